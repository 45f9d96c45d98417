//! Fields of high degree, replaced on each cell by forms of degree 2 with a bound of the difference.
//!
//! The normals of a bicubic patch have degree 5 and their moments 8, so that bounds over a box would cost nine times those of a ball end. On a small cell
//! both are nearly quadratic: with `h` the cell's side, they differ from the forms of degree 2 that agree with them at the Chebyshev nodes by `O(h³)`. The
//! difference is a form of the original degree, whose coefficients bound it, and the differences of neighbouring coefficients its derivatives.

use crate::time::pieces::Sizes;
use sweepsim_spline::kernel::{basis, restrict_rectangle};

/// The degree of reduced fields.
const LOW: usize = 2;
/// Numbers of one form of degree `LOW`.
const ROWS: usize = LOW + 1;
/// Sums of three products with weights that add up to 1, twice, are accurate to within this part of the largest number.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Bounds of what is missing from a cell's forms of `M` and `N`, and from their derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Missing {
    pub value: Sizes,
    pub slopes: [Sizes; 2],
}

/// `N` and `M` of a patch, to be reduced on any cell.
#[derive(Clone, Debug)]
pub(crate) struct Reduced {
    degrees: [usize; 2],
    /// Six tensors: `N`, `M`.
    forms: Vec<f64>,
    axes: [Axis; 2],
}

/// The projection to lower degree along one variable.
#[derive(Clone, Debug)]
struct Axis {
    low: usize,
    /// For each coefficient of the low degree, the weights of the original ones.
    down: Vec<f64>,
    /// For each original coefficient, the weights of those of the low degree.
    up: Vec<f64>,
}

impl Axis {
    fn new(degree: usize) -> Self {
        let low = degree.min(LOW);
        let unit = |i: usize, k: usize| if i == k { 1.0 } else { 0.0 };
        if degree <= LOW {
            let same: Vec<f64> = (0..=low).flat_map(|i| (0..=low).map(move |k| unit(i, k))).collect();
            return Self {
                low,
                down: same.clone(),
                up: same,
            };
        }
        // Values at the Chebyshev nodes; the middle coefficient follows from them.
        let ends = 0.25 * 3.0_f64.sqrt();
        let nodes = [0.5 - ends, 0.5, 0.5 + ends];
        let values = nodes.map(|x| {
            let mut values = vec![0.0; degree + 1];
            basis(degree, x, &mut values);
            values
        });
        // The inverse of the matrix of quadratic polynomials at the nodes.
        let quadratic = nodes.map(|x| [(1.0 - x) * (1.0 - x), 2.0 * x * (1.0 - x), x * x]);
        let matrix = nalgebra::Matrix3::from_fn(|i, k| quadratic[i][k]);
        let inverse = matrix.try_inverse().unwrap_or_else(nalgebra::Matrix3::zeros);
        let down = (0..ROWS).flat_map(|i| {
            let values = &values;
            (0..=degree).map(move |k| (0..ROWS).map(|n| inverse[(i, n)] * values[n][k]).sum())
        });
        // Raising the degree: the blossom of `B_k` at i ones among `degree` numbers, by counting pairs.
        let n = degree as f64;
        let up = (0..=degree).flat_map(|i| {
            let i = i as f64;
            let pairs = n * (n - 1.0);
            let weights = [(n - i) * (n - i - 1.0), 2.0 * i * (n - i), i * (i - 1.0)];
            weights.map(|w| w / pairs)
        });
        Self {
            low,
            down: down.collect(),
            up: up.collect(),
        }
    }

    fn down(&self, i: usize) -> &[f64] {
        let len = self.down.len() / (self.low + 1);
        &self.down[i * len..][..len]
    }

    fn up(&self, i: usize) -> &[f64] {
        &self.up[i * (self.low + 1)..][..=self.low]
    }
}

impl Reduced {
    /// For six tensors of these degrees, one after the other, if that lowers a degree.
    pub fn new(forms: &[f64], degrees: [usize; 2]) -> Option<Self> {
        (degrees[0].max(degrees[1]) > LOW).then(|| Self {
            degrees,
            forms: forms.to_vec(),
            axes: degrees.map(Axis::new),
        })
    }

    /// The degrees of the reduced forms.
    pub fn low(&self) -> [usize; 2] {
        self.degrees.map(|degree| degree.min(LOW))
    }

