//! Blocks: words, assignments, keywords and control structures.

use super::cursor::{Cursor, without_comment};
use super::expression::Expression;
use super::structures::{Item, Statement, case, define, head, jump, repeat};
use crate::text::error::{Located, NcProblem};

/// A line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Line {
    /// The number after N, and the label.
    pub labels: Vec<String>,
    pub skipped: bool,
    pub statement: Statement,
}

/// Addresses of more than one letter.
const ADDRESSES: [&str; 45] = [
    "CR", "AR", "TURN", "AP", "RP", "RPL", "I1", "J1", "K1", "A2", "B2", "C2", "A3", "B3", "C3", "A4", "B4", "C4",
    "A5", "B5", "C5", "LEAD", "TILT", "THETA", "RND", "RNDM", "CHF", "CHR", "FRC", "FRCM", "ANG", "DISR", "DISCL",
    "DISC", "FAD", "ADIS", "ADISPOS", "CTOL", "OTOL", "ATOL", "SPOS", "SPOSA", "FB", "FD", "STOLF",
];

/// Whether `name=` is an address rather than a variable.
fn is_address(name: &str) -> bool {
    let mut chars = name.chars();
    let Some(first) = chars.next() else { return false };
    let digits = chars.as_str();
    ADDRESSES.contains(&name)
        || (first != 'R' && first.is_ascii_uppercase() && digits.is_empty())
        // Spindles and axes with numbers: S1=, M2=, X1=.
        || ("SMXYZ".contains(first) && digits.len() == 1 && digits.chars().all(|c| c.is_ascii_digit()))
}

/// Reads a line.
pub(crate) fn line(text: &str) -> Result<Line, Located> {
    let code = without_comment(text.trim_end().trim_start_matches('\u{feff}'));
    // Bytes count from the line's own beginning.
    let offset = text.len() - text.trim_start_matches('\u{feff}').len();
    let shift = |(problem, span): Located| (problem, span.start + offset..span.end + offset);
    let mut cursor = Cursor::new(code);
    let mut line = Line {
        labels: Vec::new(),
        skipped: false,
        statement: Statement::Block(Vec::new()),
    };
    if cursor.peek() == Some('/') {
        line.skipped = true;
        cursor.at += 1;
        if cursor.adjacent().is_some_and(|c| c.is_ascii_digit()) {
            cursor.at += 1;
        }
    }
    // The number of a main block, `:10`.
    if cursor.peek() == Some(':') {
        cursor.at += 1;
        cursor.at += cursor.rest().len() - cursor.rest().trim_start_matches(|c: char| c.is_ascii_digit()).len();
    }
    loop {
        let mut ahead = cursor.clone();
        let Some((name, _)) = ahead.name() else { break };
        let (mut name, next) = (name, ahead.adjacent());
        if let Some(first) = first_of(&name, next).filter(|_| name.starts_with('N')) {
            ahead.at -= name.len() - first;
            name.truncate(first);
        }
        let number = name.len() > 1 && name.starts_with('N') && name[1..].chars().all(|c| c.is_ascii_digit());
        let label = ahead.peek() == Some(':') && !ahead.rest().starts_with(":=");
        if label {
            ahead.at += 1;
        } else if !number || !line.labels.is_empty() {
            break;
        }
        line.labels.push(name);
        cursor = ahead;
    }
    line.statement = statement(&mut cursor).map_err(shift)?;
    Ok(line)
}

fn statement(cursor: &mut Cursor) -> Result<Statement, Located> {
    let key = cursor.peek_name().unwrap_or_default();
    let start = cursor.clone();
    let mut skip = || {
        cursor.name();
    };
    let statement = match key.as_str() {
        "GOTO" | "GOTOC" | "GOTOF" | "GOTOB" => {
            let (search, label) = jump(cursor)?;
            Statement::Goto(search, label)
        }
        "IF" => {
            skip();
            let condition = Expression::parse(cursor)?;
            match cursor.peek_name() {
                Some(name) if name.starts_with("GOTO") => {
                    let (search, label) = jump(cursor)?;
                    Statement::IfGoto(condition, search, label)
                }
                _ => Statement::If(condition),
            }
        }
        "ELSE" => {
            skip();
            Statement::Else
        }
        "ENDIF" => {
            skip();
            Statement::EndIf
        }
        "WHILE" => {
            skip();
            Statement::While(Expression::parse(cursor)?)
        }
        "ENDWHILE" | "ENDFOR" | "ENDLOOP" => {
            skip();
            Statement::EndLoop(match key.as_str() {
                "ENDWHILE" => "WHILE",
                "ENDFOR" => "FOR",
                _ => "LOOP",
            })
        }
        "FOR" => {
            skip();
            let first = item(cursor)?;
            match cursor.name() {
                Some((name, _)) if name == "TO" => Statement::For(vec![first], Expression::parse(cursor)?),
                _ => return Err(cursor.unexpected("TO")),
            }
        }
        "LOOP" => {
            skip();
            Statement::Loop
        }
        "UNTIL" => {
            skip();
            Statement::Until(Expression::parse(cursor)?)
        }
        "REPEAT" | "REPEATB" => repeat(cursor)?,
        "DEF" => define(cursor)?,
        "PROC" => Statement::Proc(head(cursor)?),
        "CASE" if is_whole_word(&start) => case(cursor)?,
        "EXTERN" | "REDEF" => {
            cursor.at += cursor.rest().len();
            Statement::Declaration
        }
        "DEFINE" | "ID" | "IDS" | "WHEN" | "WHENEVER" | "EVERY" | "FROM" if is_whole_word(&start) => {
            let mut at = start.clone();
            let span = at.name().map_or(0..0, |(_, span)| span);
            let problem = NcProblem::unsupported(format!("{key} is"), "expected a program without it");
            return Err((problem, span));
        }
        _ => {
            let mut items = Vec::new();
            while cursor.peek().is_some() {
                items.push(item(cursor)?);
            }
            Statement::Block(items)
        }
    };
    if cursor.peek().is_some() {
        return Err(cursor.unexpected("the end of the block"));
    }
    Ok(statement)
}

