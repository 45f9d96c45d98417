//! Splits a line into words: a letter and a number each, with their positions.
//!
//! Numbers are read as `f64` (`+1.`, `.5`, `-0.25`, no exponents). Spaces within a word are allowed; comments in `( )` and after `;` are
//! skipped. Variables, expressions and calls are errors, since the geometry may depend on them.

use std::ops::Range;

use crate::text::error::NcProblem;

/// A letter and its number.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Word {
    /// In upper case.
    pub letter: char,
    pub value: f64,
    /// Bytes of the line.
    pub span: Range<usize>,
}

/// One line.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Block {
    pub words: Vec<Word>,
    /// Began with `/`.
    pub optional: bool,
    /// Was a `%`.
    pub tape: bool,
}

/// A problem, and the bytes of the line that it concerns.
pub(crate) type Located = (NcProblem, Range<usize>);

/// The words of `line`.
pub(crate) fn block(line: &str) -> Result<Block, Located> {
    let bytes = line.as_bytes();
    let mut block = Block::default();
    let mut at = 0;
    let skip_space = |at: &mut usize| {
        while bytes.get(*at).is_some_and(u8::is_ascii_whitespace) {
            *at += 1;
        }
    };
    loop {
        skip_space(&mut at);
        let Some(&byte) = bytes.get(at) else {
            return Ok(block);
        };
        let start = at;
        match byte {
            b';' => return Ok(block),
            // The mark of files that were saved as "UTF-8 with BOM".
            0xEF if start == 0 && line.starts_with('\u{feff}') => at += 3,
            b'(' => match line[start..].find(')') {
                Some(length) => at = start + length + 1,
                None => {
                    let problem = NcProblem::syntax("this comment is not closed: expected `)` on the same line");
                    return Err((problem, start..line.len()));
                }
            },
            b'%' if block.words.is_empty() => {
                block.tape = true;
                return Ok(block);
            }
            b'/' if block.words.is_empty() => {
                block.optional = true;
                at += 1;
            }
            b'#' | b'[' | b'<' => {
                return Err((
                    NcProblem::unsupported(
                        "variables and expressions are",
                        "expected a letter and a number; write out the values (a post-processor or simulator can)",
                    ),
                    start..start + 1,
                ));
            }
            b':' if block.words.is_empty() => {
                at += 1;
                let (value, end) = number(line, at).ok_or_else(|| no_number(line, start, ':'))?;
                block.words.push(Word {
                    letter: 'O',
                    value,
                    span: start..end,
                });
                at = end;
            }
            _ if byte.is_ascii_alphabetic() => {
                at += 1;
                skip_space(&mut at);
                let letter = char::from(byte.to_ascii_uppercase());
                let (value, end) = number(line, at).ok_or_else(|| no_number(line, start, letter))?;
                block.words.push(Word {
                    letter,
                    value,
                    span: start..end,
                });
                at = end;
            }
            _ => {
                let found = line[start..].chars().next().unwrap_or(' ');
                let problem = NcProblem::syntax(format!("found {found:?}, but expected a letter with a number"));
                return Err((problem, start..start + found.len_utf8()));
            }
        }
    }
}

/// The number at byte `at`, and the byte after it.
fn number(line: &str, mut at: usize) -> Option<(f64, usize)> {
    let bytes = line.as_bytes();
    let mut text = String::new();
    if let Some(&sign @ (b'+' | b'-')) = bytes.get(at) {
        text.push(char::from(sign));
        at += 1;
        while bytes.get(at).is_some_and(u8::is_ascii_whitespace) {
            at += 1;
        }
    }
    let start = at;
    while bytes.get(at).is_some_and(|&byte| byte.is_ascii_digit() || byte == b'.') {
        at += 1;
    }
    text.push_str(&line[start..at]);
    let value: f64 = text.parse().ok()?;
    value.is_finite().then_some((value, at))
}

fn no_number(line: &str, start: usize, letter: char) -> Located {
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
    } else if after.trim_start_matches(['+', '-']).starts_with(['#', '[']) {
        NcProblem::unsupported(
            "variables and expressions are",
            format!("expected a number after `{letter}`; write out the values (a post-processor or simulator can)"),
        )
    } else if letter == 'O' {
        NcProblem::unsupported("O-words (subroutines, loops) are", "expected a program without them")
    } else {
        NcProblem::syntax(format!("expected a number after `{letter}`"))
    };
    (problem, start..start + width)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Vec<(char, f64)> {
        block(line).unwrap().words.iter().map(|w| (w.letter, w.value)).collect()
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
        assert!(block("%").unwrap().tape);
        assert!(block("/G1").unwrap().optional);
        assert_eq!(words("X0.1234567890123456")[0].1, 0.123_456_789_012_345_6);
    }

    #[test]
    fn names_what_it_does_not() {
        for (line, column) in [
            ("G1 X#5", 3),
            ("G1 (open", 3),
            ("o<sub> call", 0),
            ("N1 DEF REAL", 3),
            ("X=5", 0),
            ("G1 X", 3),
            ("G1 &", 3),
            ("X1.2.3", 0),
            ("é", 0),
        ] {
            let (_, span) = block(line).unwrap_err();
            assert_eq!(span.start, column, "{line}");
        }
    }
}
