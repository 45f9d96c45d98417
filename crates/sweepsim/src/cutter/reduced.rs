//! Fields of high degree, replaced on each cell by forms of degree 2 with a bound of the difference.
//!
//! The normals of a bicubic patch have degree 5 and their moments 8, so that bounds over a box would cost nine times those of a ball end. On a small cell
//! both are nearly quadratic: with `h` the cell's side, they differ from the forms of degree 2 that agree with them at the Chebyshev nodes by `O(h³)`.
//!
//! With the error `ω` of the nodes, `ω(x) = Π (x − xₙ)`, interpolation in one variable leaves `|f − If| ≤ ‖ω‖/6 ‖f‴‖` and, by Shadrin's theorem (Error bounds
//! for Lagrange interpolation, J. Approx. Theory 80, 1995), `|(f − If)′| ≤ ‖ω′‖/6 ‖f‴‖`. In two variables, `f − I_u I_v f = (f − I_u f) + I_u (f − I_v f)`, where `I_u` makes a
//! function at most `Λ` times as large, and its derivative in `u` at most `Λ′/h`, but also at most `4/√3` times as large as that of the function itself: on a cell that is long in `v` and
//! narrow in `u`, as those at a pole are, `f_uvvv` says much more than `f_vvv`. The derivatives are bounded by the coefficients of the whole patch.

use crate::algebra::bivariate::MOST;
use crate::algebra::quad::Quad;
use crate::cutter::vanishing::{Bounds, Size, is_near_side, largest};
use crate::time::pieces::Sizes;
use sweepsim_spline::kernel::basis;

/// The degree of reduced fields.
const LOW: usize = 2;
/// Numbers of one form of degree `LOW`.
const ROWS: usize = LOW + 1;
/// The distance of the outer Chebyshev nodes from the middle of a side: `√3/4`.
const OUTER: f64 = 0.433_012_701_892_219_3;
/// `‖ω‖/6` and `‖ω′‖/6` on a side of length 1, with `ω = T₃(2x − 1)/32`.
const VALUE: f64 = 1.0 / 192.0;
const SLOPE: f64 = 3.0 / 32.0;
/// `Λ` and `Λ′` of the three nodes on such a side, at its ends.
const LEBESGUE: f64 = 5.0 / 3.0;
const LEBESGUE_OF_SLOPES: f64 = 32.0 / 3.0;
/// How many times as large as that of the function, at most, the derivative of the polynomial through its values at the three nodes is: `4/√3`. It is linear, and in the middle between
/// two nodes a difference quotient; these places are `√3/4` of the side apart, so that at its ends the sum of the absolute values of both weights is this.
const STRETCHED: f64 = 2.309_401_076_758_504;
/// Coefficients are combinations of values at the nodes with factors that add up to at most `11/3` in each variable, the square of which is less than this.
pub(super) const COMBINED: f64 = 13.5;

/// Bounds of what is missing from a cell's forms of `M` and `N`, and from their derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Missing {
    pub value: Sizes,
    pub slopes: [Sizes; 2],
    /// The same for `F_u` and `F_v`.
    pub tangents: Sizes,
}

/// How far a function with these third derivatives is from the form of degree 2 that agrees with it at the Chebyshev nodes of a cell with these sides.
pub(super) fn beyond(third: [f64; 2], widths: [f64; 2]) -> f64 {
    let rests = [0, 1].map(|axis| VALUE * third[axis] * widths[axis] * widths[axis] * widths[axis]);
    (rests[0] + LEBESGUE * rests[1]).min(rests[1] + LEBESGUE * rests[0])
}

