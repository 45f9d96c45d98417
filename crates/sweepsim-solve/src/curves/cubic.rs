//! Cubic pieces within a given distance of a certified piece of curve.
//!
//! Between two points of the curve lies a cubic with the curve's tangents there. The lengths of its two handles are chosen so that it is close to the curve at
//! a quarter, the middle and three quarters (by least squares), which makes its distance of sixth order in the length of a plane piece (de Boor, Höllig, Sabin 1987).
//! How they are chosen does not matter for the proof. Substituted for the variables, the cubic makes each equation a polynomial `r(s)` in one variable, whose coefficients bound it. Where, over a
//! box that holds both the curve and the cubic, `‖I − K J‖∞ < 1` (`J` the derivatives with respect to the other variables), the curve's point `y` and the cubic's
//! point `c` with the same value of the graph's variable have
//!
//! ```text
//! y − c = −K r + (I − K J*)(y − c),   so   |y − c| ≤ |K r| + |I − K J| |y − c|,   entry by entry.
//! ```
//!
//! With formulas, `r` is enclosed by a Taylor model instead ([`Strand`]).
//!
//! All of the curve between the two points is met, since the graph's variable goes through all values between theirs on the cubic.

use super::graph::without;
use super::strand::Strand;
use crate::coefficients::{Cell, Layout, Model, Summand};
use crate::numbers::{EPSILON, MAX_UNKNOWNS, Row, Square, ZERO, apply, inverse};

/// Roundings of one level of de Casteljau's algorithm with polynomials as weights: the products' coefficients are means of at most four terms, each with a
/// computed binomial weight.
const LEVEL: f64 = 24.0;

/// A cubic between two points of the curve, in coordinates in which the cell is `[0,1]ⁿ`: at either end, the point and a vector along the curve.
pub(super) struct Span {
    pub ends: [Row; 2],
    pub along: [Row; 2],
}

impl Span {
    /// The control values of each variable, with handles of these multiples of the vectors.
    pub(super) fn control(&self, handles: [f64; 2], n: usize) -> [[f64; 4]; MAX_UNKNOWNS] {
        let mut control = [[0.0; 4]; MAX_UNKNOWNS];
        for (j, c) in control.iter_mut().enumerate().take(n) {
            let (from, to) = (self.ends[0][j], self.ends[1][j]);
            let (first, second) = (handles[0] * self.along[0][j], handles[1] * self.along[1][j]);
            *c = [from, from + first, to - second, to];
        }
        control
    }

    /// Handles for which the cubic is close to the curve, by Gauss and Newton's method from a third. `units` are those in which distances count. No bound.
    pub(super) fn fit(
        &self,
        layout: &Layout,
        cell: &Cell,
        over: usize,
        units: &Row,
        buffer: &mut Vec<f64>,
    ) -> [f64; 2] {
        let (n, m) = (layout.n, layout.m);
        let start = [1.0 / 3.0; 2];
        let Some((k, _)) = inverse(&without(&layout.mean_slopes(&cell.c), over, m), m) else {
            return start;
        };
        let mut handles = start;
        for _ in 0..4 {
            let control = self.control(handles, n);
            let (mut matrix, mut right) = ([[0.0; 2]; 2], [0.0; 2]);
            for s in [0.25, 0.5, 0.75] {
                let r = 1.0 - s;
                let weights = [r * r * r, 3.0 * r * r * s, 3.0 * r * s * s, s * s * s];
                let mut x = [0.0; MAX_UNKNOWNS];
                for j in 0..n {
                    x[j] = (0..4).map(|k| weights[k] * control[j][k]).sum();
                }
                let (value, jacobian) = layout.evaluate(&cell.c, &x, buffer);
                let moved = |end: usize| -> Row {
                    let mut out = [0.0; MAX_UNKNOWNS];
                    for e in 0..m {
                        out[e] = (0..n).map(|j| jacobian[e][j] * self.along[end][j]).sum();
                    }
                    apply(&k, &out, m)
                };
                let (off, first, second) = (apply(&k, &value, m), moved(0), moved(1));
                for (place, j) in (0..n).filter(|j| *j != over).enumerate() {
                    let slopes = [
                        weights[1] * first[place] * units[j],
                        -weights[2] * second[place] * units[j],
                    ];
                    for a in 0..2 {
                        right[a] -= slopes[a] * off[place] * units[j];
                        for b in 0..2 {
                            matrix[a][b] += slopes[a] * slopes[b];
                        }
                    }
                }
            }
            // Straight pieces do not determine their handles: a little weight keeps these where they are.
            let keep = 1e-9 * (matrix[0][0] + matrix[1][1]);
            let (a, d, b) = (matrix[0][0] + keep, matrix[1][1] + keep, matrix[0][1]);
            let determinant = a * d - b * b;
            let next = [
                handles[0] + (d * right[0] - b * right[1]) / determinant,
                handles[1] + (a * right[1] - b * right[0]) / determinant,
            ];
            if !next.iter().all(|h| (0.1..=0.7).contains(h)) {
                return start;
            }
            handles = next;
        }
        handles
    }
}

