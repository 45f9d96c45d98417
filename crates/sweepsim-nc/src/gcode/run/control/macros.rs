//! Fanuc's custom macro B: `IF [...] GOTO`, `WHILE [...] DO`, `GOTO`.
//!
//! Source: Fanuc Series 30i operator's manual B-63944EN, *Custom macro*.

use super::super::interpreter::{Reader, Step};
use super::calls::{DEEPEST, SourceLine};
use crate::gcode::flow::source::loop_number;
use crate::gcode::syntax::block::Block;
use crate::gcode::syntax::cursor::Cursor;
use crate::gcode::syntax::expression::Values;
use crate::gcode::syntax::words;
use crate::text::error::{Located, NcProblem};

impl Reader {
    /// A statement; the cursor is where it begins.
    pub(crate) fn statement(&mut self, mut cursor: Cursor, here: SourceLine) -> Result<Step, Located> {
        let start = cursor.at;
        let word = cursor.letters().to_ascii_uppercase();
        cursor.at += word.len();
        let span = start..cursor.at;
        match word.as_str() {
            "IF" => {
                let mut values = Values::new(cursor, self);
                let holds = values.bracket()?.unwrap_or(0.0) != 0.0;
                cursor = values.cursor;
                if !holds {
                    return Ok(Step::Next);
                }
                if cursor.eat_word("GOTO") {
                    return self.go_to(cursor, here);
                }
                cursor.eat_word("THEN");
                let mut block = Block::default();
                words::read_from(cursor, self, &mut block)?;
                self.perform(&block, here)
            }
            "GOTO" => self.go_to(cursor, here),
            "WHILE" => {
                let mut values = Values::new(cursor, self);
                let holds = values.bracket()?.unwrap_or(0.0) != 0.0;
                cursor = values.cursor;
                if !cursor.eat_word("DO") {
                    return Err(cursor.unexpected("DO after the condition"));
                }
                self.open_loop(cursor, holds, here)
            }
            "DO" => self.open_loop(cursor, true, here),
            "END" => {
                let number = number(&mut cursor)?;
                let loops = &mut self.level().loops;
                while let Some(&(open, line)) = loops.last() {
                    if open == number {
                        return Ok(self.turn(SourceLine { line, ..here }));
                    }
                    loops.pop();
                }
                let problem = NcProblem::syntax(format!("END{number} without WHILE … DO{number} before it"));
                Err((problem, span))
            }
            word => {
                self.track.note(format!("{word} writes to a port: ignored"));
                Ok(Step::Next)
            }
        }
    }

    fn go_to(&mut self, cursor: Cursor, here: SourceLine) -> Result<Step, Located> {
        let mut values = Values::new(cursor, self);
        values.cursor.peek();
        let start = values.cursor.at;
        let (value, _) = values.value()?;
        let span = start..values.cursor.at;
        let number = value.unwrap_or(0.0);
        let number = NcProblem::whole("the block number of GOTO", number, 0..=999_999_999, "a whole number");
        let number = number.map_err(|problem| (problem, span.clone()))?;
        match self.texts.sources[here.source].labels().number(number, here.line) {
            Some(line) if line <= here.line => Ok(self.turn(SourceLine { line, ..here })),
            Some(line) => Ok(Step::Jump(SourceLine { line, ..here })),
            None => {
                let problem = NcProblem::syntax(format!("there is no block N{number} to go to"));
                Err((problem, span))
            }
        }
    }

    fn open_loop(&mut self, mut cursor: Cursor, holds: bool, here: SourceLine) -> Result<Step, Located> {
        let span = 0..cursor.at;
        let number = number(&mut cursor)?;
        let loops = &mut self.level().loops;
        // Jumps may have left loops, or come back to this one.
        if let Some(open) = loops
            .iter()
            .position(|&(open, line)| open == number || line == here.line)
        {
            loops.truncate(open);
        }
        if holds && loops.len() >= DEEPEST {
            let problem = NcProblem::syntax(format!(
                "loops within loops are more than {DEEPEST} deep: Fanuc allows 3"
            ));
            return Err((problem, span));
        }
        if holds {
            loops.push((number, here.line));
            return Ok(Step::Next);
        }
        match self.end_of_loop(number, here) {
            Some(line) => Ok(Step::Jump(SourceLine { line: line + 1, ..here })),
            None => {
                let problem = NcProblem::syntax(format!("there is no END{number} after this line"));
                Err((problem, span))
            }
        }
    }

    fn end_of_loop(&mut self, number: u32, here: SourceLine) -> Option<usize> {
        if let Some(line) = self.texts.loop_ends.get(&here) {
            return *line;
        }
        let source = &self.texts.sources[here.source];
        let mut deep = 0_usize;
        let mut end = None;
        for line in here.line + 1..source.len() {
            let text = source.line(line);
            if loop_number(text, "DO") == Some(number) {
                deep += 1;
            } else if loop_number(text, "END") == Some(number) {
                if deep == 0 {
                    end = Some(line);
                    break;
                }
                deep -= 1;
            }
        }
        self.texts.loop_ends.insert(here, end);
        end
    }
}

fn number(cursor: &mut Cursor) -> Result<u32, Located> {
    match cursor.digits() {
        Some(digits) if digits.whole && digits.value < 1e6 => Ok(digits.value as u32),
        _ => Err(cursor.unexpected("the number of a loop")),
    }
}
