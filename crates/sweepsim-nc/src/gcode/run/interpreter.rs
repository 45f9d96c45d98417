//! Executes a program block by block.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::control::calls::{CallLevel, SourceLine};
use super::control::lookup::folders;
use super::control::variables::{Store, given_work_offsets};
use super::motion::Nurbs;
use super::planes::PlaneBlocks;
use super::tools::ToolTable;
use crate::drive::{Canonical, ProgramPlace, Sense, Trace, Track};
use crate::gcode::flow::keywords::{Label, after_letter, is_statement, skip_head};
use crate::gcode::flow::source::{LONGEST, Source};
use crate::gcode::modes::Modes;
use crate::gcode::offsets::Offsets;
use crate::gcode::syntax::block::Block;
use crate::gcode::syntax::cursor::Cursor;
use crate::gcode::syntax::{title, words};
use crate::model::names::Format;
use crate::model::program::{Program, Units};
use crate::model::read_options::{Controller, ReadOptions};
use crate::text::error::{Located, NcError, NcProblem};

/// The most problems after the first one.
const MOST_FURTHER: usize = 100;
/// How many blocks are still executed after a problem, to find others.
const AFTER_PROBLEM: u64 = 200_000;

/// What comes after a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    Next,
    Jump(SourceLine),
    End,
}

/// The length offset in effect.
#[derive(Default)]
pub(crate) struct LengthOffset {
    pub offset: [f64; 3],
    /// Whether it is a known one.
    pub known: bool,
    /// Whether the program uses length offsets at all; otherwise its coordinates are those of the tip.
    pub used: bool,
}

/// What has switched tip control on.
#[derive(Default)]
pub(crate) struct TipControl {
    /// The machine's kinematics (M428).
    pub kinematics: bool,
    /// The length offset (G43.4).
    pub by_length: bool,
    /// G43.5: tool vectors.
    pub vectors: bool,
}

/// The interpreter.
pub(crate) struct Reader {
    pub track: Track,
    pub modes: Modes,
    pub offsets: Offsets,
    pub variables: Store,
    pub tools: ToolTable,
    pub controller: Option<Controller>,
    /// Whether the control is given, not guessed: its own rules about missing and spare words then count.
    pub strict: bool,
    pub levels: Vec<CallLevel>,
    /// The block of G66, and how deep in calls it is.
    pub modal_macro: Option<(Block, usize)>,
    pub sources: Vec<Rc<Source>>,
    pub files: Vec<PathBuf>,
    pub folders: Vec<PathBuf>,
    pub looked_for: BTreeSet<Label>,
    pub call_numbers: BTreeMap<(usize, usize, Option<u32>), u32>,
    pub loop_ends: BTreeMap<SourceLine, Option<usize>>,
    /// Where the last jump backwards led.
    pub turned: Option<SourceLine>,
    pub block_delete: bool,
    pub lenient: bool,
    /// Whether positions in machine coordinates are known: the control's variables were given.
    pub machine_known: bool,
    /// The curve of G5.2 so far.
    pub nurbs: Option<Nurbs>,
    /// The plane of G68.2 so far, if it takes several blocks.
    pub plane_blocks: Option<PlaneBlocks>,
    /// The last move was one of G45 to G48.
    pub stretched: bool,
    pub length: LengthOffset,
    /// Selected by a T word, not yet in the spindle.
    pub selected_tool: Option<u32>,
    pub tool_changed: bool,
    /// The homes of G28 and G30 in machine coordinates, as far as they are known.
    pub homes: [Option<[f64; 3]>; 2],
    pub tip: TipControl,
    /// A program number has come.
    pub numbered: bool,
    pub begun: bool,
    /// After a problem: what the program has said so far is not fully known.
    pub uncertain: bool,
    /// The units of the first move.
    pub units: Option<Units>,
}

/// A text that is read, and where it comes from.
pub(crate) struct Input<'a> {
    pub text: &'a Rc<String>,
    pub file: Option<&'a Path>,
}

/// What a program is, or what is wrong with it; and its canonical commands, if they are traced.
pub(crate) struct Outcome {
    pub program: Result<Program, NcError>,
    pub trace: Vec<Canonical>,
}

