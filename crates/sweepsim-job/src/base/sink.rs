//! Where outputs go: a folder, memory, or whatever the caller makes of them.

use crate::base::JobError;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use sweepsim_formats::{AtomicFile, FormatError, io_reason, write_atomically};

/// Writes the content of an output.
pub type Content<'a> = &'a mut dyn FnMut(&mut dyn io::Write) -> io::Result<()>;

/// Takes the outputs of a run, one after the other.
pub trait Sink {
    /// Takes one output, completely or not at all. An output of the same name is replaced.
    ///
    /// # Errors
    /// [`JobError`]: it cannot be written; [`JobError::Cancelled`] ends the writing.
    fn write(&mut self, name: &str, content: Content) -> Result<(), JobError>;

    /// Removes an output of an earlier run that is none of this one, and says whether there was one.
    fn remove(&mut self, name: &str) -> bool {
        let _ = name;
        false
    }
}

/// Outputs as files of a folder. The default has no folder: outputs are named by their whole paths.
#[derive(Debug, Default)]
pub struct Folder {
    folder: PathBuf,
    written: Vec<(String, u64)>,
}

impl Folder {
    /// Creates the folder if it does not exist, and checks that files can be written to it.
    ///
    /// # Errors
    /// [`JobError`] with the folder, and why it cannot be written to.
    pub fn create(folder: impl Into<PathBuf>) -> Result<Self, JobError> {
        let folder = folder.into();
        let refused = |error: io::Error| {
            let (folder, why) = (folder.display(), io_reason(&error));
            JobError::run(format!("cannot write to the folder {folder}: {why}"))
        };
        fs::create_dir_all(&folder).map_err(refused)?;
        // Dropped without a commit, it leaves no file.
        drop(AtomicFile::create(&folder.join("report.json"))?);
        let written = Vec::new();
        Ok(Self { folder, written })
    }

    /// The folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.folder
    }

    /// Names and sizes in bytes of the files written.
    #[must_use]
    pub fn written(&self) -> &[(String, u64)] {
        &self.written
    }
}

impl Sink for Folder {
    fn write(&mut self, name: &str, content: Content) -> Result<(), JobError> {
        let path = self.folder.join(name);
        write_atomically(&path, |file| content(file))?;
        let size = fs::metadata(&path).map_or(0, |data| data.len());
        self.written.push((name.to_owned(), size));
        Ok(())
    }

    fn remove(&mut self, name: &str) -> bool {
        fs::remove_file(self.folder.join(name)).is_ok()
    }
}

/// Outputs by name, in memory.
#[derive(Clone, Debug, Default)]
pub struct Memory(pub BTreeMap<String, Vec<u8>>);

impl Sink for Memory {
    fn write(&mut self, name: &str, content: Content) -> Result<(), JobError> {
        let mut bytes = Vec::new();
        let failed = |error| JobError::from(FormatError::writing(Path::new(name), error));
        content(&mut bytes).map_err(failed)?;
        self.0.insert(name.to_owned(), bytes);
        Ok(())
    }

    fn remove(&mut self, name: &str) -> bool {
        self.0.remove(name).is_some()
    }
}

/// The folder given, or `out/NAME`.
#[must_use]
pub fn output_folder(out: Option<&Path>, name: &str) -> PathBuf {
    out.map_or_else(|| Path::new("out").join(folder_name(name)), Path::to_owned)
}

/// A name made safe for a folder: it cannot lead out of `out/`.
#[must_use]
pub fn folder_name(name: &str) -> PathBuf {
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
