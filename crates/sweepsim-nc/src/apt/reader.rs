//! Executes the statements of a CL file.

use std::collections::HashSet;

use super::arcs::PendingArc;
use super::cycles::{Cycle, CycleStatement};
use super::loaded::LoadedTools;
use super::nurbs::Nurbs;
use super::statement::{Statement, Statements};
use super::words::{IGNORED, REFUSED, ROTARY, is_geometry};
use crate::drive::Track;
use crate::machines::WorkFrame;
use crate::model::event::EventKind;
use crate::model::names::Format;
use crate::model::program::{Call, Program, Units};
use crate::model::read_options::ReadOptions;
use crate::text::error::{Located, NcError, NcProblem, TextPosition};

/// The most problems after the first one.
const MOST_FURTHER: usize = 100;

pub(super) struct Reader<'o> {
    pub options: &'o ReadOptions,
    /// Millimetres per unit.
    pub unit: f64,
    pub track: Track,
    /// The frame of the first `MSYS`, which is that of the poses, in the frame of the file;
    pub first_frame: Option<WorkFrame>,
    /// and the one in effect, in that of the poses.
    pub frame: WorkFrame,
    pub rapid: bool,
    pub arc: Option<PendingArc>,
    pub cycle: Option<Box<Cycle>>,
    last_cycle: Option<Box<Cycle>>,
    pub nurbs: Nurbs,
    pub tools: LoadedTools,
    pub units: Option<Units>,
    pub csys: Option<[f64; 12]>,
    /// Whether coordinates are those of the part, if the file has said so.
    pub world: Option<bool>,
    ended: bool,
}

pub(super) fn read(text: &str, options: &ReadOptions) -> Result<Program, NcError> {
    options.check()?;
    let mut reader = Reader {
        options,
        unit: 1.0,
        track: Track::of_poses(options),
        first_frame: None,
        frame: WorkFrame::default(),
        rapid: false,
        arc: None,
        cycle: None,
        last_cycle: None,
        nurbs: Nurbs::default(),
        tools: LoadedTools::default(),
        units: None,
        csys: None,
        world: None,
        ended: false,
    };
    reader.track.chord_note = "arcs are divided into chords".to_owned();
    reader.default_unit(text);
    let mut errors: Vec<NcError> = Vec::new();
    let mut messages = HashSet::new();
    for statement in Statements::of(text) {
        if let Err((problem, bytes)) = reader.statement(&statement, text) {
            reader.track.joined = false;
            if options.lenient && !matches!(problem, NcProblem::Unsupported { ref what, .. } if what == PART_PROGRAM) {
                reader.track.note(format!("left out: {problem}"));
            } else if messages.insert(problem.to_string()) {
                errors.push(NcError::new(problem, Some(TextPosition::of_bytes(text, bytes))));
            }
            reader.rapid = false;
            reader.arc = None;
        }
        if reader.ended || errors.len() > MOST_FURTHER {
            break;
        }
    }
    if errors.is_empty()
        && let Err((problem, bytes)) = reader.end_of_arc()
    {
        errors.push(NcError::new(problem, Some(TextPosition::of_bytes(text, bytes))));
    }
    if let Some(error) = NcError::all(errors) {
        return Err(error);
    }
    if !reader.track.has_moved() {
        let line = text.lines().count().max(1);
        let problem = NcProblem::syntax("this program has no move: expected at least one GOTO");
        return Err(NcError::new(problem, Some(TextPosition::in_line(line, "", 1, 1))));
    }
    Ok(reader.finish())
}

/// What part programs are called in messages.
const PART_PROGRAM: &str = "APT part programs, whose path follows from geometry, are";

