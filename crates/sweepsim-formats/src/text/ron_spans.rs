//! The spans of the values of a RON text.
//!
//! The parser returns values without positions. So that an error about a value can point at it, this scans a text that
//! has already been parsed, and records the spans of all values as a tree. It never fails: it stops at unexpected text,
//! and a value that is not found has the span of the nearest one around it.

use std::collections::BTreeSet;
use std::ops::Range;

/// The span of a value, and of the values in it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SpanTree {
    pub span: Range<usize>,
    /// Fields of structs and entries of maps by the text of their key; items of lists and tuples by position.
    children: Vec<(Option<String>, SpanTree)>,
}

impl SpanTree {
    /// The tree of `text`.
    pub fn of(text: &str) -> Self {
        let mut scanner = Scanner { text, at: 0, depth: 0 };
        scanner.space();
        // Extensions, `#![enable(...)]`.
        while scanner.text[scanner.at..].starts_with("#!") {
            let rest = &scanner.text[scanner.at..];
            scanner.at += rest.find(']').map_or(rest.len(), |end| end + 1);
            scanner.space();
        }
        scanner.value()
    }

    /// The value of a field or of a map's key, also through a wrapper such as `Some( )`; `self` if there is none.
    pub fn key(&self, key: &str) -> &Self {
        let found = self.children.iter().find(|(name, _)| name.as_deref() == Some(key));
        match (found, &self.children[..]) {
            (Some((_, node)), _) => node,
            (None, [(None, wrapped)]) if wrapped.children.iter().any(|(name, _)| name.is_some()) => wrapped.key(key),
            _ => self,
        }
    }

    /// A duplicate key, with the span of its value: parsers of maps silently use the last one.
    pub fn second_key(&self) -> Option<(&str, Range<usize>)> {
        let mut seen = BTreeSet::new();
        let keys = self
            .children
            .iter()
            .filter_map(|(name, node)| Some((name.as_deref()?, node)));
        let second = keys.into_iter().find(|(key, _)| !seen.insert(*key));
        second.map(|(key, node)| (key, node.span.clone()))
    }

    /// The item at `index` of a list or tuple; `self` if there is none.
    pub fn item(&self, index: usize) -> &Self {
        self.children.get(index).map_or(self, |(_, node)| node)
    }
}

/// Deeper values are not scanned (the parser has the same limit).
const DEEPEST: usize = 128;

struct Scanner<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
}

