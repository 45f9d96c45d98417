//! What a program does besides moving, in its order.

use super::interpreter::Reader;
use crate::drive::Canonical;
use crate::gcode::syntax::block::Target;
use crate::gcode::syntax::cursor::Cursor;
use crate::gcode::syntax::expression::{Values, Variables};
use crate::model::event::EventKind;

/// Longer texts for the operator are cut.
const LONGEST: usize = 500;

impl Reader {
    /// A comment that speaks to the operator: `MSG,…`, `DEBUG,…`, `PRINT,…`.
    pub(crate) fn message(&mut self, text: &str) {
        let Some((kind, text)) = text.split_once(',') else {
            return;
        };
        if kind.eq_ignore_ascii_case("MSG") {
            let text: String = text.trim().chars().take(LONGEST).collect();
            // Texts beyond the limit, of bytes or of events, are no loss.
            if self.track.event(EventKind::Message(text)).is_err() {
                self.track
                    .note("a message beyond 64 MiB of them, or among too many events: left out");
            }
            return;
        }
        if self.track.trace.is_none() {
            return;
        }
        let text = self.filled_in(text);
        self.trace([if kind.eq_ignore_ascii_case("DEBUG") {
            Canonical::Message(text)
        } else {
            Canonical::Print(text)
        }]);
    }

    /// A text with the values of its variables. `%d`, `%f` and `%.Nf` set the decimals of those that follow.
    fn filled_in(&self, text: &str) -> String {
        let (mut filled, mut decimals) = (String::new(), 6);
        let mut rest = text;
        while let Some(next) = rest.chars().next() {
            if next == '%' {
                let format = rest[1..].find(|c: char| !(c == '.' || c.is_ascii_digit()));
                if let Some(end) = format
                    && matches!(rest.as_bytes()[1 + end], b'd' | b'f')
                {
                    decimals = match (rest.as_bytes()[1 + end], rest[1..=end].strip_prefix('.')) {
                        (b'd', _) => 0,
                        (_, Some(count)) => count.parse::<usize>().unwrap_or(4).min(15),
                        _ => 4,
                    };
                    rest = &rest[end + 2..];
                    continue;
                }
            }
            if next == '#' {
                let mut values = Values::new(Cursor { line: rest, at: 0 }, self);
                if let Ok(target) = values.target() {
                    let value = match &target {
                        Target::Number(index) => self.numbered(*index),
                        Target::Name(name) => self.named(name),
                    };
                    match value {
                        Ok(Some(value)) => filled.push_str(&format!("{value:.decimals$}")),
                        _ => filled.push_str("######"),
                    }
                    rest = &rest[values.cursor.at..];
                    continue;
                }
            }
            filled.push(next);
            rest = &rest[next.len_utf8()..];
            if filled.len() > LONGEST {
                break;
            }
        }
        filled
    }
}
