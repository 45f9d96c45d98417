//! Limits, fates and counts of subdivision searches.

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
    /// Boxes whose sides are all smaller than this fraction of the domain are not split further. At least 1e-14.
    pub smallest: f64,
    /// The maximum number of boxes.
    pub boxes: u64,
    /// The maximum depth: the number of splits above a box.
    pub depth: u32,
    /// The number of boxes that may wait or stay unresolved before a continuum of solutions is assumed. Curve and surface searches then stop. The point
    /// search goes on more coarsely: near boxes that stay unresolved it leaves others of up to 1/2048 of the domain unresolved, too. It reports at
    /// most this many clusters of unresolved boxes.
    pub unresolved: usize,
    /// The maximum number of vertices of polylines and meshes. 2²⁴ by default.
    pub vertices: usize,
    /// The maximum time. With this limit results depend on the speed of the machine; with the others they do not.
    pub time: Option<Duration>,
}

impl Default for SolveOptions {
    fn default() -> Self {
        Self {
            smallest: 1e-11,
            boxes: 2_000_000,
            depth: 2_000,
            unresolved: 512,
            vertices: 1 << 24,
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

    /// Sets [`vertices`](Self::vertices).
    #[must_use]
    pub const fn vertices(mut self, vertices: usize) -> Self {
        self.vertices = vertices;
        self
    }

    /// Sets [`time`](Self::time).
    #[must_use]
    pub const fn time(mut self, time: Option<Duration>) -> Self {
        self.time = time;
        self
    }
}

/// The outcome for a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Fate {
    /// An equation has one sign on it.
    Sign,
    /// The affine enclosures have no common zero in it.
    Linear,
    /// The projections of an equation exclude it.
    Projection,
    /// It holds one certified solution, or one certified piece of a curve or surface.
    Certified,
    /// Its only candidate for a solution lies outside.
    Elsewhere,
    /// It was split.
    Split,
    /// It stays unresolved.
    Unresolved,
}

/// Why a box stays unresolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Cause {
    /// It is as small as [`SolveOptions::smallest`]: a multiple root, a singular point, or several solutions closer together than that.
    Smallest,
    /// An equation is zero on it up to rounding (or its stated error).
    Vanishing,
    /// [`SolveOptions::boxes`] is used up.
    Boxes,
    /// [`SolveOptions::depth`] is reached.
    Depth,
    /// [`SolveOptions::unresolved`] is reached.
    Flood,
    /// [`SolveOptions::time`] is used up.
    Time,
    /// Polylines or a mesh would have more vertices than [`SolveOptions::vertices`], or than can be numbered with 32 bits.
    Vertices,
    /// The [`Monitor`] asked to stop.
    Cancelled,
    /// A curve may touch the boundary of the region in it, from outside.
    Skin,
    /// A function is not differentiable in it, or not defined in a part of it, such as a square root at 0. It is as small as
    /// [`SolveOptions::smallest`], or an equation vanishes on it.
    NotDifferentiable,
}

impl std::fmt::Display for Cause {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Smallest => "smallest box size reached: a multiple or singular solution, or a cluster",
            Self::Vanishing => "an equation vanishes up to rounding",
            Self::Boxes => "budget of boxes used up",
            Self::Depth => "maximum depth reached",
            Self::Flood => "too many unresolved boxes",
            Self::Time => "time used up",
            Self::Vertices => "budget of vertices used up",
            Self::Cancelled => "cancelled",
            Self::Skin => "a curve may touch the region's boundary from outside",
            Self::NotDifferentiable => "a function is not differentiable, or not defined in a part of the box",
        })
    }
}

/// A box that may hold further solutions: it was neither certified nor excluded.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct UnresolvedBox {
    /// The box. Boxes near one another are merged, unless that would cover much else.
    pub bounds: Vec<Enclosure>,
    /// Why it stays unresolved; if it was merged, the commonest reason.
    pub cause: Cause,
    /// The number of merged boxes.
    pub boxes: usize,
    /// The merged boxes; empty if there is only one, or if the solver does not keep them. Outside of them, `bounds` holds no solution.
    pub parts: Vec<Vec<Enclosure>>,
    /// What is known of the number of roots in and next to it; `None` if nothing is.
    pub count: Option<RootCount>,
}

/// What is proved of the number of roots in a box, for every system within the coefficients' error bounds.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RootCount {
    /// A box around the unresolved box and the real points of the neighbourhood in which roots were counted. It meets no other unresolved box and no certified root, so
    /// the roots of the region in it are among those counted.
    pub within: Vec<Enclosure>,
    /// The number of complex zeros, with multiplicity, in a neighbourhood of the unresolved box (in one unknown: the disc with `within` as a diameter, or within). Real
    /// roots are at most as many, and differ from it by an even number.
    pub zeros: Option<u32>,
    /// In two and more unknowns: the Brouwer degree, the sum of the orientations of the real roots in the neighbourhood (of a root of multiplicity `m`: between `−m` and `m`). If it is not
    /// 0, there is a root. If it is 0, there may or may not be.
    pub degree: Option<i32>,
}

impl UnresolvedBox {
    pub(crate) const fn new(bounds: Vec<Enclosure>, cause: Cause, boxes: usize) -> Self {
        Self {
            bounds,
            cause,
            boxes,
            parts: Vec::new(),
            count: None,
        }
    }
}

/// Counts of a search, by the fate of boxes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct SolveStatistics {
    /// Boxes of the subdivision: those that a [`Monitor`](crate::Monitor) visits.
    pub boxes: u64,
    /// Boxes of searches on faces (curves only). They count towards the budget, but are not counted by fate.
    pub faces: u64,
    /// Of these, excluded by a sign of the coefficients.
    pub sign: u64,
    /// Excluded by affine enclosures.
    pub linear: u64,
    /// Excluded by projection.
    pub projection: u64,
    /// Certified.
    pub certified: u64,
    /// Boxes whose only candidate lies elsewhere.
    pub elsewhere: u64,
    /// Split.
    pub splits: u64,
    /// Left unresolved.
    pub unresolved: u64,
    /// Reductions of boxes.
    pub reductions: u64,
    /// Attempts at a certificate.
    pub attempts: u64,
    /// Recomputations from the original coefficients in double-double precision.
    pub refreshed: u64,
    /// The largest number of splits above a box.
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
}

impl Watch {
    pub(crate) fn new(options: &SolveOptions) -> Self {
        Self::until(options.time.and_then(|t| Instant::now().checked_add(t)))
    }

    /// With a deadline that was set earlier.
    pub(crate) const fn until(deadline: Option<Instant>) -> Self {
        Self { deadline }
    }

    /// A clock for another thread, with the same deadline.
    pub(crate) fn share(&self) -> Self {
        Self::until(self.deadline)
    }

    /// Whether the time is used up.
    pub(crate) fn late(&self) -> bool {
        self.deadline.is_some_and(|d| Instant::now() >= d)
    }

    /// The reason to stop before the next box, if any.
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
        self.late().then_some(Cause::Time)
    }
}
