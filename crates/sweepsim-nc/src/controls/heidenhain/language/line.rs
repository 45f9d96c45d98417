//! Blocks of Klartext: words in order, each a name with what is written on it.

use std::ops::Range;

/// A word of a block: `X+10`, `IX-5`, `R0`, `FMAX`, `Q5=`, `+Q1`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::controls::heidenhain) struct Token {
    /// In capitals.
    pub text: String,
    pub span: Range<usize>,
}

/// A block.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::controls::heidenhain) struct Line {
    pub skipped: bool,
    pub tokens: Vec<Token>,
}

/// Divides a line into words, without its number and comment.
pub(in crate::controls::heidenhain) fn line(text: &str) -> Line {
    let mut quoted = false;
    let mut code = text;
    for (at, c) in text.char_indices() {
        match c {
            '"' => quoted = !quoted,
            ';' if !quoted => {
                code = &text[..at];
                break;
            }
            _ => {}
        }
    }
    let mut line = Line::default();
    let bytes = code.as_bytes();
    let mut at = 0;
    while at < bytes.len() {
        if bytes[at].is_ascii_whitespace() || !code.is_char_boundary(at) {
            at += 1;
            continue;
        }
        let start = at;
        if bytes[at] == b'"' {
            at = code[at + 1..].find('"').map_or(code.len(), |end| at + 1 + end + 1);
        } else {
            while at < bytes.len() && !bytes[at].is_ascii_whitespace() {
                at += 1;
            }
        }
        let text = code[start..at].trim_matches('\u{feff}').to_ascii_uppercase();
        let first = line.tokens.iter().all(|token| is_number(&token.text));
        if text == "/" && first {
            line.skipped = true;
        } else if let Some(rest) = text.strip_prefix('/').filter(|_| line.tokens.is_empty()) {
            line.skipped = true;
            push(&mut line, rest.to_owned(), start + 1..at);
        } else if !text.is_empty() {
            push(&mut line, text, start..at);
        }
    }
    // The number of the block.
    if line.tokens.first().is_some_and(|token| is_number(&token.text)) {
        line.tokens.remove(0);
    }
    match line.word(0) {
        "FN" | "Q" => {}
        word if word.starts_with("FN") || word.starts_with('Q') => {}
        // LBL2 is LBL 2.
        word if word.strip_prefix("LBL").is_some_and(|label| !label.is_empty()) => {
            let label = word[3..].to_owned();
            line.tokens[0].text = "LBL".into();
            let span = line.span(0);
            line.tokens.insert(1, Token { text: label, span });
        }
        _ => join_signs(&mut line.tokens),
    }
    line
}

fn is_number(text: &str) -> bool {
    text.bytes().all(|b| b.is_ascii_digit())
}

/// `X + 10` is X+10.
fn join_signs(tokens: &mut Vec<Token>) {
    let mut at = 1;
    while at + 1 < tokens.len() {
        let is_axis = |text: &str| text.len() <= 3 && text.bytes().all(|b| b.is_ascii_alphabetic());
        if matches!(tokens[at].text.as_str(), "+" | "-") && is_axis(&tokens[at - 1].text) {
            let (sign, value) = (tokens.remove(at), tokens.remove(at));
            let name = &mut tokens[at - 1];
            name.text = format!("{}{}{}", name.text, sign.text, value.text);
            name.span.end = value.span.end;
        } else {
            at += 1;
        }
    }
}

fn push(line: &mut Line, text: String, span: Range<usize>) {
    line.tokens.push(Token { text, span });
}

impl Line {
    pub fn word(&self, index: usize) -> &str {
        self.tokens.get(index).map_or("", |token| token.text.as_str())
    }

    /// Whether the block begins with these words.
    pub fn begins(&self, words: &[&str]) -> bool {
        words.iter().enumerate().all(|(index, word)| self.word(index) == *word)
    }

    pub fn span(&self, index: usize) -> Range<usize> {
        self.tokens.get(index).map_or(0..0, |token| token.span.clone())
    }

    /// The bytes from the first word to the last.
    pub fn all(&self) -> Range<usize> {
        match (self.tokens.first(), self.tokens.last()) {
            (Some(first), Some(last)) => first.span.start..last.span.end,
            _ => 0..0,
        }
    }
}

/// A word without its leading I, and whether it had one: a relative value.
pub(in crate::controls::heidenhain) fn relative(word: &str) -> (bool, &str) {
    word.strip_prefix('I').map_or((false, word), |rest| (true, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words() {
        let found = line("12 L X+10 iy-5 R0 FMAX M3 ; a comment");
        let words: Vec<&str> = found.tokens.iter().map(|token| token.text.as_str()).collect();
        assert_eq!(words, ["L", "X+10", "IY-5", "R0", "FMAX", "M3"]);
        assert_eq!(found.span(1), 5..9);
        assert!(line("/3 L X1").skipped && line("/ L X1").skipped);
        assert_eq!(line("TOOL CALL \"MILL 10\" Z").word(2), "\"MILL 10\"");
        assert_eq!(line("Ø L").tokens.len(), 2);
    }
}
