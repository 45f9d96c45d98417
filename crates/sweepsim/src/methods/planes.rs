//! Algorithm 3: the envelope's section by a plane `x = const`, as curves, cut by the lines of that plane.
//!
//! [`CurveSolver`] gives the curves of Eq. 4 (patches) and Eq. 5 (edges; caps and kinks alike) with the right connectivity, as
//! polylines whose vertices lie on the curve. Each *span*, the curve between two vertices, lies in a known box: its chord's,
//! widened by the polyline's tolerance. Where the Jacobian of `(X, Y, g)` is regular on the box, `Y` is monotone along the span: a
//! line crosses it once, if it passes between the two ends, or never. Where it is not (about the extrema of `Y`), and a line may
//! cross, the span is halved at a point of the curve, and the boxes of the halves shrink around it by the mean value theorem.
//!
//! Signs of `Y − y` are taken once per vertex: along a closed curve, crossings of either direction are as many. Where curves or spans
//! cannot be decided (a patch that hardly moves along its normal, a plane through a singular point), the answer is none, and the patch is
//! left to the charts of the column's lines.

use crate::envelope::AnyBox;
use crate::methods::lattice::Lattice;
use nalgebra::{Const, DimMin, Matrix2, ToTypenum, Vector2};
use sweepsim_solve::{CurveSolver, Curves, Enclosure, Preimage, Sample, Sink, SolveOptions, System, SystemError};

/// Tolerances of the polylines, in parts of the parameters' ranges: the boxes of spans are this much wider than the chords'. The next
/// is tried where a span of the one before could not be decided.
const TOLERANCES: [f64; 3] = [0.03, 0.003, 0.0003];
/// Boxes of a section, and of each search on a face of one. Sections without trouble need some ten to a hundred.
const BOXES: u64 = 4_000;
/// Spans of a section, halves included. Sections without trouble need some hundred; where a curve almost touches itself there is no end to them.
const SPANS: u32 = 4_000;
/// Halvings of a span.
const DEPTH: u32 = 44;
/// Steps of Newton's method.
const STEPS: usize = 24;

/// Makes the curves of sections.
#[derive(Debug)]
pub(crate) struct Slicer {
    curves: CurveSolver,
    /// Spans looked at, regular ones, evaluations.
    pub boxes: u64,
    pub regular: u64,
    pub evaluations: u64,
}

impl Slicer {
    pub fn new() -> Self {
        let options = SolveOptions {
            smallest: 1e-10,
            boxes: BOXES,
            unresolved: 4,
            ..SolveOptions::default()
        };
        Self {
            curves: CurveSolver::with_options(TOLERANCES[0], options),
            boxes: 0,
            regular: 0,
            evaluations: 0,
        }
    }

    /// Finds the preimages of the lines of `lattice`, all with one `x`, by way of the curves of `system` (which is `X = x`, and `g = 0`
    /// where the map has it). `false`, and nothing found, where that does not decide it.
    pub fn solve<const N: usize, M>(
        &mut self,
        map: &mut M,
        system: Result<System, SystemError>,
        lattice: &Lattice,
        accept: f64,
        sink: &mut impl Sink<N, M::Seen>,
    ) -> bool
    where
        M: AnyBox<N>,
        Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
    {
        let Ok(system) = system else {
            return false;
        };
        let mark = sink.mark();
        for tolerance in TOLERANCES {
            self.curves.tolerance = tolerance;
            let Ok(curves) = self.curves.solve(&system, &()) else {
                return false;
            };
            if !curves.singular.is_empty() {
                return false;
            }
            if self.cut(map, &curves, tolerance, lattice, accept, sink) {
                return true;
            }
            sink.forget(mark);
        }
        false
    }

