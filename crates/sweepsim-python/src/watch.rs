//! Long work, that Python watches and can end.

use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;
use sweepsim_job::Monitor;

/// How often Python is asked whether it was interrupted, and is told the progress.
const TICK: Duration = Duration::from_millis(50);
/// That of a main thread: readers of nested text may need it.
const STACK: usize = 8 << 20;

/// How much is done, of how much (0 if that is not known yet), in which phase.
type Step = (usize, usize, &'static str);

/// What the work tells, and whether it is to end.
#[derive(Default)]
struct Watch {
    stop: AtomicBool,
    /// The present phase, and what Python has not been told yet: the last step of each phase. Without a callback
    /// nothing is noted.
    steps: Option<Mutex<(&'static str, Vec<Step>)>>,
}

impl Watch {
    fn note(&self, note: impl FnOnce(&mut &'static str, &mut Vec<Step>)) {
        if let Some(steps) = &self.steps {
            let (phase, steps) = &mut *steps.lock().unwrap_or_else(PoisonError::into_inner);
            note(phase, steps);
        }
    }

    /// Tells Python what it does not know yet.
    fn tell(&self, progress: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let mut told = Vec::new();
        self.note(|_, steps| told = std::mem::take(steps));
        let Some(progress) = progress else { return Ok(()) };
        told.into_iter().try_for_each(|step| progress.call1(step).map(drop))
    }
}

impl Monitor for Watch {
    fn phase(&self, name: &'static str) {
        self.note(|phase, steps| {
            *phase = name;
            steps.push((0, 0, name));
        });
    }

    fn advance(&self, done: usize, total: usize) {
        self.note(|phase, steps| match steps.last_mut() {
            // Threads may come late with less.
            Some(last) if last.2 == *phase => (last.0, last.1) = (done.max(last.0), total),
            _ => steps.push((done, total, phase)),
        });
    }

    fn cancelled(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

/// Carries out work on a thread of its own, while this one leaves Python to others, tells the progress, and listens to
/// interruptions. An exception, of a signal's handler or of the callback, cancels the work and is raised when that has
/// ended.
pub(crate) fn watched<T: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&dyn Monitor) -> T + Send,
) -> PyResult<T> {
    let watch = Watch {
        steps: progress.is_some().then(Mutex::default),
        ..Watch::default()
    };
    let heard = |py: Python<'_>| {
        py.check_signals()?;
        watch.tell(progress.as_ref().map(|progress| progress.bind(py)))
    };
    let watched = &watch;
    let (done, raised) = py.detach(|| {
        thread::scope(|scope| {
            let (sender, receiver) = sync_channel(1);
            let worker = thread::Builder::new().stack_size(STACK);
            let worker = worker.spawn_scoped(scope, move || {
                // The receiver outlives the thread.
                let _ = sender.send(work(watched));
            });
            if let Err(error) = worker {
                return (None, Some(error.into()));
            }
            let mut raised: Option<PyErr> = None;
            loop {
                let done = match receiver.recv_timeout(TICK) {
                    Ok(done) => Some(done),
                    Err(RecvTimeoutError::Timeout) => None,
                    // The worker panicked, which goes on when its scope ends.
                    Err(RecvTimeoutError::Disconnected) => return (None, raised),
                };
                if raised.is_none()
                    && let Err(error) = Python::attach(heard)
                {
                    raised = Some(error);
                    watch.stop.store(true, Ordering::Relaxed);
                }
                if done.is_some() {
                    return (done, raised);
                }
            }
        })
    });
    match (done, raised) {
        (_, Some(raised)) => Err(raised),
        (Some(done), None) => Ok(done),
        (None, None) => unreachable!("a worker that sends nothing has panicked"),
    }
}
