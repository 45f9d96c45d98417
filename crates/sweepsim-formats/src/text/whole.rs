//! Files that are read as a whole, up to a size that is told.

use std::fs::File;
use std::io::{self, BufRead as _, BufReader, ErrorKind, Read as _};
use std::path::Path;

use crate::error::{FormatError, Problem};

/// The largest job, tool or motion, in bytes: a million poses written in a job have half of it.
pub(crate) const TEXT: u64 = 128 << 20;
/// The largest mesh or table of dexels that is read as a whole, in bytes: forty million triangles.
pub(crate) const DATA: u64 = 2 << 30;

/// The bytes of a file, which may also be a pipe, of at most `limit` bytes; nothing beyond is read.
///
/// # Errors
/// [`FormatError`] with the file's name: it cannot be read, or is larger.
pub(crate) fn read(file: &Path, limit: u64) -> Result<Vec<u8>, FormatError> {
    let read = File::open(file).and_then(|file| at_most(file, limit));
    read.map_err(|error| FormatError::new(Problem::Read(error), None).in_file(file))
}

/// What is left of an open file, likewise.
///
/// # Errors
/// Those of the file, and [`ErrorKind::InvalidData`] if it is larger.
pub(crate) fn at_most(file: File, limit: u64) -> io::Result<Vec<u8>> {
    let large = || {
        let message = format!("this file is larger than {limit} bytes: expected a smaller one");
        io::Error::new(ErrorKind::InvalidData, message)
    };
    // What has a length tells it; pipes do not.
    if file.metadata()?.len() > limit {
        return Err(large());
    }
    let mut bytes = Vec::new();
    file.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        Err(large())
    } else {
        Ok(bytes)
    }
}

/// The most bytes of a line that are shown.
const SHOWN: usize = 1 << 16;

/// A line of a file, from 1, without its end; nothing else of the file is kept.
pub(crate) fn line(file: &Path, number: usize) -> Option<String> {
    let mut reader = BufReader::new(File::open(file).ok()?);
    let (mut at, mut line) = (1, Vec::new());
    while at <= number {
        let bytes = reader.fill_buf().ok()?;
        let end = bytes.iter().position(|byte| *byte == b'\n');
        if at == number && line.len() < SHOWN {
            line.extend_from_slice(&bytes[..end.unwrap_or(bytes.len())]);
        }
        let (taken, at_end) = (end.map_or(bytes.len(), |end| end + 1), bytes.is_empty());
        reader.consume(taken);
        if at_end {
            break;
        }
        at += usize::from(end.is_some());
    }
    line.truncate(SHOWN);
    let text = String::from_utf8_lossy(&line);
    (at >= number).then(|| text.strip_suffix('\r').unwrap_or(&text).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scratch(name: &str) -> std::path::PathBuf {
        std::env::temp_dir().join(format!("sweepsim-whole-{}-{name}", std::process::id()))
    }

    #[test]
    fn a_line_is_found_without_the_others() {
        let file = scratch("lines");
        std::fs::write(&file, "one\r\ntwo\n\nfour").unwrap();
        let found: Vec<_> = (1..6).map(|number| line(&file, number)).collect();
        std::fs::remove_file(&file).unwrap();
        let some = |text: &str| Some(text.to_owned());
        assert_eq!(found, [some("one"), some("two"), some(""), some("four"), None]);
        assert_eq!(line(&file, 1), None);
    }

    #[test]
    fn no_more_is_read_than_is_told() {
        let file = scratch("large");
        // A hole: it takes no room on the disk.
        File::create(&file).unwrap().set_len(1 << 40).unwrap();
        let message = |error: FormatError| error.to_string();
        let limits = [read(&file, TEXT).map_err(message), read(&file, DATA).map_err(message)];
        std::fs::remove_file(&file).unwrap();
        for (found, limit) in limits.into_iter().zip([TEXT, DATA]) {
            let told = found.unwrap_err();
            assert!(told.contains(&format!("larger than {limit} bytes")), "{told}");
        }
        // A device has no length that tells.
        if let Ok(endless) = File::open("/dev/zero") {
            assert_eq!(at_most(endless, 1000).unwrap_err().kind(), ErrorKind::InvalidData);
        }
    }
}
