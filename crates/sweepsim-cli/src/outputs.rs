//! The files of a run: their folder is checked before the work begins, and each is written whole or not at all.

use crate::arguments::Output;
use crate::failure::Failure;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use sweepsim_formats::{AtomicFile, write_atomically};

/// Where the outputs go, and which are wanted.
#[derive(Debug)]
pub(crate) struct Outputs {
    folder: PathBuf,
    wanted: Vec<Output>,
    /// Names and sizes of what is written.
    pub written: Vec<(&'static str, u64)>,
}

impl Outputs {
    /// Makes the folder, and tries whether it takes files.
    pub fn new(folder: PathBuf, only: &[Output]) -> Result<Self, Failure> {
        let refused =
            |error: io::Error| Failure::message(format!("cannot write to the folder {}: {error}", folder.display()));
        fs::create_dir_all(&folder).map_err(refused)?;
        // Created and dropped: leaves nothing.
        drop(AtomicFile::create(&folder.join("report.json"))?);
        let all = [Output::Dexels, Output::Mesh, Output::Picture, Output::Report];
        let wanted = if only.is_empty() { all.to_vec() } else { only.to_vec() };
        Ok(Self {
            folder,
            wanted,
            written: Vec::new(),
        })
    }

    pub fn folder(&self) -> &Path {
        &self.folder
    }

    pub fn wants(&self, output: Output) -> bool {
        self.wanted.contains(&output)
    }

    /// Writes one file.
    pub fn write(
        &mut self,
        name: &'static str,
        write: impl FnOnce(&mut AtomicFile) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let path = self.folder.join(name);
        write_atomically(&path, write)?;
        let size = fs::metadata(&path).map_or(0, |data| data.len());
        self.written.push((name, size));
        Ok(())
    }
}