    /// The six reduced tensors on a cell, into `out`, and what is missing. `space`: memory.
    pub fn on(&self, lower: [f64; 2], upper: [f64; 2], out: &mut [f64], space: &mut Vec<f64>) -> Missing {
        let [p, q] = self.degrees;
        let [a, b] = self.low();
        let (count, few) = ((p + 1) * (q + 1), (a + 1) * (b + 1));
        let half = (a + 1) * (q + 1);
        space.clear();
        space.resize(6 * count + count + half, 0.0);
        let (own, rest) = space.split_at_mut(6 * count);
        let (difference, rows) = rest.split_at_mut(count);
        if lower == [0.0; 2] && upper == [1.0; 2] {
            own.copy_from_slice(&self.forms);
        } else {
            restrict_rectangle(&self.forms, self.degrees, lower, upper, own);
        }
        let mut missing = Missing::default();
        let [in_u, in_v] = &self.axes;
        for (form, (own, out)) in own.chunks_exact(count).zip(out.chunks_exact_mut(few)).enumerate() {
            // Of each row of `own`, then of each column.
            for (line, row) in own.chunks_exact(p + 1).zip(rows.chunks_exact_mut(a + 1)) {
                for (i, x) in row.iter_mut().enumerate() {
                    *x = dot(in_u.down(i), line);
                }
            }
            out.fill(0.0);
            for (j, line) in out.chunks_exact_mut(a + 1).enumerate() {
                for (weight, row) in in_v.down(j).iter().zip(rows.chunks_exact(a + 1)) {
                    for (x, value) in line.iter_mut().zip(row) {
                        *x += weight * value;
                    }
                }
            }
            for (j, row) in rows.chunks_exact_mut(a + 1).enumerate() {
                row.fill(0.0);
                for (weight, line) in in_v.up(j).iter().zip(out.chunks_exact(a + 1)) {
                    for (x, value) in row.iter_mut().zip(line) {
                        *x += weight * value;
                    }
                }
            }
            let (lines, differences) = (own.chunks_exact(p + 1), difference.chunks_exact_mut(p + 1));
            for ((row, line), difference) in rows.chunks_exact(a + 1).zip(lines).zip(differences) {
                for (i, (x, value)) in difference.iter_mut().zip(line).enumerate() {
                    *x = value - dot(in_u.up(i), row);
                }
            }
            let rounding = ROUNDING * largest(out.iter().copied());
            let (vector, k) = (1 - form / 3, form % 3);
            missing.value[vector][k] = largest(difference.iter().copied()) + rounding;
            for axis in 0..2 {
                let along = if axis == 0 {
                    let steps = difference.chunks_exact(p + 1);
                    largest(steps.flat_map(|line| line.windows(2).map(|pair| pair[1] - pair[0])))
                } else {
                    largest(
                        difference[p + 1..]
                            .iter()
                            .zip(&*difference)
                            .map(|(next, this)| next - this),
                    )
                };
                let factor = self.degrees[axis] as f64 / (upper[axis] - lower[axis]);
                missing.slopes[axis][vector][k] = factor * (along + 2.0 * rounding);
            }
        }
        if missing.is_unknown() {
            // Then the range of the forms is that of all numbers, and needs no more.
            out.fill(f64::NAN);
            return Missing::default();
        }
        missing
    }
}

impl Missing {
    fn is_unknown(&self) -> bool {
        let all = self.slopes.as_flattened().as_flattened().iter();
        !all.chain(self.value.as_flattened()).all(|x| x.is_finite())
    }

    /// Whether the forms had better be reduced again: the bounds of derivatives must shrink with the cell, as the derivatives' own ranges do, since what
    /// remains of an error keeps boxes near singular points from ever becoming charts. `forms`: six tensors of the degrees `low`, on a cell with these sides.
    pub fn is_coarse(&self, forms: &[f64], low: [usize; 2], widths: [f64; 2]) -> bool {
        // Of the change of derivatives along the cell, and of the forms' size.
        const SHARE: f64 = 0.25;
        const LEAST: f64 = 1e-13;
        let row = low[0] + 1;
        let count = row * (low[1] + 1);
        [1, 0]
            .into_iter()
            .zip(forms.chunks_exact(3 * count))
            .any(|(vector, forms)| {
                let (mut spread, mut size) = (0.0_f64, 0.0_f64);
                for form in forms.chunks_exact(count) {
                    size = size.max(largest(form.iter().copied()));
                    let in_v = form[row..].iter().zip(form).map(|(next, this)| next - this);
                    let in_u = form
                        .chunks_exact(row)
                        .flat_map(|line| line.windows(2).map(|pair| pair[1] - pair[0]));
                    let own = low[0] as f64 * width(in_u);
                    spread = spread.max(own.max(low[1] as f64 * width(in_v)));
                }
                let allowed = SHARE * spread + LEAST * size;
                (0..2).any(|axis| self.slopes[axis][vector].iter().any(|e| e * widths[axis] > allowed))
            })
    }
}

