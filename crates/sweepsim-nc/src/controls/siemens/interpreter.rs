//! Runs a program: jumps, loops, calls and variables.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use super::language::cursor::changes_by_m6;
use super::language::expression::{self, Expression, Value};
use super::language::routine::{Routine, parts};
use super::language::structures::{Call, Item, Statement};
use super::state::{Contours, Frames, Level, Modes, Section};
use crate::controls::run::{self, BlockIndex, DEEPEST_CALL, Library, Running};
use crate::drive::{Sense, Track};
use crate::model::names::Format;
use crate::model::program::Program;
use crate::model::read_options::{Controller, ReadOptions};
use crate::text::error::{Located, NcError, NcProblem};
use crate::text::kept::KeptText;
use crate::tools::comments;

/// The most variables.
pub(super) const MOST_VARIABLES: usize = 100_000;

pub(super) struct Reader<'a> {
    pub track: Track,
    pub modes: Modes,
    pub frames: Frames,
    pub options: &'a ReadOptions,
    pub(super) library: Library<'a>,
    pub(super) routines: Vec<Routine>,
    pub(super) names: BTreeMap<String, usize>,
    pub(super) stack: Vec<Level>,
    pub(super) globals: BTreeMap<String, Value>,
    /// After a problem: what the program has said so far is not fully known.
    pub uncertain: bool,
    pub ended: bool,
    /// Variables that the block has asked for, and nothing sets.
    pub(super) asked: RefCell<BTreeSet<String>>,
    pub(super) contours: Contours,
    /// What a subprogram that has ended could not give back.
    pub(super) broken: Option<NcProblem>,
    /// A call to make after the block.
    pub pending: Option<Call>,
}

pub(crate) fn read(text: &Rc<String>, options: &ReadOptions, library: Library) -> Result<Program, NcError> {
    options.check()?;
    let mut reader = Reader {
        track: Track::new(options, Sense::Tool),
        modes: Modes::new(options),
        frames: Frames::new(options),
        options,
        library,
        routines: Vec::new(),
        names: BTreeMap::new(),
        stack: Vec::new(),
        globals: BTreeMap::new(),
        uncertain: false,
        ended: false,
        asked: RefCell::default(),
        contours: Contours::default(),
        broken: None,
        pending: None,
    };
    reader.add(Rc::clone(text), 0);
    reader.stack.push(Level::new(0, 1));
    reader.track.describe_tools(text);
    run::run(&mut reader, text, options)?;
    let names = std::mem::take(&mut reader.modes.tools);
    let mut program = reader.track.finish();
    program.format = Some(Format::Gcode);
    program.controller = Some(Controller::Siemens);
    let comments = comments::read(text, program.units.in_mm());
    program.tools = comments.tools;
    comments::name_tools(&mut program, &names);
    program.stock = program.stock.or(comments.stock);
    Ok(program)
}

impl Running for Reader<'_> {
    fn track(&mut self) -> &mut Track {
        &mut self.track
    }

    /// The next line to run, back to the calling program where one ends.
    fn advance(&mut self) -> Option<BlockIndex> {
        while !self.ended {
            let level = self.stack.last_mut()?;
            if let Some(section) = level.sections.last_mut()
                && level.next == section.end
            {
                section.times -= 1;
                if section.times > 0 {
                    level.next = section.from;
                } else {
                    level.next = section.then;
                    level.sections.pop();
                    self.track.returns();
                    continue;
                }
            }
            let routine = &self.routines[level.routine];
            if level.next >= routine.len() {
                self.back();
                continue;
            }
            let index = level.next;
            level.next += 1;
            self.track.place.file = routine.file;
            self.track.place.line = routine.first_line() + index;
            return Some((level.routine, index));
        }
        None
    }

    fn run(&mut self, (routine, index): BlockIndex) -> Result<(), Located> {
        if let Some(problem) = self.broken.take() {
            return Err((problem, self.whole((routine, index))));
        }
        let result = self.line(routine, index);
        self.say_asked();
        result
    }

    fn doubt(&mut self) {
        self.uncertain = true;
    }

    fn line_of(&self, (routine, index): BlockIndex) -> (usize, usize, &str) {
        let routine = &self.routines[routine];
        (routine.file, routine.first_line() + index, routine.text(index))
    }

    fn whole(&self, (routine, index): BlockIndex) -> std::ops::Range<usize> {
        0..self.routines[routine].text(index).len()
    }
}

