//! Systems of splines: one Bernstein system per polynomial piece, solved separately, with roots on the planes between pieces counted once.
//!
//! Pieces meet where knots are: a spline may have kinks there, and solvers need derivatives. Near such a plane, each piece's polynomial has its
//! own root, which may or may not lie where that polynomial is valid. So these roots are judged together, over a box `H` around their
//! enclosures: with `J` the hull of all touching pieces' Jacobians over `H` and `K ≈ J⁻¹`, if `‖I − K J‖∞ < 1` then `x ↦ x − K f(x)` contracts on `H`
//! whichever pieces a segment crosses (for a continuous `f`, the mean of Jacobians along it lies in the hull); if it maps `H` into
//! itself, `H` holds exactly one root of the spline. Whatever this cannot settle stays open.

use super::treat::BEYOND;
use super::{PointSolver, Points, Root, RootLocation};
use crate::numbers::{MAX_UNKNOWNS, Row, Square, ZERO, inverse};
use crate::search::{Cause, SolveError, UnresolvedBox};
use crate::{Enclosure, Monitor, Pieces, System};

/// Roots next to planes between pieces are judged over boxes of at least this fraction of the domain.
const NEAR: f64 = 1e-9;

impl PointSolver {
    /// All roots of a system of splines. [`RootLocation::Boundary`] means the boundary of the whole domain.
    ///
    /// # Errors
    ///
    /// As [`solve`](Self::solve).
    pub fn solve_pieces(&mut self, pieces: &Pieces, monitor: &dyn Monitor) -> Result<Points, SolveError> {
        for system in &pieces.systems {
            self.check(system)?;
        }
        // The time is for all pieces together.
        self.start_clock();
        let mut points = Points::default();
        // Roots that may lie on planes between pieces.
        let mut between: Vec<Root> = Vec::new();
        for (number, system) in pieces.systems.iter().enumerate() {
            monitor.advance(number, pieces.systems.len());
            let found = self.solve_in_time(system, monitor);
            points.unresolved.extend(found.unresolved);
            points.statistics.merge(&found.statistics);
            for mut root in found.roots {
                if root.location == RootLocation::Inside {
                    points.roots.push(root);
                    continue;
                }
                let ends = root.enclosure.iter().zip(&pieces.domain);
                let outer = ends.clone().any(|(e, d)| e.lo() <= d.lo() || e.hi() >= d.hi());
                let knots = root.enclosure.iter().zip(system.domain()).zip(&pieces.domain);
                let inner = knots
                    .into_iter()
                    .any(|((e, s), d)| (e.lo() <= s.lo() && s.lo() > d.lo()) || (e.hi() >= s.hi() && s.hi() < d.hi()));
                root.location = if outer {
                    RootLocation::Boundary
                } else {
                    RootLocation::Inside
                };
                if inner {
                    between.push(root);
                } else {
                    points.roots.push(root);
                }
            }
        }
        while let Some(first) = between.pop() {
            let mut hull = first.enclosure.clone();
            let mut place = first.location;
            let mut count = 1;
            loop {
                let around = inflated(&hull, &pieces.domain);
                let meets = |r: &Root| {
                    r.enclosure
                        .iter()
                        .zip(&around)
                        .all(|(a, b)| a.lo() <= b.hi() && b.lo() <= a.hi())
                };
                let next = match between.iter().position(meets) {
                    Some(k) => between.remove(k),
                    None => match points.roots.iter().position(meets) {
                        Some(k) => points.roots.remove(k),
                        None => break,
                    },
                };
                for (h, e) in hull.iter_mut().zip(&next.enclosure) {
                    *h = Enclosure::hull(h.lo().min(e.lo()), h.hi().max(e.hi()));
                }
                if next.location == RootLocation::Boundary {
                    place = RootLocation::Boundary;
                }
                count += 1;
            }
            let around = inflated(&hull, &pieces.domain);
            let touched: Vec<&System> = pieces.systems.iter().filter(|s| touches(s, &around)).collect();
            match one_root(&touched, &around) {
                Some((point, enclosure)) => points.roots.push(Root {
                    point,
                    enclosure,
                    unique_in: around,
                    orientation: first.orientation,
                    location: place,
                }),
                None => points
                    .unresolved
                    .push(UnresolvedBox::new(around, Cause::Smallest, count)),
            }
        }
        points.roots.sort_by(|a, b| {
            let order = a.point.iter().zip(&b.point).map(|(x, y)| x.total_cmp(y));
            order
                .into_iter()
                .find(|o| o.is_ne())
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        Ok(points)
    }
}

fn touches(system: &System, hull: &[Enclosure]) -> bool {
    system
        .domain()
        .iter()
        .zip(hull)
        .all(|(s, h)| s.lo() <= h.hi() && h.lo() <= s.hi())
}

/// A box several times as wide, and wide enough for meaningful slopes.
fn inflated(hull: &[Enclosure], domain: &[Enclosure]) -> Vec<Enclosure> {
    let wider = |(h, d): (&Enclosure, &Enclosure)| {
        let pad = 16.0 * h.radius() + NEAR * (d.hi() - d.lo());
        Enclosure::hull(h.lo() - pad, h.hi() + pad)
    };
    hull.iter().zip(domain).map(wider).collect()
}

/// Proves that the piecewise map has exactly one root in the box, and encloses it.
fn one_root(systems: &[&System], bounds: &[Enclosure]) -> Option<(Vec<f64>, Vec<Enclosure>)> {
    let n = bounds.len();
    let (mut lo, mut hi) = (ZERO, ZERO);
    let middle: Vec<f64> = bounds.iter().map(|b| b.mid()).collect();
    // The values of every piece at the centre; for a continuous spline, they differ by no more than its slopes allow.
    let (mut least, mut most) = ([f64::INFINITY; MAX_UNKNOWNS], [f64::NEG_INFINITY; MAX_UNKNOWNS]);
    for (number, system) in systems.iter().enumerate() {
        let (l, h) = system.jacobian_over(bounds)?;
        let (value, error) = system.value_at(&middle);
        for i in 0..n {
            for j in 0..n {
                if number == 0 {
                    (lo[i][j], hi[i][j]) = (l[i][j], h[i][j]);
                } else {
                    lo[i][j] = lo[i][j].min(l[i][j]);
                    hi[i][j] = hi[i][j].max(h[i][j]);
                }
            }
            least[i] = least[i].min(value[i] - error[i]);
            most[i] = most[i].max(value[i] + error[i]);
        }
    }
    let mut mean = ZERO;
    for i in 0..n {
        let mut reach = 0.0;
        for j in 0..n {
            mean[i][j] = 0.5 * (lo[i][j] + hi[i][j]);
            reach += lo[i][j].abs().max(hi[i][j].abs());
        }
        let continuous = most[i] - least[i] <= reach;
        if !continuous {
            return None;
        }
    }
    let (k, _) = inverse(&mean, n)?;
    let (mut contraction, mut largest) = (0.0f64, 0.0f64);
    let mut shift = [0.0; MAX_UNKNOWNS];
    let mut offset = [0.0; MAX_UNKNOWNS];
    for i in 0..n {
        let mut row = 0.0;
        for j in 0..n {
            let (mut product, mut radius, mut size) = (if i == j { -1.0 } else { 0.0 }, 0.0, 1.0);
            for e in 0..n {
                product += k[i][e] * mean[e][j];
                radius += k[i][e].abs() * 0.5 * (hi[e][j] - lo[e][j]);
                size += k[i][e].abs() * mean[e][j].abs();
            }
            row += f64::abs(product) + radius + 32.0 * f64::EPSILON * size;
        }
        contraction = contraction.max(row);
        let mut error = 0.0;
        for e in 0..n {
            offset[i] -= k[i][e] * 0.5 * (least[e] + most[e]);
            error +=
                k[i][e].abs() * (0.5 * (most[e] - least[e]) + 8.0 * f64::EPSILON * least[e].abs().max(most[e].abs()));
        }
        shift[i] = f64::abs(offset[i]) + error;
        largest = largest.max(shift[i]);
    }
    // In sides of the box, from its middle: the map takes the box into itself, contracting.
    if !(contraction < 0.999 && largest + 0.5 * contraction < 0.5) {
        return None;
    }
    let reach = largest / (1.0 - contraction);
    let width = |j: usize| bounds[j].hi() - bounds[j].lo();
    let point = (0..n).map(|j| middle[j] + offset[j] * width(j)).collect();
    let side = |j: usize| {
        let pad = reach * width(j) * (1.0 + 8.0 * f64::EPSILON) + 4.0 * f64::EPSILON * middle[j].abs();
        Enclosure::hull(middle[j] - pad, middle[j] + pad)
    };
    Some((point, (0..n).map(side).collect()))
}

impl System {
    /// The equations' values at a point of the domain or next to it, as they were given, with error bounds.
    fn value_at(&self, point: &[f64]) -> (Row, Row) {
        let mut cell = self.layout.root();
        self.layout.ranges(&mut cell);
        let mut s = [0.0; MAX_UNKNOWNS];
        let mut rounding = 0.0;
        for (j, (x, d)) in point.iter().zip(self.domain()).enumerate() {
            s[j] = (x - d.lo()) / (d.hi() - d.lo());
            rounding += 4.0 * f64::EPSILON * (1.0 + d.magnitude() / (d.hi() - d.lo()));
        }
        let (mut value, jacobian) = self.layout.evaluate(&cell.c, &s, &mut Vec::new());
        let mut error = [0.0; MAX_UNKNOWNS];
        for e in 0..self.equations() {
            let slope = jacobian[e].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            error[e] = 2.0 * (self.layout.value_error(&cell, e) + slope * rounding) / self.layout.factor[e];
            value[e] /= self.layout.factor[e];
        }
        (value, error)
    }

    /// Enclosures of the derivatives over a box, with respect to coordinates in which the box is `[0,1]ⁿ`.
    fn jacobian_over(&self, bounds: &[Enclosure]) -> Option<(Square, Square)> {
        let n = self.variables();
        let mut cell = self.layout.root();
        let mut widths: Row = [1.0; MAX_UNKNOWNS];
        for (j, (b, d)) in bounds.iter().zip(self.domain()).enumerate() {
            let width = d.hi() - d.lo();
            // A box of at least a few roundings, so that restriction to it is possible.
            let pad = 64.0 * f64::EPSILON * (1.0 + (b.lo().abs().max(b.hi().abs())) / width);
            let (lo, hi) = ((b.lo() - d.lo()) / width - pad, (b.hi() - d.lo()) / width + pad);
            if !(lo > -BEYOND && hi < 1.0 + BEYOND && lo < hi) {
                return None;
            }
            self.layout.restrict(&mut cell, j, lo, hi);
            widths[j] = (hi - lo) * width;
        }
        self.layout.ranges(&mut cell);
        let slopes = self.layout.slopes(&cell);
        let (mut lo, mut hi) = (ZERO, ZERO);
        for e in 0..self.equations() {
            for j in 0..n {
                // Per unit of the variable, times the box's side.
                let side = (bounds[j].hi() - bounds[j].lo()).max(f64::MIN_POSITIVE);
                let factor = side / widths[j] / self.layout.factor[e];
                let (a, b) = (slopes.lo[e][j] * factor, slopes.hi[e][j] * factor);
                let pad = 8.0 * f64::EPSILON * a.abs().max(b.abs());
                (lo[e][j], hi[e][j]) = (a - pad, b + pad);
            }
        }
        Some((lo, hi))
    }
}
