//! Subprograms: where they are, and how they are called and left.

use std::collections::BTreeMap;

use super::super::interpreter::{Reader, Step};
use super::variables::Locals;
use crate::gcode::flow::keywords::{Keyword, Label};
use crate::gcode::modes::Modes;
use crate::gcode::syntax::block::Block;
use crate::model::program::Call;
use crate::text::error::NcProblem;

/// Calls within calls, at most.
pub(super) const DEEPEST: usize = 100;

/// A line of one of the texts, both from 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct SourceLine {
    pub source: usize,
    pub line: usize,
}

/// What is being executed.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) enum CallKind {
    #[default]
    Main,
    /// A subroutine of LinuxCNC.
    Subroutine(Label),
    /// M98, M97 and G65: where it starts, and how often it is still to be executed.
    Program { start: SourceLine, left: u32 },
}

/// A call that has not returned yet.
#[derive(Clone, Debug, Default)]
pub(crate) struct CallLevel {
    pub kind: CallKind,
    /// Where to go on afterwards.
    pub back: SourceLine,
    /// The call, in the program's list.
    pub call: Option<u32>,
    /// What it has to restore.
    locals: Option<(Box<Locals>, usize)>,
    named: Option<BTreeMap<String, f64>>,
    pub modes: Option<Box<Modes>>,
    /// Whether the modes are restored on return (M73).
    pub restore_modes: bool,
    /// How often each loop (by its line) is still to be executed.
    pub repeats: BTreeMap<usize, u64>,
    /// Fanuc's open loops: the number and the line of each.
    pub loops: Vec<(u32, usize)>,
}

/// The calls on their way.
pub(crate) struct Calls {
    pub levels: Vec<CallLevel>,
    /// The block of G66, and how deep in calls it is.
    pub modal: Option<(Block, usize)>,
    /// By the file and the line of the call, and the call within which it is.
    numbers: BTreeMap<(usize, usize, Option<u32>), u32>,
    /// Where the last jump backwards led.
    pub turned: Option<SourceLine>,
}

/// Fanuc's letters for the arguments of a macro, and their variables.
const ARGUMENTS: [(char, usize); 21] = [
    ('A', 1),
    ('B', 2),
    ('C', 3),
    ('D', 7),
    ('E', 8),
    ('F', 9),
    ('H', 11),
    ('I', 4),
    ('J', 5),
    ('K', 6),
    ('M', 13),
    ('Q', 17),
    ('R', 18),
    ('S', 19),
    ('T', 20),
    ('U', 21),
    ('V', 22),
    ('W', 23),
    ('X', 24),
    ('Y', 25),
    ('Z', 26),
];

/// Sets of I, J and K in one call, at most.
const SETS: usize = 10;

impl Default for Calls {
    fn default() -> Self {
        Self {
            levels: vec![CallLevel::default()],
            modal: None,
            numbers: BTreeMap::new(),
            turned: None,
        }
    }
}

impl Reader {
    pub(crate) fn level(&mut self) -> &mut CallLevel {
        // There is always the level of the main program.
        if self.calls.levels.is_empty() {
            self.calls.levels.push(CallLevel::default());
        }
        let last = self.calls.levels.len() - 1;
        &mut self.calls.levels[last]
    }

    /// Calls a subroutine of LinuxCNC.
    pub(crate) fn call_subroutine(
        &mut self,
        label: Label,
        arguments: &[f64],
        here: SourceLine,
    ) -> Result<Step, NcProblem> {
        let spot = self.find(&label, here.source, Some(Keyword::Sub))?;
        self.end_of_subroutine(&label, spot)?;
        let mut locals = [Some(0.0); 34];
        for (local, argument) in locals[1..31].iter_mut().zip(arguments) {
            *local = Some(*argument);
        }
        let saved = self.variables.locals;
        locals[0] = None;
        locals[31..].copy_from_slice(&saved[31..]);
        self.variables.locals = locals;
        let level = CallLevel {
            kind: CallKind::Subroutine(label),
            locals: Some((Box::new(saved), 31)),
            named: Some(std::mem::take(&mut self.variables.named)),
            ..CallLevel::default()
        };
        self.enter(
            level,
            SourceLine {
                line: spot.line + 1,
                ..spot
            },
            here,
        )
    }

