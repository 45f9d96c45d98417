//! Which control a program is written for, by what it says.

use super::flow::keywords::{Keyword, after_letter, is_statement, keyword, label, skip_head};
use super::syntax::cursor::Cursor;
use crate::drive::Sense;
use crate::model::read_options::{Controller, ReadOptions};

/// The rules by which a program is read.
pub(crate) struct Rules {
    pub controller: Option<Controller>,
    /// Whether the control is given, not guessed: its own rules about missing and spare words then count.
    pub strict: bool,
    pub block_delete: bool,
    pub lenient: bool,
}

impl Rules {
    pub(crate) fn new(text: &str, options: &ReadOptions) -> Self {
        Self {
            controller: options.controller.or_else(|| of(text)),
            strict: options.controller.is_some(),
            block_delete: options.block_delete,
            lenient: options.lenient,
        }
    }

    /// Whether it is a Fanuc, or follows it.
    pub(crate) fn fanuc(&self) -> bool {
        matches!(self.controller, Some(Controller::Fanuc | Controller::Haas))
    }

    /// The signs of rotary axes if no machine is given.
    pub(crate) fn sense(&self) -> Sense {
        if self.strict && self.fanuc() {
            Sense::Tool
        } else {
            Sense::Part
        }
    }
}

/// Whether a text is a program of an Okuma: `$BRACKET.MIN%` at its head, or `G15 H` for its work offset.
fn is_okuma(text: &str) -> bool {
    let head = text.lines().map(str::trim).find(|line| !line.is_empty());
    head.is_some_and(|head| okuma_title(head).is_some()) || text.contains("G15 H") || text.contains("G15H")
}

/// The name in the head of a program of an Okuma.
pub(crate) fn okuma_title(line: &str) -> Option<&str> {
    let name = line.trim().strip_prefix('$')?.strip_suffix('%')?;
    let (title, kind) = name.rsplit_once('.')?;
    (kind.eq_ignore_ascii_case("MIN") || kind.eq_ignore_ascii_case("SUB")).then_some(title)
}

/// The control, if the text uses subprograms, branches or settings of only one kind of controls.
fn of(text: &str) -> Option<Controller> {
    if is_okuma(text) {
        return Some(Controller::Okuma);
    }
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
