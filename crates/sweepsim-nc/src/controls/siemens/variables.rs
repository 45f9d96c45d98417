//! Variables, and calls of subprograms.

use std::rc::Rc;

use super::interpreter::{MOST_VARIABLES, Reader};
use super::language::expression::{self, Expression, Kind, Value};
use super::language::structures::{Call, Item};
use super::state::{Level, Modal, Modes, SavedModes};
use crate::controls::run::DEEPEST_CALL;
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcProblem};

impl Reader<'_> {
    /// The counter of a FOR loop.
    pub(super) fn count(&self, first: &[Item]) -> Result<f64, Located> {
        match first {
            [
                Item::Set {
                    name, indices, span, ..
                },
            ] => {
                let key = expression::key(name, indices, &|name| self.lookup(name))?;
                match self.lookup(&key).map_err(|problem| (problem, span.clone()))? {
                    Value::Number(number) => Ok(number),
                    Value::Text(_) => Err((
                        NcProblem::syntax("a text as a counter: expected a number"),
                        span.clone(),
                    )),
                }
            }
            [Item::Word { span, .. } | Item::Key { span, .. }] => {
                Err((NcProblem::syntax("expected a variable as the counter"), span.clone()))
            }
            _ => Ok(0.0),
        }
    }

    pub fn number(&self, expression: &Expression) -> Result<f64, Located> {
        expression.as_number(&|name| self.lookup(name))
    }

    pub fn lookup(&self, name: &str) -> Result<Value, NcProblem> {
        let local = self.stack.iter().rev().find_map(|level| level.locals.get(name));
        if let Some(value) = local.or_else(|| self.globals.get(name)) {
            return Ok(value.clone());
        }
        if name.starts_with('$') {
            if self.track.strict() {
                return Err(NcProblem::unsupported(
                    format!("the system variable {name} is"),
                    "only the control knows it; expected a number",
                ));
            }
            return Ok(self.without_value(name));
        }
        // R parameters are 0 unless set; elements of arrays too.
        let parameter = name
            .strip_prefix('R')
            .is_some_and(|digits| !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit()));
        if parameter {
            return Ok(Value::Number(0.0));
        }
        if let Some((array, _)) = name.split_once('[')
            && let Some(value) = self.stack.iter().rev().find_map(|level| level.locals.get(array))
        {
            return Ok(value.clone());
        }
        if self.track.strict() {
            return Err(NcProblem::syntax(format!(
                "the variable {name} has no value here: expected DEF and a value before it"
            )));
        }
        Ok(self.without_value(name))
    }

    /// Whether a variable of this name has been defined, or has a value.
    pub(super) fn is_variable(&self, name: &str) -> bool {
        self.stack.iter().any(|level| level.locals.contains_key(name)) || self.globals.contains_key(name)
    }

    /// What nothing sets, or only the control knows, is 0: it is said after the block.
    fn without_value(&self, name: &str) -> Value {
        self.asked.borrow_mut().insert(name.to_owned());
        Value::Number(0.0)
    }

    /// Says which variables the block has asked for in vain.
    pub(super) fn say_asked(&mut self) {
        for name in std::mem::take(self.asked.get_mut()) {
            let settle = format!("{name} = … in the program, or the program that calls this one");
            let taken = if name.starts_with('$') {
                "0: only the control knows it"
            } else {
                "0: nothing sets it"
            };
            let assumption = Assumption::new(format!("the value of {name}"), taken, settle);
            self.track.assume(assumption);
        }
    }

    pub fn assign(&mut self, name: String, value: Value) -> Result<(), NcProblem> {
        // Timers, markers and outputs move nothing, and neither does the radius of a tool's edge by itself.
        const STORED: [&str; 7] = [
            "$TC_DP6[",
            "$AC_TIMER",
            "$AC_MARKER",
            "$AC_PARAM",
            "$A_OUT",
            "$A_DB",
            "$AN_",
        ];
        if name.starts_with('$') && !STORED.iter().any(|stored| name.starts_with(stored)) {
            return Err(NcProblem::unsupported(
                format!("setting the system variable {name} is"),
                "it could move frames or axes; expected a program without it",
            ));
        }
        let array = name.split_once('[').map(|(array, _)| array.to_owned());
        let known = |level: &Level| {
            level.locals.contains_key(&name) || array.as_ref().is_some_and(|array| level.locals.contains_key(array))
        };
        let (place, value) = match self.stack.iter_mut().rev().find(|level| known(level)) {
            Some(level) => {
                let value = level.held(&name, value);
                (&mut level.locals, value)
            }
            None => (&mut self.globals, value),
        };
        if place.len() >= MOST_VARIABLES && !place.contains_key(&name) {
            return Err(NcProblem::value("the number of variables", MOST_VARIABLES, "smaller"));
        }
        place.insert(name, value);
        Ok(())
    }

    /// Whether there is a subprogram of this name, read if need be.
    pub fn knows(&mut self, name: &str) -> bool {
        if self.names.contains_key(name) {
            return true;
        }
        let Some((file, text)) = (self.library)(name) else {
            return false;
        };
        let index = self.track.add_file(file);
        self.names.insert(name.to_owned(), self.routines.len());
        self.add(Rc::new(text), index);
        true
    }

    pub(super) fn call(&mut self, call: Call) -> Result<(), NcProblem> {
        let Some(&routine) = self.names.get(&call.name) else {
            return Ok(());
        };
        if self.stack.len() > DEEPEST_CALL {
            return Err(NcProblem::syntax(format!(
                "{} is called within itself or too deeply: expected at most {DEEPEST_CALL} levels",
                call.name
            )));
        }
        let mut level = Level::new(routine, call.times);
        level.called_modally = call.modally;
        let head = &self.routines[routine].head;
        let (mut values, mut variables) = (call.values.into_iter(), call.variables.into_iter());
        for parameter in &head.parameters {
            let value = values.next().unwrap_or_else(|| parameter.kind.nothing());
            let value = parameter.kind.held(value);
            level.define(parameter.name.clone(), value, parameter.kind);
            if let Some(Some(variable)) = variables.next().filter(|_| parameter.by_reference) {
                level.returned.push((parameter.name.clone(), variable));
            }
        }
        level.saved = head.saves.then(|| Box::new(self.saved_modes()));
        self.track.calls()?;
        self.stack.push(level);
        Ok(())
    }

    /// `MCALL` with a cycle or a subprogram.
    pub(super) fn call_modally(&mut self, modal: Modal) {
        self.modes.modal_call = Some(modal);
        self.modes.modal_depth = self.stack.len();
    }

    /// What the caller has of a program that has ended: the values of its parameters by reference, and the modes before it.
    pub(super) fn give_back(&mut self, level: Level) -> Result<(), NcProblem> {
        if self.modes.modal_depth > self.stack.len() && !self.stack.is_empty() && self.modes.modal_call.take().is_some()
        {
            let taken = "no: it ends with it";
            let what = "whether a modal call goes on after the subprogram that has made it";
            self.track.assume(Assumption::new(what, taken, "MCALL at its end"));
        }
        for (parameter, variable) in level.returned {
            if let Some(value) = level.locals.get(&parameter).cloned() {
                self.assign(variable, value)?;
            }
        }
        level.saved.map_or(Ok(()), |saved| self.restore_modes(*saved))
    }

    /// The arguments that are variables, by their names with indices.
    pub(super) fn variables_among(
        &self,
        arguments: Option<&[Option<Expression>]>,
    ) -> Result<Vec<Option<String>>, Located> {
        let key = |argument: &Expression| match &argument.kind {
            Kind::Variable(name, indices) => expression::key(name, indices, &|name| self.lookup(name)).map(Some),
            _ => Ok(None),
        };
        let all = arguments.unwrap_or(&[]).iter();
        all.map(|argument| argument.as_ref().map_or(Ok(None), key)).collect()
    }

    pub(super) fn saved_modes(&self) -> SavedModes {
        SavedModes {
            motion: self.modes.motion,
            plane: self.modes.plane,
            absolute: self.modes.absolute,
            inch: self.modes.inch,
            exact_stop: self.modes.exact_stop,
            corners: self.modes.corners,
            round_ends: self.modes.round_ends,
            feed_mode: self.track.feed_mode,
            offset: self.frames.work.active,
            programmed: self.frames.programmed,
        }
    }

    pub(super) fn restore_modes(&mut self, saved: SavedModes) -> Result<(), NcProblem> {
        self.modes = Modes {
            motion: saved.motion,
            plane: saved.plane,
            absolute: saved.absolute,
            inch: saved.inch,
            exact_stop: saved.exact_stop,
            corners: saved.corners,
            round_ends: saved.round_ends,
            ..std::mem::take(&mut self.modes)
        };
        self.track.feed_mode = saved.feed_mode;
        self.frames.work.active = saved.offset;
        self.frames.programmed = saved.programmed;
        self.apply_frames()
    }
}
