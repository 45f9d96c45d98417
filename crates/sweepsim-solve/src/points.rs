//! 0-D: all solutions of `n` equations in `n` unknowns.
//!
//! For each box, the cheapest test first:
//!
//! 1. *Sign*: an equation whose coefficients (with their rounding bound) have one sign excludes the box.
//! 2. *Linear*: with the mean Jacobian `A`, each equation is `constant + A z + rest`, `|rest| ≤ r`, over the box (`z` from its
//!    centre). With `K ≈ A⁻¹`, every root lies in `N = (I − K A) Z − K constant ± |K| r`. If `N` misses the box, it has none.
//! 3. *Certificate*: if `N` is small, take a box `C` around it (also beyond the box's faces). If `‖I − K J(C)‖∞ < 1`, the map is
//!    injective on `C`; if `N(C) ⊂ C`, the map `z ↦ z − K f(z)` takes `C` into itself, so by Brouwer there is a root. Newton's method
//!    finds it, and the same `K` bounds its error. All roots of the box lie in `C`: the box is settled.
//! 4. *Projection*: where the convex hull of an equation's coefficient ranges along an axis meets 0 (Sherbrooke, Patrikalakis 1993).
//! 5. Reduce, or split a little off the middle, in the direction in which the Jacobian varies most.
//!
//! A box at the smallest size stays open, with its cause. A root on a face between boxes is found from both, and is known to be the
//! same because each is the only one in a box `C` that also holds the other: never because it is near.

use crate::certify::{Found, newton_box, unique_root};
use crate::double::Double;
use crate::layout::{Cell, EPSILON, Layout};
use crate::matrix::{MAX_UNKNOWNS, Row, Square, inverse};
use crate::search::{Cause, Fate, Open, SolveOptions, SolveStatistics, Unresolved, Watch, unite};
use crate::{Interval, Monitor, System};
use thiserror::Error;

/// Where a certified root lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Place {
    /// Inside the region.
    Inside,
    /// On the region's boundary, or nearer to it than the root's enclosure is wide: certified on a larger box.
    Boundary,
}

/// A root with its certificate.
#[derive(Clone, Debug, PartialEq)]
pub struct Root {
    /// The root, as near as numbers allow.
    pub point: Vec<f64>,
    /// Holds the root.
    pub enclosure: Vec<Interval>,
    /// Holds no other root. It may reach beyond the domain.
    pub unique_in: Vec<Interval>,
    /// The sign of `det ∂f/∂x` at the root (and wherever the root is unique).
    pub orientation: i8,
    /// Inside or on the boundary.
    pub place: Place,
}

/// All roots of a system in a region: each lies in the enclosure of one of `roots`, or in one of `unresolved`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Points {
    /// Simple roots, each certified, in lexical order.
    pub roots: Vec<Root>,
    /// What could not be settled.
    pub unresolved: Vec<Unresolved>,
    /// What the search did.
    pub statistics: SolveStatistics,
}

/// A solver was given a system of another kind, or limits that make no sense.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SolveError {
    /// Another number of equations is needed.
    #[error("{equations} equations in {variables} variables; this solver needs {expected}")]
    Equations {
        /// Of the system.
        equations: usize,
        /// Of the system.
        variables: usize,
        /// What this solver needs for so many variables.
        expected: usize,
    },
    /// Another number of variables is needed.
    #[error("{variables} variables; this solver takes {least} to {most}")]
    Variables {
        /// Of the system.
        variables: usize,
        /// The fewest.
        least: usize,
        /// The most.
        most: usize,
    },
    /// [`SolveOptions::smallest`] or another size is not a number between 1e-14 and 1.
    #[error("a smallest size or tolerance is not between 1e-14 and 1")]
    Smallest,
}

