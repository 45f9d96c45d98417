//! The text of a STEP file (ISO 10303-21), statement by statement, before a library reads it.
//!
//! What the library would take silently or not survive is found here: a file that ends too early, numbers that are
//! given twice, further data sections, and lists nested so deeply that reading them would overflow the stack. The scan
//! remembers where each entity is, so that errors show it, and writes the text anew in the forms that the library
//! knows ([`Scan::rewritten`]).

use std::ops::Range;

use sweepsim_nc::TextPosition;

use super::tori;
use crate::error::{FormatError, Problem};

/// The most lists in one another. Real files have six.
const MOST_NESTED: usize = 100;

/// Where the entities of a file are.
#[derive(Debug, Default)]
pub(super) struct Scan {
    /// The number of each entity, and its statement with the semicolon, in the order of the numbers.
    entities: Vec<(u64, Range<usize>)>,
    /// Where each data entity's keyword is; empty for an entity of several types.
    keywords: Vec<Range<usize>>,
    /// The schemas that the header names.
    pub schemas: Vec<String>,
}

/// An error at a place of the text.
pub(super) fn at(text: &[u8], bytes: Range<usize>, message: impl Into<String>) -> FormatError {
    // Only the line is looked at, as files are large.
    let begin = bytes.start.min(text.len());
    let before = text[..begin].iter().rposition(|b| *b == b'\n').map_or(0, |k| k + 1);
    let after = text[begin..]
        .iter()
        .position(|b| *b == b'\n')
        .map_or(text.len(), |k| begin + k);
    let line = text[..before].iter().filter(|b| **b == b'\n').count() + 1;
    let whole = String::from_utf8_lossy(&text[before..after]);
    let column = String::from_utf8_lossy(&text[before..begin]).chars().count() + 1;
    let width = String::from_utf8_lossy(&text[begin..bytes.end.clamp(begin, after)])
        .chars()
        .count();
    let position = TextPosition::in_line(line, whole.trim_end(), column, width);
    FormatError::new(Problem::syntax(message), Some(position))
}

impl Scan {
    /// Scans a file.
    ///
    /// # Errors
    /// [`FormatError`] at its place.
    pub fn new(text: &[u8]) -> Result<Self, FormatError> {
        let mut cursor = Cursor { text, at: 0 };
        if text.starts_with(b"PK") || text.starts_with(&[0x1f, 0x8b]) {
            return Err(at(text, 0..1, "this STEP file is compressed: expected its text"));
        }
        let first = cursor.statement()?;
        if first.as_ref().is_none_or(|s| &text[s.clone()] != b"ISO-10303-21;") {
            return Err(at(
                text,
                0..1,
                "this is no STEP file: expected ISO-10303-21; at its beginning",
            ));
        }
        let mut scan = Self::default();
        let mut data = false;
        loop {
            let Some(statement) = cursor.statement()? else {
                let message = "this STEP file ends before END-ISO-10303-21;: expected the rest of it";
                return Err(at(text, text.len()..text.len(), message));
            };
            let words = &text[statement.clone()];
            match words {
                b"END-ISO-10303-21;" => break,
                [b'#', ..] => scan.entity(text, statement)?,
                [b'D', b'A', b'T', b'A', b';' | b'(' | b' ', ..] if data => {
                    return Err(at(text, statement, "a second DATA section is not read: expected one"));
                }
                [b'D', b'A', b'T', b'A', b';' | b'(' | b' ', ..] => data = true,
                _ if words.starts_with(b"FILE_SCHEMA") => scan.schemas = strings(words),
                _ => {}
            }
        }
        let mut order: Vec<usize> = (0..scan.entities.len()).collect();
        order.sort_by_key(|k| (scan.entities[*k].0, *k));
        for pair in order.windows(2) {
            let [(one, _), (other, place)] = [&scan.entities[pair[0]], &scan.entities[pair[1]]];
            if one == other {
                let message = format!("#{one} is there twice: expected each number once");
                return Err(at(text, place.clone(), message));
            }
        }
        scan.keywords = order.iter().map(|k| scan.keywords[*k].clone()).collect();
        scan.entities = order.iter().map(|k| scan.entities[*k].clone()).collect();
        Ok(scan)
    }

