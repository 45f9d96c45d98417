//! Executes a program block by block.

use std::collections::BTreeSet;
use std::path::Path;
use std::rc::Rc;

use super::control::calls::{Calls, SourceLine};
use super::control::lookup::Texts;
use super::control::variables::Store;
use super::motion::Nurbs;
use super::planes::PlaneBlocks;
use super::tools::{ToolTable, compare_registers};
use crate::drive::{Canonical, ProgramPlace, Trace, Track};
use crate::gcode::dialect::Rules;
use crate::gcode::flow::keywords::{after_letter, is_statement, skip_head};
use crate::gcode::flow::source::{LONGEST, Source};
use crate::gcode::modes::{Modes, TipControl};
use crate::gcode::offsets::Offsets;
use crate::gcode::okuma;
use crate::gcode::syntax::block::Block;
use crate::gcode::syntax::cursor::Cursor;
use crate::gcode::syntax::{title, user_task, words};
use crate::model::names::Format;
use crate::model::program::{Program, Units};
use crate::model::read_options::ReadOptions;
use crate::text::error::{Located, NcError, NcProblem};

/// The most problems after the first one.
const MOST_FURTHER: usize = 100;
/// How many blocks are still executed after a problem, to find others.
const AFTER_PROBLEM: u64 = 200_000;

/// How many blocks are executed where lines may be those of a user task.
const MOST_USER_TASK: u64 = 2_000_000;

/// What comes after a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    Next,
    Jump(SourceLine),
    End,
}

/// The interpreter.
pub(crate) struct Reader {
    pub track: Track,
    pub rules: Rules,
    pub texts: Texts,
    pub calls: Calls,
    pub modes: Modes,
    pub variables: Store,
    pub offsets: Offsets,
    pub tools: ToolTable,
    pub tip: TipControl,
    pub pending: Pending,
    pub seen: Seen,
}

/// What further blocks go on with.
#[derive(Default)]
pub(crate) struct Pending {
    /// The curve of G5.2 so far.
    pub nurbs: Option<Nurbs>,
    /// The plane of G68.2 so far, if it takes several blocks.
    pub plane: Option<PlaneBlocks>,
    /// The last move was one of G45 to G48.
    pub stretched: bool,
}

/// What has come so far.
#[derive(Default)]
pub(crate) struct Seen {
    /// A program number.
    pub numbered: bool,
    pub begun: bool,
    /// A problem: what the program has said is not fully known.
    pub uncertain: bool,
    /// The units of the first move.
    pub units: Option<Units>,
    /// G90.1 or G91.1.
    pub centres: bool,
    /// An arc without a radius, where neither has come.
    pub odd_arcs: bool,
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
    /// Whether something was assumed.
    assumed: bool,
    /// Whether an arc had no radius about a centre that the program does not call relative.
    odd_arcs: bool,
}

pub(crate) fn read(input: &Input, options: &ReadOptions, trace: bool) -> Outcome {
    let fail = |error| Outcome {
        program: Err(error),
        trace: Vec::new(),
        assumed: false,
        odd_arcs: false,
    };
    if let Err(error) = options.check() {
        return fail(error);
    }
    if input.text.len() > LONGEST {
        let problem = NcProblem::value("the size of a program", input.text.len(), "less than 2 GB");
        return fail(NcError::new(problem, None));
    }
    let as_said = Reading {
        wear_alone: options.wear_registers,
        absolute_centres: false,
    };
    let mut outcome = read_once(input, options, trace, as_said);
    // Contours that cannot be offset by the tool's radius are those of the tool itself; arcs that have no radius have absolute centres.
    let centres = outcome.odd_arcs && !options.strict;
    let wear = outcome.assumed && !as_said.wear_alone;
    let others = [(true, false), (false, true), (true, true)].map(|(wear_alone, absolute_centres)| Reading {
        wear_alone: wear_alone || as_said.wear_alone,
        absolute_centres,
    });
    let mut others = others
        .into_iter()
        .filter(|other| outcome.program.is_err() && (wear || other.wear_alone == as_said.wear_alone))
        .filter(|other| centres || !other.absolute_centres);
    let found = others.find_map(|other| {
        let other = read_once(input, options, trace, other);
        other.program.is_ok().then_some(other)
    });
    if let (None, true, Ok(program)) = (&found, wear, &mut outcome.program) {
        let as_wear = Reading {
            wear_alone: true,
            ..as_said
        };
        compare_registers(program, || read_once(input, options, false, as_wear).program.ok());
    }
    found.unwrap_or(outcome)
}

/// How a program is read where controls differ, and it does not say how.
#[derive(Clone, Copy)]
struct Reading {
    /// Registers D that nothing sets are 0.
    wear_alone: bool,
    /// I, J and K are coordinates of centres.
    absolute_centres: bool,
}

