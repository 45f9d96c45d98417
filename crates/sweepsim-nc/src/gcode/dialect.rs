//! Which control a program is written for, by what it says.

use crate::model::read_options::Controller;

use super::flow::keywords::{Keyword, after_letter, is_statement, keyword, label, skip_head};
use super::syntax::cursor::Cursor;

/// The control, if the text uses subprograms, branches or settings of only one kind of controls.
pub(crate) fn of(text: &str) -> Option<Controller> {
    // Without variables, it does not matter.
    let variables = text.contains('#');
    if !variables && !text.contains('$') {
        return None;
    }
    for line in text.lines() {
        let mut cursor = Cursor::new(line);
        match cursor.peek() {
            Some(b'$') => return Some(Controller::Grbl),
            Some(b'G' | b'g' | b'X' | b'Y' | b'Z' | b'(' | b';') | None => {
                if variables && line.contains("G65") {
                    return Some(Controller::Fanuc);
                }
                if line.contains("#<") {
                    return Some(Controller::LinuxCnc);
                }
                continue;
            }
            _ => {}
        }
        if line.contains("#<") {
            return Some(Controller::LinuxCnc);
        }
        if let Some(mut cursor) = after_letter(line) {
            if label(&mut cursor).is_some() && keyword(&mut cursor).is_some_and(|keyword| keyword != Keyword::Call) {
                return Some(Controller::LinuxCnc);
            }
            continue;
        }
        skip_head(&mut cursor);
        if is_statement(cursor) || cursor.rest().starts_with("G65") {
            return Some(Controller::Fanuc);
        }
    }
    None
}
