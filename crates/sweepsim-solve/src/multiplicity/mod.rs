//! The number of complex zeros next to a singular point, with multiplicity, in any number of unknowns.
//!
//! Let `y ↦ z = B (φ(v) + w, v)`, `y = (w, v)`, with an orthonormal basis `B` of which the last `m` vectors, those of `v`, are (nearly) in the kernel of the
//! Jacobian, and let `G = M f` combine the equations so that the first ones are `wᵢ` and more, and the last `m` have no linear terms in `w` to speak of (singular vectors give
//! both). `φ` is a polynomial that nearly solves `G₁ = … = 0` for `w = 0` (Lyapunov and Schmidt). Over the polydisc `abs(vₖ) ≤ τ`, `abs(wᵢ) ≤ Rᵢ`:
//!
//! - the mean value theorem along `w` gives `abs(Gᵢ − wᵢ) ≤ aᵢ + Σ εᵢⱼ abs(wⱼ)`, `a` a bound of `Gᵢ` on `w = 0` and `ε` of the derivatives less those of `w`. If that is below
//!   `Rᵢ` at `abs(w) = R`, then for all `s` from 0 to 1 the zeros of `(1 − s) wᵢ + s Gᵢ` lie where `abs(w) ≤ r`, the fixed point of `r = a + ε r`;
//! - there, the last `m` equations are their values on `w = 0`, polynomials in `v`, within `Σ εₖⱼ rⱼ`. If homogeneous parts of these outweigh everything else
//!   on the boundary ([`leading`]), their homotopy has no zero on the boundary, either.
//!
//! Both maps then have equally many zeros in the polydisc: the product of the leading degrees. One variable `v` is the case of double roots, tangencies and pairs
//! closer together than can be told; then a single power of `v` leads. All holds for every system within the coefficients' error bounds.

mod expansion;
mod kernel;
mod leading;
mod series;

use crate::coefficients::Layout;
use crate::numbers::{Double, MAX_UNKNOWNS, Row, Square, ZERO, inverse};
use expansion::Expansion;
use kernel::{Decomposition, decompose, skew};
pub(crate) use leading::turns;
use leading::{Form, dominate, real_degree};
use series::{MOST, Powers, Series};

/// The top degrees of series in one, two and three variables.
const TOPS: [u8; MOST] = [8, 6, 4];
/// The most coefficients of a system times the square of a series' length.
const WORK: usize = 1 << 24;
/// Singular values below this part of the largest say nothing.
const LEAST: f64 = 1e-11;
/// Relative rounding of the sums below, with plenty of room.
const SLACK: f64 = 1e-9;

/// What is proved of a neighbourhood.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Zeros {
    /// The number of complex zeros with multiplicity.
    pub number: u32,
    /// The Brouwer degree on the neighbourhood's real points.
    pub degree: Option<i32>,
    /// A box that holds the neighbourhood's real points, in coordinates in which the domain is `[0,1]ⁿ`.
    pub lo: Row,
    pub hi: Row,
}

/// The zeros of a polynomial system in a neighbourhood of a box, within `radius` of the box's centre along each axis; `None` if that cannot be proved, or once it is `late`.
pub(crate) fn zeros(
    layout: &Layout,
    (box_lo, box_hi): (&Row, &Row),
    radius: f64,
    buffer: &mut Vec<Double>,
    late: &dyn Fn() -> bool,
) -> Option<Zeros> {
    let n = layout.n;
    let (mut lo, mut hi, mut half) = ([0.0; MAX_UNKNOWNS], [0.0; MAX_UNKNOWNS], [0.0; MAX_UNKNOWNS]);
    for j in 0..n {
        let centre = (0.5 * (box_lo[j] + box_hi[j])).clamp(0.0, 1.0);
        (lo[j], hi[j]) = (centre - radius, centre + radius);
        // In the cell's coordinates, whose origin is the middle of its rounded ends.
        let reach = (box_hi[j] - centre).max(centre - box_lo[j]);
        half[j] = reach / radius * (1.0 + SLACK) + 4.0 * f64::EPSILON * (1.0 + 1.0 / radius);
        if half[j] >= 0.5 {
            return None;
        }
    }
    let expansion = Expansion::new(layout, &lo, &hi, buffer, late)?;
    let slopes = expansion.slopes();
    let decomposition = decompose(&slopes, n);
    let found = (1..=n.min(MOST)).find_map(|m| {
        let corank = Corank::new(&expansion, &slopes, decomposition, n, m)?;
        corank.zeros(&half, late)
    });
    let (number, degree, reach) = found?;
    for j in 0..n {
        let centre = 0.5 * (lo[j] + hi[j]);
        let reach = radius * reach[j] + 4.0 * f64::EPSILON;
        (lo[j], hi[j]) = (centre - reach, centre + reach);
    }
    Some(Zeros { number, degree, lo, hi })
}

