//! A system's equations in powers of `z`, in which a cell is `[−1, 1]ⁿ`, as functions on the polydisc `abs(zⱼ) ≤ 1` of complex numbers.
//!
//! On that polydisc a form with coefficients of at most `e` over the cell is at most `e √2^d`, `d` the sum of its degrees, since `abs(1 + z) + abs(1 − z) ≤ 2 √2`; a form
//! over the domain, `e (1 + 2 ρ)^d` within `ρ` of it.

use super::series::{Powers, Series};
use crate::coefficients::Layout;
use crate::numbers::{Double, MAX_UNKNOWNS, Row, Square, ZERO, double};
use smallvec::SmallVec;

/// Up to this degree in a variable, the factors between both bases are whole numbers below `2⁵³` over a power of two.
const HIGHEST: usize = 26;
/// The error of recomputed coefficients of size 2, for each step: as in [`Layout::refresh`].
const STEP: f64 = f64::from_bits((1023 - 94) << 52);

/// One part of an equation.
#[derive(Debug)]
struct EquationPart {
    equation: usize,
    /// Variables and degrees, the fastest first.
    axes: SmallVec<[(usize, usize); 4]>,
    c: Vec<Double>,
}

/// The equations over a cell.
#[derive(Debug)]
pub(super) struct Expansion {
    n: usize,
    parts: Vec<EquationPart>,
    /// Bounds, on the polydisc, of how far the powers' sums are from each equation, and their derivatives from its derivatives.
    pub value_error: Row,
    pub slope_error: Row,
}

impl Expansion {
    /// Over a cell whose centre lies in the domain, in coordinates in which that is `[0,1]ⁿ`; `None` for degrees that are too high, or once it is `late`.
    pub(super) fn new(
        layout: &Layout,
        lo: &Row,
        hi: &Row,
        buffer: &mut Vec<Double>,
        late: &dyn Fn() -> bool,
    ) -> Option<Self> {
        let n = layout.n;
        let mut expansion = Self {
            n,
            parts: Vec::with_capacity(layout.parts.len()),
            value_error: [0.0; MAX_UNKNOWNS],
            slope_error: [0.0; MAX_UNKNOWNS],
        };
        let (mut radius, mut growth): (f64, f64) = (0.0, 1.0);
        for j in 0..n {
            radius = radius.max(0.5 * (hi[j] - lo[j]));
            growth = growth.max((1.0 + 2.0 * (-lo[j]).max(0.0)) * (1.0 + 2.0 * (hi[j] - 1.0).max(0.0)));
        }
        let degrees = layout.degrees as i32;
        let growth = growth.powi(degrees);
        let nearby = (1.0 + 2.0 * radius).powi(degrees) * (1.0 + 1e-9);
        for part in &layout.parts {
            if part.axes.iter().any(|a| a.degree > HIGHEST) || late() {
                return None;
            }
            layout.originals(part, buffer);
            let mut steps = 4;
            for axis in &part.axes {
                double::restrict(buffer, axis.degree, axis.inner, lo[axis.variable], hi[axis.variable]);
                steps += axis.degree + 1;
            }
            let largest = buffer.iter().fold(0.0, |m: f64, x| m.max(x.hi.abs()));
            for axis in &part.axes {
                to_powers(buffer, axis.degree, axis.inner);
            }
            let sum: usize = part.axes.iter().map(|a| a.degree).sum();
            let e = part.equation;
            let arithmetic =
                STEP * steps as f64 * (growth * 2f64.sqrt().powi(sum as i32) + largest * 2f64.powi(sum as i32));
            expansion.value_error[e] += arithmetic * (1.0 + 1e-9);
            expansion.parts.push(EquationPart {
                equation: e,
                axes: part.axes.iter().map(|a| (a.variable, a.degree)).collect(),
                c: buffer.clone(),
            });
        }
        for e in 0..layout.m {
            // The arithmetic's error is a polynomial on the polydisc, too.
            expansion.slope_error[e] = f64::from(degrees) * expansion.value_error[e]
                + radius * nearby * (2.0 * f64::from(degrees) * layout.first_noise[e] + layout.slope_remainder[e]);
            expansion.value_error[e] += nearby * (layout.first_noise[e] + layout.remainder[e]);
        }
        Some(expansion)
    }

    /// The equations' derivatives at the centre.
    pub(super) fn slopes(&self) -> Square {
        let mut slopes = ZERO;
        for part in &self.parts {
            let mut inner = 1;
            for (variable, degree) in &part.axes {
                slopes[part.equation][*variable] += part.c[inner].hi;
                inner *= degree + 1;
            }
        }
        slopes
    }

