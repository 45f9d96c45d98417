//! The tests of one box, in the order of their cost, and its reduction or split.

use super::certify::{Found, newton_box, unique_root};
use super::drowned::{FAINT, Hidden};
use super::solver::PointSolver;
use crate::System;
use crate::coefficients::{Cell, Layout, excluded, push, within_domain};
use crate::numbers::{CUT, EPSILON, MAX_UNKNOWNS, Row, Square, inverse};
use crate::search::{Cause, Fate};

/// The largest half width `h` of `N`, in sides of the box, at which a certificate is tried: for a quadratic, `‖I − K J‖` is
/// about `8 h` on the box and `24 h²` on the box three times as wide as `N`. After a failure it must have shrunk by [`AGAIN`].
const TRY: f64 = 0.2;
const AGAIN: f64 = 0.6;
/// The smallest half width of the box `C`, relative to the sides of the box.
const LEAST: f64 = 1.0 / 16.0;
/// How far beyond the domain a certificate may reach, relative to its sides: the bounds of separated forms hold this far.
pub(crate) const BEYOND: f64 = 1.0 / 64.0;
/// A reduction to more than this fraction of each side is not worth its cost.
const WORTH: f64 = 0.75;
/// No side shrinks below this fraction in one reduction, nor below [`THIN`] times the widest.
const SHRINK: f64 = 1.0 / 64.0;
const THIN: f64 = 1e-8;
/// The smallest side, relative to those of the domain: a few units in the last place.
const LEAST_SIDE: f64 = 4e-15;
/// Preconditioned coefficients have helped if they narrow a window to this part of its width.
const HELPS: f64 = 0.8;
/// If noise exceeds this fraction of an equation's size, its coefficients are worth recomputing.
const NOISY: f64 = 1.5e-8;
/// Without a preconditioner, noise below this fraction of every equation's size does not count: it hides nothing that it would not hide a few splits on.
const NEGLIGIBLE: f64 = 1e-12;
/// If an equation vanishes up to noise because a side that it depends on is below this fraction of another side, the other is still split: the cell may
/// hold several simple roots.
const SQUEEZED: f64 = 1.0 / 64.0;
/// Before a cell stays open, certificates are tried on boxes this many times as wide, each this many times as wide as the previous one.
const WIDER: f64 = 16.0;
const WIDER_TRIES: u32 = 6;
/// After this many cells were tried in vain, the rest are not tried: there is a continuum of solutions.
const WIDER_FAILURES: u32 = 64;

#[expect(clippy::large_enum_variant, reason = "made once an attempt, and taken apart at once")]
enum Verdict {
    Root(Found),
    Elsewhere,
    Unclear,
}