pub(crate) fn read(input: &Input, options: &ReadOptions, trace: bool) -> Outcome {
    let fail = |error| Outcome {
        program: Err(error),
        trace: Vec::new(),
    };
    if let Err(error) = options.check() {
        return fail(error);
    }
    if input.text.len() > LONGEST {
        let problem = NcProblem::value("the size of a program", input.text.len(), "less than 2 GB");
        return fail(NcError::new(problem, None));
    }
    let mut reader = Reader::new(input, options);
    reader.track.trace = trace.then(Trace::default);
    let errors = reader.run(options.most_blocks, title::leader(input.text));
    let trace = reader.track.trace.take().unwrap_or_default().commands;
    let program = NcError::all(errors).map_or(Ok(()), Err);
    let program = program.and_then(|()| match options.lenient {
        true => Ok(()),
        false => reader.track.check_moves(input.text),
    });
    let program = program.map(|()| Program {
        units: reader.units.unwrap_or_default(),
        format: Some(Format::Gcode),
        controller: reader.controller,
        files: reader.files,
        ..reader.track.finish()
    });
    Outcome { program, trace }
}

impl Reader {
    fn new(input: &Input, options: &ReadOptions) -> Self {
        let unit = if options.inch { 25.4 } else { 1.0 };
        let mut offsets = Offsets::default();
        for (index, placed) in given_work_offsets(&options.variables, unit) {
            offsets.place(index, placed);
        }
        let home = |first: u32| {
            let value = |k: u32| options.variables.get(&(first + k)).map(|value| value * unit);
            Some([value(0)?, value(1)?, value(2)?])
        };
        let mut reader = Self {
            track: Track::new(
                options,
                match options.controller {
                    Some(Controller::Haas | Controller::Fanuc) => Sense::Tool,
                    _ => Sense::Part,
                },
            ),
            modes: Modes::new(options.inch),
            offsets,
            variables: Store::new(&options.variables),
            tools: ToolTable::new(&options.tool_offsets, &options.diameters),
            controller: options.controller.or_else(|| crate::gcode::dialect::of(input.text)),
            strict: options.controller.is_some(),
            modal_macro: None,
            levels: vec![CallLevel::default()],
            sources: vec![Rc::new(Source::new(0, Rc::clone(input.text)))],
            files: input.file.map(Path::to_owned).into_iter().collect(),
            folders: folders(input.file, &options.subprograms),
            looked_for: BTreeSet::new(),
            call_numbers: BTreeMap::new(),
            loop_ends: BTreeMap::new(),
            turned: None,
            block_delete: options.block_delete,
            lenient: options.lenient,
            machine_known: !options.variables.is_empty(),
            nurbs: None,
            plane_blocks: None,
            stretched: false,
            length: LengthOffset {
                used: input.text.contains("G43") || input.text.contains("g43"),
                ..LengthOffset::default()
            },
            selected_tool: None,
            tool_changed: false,
            homes: [home(5161), home(5181)],
            tip: TipControl {
                kinematics: options.machine.tip_control,
                ..TipControl::default()
            },
            numbered: false,
            begun: false,
            uncertain: false,
            units: None,
        };
        reader.update_frame();
        if let Some(start) = options.start {
            let xyz = reader.track.frame().inverse_point(start);
            reader.track.xyz = xyz.map_or([None; 3], |xyz| xyz.map(Some));
        }
        reader
    }

