//! Runs the command in a temporary folder.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

/// A temporary folder with a job in it, and the command that runs there.
pub struct Workdir(TempDir);

impl Workdir {
    /// A folder with `job.ron`.
    pub fn new(job: &str) -> Self {
        let folder = Self(tempfile::tempdir().expect("a folder"));
        fs::write(folder.path("job.ron"), job).expect("a file");
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Runs the command in the folder.
    pub fn run(&self, arguments: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_sweepsim"))
            .args(arguments)
            .current_dir(self.0.path())
            .output()
            .expect("the command starts")
    }

    /// Runs `COMMAND job.ron --out out` with more arguments.
    pub fn run_job(&self, command: &str, more: &[&str]) -> Output {
        self.run(&[&[command, "job.ron", "--out", "out"], more].concat())
    }

    /// The standard output of a run that must succeed.
    pub fn good(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        assert!(output.status.success(), "{arguments:?}: {}", text(&output.stderr));
        text(&output.stdout)
    }

    /// The message of a run that must fail.
    pub fn bad(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", text(&output.stdout));
        text(&output.stderr)
    }

    /// The names of the files in `out`.
    pub fn written(&self) -> Vec<String> {
        listed(&self.path("out"))
    }
}

fn listed(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let name = |entry: std::io::Result<fs::DirEntry>| entry.unwrap().file_name().to_string_lossy().into_owned();
    let mut names: Vec<String> = entries.map(name).collect();
    names.sort();
    names
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
