//! The words of an equation.

use super::error::{FormulaError, FormulaProblem};
use super::numbers::Real;
use std::ops::Range;

/// A word.
#[derive(Clone, Copy, Debug)]
pub(super) enum Token {
    Number(Real),
    Name,
    Plus,
    Minus,
    Times,
    Over,
    Power,
    Equals,
    Open,
    Close,
    End,
}

/// A word with its place, in bytes of the text.
#[derive(Clone, Debug)]
pub(super) struct Word {
    pub token: Token,
    pub bytes: Range<usize>,
}

/// Reads one word after the other.
pub(super) struct Lexer<'a> {
    pub text: &'a str,
    at: usize,
}

impl<'a> Lexer<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { text, at: 0 }
    }

    /// The next word; `expected` is for the error if there is a character that begins none.
    pub(super) fn next(&mut self, expected: &'static str) -> Result<Word, FormulaError> {
        let rest = &self.text[self.at..];
        let start = self.at + (rest.len() - rest.trim_start().len());
        let rest = &self.text[start..];
        let Some(first) = rest.chars().next() else {
            self.at = start;
            return Ok(Word {
                token: Token::End,
                bytes: start..start,
            });
        };
        let (token, length) = match first {
            '+' => (Token::Plus, 1),
            '-' | '−' => (Token::Minus, first.len_utf8()),
            '*' if rest.starts_with("**") => (Token::Power, 2),
            '*' | '·' => (Token::Times, first.len_utf8()),
            '/' => (Token::Over, 1),
            '^' => (Token::Power, 1),
            '=' => (Token::Equals, 1),
            '(' => (Token::Open, 1),
            ')' => (Token::Close, 1),
            '0'..='9' | '.' => self.number(start)?,
            c if c == '_' || c.is_alphabetic() => {
                let end = rest.find(|c: char| !(c == '_' || c.is_alphanumeric()));
                (Token::Name, end.unwrap_or(rest.len()))
            }
            c => {
                let found = format!("`{}`", c.escape_default());
                let problem = FormulaProblem::Syntax { found, expected };
                return Err(FormulaError::at(self.text, start..start + c.len_utf8(), problem));
            }
        };
        self.at = start + length;
        Ok(Word {
            token,
            bytes: start..self.at,
        })
    }

    /// A number: digits with or without a point, and an exponent.
    fn number(&self, start: usize) -> Result<(Token, usize), FormulaError> {
        let bytes = &self.text.as_bytes()[start..];
        let run = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
        let whole = run(0);
        let mut length = whole;
        let mut fraction = 0;
        if bytes.get(length) == Some(&b'.') {
            fraction = run(length + 1);
            length += 1 + fraction;
        }
        if whole + fraction == 0 {
            let problem = FormulaProblem::Syntax {
                found: "`.` without digits".to_owned(),
                expected: "a number such as 0.5",
            };
            return Err(FormulaError::at(self.text, start..start + length, problem));
        }
        let mut exponent: i64 = 0;
        if matches!(bytes.get(length), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(length + 1), Some(b'+' | b'-')));
            let digits = run(length + 1 + sign);
            // Otherwise the `e` begins a name.
            if digits > 0 {
                let from = length + 1;
                length = from + sign + digits;
                // Exponents beyond all numbers are caught below.
                let value: i64 = self.text[start + from + sign..start + length]
                    .parse()
                    .unwrap_or(i64::from(i32::MAX));
                let value = value.min(i64::from(i32::MAX));
                exponent = if bytes[from] == b'-' { -value } else { value };
            }
        }
        let text = &self.text[start..start + length];
        let digits: Vec<u8> = text
            .bytes()
            .take_while(|b| !matches!(b, b'e' | b'E'))
            .filter(u8::is_ascii_digit)
            .collect();
        let real = Real::decimal(&digits, fraction as i64 - exponent, text).ok_or_else(|| {
            let number = text.chars().take(24).collect();
            FormulaError::at(
                self.text,
                start..start + length,
                FormulaProblem::NumberTooLarge { number },
            )
        })?;
        Ok((Token::Number(real), length))
    }
}