    /// M98, M97.
    pub(crate) fn call_program(
        &mut self,
        block: &Block,
        by_block_number: bool,
        here: SourceLine,
    ) -> Result<Step, NcProblem> {
        let code = if by_block_number { "M97" } else { "M98" };
        let Some(p) = block.get('P') else {
            return Err(NcProblem::syntax(format!(
                "{code} without P: expected the number of a subprogram"
            )));
        };
        let expected = "a whole number from 0 to 99999999";
        let mut number = NcProblem::whole(format!("P of {code}"), p, 0..=99_999_999, expected)?;
        let mut times = self.times(block)?;
        // Fanuc's short form: P51002 is five times O1002.
        if !by_block_number
            && number > 9999
            && !block.has('L')
            && self.find_in_texts(&Label::Number(number), here.source).is_none()
        {
            times = number / 10_000;
            number %= 10_000;
        }
        if times == 0 {
            return Ok(Step::Next);
        }
        let start = if by_block_number {
            let line = self.texts.sources[here.source].labels().number(number, here.line);
            let line = line.ok_or_else(|| NcProblem::syntax(format!("M97 P{number}: there is no block N{number}")))?;
            SourceLine { line, ..here }
        } else {
            match self.find(&Label::Number(number), here.source, None) {
                Ok(spot) => SourceLine {
                    line: spot.line + 1,
                    ..spot
                },
                Err(problem) => return self.without_macro(number, block, problem),
            }
        };
        let level = CallLevel {
            kind: CallKind::Program { start, left: times },
            ..CallLevel::default()
        };
        self.enter(level, start, here)
    }

    /// G65.
    pub(crate) fn call_macro(&mut self, block: &Block, here: SourceLine) -> Result<Step, NcProblem> {
        let Some(p) = block
            .get('P')
            .filter(|p| p.fract() == 0.0 && (0.0..=99_999_999.0).contains(p))
        else {
            return Err(NcProblem::syntax("G65 without the number of a program: expected P"));
        };
        let times = self.times(block)?;
        let spot = match self.find(&Label::Number(p as u32), here.source, None) {
            Ok(spot) => spot,
            Err(problem) => return self.without_macro(p as u32, block, problem),
        };
        let mut locals: Locals = [None; 34];
        let after = block.span('P').end;
        // Argument specification II has several sets of I, J and K. It may be mixed with I: the last word of a variable counts.
        let (mut set, mut last) = (0, 0);
        let arguments = block.words().iter().filter(|word| word.span().start >= after);
        for word in arguments.filter(|word| word.letter != 'L') {
            let place = match ARGUMENTS.iter().find(|(letter, _)| *letter == word.letter) {
                Some(&(letter @ 'I'..='K', place)) => {
                    set += usize::from(set == 0 || place <= last);
                    if set > SETS {
                        return Err(NcProblem::value(
                            format!("the number of {letter} in a macro call"),
                            set,
                            "at most 10",
                        ));
                    }
                    last = place;
                    place + 3 * (set - 1)
                }
                Some(&(_, place)) => place,
                None => {
                    return Err(NcProblem::syntax(format!(
                        "{} cannot be an argument of a macro call",
                        word.letter
                    )));
                }
            };
            locals[place] = Some(word.value);
        }
        if times == 0 {
            return Ok(Step::Next);
        }
        let saved = std::mem::replace(&mut self.variables.locals, locals);
        let start = SourceLine {
            line: spot.line + 1,
            ..spot
        };
        let level = CallLevel {
            kind: CallKind::Program { start, left: times },
            locals: Some((Box::new(saved), 34)),
            ..CallLevel::default()
        };
        self.enter(level, start, here)
    }

    /// G66: calls the macro after each block that moves, as G65 does, until G67. Moves within the macro do not call it again.
    pub(crate) fn begin_modal_macro(&mut self, block: &Block) -> Result<Step, NcProblem> {
        if self.calls.modal.is_some() {
            return Err(NcProblem::unsupported(
                "a modal macro call within another one is",
                "expected G67 before it",
            ));
        }
        if block.get('P').is_none() {
            return Err(NcProblem::syntax("G66 without the number of a program: expected P"));
        }
        // Calls return to the level they were made from: the main program's is the first.
        self.level();
        self.calls.modal = Some((block.clone(), self.calls.levels.len()));
        Ok(Step::Next)
    }

