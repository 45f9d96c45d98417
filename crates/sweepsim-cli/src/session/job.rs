//! A job that a command works on.

use super::{Failure, Outputs, Progress, output_folder};
use crate::arguments::Output;
use std::path::{Path, PathBuf};
use std::time::Instant;
use sweepsim::{Cut, SweepError};
use sweepsim_formats::{Job, Report};

/// A job as read, its output folder, and the progress of the work.
pub(crate) struct JobSession {
    file: PathBuf,
    pub job: Job,
    pub outputs: Outputs,
    pub progress: Progress,
}

impl JobSession {
    /// Prepares to work on a job that was read from `file`. The output folder is created.
    pub fn new(file: &Path, job: Job, out: Option<&Path>, wanted: &[Output], quiet: bool) -> Result<Self, Failure> {
        let outputs = Outputs::new(output_folder(out, &job.name), wanted)?;
        let progress = Progress::new(job.moves(), quiet);
        Ok(Self {
            file: file.to_owned(),
            job,
            outputs,
            progress,
        })
    }

    /// The job's file.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// The tools of the job, and their paths.
    pub fn cuts(&self) -> Vec<Cut<'_>> {
        cuts_of(&self.job)
    }

    /// The message for the user if a sweep fails.
    pub fn failed(&self, error: SweepError) -> Failure {
        match error {
            SweepError::Cancelled => Failure::Interrupted,
            error => self.failure(error),
        }
    }

    /// A failure that concerns the job.
    pub fn failure(&self, message: impl std::fmt::Display) -> Failure {
        Failure::message(format!("{}: {message}", self.file.display()))
    }

    /// The notes of the job, and of the files that it refers to.
    pub fn notes(&self) -> Vec<String> {
        let own = self
            .job
            .notes
            .iter()
            .map(|note| format!("{}: {note}", self.file.display()));
        let of_paths = self
            .job
            .paths
            .iter()
            .flat_map(|path| path.notes.iter().map(|note| format!("{}: {note}", path.source)));
        own.chain(of_paths).collect()
    }
}

fn cuts_of(job: &Job) -> Vec<Cut<'_>> {
    job.paths
        .iter()
        .map(|path| Cut::new(&job.tools[&path.tool], &path.path))
        .collect()
}

/// Runs a phase of the work, and adds its duration to the report.
pub(crate) fn phase<T>(report: &mut Report, name: &str, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    *report.seconds.entry(name.to_owned()).or_default() += start.elapsed().as_secs_f64();
    result
}
