//! A job that a command works on.

use super::{Failure, Kind, Outputs, Progress, output_folder};
use crate::arguments::{Output, ProgramOptions};
use std::path::{Path, PathBuf};
use std::time::Instant;
use sweepsim::{Cut, SweepError};
use sweepsim_formats::{Job, Report, draft};

/// A job, and what had to be guessed if it was made for a program.
pub(crate) struct JobRead {
    pub job: Job,
    pub guessed: Vec<String>,
}

/// Reads a job, or makes one for a program.
pub(crate) fn read_job(file: &Path, options: &ProgramOptions, cells: Option<[usize; 2]>) -> Result<JobRead, Failure> {
    let is_project = file
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("camotics"));
    match Kind::of(file)? {
        Kind::Job => {
            if let Some(option) = options.first() {
                let message = format!(
                    "{option} is for programs: {} is a job, which says it itself",
                    file.display()
                );
                return Err(Failure::message(message));
            }
            let (job, guessed) = (Job::read(file)?, Vec::new());
            Ok(JobRead { job, guessed })
        }
        Kind::Tools if is_project => of_program(file, options, cells),
        Kind::Path => of_program(file, options, cells),
        Kind::Mesh | Kind::Dexels | Kind::Tools => Err(Failure::message(format!(
            "{}: expected a job (.ron) or a program (.nc .cls …)",
            file.display()
        ))),
    }
}

fn of_program(file: &Path, options: &ProgramOptions, cells: Option<[usize; 2]>) -> Result<JobRead, Failure> {
    let mut draft_options = options.draft(file.parent().unwrap_or(Path::new("")));
    draft_options.cells = cells;
    let draft = draft(file, &draft_options)?;
    let job = Job::parse(&draft.text, &draft.program)?;
    let guessed = draft.guessed;
    Ok(JobRead { job, guessed })
}

/// A job as read, its output folder, and the progress of the work.
pub(crate) struct JobSession {
    file: PathBuf,
    pub job: Job,
    guessed: Vec<String>,
    pub outputs: Outputs,
    pub progress: Progress,
}

impl JobSession {
    /// Prepares to work on a job that was read from `file`. The output folder is created.
    pub fn new(
        file: &Path,
        read: JobRead,
        out: Option<&Path>,
        wanted: &[Output],
        quiet: bool,
    ) -> Result<Self, Failure> {
        let JobRead { job, guessed } = read;
        let outputs = Outputs::new(output_folder(out, &job.name), wanted)?;
        let progress = Progress::new(job.moves(), quiet);
        Ok(Self {
            file: file.to_owned(),
            job,
            guessed,
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
            SweepError::Cancelled => Failure::interrupted(),
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
        let guessed = self.guessed.iter().map(|guess| format!("guessed: {guess}"));
        guessed.chain(own).chain(of_paths).collect()
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
