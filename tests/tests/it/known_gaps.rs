//! What `docs/shortcomings.md` says is missing, tried: the list in `tests/known_gaps.ron` may only become shorter.
//!
//! A gap that is closed fails here until it leaves both the list and the page. So does one whose message has changed,
//! since the page and the list quote what a user sees.

use std::fs;
use std::io::{Cursor, Write};
use std::path::Path;

use serde::Deserialize;
use sweepsim_formats::read_mesh_file;
use sweepsim_job::Request;
use sweepsim_nc::{Controller, ReadOptions, read_text, tools};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// How many are tried, so that none is lost from the list unnoticed.
const GAPS: usize = 30;

/// Something that does not work.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Gap {
    /// What a user wants.
    name: String,
    /// The words of `docs/shortcomings.md` that own up to it.
    page: String,
    /// What is tried.
    input: Input,
    /// What happens today.
    known: Known,
}

#[derive(Deserialize)]
enum Input {
    /// A program, read as if it were in a file of this name.
    Program {
        file: String,
        control: Option<Control>,
        text: String,
    },
    /// The same, where arcs may stay arcs.
    Arcs {
        file: String,
        control: Option<Control>,
        text: String,
    },
    /// A job.
    Job(String),
    /// A mesh in a file of this name; the text of a 3MF is that of its model.
    Mesh { file: String, text: String },
    /// The first tool of a library in a file of this name.
    Tool { file: String, text: String },
}

#[derive(Clone, Copy, Deserialize)]
enum Control {
    LinuxCnc,
    Fanuc,
    Haas,
    Siemens,
    Heidenhain,
}

#[derive(Debug, Deserialize, PartialEq)]
enum Known {
    /// It is rejected, with this message.
    Error(String),
    /// It is read with this note, as if the gap were not there.
    Note(String),
    /// A curve that could stay one move becomes this many chords.
    Chords(usize),
}

/// What a try finds: the error, or the notes and the moves.
enum Found {
    Rejected(String),
    Read { notes: Vec<String>, moves: usize },
}

impl Input {
    fn attempt(&self) -> Found {
        match self {
            Self::Program { file, control, text } => program(file, *control, text, false),
            Self::Arcs { file, control, text } => program(file, *control, text, true),
            Self::Job(text) => job(text),
            Self::Mesh { file, text } => mesh(file, text),
            Self::Tool { file, text } => tool(file, text),
        }
    }
}

fn found<T, E: ToString>(result: Result<T, E>, read: impl FnOnce(T) -> (Vec<String>, usize)) -> Found {
    match result {
        Ok(value) => {
            let (notes, moves) = read(value);
            Found::Read { notes, moves }
        }
        Err(error) => Found::Rejected(error.to_string()),
    }
}

fn program(file: &str, control: Option<Control>, text: &str, arcs: bool) -> Found {
    let mut options = ReadOptions::default();
    (options.level_arcs, options.upright_arcs, options.tilted_arcs) = (arcs, arcs, arcs);
    options.controller = control.map(|control| match control {
        Control::LinuxCnc => Controller::LinuxCnc,
        Control::Fanuc => Controller::Fanuc,
        Control::Haas => Controller::Haas,
        Control::Siemens => Controller::Siemens,
        Control::Heidenhain => Controller::Heidenhain,
    });
    found(read_text(text, Path::new(file), &options), |program| {
        let notes = program.notes.into_iter().map(|note| note.message).collect();
        (notes, program.poses.len().saturating_sub(1))
    })
}

/// A job is also run: some of what is wrong with it is only found then.
fn job(text: &str) -> Found {
    let request = Request::from_job("job.ron", text);
    let outcome = request.plan().and_then(|plan| plan.run(&()));
    found(outcome, |_| (Vec::new(), 0))
}