/// Coordinates for a kernel of this many dimensions.
struct Corank<'a> {
    expansion: &'a Expansion,
    slopes: &'a Square,
    n: usize,
    m: usize,
    /// The vectors of `w`, then those of `v`.
    basis: Square,
    /// The combinations `M`.
    weights: Square,
}

impl<'a> Corank<'a> {
    fn new(
        expansion: &'a Expansion,
        slopes: &'a Square,
        mut decomposition: Decomposition,
        n: usize,
        m: usize,
    ) -> Option<Self> {
        let regular = n - m;
        let values = decomposition.values;
        if regular > 0 && !(values[regular - 1] > LEAST * values[0] && values[0].is_finite()) {
            return None;
        }
        decomposition.complete(regular, n);
        // Independent vectors are enough; that they are orthonormal up to rounding proves it, with room.
        if !(skew(&decomposition.left, n) < SLACK && skew(&decomposition.right, n) < 1e-3 * SLACK) {
            return None;
        }
        let mut weights = ZERO;
        for i in 0..n {
            let factor = if i < regular { 1.0 / values[i] } else { 1.0 };
            for e in 0..n {
                weights[i][e] = decomposition.left[i][e] * factor;
            }
        }
        Some(Self {
            expansion,
            slopes,
            n,
            m,
            basis: decomposition.right,
            weights,
        })
    }

    /// The combined equations along the curve or surface, without the equations' own errors.
    fn combined(&self, powers: &Powers, curve: &[Series], late: &dyn Fn() -> bool) -> Option<Vec<Series>> {
        let equations = self.expansion.compose(powers, curve, late)?;
        let combine = |weights: &Row| {
            let mut sum = Series::zero(powers);
            for (equation, weight) in equations.iter().zip(weights) {
                sum.add_multiple(equation, Double::new(*weight));
            }
            sum
        };
        Some(self.weights[..self.n].iter().map(combine).collect())
    }

    /// `z` at `w = 0`.
    fn curve(&self, powers: &Powers, phi: &[Series], tau: f64) -> Vec<Series> {
        let regular = self.n - self.m;
        let coordinate = |l: usize| {
            let mut sum = Series::zero(powers);
            for k in 0..self.m {
                sum.c[powers.variable(k)] = Double::new(self.basis[regular + k][l]).times(tau);
            }
            // A product of two numbers fits into two.
            for (i, phi) in phi.iter().enumerate() {
                sum.add_multiple(phi, Double::new(self.basis[i][l]));
            }
            sum
        };
        (0..self.n).map(coordinate).collect()
    }

