//! Points of a grazing curve, and the polynomials between them.

use super::chart::Witness;

/// A point of the curve, and how it goes on with `p`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knot {
    pub witness: Witness,
    pub p: f64,
    /// In the chart.
    pub at: [f64; 2],
    pub rate: [f64; 2],
    /// `q` and `z`, and their derivatives.
    pub place: [f64; 2],
    pub slope: [f64; 2],
    pub normal: [f64; 3],
}

/// The cubic polynomial with these values and derivatives at 0 and at a step: at `t` of it, with its derivative.
#[inline]
fn cubic([a, b]: [f64; 2], [da, db]: [f64; 2], step: f64, t: f64) -> [f64; 2] {
    let rise = b - a;
    let (da, db) = (da * step, db * step);
    let (second, third) = (3.0 * rise - 2.0 * da - db, da + db - 2.0 * rise);
    let value = a + t * (da + t * (second + t * third));
    let slope = (da + t * (2.0 * second + 3.0 * t * third)) / step;
    [value, slope]
}

impl Knot {
    /// The polynomials of `q` and `z` through two knots, at `p`, with their derivatives.
    #[inline]
    pub fn between(a: &Self, b: &Self, p: f64) -> [[f64; 2]; 2] {
        let (step, t) = (b.p - a.p, (p - a.p) / (b.p - a.p));
        [0, 1].map(|k: usize| cubic([a.place[k], b.place[k]], [a.slope[k], b.slope[k]], step, t))
    }

    /// The same of the position in the chart.
    pub fn position(a: &Self, b: &Self, p: f64) -> [f64; 2] {
        let (step, t) = (b.p - a.p, (p - a.p) / (b.p - a.p));
        [0, 1].map(|k: usize| cubic([a.at[k], b.at[k]], [a.rate[k], b.rate[k]], step, t)[0])
    }

    /// The position at `p`, to first order.
    pub fn along(&self, p: f64) -> [f64; 2] {
        [0, 1].map(|k: usize| self.at[k] + self.rate[k] * (p - self.p))
    }

    /// `q` and `z` at `p`, to first order.
    pub fn place_at(&self, p: f64) -> [f64; 2] {
        [0, 1].map(|k: usize| self.place[k] + self.slope[k] * (p - self.p))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubic_polynomials_are_their_own_interpolants() {
        let f = |x: f64| 2.0 - x + 0.5 * x * x - 3.0 * x * x * x;
        let slope = |x: f64| -1.0 + x - 9.0 * x * x;
        let (from, step) = (0.3, 0.8);
        for t in [0.0, 0.25, 0.6, 1.0] {
            let x = from + t * step;
            let [value, rate] = cubic([f(from), f(from + step)], [slope(from), slope(from + step)], step, t);
            assert!((value - f(x)).abs() < 1e-14 && (rate - slope(x)).abs() < 1e-13);
        }
    }
}
