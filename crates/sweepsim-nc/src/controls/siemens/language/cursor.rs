//! Reading a line from left to right.

use std::ops::Range;

use crate::text::error::{Located, NcProblem};

/// A position in a line without its comment.
#[derive(Clone, Debug)]
pub(crate) struct Cursor<'a> {
    text: &'a str,
    pub at: usize,
}

impl<'a> Cursor<'a> {
    pub fn new(text: &'a str) -> Self {
        Self { text, at: 0 }
    }

    /// The next character after blanks.
    pub fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    /// The next character, blank or not.
    pub fn adjacent(&self) -> Option<char> {
        self.text[self.at..].chars().next()
    }

    pub fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    /// Takes a text after blanks, if it is there.
    pub fn take(&mut self, expected: &str) -> bool {
        self.peek();
        let found = self.rest().starts_with(expected);
        if found {
            self.at += expected.len();
        }
        found
    }

    pub fn expect(&mut self, expected: char) -> Result<(), Located> {
        if self.peek() == Some(expected) {
            self.at += 1;
            return Ok(());
        }
        Err(self.unexpected(&format!("`{expected}`")))
    }

    /// The error for what stands here.
    pub fn unexpected(&mut self, expected: &str) -> Located {
        let found = match self.peek() {
            Some(c) => format!("`{c}`"),
            None => "the end of the block".to_owned(),
        };
        let width = self.adjacent().map_or(0, char::len_utf8);
        (
            NcProblem::syntax(format!("{found} here: expected {expected}")),
            self.at..self.at + width,
        )
    }

    /// A name: letters, digits and underscores, in capitals.
    pub fn name(&mut self) -> Option<(String, Range<usize>)> {
        let first = self.peek()?;
        if !(first.is_ascii_alphabetic() || first == '_' || first == '$') {
            return None;
        }
        let rest = self.rest();
        let end = rest
            .find(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '$'))
            .unwrap_or(rest.len());
        let span = self.at..self.at + end;
        self.at = span.end;
        Some((self.text[span.clone()].to_ascii_uppercase(), span))
    }

    /// The next name, without taking it.
    pub fn peek_name(&mut self) -> Option<String> {
        let mut ahead = self.clone();
        ahead.name().map(|(name, _)| name)
    }

    /// A decimal number without sign, with an exponent after `EX`.
    pub fn number(&mut self) -> Result<f64, Located> {
        self.peek();
        let rest = self.rest();
        let end = rest
            .find(|c: char| !(c.is_ascii_digit() || c == '.'))
            .unwrap_or(rest.len());
        let digits = &rest[..end];
        let start = self.at;
        self.at += end;
        let mut exponent = 0.0;
        let after = self.rest().as_bytes();
        if after.len() > 2
            && after[..2].eq_ignore_ascii_case(b"EX")
            && (after[2].is_ascii_digit() || b"+-".contains(&after[2]))
        {
            let tail = &self.rest()[2..];
            let sign = usize::from(tail.starts_with(['+', '-']));
            let length = sign
                + tail[sign..]
                    .find(|c: char| !c.is_ascii_digit())
                    .unwrap_or(tail.len() - sign);
            exponent = tail[..length].parse().unwrap_or(f64::NAN);
            self.at += 2 + length;
        }
        let value: f64 = digits.parse::<f64>().unwrap_or(f64::NAN) * 10_f64.powf(exponent);
        if value.is_finite() && digits.contains(|c: char| c.is_ascii_digit()) {
            Ok(value)
        } else {
            let span = start..self.at.max(start);
            Err((
                NcProblem::syntax(format!("{:?} is not a number", &self.text[span.clone()])),
                span,
            ))
        }
    }

    /// A whole number in quotes, to a base by its letter: `'HFF'`, `'B101'`, `'D9'`.
    pub fn constant(&mut self) -> Result<f64, Located> {
        let start = self.at;
        self.expect('\'')?;
        let rest = self.rest();
        let end = rest.find('\'').unwrap_or(rest.len());
        let (inside, span) = (&rest[..end], start..self.at + end);
        let (base, digits) = match inside.chars().next() {
            Some('H' | 'h') => (16, &inside[1..]),
            Some('B' | 'b') => (2, &inside[1..]),
            Some('D' | 'd') => (10, &inside[1..]),
            _ => (10, inside),
        };
        match u32::from_str_radix(digits, base) {
            Ok(value) if end < rest.len() => {
                self.at = span.end + 1;
                Ok(f64::from(value))
            }
            _ => {
                let problem = "expected a whole number in quotes, such as 'HFF' or 'B101'";
                Err((NcProblem::syntax(problem), span))
            }
        }
    }

    /// A text in quotes.
    pub fn quoted(&mut self) -> Result<String, Located> {
        self.expect('"')?;
        let rest = self.rest();
        let Some(end) = rest.find('"') else {
            let start = self.at - 1;
            return Err((
                NcProblem::syntax("a text without its end: expected `\"`"),
                start..self.text.len(),
            ));
        };
        self.at += end + 1;
        Ok(rest[..end].to_owned())
    }
}

/// The part of a line before its comment.
pub(crate) fn without_comment(line: &str) -> &str {
    let mut quoted = false;
    for (at, c) in line.char_indices() {
        match c {
            '"' => quoted = !quoted,
            ';' if !quoted => return &line[..at],
            _ => {}
        }
    }
    line
}

/// Whether a text changes tools by M6, not by T alone.
pub(crate) fn changes_by_m6(text: &str) -> bool {
    let codes = text.lines().map(without_comment);
    let mut pieces = codes.flat_map(|code| code.split(|c: char| !c.is_ascii_alphanumeric()));
    pieces.any(|piece| {
        let upper = piece.to_ascii_uppercase();
        upper.match_indices('M').any(|(at, _)| {
            let digits: String = upper[at + 1..].chars().take_while(char::is_ascii_digit).collect();
            // In T1M6 too, not in a name.
            let before = upper[..at].chars().next_back();
            matches!(digits.as_str(), "6" | "06") && before.is_none_or(|c| c.is_ascii_digit())
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_names_and_texts() {
        let mut cursor = Cursor::new(" 12.5EX-2 _home .5 \"a;b\" 7EXTRA");
        assert!((cursor.number().unwrap() - 0.125).abs() < 1e-15);
        assert_eq!(cursor.name().unwrap().0, "_HOME");
        assert_eq!(cursor.number().unwrap(), 0.5);
        assert_eq!(cursor.quoted().unwrap(), "a;b");
        assert_eq!(cursor.number().unwrap(), 7.0);
        assert_eq!(cursor.name().unwrap().0, "EXTRA");
        assert_eq!(without_comment("X1 MSG(\"a;b\") ; c"), "X1 MSG(\"a;b\") ");
    }
}