/// Whether a keyword is not the name of a variable that gets a value.
fn is_whole_word(at: &Cursor) -> bool {
    let mut ahead = at.clone();
    ahead.name();
    !matches!(ahead.peek(), Some('=' | '['))
}

/// Where the first word ends of some that stand without blanks, as `G0X1Y2`: none of them has more than one letter, and what follows is no `=` or
/// list.
fn first_of(name: &str, next: Option<char>) -> Option<usize> {
    let words = name.split_inclusive(|c: char| c.is_ascii_digit());
    let mut letters = words.map(|word| word.bytes().filter(u8::is_ascii_alphabetic).count());
    let ends_in_letter = name.ends_with(|c: char| c.is_ascii_alphabetic());
    let number_follows = next.is_some_and(|c| "+-.".contains(c));
    let complete = match ends_in_letter {
        true => number_follows || next == Some('='),
        false => next.is_none_or(|c| c.is_whitespace() || c == '.'),
    };
    let begins = name.starts_with(|c: char| c.is_ascii_alphabetic());
    let digits = |c: char| c.is_ascii_digit();
    if !(complete && begins && letters.all(|count| count <= 1) && name.bytes().all(|b| b.is_ascii_alphanumeric())) {
        return None;
    }
    let first = 1 + name[1..].find(|c| !digits(c))?;
    (first > 1).then_some(first)
}

fn item(cursor: &mut Cursor) -> Result<Item, Located> {
    let Some((mut name, mut span)) = cursor.name() else {
        return Err(cursor.unexpected("a word"));
    };
    if let Some(first) = first_of(&name, cursor.adjacent()) {
        name.truncate(first);
        span.end = span.start + first;
        cursor.at = span.end;
    }
    let mut chars = name.chars();
    let letter = chars.next().unwrap_or('_');
    let digits = chars.as_str();
    // An address and its number: X10, X-.5, G1.
    let sign = cursor.adjacent();
    let number_follows = digits.is_empty() && sign.is_some_and(|c| c.is_ascii_digit() || "+-.".contains(c));
    let number_within = !digits.is_empty() && digits.starts_with(|c: char| c.is_ascii_digit());
    let equals = {
        let mut ahead = cursor.clone();
        ahead.take("=") && ahead.adjacent() != Some('=')
    };
    if letter.is_ascii_uppercase()
        && (number_follows || number_within && !equals && digits.bytes().all(|b| b.is_ascii_digit()))
    {
        let mut at = cursor.clone();
        at.at = span.start + 1;
        let negative = at.adjacent() == Some('-');
        if matches!(at.adjacent(), Some('+' | '-')) {
            at.at += 1;
        }
        let value = at.number()?;
        cursor.at = at.at;
        let span = span.start..cursor.at;
        let value = Expression::number(if negative { -value } else { value }, span.clone());
        return Ok(Item::Word {
            name: letter.to_string(),
            value,
            span,
        });
    }
    let indices = if cursor.peek() == Some('[') {
        Expression::indices(cursor)?
    } else {
        Vec::new()
    };
    if cursor.take("=") {
        let value = Expression::parse(cursor)?;
        let span = span.start..cursor.at;
        return Ok(if indices.is_empty() && is_address(&name) {
            Item::Word { name, value, span }
        } else {
            Item::Set {
                name,
                indices,
                value,
                span,
            }
        });
    }
    let mut arguments = None;
    if cursor.peek() == Some('"') && matches!(name.as_str(), "CALL" | "EXTCALL") {
        arguments = Some(vec![Some(Expression::parse(cursor)?)]);
    } else if cursor.peek() == Some('(') {
        cursor.expect('(')?;
        let mut list = Vec::new();
        loop {
            match cursor.peek() {
                Some(',') => {
                    cursor.expect(',')?;
                    list.push(None);
                }
                Some(')') => {
                    cursor.expect(')')?;
                    break;
                }
                _ => {
                    list.push(Some(Expression::parse(cursor)?));
                    if cursor.peek() == Some(',') {
                        cursor.expect(',')?;
                    } else {
                        cursor.expect(')')?;
                        break;
                    }
                }
            }
        }
        arguments = Some(list);
    }
    Ok(Item::Key {
        name,
        arguments,
        span: span.start..cursor.at,
    })
}