/// A bound on the distance of the cubic from the curve in a cell, in the cell's sides, for each variable; `None` if there is none. `control` are the
/// cubic's control values in coordinates in which the cell is `[0,1]ⁿ`, and must lie there.
pub(super) fn distance(layout: &Layout, cell: &Cell, over: usize, control: &[[f64; 4]; MAX_UNKNOWNS]) -> Option<Row> {
    let (n, m) = (layout.n, layout.m);
    let inside = |c: &[f64; 4]| c.iter().all(|x| (0.0..=1.0).contains(x));
    if !control[..n].iter().all(inside) {
        return None;
    }
    let (k, _) = inverse(&without(&layout.mean_slopes(&cell.c), over, m), m)?;
    let slopes = layout.slopes(cell);
    let (lo, hi) = (without(&slopes.lo, over, m), without(&slopes.hi, over, m));
    let (rest, contraction) = rest(&k, &lo, &hi, m)?;
    let size = residuals(layout, cell, control);
    let mut direct = [0.0; MAX_UNKNOWNS];
    let mut largest: f64 = 0.0;
    for i in 0..m {
        direct[i] = (0..m).map(|e| k[i][e].abs() * size[e]).sum::<f64>() * (1.0 + 16.0 * EPSILON);
        if !direct[i].is_finite() {
            return None;
        }
        largest = largest.max(direct[i]);
    }
    let mut errors = [largest / (1.0 - contraction) * (1.0 + 8.0 * EPSILON); MAX_UNKNOWNS];
    for _ in 0..4 {
        let mut better = direct;
        for i in 0..m {
            for j in 0..m {
                better[i] += rest[i][j] * errors[j];
            }
            better[i] *= 1.0 + 16.0 * EPSILON;
        }
        errors = better;
    }
    let mut out = [0.0; MAX_UNKNOWNS];
    for (place, j) in (0..n).filter(|j| *j != over).enumerate() {
        out[j] = errors[place];
    }
    Some(out)
}

/// Bounds of the equations' values along the cubic.
fn residuals(layout: &Layout, cell: &Cell, control: &[[f64; 4]; MAX_UNKNOWNS]) -> Row {
    let mut size = [0.0; MAX_UNKNOWNS];
    if let Some(tape) = &layout.tape {
        let cubics = control.each_ref().map(Strand::cubic);
        let mut leaves = vec![Strand::constant(0.0); tape.leaves];
        for part in &layout.parts {
            let leaf = &mut leaves[part.equation];
            *leaf = leaf.add(Strand::of_form(part, &cell.c, &cubics));
        }
        for (e, size) in size.iter_mut().enumerate().take(layout.m) {
            *size = tape.run(e, |row| leaves[row]).size();
        }
        return size;
    }
    for (e, size) in size.iter_mut().enumerate().take(layout.m) {
        let mut sum = vec![0.0];
        let mut rounding = 0.0;
        for part in layout.parts.iter().filter(|p| p.equation == e) {
            let (terms, error) = compose(part, &cell.c, control);
            rounding += error;
            sum = add(&sum, &terms);
        }
        let largest = sum.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        // Sums of parts, after raising their degrees.
        *size = largest + rounding + LEVEL * EPSILON * (layout.degrees + 1) as f64 * cell.scale[e];
    }
    size
}

