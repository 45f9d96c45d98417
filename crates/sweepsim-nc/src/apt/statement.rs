//! Statements: a major word, a slash, and a list of words and numbers; `$` continues a line, `$$` begins a comment.

use std::ops::Range;

/// An item of a list, with its bytes in the text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Item<'t> {
    pub text: &'t str,
    /// `None` for words.
    pub number: Option<f64>,
    pub bytes: Range<usize>,
}

impl Item<'_> {
    pub fn is(&self, word: &str) -> bool {
        self.number.is_none() && self.text.eq_ignore_ascii_case(word)
    }
}

/// A statement.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Statement<'t> {
    /// The major word, as written.
    pub major: &'t str,
    /// Whether it has a slash.
    pub slash: bool,
    pub items: Vec<Item<'t>>,
    /// What follows the major word in its first line, for statements that carry text.
    pub rest: &'t str,
    /// Whether it is a comment that carries meaning, `$$-> CUTTER`.
    pub comment: bool,
    /// The first line, from 1.
    pub line: usize,
    /// The bytes of its first line.
    pub bytes: Range<usize>,
}

impl Statement<'_> {
    pub fn is(&self, word: &str) -> bool {
        self.major.eq_ignore_ascii_case(word)
    }

    /// Whether the list has a word.
    pub fn has(&self, word: &str) -> bool {
        self.items.iter().any(|item| item.is(word))
    }

    /// The first number.
    pub fn number(&self) -> Option<f64> {
        self.items.iter().find_map(|item| item.number)
    }

    /// The numbers of the list.
    pub fn numbers(&self) -> Vec<f64> {
        self.items.iter().filter_map(|item| item.number).collect()
    }

    /// The first number after a word.
    pub fn after(&self, word: &str) -> Option<f64> {
        let at = self.items.iter().position(|item| item.is(word))?;
        self.items.get(at + 1)?.number
    }
}

/// Statements that carry text instead of a list.
const LITERAL: [&str; 7] = ["PARTNO", "PPRINT", "INSERT", "REMARK", "TPRINT", "LETTER", "DISPLY"];

/// The statements of a text.
pub(super) struct Statements<'t> {
    text: &'t str,
    /// The next byte, and its line.
    at: usize,
    line: usize,
}

impl<'t> Statements<'t> {
    pub fn of(text: &'t str) -> Self {
        Self { text, at: 0, line: 0 }
    }

    /// The next line with its bytes; counts it.
    fn next_line(&mut self) -> Option<Range<usize>> {
        if self.at >= self.text.len() {
            return None;
        }
        let start = self.at;
        let end = self.text[start..]
            .find('\n')
            .map_or(self.text.len(), |length| start + length);
        self.at = (end + 1).min(self.text.len().max(end));
        if end == self.text.len() {
            self.at = end;
        }
        self.line += 1;
        Some(start..end)
    }

    /// Whether the next line holds nothing but numbers: more of the list before it.
    fn numbers_follow(&self) -> bool {
        let line = self.text[self.at..].lines().next().unwrap_or("").trim();
        !line.is_empty()
            && line
                .chars()
                .all(|c| c.is_ascii_digit() || matches!(c, '.' | '-' | '+' | ',' | ' ' | '\t' | 'e' | 'E' | '$'))
            && line.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+'))
    }
}

impl<'t> Iterator for Statements<'t> {
    type Item = Statement<'t>;

    fn next(&mut self) -> Option<Statement<'t>> {
        loop {
            let range = self.next_line()?;
            let line = self.line;
            let mut content = trimmed(self.text, range.clone());
            let mut comment = false;
            if self.text[content.clone()].starts_with("$$") {
                let Some(rest) = self.text[content.clone()].strip_prefix("$$->") else {
                    continue;
                };
                comment = true;
                content = trimmed(self.text, content.end - rest.len()..content.end);
            }
            if content.is_empty() {
                continue;
            }
            let whole = &self.text[content.clone()];
            let word_end = whole.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(whole.len());
            let literal = LITERAL.iter().any(|word| whole[..word_end].eq_ignore_ascii_case(word));
            if literal {
                let rest = whole[word_end..].trim_start();
                let slash = rest.starts_with('/');
                return Some(Statement {
                    major: &whole[..word_end],
                    slash,
                    items: Vec::new(),
                    rest: rest.strip_prefix('/').unwrap_or(rest).trim(),
                    comment,
                    line,
                    bytes: content,
                });
            }
            let (mut part, mut goes_on) = without_comment(self.text, content.clone());
            let (major, list, slash) = match self.text[part.clone()].find('/') {
                Some(at) => (part.start..part.start + at, part.start + at + 1..part.end, true),
                None => (part.clone(), part.end..part.end, false),
            };
            let mut statement = Statement {
                major: self.text[major].trim(),
                slash,
                items: Vec::new(),
                rest: self.text[list.clone()].trim(),
                comment,
                line,
                bytes: content,
            };
            part = list;
            loop {
                split(self.text, part.clone(), &mut statement.items);
                if !(goes_on || statement.is("GOTO") && self.numbers_follow()) {
                    break;
                }
                let Some(next) = self.next_line() else { break };
                let mut content = trimmed(self.text, next);
                // Comments that carry meaning go on as comments.
                if comment && let Some(rest) = self.text[content.clone()].strip_prefix("$$->") {
                    content = content.end - rest.len()..content.end;
                }
                (part, goes_on) = without_comment(self.text, content);
                // The slash may come only here.
                if !statement.slash
                    && statement.items.is_empty()
                    && let Some(rest) = self.text[part.clone()].trim_start().strip_prefix('/')
                {
                    statement.slash = true;
                    part = part.end - rest.len()..part.end;
                }
            }
            return Some(statement);
        }
    }
}