    /// Cuts the curves by the lines; `false` if some span stays undecided.
    fn cut<const N: usize, M>(
        &mut self,
        map: &mut M,
        Curves { curves, skin, .. }: &Curves,
        tolerance: f64,
        lattice: &Lattice,
        accept: f64,
        sink: &mut impl Sink<N, M::Seen>,
    ) -> bool
    where
        M: AnyBox<N>,
        Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
    {
        // With a skin, curves run on beyond the domain: at most this far.
        let region = Enclosure::new(-2.0 * skin, 1.0 + 2.0 * skin);
        let mut cutting = Cutting {
            map,
            lattice,
            x: lattice.coordinate(0, lattice.i[0]),
            accept,
            sink,
            slicer: self,
            left: SPANS,
        };
        for curve in curves {
            let count = curve.points.len();
            let mut from: Option<Vertex<N>> = None;
            let last = if curve.ends.is_none() { count + 1 } else { count };
            for k in 0..last {
                let point = &curve.points[k % count].point;
                let to = cutting.vertex(std::array::from_fn(|j| point[j]));
                if let Some(from) = from {
                    let within = std::array::from_fn(|j| {
                        let (lo, hi) = (from.x[j].min(to.x[j]), from.x[j].max(to.x[j]));
                        Enclosure::new((lo - tolerance).max(region.lo), (hi + tolerance).min(region.hi))
                    });
                    if !cutting.span(&from, &to, within, DEPTH) {
                        return false;
                    }
                }
                from = Some(to);
            }
        }
        true
    }
}

/// A point of a curve, and where along the plane it is.
#[derive(Clone, Copy, Debug)]
struct Vertex<const N: usize> {
    x: [f64; N],
    y: f64,
}

/// A crossing found, and its derivative with respect to `y`.
#[derive(Clone, Copy, Debug)]
struct Slope<const N: usize> {
    at: Vertex<N>,
    slope: [f64; N],
}

/// Where the next crossing should be, by the parabola with the slopes of the last two: the latest first.
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

/// The curves of one section being cut by the lines.
struct Cutting<'a, const N: usize, M: AnyBox<N>, K> {
    map: &'a mut M,
    lattice: &'a Lattice<'a>,
    x: f64,
    accept: f64,
    sink: &'a mut K,
    slicer: &'a mut Slicer,
    /// Spans that may still be looked at.
    left: u32,
}

/// What is seen of the equations without that of `Y`: row 0 is `X`, row 2 is `g`.
fn rows<const N: usize>() -> impl Iterator<Item = usize> {
    (0..N).filter(|r| *r != 1)
}

impl<const N: usize, M, K> Cutting<'_, N, M, K>
where
    M: AnyBox<N>,
    K: Sink<N, M::Seen>,
    Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
{
    fn evaluate(&mut self, x: &[f64; N]) -> Sample<N, M::Seen> {
        self.slicer.evaluations += 1;
        self.map.evaluate(x)
    }

    fn vertex(&mut self, x: [f64; N]) -> Vertex<N> {
        let y = self.evaluate(&x).value[1];
        Vertex { x, y }
    }

    /// Cuts the curve from `p` to `q`, which lies in the box `within`; `false` if that stays undecided.
    fn span(&mut self, p: &Vertex<N>, q: &Vertex<N>, within: [Enclosure; N], depth: u32) -> bool {
        self.slicer.boxes += 1;
        let Some(left) = self.left.checked_sub(1) else {
            return false;
        };
        self.left = left;
        let mark = self.map.mark();
        let cell = self.map.place(&within);
        // Where the map asks for nothing (an edge both of whose faces move in, …) no crossing counts.
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
            self.slicer.regular += 1;
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
            let target = self.lattice.grid.index(self.lattice.i[0], j);
            let part = ((y - from.y) / (q.y - from.y)).clamp(0.0, 1.0);
            let between = std::array::from_fn(|k| from.x[k] + part * (q.x[k] - from.x[k]));
            let guess = guess(&before, y).unwrap_or(between);
            let Some((found, slope)) = self.root(guess, (target, y), within) else {
                return false;
            };
            from = Vertex { x: found.x, y };
            before = [Some(Slope { at: from, slope }), before[0]];
            // Beyond the domain another patch, or another segment, has the curve.
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
        let mut x: [f64; N] = std::array::from_fn(|k| guess[k].clamp(within[k].lo, within[k].hi));
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
                let inside = (0..N).all(|k| next[k] >= within[k].lo - 1e-9 && next[k] <= within[k].hi + 1e-9);
                let found = Preimage {
                    target,
                    x: next,
                    from: x,
                    seen: sample.seen,
                    orientation: if determinant > 0.0 { 1 } else { -1 },
                };
                return inside.then(|| (found, std::array::from_fn(|k| inverse[(k, 1)])));
            }
            x = std::array::from_fn(|k| next[k].clamp(within[k].lo, within[k].hi));
        }
        None
    }

    /// A point of the curve between `p` and `q`, and boxes around the two halves.
    ///
    /// Some variable grows or falls all along the span: one without which the other equations' Jacobian is regular on the box.
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
        if !(length(over) > 1e-14) {
            return None;
        }
        let middle = self.on_curve(p, q, over, at, within)?;
        let parts = [p, q].map(|end| {
            let mut part = *within;
            part[over] = Enclosure::new(end.x[over].min(at), end.x[over].max(at));
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
                x[k] = (x[k] - step[n]).clamp(within[k].lo, within[k].hi);
            }
            let size = step.amax();
            if size <= 1e-15 || (size <= 1e-11 && size >= 0.25 * before) {
                return Some(self.vertex(x));
            }
            before = size;
        }
        None
    }

    /// A smaller box that holds all of the curve in `part`: by the mean value theorem around its middle, the other variables are
    /// affine functions of `over`, up to how much the Jacobian varies.
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
                    spread[j] += factor.abs() * side.radius() * (1.0 + 1e-12);
                }
            }
            for j in 0..N {
                let unit = if j == k { 1.0 } else { 0.0 };
                reach += ((row[j] - unit).abs() + spread[j] + 1e-14) * part[j].radius();
            }
            let (lo, hi) = (centre[k] + shift - reach - 1e-15, centre[k] + shift + reach + 1e-15);
            let cut = Enclosure::new(part[k].lo.max(lo), part[k].hi.min(hi));
            if cut.lo < cut.hi {
                smaller[k] = cut;
            }
        }
        smaller
    }
}

