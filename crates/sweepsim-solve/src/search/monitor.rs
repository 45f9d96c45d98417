//! How callers watch and cancel a search.

use super::Fate;
use crate::Enclosure;

/// Watches a search: progress, cancellation, pictures. `()` watches nothing.
///
/// A search may run on several threads, so a monitor is shared: it keeps its state in atomics or behind a lock.
///
/// ```
/// use std::sync::atomic::{AtomicU64, Ordering};
/// use sweepsim_solve::Monitor;
///
/// /// Cancels after a number of calls.
/// struct Patience(AtomicU64);
///
/// impl Monitor for Patience {
///     fn cancelled(&self) -> bool {
///         self.0.fetch_add(1, Ordering::Relaxed) >= 1000
///     }
/// }
/// ```
pub trait Monitor: Sync {
    /// Called when a part of longer work begins, with its name; [`advance`](Self::advance) counts from 0 again.
    fn phase(&self, name: &'static str) {
        let _ = name;
    }

    /// Called when `done` of `total` parts of the work are finished. Searches that cannot know their total do not call it.
    fn advance(&self, done: usize, total: usize) {
        let _ = (done, total);
    }

    /// Whether to stop. Called before every box, and now and then in long loops, so it should be cheap, such as loading an atomic. Once it has returned `true`, it
    /// must continue to do so.
    fn cancelled(&self) -> bool {
        false
    }

    /// Whether [`visit`](Self::visit) should be called. Constant during a search.
    fn visits(&self) -> bool {
        false
    }

    /// Called with each box once its fate is known (it may have been reduced by then), and the number of splits above it.
    fn visit(&self, bounds: &[Enclosure], depth: u32, fate: Fate) {
        let _ = (bounds, depth, fate);
    }
}

impl Monitor for () {}

impl<M: Monitor + ?Sized> Monitor for &M {
    fn phase(&self, name: &'static str) {
        (**self).phase(name);
    }

    fn advance(&self, done: usize, total: usize) {
        (**self).advance(done, total);
    }

    fn cancelled(&self) -> bool {
        (**self).cancelled()
    }

    fn visits(&self) -> bool {
        (**self).visits()
    }

    fn visit(&self, bounds: &[Enclosure], depth: u32, fate: Fate) {
        (**self).visit(bounds, depth, fate);
    }
}

/// Passes on cancellation and nothing else: for a search within another one, whose progress and boxes are of no interest.
#[derive(Clone, Copy)]
pub struct CancelOnly<'a>(pub &'a dyn Monitor);

impl std::fmt::Debug for CancelOnly<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("CancelOnly(..)")
    }
}

impl Monitor for CancelOnly<'_> {
    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }
}