/// The largest number less the smallest; 0 for none.
fn width(values: impl Iterator<Item = f64>) -> f64 {
    let (lo, hi) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| {
        (if x < lo { x } else { lo }, if x > hi { x } else { hi })
    });
    if hi > lo { hi - lo } else { 0.0 }
}

#[inline]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b)
}

/// The largest absolute value; NaN if one of them is.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    // NaN is larger than any number in this order, and stays.
    values.fold(0.0, |most: f64, x| {
        if most.is_nan() || x.abs() <= most {
            most
        } else {
            x.abs()
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use sweepsim_spline::Bernstein;

    fn degrees() -> impl Strategy<Value = [usize; 2]> {
        prop_oneof![Just([8, 8]), Just([11, 11]), Just([2, 7]), [1_usize..9, 3_usize..9]]
    }

    proptest! {
        /// On any cell, and on parts of it that inherit its bounds, the reduced forms and their derivatives differ from the original ones by no more than
        /// what is said to be missing; and that is not much more than the difference.
        #[test]
        fn reductions_are_within_their_bounds(
            degrees in degrees(), numbers in proptest::collection::vec(-3.0..3.0, 6 * 144), corner in [0.0..0.9, 0.0..0.9],
            width in [1e-3..0.1, 1e-3..0.1], whole in any::<bool>(), at in proptest::collection::vec([0.0..=1.0, 0.0..=1.0], 12),
        ) {
            let count = (degrees[0] + 1) * (degrees[1] + 1);
            let forms = &numbers[..6 * count];
            let reduced = Reduced::new(forms, degrees).unwrap();
            let (lower, upper) = if whole { ([0.0; 2], [1.0; 2]) } else { (corner, [corner[0] + width[0], corner[1] + width[1]]) };
            let widths = [upper[0] - lower[0], upper[1] - lower[1]];
            let low = reduced.low();
            let few = (low[0] + 1) * (low[1] + 1);
            let mut out = vec![0.0; 6 * few];
            let missing = reduced.on(lower, upper, &mut out, &mut Vec::new());
            for k in 0..6 {
                let full = Bernstein::new(&degrees, forms[k * count..][..count].to_vec()).unwrap();
                let own = Bernstein::new(&low, out[k * few..][..few].to_vec()).unwrap();
                let (vector, k) = (1 - k / 3, k % 3);
                let mut most = 0.0_f64;
                for at in &at {
                    let place = [0, 1].map(|axis| lower[axis] + at[axis] * widths[axis]);
                    let off = (full.evaluate(&place) - own.evaluate(at)).abs();
                    prop_assert!(off <= missing.value[vector][k] + 1e-12, "{off} {}", missing.value[vector][k]);
                    most = most.max(off);
                    for axis in 0..2 {
                        let slope = own.derivative(axis).evaluate(at) / widths[axis];
                        let off = (full.derivative(axis).evaluate(&place) - slope).abs();
                        prop_assert!(off <= missing.slopes[axis][vector][k] + 1e-10);
                    }
                }
                // On a small cell the difference is nearly cubic. The points may all lie where it is small.
                prop_assert!(whole || missing.value[vector][k] <= 1e3 * most + 1e-11 || most < 1e-6);
            }
        }
    }

    #[test]
    fn numbers_that_are_not_finite_leave_nothing_known() {
        let mut forms = vec![1.0; 6 * 16];
        forms[17] = f64::INFINITY;
        let mut out = vec![0.0; 6 * 9];
        let reduced = Reduced::new(&forms, [3, 3]).unwrap();
        let missing = reduced.on([0.1, 0.2], [0.3, 0.4], &mut out, &mut Vec::new());
        assert!(out.iter().all(|x| x.is_nan()));
        assert_eq!(missing.value, [[0.0; 3]; 2]);
        assert!(!missing.is_coarse(&out, [2; 2], [0.2; 2]));
    }
}
