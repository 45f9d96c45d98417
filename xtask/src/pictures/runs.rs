//! Pictures that the command draws itself.

use super::sheet;
use crate::workspace;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use sweepsim_picture::Image;

/// A picture of the docs, and the command that draws it. `FIXTURES` stands for the folder of the fixtures, `OUT` for
/// that of the run.
pub struct Run {
    pub name: &'static str,
    /// A job that is written first: its text, or a text of a fixture that is replaced in it.
    job: Source,
    /// The command's words after the job.
    options: &'static [&'static str],
    takes: Takes,
}

/// Where a job comes from.
enum Source {
    /// `fixtures/jobs/NAME.ron`.
    Fixture(&'static str),
    /// That, with one text replaced by another.
    Changed(&'static str, &'static str, &'static str),
    /// A block of a page of the docs: the file, and the job's name.
    Page(&'static str, &'static str),
}

/// What a run is taken for.
enum Takes {
    /// `part.png`.
    Part,
    /// `comparison.png` of the part and another run of the same job, with these options.
    Compared(&'static [&'static str]),
    /// The same of the part and a fixture.
    AgainstFixture(&'static str),
    /// These frames, two in a row.
    Frames(&'static [usize]),
}

use Source::{Changed, Fixture, Page};

pub const RUNS: [Run; 13] = [
    run(
        "teapot",
        Fixture("teapot-exterior"),
        &["--size", "900x675"],
        Takes::Part,
    ),
    run(
        "teapot-coarse",
        Fixture("teapot-exterior"),
        &["--cells", "60x60", "--directions", "z", "--size", "900x675"],
        Takes::Compared(&[]),
    ),
    run("impeller", Fixture("impeller"), &["--size", "800x600"], Takes::Part),
    run(
        "impeller-section",
        Fixture("impeller"),
        &[
            "--directions",
            "z",
            "--section",
            "y=-4",
            "--camera",
            "-75,28",
            "--size",
            "1000x750",
        ],
        Takes::Part,
    ),
    run(
        "impeller-tri",
        Fixture("impeller"),
        &["--section", "y=-4", "--camera", "-75,28", "--size", "1000x750"],
        Takes::Part,
    ),
    run(
        "undercut",
        Page("dexels.md", "undercut"),
        &["--camera", "-60,30", "--size", "1100x825"],
        Takes::Part,
    ),
    run(
        "undercut-section",
        Page("dexels.md", "undercut"),
        &["--section", "x=30", "--camera", "25,22", "--size", "800x600"],
        Takes::Part,
    ),
    run(
        "example-teapot-exterior",
        Fixture("teapot-exterior"),
        &["--frames", "7", "--size", "560x420", "--no-axes"],
        Takes::Frames(&[2, 3, 5, 7]),
    ),
    run(
        "example-teapot-interior",
        Fixture("teapot-interior"),
        &["--frames", "7", "--size", "560x420", "--no-axes", "--camera", "-40,42"],
        Takes::Frames(&[2, 3, 5, 7]),
    ),
    run(
        "example-impeller-blade",
        Fixture("impeller-blade"),
        &["--frames", "7", "--size", "560x420", "--no-axes", "--camera", "-50,38"],
        Takes::Frames(&[2, 4, 5, 7]),
    ),
    run(
        "example-railing",
        Fixture("railing"),
        &["--frames", "13", "--size", "560x420", "--no-axes", "--camera", "-65,28"],
        Takes::Frames(&[3, 4, 6, 13]),
    ),
    run(
        "railing-gouge",
        Changed(
            "railing",
            "min: (0, -24), max: (96, 24)",
            "min: (10, -24), max: (46, -12)",
        ),
        &["--size", "1000x750", "--camera", "-65,28"],
        Takes::Part,
    ),
    run(
        "railing-deviation",
        Fixture("railing"),
        &["--size", "1000x750", "--camera", "-65,28"],
        Takes::AgainstFixture("meshes/railing.ply"),
    ),
];

const fn run(name: &'static str, job: Source, options: &'static [&'static str], takes: Takes) -> Run {
    Run {
        name,
        job,
        options,
        takes,
    }
}

impl Run {
    /// Runs the command, and reads what it draws.
    pub fn image(&self) -> Result<Image, String> {
        let out = workspace::root().join("out/pictures").join(self.name);
        fs::create_dir_all(&out).map_err(|error| format!("{}: {error}", out.display()))?;
        let job = self.job(&out)?;
        let simulate =
            |out: &Path, more: &[&str]| command(&[&["simulate", &shown(&job), "--out", &shown(out)], more].concat());
        let compare = |target: &Path| {
            let view = self
                .options
                .windows(2)
                .filter(|pair| ["--size", "--camera"].contains(&pair[0]));
            let view: Vec<&str> = view.flatten().copied().collect();
            let part = out.join("part.ply");
            command(
                &[
                    &["compare", &shown(&part), &shown(target), "--out", &shown(&out)],
                    &view[..],
                ]
                .concat(),
            )?;
            read(&out.join("comparison.png"))
        };
        match &self.takes {
            Takes::Part => {
                simulate(&out, &[self.options, &["--only", "picture"]].concat())?;
                read(&out.join("part.png"))
            }
            Takes::Frames(numbers) => {
                simulate(&out, &[self.options, &["--only", "dexels"]].concat())?;
                let frame = |number: &usize| read(&out.join(format!("frame-{number:04}.png")));
                let images: Result<Vec<Image>, String> = numbers.iter().map(frame).collect();
                sheet(&images?, 2)
            }
            Takes::Compared(others) => {
                simulate(&out, &[self.options, &["--only", "mesh"]].concat())?;
                let other = out.join("other");
                simulate(&other, &[*others, &["--only", "binary"]].concat())?;
                compare(&other.join("part.dexels"))
            }
            Takes::AgainstFixture(target) => {
                simulate(&out, &[self.options, &["--only", "mesh"]].concat())?;
                compare(&workspace::fixtures().join(target))
            }
        }
    }

    /// The job's file.
    fn job(&self, out: &Path) -> Result<PathBuf, String> {
        let fixture = |name: &str| workspace::fixtures().join(format!("jobs/{name}.ron"));
        let (text, file) = match self.job {
            Fixture(name) => return Ok(fixture(name)),
            Changed(name, from, to) => {
                let text = text(&fixture(name))?;
                if !text.contains(from) {
                    return Err(format!("{name}.ron: expected `{from}`"));
                }
                let folder = shown(&workspace::fixtures());
                (text.replace(from, to).replace("\"../", &format!("\"{folder}/")), name)
            }
            Page(page, name) => {
                let text = text(&workspace::root().join("docs").join(page))?;
                let start = format!("```ron\nJob(\n    name: \"{name}\"");
                let block = text.split_once(&start).and_then(|(_, rest)| rest.split_once("\n```"));
                let (rest, _) = block.ok_or_else(|| format!("{page}: expected the job {name}"))?;
                (format!("Job(\n    name: \"{name}\"{rest}\n"), name)
            }
        };
        let file = out.join(format!("{file}.ron"));
        fs::write(&file, text).map_err(|error| format!("{}: {error}", file.display()))?;
        Ok(file)
    }
}

pub fn shown(path: &Path) -> String {
    path.display().to_string()
}

fn text(file: &Path) -> Result<String, String> {
    fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))
}

/// Builds `sweepsim` as this program was built.
pub fn build() -> Result<(), String> {
    let release: &[&str] = if cfg!(debug_assertions) { &[] } else { &["--release"] };
    let status = Command::new(env!("CARGO"))
        .args(["build", "--quiet", "--package", "sweepsim-cli"])
        .args(release)
        .status();
    match status {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("cargo build: {status}")),
        Err(error) => Err(format!("cargo build: {error}")),
    }
}

/// Runs `sweepsim`.
pub fn command(words: &[&str]) -> Result<(), String> {
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let program = own.with_file_name(format!("sweepsim{}", std::env::consts::EXE_SUFFIX));
    match Command::new(program).args(words).arg("--quiet").status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("sweepsim {}: {status}", words.join(" "))),
        Err(error) => Err(format!("sweepsim: {error}")),
    }
}

pub fn read(file: &Path) -> Result<Image, String> {
    let about = |error: &dyn std::fmt::Display| format!("{}: {error}", file.display());
    let bytes = fs::read(file).map_err(|error| about(&error))?;
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .map_err(|error| about(&error))?;
    let size = reader.output_buffer_size().ok_or_else(|| about(&"too large"))?;
    let mut rgb = vec![0; size];
    reader.next_frame(&mut rgb).map_err(|error| about(&error))?;
    let size = [reader.info().width as usize, reader.info().height as usize];
    Image::new(size, rgb).map_err(|error| about(&error))
}