/// The form of degree 2 with these values at the Chebyshev nodes: `values[j][i]` at the node `i` in `u` and `j` in `v`, and so are its coefficients.
pub(super) fn through(values: &[[Quad; 3]; 3]) -> [[Quad; 3]; 3] {
    let line = |of: [&Quad; 3]| -> [Quad; 3] {
        INVERSE_COLUMNS.map(|[p, q, r]| std::array::from_fn(|k| p * of[0][k] + q * of[1][k] + r * of[2][k]))
    };
    let [a, b, c] = values.each_ref().map(|[a, b, c]| line([a, b, c]));
    let [a, b, c] = [0, 1, 2].map(|i| line([&a[i], &b[i], &c[i]]));
    [0, 1, 2].map(|j| [a[j], b[j], c[j]])
}

/// The Chebyshev nodes of an interval.
pub(super) fn nodes(start: f64, width: f64) -> [f64; 3] {
    [0.5 - OUTER, 0.5, 0.5 + OUTER].map(|node| start + node * width)
}

/// `N` and `M` of a patch, to be reduced on any cell.
#[derive(Clone, Debug)]
pub(crate) struct Reduced {
    degrees: [usize; 2],
    /// Six tensors: `N`, `M`.
    forms: Vec<f64>,
    sizes: [Size; 6],
    /// Whether some of them lack less and less towards a side, as the components of normals do that vanish at a pole.
    pub vanishes: bool,
}

impl Reduced {
    /// For six tensors of these degrees, one after the other, if that lowers a degree.
    pub fn new(forms: &[f64], degrees: [usize; 2]) -> Option<Self> {
        let [p, q] = degrees;
        Self::lowers(degrees)?;
        let mut each = forms
            .chunks_exact((p + 1) * (q + 1))
            .map(|form| Size::new(form, degrees, COMBINED));
        let sizes: [Size; 6] = std::array::from_fn(|_| each.next().expect("six forms"));
        Some(Self {
            degrees,
            forms: forms.to_vec(),
            vanishes: sizes.iter().any(Size::vanishes),
            sizes,
        })
    }

    /// The degrees of reduced forms, if these are reduced.
    pub fn lowers(degrees: [usize; 2]) -> Option<[usize; 2]> {
        let [p, q] = degrees;
        (p.max(q) > LOW && p.max(q) < MOST).then(|| degrees.map(|degree| degree.min(LOW)))
    }

    /// The degrees of the reduced forms.
    pub fn low(&self) -> [usize; 2] {
        self.degrees.map(|degree| degree.min(LOW))
    }

    /// The six reduced tensors on a cell, into `out`, and what is missing.
    pub fn on(&self, lower: [f64; 2], upper: [f64; 2], out: &mut [f64]) -> Missing {
        let [p, q] = self.degrees;
        let [a, b] = self.low();
        let [in_u, in_v] = [0, 1].map(|axis| weights(self.degrees[axis], lower[axis], upper[axis]));
        let few = (a + 1) * (b + 1);
        let forms = self.forms.chunks_exact((p + 1) * (q + 1));
        for (form, out) in forms.zip(out.chunks_exact_mut(few)) {
            let mut sums = [[0.0; ROWS]; ROWS];
            for (line, in_v) in form.chunks_exact(p + 1).zip(&in_v) {
                let mut row = [0.0; ROWS];
                for (c, in_u) in line.iter().zip(&in_u) {
                    for i in 0..ROWS {
                        row[i] += in_u[i] * c;
                    }
                }
                for (sum, weight) in sums.iter_mut().zip(in_v) {
                    for i in 0..ROWS {
                        sum[i] += weight * row[i];
                    }
                }
            }
            for (line, sum) in out.chunks_exact_mut(a + 1).zip(&sums) {
                line.copy_from_slice(&sum[..=a]);
            }
        }
        self.missing((lower, upper), [[0.0; 3]; 2], out)
    }