impl Reader<'_> {
    fn finish(mut self) -> Program {
        let tools = self.tools.finish(&mut self.track.notes);
        Program {
            format: Some(Format::Apt),
            units: self.units.unwrap_or_default(),
            tools,
            ..self.track.finish()
        }
    }

    /// The unit until the file says one: as its feeds suggest, or as given.
    fn default_unit(&mut self, text: &str) {
        let mut inch = self.options.inch;
        for statement in Statements::of(text) {
            if statement.is("UNITS") || statement.is("UNIT") {
                break;
            }
            let metric = statement.has("MMPM") || statement.has("MMPR");
            if statement.is("FEDRAT") && (metric || statement.has("IPM") || statement.has("IPR")) {
                let unit = if metric { "millimetres" } else { "inches" };
                let note = format!("no units are given: {unit}, as in the feeds");
                self.track.notes.add(statement.line, note);
                inch = !metric;
                break;
            }
        }
        if inch {
            self.unit = 25.4;
            self.units = Some(Units::Inch);
        }
    }

    fn statement(&mut self, statement: &Statement, text: &str) -> Result<(), Located> {
        let line = statement.line;
        (self.track.place.line, self.track.place.call) = (line, None);
        let whole = |problem| (problem, statement.bytes.clone());
        let is = |word: &str| statement.is(word);
        // An arc whose end is not given by the next move ends by its angle.
        if self.arc.is_some()
            && !["GOTO", "FEDRAT", "PAINT", "SPINDL", "COOLNT", "PPRINT", "RAPID"]
                .iter()
                .any(|w| is(w))
        {
            self.end_of_arc()?;
        }
        if self.nurbs.is_open() && !is("KNOT") && !is("CNTRL") && !is("NURBS") && !is("WEIGHT") {
            let bytes = self.nurbs.bytes();
            self.end_of_nurbs().map_err(|problem| (problem, bytes))?;
        }
        if statement.comment {
            return self.meaningful_comment(statement);
        }
        match statement.major.to_ascii_uppercase().as_str() {
            "GOTO" => self.goto(statement)?,
            "RAPID" => self.rapid = true,
            "FEDRAT" => self.fedrat(statement),
            "FROM" => self.from(statement)?,
            "GODLTA" => self.godlta(statement)?,
            "GOHOME" => {
                self.track
                    .note("GOHOME: the tool leaves for a place that only the machine knows; the path breaks");
                self.track.leave([true; 3]);
            }
            "CIRCLE" => self.circle(statement)?,
            "MOVARC" => self.movarc(statement)?,
            "CYCLE" => {
                self.track.program.calls.push(Call::new(0, line, None));
                let call = (self.track.program.calls.len() - 1) as u32;
                match CycleStatement::of(statement, self.unit, call).map_err(whole)? {
                    CycleStatement::Off => self.cycle = None,
                    CycleStatement::On => self.cycle = self.last_cycle.clone(),
                    CycleStatement::Begin(cycle) => {
                        self.cycle = Some(cycle.clone());
                        self.last_cycle = Some(cycle);
                        return Ok(());
                    }
                }
                self.track.program.calls.pop();
            }
            "CUTTER" | "TLDATA" => {
                if let Some(note) = self.tools.describe(statement, self.unit).map_err(whole)? {
                    self.track.note(note);
                }
            }
            "LOAD" | "LOADTL" | "TURRET" | "TOOLNO" => self.load(statement).map_err(whole)?,
            "SELECT" | "SELCTL" => {}
            "UNITS" | "UNIT" => self.set_unit(statement).map_err(whole)?,
            "MSYS" => self.msys(statement).map_err(whole)?,
            "CSYS" | "TRNTYP" => self.frame_of_coordinates(statement).map_err(whole)?,
            "ORIGIN" | "SETUP" => self.track.note(format!(
                "{} is for the post-processor: ignored",
                statement.major.to_ascii_uppercase()
            )),
            "CUTCOM" => {
                if !statement.has("OFF") && !statement.has("ON") {
                    let note =
                        "CUTCOM: the coordinates are taken as those of the tool's axis, as CAM systems write them";
                    self.track.note(note);
                }
            }
            "SPINDL" => self.spindle(statement).map_err(whole)?,
            "COOLNT" => self.coolant(statement).map_err(whole)?,
            "DELAY" | "DWELL" => {
                if let Some(seconds) = statement.number().filter(|seconds| *seconds >= 0.0) {
                    self.track.event(EventKind::Dwell { seconds }).map_err(whole)?;
                }
            }
            "STOP" => self.track.event(EventKind::Stop).map_err(whole)?,
            "OPSTOP" => self.track.event(EventKind::OptionalStop).map_err(whole)?,
            "PARTNO" => {
                self.track
                    .program
                    .title
                    .get_or_insert_with(|| statement.rest.to_owned());
            }
            "PPRINT" | "DISPLY" | "TPRINT" => {
                let text = statement.rest.to_owned();
                self.track.event(EventKind::Message(text)).map_err(whole)?;
            }
            "INSERT" => self.insert(statement),
            "REMARK" | "LETTER" => {}
            "CSI_SET_FLUTE_LENGTH" => self
                .tools
                .flute_length(statement.number().map(|value| value * self.unit)),
            "CSI_SET_EXTENSION_LENGTH" => self.tools.stick_out(statement.number().map(|value| value * self.unit)),
            "NURBS" | "KNOT" | "CNTRL" | "WEIGHT" => self.nurbs.statement(statement, self.unit).map_err(whole)?,
            "MOVNRB" => self
                .track
                .note("MOVNRB: the points that approximate the curve are read, not the curve"),
            "FINI" => self.ended = true,
            _ => self.other(statement, text)?,
        }
        Ok(())
    }

    /// Statements that do nothing here, or cannot be read.
    fn other(&mut self, statement: &Statement, text: &str) -> Result<(), Located> {
        let fail = |what: &str, instead: &str| Err((NcProblem::unsupported(what, instead), statement.bytes.clone()));
        let major = statement.major;
        let upper = major.to_ascii_uppercase();
        if is_geometry(&upper, &text[statement.bytes.clone()]) {
            return fail(
                PART_PROGRAM,
                "expected a CL file, as APT processors and CAM systems write it, in which GOTO gives every point",
            );
        }
        if let Some((_, what)) = REFUSED.iter().find(|(word, _)| upper == *word) {
            let nothing = upper == "TRANS" && statement.numbers().iter().all(|value| *value == 0.0);
            if !nothing {
                return fail(
                    what,
                    "the path of the tool would be unknown; expected GOTO, CIRCLE or CYCLE",
                );
            }
        } else if ROTARY.contains(&upper.as_str()) {
            if upper != "MULTAX" {
                let note = format!("{upper}: the tool axes of GOTO say how the part is turned; ignored");
                self.track.notes.add(statement.line, note);
            }
        } else if !IGNORED.contains(&upper.as_str()) && !upper.starts_with("CSI_") {
            let shown: String = upper.chars().take(40).collect();
            self.track
                .notes
                .add(statement.line, format!("{shown} is not understood: ignored"));
        }
        Ok(())
    }
}
