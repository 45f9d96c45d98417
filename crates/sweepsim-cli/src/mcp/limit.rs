//! How much work a call may do.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use sweepsim_job::Monitor;

/// Watches the work of a call, and ends it.
#[derive(Debug, Default)]
pub(super) struct Limit {
    reached: AtomicBool,
    /// The phase, how much of it is done, and of how much.
    at: Mutex<(&'static str, usize, usize)>,
}

impl Limit {
    /// Ends the work.
    pub fn reach(&self) {
        self.reached.store(true, Ordering::Relaxed);
    }

    /// How far the work came, in words.
    pub fn progress(&self) -> String {
        match *self.at.lock().unwrap_or_else(PoisonError::into_inner) {
            ("", ..) => "while reading".to_owned(),
            (phase, _, 0) => format!("in the phase {phase:?}"),
            (phase, done, total) => format!("in the phase {phase:?}, after {done} of {total} parts"),
        }
    }
}

impl Monitor for Limit {
    fn phase(&self, name: &'static str) {
        *self.at.lock().unwrap_or_else(PoisonError::into_inner) = (name, 0, 0);
    }

    fn advance(&self, done: usize, total: usize) {
        let mut at = self.at.lock().unwrap_or_else(PoisonError::into_inner);
        (at.1, at.2) = (done, total);
    }

    fn cancelled(&self) -> bool {
        self.reached.load(Ordering::Relaxed)
    }
}