impl Reader<'_> {
    /// Adds the programs of a text. The first is the main one.
    pub(super) fn add(&mut self, text: Rc<String>, file: usize) {
        self.modes.changes_by_m6 |= changes_by_m6(&text);
        let text = Rc::new(KeptText::new(text));
        for (name, lines) in parts(&text) {
            self.names.entry(name).or_insert(self.routines.len());
            self.routines.push(Routine::new(file, Rc::clone(&text), lines));
        }
    }

    /// Ends the current program.
    pub fn back(&mut self) {
        let Some(level) = self.stack.last_mut() else { return };
        for _ in level.sections.drain(..) {
            self.track.returns();
        }
        if level.times > 1 {
            level.times -= 1;
            level.next = 0;
            return;
        }
        let ended = self.stack.pop();
        if self.stack.is_empty() {
            self.ended = true;
        } else {
            self.track.returns();
        }
        if let Some(Err(problem)) = ended.map(|level| self.give_back(level)) {
            self.broken = Some(problem);
        }
    }

    /// The text of the block that runs now.
    pub fn current_text(&self) -> &str {
        let Some(level) = self.stack.last() else { return "" };
        let routine = &self.routines[level.routine];
        let index = self.track.place.line.saturating_sub(routine.first_line());
        routine.text(index)
    }

    fn jump(&mut self, to: usize) {
        if let Some(level) = self.stack.last_mut() {
            // A jump out of a repeated section ends it.
            while level
                .sections
                .last()
                .is_some_and(|section| !(section.from..section.end).contains(&to))
            {
                level.sections.pop();
                self.track.returns();
            }
            level.next = to;
        }
    }

    fn line(&mut self, routine: usize, index: usize) -> Result<(), Located> {
        let line = self.routines[routine].line(index)?;
        if line.skipped {
            if self.options.block_delete {
                return Ok(());
            }
            self.track.note("optional blocks (`/`) are executed");
        }
        let true_of = |reader: &Self, condition: &Expression| Ok::<bool, Located>(reader.number(condition)? != 0.0);
        match &line.statement {
            Statement::Block(items) => {
                if !items.is_empty() {
                    self.block(items)?;
                    if let Some(call) = self.pending.take() {
                        self.call(call)
                            .map_err(|problem| (problem, self.whole((routine, index))))?;
                    }
                }
            }
            Statement::Goto(search, label) => {
                let to = self.routines[routine].find(label, index, *search)?;
                self.jump(to);
            }
            Statement::IfGoto(condition, search, label) => {
                if true_of(self, condition)? {
                    let to = self.routines[routine].find(label, index, *search)?;
                    self.jump(to);
                }
            }
            Statement::If(condition) => {
                let other = self.routines[routine].partner(index, "ENDIF")?;
                if !true_of(self, condition)? {
                    self.jump(other + 1);
                }
            }
            Statement::Else => {
                let end = self.routines[routine].partner(index, "ENDIF")?;
                self.jump(end + 1);
            }
            Statement::EndIf | Statement::Repeat | Statement::Loop | Statement::Declaration => {}
            Statement::While(condition) => {
                let end = self.routines[routine].partner(index, "ENDWHILE")?;
                if !true_of(self, condition)? {
                    self.jump(end + 1);
                }
            }
            Statement::For(first, last) => {
                let end = self.routines[routine].partner(index, "ENDFOR")?;
                self.block(first)?;
                if self.count(first)? > self.number(last)? {
                    self.jump(end + 1);
                }
            }
            Statement::EndLoop(kind) => {
                let start = self.routines[routine].partner(index, kind)?;
                let begins = self.routines[routine].line(start);
                let again = match begins.as_ref().map(|line| &line.statement) {
                    Ok(Statement::For(first, last)) => {
                        let next = self.count(first)? + 1.0;
                        if let Some(Item::Set { name, indices, .. }) = first.first() {
                            let key = expression::key(name, indices, &|name| self.lookup(name))?;
                            self.assign(key, Value::Number(next))
                                .map_err(|problem| (problem, 0..0))?;
                        }
                        if next <= self.number(last)? {
                            start + 1
                        } else {
                            index + 1
                        }
                    }
                    _ => start,
                };
                self.jump(again);
            }
            Statement::Until(condition) => {
                let start = self.routines[routine].partner(index, "REPEAT before it")?;
                if !true_of(self, condition)? {
                    self.jump(start);
                }
            }
            Statement::RepeatLabel { from, to, times, block } => {
                let section = self.routines[routine].section(from, to.as_deref(), *block, index)?;
                let times = times.as_ref().map_or(Ok(1.0), |times| self.number(times))?;
                if !(times >= 0.0 && times.fract() == 0.0) {
                    let problem = NcProblem::value("the number of repeats P", times, "a whole number from 0 on");
                    return Err((problem, self.whole((routine, index))));
                }
                if times >= 1.0 && !section.is_empty() {
                    self.track
                        .calls()
                        .map_err(|problem| (problem, self.whole((routine, index))))?;
                    if let Some(level) = self.stack.last_mut() {
                        if level.sections.len() > DEEPEST_CALL {
                            let problem = NcProblem::syntax("repeats within repeats: nested too deeply");
                            return Err((problem, self.whole((routine, index))));
                        }
                        level.sections.push(Section {
                            from: section.start,
                            end: section.end,
                            times: times as usize,
                            then: index + 1,
                        });
                        level.next = section.start;
                    }
                }
            }
            Statement::Case(value, cases, otherwise) => {
                let value = value.value(&|name| self.lookup(name))?;
                let mut to = otherwise.as_ref().map(|(search, label)| (*search, label));
                for (constant, search, label) in cases {
                    if constant.value(&|name| self.lookup(name))? == value {
                        to = Some((*search, label));
                        break;
                    }
                }
                if let Some((search, label)) = to {
                    let to = self.routines[routine].find(label, index, search)?;
                    self.jump(to);
                }
            }
            Statement::Define(variables, kind) => {
                for (name, value) in variables {
                    let value = match value {
                        Some(value) => kind.held(value.value(&|name| self.lookup(name))?),
                        None => kind.nothing(),
                    };
                    if let Some(level) = self.stack.last_mut()
                        && level.locals.len() < MOST_VARIABLES
                    {
                        level.define(name.clone(), value, *kind);
                    }
                }
            }
            // Its parameters are set by the call.
            Statement::Proc(_) => {}
        }
        Ok(())
    }
}
