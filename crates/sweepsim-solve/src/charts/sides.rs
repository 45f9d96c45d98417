//! Two functions of which exactly one must be negative where a preimage is of interest.
//!
//! The tool at rest between two motions bounds the sweep only where `g` changes its sign, in a thin lune between two curves. A chart may hold hundreds
//! of lines, and a few of them in the lune: bounds of both functions, linear in position, rule out the others without an evaluation.

use super::linear::Linear;
use super::region::Region;
use crate::Enclosure;
use nalgebra::SVector;

/// A function over a box, in coordinates `s ∈ [−1, 1]^N` scaled to it: within `error` of `value + ⟨slope, s⟩`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine<const N: usize> {
    /// The value at the centre.
    pub value: f64,
    /// The change from the centre to each face.
    pub slope: [f64; N],
    /// The largest difference. Not a number: nothing is known.
    pub error: f64,
}

/// Relative rounding of a value of an [`Affine`], generously.
const ROUNDING: f64 = 1e-13;

impl<const N: usize> Affine<N> {
    /// The best for a form with these coefficients, `rows` of equal length: along the first variable in each row, along the last one from row to
    /// row. `error`: of the coefficients.
    #[must_use]
    pub fn of_form(coefficients: &[f64], length: usize, error: f64) -> Self {
        let mut affine = Self {
            value: 0.0,
            slope: [0.0; N],
            error: f64::NAN,
        };
        let rows = coefficients.len() / length.max(1);
        if N != 2 || rows == 0 {
            return affine;
        }
        let at = |i: usize, j: usize| coefficients[j * length + i];
        let (last, top) = (length - 1, rows - 1);
        let corners = [at(0, 0), at(last, 0), at(0, top), at(last, top)];
        affine.slope[0] = 0.25 * (corners[1] - corners[0] + corners[3] - corners[2]);
        affine.slope[1] = 0.25 * (corners[2] - corners[0] + corners[3] - corners[1]);
        // Coefficients of a linear function are its values at evenly spaced places.
        let place = |k: usize, most: usize| {
            if most == 0 {
                0.0
            } else {
                2.0 * k as f64 / most as f64 - 1.0
            }
        };
        let (mut lo, mut hi, mut size) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
        for j in 0..rows {
            for i in 0..length {
                let c = at(i, j);
                let rest = c - affine.slope[0] * place(i, last) - affine.slope[1] * place(j, top);
                if rest.is_nan() {
                    return affine;
                }
                (lo, hi, size) = (lo.min(rest), hi.max(rest), size.max(c.abs()));
            }
        }
        affine.value = 0.5 * (lo + hi);
        affine.error = 0.5 * (hi - lo) + error + ROUNDING * size;
        affine
    }

    /// The sign over the box from `lo` to `hi`, if it has only one: `true` is negative. 0 is not.
    #[must_use]
    #[inline]
    pub fn is_negative(&self, lo: &[f64; N], hi: &[f64; N]) -> Option<bool> {
        let (mut value, mut reach, mut size) = (self.value, self.error, self.value.abs());
        for (i, slope) in self.slope.iter().enumerate() {
            let (lo, hi) = (lo[i], hi[i]);
            value += slope * 0.5 * (lo + hi);
            reach += slope.abs() * 0.5 * (hi - lo);
            size += slope.abs() * lo.abs().max(hi.abs());
        }
        reach += ROUNDING * size;
        if value < -reach {
            Some(true)
        } else if value > reach {
            Some(false)
        } else {
            None
        }
    }
}

/// Where exactly one of two functions may be negative.
pub(crate) struct Sides<const N: usize>(pub [Affine<N>; 2]);

impl<const N: usize> Sides<N> {
    /// Whether both functions have the same sign everywhere in the region.
    #[inline]
    pub fn agree(&self, region: &Region<N>) -> bool {
        let (lo, hi) = (region.lo.into(), region.hi.into());
        let [a, b] = self.0.each_ref().map(|side| side.is_negative(&lo, &hi));
        a.is_some() && a == b
    }

