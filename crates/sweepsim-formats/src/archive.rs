//! ZIP archives, the containers of NPZ and 3MF.

use std::io::{self, Cursor, Read, Write};

use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipArchive, ZipWriter};

use crate::error::{FormatError, Problem};

/// The size in bytes to which any entry may expand.
const FREE_BYTES: u64 = 1 << 28;
/// How many times its compressed size an entry may expand to beyond that. Text compresses 10 times, noise not at all;
/// 1000 times is a decompression bomb, or an array of equal numbers.
const MOST_EXPANSION: u64 = 100;

/// Writes an archive without compression. The same content gives the same bytes.
pub(crate) fn write(entries: &[(&str, Vec<u8>)], writer: &mut (impl Write + ?Sized)) -> io::Result<()> {
    let mut archive = ZipWriter::new_stream(writer);
    for (name, bytes) in entries {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .last_modified_time(DateTime::DEFAULT)
            .large_file(bytes.len() as u64 >= u64::from(u32::MAX));
        archive.start_file(*name, options)?;
        archive.write_all(bytes)?;
    }
    archive.finish()?;
    Ok(())
}

fn problem(message: impl Into<String>) -> FormatError {
    FormatError::new(Problem::syntax(message), None)
}

fn damaged() -> FormatError {
    problem("this archive is damaged or truncated")
}

/// The entries of an archive.
pub(crate) struct Archive<'a>(ZipArchive<Cursor<&'a [u8]>>);

impl<'a> Archive<'a> {
    /// Reads the directory of an archive.
    pub fn read(bytes: &'a [u8]) -> Result<Self, FormatError> {
        if !bytes.starts_with(b"PK\x03\x04") {
            return Err(problem("this is not an archive: expected `PK` at its beginning"));
        }
        ZipArchive::new(Cursor::new(bytes)).map(Self).map_err(|_| damaged())
    }

    /// Whether the archive has an entry.
    pub fn has(&self, name: &str) -> bool {
        self.0.index_for_name(name).is_some()
    }

    /// The content of an entry, decompressed, with its checksum verified.
    pub fn entry(&mut self, name: &str) -> Result<Vec<u8>, FormatError> {
        let mut entry = self.0.by_name(name).map_err(|error| match error {
            ZipError::FileNotFound => problem(format!("this archive has no entry `{name}`")),
            ZipError::UnsupportedArchive(_) => FormatError::new(
                Problem::unsupported(
                    format!("the encryption or compression of `{name}` is"),
                    "expected an archive that is stored or deflated",
                ),
                None,
            ),
            _ => damaged(),
        })?;
        let limit = FREE_BYTES.saturating_add(entry.compressed_size().saturating_mul(MOST_EXPANSION));
        // Grows with the data read, whatever size the directory claims.
        let mut bytes = Vec::new();
        let read = (&mut entry).take(limit + 1).read_to_end(&mut bytes);
        if read.is_err() {
            return Err(damaged());
        }
        if bytes.len() as u64 > limit {
            return Err(problem(format!(
                "the entry `{name}` of this archive expands to more than {MOST_EXPANSION} times its size: expected an ordinary archive, or one without compression"
            )));
        }
        Ok(bytes)
    }
}
