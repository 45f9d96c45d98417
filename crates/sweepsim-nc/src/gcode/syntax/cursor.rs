//! A position in a line, and what stands there.

use std::ops::Range;

use crate::text::error::{Located, NcProblem};

/// Powers of ten that are exact as `f64`.
const TENS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];

/// A position in a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cursor<'a> {
    pub line: &'a str,
    pub at: usize,
}

/// An unsigned number, and whether it has no decimal point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Digits {
    pub value: f64,
    pub whole: bool,
}

impl<'a> Cursor<'a> {
    pub(crate) fn new(line: &'a str) -> Self {
        let at = if line.starts_with('\u{feff}') { 3 } else { 0 };
        Self { line, at }
    }

    fn bytes(&self) -> &'a [u8] {
        self.line.as_bytes()
    }

    /// The next byte that is not a space.
    pub(crate) fn peek(&mut self) -> Option<u8> {
        let bytes = self.bytes();
        loop {
            match bytes.get(self.at) {
                Some(b' ' | b'\t' | b'\r' | b'\x0b' | b'\x0c') => self.at += 1,
                other => return other.copied(),
            }
        }
    }

    /// Skips a byte if it comes next.
    pub(crate) fn eat(&mut self, byte: u8) -> bool {
        let next = self.peek() == Some(byte);
        self.at += usize::from(next);
        next
    }

    /// The rest of the line.
    pub(crate) fn rest(&self) -> &'a str {
        self.line.get(self.at..).unwrap_or("")
    }

    /// The letters that come next.
    pub(crate) fn letters(&mut self) -> &'a str {
        self.peek();
        let rest = self.rest();
        let end = rest.bytes().take_while(u8::is_ascii_alphabetic).count();
        &rest[..end]
    }

    /// Skips a word in any case, if the letters that come next begin with it.
    pub(crate) fn eat_word(&mut self, word: &str) -> bool {
        let found = self
            .letters()
            .get(..word.len())
            .is_some_and(|next| next.eq_ignore_ascii_case(word));
        if found {
            self.at += word.len();
        }
        found
    }

    /// An unsigned number.
    ///
    /// Up to 15 digits are exact by one division (Clinger, *How to read floating point numbers accurately*, 1990); the rest is left to the
    /// standard library.
    pub(crate) fn digits(&mut self) -> Option<Digits> {
        self.peek();
        let (bytes, start) = (self.bytes(), self.at);
        let (mut mantissa, mut digits, mut fraction, mut point) = (0_u64, 0_usize, 0_usize, false);
        let mut at = start;
        while let Some(&byte) = bytes.get(at) {
            match byte {
                b'0'..=b'9' => {
                    if digits < 18 {
                        mantissa = mantissa * 10 + u64::from(byte - b'0');
                    }
                    digits += 1;
                    fraction += usize::from(point);
                }
                b'.' if !point => point = true,
                b'.' => return None,
                _ => break,
            }
            at += 1;
        }
        if digits == 0 {
            return None;
        }
        let value = if mantissa < 1 << 53 && digits <= 18 {
            mantissa as f64 / TENS[fraction]
        } else {
            self.line[start..at]
                .parse()
                .ok()
                .filter(|value: &f64| value.is_finite())?
        };
        self.at = at;
        Some(Digits { value, whole: !point })
    }

    /// The name in `<…>` that comes next: in lower case, without spaces.
    pub(crate) fn name(&mut self) -> Result<String, Located> {
        let start = self.at;
        let end = self.rest().find('>').ok_or_else(|| {
            let problem = NcProblem::syntax("this name is not closed: expected `>` on the same line");
            (problem, start..self.line.len())
        })?;
        let text = &self.rest()[1..end];
        self.at += end + 1;
        Ok(text
            .chars()
            .filter(|c| !c.is_whitespace())
            .flat_map(char::to_lowercase)
            .collect())
    }

    /// A problem with the character that comes next.
    pub(crate) fn unexpected(&mut self, expected: &str) -> Located {
        self.peek();
        match self.rest().chars().next() {
            Some(found) => {
                let problem = NcProblem::syntax(format!("found {found:?}, but expected {expected}"));
                (problem, self.at..self.at + found.len_utf8())
            }
            None => {
                let problem = NcProblem::syntax(format!("the line ends here, but expected {expected}"));
                (problem, self.end())
            }
        }
    }

    fn end(&self) -> Range<usize> {
        let end = self.line.len();
        let start = self.line.char_indices().next_back().map_or(0, |(start, _)| start);
        start..end
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_exactly_those_of_the_standard_library() {
        let mut state = 1_u64;
        let mut random = |bound: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % bound
        };
        for _ in 0..20_000 {
            let whole: String = (0..random(12)).map(|_| char::from(b'0' + random(10) as u8)).collect();
            let fraction: String = (0..random(14)).map(|_| char::from(b'0' + random(10) as u8)).collect();
            let text = format!("{whole}.{fraction}");
            let found = Cursor::new(&text).digits().map(|digits| digits.value);
            assert_eq!(found, text.parse::<f64>().ok(), "{text}");
        }
        assert_eq!(
            Cursor::new("12").digits().unwrap(),
            Digits {
                value: 12.0,
                whole: true
            }
        );
        assert_eq!(Cursor::new("1.2.3").digits(), None);
        assert_eq!(Cursor::new(".").digits(), None);
        assert_eq!(Cursor::new(&"9".repeat(400)).digits(), None);
    }
}