    /// The range of second values for which targets that agree with `q` otherwise can have a preimage in the box where the signs differ, predicted from
    /// the centre.
    pub fn window(&self, linear: &Linear<N>, value: &[f64; N], q: &[f64; N]) -> Option<Enclosure> {
        if N < 2 {
            return Some(Enclosure::WHOLE);
        }
        // A preimage is at `start + step (q₁ − Φ₁)`, give or take `reach`.
        let mut level = *q;
        level[1] = value[1];
        let start = linear.predict(&SVector::zeros(), value, &level);
        let [may_be_negative, may_be_other] = {
            let ends = |sign: f64| {
                self.0.each_ref().map(|side| {
                    let (mut rest, mut factor, mut error, mut size) = (side.value, 0.0, side.error, side.value.abs());
                    for (i, slope) in side.slope.iter().enumerate() {
                        rest += slope * start[i];
                        factor += slope * linear.inverse[(i, 1)];
                        error += slope.abs() * linear.reach(i);
                        size += slope.abs() * (1.0 + start[i].abs());
                    }
                    let limit = error + ROUNDING * size;
                    if limit.is_nan() {
                        return Some((f64::NEG_INFINITY, f64::INFINITY));
                    }
                    below(sign * factor, limit - sign * rest)
                })
            };
            [ends(1.0), ends(-1.0)]
        };
        let both = |a: Option<(f64, f64)>, b: Option<(f64, f64)>| {
            let ((a, b), (c, d)) = (a?, b?);
            let (lo, hi) = (a.max(c), b.min(d));
            (lo <= hi).then_some((lo, hi))
        };
        let ranges = [
            both(may_be_negative[0], may_be_other[1]),
            both(may_be_other[0], may_be_negative[1]),
        ];
        let (lo, hi) = match ranges {
            [None, None] => return None,
            [Some(own), None] | [None, Some(own)] => own,
            [Some((a, b)), Some((c, d))] => (a.min(c), b.max(d)),
        };
        Some(Enclosure::hull(value[1] + lo, value[1] + hi))
    }
}

