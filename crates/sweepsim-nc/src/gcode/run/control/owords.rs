//! LinuxCNC's O-words: subroutines, loops and branches.
//!
//! Source: *LinuxCNC G-code reference, O Codes*.

use super::super::interpreter::{Reader, Step};
use super::calls::{CallKind, SourceLine};
use crate::gcode::flow::keywords::{Keyword, Label, after_letter, keyword, label};
use crate::gcode::syntax::block::Block;
use crate::gcode::syntax::cursor::Cursor;
use crate::gcode::syntax::expression::Values;
use crate::gcode::syntax::{title, words};
use crate::text::error::{Located, NcProblem};

/// Arguments of a call, at most.
const MOST_ARGUMENTS: usize = 30;

impl Reader {
    /// A line that begins with `O`; the cursor is behind it.
    pub(crate) fn labelled(&mut self, mut cursor: Cursor, here: SourceLine) -> Result<Step, Located> {
        let start = cursor.at.saturating_sub(1);
        let name = match label(&mut cursor) {
            Some(name) => name,
            // A label that is computed: `o#1 call`, `o[#1 + 2] call`.
            None => {
                let mut values = Values::new(cursor, self);
                if !values.follows() {
                    return Err(cursor.unexpected("the number or the name of a subroutine after `O`"));
                }
                let (value, _) = values.value()?;
                cursor = values.cursor;
                let value = value.unwrap_or(0.0);
                let number = NcProblem::whole("the number of a subroutine", value, 0..=99_999_999, "a whole number");
                Label::Number(number.map_err(|problem| (problem, start..cursor.at))?)
            }
        };
        let Some(keyword) = keyword(&mut cursor) else {
            return self.program_number(&name, cursor, here);
        };
        let span = start..cursor.at;
        let at = |result: Result<Step, NcProblem>| result.map_err(|problem| (problem, span.clone()));
        match keyword {
            Keyword::Sub => at(self.skip_subroutine(&name, here)),
            Keyword::EndSub | Keyword::Return => {
                let value = self.optional_bracket(cursor)?;
                if let (Keyword::EndSub, CallKind::Subroutine(called)) = (keyword, &self.level().kind)
                    && *called != name
                {
                    let problem = format!("`{name} endsub` in the subroutine {called}: expected `{called} endsub`");
                    return Err((NcProblem::syntax(problem), span));
                }
                at(self.leave_subroutine(value))
            }
            Keyword::Call => {
                let arguments = self.arguments(cursor)?;
                at(self.call_subroutine(name, &arguments, here))
            }
            Keyword::If => {
                if self.condition(cursor)? {
                    Ok(Step::Next)
                } else {
                    self.next_branch(&name, here)
                }
            }
            // The branch before has been executed.
            Keyword::ElseIf | Keyword::Else => at(self.after(&name, here, &[Keyword::EndIf], "endif")),
            Keyword::EndIf | Keyword::Do => Ok(Step::Next),
            Keyword::While => {
                let go_on = self.condition(cursor)?;
                match (self.loop_start(&name, here), go_on) {
                    (Some(line), true) => Ok(self.turn(SourceLine { line: line + 1, ..here })),
                    (Some(_), false) | (None, true) => Ok(Step::Next),
                    (None, false) => at(self.after(&name, here, &[Keyword::EndWhile], "endwhile")),
                }
            }
            Keyword::EndWhile => match self.preceding(&name, here, Keyword::While) {
                Some(line) => Ok(self.turn(SourceLine { line, ..here })),
                None => at(Err(NcProblem::syntax(format!(
                    "`{name} endwhile` without `{name} while` before it"
                )))),
            },
            Keyword::Repeat => {
                let mut values = Values::new(cursor, self);
                let count = values.bracket()?.unwrap_or(0.0).round();
                if count < 1.0 {
                    return at(self.after(&name, here, &[Keyword::EndRepeat], "endrepeat"));
                }
                self.level().repeats.insert(here.line, count as u64);
                Ok(Step::Next)
            }
            Keyword::EndRepeat => {
                let Some(line) = self.preceding(&name, here, Keyword::Repeat) else {
                    let problem = format!("`{name} endrepeat` without `{name} repeat` before it");
                    return at(Err(NcProblem::syntax(problem)));
                };
                let left = self.level().repeats.entry(line).or_insert(1);
                *left = left.saturating_sub(1);
                if *left > 0 {
                    Ok(self.turn(SourceLine { line: line + 1, ..here }))
                } else {
                    Ok(Step::Next)
                }
            }
            Keyword::Break => at(self.after(
                &name,
                here,
                &[Keyword::EndWhile, Keyword::While, Keyword::EndRepeat],
                "endwhile",
            )),
            Keyword::Continue => {
                let ends = [Keyword::EndWhile, Keyword::While, Keyword::EndRepeat];
                match self.following(&name, here, &ends) {
                    Some(line) => Ok(Step::Jump(SourceLine { line, ..here })),
                    None => at(Err(NcProblem::syntax(format!("`{name} continue` outside of a loop")))),
                }
            }
        }
    }

    /// A jump backwards: loops end by a budget.
    pub(crate) fn turn(&mut self, to: SourceLine) -> Step {
        self.calls.turned = Some(to);
        Step::Jump(to)
    }

    fn following(&self, name: &Label, here: SourceLine, keywords: &[Keyword]) -> Option<usize> {
        let labels = self.texts.sources[here.source].labels();
        let found = labels
            .after(name, here.line)
            .find(|(_, keyword)| keywords.contains(keyword));
        found.map(|(line, _)| line)
    }

