//! Files that are read as a whole, up to a size that is told.

use std::fs::File;
use std::io::{Error, ErrorKind, Read as _, Result};
use std::path::Path;

use super::utf16;

/// The largest library of tools or description of a machine, in bytes: libraries of thousands of tools have a few millions.
pub(crate) const LARGEST: u64 = 64 << 20;

/// The bytes of a file, which may also be a pipe, of at most [`LARGEST`] bytes; nothing beyond is read. UTF-16 as UTF-8.
///
/// # Errors
/// Those of the file, and [`ErrorKind::InvalidData`] if it is larger.
pub(crate) fn bytes(file: &Path) -> Result<Vec<u8>> {
    at_most(File::open(file)?, LARGEST)
}

/// As [`bytes`], of a text.
///
/// # Errors
/// Also [`ErrorKind::InvalidData`], if it is not UTF-8.
pub(crate) fn text(file: &Path) -> Result<String> {
    String::from_utf8(bytes(file)?).map_err(|error| Error::new(ErrorKind::InvalidData, error))
}

fn at_most(file: File, limit: u64) -> Result<Vec<u8>> {
    let large = || {
        let message = format!("this file is larger than {limit} bytes: expected a smaller one");
        Error::new(ErrorKind::InvalidData, message)
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
        Ok(utf16::as_utf8(&bytes).unwrap_or(bytes))
    }
}
