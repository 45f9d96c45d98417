//! Interruption by Ctrl-C, or by the system (SIGTERM, SIGHUP): the process ends at once, whatever it computes; a file
//! that is being written is given up first, so that nothing half-written remains.

use super::Failure;
use indicatif::ProgressBar;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use sweepsim_job::JobError;

/// What an interruption has to know of the run.
struct Run {
    /// Whether a file is being written.
    writing: bool,
    /// The names of the output files that are complete.
    complete: Vec<String>,
    /// Removed from the terminal before the last message.
    bar: Option<ProgressBar>,
}

static RUN: Mutex<Run> = Mutex::new(Run {
    writing: false,
    complete: Vec::new(),
    bar: None,
});
static INTERRUPTED: AtomicBool = AtomicBool::new(false);
/// What shells report for a process ended by SIGINT.
pub(crate) const EXIT_STATUS: u8 = 130;

/// Handles interruptions from now on. Where no handler can be set, the system ends the process.
pub(crate) fn handle() {
    let _ = ctrlc::set_handler(|| {
        let again = INTERRUPTED.swap(true, Ordering::Relaxed);
        // Locked until the end: no file is begun meanwhile.
        let run = run();
        if run.writing && !again {
            return;
        }
        if let Some(bar) = &run.bar {
            bar.finish_and_clear();
        }
        let complete = run.complete.clone();
        anstream::eprintln!("{}", Failure::Interrupted { complete });
        std::process::exit(EXIT_STATUS.into());
    });
}

/// Whether the run has been interrupted, and is giving up the file that it writes.
pub(crate) fn interrupted() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// Removes this bar from the terminal if the run is interrupted.
pub(crate) fn remove_at_end(bar: ProgressBar) {
    run().bar = Some(bar);
}

/// Writes a file, and names it among those that are complete. Fails if the run has been interrupted meanwhile, so that
/// it ends.
pub(crate) fn writing<T>(name: Option<&str>, write: impl FnOnce() -> Result<T, JobError>) -> Result<T, JobError> {
    run().writing = true;
    let written = write();
    let mut run = run();
    run.writing = false;
    if written.is_ok() {
        run.complete.extend(name.map(str::to_owned));
    }
    if interrupted() {
        drop(run);
        return Err(JobError::Cancelled);
    }
    written
}

/// The names of the output files that are complete.
pub(crate) fn complete() -> Vec<String> {
    run().complete.clone()
}

fn run() -> MutexGuard<'static, Run> {
    RUN.lock().unwrap_or_else(PoisonError::into_inner)
}
