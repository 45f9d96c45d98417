//! Files that are whole or not there: written under another name in the same folder, then renamed.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use crate::error::{FormatError, Problem};

/// A file that appears under its name only with [`AtomicFile::commit`]. Dropped before, it leaves nothing.
///
/// ```
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("report.json");
/// use std::io::Write;
/// let mut file = sweepsim_formats::AtomicFile::create(&path)?;
/// writeln!(file, "all of it")?;
/// assert!(!path.exists());
/// file.commit()?;
/// assert!(path.exists());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct AtomicFile {
    writer: Option<BufWriter<File>>,
    temporary: PathBuf,
    path: PathBuf,
}

impl AtomicFile {
    /// Begins to write what is to be `path`. Its folder must be there.
    ///
    /// # Errors
    /// [`Problem::Write`] with the name of the file.
    pub fn create(path: &Path) -> Result<Self, FormatError> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let fail = |error| FormatError::new(Problem::Write(error), None).in_file(path);
        let Some(name) = path.file_name() else {
            return Err(fail(io::Error::new(
                io::ErrorKind::InvalidInput,
                "expected the name of a file",
            )));
        };
        if path.is_dir() {
            return Err(fail(io::Error::new(
                io::ErrorKind::IsADirectory,
                "a folder has this name",
            )));
        }
        // Names that another process or thread has taken are skipped.
        loop {
            let count = COUNT.fetch_add(1, Ordering::Relaxed);
            let mut hidden = std::ffi::OsString::from(".");
            hidden.push(name);
            hidden.push(format!(".{}-{count}.part", std::process::id()));
            let temporary = path.with_file_name(hidden);
            match OpenOptions::new().write(true).create_new(true).open(&temporary) {
                Ok(file) => {
                    return Ok(Self {
                        writer: Some(BufWriter::new(file)),
                        temporary,
                        path: path.to_owned(),
                    });
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(fail(error)),
            }
        }
    }

    /// Gives the file its name, in place of one that has it.
    ///
    /// # Errors
    /// [`Problem::Write`] with the name of the file, and nothing is left.
    pub fn commit(mut self) -> Result<(), FormatError> {
        self.finish()
            .map_err(|error| FormatError::new(Problem::Write(error), None).in_file(&self.path))
    }

    fn finish(&mut self) -> io::Result<()> {
        if let Some(writer) = &mut self.writer {
            writer.flush()?;
            writer.get_ref().sync_all()?;
        }
        // Closed before it is renamed.
        drop(self.writer.take());
        match fs::rename(&self.temporary, &self.path) {
            Ok(()) => Ok(()),
            Err(error) => {
                // The error that matters is the first one.
                let _ = fs::remove_file(&self.temporary);
                Err(error)
            }
        }
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.writer {
            Some(writer) => writer.write(bytes),
            None => Err(io::ErrorKind::BrokenPipe.into()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.as_mut().map_or(Ok(()), BufWriter::flush)
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        if let Some(writer) = self.writer.take() {
            // What is buffered is not wanted any more, and a file that cannot be removed is not worth a panic.
            drop(writer.into_parts());
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

/// Writes `path` whole or not at all.
///
/// # Errors
/// [`Problem::Write`] with the name of the file, and nothing is left.
pub fn write_atomically(path: &Path, write: impl FnOnce(&mut AtomicFile) -> io::Result<()>) -> Result<(), FormatError> {
    let mut file = AtomicFile::create(path)?;
    write(&mut file).map_err(|error| FormatError::new(Problem::Write(error), None).in_file(path))?;
    file.commit()
}
