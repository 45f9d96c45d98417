//! Runs a program: blocks in order, labels, calls and jumps.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::frames::Frames;
use super::language::line::{self, Line};
use super::language::routine::Routine;
use super::language::values::{Jump, Parameters};
use super::state::{Cycles, FreeContour, Level, LevelKind, Modes, Pattern};
use crate::controls::run::{self, BlockIndex, Library, Running};
use crate::drive::{ProgramPlace, Sense, Track};
use crate::model::event::EventKind;
use crate::model::names::Format;
use crate::model::program::{Program, Units};
use crate::model::read_options::{Controller, ReadOptions};
use crate::model::stock::StockDescription;
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcError, NcProblem};
use crate::tools::comments;

pub(super) struct Reader<'a> {
    pub track: Track,
    pub parameters: Parameters,
    pub frames: Frames,
    pub modes: Modes,
    /// The last move's end is made by the RND or CHF that follows.
    pub rounded: bool,
    pub cycles: Cycles,
    pub free: FreeContour,
    pub uncertain: bool,
    /// What the codes of a block do at its end.
    pub(super) at_end: Vec<EventKind>,
    /// The program of SEL PGM.
    pub(super) selected: Option<String>,
    pub(super) library: Library<'a>,
    pub(super) options: &'a ReadOptions,
    pub(super) routines: Vec<Routine>,
    pub(super) names: BTreeMap<String, usize>,
    pub(super) stack: Vec<Level>,
    pub(super) ended: bool,
    pub(super) tools: BTreeMap<String, u32>,
    pub(super) stock: [[Option<f64>; 3]; 2],
}

pub(crate) fn read(text: &Rc<String>, options: &ReadOptions, library: Library) -> Result<Program, NcError> {
    options.check()?;
    let mut reader = Reader {
        track: Track::new(options, Sense::Tool),
        parameters: Parameters::new(options.strict),
        frames: Frames::new(options),
        modes: Modes {
            inch: options.inch,
            plane: [0, 1, 2],
            tip_control: options.machine.tip_control,
            ..Modes::default()
        },
        rounded: false,
        cycles: Cycles::default(),
        free: FreeContour::default(),
        uncertain: false,
        at_end: Vec::new(),
        selected: None,
        library,
        options,
        routines: vec![Routine::new(0, Rc::clone(text))],
        names: BTreeMap::new(),
        stack: vec![Level::new(0, 0, LevelKind::Program)],
        ended: false,
        tools: BTreeMap::new(),
        stock: [[None; 3]; 2],
    };
    reader.track.describe_tools(text);
    // Names of tools are those that the comments give to their numbers.
    let inch = text
        .lines()
        .take(20)
        .any(|line| line.contains("BEGIN PGM") && line.trim_end().ends_with("INCH"));
    let described = comments::read(text, if inch { 25.4 } else { 1.0 }).tools;
    for (number, tool) in &described {
        if let Some(name) = tool.name.as_deref().and_then(|name| name.split(" / ").next()) {
            reader
                .tools
                .entry(format!("\"{}\"", name.trim().to_uppercase()))
                .or_insert(*number);
        }
    }
    run::run(&mut reader, text, options)?;
    let names = std::mem::take(&mut reader.tools);
    let mut program = reader.finish();
    program.tools = described;
    comments::name_tools(&mut program, &names);
    Ok(program)
}

impl Running for Reader<'_> {
    fn track(&mut self) -> &mut Track {
        &mut self.track
    }

    /// The next block, back to the caller where a program ends.
    fn advance(&mut self) -> Option<BlockIndex> {
        while !self.ended {
            let level = self.stack.last_mut()?;
            if let LevelKind::Section { from, end, times } = &mut level.kind
                && level.next >= *end
            {
                *times -= 1;
                if *times > 0 {
                    level.next = *from;
                } else {
                    self.back();
                    continue;
                }
            }
            if level.next >= self.routines[level.routine].len() {
                self.back();
                continue;
            }
            let index = level.next;
            level.next += 1;
            let routine = level.routine;
            self.track.place.file = self.routines[routine].file;
            self.track.place.line = index + 1;
            if !self.routines[routine].block(index).tokens.is_empty() {
                return Some((routine, index));
            }
        }
        None
    }

    fn run(&mut self, (routine, index): BlockIndex) -> Result<(), Located> {
        let line = self.routines[routine].block(index);
        let result = self.block(&line, routine, index);
        let result = result.and_then(|()| self.end_codes(&line));
        for name in self.parameters.asked() {
            let settle = format!("{name} = … in the program");
            let assumption = Assumption::new(format!("the value of {name}"), "0: nothing sets it", settle);
            self.track.assume(assumption);
        }
        result
    }

    fn doubt(&mut self) {
        self.uncertain = true;
        self.rounded = false;
    }

    fn line_of(&self, (routine, index): BlockIndex) -> (usize, usize, &str) {
        let routine = &self.routines[routine];
        (routine.file, index + 1, routine.text(index))
    }

    fn whole(&self, (routine, index): BlockIndex) -> std::ops::Range<usize> {
        self.routines[routine].block(index).all()
    }
}

