//! Equations from text, by recursive descent.
//!
//! ```text
//! equation = sum [ "=" sum ]
//! sum      = product { ("+" | "-") product }
//! product  = signed { ("*" | "/") signed }
//! signed   = { "+" | "-" } power
//! power    = atom [ ("^" | "**") signed ]
//! atom     = number | name | function "(" sum ")" | "(" sum ")"
//! ```
//!
//! So `-x^2` is `-(x^2)`, and `2^-1^2` is `2^(-(1^2))`.

use super::error::{FormulaError, FormulaProblem};
use super::formula::{Formula, Node};
use super::lexer::{Lexer, Token, Word};
use super::numbers::Real;
use crate::coefficients::Function;

/// The deepest nesting: each level takes a few frames of the call stack.
const DEEPEST: usize = 200;
/// The longest excerpt of a word in a message.
const LONGEST: usize = 24;

const FUNCTIONS: [(&str, Function); 7] = [
    ("sin", Function::Sine),
    ("cos", Function::Cosine),
    ("tan", Function::Tangent),
    ("exp", Function::Exponential),
    ("ln", Function::Logarithm),
    ("sqrt", Function::SquareRoot),
    ("atan", Function::ArcTangent),
];

const OPERAND: &str = "a number, a name, `(` or a sign";
const OPERATOR: &str = "an operator, `=`, `)` or the end";

fn function(name: &str) -> Option<Function> {
    FUNCTIONS.iter().find(|(known, _)| *known == name).map(|(_, f)| *f)
}

/// Checks that variables can be told from one another and from functions.
pub(super) fn check_names(names: &[&str], sides: usize) -> Result<(), FormulaError> {
    if names.len() != sides {
        let names = names.len();
        return Err(FormulaError::new(FormulaProblem::VariableCount { names, sides }));
    }
    for (number, name) in names.iter().enumerate() {
        let first = name.chars().next().is_some_and(|c| c == '_' || c.is_alphabetic());
        let word = name.chars().all(|c| c == '_' || c.is_alphanumeric());
        if !first || !word || function(name).is_some() || names[..number].contains(name) {
            return Err(FormulaError::new(FormulaProblem::VariableName {
                variable: number + 1,
                name: name.chars().take(LONGEST).collect(),
            }));
        }
    }
    Ok(())
}

/// One equation as the difference of its sides.
pub(super) fn equation(text: &str, names: &[&str]) -> Result<Formula, FormulaError> {
    let mut lexer = Lexer::new(text);
    let word = lexer.next(OPERAND)?;
    let mut parser = Parser {
        lexer,
        word,
        names,
        depth: 0,
    };
    let left = parser.sum()?;
    if !matches!(parser.word.token, Token::Equals) {
        parser.end("an operator, `=` or the end")?;
        return Ok(left);
    }
    parser.advance(OPERAND)?;
    let right = parser.sum()?;
    parser.end("an operator or the end")?;
    Ok(left - right)
}

struct Parser<'a> {
    lexer: Lexer<'a>,
    /// The next word.
    word: Word,
    names: &'a [&'a str],
    depth: usize,
}