    fn entity(&mut self, text: &[u8], statement: Range<usize>) -> Result<(), FormatError> {
        let mut cursor = Cursor {
            text,
            at: statement.start + 1,
        };
        let digits = cursor.run(u8::is_ascii_digit);
        let number = std::str::from_utf8(&text[digits])
            .ok()
            .and_then(|digits| digits.parse().ok());
        cursor.blank();
        let Some(number) = number.filter(|_| text.get(cursor.at) == Some(&b'=')) else {
            return Err(at(text, statement, "expected a number and = after #"));
        };
        cursor.at += 1;
        cursor.blank();
        let keyword = cursor.run(|b| b.is_ascii_alphanumeric() || *b == b'_');
        self.entities.push((number, statement));
        self.keywords.push(keyword);
        Ok(())
    }

    /// Which of the entities has a number.
    fn find(&self, number: usize) -> Option<usize> {
        let found = self
            .entities
            .binary_search_by_key(&(number as u64), |(number, _)| *number);
        found.ok()
    }

    /// The statement of an entity.
    pub fn place(&self, number: usize) -> Option<Range<usize>> {
        Some(self.entities[self.find(number)?].1.clone())
    }

    /// The attributes of an entity.
    pub fn attributes<'a>(&self, text: &'a [u8], number: usize) -> Option<Vec<&'a [u8]>> {
        let found = self.find(number)?;
        let range = self.keywords[found].end..self.entities[found].1.end;
        Some(attributes(text, range).into_iter().map(|range| &text[range]).collect())
    }

    /// The text for the library. Each name of a face or an edge becomes its number, as `#12`, which the library hands
    /// through with it; a solid with voids becomes an entity of two types, and a product definition with documents one
    /// without.
    ///
    /// # Errors
    /// [`FormatError`] where an entity has too few attributes.
    pub fn rewritten(&self, text: &[u8]) -> Result<Vec<u8>, FormatError> {
        let mut out = Vec::with_capacity(text.len() + text.len() / 64);
        let mut order: Vec<usize> = (0..self.entities.len()).collect();
        order.sort_by_key(|k| self.entities[*k].1.start);
        let mut done = 0;
        let mut next = self.entities.last().map_or(1, |(number, _)| number.saturating_add(1));
        for k in order {
            let (number, statement) = self.entities[k].clone();
            let keyword = self.keywords[k].clone();
            let short = || at(text, statement.clone(), format!("#{number} has too few attributes"));
            match &text[keyword.clone()] {
                b"ADVANCED_FACE" | b"FACE_SURFACE" | b"EDGE_CURVE" => {
                    let name = attributes(text, keyword.end..statement.end)
                        .into_iter()
                        .next()
                        .ok_or_else(short)?;
                    out.extend_from_slice(&text[done..name.start]);
                    out.extend_from_slice(format!("'#{number}'").as_bytes());
                    done = name.end;
                }
                b"BREP_WITH_VOIDS" => {
                    let found = attributes(text, keyword.end..statement.end);
                    let [name, outer, voids] = &found[..] else {
                        return Err(short());
                    };
                    let [name, outer, voids] = [name, outer, voids].map(|range| &text[range.clone()]);
                    out.extend_from_slice(&text[done..keyword.start]);
                    for piece in [
                        b"(BREP_WITH_VOIDS(",
                        voids,
                        b")MANIFOLD_SOLID_BREP(",
                        name,
                        b",",
                        outer,
                        b"));",
                    ] {
                        out.extend_from_slice(piece);
                    }
                    done = statement.end;
                }
                b"TOROIDAL_SURFACE" | b"DEGENERATE_TOROIDAL_SURFACE" => {
                    let attributes = |number| self.attributes(text, number);
                    if let Some(revolved) = tori::revolved(number, attributes, &mut next) {
                        out.extend_from_slice(&text[done..keyword.start]);
                        out.extend_from_slice(revolved.as_bytes());
                        done = statement.end;
                    }
                }
                b"PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS" => {
                    out.extend_from_slice(&text[done..keyword.start]);
                    out.extend_from_slice(b"PRODUCT_DEFINITION");
                    done = keyword.end;
                }
                _ => {}
            }
        }
        out.extend_from_slice(&text[done..]);
        Ok(out)
    }

    /// The name of a face in the file, if it has one.
    pub fn face_name(&self, text: &[u8], number: usize) -> Option<String> {
        let name = *self.attributes(text, number)?.first()?;
        let name = strings(name).into_iter().next()?;
        (!matches!(name.as_str(), "" | "NONE")).then_some(name)
    }
}

