//! The output files of a run. Their folder is checked before the work begins, and each is written completely or not at all.

use super::interruption::{interrupted, writing};
use super::{Failure, words};
use crate::arguments::Output;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use sweepsim_formats::{AtomicFile, io_reason, write_atomically};

/// The output folder, and the files to write to it.
#[derive(Debug)]
pub(crate) struct Outputs {
    folder: PathBuf,
    wanted: Vec<Output>,
    /// Names and sizes of the files written.
    pub written: Vec<(String, u64)>,
}

impl Outputs {
    /// Creates the folder, and checks that files can be written to it.
    pub fn new(folder: PathBuf, only: &[Output]) -> Result<Self, Failure> {
        let refused = |error: io::Error| {
            Failure::message(format!(
                "cannot write to the folder {}: {}",
                folder.display(),
                io_reason(&error)
            ))
        };
        fs::create_dir_all(&folder).map_err(refused)?;
        // Dropped without a commit, it leaves no file.
        writing(None, || {
            drop(AtomicFile::create(&folder.join("report.json"))?);
            Ok(())
        })?;
        let all = [Output::Dexels, Output::Mesh, Output::Picture, Output::Report];
        let wanted = if only.is_empty() { all.to_vec() } else { only.to_vec() };
        Ok(Self {
            folder,
            wanted,
            written: Vec::new(),
        })
    }

    pub fn wants(&self, output: Output) -> bool {
        self.wanted.contains(&output)
    }

    /// Writes one file, unless the run is interrupted meanwhile.
    pub fn write(
        &mut self,
        name: &str,
        write: impl FnOnce(&mut Interruptible<'_>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let path = self.folder.join(name);
        writing(Some(name), || {
            Ok(write_atomically(&path, |file| write(&mut Interruptible(file)))?)
        })?;
        let size = fs::metadata(&path).map_or(0, |data| data.len());
        self.written.push((name.to_owned(), size));
        Ok(())
    }

    /// Removes files of an earlier run: those with the names of 0, 1, 2 … up to the first that does not exist.
    pub fn remove_from(&self, name: impl Fn(usize) -> String) {
        for number in 0.. {
            if fs::remove_file(self.folder.join(name(number))).is_err() {
                break;
            }
        }
    }

    /// The files written, with their sizes, for the last line of a summary.
    pub fn listed(&self) -> String {
        // Numbered files are listed as one.
        let series = |name: &str| name.starts_with("frame-");
        let runs = self.written.chunk_by(|(a, _), (b, _)| series(a) && series(b));
        let files: Vec<String> = runs
            .map(|run| {
                let size = words::bytes(run.iter().map(|(_, size)| size).sum());
                match run {
                    [(first, _), .., (last, _)] => format!("{first} … {last} ({size})"),
                    _ => format!("{} ({size})", run[0].0),
                }
            })
            .collect();
        format!("{}: {}", self.folder.display(), files.join(", "))
    }
}

/// Writes a file outside of an output folder.
pub(crate) fn save(file: &Path, write: impl FnOnce(&mut AtomicFile) -> io::Result<()>) -> Result<(), Failure> {
    writing(Some(&file.to_string_lossy()), || Ok(write_atomically(file, write)?))
}

/// A file whose writing fails once the run is interrupted.
pub(crate) struct Interruptible<'a>(&'a mut AtomicFile);

impl io::Write for Interruptible<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if interrupted() {
            return Err(io::Error::other("interrupted"));
        }
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

/// The folder given by the options, or `out/NAME`.
pub(crate) fn output_folder(out: Option<&Path>, name: &str) -> PathBuf {
    out.map_or_else(|| Path::new("out").join(folder_name(name)), Path::to_owned)
}

/// A name made safe for a folder: it cannot lead out of `out/`.
fn folder_name(name: &str) -> PathBuf {
    let safe: String = name
        .chars()
        .map(|c| {
            if c.is_alphanumeric() || "-_. ".contains(c) {
                c
            } else {
                '_'
            }
        })
        .collect();
    let safe = safe.trim_matches(['.', ' ']);
    PathBuf::from(if safe.is_empty() { "job" } else { safe })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_leads_out_of_the_folder() {
        assert_eq!(folder_name("a part-1.2"), Path::new("a part-1.2"));
        assert_eq!(folder_name("../../etc"), Path::new("_.._etc"));
        assert_eq!(folder_name(".."), Path::new("job"));
        assert_eq!(folder_name("a/b\\c"), Path::new("a_b_c"));
        assert_eq!(folder_name("größe"), Path::new("größe"));
    }
}
