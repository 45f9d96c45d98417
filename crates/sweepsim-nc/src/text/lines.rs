//! Lines of bounded length, so that no input takes memory without end.

use std::io::BufRead;
use std::rc::Rc;

use crate::text::error::{NcError, NcProblem, TextPosition};
use crate::text::utf16;

/// The longest line of a program or a table, in bytes. Blocks have a few hundred at most.
pub(crate) const LONGEST: usize = 1 << 16;
/// The largest program that is read as a whole, in bytes: positions in it are kept as `u32`.
const MOST: usize = u32::MAX as usize / 2;
/// How much of a line that is too long is shown.
const SHOWN: usize = 120;

/// The lines of a reader, one at a time.
pub(crate) struct Lines<R> {
    reader: R,
    line: Vec<u8>,
    /// The number of the last line read, from 1.
    pub number: usize,
}

impl<R: BufRead> Lines<R> {
    pub fn new(reader: R) -> Self {
        Self {
            reader,
            line: Vec::new(),
            number: 0,
        }
    }

    /// The last line read, with its end, `\n`, `\r` or both.
    pub fn line(&self) -> &[u8] {
        &self.line
    }

    /// Reads the next line; `false` if there is none.
    ///
    /// # Errors
    /// [`NcError`]: the reader fails, or the line is longer than [`LONGEST`] bytes.
    pub fn next_line(&mut self) -> Result<bool, NcError> {
        self.line.clear();
        loop {
            let bytes = self.reader.fill_buf();
            let bytes = bytes.map_err(|error| NcError::new(NcProblem::Read(error), None))?;
            // A line that ends with `\r` may go on with `\n`.
            let begun = if self.line.last() == Some(&b'\r') {
                usize::from(bytes.first() == Some(&b'\n'))
            } else {
                match bytes.iter().position(|byte| matches!(byte, b'\n' | b'\r')) {
                    Some(end) if bytes[end] == b'\n' => end + 1,
                    Some(end) if end + 1 < bytes.len() => end + 1 + usize::from(bytes[end + 1] == b'\n'),
                    _ => bytes.len(),
                }
            };
            self.line.extend_from_slice(&bytes[..begun.min(LONGEST + 1)]);
            let ended = bytes.is_empty() || begun < bytes.len() || bytes.last() == Some(&b'\n');
            self.reader.consume(begun);
            if self.line.len() > LONGEST {
                return Err(self.too_long());
            }
            if ended {
                break;
            }
        }
        if self.line.is_empty() {
            return Ok(false);
        }
        self.number += 1;
        Ok(true)
    }

    fn too_long(&self) -> NcError {
        let shown = String::from_utf8_lossy(&self.line[..SHOWN]);
        let message = format!("this line is longer than {LONGEST} bytes: expected a text of shorter lines");
        let place = TextPosition::in_line(self.number + 1, &shown, 1, shown.chars().count());
        NcError::new(NcProblem::syntax(message), Some(place))
    }
}

/// Everything in a reader; UTF-16 as UTF-8.
///
/// # Errors
/// [`NcError`]: the reader fails, a line is longer than [`LONGEST`] bytes, or there is more than 2 GB; nothing beyond it is read.
pub(crate) fn all(reader: impl BufRead) -> Result<Vec<u8>, NcError> {
    let mut lines = Lines::new(reader);
    let (mut bytes, mut lone) = (Vec::new(), false);
    while lines.next_line()? {
        lone |= lines.line().ends_with(b"\r");
        if bytes.len() + lines.line().len() > MOST {
            return Err(NcError::new(
                NcProblem::value("the size of a program", format!("over {MOST} bytes"), "less than 2 GB"),
                None,
            ));
        }
        bytes.extend_from_slice(lines.line());
    }
    if let Some(text) = utf16::as_utf8(&bytes) {
        (bytes, lone) = (text, true);
    }
    if lone {
        end_lines_at_returns(&mut bytes);
    }
    Ok(bytes)
}

/// Makes `\n` of each `\r` that ends a line by itself, as old controls and Macs wrote them. Those beside a `\n` are part of its line's end (`\r\n`, `\r\r\n`,
/// `\n\r`) and stay. All readers of programs take lines to end so; other bytes keep their places.
///
/// ```
/// let mut text = *b"G0 X0\r\nG0 X1 (first)\rY2\r";
/// sweepsim_nc::end_lines_at_returns(&mut text);
/// assert_eq!(&text, b"G0 X0\r\nG0 X1 (first)\nY2\n");
/// ```
pub fn end_lines_at_returns(bytes: &mut [u8]) {
    let ends = |byte: u8| matches!(byte, b'\r' | b'\n');
    for run in bytes.chunk_by_mut(|a, b| ends(*a) == ends(*b)) {
        if run[0] == b'\r' && !run.contains(&b'\n') {
            run.fill(b'\n');
        }
    }
}

/// A text whose lines end as the readers expect it.
pub(crate) fn kept(text: &str) -> Rc<String> {
    let mut bytes = text.as_bytes().to_vec();
    end_lines_at_returns(&mut bytes);
    Rc::new(String::from_utf8(bytes).unwrap_or_else(|_| text.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{BufReader, Read as _};

    #[test]
    fn lines_end_alike_in_buffers_of_any_size() {
        let text = b"a\nbc\r\n\r\n\rd\re\n\nlast";
        let expected = ["a\n", "bc\r\n", "\r\n", "\r", "d\r", "e\n", "\n", "last"];
        for size in 1..30 {
            let mut lines = Lines::new(BufReader::with_capacity(size, &text[..]));
            for (number, line) in expected.iter().enumerate() {
                assert!(lines.next_line().unwrap());
                assert_eq!(lines.line(), line.as_bytes(), "{size}");
                assert_eq!(lines.number, number + 1);
            }
            assert!(!lines.next_line().unwrap());
            let ended = b"a\nbc\r\n\r\n\rd\ne\n\nlast";
            assert_eq!(all(BufReader::with_capacity(size, &text[..])).unwrap(), ended);
        }
        assert_eq!(all(&b""[..]).unwrap(), b"");
        assert_eq!(all(&b"x\r"[..]).unwrap(), b"x\n");
        assert_eq!(all(&b"a\r\r\nb\n\rc\r\rd"[..]).unwrap(), b"a\r\r\nb\n\rc\n\nd");
    }

    #[test]
    fn a_line_without_end_is_named_and_not_read_on() {
        struct Endless(u64);
        impl std::io::Read for Endless {
            fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
                buffer.fill(b'1');
                self.0 += buffer.len() as u64;
                assert!(self.0 < 1 << 20, "read on");
                Ok(buffer.len())
            }
        }
        let text = b"G0 X0\nG1 X".chain(Endless(0));
        let error = all(BufReader::new(text)).unwrap_err();
        let message = "2:1: this line is longer than 65536 bytes: expected a text of shorter lines";
        assert_eq!(error.to_string(), message);
        let most = vec![b' '; LONGEST];
        assert_eq!(all(&most[..]).unwrap(), most);
    }
}
