//! Okuma's user task: what its statements do.

use super::super::interpreter::{Reader, Step};
use super::calls::{CallKind, SourceLine};
use crate::gcode::flow::keywords::Label;
use crate::gcode::syntax::block::{Block, Target};
use crate::gcode::syntax::cursor::Cursor;
use crate::gcode::syntax::expression::Values;
use crate::gcode::syntax::user_task::Statement;
use crate::gcode::syntax::words;
use crate::model::read_options::Controller;
use crate::text::error::{Located, NcProblem};

impl Reader {
    /// A line that has more than words. The places of problems are its whole line.
    pub(crate) fn user_task(
        &mut self,
        statement: Statement,
        here: SourceLine,
        block: &mut Block,
    ) -> Result<Step, Located> {
        let whole = |(problem, _): Located| (problem, 0..usize::MAX);
        let fail = |problem| (problem, 0..usize::MAX);
        match statement {
            Statement::Words(text) => {
                words::read(&text, self, block).map_err(whole)?;
                self.track.begin_block();
                self.perform(block, here).map_err(whole)
            }
            Statement::Jump { condition, label } => {
                let holds = match &condition {
                    Some(text) => Values::new(Cursor::new(text), self).bracket().map_err(whole)?,
                    None => Some(1.0),
                };
                if holds.unwrap_or(0.0) == 0.0 {
                    return Ok(Step::Next);
                }
                let number = label[1..].parse::<u32>().ok();
                let labels = self.texts.sources[here.source].labels();
                let line = match number {
                    Some(number) => labels.number(number, here.line),
                    None => labels.named(&label, here.line),
                };
                match line {
                    Some(line) if line <= here.line => Ok(self.turn(SourceLine { line, ..here })),
                    Some(line) => Ok(Step::Jump(SourceLine { line, ..here })),
                    None => Err(fail(NcProblem::syntax(format!("there is no block {label} to go to")))),
                }
            }
            Statement::Call { name, times, arguments } => {
                let mut values = Vec::new();
                for (name, text) in arguments {
                    let value = Values::new(Cursor::new(&text), self).expression().map_err(whole)?;
                    values.push((name, value));
                }
                self.call_named(&name, times, values, here).map_err(fail)
            }
            Statement::Return => self.leave_program(&Block::default(), here).map_err(fail),
            Statement::Name => Ok(Step::Next),
            Statement::Ignored(name) => {
                self.track.note(format!("{name} moves nothing: ignored"));
                Ok(Step::Next)
            }
        }
    }

    /// `CALL OSUB PA=5`: the arguments are variables of the subprogram.
    fn call_named(
        &mut self,
        name: &str,
        times: u32,
        arguments: Vec<(String, Option<f64>)>,
        here: SourceLine,
    ) -> Result<Step, NcProblem> {
        if times == 0 {
            return Ok(Step::Next);
        }
        let label = match name.parse::<u32>() {
            Ok(number) => Label::Number(number),
            Err(_) => Label::Name(name.to_owned()),
        };
        let spot = match self.find(&label, here.source, None) {
            Ok(spot) => spot,
            Err(_) => {
                self.track
                    .leave_out_program(&format!("O{name}"), &format!("O{name}.SUB"))?;
                return Ok(Step::Next);
            }
        };
        let start = SourceLine {
            line: spot.line + 1,
            ..spot
        };
        let level = self.level_with_names(CallKind::Program { start, left: times });
        let step = self.enter(level, start, here)?;
        for (name, value) in arguments {
            if value.is_some() {
                self.assign(&Target::Name(name), value)?;
            }
        }
        Ok(step)
    }

    /// Whether lines may have more than words.
    pub(crate) fn has_user_task(&self) -> bool {
        self.rules.controller == Some(Controller::Okuma)
    }
}