impl Scanner<'_> {
    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    /// Skips space and comments.
    fn space(&mut self) {
        loop {
            let rest = &self.text[self.at..];
            if rest.starts_with("//") {
                self.at += rest.find('\n').unwrap_or(rest.len());
            } else if rest.starts_with("/*") {
                self.block_comment();
            } else {
                match rest.chars().next() {
                    Some(c) if c.is_whitespace() => self.at += c.len_utf8(),
                    _ => return,
                }
            }
        }
    }

    fn block_comment(&mut self) {
        let bytes = self.text.as_bytes();
        let mut nested = 0_usize;
        while self.at < bytes.len() {
            match &bytes[self.at..] {
                [b'/', b'*', ..] => {
                    nested += 1;
                    self.at += 2;
                }
                [b'*', b'/', ..] => {
                    nested -= 1;
                    self.at += 2;
                    if nested == 0 {
                        return;
                    }
                }
                _ => self.at += 1,
            }
        }
    }

    /// A string or character, from its opening quote.
    fn quoted(&mut self, quote: u8) {
        let bytes = self.text.as_bytes();
        self.at += 1;
        while let Some(&byte) = bytes.get(self.at) {
            self.at += 1;
            if byte == b'\\' {
                self.at += 1;
            } else if byte == quote {
                break;
            }
        }
        self.skip_to_boundary();
    }

    /// A raw string, from the hashes after its `r`.
    fn raw(&mut self) {
        let rest = &self.text[self.at..];
        let hashes = rest.len() - rest.trim_start_matches('#').len();
        let end = format!("\"{}", "#".repeat(hashes));
        let from = hashes + 1;
        self.at += rest
            .get(from..)
            .and_then(|inner| inner.find(&end))
            .map_or(rest.len(), |found| from + found + end.len());
    }

    fn skip_to_boundary(&mut self) {
        self.at = self.at.min(self.text.len());
        while !self.text.is_char_boundary(self.at) {
            self.at += 1;
        }
    }

    /// A word or number.
    fn word(&mut self) {
        let rest = &self.text[self.at..];
        let ends = |c: char| c.is_whitespace() || "()[]{},:\"'/".contains(c);
        self.at += rest.find(ends).unwrap_or(rest.len());
    }

    /// A value: a scalar, or an optional name and the values in its brackets.
    fn value(&mut self) -> SpanTree {
        let start = self.at;
        let mut children = Vec::new();
        match self.peek() {
            Some(b'"') => self.quoted(b'"'),
            Some(b'\'') => self.quoted(b'\''),
            Some(b'(' | b'[' | b'{') => children = self.bracketed(),
            _ => {
                self.word();
                if &self.text[start..self.at] == "r" && self.peek() == Some(b'"') {
                    self.raw();
                } else if self.text[start..self.at].starts_with("r#") && self.peek() == Some(b'"') {
                    self.at = start + 1;
                    self.raw();
                } else {
                    let after_name = self.at;
                    self.space();
                    if self.peek() == Some(b'(') && after_name > start {
                        children = self.bracketed();
                    } else {
                        self.at = after_name;
                    }
                }
            }
        }
        SpanTree {
            span: start..self.at,
            children,
        }
    }

    fn bracketed(&mut self) -> Vec<(Option<String>, SpanTree)> {
        let mut children = Vec::new();
        self.depth += 1;
        self.at += 1;
        loop {
            self.space();
            match self.peek() {
                None => break,
                Some(b')' | b']' | b'}') => {
                    self.at += 1;
                    break;
                }
                Some(b',') => self.at += 1,
                _ if self.depth > DEEPEST => self.at = self.text.len(),
                _ => {
                    let start = self.at;
                    let first = self.value();
                    self.space();
                    if self.peek() == Some(b':') {
                        self.at += 1;
                        self.space();
                        let key = self.text[first.span].to_owned();
                        children.push((Some(key), self.value()));
                    } else {
                        children.push((None, first));
                    }
                    if self.at == start {
                        // Not RON: stop.
                        self.at = self.text.len();
                    }
                }
            }
        }
        self.depth -= 1;
        children
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    #[test]
    fn finds_values() {
        let text = r##"#![enable(implicit_some)] /* a /* nested */ one */
            Job( // (
                name: "a \" ( b", raw: r#"x " ("#, c: '(',
                tools: { 1: Ball(radius: -5.0), 20: Flat ( length : 2 ) },
                poses: [((1, 2), (3,4)), ((5, 6), (7, 8))], some: Some(Mesh("f.stl")),
            )"##;
        let node = SpanTree::of(text);
        let at = |node: &SpanTree| &text[node.span.clone()];
        assert_eq!(at(node.key("name")), r#""a \" ( b""#);
        assert_eq!(at(node.key("raw")), r##"r#"x " ("#"##);
        assert_eq!(at(node.key("tools").key("1").key("radius")), "-5.0");
        assert_eq!(at(node.key("tools").key("20").key("length")), "2");
        assert_eq!(at(node.key("poses").item(1).item(0).item(1)), "6");
        assert_eq!(at(node.key("some").item(0).item(0)), "\"f.stl\"");
        assert_eq!(at(node.key("tools").key("1").key("none")), "Ball(radius: -5.0)");
    }

    proptest! {
        #[test]
        fn never_panics(text in r#"[()\[\]{},:"'/*r#é\\ \na0-9.-]{0,60}|.{0,40}"#) {
            let _ = SpanTree::of(&text);
        }
    }
}