/// The Jacobian of `X` (and `g`) with respect to the variables other than `over`; with one variable, a unit row fills it up.
fn without<const N: usize>(jacobian: &[[f64; N]; N], over: usize) -> Matrix2<f64> {
    let mut matrix = Matrix2::identity();
    for (n, r) in rows::<N>().enumerate() {
        for (m, k) in (0..N).filter(|k| *k != over).enumerate() {
            matrix[(n, m)] = jacobian[r][k];
        }
    }
    matrix
}

/// Whether the Jacobian of `X` (and `g`) with respect to the variables other than `over` has one sign of its determinant.
fn minor_is_definite<const N: usize>(jacobian: &[[Enclosure; N]; N], over: usize) -> bool {
    let mut others = (0..N).filter(|k| *k != over);
    let (a, b) = (others.next(), others.next());
    let (lo, hi) = match (a, b) {
        (Some(a), Some(b)) => {
            let [p, q] = [jacobian[0][a], jacobian[0][b]];
            let [r, s] = [jacobian[2][a], jacobian[2][b]];
            let (first, second) = (product(p, s), product(q, r));
            (first.lo - second.hi, first.hi - second.lo)
        }
        (Some(a), None) => (jacobian[0][a].lo, jacobian[0][a].hi),
        _ => (0.0, 0.0),
    };
    let margin = 8.0 * f64::EPSILON * lo.abs().max(hi.abs());
    lo > margin || hi < -margin
}

fn product(a: Enclosure, b: Enclosure) -> Enclosure {
    let all = [a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi];
    Enclosure::new(
        all.iter().fold(f64::INFINITY, |m, x| m.min(*x)),
        all.iter().fold(f64::NEG_INFINITY, |m, x| m.max(*x)),
    )
}

/// Whether no matrix of the enclosure is singular: `‖I − K J‖∞ < 1`, `K` the inverse of its middle, in coordinates scaled to the box.
fn regular<const N: usize>(bounds: &[Enclosure; N], jacobian: &[[Enclosure; N]; N]) -> bool
where
    Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
{
    type Square<const N: usize> = nalgebra::SMatrix<f64, N, N>;
    let half = bounds.map(Enclosure::radius);
    let middle = Square::<N>::from_fn(|i, j| jacobian[i][j].mid() * half[j]);
    let radius = Square::<N>::from_fn(|i, j| jacobian[i][j].radius() * half[j]);
    let Some(inverse) = middle.try_inverse() else {
        return false;
    };
    let size = inverse.abs();
    let rest = (Square::<N>::identity() - inverse * middle).abs() + size * radius + size * middle.abs() * 1e-14;
    (0..N).all(|i| rest.row(i).sum() < 1.0)
}
