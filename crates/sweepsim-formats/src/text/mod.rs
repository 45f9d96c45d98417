//! Text files, and RON with the positions of its values.

mod ron_spans;
pub(crate) mod whole;

pub(crate) use ron_spans::SpanTree;

use std::path::Path;

use crate::error::{FormatError, Problem, TextPosition};

/// Reads a text file of at most 128 MiB.
pub(crate) fn read(file: &Path) -> Result<String, FormatError> {
    let mut bytes = whole::read(file, whole::TEXT)?;
    // Some editors write a mark before the first character, which is no part of the text.
    if bytes.starts_with("\u{feff}".as_bytes()) {
        bytes.drain(.."\u{feff}".len());
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let text = String::from_utf8_lossy(error.as_bytes());
        let problem = Problem::syntax("this is not a text file: expected UTF-8");
        FormatError::new(problem, Some(TextPosition::of_bytes(&text, valid..valid + 1))).in_file(file)
    })
}

/// Parses RON, without checking the values.
pub(crate) fn ron<T: serde::de::DeserializeOwned>(text: &str) -> Result<T, FormatError> {
    let options = ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
    options.from_str(text).map_err(|error| {
        // The parser counts lines and characters from 1; convert to bytes.
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
        // The span may begin with white space.
        let skipped = text[span.start..].len() - text[span.start..].trim_start().len();
        let start = if error.code == ron::Error::Eof {
            span.start
        } else {
            span.start + skipped
        };
        FormatError::new(
            Problem::syntax(error.code.to_string()),
            Some(TextPosition::of_bytes(text, start..span.end.max(start))),
        )
    })
}