fn mesh(file: &str, text: &str) -> Found {
    let folder = tempfile::tempdir().expect("a folder for the mesh");
    let path = folder.path().join(file);
    let bytes = if file.ends_with(".3mf") {
        let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
        archive
            .start_file("3D/3dmodel.model", SimpleFileOptions::default())
            .and_then(|()| archive.write_all(text.as_bytes()).map_err(Into::into))
            .and_then(|()| archive.finish())
            .expect("an archive in memory")
            .into_inner()
    } else {
        text.as_bytes().to_vec()
    };
    fs::write(&path, bytes).expect("the mesh is written");
    let result = read_mesh_file(&path).map_err(|error| {
        let folder = format!("{}/", folder.path().display());
        error.to_string().replace(&folder, "")
    });
    found(result, |_| (Vec::new(), 0))
}

fn tool(file: &str, text: &str) -> Found {
    let library = tools::parse(text, Path::new(file), false).expect("the library is read");
    let tool = library.tools.values().next().expect("a tool");
    found(tool.build(), |tool| (tool.notes, 0))
}

/// Why an entry has to be changed, if it has.
fn complaint(gap: &Gap) -> Option<String> {
    let changed = |now: String| Some(format!("{} is not what it was known to be. Now: {now}", gap.name));
    match (&gap.known, gap.input.attempt()) {
        (Known::Error(known), Found::Rejected(now)) if *known == now => None,
        (Known::Note(known), Found::Read { notes, .. }) if notes.contains(known) => None,
        (Known::Chords(known), Found::Read { moves, .. }) if *known == moves => None,
        (Known::Note(_), Found::Read { notes, .. }) if !notes.is_empty() => changed(notes.join("; ")),
        (Known::Chords(_), Found::Read { moves, .. }) if moves > 1 => changed(format!("{moves} chords")),
        (_, Found::Rejected(now)) => changed(now),
        (_, Found::Read { .. }) => Some(format!("{} is closed: remove it from the list and the page", gap.name)),
    }
}

fn listed() -> Vec<Gap> {
    let text = include_str!("../../known_gaps.ron");
    ron::from_str(text).unwrap_or_else(|error| panic!("tests/known_gaps.ron:{error}"))
}

#[test]
fn known_gaps_are_still_there() {
    let gaps = listed();
    let complaints: Vec<String> = gaps.iter().filter_map(complaint).collect();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
    assert_eq!(gaps.len(), GAPS, "GAPS says how many are tried");
}

#[test]
fn known_gaps_are_on_the_page() {
    let page = include_str!("../../../docs/shortcomings.md");
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let page = words(page);
    let missing: Vec<String> = listed()
        .into_iter()
        .filter(|gap| !page.contains(&words(&gap.page)))
        .map(|gap| format!("{}: {}", gap.name, gap.page))
        .collect();
    assert!(
        missing.is_empty(),
        "not on docs/shortcomings.md:\n{}",
        missing.join("\n")
    );
}

/// What the two tests above rely on.
#[test]
fn a_closed_gap_and_a_new_message_are_noticed() {
    let gap = |text: &str, known: Known| Gap {
        name: "a move".to_owned(),
        page: String::new(),
        input: Input::Program {
            file: "a.nc".to_owned(),
            control: None,
            text: text.to_owned(),
        },
        known,
    };
    let closed = "a move is closed: remove it from the list and the page";
    let line = "G21 G90\nG0 X0 Y0 Z0\nG1 X5 F100\n";
    assert_eq!(
        complaint(&gap(line, Known::Error("refused".to_owned()))).as_deref(),
        Some(closed)
    );
    assert_eq!(complaint(&gap(line, Known::Chords(20))).as_deref(), Some(closed));
    let unknown = complaint(&gap("G21 G90\nG150\n", Known::Error("refused".to_owned()))).expect("another message");
    assert!(unknown.contains("not what it was known to be"), "{unknown}");
    let fewer = complaint(&gap("G21 G90\nG17 G0 X0 Y0 Z0\nG2 X10 I5 F100\n", Known::Chords(2))).expect("more chords");
    assert!(fewer.contains("chords"), "{fewer}");
}
