//! The crossings of one span of a section's curve with the lines of its plane.

use crate::envelope::AnyBox;
use crate::methods::lattice::Lattice;
use crate::methods::planes::jacobian::{minor_is_definite, regular, rows, without};
use nalgebra::{Const, DimMin, ToTypenum, Vector2};
use sweepsim_solve::{ChartStatistics, Enclosure, Monitor, Preimage, Sample, Sink};

/// The maximum number of halvings of a span.
pub(super) const DEPTH: u32 = 44;
/// The maximum number of Newton steps.
const STEPS: usize = 24;

// Limits in parameters of [0, 1]. They follow from rounding, not from the tolerance.

/// How far outside its box a crossing may be found. The box holds exactly one, so the limit only has to exceed what the last step of
/// Newton's method leaves: about the square of a step of at most 1e-5.
const BESIDE: f64 = 1e-9;
/// A span shorter than this is not halved: its middle would be within a few dozen roundings of its ends.
const SHORTEST: f64 = 1e-14;
/// Newton's method has converged when a step is this short: a few roundings of a parameter.
const CONVERGED: f64 = 1e-15;
/// Below this, a step that is not at least four times shorter than the one before is rounding.
const STALLED: f64 = 1e-11;
/// Rounding of a sum of `N` products of preconditioned entries near 1.
const SUMS: f64 = 1e-14;
/// Rounds the spread of a row upwards: its sums have fewer than a thousand roundings.
const OUTWARDS: f64 = 1.0 + 1e-12;

/// A point of a curve, and its position along the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex<const N: usize> {
    pub x: [f64; N],
    pub y: f64,
}

/// A crossing found, and its derivative with respect to `y`.
#[derive(Clone, Copy, Debug)]
struct Slope<const N: usize> {
    at: Vertex<N>,
    slope: [f64; N],
}

/// Predicts the next crossing from the parabola through the last two with their slopes, the latest first.
fn guess<const N: usize>(last: &[Option<Slope<N>>; 2], y: f64) -> Option<[f64; N]> {
    let latest = last[0]?;
    let step = y - latest.at.y;
    Some(std::array::from_fn(|k| {
        let bend = last[1].map_or(0.0, |before| {
            (latest.slope[k] - before.slope[k]) / (latest.at.y - before.at.y)
        });
        latest.at.x[k] + step * (latest.slope[k] + 0.5 * step * bend)
    }))
}

/// The curves of one section, as they are intersected with the lines.
pub(super) struct Cutting<'a, const N: usize, M: AnyBox<N>, K> {
    pub map: &'a mut M,
    pub lattice: &'a Lattice<'a>,
    pub monitor: &'a dyn Monitor,
    pub x: f64,
    pub accept: f64,
    pub sink: &'a mut K,
    pub statistics: &'a mut ChartStatistics,
    /// Spans that may still be examined.
    pub left: &'a mut u32,
}

