//! Splits a line into words: a letter and a value each, with their positions.
//!
//! Numbers are read as `f64` (`+1.`, `.5`, `-0.25`, no exponents). Spaces within a word are allowed; comments in `( )` and after `;` are
//! skipped, except for those that speak to the operator.

use super::block::{Block, Word};
use super::cursor::Cursor;
use super::expression::{NoVariables, Values, Variables};
use crate::text::error::{Located, NcProblem};

/// The words of `line` in `block`, which is cleared before.
pub(crate) fn read(line: &str, variables: &dyn Variables, block: &mut Block) -> Result<(), Located> {
    block.clear();
    read_from(Cursor::new(line), variables, block)
}

/// The words from a cursor on, in addition to those in `block`.
pub(crate) fn read_from(cursor: Cursor, variables: &dyn Variables, block: &mut Block) -> Result<(), Located> {
    let line = cursor.line;
    let mut values = Values::new(cursor, variables);
    while let Some(byte) = values.cursor.peek() {
        let start = values.cursor.at;
        match byte {
            b';' => {
                note_message(block, line, start + 1, line.len());
                return Ok(());
            }
            b'(' => match line[start..].find(')') {
                Some(length) => {
                    note_message(block, line, start + 1, start + length);
                    values.cursor.at += length + 1;
                }
                None => {
                    let problem = NcProblem::syntax("this comment is not closed: expected `)` on the same line");
                    return Err((problem, start..line.len()));
                }
            },
            b'%' if block.is_empty() => {
                block.tape = true;
                return Ok(());
            }
            b'/' if block.is_empty() => {
                block.optional = true;
                values.cursor.at += 1;
                // Fanuc numbers the switches: /2 G1.
                if matches!(line.as_bytes().get(values.cursor.at), Some(b'1'..=b'9')) {
                    values.cursor.at += 1;
                }
            }
            b'#' => assignment(&mut values, block)?,
            b',' => after_comma(&mut values, block)?,
            b':' if block.is_empty() => {
                values.cursor.at += 1;
                let Some(digits) = values.cursor.digits() else {
                    return Err(no_value(line, start, ':'));
                };
                block.push(Word::new('O', digits.value, start..values.cursor.at))?;
            }
            _ if byte.is_ascii_alphabetic() => {
                values.cursor.at += 1;
                let letter = char::from(byte.to_ascii_uppercase());
                let fast = values.cursor;
                // Most words are a letter and plain digits.
                if let Some(digits) = values.cursor.digits() {
                    let mut word = Word::new(letter, digits.value, start..values.cursor.at);
                    word.whole = digits.whole;
                    block.push(word)?;
                    continue;
                }
                values.cursor = fast;
                if !values.follows() {
                    return Err(no_value(line, start, letter));
                }
                values.address = Some(letter);
                let read = values.value();
                values.address = None;
                let (value, whole) = match read {
                    Ok(value) => value,
                    // `X1.2.3`, `FOO`.
                    Err(error)
                        if line[start..].starts_with(|c: char| c.is_ascii_alphabetic()) && error.1.start == fast.at =>
                    {
                        return Err(no_value_or(line, start, letter, error));
                    }
                    Err(error) => return Err(error),
                };
                // A variable without a value: the word does not count.
                if let Some(value) = value {
                    let mut word = Word::new(letter, value, start..values.cursor.at);
                    word.whole = whole;
                    block.push(word)?;
                }
            }
            _ => return Err(values.cursor.unexpected("a letter with a number")),
        }
    }
    Ok(())
}

/// The words of a line in which variables do not matter.
pub(crate) fn plain(line: &str) -> Result<Block, Located> {
    let mut block = Block::default();
    read(line, &NoVariables, &mut block)?;
    Ok(block)
}

/// `,R5` and `,C2`, a corner at the end of the move, and `,A45`, the angle of its line.
fn after_comma(values: &mut Values, block: &mut Block) -> Result<(), Located> {
    let start = values.cursor.at;
    let unexpected = values.cursor.unexpected("a letter with a number");
    values.cursor.at += 1;
    let letter = values.cursor.peek().map(|byte| byte.to_ascii_uppercase());
    let place = match letter {
        Some(b'R' | b'C') => &mut block.corner,
        Some(b'A') => &mut block.angle,
        _ => return Err(unexpected),
    };
    values.cursor.at += 1;
    if place.is_some() || !values.follows() {
        return Err(unexpected);
    }
    let (value, _) = values.value()?;
    let letter = letter.map_or(',', char::from);
    *place = value.map(|value| Word::new(letter, value, start..values.cursor.at));
    Ok(())
}