    /// Executes the main program, and returns its problems.
    fn run(&mut self, most_blocks: u64, leader: usize) -> Vec<NcError> {
        let mut errors: Vec<NcError> = Vec::new();
        let mut messages = BTreeSet::new();
        if leader > 0 {
            self.track.notes.add(1, "text before the first `%`: ignored");
        }
        let mut here = SourceLine {
            source: 0,
            line: leader,
        };
        let mut source = Rc::clone(&self.sources[0]);
        let mut block = Block::default();
        let mut left = most_blocks;
        loop {
            if here.line >= source.len() {
                if here.source == 0 && self.levels.len() == 1 {
                    break;
                }
                let problem = NcProblem::syntax("the file ends within a subprogram: expected M99, or `endsub`");
                errors.push(self.error(problem, &source, source.len().saturating_sub(1), 0..0));
                break;
            }
            if left == 0 {
                // Problems have made the loop's end unreachable, perhaps.
                if errors.is_empty() {
                    let to = self.turned.unwrap_or(here);
                    let source = Rc::clone(&self.sources[to.source]);
                    let problem = NcProblem::value(
                        "the number of executed blocks",
                        most_blocks,
                        "smaller: the loop that begins here does not end, or `most_blocks` is too small",
                    );
                    errors.push(self.error(problem, &source, to.line, 0..usize::MAX));
                }
                break;
            }
            left -= 1;
            let step = match self.line(&source, here, &mut block) {
                Ok(step) => step,
                Err((problem, span)) => {
                    self.go_on(&block);
                    let text = problem.to_string();
                    if self.lenient {
                        self.track.note(format!("left out: {text}"));
                    } else if messages.insert(text) {
                        errors.push(self.error(problem, &source, here.line, span));
                        left = left.min(AFTER_PROBLEM);
                    }
                    Step::Next
                }
            };
            match step {
                Step::Next => here.line += 1,
                Step::Jump(to) => {
                    if to.source != here.source {
                        source = Rc::clone(&self.sources[to.source]);
                    }
                    here = to;
                }
                Step::End => break,
            }
            if errors.len() > MOST_FURTHER || self.track.trace.is_some() && !errors.is_empty() {
                break;
            }
        }
        for ended in [self.track.end_compensation(None), self.check_curve()] {
            let Err(problem) = ended else { continue };
            let last = here.line.min(source.len().saturating_sub(1));
            errors.push(self.error(problem, &source, last, 0..usize::MAX));
        }
        // By line, of each file.
        errors.sort_by_key(|error| (error.file().is_none(), error.position().map(|position| position.line)));
        errors
    }

    fn error(&self, problem: NcProblem, source: &Source, line: usize, span: std::ops::Range<usize>) -> NcError {
        let files = (&self.files[..], source.file);
        NcError::on_line(problem, (line + 1, source.line(line)), span, files)
    }

    /// Goes on after a problem, to find others: where the tool is now is not known.
    fn go_on(&mut self, block: &Block) {
        self.uncertain = true;
        self.nurbs = None;
        self.plane_blocks = None;
        self.track.leave([true; 3]);
        let cycle = matches!(self.modes.motion, Some(crate::gcode::codes::MotionMode::Cycle(_)));
        if cycle || !self.lenient || block.has('G') {
            self.modes.motion = None;
        }
    }

    fn line(&mut self, source: &Source, here: SourceLine, block: &mut Block) -> Result<Step, Located> {
        let line = source.line(here.line);
        self.track.place = ProgramPlace {
            file: source.file,
            line: here.line + 1,
            call: self.level().call,
        };
        if !self.track.has_moved()
            && let Some(title) = title::of(line)
        {
            self.begun = true;
            block.clear();
            self.track.program.title.get_or_insert(title);
            return Ok(Step::Next);
        }
        let mut cursor = Cursor::new(line);
        match cursor.peek() {
            None => return Ok(Step::Next),
            Some(b'$' | b'{' | b'?' | b'!' | b'~') => return self.command(line, cursor),
            _ => {}
        }
        if line.as_bytes().get(cursor.at) == Some(&b'/') && self.block_delete {
            self.track.note("optional blocks (`/`) are skipped");
            return Ok(Step::Next);
        }
        if let Some(cursor) = after_letter(line) {
            self.begun = true;
            block.clear();
            return self.labelled(cursor, here);
        }
        skip_head(&mut cursor);
        if is_statement(cursor) {
            self.begun = true;
            block.clear();
            return self.statement(cursor, here);
        }
        words::read(line, self, block)?;
        if block.tape {
            let ends = self.begun && self.levels.len() == 1;
            return Ok(if ends { Step::End } else { Step::Next });
        }
        if let Some(message) = block.message.clone() {
            self.message(&line[message]);
        }
        if block.optional && !(block.is_empty() && block.assignments.is_empty()) {
            self.track.note("optional blocks (`/`) are executed");
        }
        if block.is_empty() && block.assignments.is_empty() {
            return Ok(Step::Next);
        }
        self.begun = true;
        self.perform(block, here)
    }
}