/// A range of bytes without the white space around.
fn trimmed(text: &str, range: Range<usize>) -> Range<usize> {
    let part = &text[range.clone()];
    let front = part.trim_start_matches(|c: char| c.is_whitespace() || c == '\u{feff}');
    let start = range.start + (part.len() - front.len());
    start..start + front.trim_end().len()
}

/// A line up to `$`, and whether that continues it.
fn without_comment(text: &str, range: Range<usize>) -> (Range<usize>, bool) {
    match text[range.clone()].find('$') {
        Some(at) => {
            let goes_on = !text[range.start + at..range.end].starts_with("$$");
            (range.start..range.start + at, goes_on)
        }
        None => (range, false),
    }
}

/// Adds the items of a list.
fn split<'t>(text: &'t str, range: Range<usize>, items: &mut Vec<Item<'t>>) {
    let mut start = range.start;
    for piece in text[range].split(',') {
        let bytes = trimmed(text, start..start + piece.len());
        start += piece.len() + 1;
        if bytes.is_empty() {
            continue;
        }
        let text = &text[bytes.clone()];
        items.push(Item {
            text,
            number: number(text),
            bytes,
        });
    }
}

/// A finite number: with digits, perhaps with a sign, a point and an exponent.
fn number(text: &str) -> Option<f64> {
    let first = text.bytes().next()?;
    if !(first.is_ascii_digit() || matches!(first, b'.' | b'-' | b'+')) {
        return None;
    }
    text.parse::<f64>().ok().filter(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &str) -> Vec<Statement<'_>> {
        Statements::of(text).collect()
    }

    #[test]
    fn majors_lists_and_continuations() {
        let text = "PARTNO a / b, c\n$$ GOTO/1,2,3\n  goto / 1., $\n -2.5e1,$$ comment\n$$-> CUTTER / 3.0\n\
                    RAPID\nTOOL PATH/MILL,TOOL,D10\r\nGOTO/1,2,3\n4,5,6\nFINI";
        let found = all(text);
        let majors: Vec<&str> = found.iter().map(|s| s.major).collect();
        assert_eq!(
            majors,
            ["PARTNO", "goto", "CUTTER", "RAPID", "TOOL PATH", "GOTO", "FINI"]
        );
        assert_eq!(found[0].rest, "a / b, c");
        let numbers: Vec<_> = found[1].items.iter().map(|item| item.number).collect();
        assert_eq!((numbers, found[1].line), (vec![Some(1.0), Some(-25.0)], 3));
        assert!(found[2].comment && found[2].number() == Some(3.0));
        assert_eq!(found[4].items[2].text, "D10");
        assert_eq!(found[5].items.len(), 6);
        assert_eq!((found[6].line, found[5].line), (10, 8));
        assert_eq!(&text[found[1].items[1].bytes.clone()], "-2.5e1");
    }

    #[test]
    fn what_is_no_number() {
        assert_eq!(
            ["inf", "nan", "-", "1STPECK", "1.2.3", "", "1e999"].map(number),
            [None; 7]
        );
        assert_eq!(
            ["5.", ".5", "-.5", "+1E2"].map(number),
            [Some(5.0), Some(0.5), Some(-0.5), Some(100.0)]
        );
        assert!(all("").is_empty() && all("\n \n$$\n").is_empty());
        assert_eq!(all("GOTO/1,$").len(), 1);
        assert_eq!(all("CUTTER $\n/ 5").first().and_then(Statement::number), Some(5.0));
    }
}