/// The attributes of an entity: what is between the commas of the list that begins in `range`.
fn attributes(text: &[u8], range: Range<usize>) -> Vec<Range<usize>> {
    let mut cursor = Cursor { text, at: range.start };
    let (mut found, mut depth, mut begin) = (Vec::new(), 0_usize, range.start);
    while cursor.at < range.end {
        cursor.blank();
        let here = cursor.at;
        match text.get(here) {
            Some(b'\'' | b'"') => {
                let _ = cursor.quoted();
                continue;
            }
            Some(b'(') => {
                depth += 1;
                if depth == 1 {
                    begin = here + 1;
                }
            }
            Some(b',') if depth == 1 => {
                found.push(begin..here);
                begin = here + 1;
            }
            Some(b')') => {
                if depth == 1 {
                    found.push(begin..here);
                    break;
                }
                depth = depth.saturating_sub(1);
            }
            None => break,
            _ => {}
        }
        cursor.at += 1;
    }
    found
}

/// The texts in quotes of a statement.
fn strings(words: &[u8]) -> Vec<String> {
    let mut cursor = Cursor { text: words, at: 0 };
    let mut found = Vec::new();
    while cursor.at < words.len() {
        cursor.blank();
        let begin = cursor.at;
        if words.get(begin) == Some(&b'\'') && cursor.quoted().is_ok() {
            let inside = String::from_utf8_lossy(&words[begin + 1..cursor.at - 1]);
            found.push(inside.replace("''", "'"));
        } else {
            cursor.at += 1;
        }
    }
    found
}

/// A place in the text.
struct Cursor<'a> {
    text: &'a [u8],
    at: usize,
}

impl Cursor<'_> {
    fn run(&mut self, holds: impl Fn(&u8) -> bool) -> Range<usize> {
        let begin = self.at;
        self.at += self.text[begin..].iter().take_while(|b| holds(b)).count();
        begin..self.at
    }

    /// Skips blanks and comments.
    fn blank(&mut self) {
        loop {
            self.run(u8::is_ascii_whitespace);
            if !self.text[self.at..].starts_with(b"/*") {
                return;
            }
            let inside = &self.text[self.at + 2..];
            let end = inside.windows(2).position(|pair| pair == b"*/");
            self.at = end.map_or(self.text.len(), |end| self.at + end + 4);
        }
    }

    /// Skips a text in quotes, whose own quotes are doubled.
    fn quoted(&mut self) -> Result<(), FormatError> {
        let (begin, quote) = (self.at, self.text[self.at]);
        loop {
            self.at += 1;
            self.run(|b| *b != quote);
            if self.at >= self.text.len() {
                return Err(at(
                    self.text,
                    begin..begin + 1,
                    "this text has no end: expected a quote",
                ));
            }
            self.at += 1;
            if self.text.get(self.at) != Some(&quote) {
                return Ok(());
            }
        }
    }

    /// The next statement, with its semicolon; `None` at the end of the text.
    fn statement(&mut self) -> Result<Option<Range<usize>>, FormatError> {
        // A mark of UTF-8 at the very beginning.
        if self.at == 0 && self.text.starts_with(&[0xef, 0xbb, 0xbf]) {
            self.at = 3;
        }
        self.blank();
        let begin = self.at;
        let mut depth = 0_usize;
        while let Some(byte) = self.text.get(self.at) {
            match byte {
                b'\'' | b'"' => {
                    self.quoted()?;
                    continue;
                }
                b'/' => {
                    let here = self.at;
                    self.blank();
                    self.at = self.at.max(here + 1);
                    continue;
                }
                b'(' => depth += 1,
                b')' => depth = depth.saturating_sub(1),
                b';' => {
                    self.at += 1;
                    return Ok(Some(begin..self.at));
                }
                _ => {}
            }
            if depth > MOST_NESTED {
                let message = format!("more than {MOST_NESTED} lists in one another: expected fewer");
                return Err(at(self.text, self.at..self.at + 1, message));
            }
            self.at += 1;
        }
        if begin == self.text.len() {
            return Ok(None);
        }
        Err(at(
            self.text,
            begin..begin + 1,
            "this statement has no end: expected a semicolon",
        ))
    }
}
