//! Lines of programs, read where they are needed.

use crate::request::Input;
use crate::session::Session;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Result, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use sweepsim::motion::BodyKind;

/// So many lines have one entry in the index of a file.
const INDEXED: usize = 1024;
/// The most bytes of a line that are shown.
const SHOWN: usize = 1 << 16;

/// The lines of the programs of a job. Of each file only the places of some lines are kept, however long it is.
pub(super) struct ProgramTexts {
    pub folder: PathBuf,
    files: BTreeMap<String, Option<Index>>,
}

impl ProgramTexts {
    pub fn new(session: Session) -> Self {
        let mut files = BTreeMap::new();
        if let Input::Program { name, text } = &session.request.input {
            let name = name.file_name().unwrap_or_default().to_string_lossy();
            files.insert(name.into_owned(), Index::of_bytes(text.clone().into_bytes()).ok());
        }
        let folder = session.folder().to_owned();
        Self { folder, files }
    }

    /// A line of a file, without the space around it.
    pub fn line(&mut self, file: &str, line: usize) -> Option<String> {
        let index = self.files.entry(file.to_owned());
        let index = index.or_insert_with(|| Index::of(&self.folder.join(file)).ok());
        let found = index.as_mut()?.line(line.checked_sub(1)?).ok()??;
        Some(String::from_utf8_lossy(&found).trim().to_owned())
    }
}

/// What a body is called.
pub(super) fn name_of(kind: BodyKind) -> &'static str {
    match kind {
        BodyKind::Shank => "shank",
        BodyKind::Holder => "holder",
        _ => "body",
    }
}

/// Bytes that can be read from any place on.
trait Text: BufRead + Seek + Send {}

impl<T: BufRead + Seek + Send> Text for T {}

/// A file, and where every so many lines begin.
struct Index {
    reader: Box<dyn Text>,
    starts: Vec<u64>,
    /// Of the whole file.
    length: u64,
}

impl Index {
    fn of(file: &Path) -> Result<Self> {
        let (index, lone) = Self::of_text(Box::new(BufReader::new(File::open(file)?)))?;
        if !lone {
            return Ok(index);
        }
        // Rare, and small where it occurs.
        Self::of_bytes(std::fs::read(file)?)
    }

    fn of_bytes(mut bytes: Vec<u8>) -> Result<Self> {
        sweepsim_nc::end_lines_at_returns(&mut bytes);
        Ok(Self::of_text(Box::new(Cursor::new(bytes)))?.0)
    }

    /// The index, and whether there is a `\r` without its `\n`.
    fn of_text(mut reader: Box<dyn Text>) -> Result<(Self, bool)> {
        let (mut starts, mut at, mut lines) = (vec![0], 0, 0);
        let (mut lone, mut returned) = (false, false);
        loop {
            let bytes = reader.fill_buf()?;
            if bytes.is_empty() {
                break;
            }
            for (k, byte) in bytes.iter().enumerate() {
                lone |= returned && *byte != b'\n';
                returned = *byte == b'\r';
                if *byte == b'\n' {
                    lines += 1;
                    if lines % INDEXED == 0 {
                        starts.push(at + k as u64 + 1);
                    }
                }
            }
            let taken = bytes.len();
            at += taken as u64;
            reader.consume(taken);
        }
        let index = Self {
            reader,
            starts,
            length: at,
        };
        Ok((index, lone || returned))
    }

    /// A line, counted from 0; `None` beyond the end.
    fn line(&mut self, number: usize) -> Result<Option<Vec<u8>>> {
        let Some(start) = self.starts.get(number / INDEXED) else {
            return Ok(None);
        };
        let mut left = self.length - start;
        self.reader.seek(SeekFrom::Start(*start))?;
        let (mut skip, mut line) = (number % INDEXED, Vec::new());
        loop {
            if left == 0 && line.is_empty() {
                return Ok(None);
            }
            let bytes = self.reader.fill_buf()?;
            let end = bytes.iter().position(|byte| *byte == b'\n');
            if skip == 0 && line.len() < SHOWN {
                line.extend_from_slice(&bytes[..end.unwrap_or(bytes.len())]);
            }
            let taken = end.map_or(bytes.len(), |end| end + 1);
            let over = bytes.is_empty() || (skip == 0 && end.is_some());
            left = left.saturating_sub(taken as u64);
            self.reader.consume(taken);
            if over {
                line.truncate(SHOWN);
                return Ok(Some(line));
            }
            skip -= usize::from(end.is_some());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_line_is_found() {
        let file = std::env::temp_dir().join(format!("sweepsim-lines-{}", std::process::id()));
        let lines: Vec<String> = (0..5000).map(|k| "x".repeat(k % 13) + &k.to_string()).collect();
        for (between, end) in [("\r\n", ""), ("\r\n", "\n"), ("\r", "\r"), ("\n", "")] {
            std::fs::write(&file, lines.join(between) + end).unwrap();
            let mut index = Index::of(&file).unwrap();
            let mut found = |k: usize| {
                index
                    .line(k)
                    .unwrap()
                    .map(|line| String::from_utf8_lossy(&line).trim().to_owned())
            };
            for k in [0, 1, 1023, 1024, 1025, 4999, 7, 2048] {
                assert_eq!(found(k).as_ref(), Some(&lines[k]));
            }
            assert_eq!([found(5000), found(9999)], [None, None]);
        }
        std::fs::remove_file(&file).unwrap();
    }
}
