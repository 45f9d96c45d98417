//! Expressions: parsed once, evaluated wherever they are used.

use std::ops::Range;

use super::cursor::Cursor;
use super::functions::{binary, function};
use crate::text::error::{Located, NcProblem};

/// The deepest nesting of an expression.
const DEEPEST: usize = 60;

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Number(f64),
    Text(String),
}

/// An expression, with its bytes in the line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Expression {
    pub kind: Kind,
    pub span: Range<usize>,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Kind {
    Number(f64),
    Text(String),
    /// A variable with its indices.
    Variable(String, Vec<Expression>),
    Call(String, Vec<Expression>),
    Unary(&'static str, Box<Expression>),
    Binary(&'static str, Box<Expression>, Box<Expression>),
}

/// Operators by precedence, the weakest first: those of bits and of logic come before comparisons.
///
/// Source: Siemens, *Job planning, Programming Manual*, 07/2010 (6FC5398-2BP40-0BA0), 1.7 Priority of the operations.
const OPERATORS: [&[&str]; 11] = [
    &["==", "<>", "<=", ">=", "<", ">"],
    &["<<"],
    &["OR"],
    &["XOR"],
    &["AND"],
    &["B_OR"],
    &["B_XOR"],
    &["B_AND"],
    &["+", "-"],
    &["*", "/", "DIV", "MOD"],
    &[],
];

impl Expression {
    pub fn parse(cursor: &mut Cursor) -> Result<Self, Located> {
        Self::level(cursor, 0, 0)
    }

    fn level(cursor: &mut Cursor, level: usize, depth: usize) -> Result<Self, Located> {
        if depth > DEEPEST {
            return Err(cursor.unexpected("a simpler expression: this one is nested too deeply"));
        }
        if level + 1 == OPERATORS.len() {
            return Self::unary(cursor, depth);
        }
        let mut left = Self::level(cursor, level + 1, depth)?;
        while let Some(operator) = operator(cursor, OPERATORS[level]) {
            let right = Self::level(cursor, level + 1, depth)?;
            let span = left.span.start..right.span.end;
            let kind = Kind::Binary(operator, Box::new(left), Box::new(right));
            left = Self { kind, span };
        }
        Ok(left)
    }

    fn unary(cursor: &mut Cursor, depth: usize) -> Result<Self, Located> {
        cursor.peek();
        let start = cursor.at;
        for (text, sign) in [("-", "-"), ("+", "+")] {
            if cursor.take(text) {
                if depth > DEEPEST {
                    return Err(cursor.unexpected("a simpler expression: this one is nested too deeply"));
                }
                let inner = Self::unary(cursor, depth + 1)?;
                let span = start..inner.span.end;
                return Ok(Self {
                    kind: Kind::Unary(sign, Box::new(inner)),
                    span,
                });
            }
        }
        for not in ["NOT", "B_NOT"] {
            if cursor.peek_name().as_deref() == Some(not) {
                cursor.name();
                let inner = Self::level(cursor, OPERATORS.len() - 1, depth + 1)?;
                let span = start..inner.span.end;
                let kind = Kind::Unary(not, Box::new(inner));
                return Ok(Self { kind, span });
            }
        }
        Self::atom(cursor, depth)
    }

    fn atom(cursor: &mut Cursor, depth: usize) -> Result<Self, Located> {
        let start = {
            cursor.peek();
            cursor.at
        };
        let kind = match cursor.peek() {
            Some('(') => {
                cursor.expect('(')?;
                let inner = Self::level(cursor, 0, depth + 1)?;
                cursor.expect(')')?;
                inner.kind
            }
            Some('"') => Kind::Text(cursor.quoted()?),
            Some('\'') => Kind::Number(cursor.constant()?),
            Some(c) if c.is_ascii_digit() || c == '.' => Kind::Number(cursor.number()?),
            _ => {
                let Some((name, _)) = cursor.name() else {
                    return Err(cursor.unexpected("a number, a variable or a function"));
                };
                match cursor.peek() {
                    Some('(') => Kind::Call(name, Self::list(cursor, ('(', ')'), depth)?),
                    Some('[') => Kind::Variable(name, Self::list(cursor, ('[', ']'), depth)?),
                    _ => match name.as_str() {
                        "TRUE" => Kind::Number(1.0),
                        "FALSE" => Kind::Number(0.0),
                        _ => Kind::Variable(name, Vec::new()),
                    },
                }
            }
        };
        Ok(Self {
            kind,
            span: start..cursor.at,
        })
    }

    fn list(cursor: &mut Cursor, (open, close): (char, char), depth: usize) -> Result<Vec<Self>, Located> {
        cursor.expect(open)?;
        let mut list = Vec::new();
        loop {
            list.push(Self::level(cursor, 0, depth + 1)?);
            if cursor.peek() == Some(',') {
                cursor.expect(',')?;
                continue;
            }
            cursor.expect(close)?;
            return Ok(list);
        }
    }

    /// The indices of a variable.
    pub fn indices(cursor: &mut Cursor) -> Result<Vec<Self>, Located> {
        Self::list(cursor, ('[', ']'), 0)
    }

    /// A number.
    pub fn number(value: f64, span: Range<usize>) -> Self {
        Self {
            kind: Kind::Number(value),
            span,
        }
    }

    /// Its value, with variables from `lookup`.
    pub fn value(&self, lookup: &dyn Fn(&str) -> Result<Value, NcProblem>) -> Result<Value, Located> {
        let here = |problem| (problem, self.span.clone());
        let number = |inner: &Self| inner.as_number(lookup);
        let result = match &self.kind {
            Kind::Number(value) => *value,
            Kind::Text(text) => return Ok(Value::Text(text.clone())),
            Kind::Variable(name, indices) => {
                return lookup(&key(name, indices, lookup)?).map_err(here);
            }
            Kind::Unary("-", inner) => -number(inner)?,
            Kind::Unary("NOT", inner) => f64::from(number(inner)? == 0.0),
            Kind::Unary("B_NOT", inner) => f64::from(!(number(inner)? as i32)),
            Kind::Unary(_, inner) => number(inner)?,
            Kind::Binary(operator, left, right) => match (*operator, left.value(lookup)?, right.value(lookup)?) {
                ("<<", left, right) => return Ok(Value::Text(format!("{}{}", left.text(), right.text()))),
                (operator, Value::Number(a), Value::Number(b)) => binary(operator, a, b).map_err(here)?,
                ("==", left, right) => f64::from(left == right),
                ("<>", left, right) => f64::from(left != right),
                _ => return Err(here(NcProblem::syntax("a text in a calculation: expected a number"))),
            },
            Kind::Call(name, arguments) => {
                let values = arguments.iter().map(number).collect::<Result<Vec<f64>, _>>()?;
                function(name, &values).map_err(here)?
            }
        };
        if result.is_finite() {
            Ok(Value::Number(result))
        } else {
            Err(here(NcProblem::value(
                "the result of this expression",
                result,
                "finite",
            )))
        }
    }

    pub fn as_number(&self, lookup: &dyn Fn(&str) -> Result<Value, NcProblem>) -> Result<f64, Located> {
        match self.value(lookup)? {
            Value::Number(number) => Ok(number),
            Value::Text(text) => Err((
                NcProblem::value("this", format!("{text:?}"), "a number"),
                self.span.clone(),
            )),
        }
    }
}

impl Value {
    pub fn text(&self) -> String {
        match self {
            Self::Number(number) => number.to_string(),
            Self::Text(text) => text.clone(),
        }
    }
}

/// The name of a variable with the values of its indices.
pub(crate) fn key(
    name: &str,
    indices: &[Expression],
    lookup: &dyn Fn(&str) -> Result<Value, NcProblem>,
) -> Result<String, Located> {
    let mut key = name.to_owned();
    for index in indices {
        // Axes are names: $P_UIFR[1,X,TR].
        let text = match &index.kind {
            Kind::Variable(axis, none) if none.is_empty() && name.starts_with('$') => axis.clone(),
            _ => index.value(lookup)?.text(),
        };
        key = if name == "R" {
            format!("R{text}")
        } else {
            format!("{key}[{text}]")
        };
    }
    Ok(key)
}

fn operator(cursor: &mut Cursor, operators: &[&'static str]) -> Option<&'static str> {
    for operator in operators {
        let found = if operator.starts_with(|c: char| c.is_ascii_alphabetic()) {
            let found = cursor.peek_name().as_deref() == Some(operator);
            if found {
                cursor.name();
            }
            found
        } else {
            // `<` is not the first half of `<<`.
            let half = *operator == "<" && cursor.peek().is_some() && cursor.rest().starts_with("<<");
            !half && cursor.take(operator)
        };
        if found {
            return Some(operator);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> Result<Value, String> {
        let mut cursor = Cursor::new(text);
        let lookup = |name: &str| match name {
            "R1" => Ok(Value::Number(4.0)),
            "_A[2]" => Ok(Value::Number(7.0)),
            _ => Err(NcProblem::syntax(format!("no {name}"))),
        };
        let expression = Expression::parse(&mut cursor).map_err(|(problem, _)| problem.to_string())?;
        expression.value(&lookup).map_err(|(problem, _)| problem.to_string())
    }

    #[test]
    fn follows_the_precedence() {
        for (text, expected) in [
            ("1+2*3", 7.0),
            ("-2*3", -6.0),
            ("(1+2)*3", 9.0),
            ("10-4-3", 3.0),
            ("R1/8", 0.5),
            ("R[1]*2", 8.0),
            ("_a[R1/2]", 7.0),
            ("7 DIV 2 + 7 MOD 2", 4.0),
            ("1<2 AND 2<>3", 1.0),
            ("NOT 1 == 1", 0.0),
            ("B_NOT 5", -6.0),
            // Operators of bits and of logic before comparisons.
            ("6 B_AND 3 == 2", 1.0),
            ("2 == 6 B_AND 3", 1.0),
            ("1 B_OR 6 B_XOR 2 B_AND 3", 5.0),
            ("2 == 2 AND 1", 0.0),
            ("(2 == 2) AND 1", 1.0),
            ("3 > 1 OR 2", 1.0),
            ("0 AND 1 XOR 1 OR 0", 1.0),
            // Numbers are the same within 1e-12 of their size.
            ("0.1+0.2 == 0.3", 1.0),
            ("0.1+0.2 <> 0.3", 0.0),
            ("0.1+0.2 > 0.3", 0.0),
            ("0.3 >= 0.1+0.2", 1.0),
            ("1.000001 > 1", 1.0),
            ("'HFF' + 'B101' + 'D9'", 269.0),
            ("ROUNDUP(3.1)", 4.0),
            ("SIN(30)*2", 1.0),
            ("ATAN2(1,1)", 45.0),
            ("POT(3)+SQRT(16)", 13.0),
            ("- - 2", 2.0),
            ("\"a\"<<1 == \"a1\"", 1.0),
        ] {
            let Ok(Value::Number(found)) = value(text) else {
                panic!("{text}: {:?}", value(text))
            };
            assert!((found - expected).abs() < 1e-12, "{text}: {found}");
        }
    }

    #[test]
    fn bad_expressions_say_why() {
        for (text, message) in [
            ("1/0", "a division by 0"),
            (
                "SQRT(-1)",
                "this function is SQRT(-1), but must be one that is known, with arguments in its range",
            ),
            ("R9", "no R9"),
            ("(1", "the end of the block here: expected `)`"),
            (
                "1+",
                "the end of the block here: expected a number, a variable or a function",
            ),
            ("\"a\"+1", "a text in a calculation: expected a number"),
        ] {
            assert_eq!(value(text).unwrap_err(), message, "{text}");
        }
        let deep = format!("{}1{}", "(".repeat(5000), ")".repeat(5000));
        assert!(value(&deep).unwrap_err().contains("nested too deeply"));
        assert!(value(&"-".repeat(5000)).unwrap_err().contains("nested too deeply"));
    }
}
