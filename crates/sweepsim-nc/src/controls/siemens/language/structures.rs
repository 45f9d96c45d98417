//! Repeats by label, and definitions of variables.

use super::block::Statement;
use super::cursor::Cursor;
use super::expression::Expression;
use crate::text::error::Located;

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
