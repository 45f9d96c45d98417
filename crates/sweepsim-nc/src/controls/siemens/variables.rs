//! Variables, and calls of subprograms.

use std::rc::Rc;

use super::interpreter::{Level, MOST_VARIABLES, Reader};
use super::language::expression::{self, Expression, Value};
use super::language::structures::Item;
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
        let place = match self.stack.iter_mut().rev().find(|level| known(level)) {
            Some(level) => &mut level.locals,
            None => &mut self.globals,
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

    pub(super) fn call(&mut self, name: &str, arguments: Vec<Value>, times: usize) -> Result<(), NcProblem> {
        let Some(&routine) = self.names.get(name) else {
            return Ok(());
        };
        if self.stack.len() > DEEPEST_CALL {
            return Err(NcProblem::syntax(format!(
                "{name} is called within itself or too deeply: expected at most {DEEPEST_CALL} levels"
            )));
        }
        let mut values = arguments.into_iter();
        let locals = self.routines[routine].parameters.iter().cloned();
        let locals = locals
            .map(|name| (name, values.next().unwrap_or(Value::Number(0.0))))
            .collect();
        self.track.calls()?;
        self.stack.push(Level::new(routine, locals, times));
        Ok(())
    }
}
