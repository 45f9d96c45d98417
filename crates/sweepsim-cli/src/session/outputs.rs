//! The output files of a run, which an interruption leaves complete or not at all.

use super::interruption::{interrupted, writing};
use std::io;
use std::path::{Path, PathBuf};
use sweepsim_job::{Content, Folder, JobError, Sink, words};

/// The output folder, and what has been written to it.
#[derive(Debug)]
pub(crate) struct Outputs(Folder);

impl Outputs {
    /// Creates the folder, and checks that files can be written to it.
    pub fn new(folder: PathBuf) -> Result<Self, JobError> {
        writing(None, || Folder::create(folder)).map(Self)
    }

    /// Files anywhere.
    pub fn anywhere() -> Self {
        Self(Folder::default())
    }

    /// The folder; empty for files anywhere.
    pub fn folder(&self) -> &Path {
        self.0.path()
    }

    /// The files written, with their sizes, for the last line of a summary.
    pub fn listed(&self) -> String {
        // Numbered files are listed as one.
        let series = |name: &str| name.starts_with("frame-");
        let runs = self.0.written().chunk_by(|(a, _), (b, _)| series(a) && series(b));
        let files: Vec<String> = runs
            .map(|run| {
                let size = words::bytes(run.iter().map(|(_, size)| size).sum());
                match run {
                    [(first, _), .., (last, _)] => format!("{first} … {last} ({size})"),
                    _ => format!("{} ({size})", run[0].0),
                }
            })
            .collect();
        match self.0.path().as_os_str().is_empty() {
            true => files.join(", "),
            false => format!("{}: {}", self.0.path().display(), files.join(", ")),
        }
    }
}

impl Sink for Outputs {
    fn write(&mut self, name: &str, content: Content) -> Result<(), JobError> {
        writing(Some(name), || {
            self.0.write(name, &mut |file| content(&mut Interruptible(file)))
        })
    }

    fn remove(&mut self, name: &str) -> bool {
        self.0.remove(name)
    }
}

/// A file whose writing fails once the run is interrupted.
struct Interruptible<'a>(&'a mut dyn io::Write);

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
