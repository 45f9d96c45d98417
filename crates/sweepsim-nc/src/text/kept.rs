//! A text that is kept whole, by lines.

use std::rc::Rc;

/// A text with the places of its lines.
pub(crate) struct KeptText {
    text: Rc<String>,
    /// Where each line begins, and where the text ends.
    starts: Vec<usize>,
}

impl KeptText {
    pub fn new(text: Rc<String>) -> Self {
        let mut starts = Vec::with_capacity(text.bytes().filter(|byte| *byte == b'\n').count() + 2);
        starts.push(0);
        starts.extend(text.split_inclusive('\n').scan(0, |end, line| {
            *end += line.len();
            Some(*end)
        }));
        Self { text, starts }
    }

    /// The number of lines, as [`str::lines`] counts them.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// A line without its end, counted from 0; empty beyond the last.
    pub fn line(&self, index: usize) -> &str {
        let Some(&[start, end]) = self.starts.get(index..).and_then(|starts| starts.first_chunk()) else {
            return "";
        };
        let line = &self.text[start..end];
        let Some(line) = line.strip_suffix('\n') else {
            return line;
        };
        line.strip_suffix('\r').unwrap_or(line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_those_of_the_standard_library() {
        for text in [
            "",
            "\n",
            "a",
            "a\n",
            "a\nb",
            "a\r\nb\r\n",
            "\r\n\n\r",
            "ä\n\n\u{feff}b\rc\n",
            "x\r",
        ] {
            let kept = KeptText::new(Rc::new(text.to_owned()));
            let lines: Vec<&str> = (0..kept.len()).map(|index| kept.line(index)).collect();
            assert_eq!(lines, text.lines().collect::<Vec<_>>(), "{text:?}");
            assert_eq!(kept.line(kept.len()), "");
            assert_eq!(kept.line(usize::MAX), "");
        }
    }
}