/// The range of `x` with `factor · x ≤ limit`, a little wider.
fn below(factor: f64, limit: f64) -> Option<(f64, f64)> {
    let end = limit / factor;
    if !end.is_finite() {
        return (factor != 0.0 || limit >= 0.0).then_some((f64::NEG_INFINITY, f64::INFINITY));
    }
    let margin = ROUNDING * end.abs();
    if factor > 0.0 {
        Some((f64::NEG_INFINITY, end + margin))
    } else {
        Some((end - margin, f64::INFINITY))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ChartMap, ChartOptions, ChartSolver, ChartTarget, Preimage, Sample, Sink, Targets, UnresolvedTarget};
    use sweepsim_props::*;
    use sweepsim_spline::Bernstein;

    proptest! {
        #[test]
        fn functions_are_within_their_errors(
            degrees in [0_usize..4, 0_usize..4], numbers in collection::vec(-3.0..3.0, 16), at in [0.0..=1.0, 0.0..=1.0],
        ) {
            let count = (degrees[0] + 1) * (degrees[1] + 1);
            let form = Bernstein::new(&degrees, numbers[..count].to_vec()).unwrap();
            let affine = Affine::<2>::of_form(form.coefficients(), degrees[0] + 1, 0.0);
            let value = affine.value + affine.slope[0] * (2.0 * at[0] - 1.0) + affine.slope[1] * (2.0 * at[1] - 1.0);
            let exact = form.evaluate(&at);
            prop_assert!((exact - value).abs() <= affine.error + 1e-13);
            for width in [0.0, 0.1, 1.0] {
                let [lo, hi] = [-width, width].map(|reach| at.map(|x| (2.0 * x - 1.0 + reach).clamp(-1.0, 1.0)));
                if let Some(is_negative) = affine.is_negative(&lo, &hi) {
                    prop_assert_eq!(exact < 0.0, is_negative, "{}", exact);
                }
            }
            // Bilinear forms differ from linear ones by their twist alone.
            if degrees == [1, 1] {
                let twist = 0.25 * (numbers[0] - numbers[1] - numbers[2] + numbers[3]).abs();
                prop_assert!(affine.error <= twist + 1e-12);
            }
        }
    }

    /// `(x + a y² + b, y + c x²)` on `[−1, 1]²`, and two linear functions.
    struct Bent {
        curvature: [f64; 2],
        lines: [[f64; 3]; 2],
        sided: bool,
    }

    impl Bent {
        fn value(&self, [x, y]: [f64; 2]) -> [f64; 2] {
            [x + self.curvature[0] * y * y, y + self.curvature[1] * x * x]
        }

        fn is_between(&self, [x, y]: [f64; 2]) -> bool {
            let [a, b] = self.lines.map(|[a, b, c]| a + b * x + c * y < 0.0);
            a != b
        }
    }

    impl ChartMap<2> for Bent {
        type Cell = [Enclosure; 2];
        type Seen = ();

        fn bounds(&self, cell: &Self::Cell) -> [Enclosure; 2] {
            *cell
        }

        fn values(&mut self, _: &Self::Cell) -> Option<[Enclosure; 2]> {
            Some([Enclosure::hull(-3.0, 3.0); 2])
        }

        fn jacobian(&mut self, cell: &Self::Cell) -> [[Enclosure; 2]; 2] {
            let [x, y] = cell;
            let one = Enclosure::hull(1.0, 1.0);
            let slope = |c: f64, x: &Enclosure| Enclosure::hull(2.0 * c * x.lo(), 2.0 * c * x.hi());
            [[one, slope(self.curvature[0], y)], [slope(self.curvature[1], x), one]]
        }

        fn split(&mut self, cell: &Self::Cell, axis: usize) -> [Self::Cell; 2] {
            let (lo, hi, mid) = (cell[axis].lo(), cell[axis].hi(), cell[axis].mid());
            let (mut lower, mut upper) = (*cell, *cell);
            lower[axis] = Enclosure::hull(lo, mid);
            upper[axis] = Enclosure::hull(mid, hi);
            [lower, upper]
        }

        fn sides(&self, cell: &Self::Cell) -> Option<[Affine<2>; 2]> {
            let [x, y] = cell;
            self.sided.then(|| {
                self.lines.map(|[a, b, c]| Affine {
                    value: a + b * x.mid() + c * y.mid(),
                    slope: [b * x.radius(), c * y.radius()],
                    error: 1e-14,
                })
            })
        }

        fn evaluate(&self, x: &[f64; 2]) -> Sample<2, ()> {
            let [a, c] = self.curvature;
            Sample {
                value: self.value(*x),
                jacobian: [[1.0, 2.0 * a * x[1]], [2.0 * c * x[0], 1.0]],
                seen: (),
            }
        }

        fn scales(&self) -> [f64; 2] {
            [0.1; 2]
        }

        fn rounding(&self) -> [f64; 2] {
            [1e-14; 2]
        }
    }

    /// Values `0.1 (i, j) + 0.037`, from −2 to 2.
    struct Square;

    impl Targets<2> for Square {
        fn count(&self, _: &[Enclosure; 2]) -> usize {
            41 * 41
        }

        fn visit(
            &self,
            range: &[Enclosure; 2],
            narrow: &dyn Fn(&[f64; 2]) -> Option<Enclosure>,
            visit: &mut dyn FnMut(&ChartTarget<2>) -> bool,
        ) {
            let at = |k: usize| 0.1 * (k as f64 - 20.0) + 0.037;
            for i in 0..41 {
                let Some(window) = narrow(&[at(i), at(0)]).and_then(|window| window.intersection(range[1])) else {
                    continue;
                };
                for j in (0..41).filter(|j| window.contains(at(*j))) {
                    let target = ChartTarget {
                        number: 41 * i + j,
                        place: [i, j],
                        value: [at(i), at(j)],
                    };
                    if !visit(&target) {
                        return;
                    }
                }
            }
        }
    }

    impl Sink<2> for Vec<(usize, [f64; 2])> {
        fn found(&mut self, preimage: Preimage<2>) {
            self.push((preimage.target, preimage.x));
        }

        fn mark(&self) -> usize {
            self.len()
        }

        fn forget(&mut self, mark: usize) {
            self.truncate(mark);
        }

        fn forget_targets(&mut self, _: usize, targets: &[usize]) {
            unreachable!("{targets:?}");
        }

        fn unresolved(&mut self, target: UnresolvedTarget<2>) {
            unreachable!("{target:?}");
        }
    }

    /// What lies between the sides, in order, and the number of evaluations.
    fn solve(map: &mut Bent, sided: bool) -> (Vec<(usize, [f64; 2])>, u64) {
        map.sided = sided;
        let root = [Enclosure::hull(-1.0, 1.0); 2];
        let mut solver = ChartSolver::new(ChartOptions::default());
        let mut found = Vec::new();
        solver.solve(map, root, &Square, &mut found, &());
        found.retain(|(_, x)| map.is_between(*x));
        found.sort_by_key(|(target, _)| *target);
        (found, solver.statistics.evaluations)
    }

    proptest! {
        /// A search that leaves out what has the same sign on both sides finds everything else.
        #[test]
        fn nothing_between_the_sides_is_missed(
            curvature in [-0.45..0.45, -0.45..0.45],
            lines in [[-1.0..1.0, -1.0..1.0, -1.0..1.0], [-1.0..1.0, -1.0..1.0, -1.0..1.0]],
            constant in any::<bool>(),
        ) {
            let mut map = Bent { curvature, lines, sided: false };
            if constant {
                map.lines[0] = [1.0, 0.0, 0.0];
            }
            let (all, kept) = (solve(&mut map, false).0, solve(&mut map, true).0);
            prop_assert_eq!(all.len(), kept.len());
            for ((target, x), (other, y)) in all.iter().zip(&kept) {
                prop_assert!(target == other && (0..2).all(|k| (x[k] - y[k]).abs() < 1e-9));
            }
        }
    }

    #[test]
    fn a_thin_lune_takes_few_evaluations() {
        let mut map = Bent {
            curvature: [0.1, -0.05],
            lines: [[0.3, 1.0, 0.02], [0.31, 1.0, -0.02]],
            sided: false,
        };
        let ((all, plain), (kept, sided)) = (solve(&mut map, false), solve(&mut map, true));
        assert!(
            !all.is_empty() && all.len() == kept.len() && 4 * sided < plain,
            "{plain} {sided}"
        );
    }
}
