//! What all subdivision searches share: limits, counts, and what is left open.

use crate::{Enclosure, Monitor};
use std::time::{Duration, Instant};

/// Limits of a search.
///
/// ```
/// use sweepsim_solve::SolveOptions;
/// let options = SolveOptions::default().boxes(10_000).smallest(1e-10);
/// assert_eq!(options.boxes, 10_000);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SolveOptions {
    /// A box whose sides are all at most this part of the domain's is not split further. At least 1e-14.
    pub smallest: f64,
    /// The most boxes that are looked at.
    pub boxes: u64,
    /// The most splits above a box.
    pub depth: u32,
    /// The most boxes that may stay open before the search gives up: a continuum of solutions must not flood it.
    pub unresolved: usize,
    /// The longest that the search may take. Results then depend on the machine's speed; the other limits do not.
    pub time: Option<Duration>,
}

impl Default for SolveOptions {
    fn default() -> Self {
        Self {
            smallest: 1e-11,
            boxes: 2_000_000,
            depth: 2_000,
            unresolved: 512,
            time: None,
        }
    }
}

impl SolveOptions {
    /// Sets [`smallest`](Self::smallest).
    #[must_use]
    pub const fn smallest(mut self, smallest: f64) -> Self {
        self.smallest = smallest;
        self
    }

    /// Sets [`boxes`](Self::boxes).
    #[must_use]
    pub const fn boxes(mut self, boxes: u64) -> Self {
        self.boxes = boxes;
        self
    }

    /// Sets [`depth`](Self::depth).
    #[must_use]
    pub const fn depth(mut self, depth: u32) -> Self {
        self.depth = depth;
        self
    }

    /// Sets [`unresolved`](Self::unresolved).
    #[must_use]
    pub const fn unresolved(mut self, unresolved: usize) -> Self {
        self.unresolved = unresolved;
        self
    }

    /// Sets [`time`](Self::time).
    #[must_use]
    pub const fn time(mut self, time: Option<Duration>) -> Self {
        self.time = time;
        self
    }
}

/// What became of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Fate {
    /// An equation has one sign on it.
    Sign,
    /// The affine enclosures have no common zero in it.
    Linear,
    /// Some equation cannot vanish in any part of some side.
    Projection,
    /// It holds one solution, or one piece of a curve or surface, with certificate.
    Certified,
    /// The one solution that could lie in it lies outside.
    Elsewhere,
    /// It was split.
    Split,
    /// It stays open.
    Unresolved,
}

/// Why a box stays open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Cause {
    /// It is as small as [`SolveOptions::smallest`]: a multiple root, a singular point, or solutions nearer to one another than that.
    Smallest,
    /// An equation is zero on it up to rounding (or its stated error).
    Vanishing,
    /// [`SolveOptions::boxes`] is spent.
    Boxes,
    /// [`SolveOptions::depth`] is reached.
    Depth,
    /// [`SolveOptions::unresolved`] is reached.
    Flood,
    /// [`SolveOptions::time`] is spent.
    Time,
    /// The [`Monitor`] asked to stop.
    Cancelled,
}

impl std::fmt::Display for Cause {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Smallest => "smallest size reached: a multiple or singular solution, or a cluster",
            Self::Vanishing => "an equation vanishes up to rounding",
            Self::Boxes => "budget of boxes spent",
            Self::Depth => "depth reached",
            Self::Flood => "too many boxes stay open",
            Self::Time => "time spent",
            Self::Cancelled => "cancelled",
        })
    }
}

/// A box that may hold solutions besides those returned: neither settled nor excluded.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct UnresolvedBox {
    /// The box; touching ones of the same cause are united.
    pub bounds: Vec<Enclosure>,
    /// Why.
    pub cause: Cause,
    /// How many boxes of the subdivision it unites.
    pub boxes: usize,
}

/// How many boxes met which fate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct SolveStatistics {
    /// Boxes looked at: those of the subdivision itself, which a [`Monitor`](crate::Monitor) sees.
    pub boxes: u64,
    /// Boxes of the searches on the faces of boxes (curves only). They have no fate here, but count towards the budget.
    pub faces: u64,
    /// Of these, excluded by a sign of the coefficients.
    pub sign: u64,
    /// Excluded by affine enclosures.
    pub linear: u64,
    /// Excluded by projection.
    pub projection: u64,
    /// Settled with a certificate.
    pub certified: u64,
    /// Whose only candidate lies elsewhere.
    pub elsewhere: u64,
    /// Split.
    pub splits: u64,
    /// Left open.
    pub unresolved: u64,
    /// Reductions of boxes.
    pub reductions: u64,
    /// Attempts at a certificate.
    pub attempts: u64,
    /// Computations anew from the first coefficients, in twice the precision.
    pub refreshed: u64,
    /// The most splits above a box.
    pub depth: u32,
}

impl SolveStatistics {
    pub(crate) fn merge(&mut self, other: &Self) {
        self.boxes += other.boxes;
        self.faces += other.faces;
        self.sign += other.sign;
        self.linear += other.linear;
        self.projection += other.projection;
        self.certified += other.certified;
        self.elsewhere += other.elsewhere;
        self.splits += other.splits;
        self.unresolved += other.unresolved;
        self.reductions += other.reductions;
        self.attempts += other.attempts;
        self.refreshed += other.refreshed;
        self.depth = self.depth.max(other.depth);
    }

    pub(crate) fn count(&mut self, fate: Fate) {
        *match fate {
            Fate::Sign => &mut self.sign,
            Fate::Linear => &mut self.linear,
            Fate::Projection => &mut self.projection,
            Fate::Certified => &mut self.certified,
            Fate::Elsewhere => &mut self.elsewhere,
            Fate::Split => &mut self.splits,
            Fate::Unresolved => &mut self.unresolved,
        } += 1;
    }
}

/// The budget's clock.
#[derive(Debug)]
pub(crate) struct Watch {
    deadline: Option<Instant>,
    ticks: u32,
}

impl Watch {
    pub(crate) fn new(options: &SolveOptions) -> Self {
        Self {
            deadline: options.time.and_then(|t| Instant::now().checked_add(t)),
            ticks: 0,
        }
    }

    /// Why to stop before the next box, if at all.
    pub(crate) fn stop(
        &mut self,
        options: &SolveOptions,
        statistics: &SolveStatistics,
        open: usize,
        monitor: &dyn Monitor,
    ) -> Option<Cause> {
        if statistics.boxes + statistics.faces >= options.boxes {
            return Some(Cause::Boxes);
        }
        if open > options.unresolved {
            return Some(Cause::Flood);
        }
        if monitor.cancelled() {
            return Some(Cause::Cancelled);
        }
        // Asking the clock is not as cheap.
        self.ticks += 1;
        let late = self.ticks.is_multiple_of(32) && self.deadline.is_some_and(|d| Instant::now() >= d);
        late.then_some(Cause::Time)
    }
}
