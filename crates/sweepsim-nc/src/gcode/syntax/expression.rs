//! Values: numbers, variables, and expressions in brackets.
//!
//! LinuxCNC's grammar (RS-274/NGC, section 3.3.2) and Fanuc's custom macro B. They agree but for the precedence of `AND`, `OR` and `XOR`,
//! the rounding functions, and variables without a value.

use super::block::Target;
use super::cursor::{Cursor, Digits};
use super::functions::{Operator, Value, apply, call};
use crate::text::error::{Located, NcProblem};

/// The variables of a program, as an expression reads them.
pub(crate) trait Variables {
    /// Whether expressions follow Fanuc's rules.
    fn fanuc(&self) -> bool;
    /// What `ROUND` within a word of a length or an angle rounds to, where that is not a whole number.
    fn increment(&self, letter: char) -> Option<f64>;
    /// The value of `#index`; `None` if it has none.
    fn numbered(&self, index: u32) -> Result<Option<f64>, NcProblem>;
    /// The value of `#<name>`.
    fn named(&self, name: &str) -> Result<Option<f64>, NcProblem>;
    /// Whether a variable has a value.
    fn exists(&self, target: &Target) -> bool;
}

/// Nothing has a value: for texts that are only looked at.
pub(crate) struct NoVariables;

impl Variables for NoVariables {
    fn fanuc(&self) -> bool {
        false
    }
    fn increment(&self, _: char) -> Option<f64> {
        None
    }
    fn numbered(&self, _: u32) -> Result<Option<f64>, NcProblem> {
        Ok(Some(0.0))
    }
    fn named(&self, _: &str) -> Result<Option<f64>, NcProblem> {
        Ok(Some(0.0))
    }
    fn exists(&self, _: &Target) -> bool {
        false
    }
}

/// Brackets within brackets, at most.
const DEEPEST: usize = 60;

/// Reads values of a line.
pub(crate) struct Values<'a, 'b> {
    pub cursor: Cursor<'a>,
    pub variables: &'b dyn Variables,
    /// The letter of the word whose value is read.
    pub address: Option<char>,
    depth: usize,
}

impl<'a, 'b> Values<'a, 'b> {
    pub(crate) fn new(cursor: Cursor<'a>, variables: &'b dyn Variables) -> Self {
        Self {
            cursor,
            variables,
            address: None,
            depth: 0,
        }
    }

    /// Whether a value can begin with the next character.
    pub(crate) fn follows(&mut self) -> bool {
        match self.cursor.peek() {
            Some(b'+' | b'-' | b'.' | b'#' | b'[' | b'0'..=b'9') => true,
            Some(byte) if byte.is_ascii_alphabetic() => {
                let mut cursor = self.cursor;
                let letters = cursor.letters();
                cursor.at += letters.len();
                letters.len() > 1 && cursor.peek() == Some(b'[')
            }
            _ => false,
        }
    }

    /// A number, a variable, an expression in brackets or a function of one, with its sign. Also whether it is plain digits.
    pub(crate) fn value(&mut self) -> Result<(Value, bool), Located> {
        let mut negative = false;
        while let Some(sign @ (b'+' | b'-')) = self.cursor.peek() {
            negative ^= sign == b'-';
            self.cursor.at += 1;
        }
        let (value, whole) = match self.cursor.peek() {
            Some(b'[') => (self.bracket()?, false),
            Some(b'#') => (self.variable()?, false),
            Some(byte) if byte.is_ascii_alphabetic() => (Some(self.function()?), false),
            _ => match self.cursor.digits() {
                Some(Digits { value, whole }) => (Some(value), whole),
                None => return Err(self.cursor.unexpected("a number")),
            },
        };
        Ok((value.map(|value| if negative { -value } else { value }), whole))
    }

    /// A value in brackets.
    pub(crate) fn bracket(&mut self) -> Result<Value, Located> {
        let start = self.cursor.at;
        if !self.cursor.eat(b'[') {
            return Err(self.cursor.unexpected("`[`"));
        }
        self.depth += 1;
        if self.depth > DEEPEST {
            let problem = NcProblem::syntax(format!("more than {DEEPEST} brackets within brackets"));
            return Err((problem, start..start + 1));
        }
        let value = self.expression()?;
        self.depth -= 1;
        if !self.cursor.eat(b']') {
            return Err(self.cursor.unexpected("an operator or `]`"));
        }
        Ok(value)
    }

    /// An expression, to the first character that cannot go on with it.
    pub(crate) fn expression(&mut self) -> Result<Value, Located> {
        let (first, _) = self.value()?;
        self.operators(first, 1)
    }

    fn operators(&mut self, mut left: Value, lowest: u8) -> Result<Value, Located> {
        let fanuc = self.variables.fanuc();
        loop {
            let before = self.cursor;
            let Some(operator) = self.operator() else {
                return Ok(left);
            };
            let precedence = operator.precedence(fanuc);
            if precedence < lowest {
                self.cursor = before;
                return Ok(left);
            }
            let (mut right, _) = self.value()?;
            loop {
                let ahead = self.cursor;
                let tighter = self.operator().is_some_and(|next| next.precedence(fanuc) > precedence);
                self.cursor = ahead;
                if !tighter {
                    break;
                }
                right = self.operators(right, precedence + 1)?;
            }
            left = apply(operator, left, right, fanuc).map_err(|problem| (problem, before.at..self.cursor.at))?;
        }
    }

