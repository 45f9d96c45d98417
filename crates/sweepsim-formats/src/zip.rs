//! ZIP archives of files that are stored as they are: enough for NPZ and 3MF of our own.

use std::io::{self, Write};

use crate::checksum::crc32;
use crate::error::{FormatError, Problem};

const LOCAL: &[u8; 4] = b"PK\x03\x04";
const CENTRAL: &[u8; 4] = b"PK\x01\x02";
const END: &[u8; 4] = b"PK\x05\x06";
/// 1980-01-01, the first day that the format knows: the same content gives the same bytes.
const DATE: u16 = 1 << 5 | 1;

/// Writes an archive.
pub(crate) fn write(entries: &[(&str, Vec<u8>)], writer: &mut impl Write) -> io::Result<()> {
    let large = || {
        io::Error::new(
            io::ErrorKind::InvalidInput,
            "more than 4 GiB do not fit into this format",
        )
    };
    let (mut directory, mut offset) = (Vec::new(), 0_u64);
    for (name, bytes) in entries {
        let size = u32::try_from(bytes.len()).map_err(|_| large())?;
        let start = u32::try_from(offset).map_err(|_| large())?;
        // Version, flags, method, time, date, checksum, both sizes, length of the name, none of more.
        let mut common = Vec::with_capacity(26);
        for number in [20, 0, 0, 0, DATE] {
            common.extend(number.to_le_bytes());
        }
        for number in [crc32(&[bytes]), size, size] {
            common.extend(number.to_le_bytes());
        }
        common.extend((name.len() as u16).to_le_bytes());
        common.extend([0; 2]);
        for part in [&LOCAL[..], &common, name.as_bytes(), bytes] {
            writer.write_all(part)?;
            offset += part.len() as u64;
        }
        directory.extend(CENTRAL);
        directory.extend(20_u16.to_le_bytes());
        directory.extend(&common);
        directory.extend([0; 10]);
        directory.extend(start.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let start = u32::try_from(offset).map_err(|_| large())?;
    let count = (entries.len() as u16).to_le_bytes();
    writer.write_all(&directory)?;
    writer.write_all(END)?;
    writer.write_all(&[0; 4])?;
    writer.write_all(&[count, count].concat())?;
    writer.write_all(&(directory.len() as u32).to_le_bytes())?;
    writer.write_all(&start.to_le_bytes())?;
    writer.write_all(&[0; 2])
}

fn number(bytes: &[u8], at: usize, width: usize) -> Option<usize> {
    let field = bytes.get(at..at.checked_add(width)?)?;
    Some(field.iter().rev().fold(0, |sum, byte| sum << 8 | usize::from(*byte)))
}

/// The files of an archive.
pub(crate) struct Archive<'a> {
    files: Vec<(&'a [u8], &'a [u8])>,
}

impl<'a> Archive<'a> {
    /// Finds the files, and checks that they are whole.
    pub fn read(bytes: &'a [u8]) -> Result<Self, FormatError> {
        let problem = |message: &str| FormatError::new(Problem::syntax(message), None);
        if !bytes.starts_with(LOCAL) {
            return Err(problem("this is no archive: expected `PK` at its beginning"));
        }
        let damaged = || problem("this archive is damaged, or stops in the middle");
        // The end is 22 bytes long, and a comment may follow.
        let first = bytes.len().saturating_sub(22 + usize::from(u16::MAX));
        let end = (first..bytes.len().saturating_sub(21))
            .rev()
            .find(|at| bytes[*at..].starts_with(END));
        let end = end.ok_or_else(damaged)?;
        let count = number(bytes, end + 10, 2).ok_or_else(damaged)?;
        let mut at = number(bytes, end + 16, 4).ok_or_else(damaged)?;
        let mut files = Vec::new();
        for _ in 0..count {
            let entry = bytes
                .get(at..)
                .filter(|entry| entry.starts_with(CENTRAL))
                .ok_or_else(damaged)?;
            let field = |at, width| number(entry, at, width).ok_or_else(damaged);
            let (method, sum, size, start) = (field(10, 2)?, field(16, 4)?, field(24, 4)?, field(42, 4)?);
            let lengths = [field(28, 2)?, field(30, 2)?, field(32, 2)?];
            if method != 0 {
                let problem = Problem::unsupported("compressed archives are", "store their files as they are");
                return Err(FormatError::new(problem, None));
            }
            let name = entry.get(46..46 + lengths[0]).ok_or_else(damaged)?;
            let local = bytes
                .get(start..)
                .filter(|local| local.starts_with(LOCAL))
                .ok_or_else(damaged)?;
            let skip = |at| number(local, at, 2).ok_or_else(damaged);
            let from = 30 + skip(26)? + skip(28)?;
            let content = local.get(from..from + size).ok_or_else(damaged)?;
            if crc32(&[content]) as usize != sum {
                return Err(damaged());
            }
            files.push((name, content));
            at += 46 + lengths.iter().sum::<usize>();
        }
        Ok(Self { files })
    }

    /// Whether there is a file of this name.
    pub fn has(&self, name: &str) -> bool {
        self.files.iter().any(|(found, _)| *found == name.as_bytes())
    }

    /// The content of a file.
    pub fn file(&self, name: &str) -> Result<&'a [u8], FormatError> {
        let found = self.files.iter().find(|(found, _)| *found == name.as_bytes());
        found.map(|(_, content)| *content).ok_or_else(|| {
            let message = format!("this archive has no file `{name}`");
            FormatError::new(Problem::syntax(message), None)
        })
    }
}