    /// How often to execute it: L.
    fn times(&self, block: &Block) -> Result<u32, NcProblem> {
        let l = block.get('L').unwrap_or(1.0);
        NcProblem::whole(
            "the number of repeats L",
            l,
            0..=99_999,
            "a whole number from 0 to 99999",
        )
    }

    /// A level with named variables of its own.
    pub(super) fn level_with_names(&mut self, kind: CallKind) -> CallLevel {
        CallLevel {
            kind,
            named: Some(std::mem::take(&mut self.variables.named)),
            ..CallLevel::default()
        }
    }

    pub(super) fn enter(&mut self, mut level: CallLevel, to: SourceLine, here: SourceLine) -> Result<Step, NcProblem> {
        if self.calls.levels.len() > DEEPEST {
            self.leave_level(level);
            return Err(NcProblem::syntax(format!(
                "calls within calls are more than {DEEPEST} deep: a subprogram calls itself without end"
            )));
        }
        let parent = self.level().call;
        let key = (self.track.place.file, self.track.place.line, parent);
        let next = self.track.program.calls.len() as u32;
        let call = *self.calls.numbers.entry(key).or_insert(next);
        if call == next {
            self.track.program.calls.push(Call::new(key.0, key.1, parent));
        }
        level.call = Some(call);
        level.back = SourceLine {
            line: here.line + 1,
            ..here
        };
        self.calls.levels.push(level);
        Ok(Step::Jump(to))
    }

    /// Restores what a call has saved.
    fn leave_level(&mut self, level: CallLevel) {
        if let Some((saved, count)) = level.locals {
            self.variables.locals[..count].copy_from_slice(&saved[..count]);
        }
        if let Some(named) = level.named {
            self.variables.named = named;
        }
        if let (true, Some(modes)) = (level.restore_modes, level.modes) {
            self.modes = *modes;
        }
    }

    /// Returns from a subroutine of LinuxCNC.
    pub(crate) fn leave_subroutine(&mut self, value: Option<f64>) -> Result<Step, NcProblem> {
        if !matches!(self.level().kind, CallKind::Subroutine(_)) {
            return Err(NcProblem::syntax(
                "this ends a subroutine that was not called by `O… call`: a subprogram called by M98 ends with M99",
            ));
        }
        let Some(level) = self.calls.levels.pop() else {
            return Ok(Step::Next);
        };
        let back = level.back;
        self.leave_level(level);
        self.variables.set_returned(value);
        Ok(Step::Jump(back))
    }

    /// M99.
    pub(crate) fn leave_program(&mut self, block: &Block, here: SourceLine) -> Result<Step, NcProblem> {
        let number = |p: f64| NcProblem::whole("P of M99", p, 0..=100_000_000, "the number of a block");
        let to_number = block.get('P').map(number).transpose()?;
        let jump = |reader: &Self, from: SourceLine| match to_number {
            None => Ok(Step::Jump(from)),
            Some(number) => match reader.texts.sources[from.source].labels().number(number, from.line) {
                Some(line) => Ok(Step::Jump(SourceLine { line, ..from })),
                None => Err(NcProblem::syntax(format!(
                    "M99 P{number}: there is no block N{number} to return to"
                ))),
            },
        };
        match &mut self.level().kind {
            CallKind::Main if to_number.is_some() => jump(self, here),
            CallKind::Main => {
                self.track
                    .note("M99 ends the program here; a machine may start it again");
                Ok(Step::End)
            }
            CallKind::Subroutine(label) => Err(NcProblem::syntax(format!(
                "M99 in a subroutine that was called by `{label} call`: expected `{label} endsub` or `{label} return`"
            ))),
            CallKind::Program { start, left } if *left > 1 && to_number.is_none() => {
                *left -= 1;
                Ok(Step::Jump(*start))
            }
            CallKind::Program { .. } => {
                let Some(level) = self.calls.levels.pop() else {
                    return Ok(Step::End);
                };
                let back = level.back;
                self.leave_level(level);
                jump(self, back)
            }
        }
    }
}