    /// Bounds of how far the derivatives are from those at the centre, where each `abs(zⱼ)` is at most `reach[j] ≤ 1`.
    pub(super) fn variation(&self, reach: &Row) -> Square {
        let mut variation = ZERO;
        for part in &self.parts {
            let mut index: SmallVec<[usize; 8]> = SmallVec::from_elem(0, part.axes.len());
            for c in &part.c {
                if index.iter().sum::<usize>() >= 2 {
                    let factors = part.axes.iter().zip(&index);
                    let size = factors.fold(c.hi.abs(), |s, ((v, _), i)| s * reach[*v].powi(*i as i32));
                    for ((variable, _), i) in part.axes.iter().zip(&index) {
                        if *i > 0 {
                            variation[part.equation][*variable] += *i as f64 * size / reach[*variable];
                        }
                    }
                }
                for (i, (_, degree)) in index.iter_mut().zip(&part.axes) {
                    *i += 1;
                    if *i <= *degree {
                        break;
                    }
                    *i = 0;
                }
            }
        }
        for (row, error) in variation.iter_mut().zip(&self.slope_error) {
            for x in &mut row[..self.n] {
                *x = *x * (1.0 + 1e-9) + error;
            }
        }
        variation
    }

    /// How many products of series a composition takes.
    pub(super) fn cost(&self) -> usize {
        self.parts.iter().map(|p| p.c.len()).sum()
    }

    /// The equations along `z = curve(t)`, without their value errors; `None` once it is `late`.
    pub(super) fn compose(&self, powers: &Powers, curve: &[Series], late: &dyn Fn() -> bool) -> Option<Vec<Series>> {
        let mut equations = vec![Series::zero(powers); self.n];
        // Powers of each coordinate, as far as any part needs them.
        let mut raised: Vec<Vec<Series>> = Vec::with_capacity(self.n);
        for (variable, coordinate) in curve.iter().enumerate() {
            let own = |p: &EquationPart| p.axes.iter().find(|a| a.0 == variable).map_or(0, |a| a.1);
            let top = self.parts.iter().map(own).max().unwrap_or(0);
            let mut list = vec![Series::constant(powers, Double::new(1.0))];
            for k in 0..top {
                let mut next = Series::zero(powers);
                next.add_product(powers, &list[k], coordinate);
                list.push(next);
            }
            raised.push(list);
        }
        for part in &self.parts {
            if late() {
                return None;
            }
            let Some(((variable, _), others)) = part.axes.split_last() else {
                equations[part.equation].add_multiple(&raised[0][0], part.c[0]);
                continue;
            };
            // The slowest axis first: its slabs are numbers, those of the next ones series.
            let mut inner: usize = others.iter().map(|(_, d)| d + 1).product();
            let mut sums = vec![Series::zero(powers); inner];
            for (slab, power) in part.c.chunks_exact(inner).zip(&raised[*variable]) {
                for (sum, c) in sums.iter_mut().zip(slab) {
                    if c.hi != 0.0 {
                        sum.add_multiple(power, *c);
                    }
                }
            }
            for (variable, degree) in others.iter().rev() {
                inner /= degree + 1;
                let mut next = vec![Series::zero(powers); inner];
                for (slab, power) in sums.chunks_exact(inner).zip(&raised[*variable]) {
                    for (sum, c) in next.iter_mut().zip(slab) {
                        sum.add_product(powers, power, c);
                    }
                }
                sums = next;
            }
            equations[part.equation].add_multiple(&sums[0], Double::new(1.0));
        }
        Some(equations)
    }
}

/// From Bernstein coefficients over `[−1, 1]` to powers, along one axis.
fn to_powers(c: &mut [Double], degree: usize, inner: usize) {
    // (1 + z)ⁱ (1 − z)^(d − i) C(d, i) / 2ᵈ.
    let mut factors = vec![vec![0.0; degree + 1]; degree + 1];
    for (i, row) in factors.iter_mut().enumerate() {
        row[0] = sweepsim_spline::kernel::binomial(degree, i) * 0.5f64.powi(degree as i32);
        for factor in 0..degree {
            let sign = if factor < i { 1.0 } else { -1.0 };
            for k in (1..=factor + 1).rev() {
                row[k] += sign * row[k - 1];
            }
        }
    }
    let mut sums = vec![Double::default(); degree + 1];
    for block in c.chunks_exact_mut((degree + 1) * inner) {
        for at in 0..inner {
            for (k, sum) in sums.iter_mut().enumerate() {
                *sum = Double::default();
                for (i, row) in factors.iter().enumerate() {
                    *sum = sum.add(block[i * inner + at].times(row[k]));
                }
            }
            for (k, sum) in sums.iter().enumerate() {
                block[k * inner + at] = *sum;
            }
        }
    }
}
