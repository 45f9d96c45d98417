//! Atomic files: written under a temporary name in the same folder, then renamed.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use crate::error::{FormatError, Problem};

/// A file that appears under its name with [`AtomicFile::commit`]. Dropped before that, it leaves nothing behind.
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
    writer: BufWriter<NamedTempFile<File>>,
    path: PathBuf,
}

impl AtomicFile {
    /// Creates a file that will become `path`. Its folder must exist.
    ///
    /// # Errors
    /// [`Problem::Write`] with the name of the file.
    pub fn create(path: &Path) -> Result<Self, FormatError> {
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
        let mut prefix = std::ffi::OsString::from(".");
        prefix.push(name);
        prefix.push(".");
        let mut builder = Builder::new();
        builder.prefix(&prefix).suffix(".part");
        // Like any other new file, not private as temporary files are.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let file = builder.tempfile_in(folder.unwrap_or(Path::new("."))).map_err(fail)?;
        Ok(Self {
            writer: BufWriter::new(file),
            path: path.to_owned(),
        })
    }

    /// Gives the file its name, replacing a file that has it.
    ///
    /// # Errors
    /// [`Problem::Write`] with the name of the file; nothing is left behind.
    pub fn commit(self) -> Result<(), FormatError> {
        let Self { mut writer, path } = self;
        let finish = || -> io::Result<()> {
            writer.flush()?;
            let (file, _) = writer.into_parts();
            file.as_file().sync_all()?;
            file.persist(&path)?;
            Ok(())
        };
        finish().map_err(|error| FormatError::new(Problem::Write(error), None).in_file(&path))
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

/// Writes a file completely or not at all.
///
/// # Errors
/// [`Problem::Write`] with the name of the file; nothing is left behind.
pub fn write_atomically(path: &Path, write: impl FnOnce(&mut AtomicFile) -> io::Result<()>) -> Result<(), FormatError> {
    let mut file = AtomicFile::create(path)?;
    write(&mut file).map_err(|error| FormatError::new(Problem::Write(error), None).in_file(path))?;
    file.commit()
}