/// `|I − K J|` entry by entry, and its largest row sum if that is below 1.
fn rest(k: &Square, lo: &Square, hi: &Square, m: usize) -> Option<(Square, f64)> {
    let mut rest = ZERO;
    let mut contraction: f64 = 0.0;
    for i in 0..m {
        let mut row = 0.0;
        for j in 0..m {
            let (mut middle, mut radius, mut size) = (if i == j { -1.0 } else { 0.0 }, 0.0, 1.0);
            for e in 0..m {
                middle += k[i][e] * (0.5 * (lo[e][j] + hi[e][j]));
                radius += k[i][e].abs() * (0.5 * (hi[e][j] - lo[e][j]));
                size += k[i][e].abs() * lo[e][j].abs().max(hi[e][j].abs());
            }
            rest[i][j] = f64::abs(middle) + radius + 32.0 * EPSILON * size;
            row += rest[i][j];
        }
        let contracts = row < 0.999;
        if !contracts {
            return None;
        }
        contraction = contraction.max(row);
    }
    Some((rest, contraction))
}

/// The part as a polynomial of the cubic's parameter, in Bernstein form, with a bound on the error of its coefficients.
fn compose(part: &Summand, c: &[f64], control: &[[f64; 4]; MAX_UNKNOWNS]) -> (Vec<f64>, f64) {
    let values = part.of(c);
    let size = values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let mut rows: Vec<Vec<f64>> = values.iter().map(|x| vec![*x]).collect();
    let mut levels = 0;
    // Slowest axis first: its slabs are as long as all faster axes together.
    for axis in part.axes.iter().rev() {
        let weights = [control[axis.variable].map(|u| 1.0 - u), control[axis.variable]];
        for level in 0..axis.degree {
            for i in 0..(axis.degree - level) * axis.inner {
                let [lower, upper] = [0, 1].map(|k| multiply(&rows[i + k * axis.inner], &weights[k]));
                rows[i] = add(&lower, &upper);
            }
        }
        rows.truncate(axis.inner);
        levels += axis.degree;
    }
    (rows.swap_remove(0), LEVEL * EPSILON * levels as f64 * size)
}

/// The product of a Bernstein form and a cubic one.
fn multiply(a: &[f64], cubic: &[f64; 4]) -> Vec<f64> {
    let p = a.len() - 1;
    // C(p, i) C(3, k) / C(p + 3, i + k) = C(i + k, k) C(p − i + 3 − k, 3 − k) / C(p + 3, 3): whole numbers, exactly.
    let choose = |n: usize, k: usize| match k {
        0 => 1.0,
        1 => n as f64,
        2 => (n * (n - 1) / 2) as f64,
        _ => (n * (n - 1) * (n - 2) / 6) as f64,
    };
    let all = choose(p + 3, 3);
    let mut product = vec![0.0; p + 4];
    for (i, x) in a.iter().enumerate() {
        for (k, y) in cubic.iter().enumerate() {
            let weight = choose(i + k, k) * choose(p - i + 3 - k, 3 - k) / all;
            product[i + k] += weight * x * y;
        }
    }
    product
}

/// The sum of two Bernstein forms whose degrees are multiples of three.
fn add(a: &[f64], b: &[f64]) -> Vec<f64> {
    let (short, long) = if a.len() < b.len() { (a, b) } else { (b, a) };
    let mut short = short.to_vec();
    while short.len() < long.len() {
        short = multiply(&short, &[1.0; 4]);
    }
    short.iter().zip(long).map(|(x, y)| x + y).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_products() {
        let value = |c: &[f64], s: f64| {
            let mut c = c.to_vec();
            while c.len() > 1 {
                c = c.windows(2).map(|w| w[0] * (1.0 - s) + w[1] * s).collect();
            }
            c[0]
        };
        let (a, b) = ([0.3, -1.0, 2.0, 0.7, 0.1, -0.4, 5.0], [1.0, 0.25, -2.0, 0.5]);
        let product = multiply(&a, &b);
        assert_eq!(product.len(), 10);
        let sum = add(&a, &b);
        for k in 0..=10 {
            let s = f64::from(k) / 10.0;
            assert!((value(&product, s) - value(&a, s) * value(&b, s)).abs() < 1e-14);
            assert!((value(&sum, s) - value(&a, s) - value(&b, s)).abs() < 1e-14);
        }
    }
}
