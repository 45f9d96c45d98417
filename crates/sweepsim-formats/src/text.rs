//! Places in a text: from bytes, or from a line and a column, to what a message shows.

use std::ops::Range;
use std::path::Path;

use crate::error::{FormatError, Place, Problem};

/// A line longer than this is shown in part only.
const LONGEST_EXCERPT: usize = 160;

/// The place of `span`, in bytes of `text`, on the line where it begins.
pub(crate) fn place(text: &str, span: Range<usize>) -> Place {
    let floor = |mut byte: usize| {
        byte = byte.min(text.len());
        while !text.is_char_boundary(byte) {
            byte -= 1;
        }
        byte
    };
    let (start, end) = (floor(span.start), floor(span.end.max(span.start)));
    let line_start = text[..start].rfind('\n').map_or(0, |byte| byte + 1);
    let line = 1 + text[..line_start].bytes().filter(|&byte| byte == b'\n').count();
    let whole = text[line_start..].lines().next().unwrap_or("");
    let column = 1 + text[line_start..start].chars().count();
    let width = text[start..end].lines().next().unwrap_or("").chars().count();
    place_in_line(line, whole, column, width)
}

/// The place of `width` characters from `column` on in `line`, whose text is `whole`.
pub(crate) fn place_in_line(line: usize, whole: &str, column: usize, width: usize) -> Place {
    let column = column.max(1);
    let kept = LONGEST_EXCERPT.max(column.saturating_add(LONGEST_EXCERPT / 4));
    Place {
        line,
        column,
        width: width.max(1),
        excerpt: whole.chars().take(kept).collect(),
    }
}

/// Reads a text file.
pub(crate) fn read(file: &Path) -> Result<String, FormatError> {
    let bytes = std::fs::read(file).map_err(|error| FormatError::new(Problem::Read(error), None).in_file(file))?;
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let text = String::from_utf8_lossy(error.as_bytes());
        let problem = Problem::syntax("this is no text: expected UTF-8");
        FormatError::new(problem, Some(place(&text, valid..valid + 1))).in_file(file)
    })
}

/// The values of a RON text, not checked yet.
pub(crate) fn ron<T: serde::de::DeserializeOwned>(text: &str) -> Result<T, FormatError> {
    let options = ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
    options.from_str(text).map_err(|error| {
        // Positions are lines and characters from 1; the text around them is found again by bytes.
        let byte = |position: ron::error::Position| {
            let start: usize = text
                .split_inclusive('\n')
                .take(position.line.saturating_sub(1))
                .map(str::len)
                .sum();
            let column = text[start..].char_indices().nth(position.col.saturating_sub(1));
            start + column.map_or(text.len() - start, |(byte, _)| byte)
        };
        let span = byte(error.span.start)..byte(error.span.end);
        // The span may have space around what is meant.
        let skipped = text[span.start..].len() - text[span.start..].trim_start().len();
        let start = if error.code == ron::Error::Eof {
            span.start
        } else {
            span.start + skipped
        };
        FormatError::new(
            Problem::syntax(error.code.to_string()),
            Some(place(text, start..span.end.max(start))),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters() {
        let text = "a\nØØ x = 1\n";
        let at = text.find('x').unwrap();
        let found = place(text, at..at + 1);
        assert_eq!((found.line, found.column, found.width), (2, 4, 1));
        assert_eq!(found.excerpt, "ØØ x = 1");
    }

    #[test]
    fn beyond_the_end_is_the_end() {
        let found = place("ab", 10..20);
        assert_eq!((found.line, found.column, found.width), (1, 3, 1));
    }
}
