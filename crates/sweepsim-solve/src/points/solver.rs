//! The 0-D solver: its search, and the postprocessing.

use super::Points;
use super::certify::Found;
use super::flood::{COARSE, CROWD};
use crate::coefficients::{Cell, PartRanges, pop, push};
use crate::numbers::{Double, Row};
use crate::search::{
    Cause, Fate, Open, SolveError, SolveOptions, SolveStatistics, UnresolvedBox, Watch, cluster_box, clusters, unite,
};
use crate::{Monitor, System};
use std::time::Instant;

/// The order in which boxes are searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    /// Depth first, until too many boxes stay open.
    DepthFirst,
    /// Depth first, and the largest first once boxes stay open (`flood.rs`).
    LargestInCrowds,
}

/// Whether preconditioned coefficients help: in some systems they halve the boxes, in others they only take time.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Blending {
    chances: u32,
    tries: u32,
    helps: u32,
}

impl Blending {
    /// Whether to try: at first, while at least half of the tries help, and now and then.
    pub(super) fn worthwhile(&mut self) -> bool {
        self.chances += 1;
        self.tries < 32 || 2 * self.helps >= self.tries || self.chances.is_multiple_of(16)
    }

    pub(super) fn record(&mut self, helped: bool) {
        self.tries += 1;
        self.helps += u32::from(helped);
    }
}

/// This part of the time is kept for what follows the search. Grouping the open boxes usually takes less; if it takes longer, it ends with the time, in coarser groups.
const KEPT: u32 = 10;

/// The 0-D solver. It reuses its memory from one system to the next.
///
/// ```
/// use sweepsim_solve::{Bernstein, Enclosure, PointSolver, System};
///
/// // x² + y² = 1 and y = x, on [−2, 2]². In u = (x + 2)/4: x² = 16 u² − 16 u + 4 has coefficients 4, −4, 4.
/// let square = |axis| Bernstein::from_fn(&[2, 2], |i| [4.0, -4.0, 4.0][i[axis]]).unwrap();
/// let circle = square(0).add(&square(1)).sub(&Bernstein::constant(2, 1.0));
/// let line = Bernstein::variable(2, 1).sub(&Bernstein::variable(2, 0));
/// let system = System::mapped(&[Enclosure::new(-2.0, 2.0)?; 2], [&circle, &line])?;
/// let points = PointSolver::default().solve(&system, &())?;
/// assert_eq!(points.roots.len(), 2);
/// assert!(points.unresolved.is_empty());
/// assert!(points.roots[1].enclosure[0].contains(0.5f64.sqrt()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Default)]
pub struct PointSolver {
    /// Limits.
    pub options: SolveOptions,
    pub(crate) stack: Vec<f64>,
    pub(crate) depths: Vec<u32>,
    pub(crate) cell: Cell,
    pub(super) trial: Cell,
    pub(super) lower: Cell,
    pub(super) buffer: Vec<f64>,
    pub(super) doubles: Vec<Double>,
    pub(super) ranges: PartRanges,
    pub(super) failures: u32,
    pub(super) blending: Blending,
    /// When the search ends and, once it has ended, what follows.
    pub(super) deadline: Option<Instant>,
    /// When all ends.
    pub(super) end: Option<Instant>,
    /// Boxes of at most this size (in sides of the domain) stay open where noise hides the solution.
    pub(super) coarsest: f64,
    pub(crate) found: Vec<Found>,
    pub(crate) open: Vec<Open>,
    pub(crate) statistics: SolveStatistics,
}

impl PointSolver {
    /// Creates a solver with these limits.
    #[must_use]
    pub fn new(options: SolveOptions) -> Self {
        Self {
            options,
            ..Self::default()
        }
    }

    /// All roots of the system in its region.
    ///
    /// # Errors
    ///
    /// [`SolveError::Equations`] unless there are as many equations as variables; [`SolveError::Smallest`].
    pub fn solve(&mut self, system: &System, monitor: &dyn Monitor) -> Result<Points, SolveError> {
        self.check(system)?;
        self.start_clock();
        Ok(self.solve_in_time(system, monitor))
    }

    /// As [`solve`](Self::solve), for a system that was checked, until the deadline.
    pub(super) fn solve_in_time(&mut self, system: &System, monitor: &dyn Monitor) -> Points {
        self.restart();
        self.coarsest = COARSE;
        self.search(system, &system.root(), 0, monitor, Order::LargestInCrowds);
        // Several systems may share one time: the next one's search ends when this one's would have.
        let deadline = std::mem::replace(&mut self.deadline, self.end);
        self.finish(system);
        let points = self.points(system);
        self.deadline = deadline;
        points
    }

    pub(super) fn start_clock(&mut self) {
        let now = Instant::now();
        self.deadline = self.options.time.and_then(|t| now.checked_add(t - t / KEPT));
        self.end = self.options.time.and_then(|t| now.checked_add(t));
    }

    /// Whether the time of the search, or of what follows it, is used up.
    pub(super) fn late(&self) -> bool {
        self.deadline.is_some_and(|d| Instant::now() >= d)
    }

    /// How much time of the search is left; `None` if there is no limit.
    pub(super) fn time_left(&self) -> Option<std::time::Duration> {
        self.deadline.map(|d| d.saturating_duration_since(Instant::now()))
    }

    /// Checks that the system and the limits are valid.
    pub(crate) fn check(&self, system: &System) -> Result<(), SolveError> {
        let (n, m) = (system.layout.n, system.layout.m);
        if m != n {
            return Err(SolveError::Equations {
                equations: m,
                variables: n,
                expected: n,
            });
        }
        if !(1e-14..=1.0).contains(&self.options.smallest) {
            return Err(SolveError::Smallest);
        }
        Ok(())
    }