/// `#1 = 5`
fn assignment(values: &mut Values, block: &mut Block) -> Result<(), Located> {
    let target = values.target()?;
    if !values.cursor.eat(b'=') {
        return Err(values
            .cursor
            .unexpected("`=` after a variable at the beginning of a block"));
    }
    let value = values.expression()?;
    block.assignments.push((target, value));
    Ok(())
}

/// Remembers a comment that speaks to the operator.
fn note_message(block: &mut Block, line: &str, start: usize, end: usize) {
    let text = &line.as_bytes()[start..end];
    let skipped = text.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
    let text = &text[skipped..];
    let says = |word: &[u8]| text.len() >= word.len() && text[..word.len()].eq_ignore_ascii_case(word);
    if says(b"MSG,") || says(b"DEBUG,") || says(b"PRINT,") {
        block.message = Some(start + skipped..end);
    }
}

/// The more telling of two errors: that of the number, if it is one.
fn no_value_or(line: &str, start: usize, letter: char, error: Located) -> Located {
    let next = line[start + 1..].trim_start();
    if next.starts_with(['[', '#', '+', '-']) {
        error
    } else {
        no_value(line, start, letter)
    }
}

fn no_value(line: &str, start: usize, letter: char) -> Located {
    let rest = &line[start..];
    let word: String = rest
        .chars()
        .take_while(|c| c.is_ascii_alphanumeric() || *c == '_')
        .collect();
    let after = rest[letter.len_utf8()..].trim_start();
    let width = word.len().max(1);
    let problem = if word.chars().filter(char::is_ascii_alphabetic).count() > 1 || after.starts_with('=') {
        NcProblem::unsupported(
            format!("statements like `{}` are", if word.is_empty() { ":" } else { &word }),
            "expected RS-274 words, a letter and a number each (Siemens and macro programs: post-process them first)",
        )
    } else {
        NcProblem::syntax(format!("expected a number after `{letter}`"))
    };
    (problem, start..start + width)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Vec<(char, f64)> {
        let block = plain(line).unwrap();
        block.words().iter().map(|w| (w.letter, w.value)).collect()
    }

    #[test]
    fn reads_what_controls_read() {
        assert_eq!(
            words("n10 G01X-1.5 y +.25 Z 3. (x9) F - 2;Q7"),
            [
                ('N', 10.0),
                ('G', 1.0),
                ('X', -1.5),
                ('Y', 0.25),
                ('Z', 3.0),
                ('F', -2.0)
            ]
        );
        assert!(plain("%").unwrap().tape);
        assert!(plain("/G1").unwrap().optional);
        assert_eq!(words("/2 G1"), [('G', 1.0)]);
        assert_eq!(words("X0.1234567890123456")[0].1, 0.123_456_789_012_345_6);
    }

    #[test]
    fn reads_expressions() {
        for (text, value) in [
            ("X[1+2*3]", 7.0),
            ("X[[1+2]*3]", 9.0),
            ("X[2**3**2]", 64.0),
            ("X[7 MOD 4]", 3.0),
            ("X[-7 MOD 4]", 1.0),
            ("X-[1-2-3]", 4.0),
            ("X SIN[30]", 0.5),
            ("X ATAN[1]/[1]", 45.0),
            ("X ATAN[1,-1]", 135.0),
            ("X[1 EQ 1 AND 0 GT 1]", 0.0),
            ("X[SQRT[16]/ABS[-2]]", 2.0),
            ("X ROUND[-2.5]", -3.0),
            ("X FIX[-2.5]", -3.0),
            ("X FUP[2.1]", 3.0),
            ("X[10-4/2]", 8.0),
            ("X[1/[2/4]]", 2.0),
            ("X--5", 5.0),
        ] {
            let found = words(text)[0].1;
            assert!((found - value).abs() < 1e-12, "{text}: {found}");
        }
    }

    #[test]
    fn names_what_it_does_not() {
        for (line, column) in [
            ("G1 X5]", 5),
            ("G1 (open", 3),
            ("o<sub> call", 0),
            ("N1 DEF REAL", 3),
            ("X=5", 0),
            ("G1 X", 3),
            ("G1 &", 3),
            ("X1.2.3", 0),
            ("é", 0),
            ("X[1", 2),
            ("X[1/0]", 3),
            ("X SQRT[-1]", 2),
            ("X FOO[1]", 2),
            ("#1 5", 3),
            ("X#", 1),
        ] {
            let (_, span) = plain(line).unwrap_err();
            assert_eq!(span.start, column, "{line}");
        }
        assert!(plain(&format!("X{}1", "[".repeat(1000))).is_err());
        assert!(plain(&format!("X{}1", "#".repeat(1000))).is_err());
        assert!(plain(&format!("X{}1", "SIN[".repeat(1000))).is_err());
    }
}