impl<const N: usize, M, K> Cutting<'_, N, M, K>
where
    M: AnyBox<N>,
    K: Sink<N, M::Seen>,
    Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
{
    fn evaluate(&mut self, x: &[f64; N]) -> Sample<N, M::Seen> {
        self.statistics.evaluations += 1;
        self.map.evaluate(x)
    }

    pub fn vertex(&mut self, x: [f64; N]) -> Vertex<N> {
        let y = self.evaluate(&x).value[1];
        Vertex { x, y }
    }

    /// Intersects the curve from `p` to `q`, which lies in the box `within`, with the lines; `false` if that stays undecided.
    pub fn span(&mut self, p: &Vertex<N>, q: &Vertex<N>, within: [Enclosure; N], depth: u32) -> bool {
        self.statistics.boxes += 1;
        let Some(left) = self.left.checked_sub(1) else {
            return false;
        };
        *self.left = left;
        if self.monitor.cancelled() {
            return false;
        }
        let mark = self.map.mark();
        let cell = self.map.place(&within);
        // Where the map excludes the box (both faces of an edge move inwards, say) no crossing counts.
        let lines = self
            .map
            .values(&cell)
            .and_then(|values| self.lattice.numbers(1, values[1]));
        let Some((first, last)) = lines else {
            self.map.release(mark);
            return true;
        };
        let jacobian = self.map.jacobian(&cell);
        self.map.release(mark);
        if regular(&within, &jacobian) {
            self.statistics.charts += 1;
            return self.cross(p, q, &within, [first, last]);
        }
        let halves = (depth > 0).then(|| self.halves(p, q, &within, &jacobian)).flatten();
        halves.is_some_and(|(middle, parts)| {
            self.span(p, &middle, parts[0], depth - 1) && self.span(&middle, q, parts[1], depth - 1)
        })
    }

    /// The crossings of a span along which `Y` is monotone.
    fn cross(&mut self, p: &Vertex<N>, q: &Vertex<N>, within: &[Enclosure; N], [first, last]: [usize; 2]) -> bool {
        let mut from = *p;
        let mut before: [Option<Slope<N>>; 2] = [None; 2];
        let forward = p.y < q.y;
        for n in 0..=last - first {
            let j = if forward { first + n } else { last - n };
            let y = self.lattice.coordinate(1, j);
            if (p.y < y) == (q.y < y) {
                continue;
            }
            let Some(target) = self.lattice.grid.index(self.lattice.i[0], j) else {
                continue;
            };
            let part = ((y - from.y) / (q.y - from.y)).clamp(0.0, 1.0);
            let between = std::array::from_fn(|k| from.x[k] + part * (q.x[k] - from.x[k]));
            let guess = guess(&before, y).unwrap_or(between);
            let Some((found, slope)) = self.root(guess, (target, y), within) else {
                return false;
            };
            from = Vertex { x: found.x, y };
            before = [Some(Slope { at: from, slope }), before[0]];
            // Beyond the domain, the curve belongs to another patch or segment.
            if found.x.iter().all(|x| (0.0..=1.0).contains(x)) {
                self.sink.found(found);
            }
        }
        true
    }

    /// The point of the span where `Y = y`, by Newton's method, and how it moves with `y`.
    fn root(
        &mut self,
        guess: [f64; N],
        (target, y): (usize, f64),
        within: &[Enclosure; N],
    ) -> Option<(Preimage<N, M::Seen>, [f64; N])> {
        let mut x: [f64; N] = std::array::from_fn(|k| guess[k].clamp(within[k].lo(), within[k].hi()));
        for _ in 0..STEPS {
            let sample = self.evaluate(&x);
            let wanted = [self.x, y, 0.0];
            let rest = nalgebra::SVector::<f64, N>::from_fn(|i, _| sample.value[i] - wanted[i]);
            let matrix = nalgebra::SMatrix::<f64, N, N>::from_fn(|i, k| sample.jacobian[i][k]);
            let determinant = matrix.determinant();
            let inverse = matrix.try_inverse()?;
            let step = inverse * rest;
            let next: [f64; N] = std::array::from_fn(|k| x[k] - step[k]);
            if !next.iter().all(|x| x.is_finite()) {
                return None;
            }
            if step.amax() <= self.accept {
                // The box holds one point of the span with this Y: if Newton's method found it, it is in the box.
                let inside = (0..N).all(|k| next[k] >= within[k].lo() - BESIDE && next[k] <= within[k].hi() + BESIDE);
                let found = Preimage {
                    target,
                    x: next,
                    from: x,
                    seen: sample.seen,
                    orientation: if determinant > 0.0 { 1 } else { -1 },
                };
                return inside.then(|| (found, std::array::from_fn(|k| inverse[(k, 1)])));
            }
            x = std::array::from_fn(|k| next[k].clamp(within[k].lo(), within[k].hi()));
        }
        None
    }

    /// A point of the curve between `p` and `q`, and boxes around the two halves.
    ///
    /// Some variable is monotone along the span: one for which the Jacobian of the other equations without its column is regular on the box.
    fn halves(
        &mut self,
        p: &Vertex<N>,
        q: &Vertex<N>,
        within: &[Enclosure; N],
        jacobian: &[[Enclosure; N]; N],
    ) -> Option<(Vertex<N>, [[Enclosure; N]; 2])> {
        let length = |k: usize| (q.x[k] - p.x[k]).abs();
        let over = (0..N)
            .filter(|k| minor_is_definite(jacobian, *k))
            .max_by(|a, b| length(*a).total_cmp(&length(*b)))?;
        let at = 0.5 * (p.x[over] + q.x[over]);
        if !(length(over) > SHORTEST) {
            return None;
        }
        let middle = self.on_curve(p, q, over, at, within)?;
        let parts = [p, q].map(|end| {
            let mut part = *within;
            part[over] = Enclosure::hull(end.x[over].min(at), end.x[over].max(at));
            part
        });
        let parts = parts.map(|part| self.shrunk(part, over));
        Some((middle, parts))
    }

    /// The point of the curve where the variable `over` is `at`.
    fn on_curve(
        &mut self,
        p: &Vertex<N>,
        q: &Vertex<N>,
        over: usize,
        at: f64,
        within: &[Enclosure; N],
    ) -> Option<Vertex<N>> {
        let mut x: [f64; N] = std::array::from_fn(|k| 0.5 * (p.x[k] + q.x[k]));
        x[over] = at;
        let mut before = f64::INFINITY;
        for _ in 0..STEPS {
            let sample = self.evaluate(&x);
            let target = [self.x, 0.0, 0.0];
            let mut rest = Vector2::zeros();
            for (n, r) in rows::<N>().enumerate() {
                rest[n] = sample.value[r] - target[r];
            }
            let step = without(&sample.jacobian, over).try_inverse()? * rest;
            if !(step.x.is_finite() && step.y.is_finite()) {
                return None;
            }
            for (k, n) in (0..N).filter(|k| *k != over).zip(0..) {
                x[k] = (x[k] - step[n]).clamp(within[k].lo(), within[k].hi());
            }
            let size = step.amax();
            if size <= CONVERGED || (size <= STALLED && size >= 0.25 * before) {
                return Some(self.vertex(x));
            }
            before = size;
        }
        None
    }

    /// A smaller box that holds all of the curve in `part`: by the mean value theorem about its middle, the other variables are
    /// affine functions of `over`, up to the variation of the Jacobian.
    fn shrunk(&mut self, part: [Enclosure; N], over: usize) -> [Enclosure; N] {
        let mark = self.map.mark();
        let cell = self.map.place(&part);
        let jacobian = self.map.jacobian(&cell);
        self.map.release(mark);
        let centre: [f64; N] = std::array::from_fn(|k| part[k].mid());
        let sample = self.evaluate(&centre);
        let Some(inverse) = without(&sample.jacobian, over).try_inverse() else {
            return part;
        };
        let target = [self.x, 0.0, 0.0];
        let rounding = self.map.rounding();
        let others: smallvec::SmallVec<[usize; 3]> = (0..N).filter(|k| *k != over).collect();
        let mut smaller = part;
        for (n, &k) in others.iter().enumerate() {
            let (mut shift, mut reach) = (0.0, 0.0);
            let mut row = [0.0; N];
            let mut spread = [0.0; N];
            for (m, r) in rows::<N>().enumerate() {
                let factor = inverse[(n, m)];
                shift -= factor * (sample.value[r] - target[r]);
                reach += factor.abs() * rounding[r];
                for (j, side) in jacobian[r].iter().enumerate() {
                    row[j] += factor * side.mid();
                    spread[j] += factor.abs() * side.radius() * OUTWARDS;
                }
            }
            for j in 0..N {
                let unit = if j == k { 1.0 } else { 0.0 };
                reach += ((row[j] - unit).abs() + spread[j] + SUMS) * part[j].radius();
            }
            let (lo, hi) = (
                centre[k] + shift - reach - CONVERGED,
                centre[k] + shift + reach + CONVERGED,
            );
            if let Some(cut) = part[k].intersection(Enclosure::hull(lo, hi))
                && cut.lo() < cut.hi()
            {
                smaller[k] = cut;
            }
        }
        smaller
    }
}