    /// The results, in the domain's coordinates.
    pub(crate) fn points(&mut self, system: &System) -> Points {
        let n = system.layout.n;
        self.found.sort_by(|a, b| {
            let ends = a.point[..n].iter().zip(&b.point[..n]);
            ends.map(|(x, y)| x.total_cmp(y))
                .find(|o| o.is_ne())
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        let roots = self.represent(system);
        let mut clusters = clusters(&self.open, n, self.options.unresolved, &|| self.late());
        let counts = self.counts(system, &mut clusters);
        let unresolved = clusters
            .iter()
            .zip(counts)
            .map(|(c, count)| UnresolvedBox {
                count,
                ..cluster_box(system, &self.open, c)
            })
            .collect();
        Points {
            roots,
            unresolved,
            statistics: self.statistics,
        }
    }

    /// The search and its postprocessing, with the results in inner coordinates in `found` and `open`. It stops at the limit of unresolved boxes: for
    /// systems whose roots are of no use unless all of them are simple.
    pub(crate) fn run(&mut self, system: &System, monitor: &dyn Monitor) {
        self.start_clock();
        self.restart();
        self.coarsest = f64::INFINITY;
        let root = system.root();
        self.search(system, &root, 0, monitor, Order::DepthFirst);
        self.finish(system);
        unite(&mut self.open, system.layout.n);
    }

    /// Clears the results.
    pub(crate) fn restart(&mut self) {
        self.statistics = SolveStatistics::default();
        self.found.clear();
        self.open.clear();
        self.stack.clear();
        self.depths.clear();
        self.failures = 0;
        self.blending = Blending::default();
    }

    /// Removes duplicate roots, and open boxes that hold nothing but a found root.
    pub(crate) fn finish(&mut self, system: &System) {
        let n = system.layout.n;
        self.identify(system);
        // An open box inside a box where a found root is the only one holds nothing else.
        let found = &self.found;
        self.open.retain(|o| {
            !found
                .iter()
                .any(|f| inside(&o.lo, &o.hi, &f.unique_lo, &f.unique_hi, n))
        });
    }

    /// The search from one cell at some depth; adds to `found` and `open`.
    pub(crate) fn search(&mut self, system: &System, first: &Cell, depth: u32, monitor: &dyn Monitor, order: Order) {
        let layout = &system.layout;
        let mut watch = Watch::until(self.deadline);
        push(&mut self.stack, first, layout);
        self.depths.push(depth);
        while let Some(depth) = self.depths.pop() {
            pop(&mut self.stack, &mut self.cell, layout);
            let open = match order {
                Order::DepthFirst => self.open.len(),
                Order::LargestInCrowds => 0,
            };
            let stop = watch.stop(&self.options, &self.statistics, open, monitor);
            if let Some(cause) = stop {
                self.leave(cause);
                while self.depths.pop().is_some() {
                    pop(&mut self.stack, &mut self.cell, layout);
                    self.leave(cause);
                }
                break;
            }
            self.watched_visit(system, depth, monitor);
            if order == Order::LargestInCrowds && self.open.len() > CROWD {
                self.largest_first(system, &mut watch, monitor);
            }
        }
    }

    /// Treats the current cell, and counts.
    pub(crate) fn visit(&mut self, system: &System, depth: u32) -> Fate {
        self.statistics.boxes += 1;
        self.statistics.depth = self.statistics.depth.max(depth);
        let fate = self.treat(system, depth);
        self.statistics.count(fate);
        fate
    }

    /// Leaves the current cell open.
    pub(crate) fn leave(&mut self, cause: Cause) {
        self.open.push(Open {
            lo: self.cell.lo,
            hi: self.cell.hi,
            cause,
            boxes: 1,
        });
    }

    /// Drops roots that were found from several boxes. Only a root whose enclosure leaves its box can be such a duplicate.
    fn identify(&mut self, system: &System) {
        let n = system.layout.n;
        let touches = |a: &Found, b: &Found| (0..n).all(|j| a.lo[j] <= b.hi[j] && b.lo[j] <= a.hi[j]);
        let mut kept: Vec<Found> = Vec::with_capacity(self.found.len());
        let mut straddling: Vec<usize> = Vec::new();
        for next in std::mem::take(&mut self.found) {
            let same = if next.straddles {
                kept.iter().position(|k| touches(k, &next))
            } else {
                straddling.iter().copied().find(|k| touches(&kept[*k], &next))
            };
            let Some(same) = same else {
                if next.straddles {
                    straddling.push(kept.len());
                }
                kept.push(next);
                continue;
            };
            let first = &mut kept[same];
            first.boundary |= next.boundary;
            let first = *first;
            let one = inside(&next.lo, &next.hi, &first.unique_lo, &first.unique_hi, n)
                || inside(&first.lo, &first.hi, &next.unique_lo, &next.unique_hi, n)
                || self.only_one(system, &first, &next);
            if !one {
                // Two enclosures that meet, neither within the other's box: one root or two.
                self.open.push(Open {
                    lo: next.lo,
                    hi: next.hi,
                    cause: Cause::Smallest,
                    boxes: 1,
                });
            }
        }
        self.found = kept;
    }
}

fn inside(lo: &Row, hi: &Row, outer_lo: &Row, outer_hi: &Row, n: usize) -> bool {
    (0..n).all(|j| outer_lo[j] <= lo[j] && hi[j] <= outer_hi[j])
}