    fn operator(&mut self) -> Option<Operator> {
        let symbol = match self.cursor.peek()? {
            b'*' if self.cursor.rest().starts_with("**") => {
                self.cursor.at += 2;
                return Some(Operator::Power);
            }
            b'*' => Operator::Times,
            b'/' => Operator::Over,
            b'+' => Operator::Plus,
            b'-' => Operator::Minus,
            byte if byte.is_ascii_alphabetic() => {
                let operators = [
                    ("MOD", Operator::Modulo),
                    ("AND", Operator::And),
                    ("XOR", Operator::Xor),
                    ("OR", Operator::Or),
                    ("EQ", Operator::Equal),
                    ("NE", Operator::Different),
                    ("GT", Operator::Greater),
                    ("GE", Operator::AtLeast),
                    ("LT", Operator::Less),
                    ("LE", Operator::AtMost),
                ];
                let found = operators.into_iter().find(|(word, _)| self.cursor.eat_word(word));
                return found.map(|(_, operator)| operator);
            }
            _ => return None,
        };
        self.cursor.at += 1;
        Some(symbol)
    }

    /// What a variable at the cursor is called: `#5`, `##5`, `#[#1+2]`, `#<name>`.
    pub(crate) fn target(&mut self) -> Result<Target, Located> {
        let start = self.cursor.at;
        if !self.cursor.eat(b'#') {
            return Err(self.cursor.unexpected("`#`"));
        }
        let address = self.address.take();
        let index = match self.cursor.peek() {
            Some(b'<') => return self.cursor.name().map(Target::Name),
            Some(b'#') => {
                self.depth += 1;
                if self.depth > DEEPEST {
                    let problem = NcProblem::syntax(format!("more than {DEEPEST} `#` in a row"));
                    return Err((problem, start..start + 1));
                }
                let index = self.variable()?;
                self.depth -= 1;
                index
            }
            Some(b'[') => self.bracket()?,
            _ => match self.cursor.digits() {
                Some(digits) => Some(digits.value),
                None => {
                    return Err(self.cursor.unexpected("the number or the name of a variable after `#`"));
                }
            },
        }
        .unwrap_or(0.0);
        self.address = address;
        let near = index.round();
        if (index - near).abs() > 1e-4 || !(0.0..=99_999.0).contains(&near) {
            let problem = NcProblem::value("the number of a variable", index, "a whole number from 0 to 99999");
            return Err((problem, start..self.cursor.at));
        }
        Ok(Target::Number(near as u32))
    }

    /// The value of a variable.
    fn variable(&mut self) -> Result<Value, Located> {
        let start = self.cursor.at;
        let value = match self.target()? {
            Target::Number(index) => self.variables.numbered(index),
            Target::Name(name) => self.variables.named(&name),
        };
        value.map_err(|problem| (problem, start..self.cursor.at))
    }

    fn function(&mut self) -> Result<f64, Located> {
        let start = self.cursor.at;
        let name = self.cursor.letters().to_ascii_uppercase();
        self.cursor.at += name.len();
        if self.cursor.peek() != Some(b'[') {
            let problem = NcProblem::syntax(format!("found `{name}`, but expected a number"));
            return Err((problem, start..start + name.len()));
        }
        if name == "EXISTS" {
            self.cursor.eat(b'[');
            let target = self.target()?;
            if !self.cursor.eat(b']') {
                return Err(self.cursor.unexpected("`]` after the variable"));
            }
            return Ok(f64::from(self.variables.exists(&target)));
        }
        let two = matches!(name.as_str(), "ATAN" | "POW");
        let (first, second) = self.arguments(two)?;
        let whole = start..self.cursor.at;
        if matches!(name.as_str(), "ROUND" | "RND")
            && let Some(step) = self.address.and_then(|letter| self.variables.increment(letter))
        {
            return Ok((first / step).round() * step);
        }
        call(&name, first, second, self.variables.fanuc()).map_err(|problem| (problem, whole))
    }

    /// `[a]`, or one of `[a]/[b]` and `[a,b]`.
    fn arguments(&mut self, two: bool) -> Result<(f64, Option<f64>), Located> {
        if !two {
            return Ok((self.bracket()?.unwrap_or(0.0), None));
        }
        self.cursor.eat(b'[');
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.cursor.unexpected("fewer brackets within brackets"));
        }
        let first = self.expression()?.unwrap_or(0.0);
        let second = if self.cursor.eat(b',') {
            Some(self.expression()?.unwrap_or(0.0))
        } else {
            None
        };
        self.depth -= 1;
        if !self.cursor.eat(b']') {
            return Err(self.cursor.unexpected("an operator or `]`"));
        }
        let before = self.cursor;
        if second.is_none() && self.cursor.eat(b'/') && self.cursor.peek() == Some(b'[') {
            return Ok((first, Some(self.bracket()?.unwrap_or(0.0))));
        }
        if second.is_none() {
            self.cursor = before;
        }
        Ok((first, second))
    }
}