    fn preceding(&self, name: &Label, here: SourceLine, wanted: Keyword) -> Option<usize> {
        let labels = self.texts.sources[here.source].labels();
        let found = labels.before(name, here.line).find(|(_, keyword)| *keyword == wanted);
        found.map(|(line, _)| line)
    }

    fn after(&self, name: &Label, here: SourceLine, keywords: &[Keyword], end: &str) -> Result<Step, NcProblem> {
        match self.following(name, here, keywords) {
            Some(line) => Ok(Step::Jump(SourceLine { line: line + 1, ..here })),
            None => Err(NcProblem::syntax(format!("there is no `{name} {end}` after this line"))),
        }
    }

    /// The `do` of a loop that ends with this `while`.
    fn loop_start(&self, name: &Label, here: SourceLine) -> Option<usize> {
        let labels = self.texts.sources[here.source].labels();
        let ends = [Keyword::Do, Keyword::While, Keyword::EndWhile];
        let (line, keyword) = labels
            .before(name, here.line)
            .find(|(_, keyword)| ends.contains(keyword))?;
        (keyword == Keyword::Do).then_some(line)
    }

    fn skip_subroutine(&mut self, name: &Label, here: SourceLine) -> Result<Step, NcProblem> {
        let end = self.end_of_subroutine(name, here)?;
        if matches!(self.level().kind, CallKind::Subroutine(_)) {
            return Err(NcProblem::syntax(
                "a subroutine within a subroutine: expected one after the other",
            ));
        }
        Ok(Step::Jump(SourceLine { line: end + 1, ..here }))
    }

    /// The line where the subroutine that begins at a line ends.
    pub(crate) fn end_of_subroutine(&self, name: &Label, here: SourceLine) -> Result<usize, NcProblem> {
        let Some(end) = self.following(name, here, &[Keyword::EndSub]) else {
            return Err(NcProblem::syntax(format!(
                "there is no `{name} endsub` after the line where it begins"
            )));
        };
        match self.texts.sources[here.source]
            .labels()
            .subroutine_within(here.line, end)
        {
            Some(line) => Err(NcProblem::syntax(format!(
                "a subroutine within this one, in line {}: expected one after the other",
                line + 1
            ))),
            None => Ok(end),
        }
    }

    /// After an `if` that does not hold: the first `elseif` that does, or the `else`.
    fn next_branch(&mut self, name: &Label, here: SourceLine) -> Result<Step, Located> {
        let mut line = here.line;
        loop {
            let labels = self.texts.sources[here.source].labels();
            let ends = [Keyword::ElseIf, Keyword::Else, Keyword::EndIf];
            let Some((next, found)) = labels.after(name, line).find(|(_, keyword)| ends.contains(keyword)) else {
                let problem = NcProblem::syntax(format!("there is no `{name} endif` after this line"));
                return Err((problem, 0..usize::MAX));
            };
            line = next;
            if found != Keyword::ElseIf {
                return Ok(Step::Jump(SourceLine { line: line + 1, ..here }));
            }
            let source = std::rc::Rc::clone(&self.texts.sources[here.source]);
            let Some(mut cursor) = after_letter(source.line(line)) else {
                continue;
            };
            label(&mut cursor);
            keyword(&mut cursor);
            // A problem there is reported there.
            match self.condition(cursor) {
                Ok(true) => return Ok(Step::Jump(SourceLine { line: line + 1, ..here })),
                Ok(false) => {}
                Err((problem, _)) => return Err((problem, 0..usize::MAX)),
            }
        }
    }

    fn condition(&self, cursor: Cursor) -> Result<bool, Located> {
        Ok(Values::new(cursor, self).bracket()?.unwrap_or(0.0) != 0.0)
    }

    fn optional_bracket(&self, mut cursor: Cursor) -> Result<Option<f64>, Located> {
        if cursor.peek() != Some(b'[') {
            return Ok(None);
        }
        Values::new(cursor, self).bracket()
    }

    fn arguments(&self, cursor: Cursor) -> Result<Vec<f64>, Located> {
        let mut values = Values::new(cursor, self);
        let mut arguments = Vec::new();
        loop {
            match values.cursor.peek() {
                Some(b'[') => arguments.push(values.bracket()?.unwrap_or(0.0)),
                Some(b'(') => match values.cursor.rest().find(')') {
                    Some(end) => values.cursor.at += end + 1,
                    None => return Err(values.cursor.unexpected("a comment that ends with `)`")),
                },
                None | Some(b';') => return Ok(arguments),
                _ => return Err(values.cursor.unexpected("an argument in brackets")),
            }
            if arguments.len() > MOST_ARGUMENTS {
                return Err(values.cursor.unexpected("at most 30 arguments"));
            }
        }
    }

    /// `O1000`: the number of a program. What follows it is a block.
    fn program_number(&mut self, name: &Label, cursor: Cursor, here: SourceLine) -> Result<Step, Located> {
        let span = 0..cursor.at;
        let main = self.level().kind == CallKind::Main;
        match main {
            true if self.seen.numbered => {
                self.track
                    .note(format!("{name} begins another program: this one ends here"));
                return Ok(Step::End);
            }
            true => {
                self.seen.numbered = true;
                if self.track.program.title.is_none() {
                    let title = title::in_comment(&cursor.line[cursor.at..]);
                    self.track.program.title = Some(title.unwrap_or_else(|| name.to_string()));
                }
            }
            false => {
                let problem = format!("{name} begins another program before this one ends: expected M99 before it");
                return Err((NcProblem::syntax(problem), span));
            }
        }
        let mut block = Block::default();
        words::read_from(cursor, self, &mut block)?;
        self.perform(&block, here)
    }
}