/// The largest half width `h` of `N`, in sides of the box, at which a certificate is tried: for a quadratic, `‖I − K J‖` is
/// about `8 h` on the box and `24 h²` on the box three times as wide as `N`. After a failure it must have shrunk by [`AGAIN`].
const TRY: f64 = 0.2;
const AGAIN: f64 = 0.6;
/// The least half width of the box `C`, in sides of the box.
const LEAST: f64 = 1.0 / 16.0;
/// How far beyond the domain a certificate may reach, in its sides: the bounds of separated forms hold so far.
pub(crate) const BEYOND: f64 = 1.0 / 64.0;
/// A reduction to more than this part of each side is not worth its cost.
const WORTH: f64 = 0.75;
/// No side shrinks below this part in one reduction, nor below [`THIN`] of the widest.
const SHRINK: f64 = 1.0 / 64.0;
const THIN: f64 = 1e-8;
/// The least side, in those of the domain: some units in the last place.
const LEAST_SIDE: f64 = 4e-15;
/// Boxes are split here.
const CUT: f64 = 0.492;
/// Noise above this part of an equation's size makes its coefficients worth computing anew.
const NOISY: f64 = 1.5e-8;
/// Where an equation vanishes up to noise because a side that it depends on is below this part of another, the other is split all the same: the cell may
/// hold several simple roots.
const SQUEEZED: f64 = 1.0 / 64.0;
/// Before a cell stays open, certificates are tried on boxes of so many times its width, each so many times as wide as the one before.
const WIDER: f64 = 16.0;
const WIDER_TRIES: u32 = 6;
/// Where so many cells were tried in vain, the rest is not: a continuum of solutions.
const WIDER_FAILURES: u32 = 64;

#[expect(clippy::large_enum_variant, reason = "made once an attempt, and taken apart at once")]
enum Verdict {
    Root(Found),
    Elsewhere,
    Unclear,
}

/// The 0-D solver, with memory that it keeps from one system to the next.
///
/// ```
/// use sweepsim_solve::{Interval, PointSolver, System};
/// use sweepsim_spline::Bernstein;
///
/// // x² + y² = 1 and y = x, on [−2, 2]². In u = (x + 2)/4: x² = 16 u² − 16 u + 4 has coefficients 4, −4, 4.
/// let square = |axis| Bernstein::from_fn(&[2, 2], |i| [4.0, -4.0, 4.0][i[axis]]).unwrap();
/// let circle = square(0).add(&square(1)).sub(&Bernstein::constant(2, 1.0));
/// let line = Bernstein::variable(2, 1).sub(&Bernstein::variable(2, 0));
/// let system = System::new(&[Interval::new(-2.0, 2.0); 2], [&circle, &line])?;
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
    trial: Cell,
    lower: Cell,
    buffer: Vec<f64>,
    doubles: Vec<Double>,
    ranges: Vec<(f64, f64)>,
    failures: u32,
    pub(crate) found: Vec<Found>,
    pub(crate) open: Vec<Open>,
    pub(crate) statistics: SolveStatistics,
}