    /// What is missing from reduced tensors on a cell, if the values at its nodes have these errors.
    ///
    /// If that is unknown, all of `out` becomes NaN.
    pub fn missing(&self, (lower, upper): ([f64; 2], [f64; 2]), errors: Sizes, out: &mut [f64]) -> Missing {
        let mut missing = Missing::default();
        let widths = [0, 1].map(|axis| upper[axis] - lower[axis]);
        let is_near = self.vanishes && is_near_side(lower, upper);
        for (number, size) in self.sizes.iter().enumerate() {
            let (vector, k) = (1 - number / 3, number % 3);
            let Bounds { rounding, third, mixed } = if is_near {
                size.on(lower, upper)
            } else {
                size.anywhere()
            };
            let rounding = rounding + COMBINED * errors[vector][k];
            let cubes = [0, 1].map(|axis| widths[axis] * widths[axis] * widths[axis]);
            missing.value[vector][k] = beyond(third, widths) + rounding;
            for axis in 0..2 {
                let (own, other) = (SLOPE * third[axis] * cubes[axis], 1 - axis);
                let across = (LEBESGUE_OF_SLOPES * third[other]).min(STRETCHED * mixed[other] * widths[axis]);
                let all = own + VALUE * cubes[other] * across + 4.0 * rounding;
                missing.slopes[axis][vector][k] = all / widths[axis];
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

/// For each coefficient of a form of this degree, its weights in the coefficients of the form of degree `LOW`, or its own if that is lower, that agrees with it at the Chebyshev nodes of an interval.
fn weights(degree: usize, start: f64, end: f64) -> [[f64; ROWS]; MOST] {
    let mut weights = [[0.0; ROWS]; MOST];
    let mut values = [0.0; MOST];
    let width = end - start;
    if degree < LOW {
        // At the ends, or anywhere: these are the coefficients.
        for i in 0..=degree {
            basis(degree, start + i as f64 * width, &mut values);
            for (weights, value) in weights.iter_mut().zip(values).take(degree + 1) {
                weights[i] = value;
            }
        }
        return weights;
    }
    // From the nearer side, so that all values have a small relative error.
    let is_mirrored = start > 0.5;
    let near = if is_mirrored { 1.0 - end } else { start };
    for (at, node) in nodes(near, width).into_iter().enumerate() {
        basis(degree, node, &mut values);
        let of_coefficients = INVERSE[if is_mirrored { 2 - at } else { at }];
        if is_mirrored {
            values[..=degree].reverse();
        }
        for (weights, value) in weights.iter_mut().zip(values).take(degree + 1) {
            for i in 0..ROWS {
                weights[i] += of_coefficients[i] * value;
            }
        }
    }
    weights
}

/// For each of the three nodes, the factors of a value there in the coefficients of the quadratic polynomial through all three.
const INVERSE: [[f64; ROWS]; 3] = {
    // Lagrange's polynomials at the ends; b₁ = 2 f(1/2) − (b₀ + b₂)/2.
    let (near, far) = (
        0.5 / (OUTER * 4.0 * OUTER) * (0.5 + OUTER),
        0.5 / (OUTER * 4.0 * OUTER) * (0.5 - OUTER),
    );
    let middle = 1.0 - 0.25 / (OUTER * OUTER);
    [
        [2.0 * near, -near - far, 2.0 * far],
        [middle, 2.0 - middle, middle],
        [2.0 * far, -near - far, 2.0 * near],
    ]
};

/// The same for each coefficient.
const INVERSE_COLUMNS: [[f64; 3]; ROWS] = {
    let [p, q, r] = INVERSE;
    [[p[0], q[0], r[0]], [p[1], q[1], r[1]], [p[2], q[2], r[2]]]
};

impl Missing {
    fn is_unknown(&self) -> bool {
        let all = self.slopes.as_flattened().as_flattened().iter();
        !all.chain(self.value.as_flattened()).all(|x| x.is_finite())
    }

    /// Whether the forms had better be reduced again: the bounds of derivatives must shrink with the cell, as the derivatives' own ranges do, since what
    /// remains of an error keeps boxes near singular points from ever becoming charts. `forms`: six tensors of the degrees `low`, on a cell with these sides.
    /// `each`: for each component, and not only for the largest of a vector.
    pub fn is_coarse(&self, forms: &[f64], low: [usize; 2], widths: [f64; 2], each: bool) -> bool {
        // Of the change of derivatives along the cell, and of the forms' size.
        const SHARE: f64 = 0.25;
        const LEAST: f64 = 2e-12;
        let row = low[0] + 1;
        let count = row * (low[1] + 1);
        [1, 0]
            .into_iter()
            .zip(forms.chunks_exact(3 * count))
            .any(|(vector, forms)| {
                let (mut spreads, mut size) = ([0.0_f64; 3], 0.0_f64);
                for (spread, form) in spreads.iter_mut().zip(forms.chunks_exact(count)) {
                    size = size.max(largest(form.iter().copied()));
                    let in_v = form[row..].iter().zip(form).map(|(next, this)| next - this);
                    let in_u = form
                        .chunks_exact(row)
                        .flat_map(|line| line.windows(2).map(|pair| pair[1] - pair[0]));
                    let own = low[0] as f64 * width(in_u);
                    *spread = own.max(low[1] as f64 * width(in_v));
                }
                if !each {
                    spreads = [largest(spreads.into_iter()); 3];
                }
                let allowed = spreads.map(|spread| SHARE * spread + LEAST * size);
                (0..2).any(|axis| (0..3).any(|k| self.slopes[axis][vector][k] * widths[axis] > allowed[k]))
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

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;
    use sweepsim_spline::Bernstein;

    fn degrees() -> impl Strategy<Value = [usize; 2]> {
        prop_oneof![Just([8, 8]), Just([11, 11]), Just([2, 7]), [1_usize..9, 3_usize..9]]
    }

    proptest! {
        /// On any cell, and on parts of it that inherit its bounds, the reduced forms and their derivatives differ from the original ones by no more than
        /// what is said to be missing; and that is an eighth on a cell of half the sides, but for rounding.
        #[test]
        fn reductions_are_within_their_bounds(
            degrees in degrees(), numbers in collection::vec(-3.0..3.0, 6 * 144), corner in [0.0..0.9, 0.0..0.9],
            width in [1e-3..0.1, 1e-3..0.1], whole in any::<bool>(), pole in prop::option::of((0_usize..2, any::<bool>(), 1.0..12.0_f64, any::<bool>())), at in collection::vec([0.0..=1.0, 0.0..=1.0], 12),
        ) {
            let count = (degrees[0] + 1) * (degrees[1] + 1);
            let mut forms = numbers[..6 * count].to_vec();
            let (mut lower, mut upper) = if whole { ([0.0; 2], [1.0; 2]) } else { (corner, [corner[0] + width[0], corner[1] + width[1]]) };
            // Forms that vanish on a side, on a cell as near to it as some distance.
            let mut scale = [1.0; 2];
            let mut mirrored = None;
            if let Some((axis, is_upper, digits, touches)) = pole {
                let row = degrees[0] + 1;
                for (k, c) in forms.iter_mut().enumerate() {
                    let index = [k % count % row, k % count / row][axis];
                    if index == if is_upper { degrees[axis] } else { 0 } {
                        *c = 0.0;
                    }
                }
                let far = 10_f64.powf(-digits);
                let near = if touches { 0.0 } else { 0.3 * far };
                (lower[axis], upper[axis]) = if is_upper { (1.0 - far, 1.0 - near) } else { (near, far) };
                scale[1 - axis] = (40.0 * far).min(1.0);
                mirrored = is_upper.then_some(axis);
            }
            let forms = &forms[..];
            let reduced = Reduced::new(forms, degrees).unwrap();
            let widths = [upper[0] - lower[0], upper[1] - lower[1]];
            let low = reduced.low();
            let few = (low[0] + 1) * (low[1] + 1);
            let mut out = vec![0.0; 6 * few];
            let missing = reduced.on(lower, upper, &mut out);
            let middle = [0, 1].map(|axis| 0.5 * (lower[axis] + upper[axis]));
            let half = reduced.on(lower, middle, &mut vec![0.0; 6 * few]);
            for k in 0..6 {
                // About the nearer side, where the original's roundings are small.
                let mut full = forms[k * count..][..count].to_vec();
                match mirrored {
                    Some(0) => full.chunks_exact_mut(degrees[0] + 1).for_each(<[f64]>::reverse),
                    Some(_) => {
                        full.reverse();
                        full.chunks_exact_mut(degrees[0] + 1).for_each(<[f64]>::reverse);
                    }
                    None => {}
                }
                let full = Bernstein::new(&degrees, full).unwrap();
                let own = Bernstein::new(&low, out[k * few..][..few].to_vec()).unwrap();
                let (vector, k) = (1 - k / 3, k % 3);
                for at in &at {
                    let place = [0, 1].map(|axis| match mirrored {
                        Some(own) if own == axis => (1.0 - upper[axis]) + (1.0 - at[axis]) * widths[axis],
                        _ => lower[axis] + at[axis] * widths[axis],
                    });
                    let off = (full.evaluate(&place) - own.evaluate(at)).abs();
                    let (lacking, small) = (missing.value[vector][k], scale[0].min(scale[1]));
                    prop_assert!(off <= lacking + 1e-12 * small, "{off} {lacking}");
                    // Nothing is left of it at a pole.
                    prop_assert!(lacking <= 1e5 * small, "{lacking} {small}");
                    for axis in 0..2 {
                        let sign = if mirrored == Some(axis) { -1.0 } else { 1.0 };
                        let slope = own.derivative(axis).evaluate(at) / widths[axis];
                        let off = (sign * full.derivative(axis).evaluate(&place) - slope).abs();
                        prop_assert!(off <= missing.slopes[axis][vector][k] + 1e-10 * scale[axis]);
                    }
                }
                let less = half.value[vector][k] - 0.125 * missing.value[vector][k];
                prop_assert!(less < 1e-10 && (pole.is_some() || less > -1e-10), "{less}");
            }
        }
    }

    /// `u³` differs from its reduction by just as much as is said to be missing, at an end of the cell.
    #[test]
    fn bounds_are_attained_by_cubic_functions() {
        let cube = Bernstein::new(&[3, 0], vec![0.0, 0.0, 0.0, 1.0]).unwrap();
        let forms: Vec<f64> = (0..6).flat_map(|_| cube.coefficients().to_vec()).collect();
        let reduced = Reduced::new(&forms, [3, 0]).unwrap();
        let mut out = vec![0.0; 6 * 3];
        let missing = reduced.on([0.3, 0.0], [0.7, 1.0], &mut out);
        for (value, slope) in missing
            .value
            .as_flattened()
            .iter()
            .zip(missing.slopes[0].as_flattened())
        {
            assert!((out[2] - 0.343).abs() > value * (1.0 - 1e-9) && (out[2] - 0.343).abs() <= *value);
            let off = (out[2] - out[1]) * 2.0 / 0.4 - 3.0 * 0.49;
            assert!(off.abs() > slope * (1.0 - 1e-9) && off.abs() <= *slope);
        }
    }

    #[test]
    fn numbers_that_are_not_finite_leave_nothing_known() {
        let mut forms = vec![1.0; 6 * 16];
        forms[17] = f64::INFINITY;
        let mut out = vec![0.0; 6 * 9];
        let reduced = Reduced::new(&forms, [3, 3]).unwrap();
        let missing = reduced.on([0.1, 0.2], [0.3, 0.4], &mut out);
        assert!(out.iter().all(|x| x.is_nan()));
        assert_eq!(missing.value, [[0.0; 3]; 2]);
        assert!(!missing.is_coarse(&out, [2; 2], [0.2; 2], true));
    }
}
