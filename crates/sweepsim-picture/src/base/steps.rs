//! How far a picture has come, and whether it is still wanted.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Is told the share of the work that is done, and says whether to go on.
pub(crate) type GoOn<'a> = &'a (dyn Fn(f64) -> ControlFlow<()> + Sync);

/// Counts the steps of a picture.
pub(crate) struct Steps<'a> {
    go_on: GoOn<'a>,
    done: AtomicUsize,
    all: usize,
}

impl<'a> Steps<'a> {
    pub fn new(go_on: GoOn<'a>, all: usize) -> Self {
        let done = AtomicUsize::new(0);
        Self { go_on, done, all }
    }

    /// Does a step, unless the picture is no longer wanted.
    pub fn step<T>(&self, work: impl FnOnce() -> T) -> Option<T> {
        let done = self.done.fetch_add(1, Ordering::Relaxed);
        let share = done as f64 / self.all.max(1) as f64;
        (self.go_on)(share.min(1.0)).is_continue().then(work)
    }
}