fn read_once(input: &Input, options: &ReadOptions, trace: bool, reading: Reading) -> Outcome {
    let mut reader = Reader::new(input, options);
    reader.tools.wear_alone = reading.wear_alone;
    reader.modes.absolute_centres = reading.absolute_centres;
    reader.track.trace = trace.then(Trace::default);
    let errors = reader.run(options.most_blocks, title::leader(input.text));
    let trace = reader.track.trace.take().unwrap_or_default().commands;
    let assumed = reader.track.assumes();
    let odd_arcs = reader.seen.odd_arcs;
    let program = NcError::all(errors).map_or(Ok(()), Err);
    let program = program.and_then(|()| match options.lenient {
        true => Ok(()),
        false => reader.track.check_moves(input.text),
    });
    let program = program.map(|()| Program {
        units: reader.seen.units.unwrap_or_default(),
        format: Some(Format::Gcode),
        controller: reader.rules.controller,
        files: reader.texts.files,
        ..reader.track.finish()
    });
    Outcome {
        program,
        trace,
        assumed,
        odd_arcs,
    }
}

impl Reader {
    fn new(input: &Input, options: &ReadOptions) -> Self {
        let rules = Rules::new(input.text, options);
        let mut reader = Self {
            track: Track::new(options, rules.sense()),
            texts: Texts::new(input, options),
            calls: Calls::default(),
            modes: Modes::new(options.inch),
            variables: Store::new(&options.variables),
            offsets: Offsets::new(options),
            tools: ToolTable::new(options, input.text),
            tip: TipControl {
                kinematics: options.machine.tip_control,
                ..TipControl::default()
            },
            pending: Pending::default(),
            seen: Seen::default(),
            rules,
        };
        reader.track.describe_tools(input.text);
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
        let mut source = Rc::clone(&self.texts.sources[0]);
        let mut block = Block::default();
        // Lines of a user task take longer.
        let most_blocks = match self.has_user_task() {
            true => most_blocks.min(MOST_USER_TASK),
            false => most_blocks,
        };
        let mut left = most_blocks;
        loop {
            if here.line >= source.len() {
                if here.source == 0 && self.calls.levels.len() == 1 {
                    break;
                }
                let problem = NcProblem::syntax("the file ends within a subprogram: expected M99, or `endsub`");
                errors.push(self.error(problem, &source, source.len().saturating_sub(1), 0..0));
                break;
            }
            if left == 0 {
                // Problems have made the loop's end unreachable, perhaps.
                if errors.is_empty() {
                    let to = self.calls.turned.unwrap_or(here);
                    let source = Rc::clone(&self.texts.sources[to.source]);
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
                    if self.rules.lenient {
                        self.track.note(format!("left out: {text}"));
                    } else if messages.insert(text) {
                        errors.push(self.error(problem, &source, here.line, span));
                        left = left.min(AFTER_PROBLEM);
                    }
                    Step::Next
                }
            };
            if self.variables.asks() {
                self.say_unknown(source.line(here.line), matches!(step, Step::Jump(_)));
            }
            match step {
                Step::Next => here.line += 1,
                Step::Jump(to) => {
                    if to.source != here.source {
                        source = Rc::clone(&self.texts.sources[to.source]);
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
        let files = (&self.texts.files[..], source.file);
        NcError::on_line(problem, (line + 1, source.line(line)), span, files)
    }

    /// Goes on after a problem, to find others: where the tool is now is not known.
    fn go_on(&mut self, block: &Block) {
        self.seen.uncertain = true;
        self.pending.nurbs = None;
        self.pending.plane = None;
        self.track.leave([true; 3]);
        let cycle = matches!(self.modes.motion, Some(crate::gcode::codes::MotionMode::Cycle(_)));
        if cycle || !self.rules.lenient || block.has('G') {
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
            self.seen.begun = true;
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
        if line.as_bytes().get(cursor.at) == Some(&b'/') && self.rules.block_delete {
            self.track.note("optional blocks (`/`) are skipped");
            return Ok(Step::Next);
        }
        let call = okuma::call(line).filter(|call| self.has_user_task() && call.trim_start().starts_with("OO"));
        if let Some(call) = call {
            self.track.begin_block();
            return self
                .call_okuma(call)
                .map(|()| Step::Next)
                .map_err(|problem| (problem, 0..line.len()));
        }
        if self.has_user_task()
            && let Some(statement) = user_task::statement(line)
        {
            self.seen.begun = true;
            block.clear();
            return self.user_task(statement, here, block);
        }
        if let Some(cursor) = after_letter(line) {
            self.seen.begun = true;
            block.clear();
            return self.labelled(cursor, here);
        }
        skip_head(&mut cursor);
        if is_statement(cursor) {
            self.seen.begun = true;
            block.clear();
            return self.statement(cursor, here);
        }
        words::read(line, self, block)?;
        if block.tape {
            let ends = self.seen.begun && self.calls.levels.len() == 1;
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
        self.seen.begun = true;
        self.track.begin_block();
        self.perform(block, here)
    }
}