impl Parser<'_> {
    fn advance(&mut self, expected: &'static str) -> Result<(), FormulaError> {
        self.word = self.lexer.next(expected)?;
        Ok(())
    }

    fn excerpt(&self) -> String {
        self.lexer.text[self.word.bytes.clone()].chars().take(LONGEST).collect()
    }

    fn error(&self, problem: FormulaProblem) -> FormulaError {
        FormulaError::at(self.lexer.text, self.word.bytes.clone(), problem)
    }

    fn unexpected(&self, expected: &'static str) -> FormulaError {
        let found = match self.word.token {
            Token::End => "the end".to_owned(),
            _ => format!("`{}`", self.excerpt()),
        };
        self.error(FormulaProblem::Syntax { found, expected })
    }

    fn end(&self, expected: &'static str) -> Result<(), FormulaError> {
        match self.word.token {
            Token::End => Ok(()),
            _ => Err(self.unexpected(expected)),
        }
    }

    fn sum(&mut self) -> Result<Formula, FormulaError> {
        let mut left = self.product()?;
        loop {
            match self.word.token {
                Token::Plus => {
                    self.advance(OPERAND)?;
                    left = left + self.product()?;
                }
                Token::Minus => {
                    self.advance(OPERAND)?;
                    left = left - self.product()?;
                }
                _ => return Ok(left),
            }
        }
    }

    fn product(&mut self) -> Result<Formula, FormulaError> {
        let mut left = self.signed()?;
        loop {
            match self.word.token {
                Token::Times => {
                    self.advance(OPERAND)?;
                    left = left * self.signed()?;
                }
                Token::Over => {
                    self.advance(OPERAND)?;
                    left = left / self.signed()?;
                }
                _ => return Ok(left),
            }
        }
    }

    fn signed(&mut self) -> Result<Formula, FormulaError> {
        let mut negative = false;
        loop {
            match self.word.token {
                Token::Plus => {}
                Token::Minus => negative = !negative,
                _ => break,
            }
            self.advance(OPERAND)?;
        }
        let power = self.power()?;
        Ok(if negative { -power } else { power })
    }

    /// Runs a rule one level deeper.
    fn deeper(&mut self, rule: fn(&mut Self) -> Result<Formula, FormulaError>) -> Result<Formula, FormulaError> {
        if self.depth >= DEEPEST {
            return Err(self.error(FormulaProblem::TooDeep { most: DEEPEST }));
        }
        self.depth += 1;
        let result = rule(self);
        self.depth -= 1;
        result
    }

    fn power(&mut self) -> Result<Formula, FormulaError> {
        let base = self.atom()?;
        if !matches!(self.word.token, Token::Power) {
            return Ok(base);
        }
        self.advance(OPERAND)?;
        let exponent = self.deeper(Self::signed)?;
        Ok(match whole(&exponent) {
            Some(k) => base.powi(k),
            None => base.pow(exponent),
        })
    }

    fn atom(&mut self) -> Result<Formula, FormulaError> {
        match self.word.token {
            Token::Number(real) => {
                self.advance(OPERATOR)?;
                Ok(Formula::of(Node::Constant(real)))
            }
            Token::Name => self.name(),
            Token::Open => {
                self.advance(OPERAND)?;
                self.parenthesis()
            }
            _ => Err(self.unexpected(OPERAND)),
        }
    }

    /// What follows an opening parenthesis.
    fn parenthesis(&mut self) -> Result<Formula, FormulaError> {
        let inside = self.deeper(Self::sum)?;
        if !matches!(self.word.token, Token::Close) {
            return Err(self.unexpected("an operator or `)`"));
        }
        self.advance(OPERATOR)?;
        Ok(inside)
    }

    fn name(&mut self) -> Result<Formula, FormulaError> {
        let word = self.word.clone();
        let name = &self.lexer.text[word.bytes.clone()];
        let short = || name.chars().take(LONGEST).collect();
        let place = |problem| FormulaError::at(self.lexer.text, word.bytes.clone(), problem);
        let constant = match name {
            "pi" | "π" => Some(Real::PI),
            "e" => Some(Real::E),
            _ => None,
        };
        // A variable may be called `e`.
        let variable = self.names.iter().position(|known| *known == name);
        let function = function(name);
        let functions = || FUNCTIONS.map(|(name, _)| name).join(", ");
        let known = || {
            self.names
                .iter()
                .copied()
                .chain(["pi", "e"])
                .collect::<Vec<_>>()
                .join(", ")
        };
        let next = self.lexer.next(OPERATOR);
        let opens = matches!(&next, Ok(word) if matches!(word.token, Token::Open));
        let formula = match (function, variable, constant) {
            (Some(function), ..) if opens => {
                self.word = next?;
                self.advance(OPERAND)?;
                let argument = self.parenthesis()?;
                return Ok(Formula::of(Node::Apply(function, argument)));
            }
            (Some(_), ..) => {
                self.word = next?;
                return Err(self.unexpected("`(` after a function's name"));
            }
            (None, Some(number), _) => Formula::variable(number),
            (None, None, Some(real)) => Formula::of(Node::Constant(real)),
            (None, None, None) if opens => {
                return Err(place(FormulaProblem::UnknownFunction {
                    name: short(),
                    expected: functions(),
                }));
            }
            (None, None, None) => {
                return Err(place(FormulaProblem::UnknownName {
                    name: short(),
                    expected: known(),
                }));
            }
        };
        self.word = next?;
        Ok(formula)
    }
}

/// The whole number that an exponent is, if it is one.
fn whole(exponent: &Formula) -> Option<i32> {
    let number = |formula: &Formula| match &*formula.0 {
        Node::Constant(real) if real.error == 0.0 && real.value.lo == 0.0 => Some(real.value.hi),
        _ => None,
    };
    let value = match &*exponent.0 {
        // A sign is a factor.
        Node::Multiply(sign, rest) => number(sign)? * number(rest)?,
        _ => number(exponent)?,
    };
    let fits = value.fract() == 0.0 && value.abs() <= f64::from(1 << 20);
    fits.then_some(value as i32)
}