impl Reader<'_> {
    fn finish(mut self) -> Program {
        if let [[Some(x0), Some(y0), Some(z0)], [Some(x1), Some(y1), Some(z1)]] = self.stock
            && x0 != x1
            && y0 != y1
            && z0 != z1
        {
            self.track.program.stock = Some(StockDescription::Block {
                min: [x0.min(x1), y0.min(y1), z0.min(z1)],
                max: [x0.max(x1), y0.max(y1), z0.max(z1)],
            });
        }
        self.track.program.format = Some(Format::Gcode);
        self.track.program.controller = Some(Controller::Heidenhain);
        self.track.program.units = if self.modes.inch { Units::Inch } else { Units::Mm };
        self.track.finish()
    }

    pub(super) fn back(&mut self) {
        if let Some(locals) = self.stack.pop().and_then(|level| level.locals) {
            self.parameters.give_locals(locals);
        }
        if self.stack.is_empty() {
            self.ended = true;
        } else {
            self.track.returns();
        }
    }

    /// The block after this one, without empty ones.
    pub(super) fn following(&self) -> Option<Rc<Line>> {
        self.following_after(0)
    }

    /// A further block, without empty ones.
    pub(super) fn following_after(&self, skipped: usize) -> Option<Rc<Line>> {
        self.following_lines().nth(skipped).map(|(_, line)| line)
    }

    /// The block after this one, and where it is.
    pub(super) fn following_with_place(&self) -> Option<(Rc<Line>, ProgramPlace)> {
        let (line, found) = self.following_lines().next()?;
        Some((
            found,
            ProgramPlace {
                line,
                ..self.track.place
            },
        ))
    }

    pub(super) fn following_lines(&self) -> impl Iterator<Item = (usize, Rc<Line>)> {
        let level = self.stack.last();
        let lines = level.map(|level| (&self.routines[level.routine], level.next));
        lines.into_iter().flat_map(|(routine, next)| {
            let blocks = (next..routine.len()).map(|index| (index + 1, routine.block(index)));
            blocks.filter(|(_, block)| !block.tokens.is_empty() && !block.word(0).starts_with("FSELECT"))
        })
    }

    /// Millimetres per unit of length.
    pub(super) fn unit(&self) -> f64 {
        if self.modes.inch { 25.4 } else { 1.0 }
    }

    fn block(&mut self, line: &Line, routine: usize, index: usize) -> Result<(), Located> {
        if line.skipped {
            if self.options.block_delete {
                return Ok(());
            }
            self.track.note("optional blocks (`/`) are executed");
        }
        match line.word(0) {
            "BEGIN" if line.word(1) == "PGM" => {
                let inch = line.tokens.last().is_some_and(|token| token.text == "INCH");
                if self.stack.len() > 1 && inch != self.modes.inch {
                    let problem = "a program that is called, in other units than its caller, is";
                    let expected = "expected the same in both heads, MM or INCH";
                    return Err((NcProblem::unsupported(problem, expected), line.all()));
                }
                if self.stack.len() == 1 {
                    self.modes.inch = inch;
                    self.track.program.title = line
                        .tokens
                        .get(2)
                        .map(|token| self.routines[routine].text(index)[token.span.clone()].to_owned());
                }
            }
            "END" if line.word(1) == "PGM" => self.back(),
            "BLK" => self.stock_corner(line)?,
            "TOOL" if line.word(1) == "CALL" => self.tool_call(line)?,
            "TOOL" if line.word(1) == "DEF" => self.tool_definition(line)?,
            "L" | "LP" | "LN" | "C" | "CP" | "CR" | "CT" | "CTP" | "CC" | "RND" | "CHF" | "M140" => self.path(line)?,
            "FL" | "FLT" | "FC" | "FCT" | "FPOL" => self.free_block(line)?,
            // Which of several contours, by the control's own numbers: said where there are several.
            word if word.starts_with("FSELECT") => {}
            "LBL" if line.word(1) == "0" => {
                if matches!(
                    self.stack.last(),
                    Some(Level {
                        kind: LevelKind::Subprogram,
                        ..
                    })
                ) {
                    self.back();
                }
            }
            "LBL" => {}
            "CALL" if line.word(1) == "LBL" => self.call_label(line, routine, index)?,
            "CALL" if line.word(1) == "PGM" => self.call_program(line)?,
            "FN" => self.function(line, routine)?,
            word if word.starts_with("FN") => {
                // FN0: is FN 0:.
                let mut apart = line.clone();
                let (text, span) = (word[2..].to_owned(), line.span(0));
                apart.tokens[0].text = "FN".into();
                apart.tokens.insert(1, line::Token { text, span });
                self.function(&apart, routine)?;
            }
            word if word.starts_with('Q') && !word.starts_with("QS") => self.parameters.formula(line)?,
            "CYCL" => self.cycle_block(line)?,
            "PLANE" => self.plane_block(line)?,
            "FUNCTION" => self.function_block(line)?,
            "STOP" => {
                self.event(EventKind::Stop, line)?;
                self.codes(line)?;
            }
            word if word.starts_with('M') && word[1..].bytes().all(|b| b.is_ascii_digit()) => {
                self.codes(line)?;
            }
            "APPR" | "DEP" => self.approach_block(line)?,
            "TRANS" if line.word(1) == "DATUM" => self.datum_block(line)?,
            "PATTERN" if line.word(1) == "DEF" => self.pattern_block(line)?,
            "SEL" if line.word(1) == "PATTERN" => {
                self.cycles.pattern = Pattern::Table(line.word(2).trim_matches('"').to_owned());
                self.ignore(line);
            }
            "SEL" if line.word(1) == "PGM" => self.selected = Some(line.word(2).to_owned()),
            "CALL" if line.word(1) == "SELECTED" => {
                let path = self.selected.clone().unwrap_or_default();
                self.call_path(&path, line)?;
            }
            // Tables, texts, what the control watches, and how it shows it.
            "SEL" | "DECLARE" | "SECTION" | "MONITORING" | "POLARKIN" | "QS" => self.ignore(line),
            word if word.starts_with("QS") => self.ignore(line),
            "TCH" => {
                let taken = "its cycle cuts nothing: left out";
                let assumption = Assumption::new("what a probe finds", taken, "a program without probing");
                self.track.assume(assumption.harmless());
            }
            // A comment or structure item.
            word if word.starts_with('*') => {}
            word => {
                let problem = NcProblem::unsupported(
                    format!("{word} is"),
                    "expected L, C, CC, CR, CT, CP, CTP, LP, LN, RND, CHF, TOOL CALL, LBL, CALL, FN, Q, CYCL or PLANE",
                );
                return Err((problem, line.span(0)));
            }
        }
        Ok(())
    }

    /// A block that moves nothing.
    fn ignore(&mut self, line: &Line) {
        self.track
            .note(format!("{} {} moves nothing: ignored", line.word(0), line.word(1)));
    }

    fn function(&mut self, line: &Line, routine: usize) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        match self.parameters.function(line)? {
            Jump::None => {}
            Jump::To(label) => self.jump(&label, routine).map_err(whole)?,
            Jump::Stop(error) => {
                let what = format!(
                    "whether the program goes on after the error {}",
                    error.trim_start_matches('=')
                );
                let taken = "FN 14 ends it: what follows is left out";
                let settle = "the path without FN 14";
                self.track.assume(Assumption::new(what, taken, settle));
                self.ended = true;
            }
            Jump::Ignored(number) => self.track.note(format!("FN {number} moves nothing: ignored")),
            Jump::Read(name, of) => {
                // ID270: where the tool is, in the coordinates of the program.
                let axis = of.strip_prefix("ID270 NR1 IDX").and_then(|k| k.parse::<usize>().ok());
                let known = axis.and_then(|k| *self.track.xyz.get(k.checked_sub(1)?)?);
                if known.is_none() && self.options.strict {
                    let found = format!("reading {of} is");
                    return Err(whole(NcProblem::unsupported(
                        found,
                        "only the control knows it; expected a number",
                    )));
                }
                if known.is_none() {
                    let settle = format!("{name} = … in the program");
                    let what = format!("what the control knows of {of}");
                    self.track
                        .assume(Assumption::new(what, format!("0, as {name}"), settle));
                }
                let value = known.map_or(0.0, |mm| mm / self.unit());
                self.parameters.set(&name, value).map_err(whole)?;
            }
        }
        Ok(())
    }

    pub(super) fn event(&mut self, kind: EventKind, line: &Line) -> Result<(), Located> {
        self.track.event(kind).map_err(|problem| (problem, line.all()))
    }
}