impl PointSolver {
    /// Tests, reduces and, if need be, splits the current cell (pushing the parts).
    pub(super) fn treat(&mut self, system: &System, depth: u32) -> Fate {
        let layout = &system.layout;
        let n = layout.n;
        let mut threshold = TRY;
        let mut fresh = false;
        let mut inverted;
        let faint = loop {
            let mut totals = layout.ranges(&mut self.cell);
            if excluded(&totals, n) {
                return Fate::Sign;
            }
            if !fresh && layout.noisy(&self.cell, &totals, NOISY) && within_domain(&self.cell, n) {
                self.refresh(layout);
                fresh = true;
                totals = layout.ranges(&mut self.cell);
                if excluded(&totals, n) {
                    return Fate::Sign;
                }
            }
            let affine = layout.affine(&self.cell, layout.mean_slopes(&self.cell.c));
            inverted = inverse(&affine.slope, n);
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
            if let (Some((k, _)), Some(blend)) = (&inverted, &layout.blend)
                && self.blending.worthwhile()
            {
                let before = window;
                blend.project(layout, &self.cell, k, &mut self.buffer, &mut window);
                let narrower = |j: usize| window[j].1 - window[j].0 < HELPS * (before[j].1 - before[j].0);
                self.blending.record((0..n).any(narrower));
                if window[..n].iter().any(|w| w.0 > w.1) {
                    return Fate::Linear;
                }
            }
            layout.part_ranges(&self.cell, &mut self.ranges);
            for j in 0..n {
                layout.project(&self.cell, &self.ranges, &totals, j, &mut window[j]);
                if window[j].0 > window[j].1 {
                    return Fate::Projection;
                }
            }
            if self.reduce(layout, &mut window) {
                self.statistics.reductions += 1;
                fresh = false;
                if self.late() {
                    self.leave(Cause::Time);
                    return Fate::Unresolved;
                }
                continue;
            }
            // Before noise is blamed, it is made as small as it can be.
            let k = inverted.as_ref().map(|(k, _)| k);
            let faint = self.faint(layout, k);
            if faint && !fresh && layout.improvable(&self.cell) && within_domain(&self.cell, n) {
                self.refresh(layout);
                fresh = true;
                continue;
            }
            break faint;
        };
        let hidden = if faint {
            self.hidden(layout, SQUEEZED)
        } else {
            Hidden::Nothing
        };
        let k = inverted.as_ref().map(|(k, _)| k);
        let width = |j: usize| self.cell.hi[j] - self.cell.lo[j];
        let widest = (0..n).fold(0, |best, j| if width(j) > width(best) { j } else { best });
        let cause = if (0..n).all(|j| width(j) <= self.options.smallest) {
            Some(Cause::Smallest)
        } else if hidden == Hidden::Wide && (width(widest) <= self.coarsest) {
            Some(Cause::Vanishing)
        } else if depth >= self.options.depth {
            Some(Cause::Depth)
        } else {
            None
        };
        if let Some(cause) = cause {
            return self.settle_or_leave(system, cause);
        }
        let axis = if hidden == Hidden::Nothing {
            self.direction(layout, depth, k)
        } else {
            widest
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

    /// Recomputes the current cell's coefficients.
    fn refresh(&mut self, layout: &Layout) {
        layout.refresh(&mut self.cell, &mut self.doubles);
        self.statistics.refreshed += 1;
    }

    /// Whether noise may hide something: preconditioned by this matrix it is a part of a side; or there is no such matrix, and the noise is not
    /// negligible.
    fn faint(&self, layout: &Layout, k: Option<&Square>) -> bool {
        let n = layout.n;
        let mut errors = [0.0; MAX_UNKNOWNS];
        for (e, error) in errors[..n].iter_mut().enumerate() {
            *error = layout.value_error(&self.cell, e);
        }
        let Some(k) = k else {
            return (0..n).any(|e| errors[e] > NEGLIGIBLE * layout.size(&self.cell, e));
        };
        (0..n).any(|i| {
            let noise: f64 = (0..n).map(|e| k[i][e].abs() * errors[e]).sum();
            let clear = noise < FAINT;
            !clear
        })
    }

    /// Shrinks the cell to the window (relative to its sides) if that is worth the cost.
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
        (trial.lo, trial.hi) = (cell.lo, cell.hi);
        trial.noise.clone_from(&cell.noise);
        trial.scale.clone_from(&cell.scale);
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
        match unique_root(layout, trial, &mut self.buffer, &mut self.doubles) {
            Some(unique) => placed(system, cell, unique),
            None => Verdict::Unclear,
        }
    }

    /// The last resort for a cell that is about to stay open: a certificate on a larger box around it. Reductions may have made the
    /// cell so small that noise hides its slopes, even though the root is simple.
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
            if reach > 0.5 || self.late() {
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
            let Some(unique) = unique_root(layout, trial, &mut self.buffer, &mut self.doubles) else {
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
        let own = matches!(cause, Cause::Smallest | Cause::Vanishing);
        if own && layout.tape.is_some() && !layout.differentiable(&self.cell) {
            self.leave(Cause::NotDifferentiable);
        } else {
            self.leave(cause);
        }
        Fate::Unresolved
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
