//! What lines may be, and those that repeat from a label or define variables.

use std::ops::Range;

use super::cursor::Cursor;
use super::expression::{Expression, Value};
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
    /// A jump to the label of the first constant that a value is, or to the last one.
    Case(Expression, Vec<(Expression, Search, String)>, Option<(Search, String)>),
    /// Variables with their first values.
    Define(Vec<(String, Option<Expression>)>, VariableKind),
    /// The head of a subprogram.
    Proc(Head),
    /// A declaration that says nothing about moves.
    Declaration,
}

/// A call of a subprogram that is still to be made.
#[derive(Clone, Debug)]
pub(crate) struct Call {
    pub name: String,
    pub values: Vec<Value>,
    /// The caller's variables among the arguments, each in its place.
    pub variables: Vec<Option<String>>,
    pub times: usize,
    pub modally: bool,
}

/// What a variable holds: what it gets becomes that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum VariableKind {
    Real,
    /// Numbers become the nearest whole one.
    Whole,
    /// 0 or 1.
    Truth,
    Text,
}

impl VariableKind {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "REAL" | "AXIS" | "FRAME" | "CHAR" => Self::Real,
            "INT" => Self::Whole,
            "BOOL" => Self::Truth,
            "STRING" => Self::Text,
            _ => return None,
        })
    }

    /// A value as such a variable holds it. Source: as of the operators, 1.8 Possible type conversions.
    pub fn held(self, value: Value) -> Value {
        match (self, value) {
            (Self::Whole, Value::Number(number)) => Value::Number((number + 0.5).floor()),
            (Self::Truth, Value::Number(number)) => Value::Number(f64::from(number != 0.0)),
            (_, value) => value,
        }
    }

    /// What it holds before it gets something.
    pub fn nothing(self) -> Value {
        match self {
            Self::Text => Value::Text(String::new()),
            _ => Value::Number(0.0),
        }
    }
}

/// The head of a subprogram: `PROC NAME(VAR REAL A, INT B) SAVE`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Head {
    pub parameters: Vec<Parameter>,
    /// The modes of its caller come back at its end.
    pub saves: bool,
}

/// A parameter of a subprogram.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Parameter {
    pub name: String,
    pub kind: VariableKind,
    /// The caller's variable gets its value at the end (`VAR`).
    pub by_reference: bool,
}

pub(crate) fn head(cursor: &mut Cursor) -> Result<Head, Located> {
    cursor.name();
    let mut head = Head::default();
    if cursor.name().is_some() && cursor.take("(") {
        let (mut kind, mut by_reference) = (VariableKind::Real, false);
        while !cursor.take(")") {
            match cursor.name() {
                // The type, then the name: the last name before a comma.
                Some((name, _)) if matches!(cursor.peek(), Some(',' | ')' | '=')) => {
                    let parameter = Parameter {
                        name,
                        kind,
                        by_reference,
                    };
                    head.parameters.push(parameter);
                    (kind, by_reference) = (VariableKind::Real, false);
                }
                Some((name, _)) => {
                    by_reference |= name == "VAR";
                    kind = VariableKind::named(&name).unwrap_or(kind);
                }
                None if cursor.take(",") => {}
                None => return Err(cursor.unexpected("a parameter")),
            }
        }
    }
    while let Some((name, _)) = cursor.name() {
        head.saves |= name == "SAVE";
    }
    cursor.at += cursor.rest().len();
    Ok(head)
}

/// `CASE R1 OF 1 GOTOF A 2 GOTOF B DEFAULT GOTOF C`.
pub(crate) fn case(cursor: &mut Cursor) -> Result<Statement, Located> {
    cursor.name();
    let value = Expression::parse(cursor)?;
    if cursor.name().is_none_or(|(name, _)| name != "OF") {
        return Err(cursor.unexpected("OF"));
    }
    let mut cases = Vec::new();
    let mut otherwise = None;
    while cursor.peek().is_some() {
        if cursor.peek_name().as_deref() == Some("DEFAULT") {
            cursor.name();
            otherwise = Some(jump(cursor)?);
        } else {
            let constant = Expression::parse(cursor)?;
            let (search, label) = jump(cursor)?;
            cases.push((constant, search, label));
        }
    }
    Ok(Statement::Case(value, cases, otherwise))
}

pub(crate) fn jump(cursor: &mut Cursor) -> Result<(Search, String), Located> {
    let search = match cursor.name().map(|(name, _)| name).as_deref() {
        Some("GOTOF") => Search::Forward,
        Some("GOTOB") => Search::Backward,
        Some("GOTO" | "GOTOC") => Search::Anywhere,
        _ => return Err(cursor.unexpected("GOTOF, GOTOB or GOTO with a label")),
    };
    match cursor.name() {
        Some((label, _)) => Ok((search, label)),
        None => Err(cursor.unexpected("a label or a block number")),
    }
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
            Some((name, _)) => match VariableKind::named(&name) {
                Some(kind) => break kind,
                None => return Err(cursor.unexpected("a type: REAL, INT, BOOL, CHAR or STRING")),
            },
            None => return Err(cursor.unexpected("a type: REAL, INT, BOOL, CHAR or STRING")),
        }
    };
    if kind == VariableKind::Text && cursor.peek() == Some('[') {
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
            return Ok(Statement::Define(variables, kind));
        }
    }
}