    /// Number and degree, and how far the neighbourhood reaches, if it holds a box of these half widths.
    fn zeros(mut self, half: &Row, late: &dyn Fn() -> bool) -> Option<(u32, Option<i32>, Row)> {
        let (n, m) = (self.n, self.m);
        let regular = n - m;
        let powers = Powers::new(m, TOPS[m - 1]);
        if self.expansion.cost() * powers.len() * powers.len() > WORK {
            return None;
        }
        let sum = |of: &dyn Fn(usize) -> f64| (0..n).map(of).sum::<f64>() * (1.0 + SLACK);
        // Half of the cell for `v`, the rest for `w`.
        let widest = (0..n).fold(0.0, |w: f64, l| {
            w.max(self.basis[regular..n].iter().map(|q| q[l].abs()).sum())
        });
        let tau = 0.5 / widest;
        // The coordinates of a box's points: the basis is orthonormal, but for rounding.
        let whole: f64 = half[..n].iter().sum();
        let extent = |i: usize| sum(&|l| self.basis[i][l].abs() * half[l]) + 1e-2 * SLACK * whole;
        if !(regular..n).all(|k| extent(k) < 0.9 * tau) {
            return None;
        }

        let mut phi = vec![Series::zero(&powers); regular];
        for _ in 0..=TOPS[m - 1] {
            let values = self.combined(&powers, &self.curve(&powers, &phi, tau), late)?;
            for (phi, value) in phi.iter_mut().zip(&values) {
                for (x, y) in phi.c.iter_mut().zip(&value.c) {
                    *x = x.sub(*y);
                }
            }
        }
        let curve = self.curve(&powers, &phi, tau);
        let mut values = self.combined(&powers, &curve, late)?;
        let (degrees, mix) = leading::degrees(&powers, &values[regular..]);
        if m > 1 {
            let old = self.weights;
            for (i, row) in mix[..m].iter().enumerate() {
                self.weights[regular + i] = std::array::from_fn(|e| (0..m).map(|k| row[k] * old[regular + k][e]).sum());
            }
            values = self.combined(&powers, &curve, late)?;
        }

        let noise = |i: usize| sum(&|e| self.weights[i][e].abs() * self.expansion.value_error[e]);
        let along: Vec<f64> = (0..regular).map(|i| values[i].size() + noise(i)).collect();
        let sizes: Vec<f64> = phi.iter().map(Series::size).collect();
        // Wide enough to hold the box, and for the equations to hold off their zeros.
        let reach: Vec<f64> = (0..regular)
            .map(|i| (extent(i) + sizes[i]).max(8.0 * along[i]).max(1e-30))
            .collect();
        let mut within = [0.0; MAX_UNKNOWNS];
        for (l, within) in within[..n].iter_mut().enumerate() {
            let kernel: f64 = (regular..n).map(|k| self.basis[k][l].abs() * tau).sum();
            let others: f64 = (0..regular)
                .map(|i| self.basis[i][l].abs() * (reach[i] + sizes[i]))
                .sum();
            *within = (kernel + others) * (1.0 + SLACK) + 1e-30;
            if !(*within <= 1.0) {
                return None;
            }
        }
        let variation = self.expansion.variation(&within);
        // Bounds of the derivatives along `w`, less 1 on the diagonal.
        let mut epsilon = ZERO;
        for i in 0..n {
            for j in 0..regular {
                let (mut middle, mut size) = (if i == j { -1.0 } else { 0.0 }, 1.0);
                let mut radius = 0.0;
                for e in 0..n {
                    for l in 0..n {
                        let term = self.weights[i][e] * self.slopes[e][l] * self.basis[j][l];
                        middle += term;
                        size += term.abs();
                        radius += (self.weights[i][e] * variation[e][l] * self.basis[j][l]).abs();
                    }
                }
                epsilon[i][j] = (f64::abs(middle) + radius) * (1.0 + SLACK) + 1e-13 * size;
            }
        }
        let next = |i: usize, of: &[f64]| {
            let spill: f64 = of.iter().zip(&epsilon[i]).map(|(r, e)| r * e).sum();
            (along[i] + spill) * (1.0 + SLACK)
        };
        if !(0..regular).all(|i| next(i, &reach) < reach[i]) {
            return None;
        }
        let mut close = reach;
        for _ in 0..60 {
            close = (0..regular).map(|i| next(i, &close).min(close[i])).collect();
        }
        let forms: Vec<Form> = (0..m)
            .map(|k| {
                let spill: f64 = close.iter().zip(&epsilon[regular + k]).map(|(r, e)| r * e).sum();
                let more = (spill + noise(regular + k)) * (1.0 + SLACK);
                Form::new(&powers, &values[regular + k], degrees[k], more)
            })
            .collect();
        if !dominate(&forms) {
            return None;
        }
        let number = degrees[..m].iter().map(|d| u32::from(*d)).product();
        let degree = real_degree(&forms).and_then(|d| {
            let (_, first) = inverse(&self.weights, n)?;
            let (_, second) = inverse(&self.basis, n)?;
            Some(d * i32::from(first) * i32::from(second))
        });
        Some((number, degree, within))
    }
}
