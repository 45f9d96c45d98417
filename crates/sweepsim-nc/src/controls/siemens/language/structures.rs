//! What lines may be, and those that repeat from a label or define variables.

use std::ops::Range;

use super::cursor::Cursor;
use super::expression::Expression;
use crate::text::error::Located;

/// A part of a block.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Item {
    /// An address with its value: `X10`, `X=R1+2`, `CR=5`, `I=AC(3)`.
    Word {
        name: String,
        value: Expression,
        span: Range<usize>,
    },
    /// A variable gets a value.
    Set {
        name: String,
        indices: Vec<Expression>,
        value: Expression,
        span: Range<usize>,
    },
    /// A keyword or a call, with its arguments: those left out are `None`.
    Key {
        name: String,
        arguments: Option<Vec<Option<Expression>>>,
        span: Range<usize>,
    },
}

/// Where a jump looks for its label.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Search {
    Forward,
    Backward,
    /// Forward first, then from the beginning.
    Anywhere,
}

/// What a line does.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Statement {
    Block(Vec<Item>),
    Goto(Search, String),
    /// A jump under a condition.
    IfGoto(Expression, Search, String),
    If(Expression),
    Else,
    EndIf,
    While(Expression),
    For(Vec<Item>, Expression),
    Loop,
    Repeat,
    Until(Expression),
    /// The end of WHILE, FOR or LOOP.
    EndLoop(&'static str),
    /// Repeats from a label: to its next block with the second label, or to here.
    RepeatLabel {
        from: String,
        to: Option<String>,
        times: Option<Expression>,
        /// Only the block of the label (REPEATB).
        block: bool,
    },
    /// Variables with their first values.
    Define(Vec<(String, Option<Expression>)>, bool),
    /// The head of a subprogram, with its parameters.
    Proc(Vec<String>),
    /// A declaration that says nothing about moves.
    Declaration,
}

pub(crate) fn repeat(cursor: &mut Cursor) -> Result<Statement, Located> {
    let block = cursor.name().is_some_and(|(name, _)| name == "REPEATB");
    let mut labels = Vec::new();
    let mut times = None;
    while cursor.peek().is_some() {
        let mut ahead = cursor.clone();
        let Some((name, span)) = ahead.name() else {
            return Err(cursor.unexpected("a label, or P= with the number of repeats"));
        };
        if name == "P" && ahead.take("=") {
            times = Some(Expression::parse(&mut ahead)?);
        } else if let Some(count) = name.strip_prefix('P').and_then(|digits| digits.parse().ok()) {
            times = Some(Expression::number(count, span));
        } else {
            labels.push(name);
        }
        *cursor = ahead;
    }
    let mut labels = labels.into_iter();
    Ok(match (labels.next(), labels.next()) {
        (None, _) => Statement::Repeat,
        (Some(from), to) => Statement::RepeatLabel { from, to, times, block },
    })
}

pub(crate) fn define(cursor: &mut Cursor) -> Result<Statement, Located> {
    cursor.name();
    let kind = loop {
        match cursor.name() {
            Some((name, _)) if matches!(name.as_str(), "NCK" | "CHAN") => {}
            Some((name, _))
                if matches!(
                    name.as_str(),
                    "REAL" | "INT" | "BOOL" | "CHAR" | "STRING" | "AXIS" | "FRAME"
                ) =>
            {
                break name;
            }
            _ => return Err(cursor.unexpected("a type: REAL, INT, BOOL, CHAR or STRING")),
        }
    };
    if kind == "STRING" && cursor.peek() == Some('[') {
        Expression::indices(cursor)?;
    }
    let mut variables = Vec::new();
    loop {
        let Some((name, _)) = cursor.name() else {
            return Err(cursor.unexpected("the name of a variable"));
        };
        if cursor.peek() == Some('[') {
            Expression::indices(cursor)?;
        }
        let value = if cursor.take("=") {
            Some(Expression::parse(cursor)?)
        } else {
            None
        };
        variables.push((name, value));
        if !cursor.take(",") {
            return Ok(Statement::Define(variables, kind == "STRING"));
        }
    }
}