impl PointSolver {
    /// A solver with these limits.
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
        self.run(system, monitor);
        Ok(self.points(system))
    }

    /// Whether the system and the limits can be meant.
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

    /// What was found, in the domain's coordinates.
    pub(crate) fn points(&mut self, system: &System) -> Points {
        let n = system.layout.n;
        self.found.sort_by(|a, b| {
            let ends = a.point[..n].iter().zip(&b.point[..n]);
            ends.map(|(x, y)| x.total_cmp(y))
                .find(|o| o.is_ne())
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        let root = |f: &Found| Root {
            point: system.outer_point(&f.point),
            enclosure: system.outward(&f.lo, &f.hi),
            unique_in: system.inward(&f.unique_lo, &f.unique_hi),
            orientation: f.orientation,
            place: if f.boundary { Place::Boundary } else { Place::Inside },
        };
        Points {
            roots: self.found.iter().map(root).collect(),
            unresolved: self.open.iter().map(|o| open_box(system, o)).collect(),
            statistics: self.statistics,
        }
    }

    /// The search and what follows it, with the results in inner coordinates: in `found` and `open`.
    pub(crate) fn run(&mut self, system: &System, monitor: &dyn Monitor) {
        self.restart();
        let root = system.root();
        self.search(system, &root, 0, monitor);
        self.finish(system.layout.n);
    }

    /// Forgets what was found.
    pub(crate) fn restart(&mut self) {
        self.statistics = SolveStatistics::default();
        self.found.clear();
        self.open.clear();
        self.stack.clear();
        self.depths.clear();
        self.failures = 0;
    }

    /// Counts roots once, and unites open boxes.
    pub(crate) fn finish(&mut self, n: usize) {
        self.identify(n);
        // An open box inside a box where a found root is the only one holds nothing else.
        let found = &self.found;
        self.open.retain(|o| {
            !found
                .iter()
                .any(|f| inside(&o.lo, &o.hi, &f.unique_lo, &f.unique_hi, n))
        });
        unite(&mut self.open, n);
    }

    /// The depth-first search from one cell at some depth; adds to `found` and `open`.
    pub(crate) fn search(&mut self, system: &System, first: &Cell, depth: u32, monitor: &dyn Monitor) {
        let layout = &system.layout;
        let mut watch = Watch::new(&self.options);
        push(&mut self.stack, first, layout);
        self.depths.push(depth);
        while let Some(depth) = self.depths.pop() {
            pop(&mut self.stack, &mut self.cell, layout);
            let stop = watch.stop(&self.options, &self.statistics, self.open.len(), monitor);
            if let Some(cause) = stop {
                self.leave(cause);
                while self.depths.pop().is_some() {
                    pop(&mut self.stack, &mut self.cell, layout);
                    self.leave(cause);
                }
                break;
            }
            let fate = self.visit(system, depth);
            if monitor.visits() {
                // Where the cell was split, `cell` is the upper part by now and `lower` the other.
                let lo = if fate == Fate::Split {
                    &self.lower.lo
                } else {
                    &self.cell.lo
                };
                monitor.visit(&system.outward(lo, &self.cell.hi), depth, fate);
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

    /// Tests, reduces and, if need be, splits the current cell (pushing the parts).
    fn treat(&mut self, system: &System, depth: u32) -> Fate {
        let layout = &system.layout;
        let n = layout.n;
        let mut threshold = TRY;
        let (totals, inverted) = loop {
            let mut totals = layout.ranges(&mut self.cell);
            if excluded(&totals, n) {
                return Fate::Sign;
            }
            if layout.noisy(&self.cell, &totals, NOISY) && within_domain(&self.cell, n) {
                layout.refresh(&mut self.cell, &mut self.doubles);
                self.statistics.refreshed += 1;
                totals = layout.ranges(&mut self.cell);
                if excluded(&totals, n) {
                    return Fate::Sign;
                }
            }
            let affine = layout.affine(&self.cell, layout.mean_slopes(&self.cell.c));
            let inverted = inverse(&affine.slope, n);
            let mut window = [(0.0, 1.0); MAX_UNKNOWNS];
            if let Some((k, _)) = &inverted {
                let (centre, half) = newton_box(&affine, k, n);
                for j in 0..n {
                    window[j].0 = (0.5 + centre[j] - half[j]).max(0.0);
                    window[j].1 = (0.5 + centre[j] + half[j]).min(1.0);
                    if window[j].0 > window[j].1 {
                        return Fate::Linear;
                    }
                }
                let largest = half[..n].iter().fold(0.0, |m: f64, h| m.max(*h));
                let bounded = half[..n].iter().all(|h| h.is_finite());
                if bounded && largest <= threshold {
                    threshold = AGAIN * largest;
                    match self.certify(system, &centre, &half) {
                        Verdict::Root(found) => {
                            self.found.push(found);
                            return Fate::Certified;
                        }
                        Verdict::Elsewhere => return Fate::Elsewhere,
                        Verdict::Unclear => {}
                    }
                }
            }
            layout.part_ranges(&self.cell, &mut self.ranges);
            for j in 0..n {
                layout.project(&self.cell, &self.ranges, &totals, j, &mut window[j]);
                if window[j].0 > window[j].1 {
                    return Fate::Projection;
                }
            }
            if !self.reduce(layout, &mut window) {
                break (totals, inverted);
            }
            self.statistics.reductions += 1;
        };
        let width = |j: usize| self.cell.hi[j] - self.cell.lo[j];
        let vanishing = |i: usize| layout.vanishes(&self.cell, &totals, i);
        let widest = (0..n).fold(0, |best, j| if width(j) > width(best) { j } else { best });
        let thin = |j: usize| width(j) < SQUEEZED * width(widest);
        let squeezed = !(0..n).all(vanishing)
            && (0..n).all(|i| !vanishing(i) || ((0..n).any(|j| thin(j) && layout.depends(i, j)) && !layout.nothing(i)));
        let cause = if (0..n).all(|j| width(j) <= self.options.smallest) {
            Some(Cause::Smallest)
        } else if (0..n).any(vanishing) && !squeezed {
            Some(Cause::Vanishing)
        } else if depth >= self.options.depth {
            Some(Cause::Depth)
        } else {
            None
        };
        if let Some(cause) = cause {
            return self.settle_or_leave(system, cause);
        }
        let axis = if (0..n).any(vanishing) {
            widest
        } else {
            self.direction(layout, depth, inverted.as_ref().map(|(k, _)| k))
        };
        let (lo, hi) = (self.cell.lo[axis], self.cell.hi[axis]);
        let at = lo + CUT * (hi - lo);
        if !(at > lo && at < hi) {
            return self.settle_or_leave(system, Cause::Smallest);
        }
        layout.split(&mut self.cell, &mut self.lower, axis, at);
        push(&mut self.stack, &self.cell, layout);
        push(&mut self.stack, &self.lower, layout);
        self.depths.push(depth + 1);
        self.depths.push(depth + 1);
        Fate::Split
    }

    /// Shrinks the cell to the window (in its sides) where that is worth it.
    fn reduce(&mut self, layout: &Layout, window: &mut [(f64, f64); MAX_UNKNOWNS]) -> bool {
        let n = layout.n;
        if !window[..n].iter().any(|w| w.1 - w.0 < WORTH) {
            return false;
        }
        let widest = (0..n).fold(0.0, |m: f64, j| {
            m.max((window[j].1 - window[j].0) * (self.cell.hi[j] - self.cell.lo[j]))
        });
        let mut worth = false;
        for j in 0..n {
            let (lo, hi) = (self.cell.lo[j], self.cell.hi[j]);
            let side = hi - lo;
            let least = SHRINK.max(THIN * widest / side).max(LEAST_SIDE / side).min(1.0);
            let (mut a, mut b) = window[j];
            // A tenth of slack on either side, and at least the least width.
            let middle = 0.5 * (a + b);
            let half = (0.55 * (b - a)).max(0.5 * least);
            (a, b) = (middle - half, middle + half);
            if a < 0.0 {
                (a, b) = (0.0, (b - a).min(1.0));
            } else if b > 1.0 {
                (a, b) = ((1.0 - (b - a)).max(0.0), 1.0);
            }
            if b - a > 0.9 {
                continue;
            }
            let new_lo = if a > 0.0 { (lo + a * side).max(lo) } else { lo };
            let new_hi = if b < 1.0 { (lo + b * side).min(hi) } else { hi };
            let smaller = new_lo < new_hi && (new_lo != lo || new_hi != hi);
            if !smaller {
                continue;
            }
            worth |= new_hi - new_lo < 0.85 * side;
            layout.restrict(&mut self.cell, j, new_lo, new_hi);
        }
        worth
    }

    /// The axis to split across.
    fn direction(&self, layout: &Layout, depth: u32, inverse: Option<&Square>) -> usize {
        let n = layout.n;
        let width = |j: usize| self.cell.hi[j] - self.cell.lo[j];
        let widest = (0..n).fold(0, |best, j| if width(j) > width(best) { j } else { best });
        if depth % 4 == 3 {
            return widest;
        }
        let slopes = layout.slopes(&self.cell);
        let mut weight = [0.0; MAX_UNKNOWNS];
        for j in 0..n {
            for k in 0..n {
                match inverse {
                    Some(inverse) => {
                        let radius = 0.5 * (slopes.hi[k][j] - slopes.lo[k][j]);
                        for i in 0..n {
                            weight[j] += inverse[i][k].abs() * radius;
                        }
                    }
                    None => {
                        let size = layout.size(&self.cell, k);
                        if size > 0.0 {
                            weight[j] += slopes.hi[k][j].abs().max(slopes.lo[k][j].abs()) / size;
                        }
                    }
                }
            }
            if !weight[j].is_finite() || width(j) <= self.options.smallest.max(THIN * width(widest)) {
                weight[j] = -1.0;
            }
        }
        let best = (0..n).fold(0, |best, j| if weight[j] > weight[best] { j } else { best });
        if weight[best] > 0.0 { best } else { widest }
    }

    /// Tries to prove that a box around the candidate holds exactly one root, and finds it.
    fn certify(&mut self, system: &System, centre: &Row, half: &Row) -> Verdict {
        let layout = &system.layout;
        let n = layout.n;
        self.statistics.attempts += 1;
        let cell = &self.cell;
        let trial = &mut self.trial;
        trial.c.clear();
        trial.c.extend_from_slice(&cell.c);
        (trial.lo, trial.hi, trial.noise, trial.scale) = (cell.lo, cell.hi, cell.noise, cell.scale);
        let limit = if system.bounded() { 0.0 } else { BEYOND };
        for j in 0..n {
            let side = cell.hi[j] - cell.lo[j];
            let reach = (1.5 * half[j]).max(LEAST);
            let middle = 0.5 + centre[j];
            let lo = (cell.lo[j] + (middle - reach) * side).max(-limit);
            let hi = (cell.lo[j] + (middle + reach) * side).min(1.0 + limit);
            let wide = hi - lo > 64.0 * EPSILON * lo.abs().max(hi.abs());
            if !wide {
                return Verdict::Unclear;
            }
            layout.restrict(trial, j, lo, hi);
        }
        match unique_root(layout, trial, &mut self.buffer) {
            Some(unique) => placed(system, cell, unique),
            None => Verdict::Unclear,
        }
    }

    /// The last resort for a cell that is about to stay open: a certificate on a larger box around it. Reductions may have made the
    /// cell so small that noise hides its slopes, though the root is simple.
    fn settle_or_leave(&mut self, system: &System, cause: Cause) -> Fate {
        let layout = &system.layout;
        let n = layout.n;
        let limit = if system.bounded() { 0.0 } else { BEYOND };
        let cell = &self.cell;
        let widest = (0..n).fold(0.0, |w: f64, j| w.max(cell.hi[j] - cell.lo[j]));
        let useful = cause != Cause::Depth && self.failures < WIDER_FAILURES;
        let mut reach = widest;
        for _ in 0..if useful { WIDER_TRIES } else { 0 } {
            reach *= WIDER;
            if reach > 0.5 {
                break;
            }
            let trial = &mut self.trial;
            trial.c.resize(layout.len, 0.0);
            for j in 0..n {
                trial.lo[j] = (cell.lo[j] - reach).max(-limit);
                trial.hi[j] = (cell.hi[j] + reach).min(1.0 + limit);
            }
            layout.refresh(trial, &mut self.doubles);
            self.statistics.refreshed += 1;
            self.statistics.attempts += 1;
            let Some(unique) = unique_root(layout, trial, &mut self.buffer) else {
                continue;
            };
            match placed(system, cell, unique) {
                Verdict::Root(found) => {
                    self.found.push(found);
                    return Fate::Certified;
                }
                Verdict::Elsewhere => return Fate::Elsewhere,
                Verdict::Unclear => {}
            }
        }
        self.failures += u32::from(useful);
        self.leave(cause);
        Fate::Unresolved
    }

    /// Drops roots that were found from several boxes: only one whose enclosure leaves its box can have been.
    fn identify(&mut self, n: usize) {
        let touches = |a: &Found, b: &Found| (0..n).all(|j| a.lo[j] <= b.hi[j] && b.lo[j] <= a.hi[j]);
        let mut kept: Vec<Found> = Vec::with_capacity(self.found.len());
        let mut straddling: Vec<usize> = Vec::new();
        for next in self.found.drain(..) {
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
            let one = inside(&next.lo, &next.hi, &first.unique_lo, &first.unique_hi, n)
                || inside(&first.lo, &first.hi, &next.unique_lo, &next.unique_hi, n);
            first.boundary |= next.boundary;
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

/// Where the only root of a box around the cell lies.
fn placed(system: &System, cell: &Cell, unique: Found) -> Verdict {
    let mut found = unique;
    for j in 0..system.layout.n {
        if unique.hi[j] < cell.lo[j] || unique.lo[j] > cell.hi[j] {
            return Verdict::Elsewhere;
        }
        found.straddles |= unique.lo[j] < cell.lo[j] || unique.hi[j] > cell.hi[j];
        found.boundary |= unique.lo[j] <= system.region.0[j] || unique.hi[j] >= system.region.1[j];
    }
    Verdict::Root(found)
}

pub(crate) fn open_box(system: &System, open: &Open) -> Unresolved {
    Unresolved {
        bounds: system.outward(&open.lo, &open.hi),
        cause: open.cause,
        boxes: open.boxes,
    }
}

fn inside(lo: &Row, hi: &Row, outer_lo: &Row, outer_hi: &Row, n: usize) -> bool {
    (0..n).all(|j| outer_lo[j] <= lo[j] && hi[j] <= outer_hi[j])
}

pub(crate) fn within_domain(cell: &Cell, n: usize) -> bool {
    (0..n).all(|j| cell.lo[j] >= 0.0 && cell.hi[j] <= 1.0)
}

pub(crate) fn excluded(totals: &(Row, Row), m: usize) -> bool {
    (0..m).any(|i| totals.0[i] > 0.0 || totals.1[i] < 0.0)
}

pub(crate) fn push(stack: &mut Vec<f64>, cell: &Cell, layout: &Layout) {
    let (n, m) = (layout.n, layout.rows());
    stack.extend_from_slice(&cell.lo[..n]);
    stack.extend_from_slice(&cell.hi[..n]);
    stack.extend_from_slice(&cell.noise[..m]);
    stack.extend_from_slice(&cell.scale[..m]);
    stack.extend_from_slice(&cell.c);
}

pub(crate) fn pop(stack: &mut Vec<f64>, cell: &mut Cell, layout: &Layout) {
    let (n, m) = (layout.n, layout.rows());
    let size = 2 * n + 2 * m + layout.len;
    let start = stack.len() - size;
    let record = &stack[start..];
    cell.lo[..n].copy_from_slice(&record[..n]);
    cell.hi[..n].copy_from_slice(&record[n..2 * n]);
    cell.noise[..m].copy_from_slice(&record[2 * n..2 * n + m]);
    cell.scale[..m].copy_from_slice(&record[2 * n + m..2 * n + 2 * m]);
    cell.c.clear();
    cell.c.extend_from_slice(&record[2 * n + 2 * m..]);
    stack.truncate(start);
}
