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

/// What is known of the curve at one line: for other lines of its chart.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct KnownLine {
    /// A point of the chart near the curve, or near where that leaves the chart.
    pub witness: Option<Witness>,
    pub knot: Option<Knot>,
}

impl KnownLine {
    /// The witness nearest to `p`.
    pub fn nearest(ends: [&Self; 2], p: f64) -> Option<Witness> {
        let far = |witness: &Witness| (witness.value[0] - p).abs();
        match ends.map(|end| end.witness) {
            [Some(a), Some(b)] => Some(if far(&b) < far(&a) { b } else { a }),
            [a, b] => a.or(b),
        }
    }
}

/// The cubic polynomial with these values and derivatives at 0 and at a step: at `t` of it.
#[inline]
fn cubic([a, b]: [f64; 2], [da, db]: [f64; 2], step: f64, t: f64) -> f64 {
    let rise = b - a;
    let (da, db) = (da * step, db * step);
    let (second, third) = (3.0 * rise - 2.0 * da - db, da + db - 2.0 * rise);
    a + t * (da + t * (second + t * third))
}

impl Knot {
    /// The position in the chart between two knots, by the cubic polynomial through both.
    pub fn position(a: &Self, b: &Self, p: f64) -> [f64; 2] {
        let (step, t) = (b.p - a.p, (p - a.p) / (b.p - a.p));
        [0, 1].map(|k: usize| cubic([a.at[k], b.at[k]], [a.rate[k], b.rate[k]], step, t))
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

/// The polynomials of degree 5 through three knots, of `q` and `z`.
pub(super) struct Quintic {
    nodes: [f64; 3],
    /// Newton's divided differences of each, every node twice.
    differences: [[f64; 6]; 2],
}

impl Quintic {
    /// The middle knot is farther than this from both others, in parts of their distance: otherwise the polynomial at another knot says little of its error between.
    const SHARE: f64 = 0.3;

    /// Whether a knot is far enough from both others.
    pub fn is_between(a: &Knot, middle: &Knot, b: &Knot) -> bool {
        let share = (middle.p - a.p) / (b.p - a.p);
        (Self::SHARE..=1.0 - Self::SHARE).contains(&share)
    }

    /// `None` if the knots are too close to each other.
    pub fn through(a: &Knot, middle: &Knot, b: &Knot) -> Option<Self> {
        let knots = [a, middle, b];
        let nodes = knots.map(|knot| knot.p);
        let at = [nodes[0], nodes[0], nodes[1], nodes[1], nodes[2], nodes[2]];
        let mut differences = [[0.0; 6]; 2];
        for (k, own) in differences.iter_mut().enumerate() {
            for (n, value) in own.iter_mut().enumerate() {
                *value = knots[n / 2].place[k];
            }
            for order in 1..6 {
                for n in (order..6).rev() {
                    own[n] = if order == 1 && n % 2 == 1 {
                        knots[n / 2].slope[k]
                    } else {
                        (own[n] - own[n - 1]) / (at[n] - at[n - order])
                    };
                }
            }
        }
        let is_finite = differences.as_flattened().iter().all(|x| x.is_finite());
        (is_finite && Self::is_between(a, middle, b)).then_some(Self { nodes, differences })
    }

    /// `q` and `z` at `p`, with their derivatives.
    #[inline]
    pub fn at(&self, p: f64) -> [[f64; 2]; 2] {
        let [a, b, c] = self.nodes.map(|node| p - node);
        let factors = [a, a, b, b, c];
        self.differences.each_ref().map(|own| {
            let (mut value, mut slope) = (own[5], 0.0);
            for n in (0..5).rev() {
                slope = slope * factors[n] + value;
                value = value * factors[n] + own[n];
            }
            [value, slope]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn knot(p: f64, value: &dyn Fn(f64) -> f64, slope: &dyn Fn(f64) -> f64) -> Knot {
        let witness = Witness {
            at: [0.0; 2],
            value: [p, 0.0],
            q: 0.0,
        };
        Knot {
            witness,
            p,
            at: [value(p), p],
            rate: [slope(p), 1.0],
            place: [value(p), -2.0 * value(p)],
            slope: [slope(p), -2.0 * slope(p)],
            normal: [0.0; 3],
        }
    }

    #[test]
    fn polynomials_are_their_own_interpolants() {
        let f = |x: f64| 2.0 - x + 0.5 * x * x - 3.0 * x * x * x;
        let slope = |x: f64| -1.0 + x - 9.0 * x * x;
        let (a, b) = (knot(0.3, &f, &slope), knot(1.1, &f, &slope));
        for p in [0.3, 0.4, 0.9, 1.1] {
            assert!((Knot::position(&a, &b, p)[0] - f(p)).abs() < 1e-14);
        }
        let f = |x: f64| f(x) + x.powi(5) - 0.7 * x.powi(4);
        let slope = |x: f64| slope(x) + 5.0 * x.powi(4) - 2.8 * x.powi(3);
        let knots = [0.3, 0.6, 1.1].map(|p| knot(p, &f, &slope));
        let quintic = Quintic::through(&knots[0], &knots[1], &knots[2]).unwrap();
        for p in [0.3, 0.4, 0.6, 0.9, 1.1] {
            for (k, factor) in [1.0, -2.0].into_iter().enumerate() {
                let [value, rate] = quintic.at(p)[k];
                assert!((value - factor * f(p)).abs() < 1e-13 && (rate - factor * slope(p)).abs() < 1e-12);
            }
        }
        assert!(Quintic::through(&knots[0], &knots[0], &knots[2]).is_none());
        assert!(Quintic::through(&knots[1], &knots[1], &knots[1]).is_none());
    }

    /// Where the polynomial of a larger interval is off by some amount at a knot, those over the halves are off by less than a third of that.
    #[test]
    fn errors_are_less_over_the_halves() {
        // The sixth power is the first that no quintic polynomial follows.
        let (f, slope) = (|x: f64| x.powi(6), |x: f64| 6.0 * x.powi(5));
        let at = |p: f64| knot(p, &f, &slope);
        for middle in [0.3, 0.5, 0.7] {
            for share in [0.3, 0.5, 0.7] {
                let [a, m, b] = [0.0, middle, 1.0].map(at);
                let whole = Quintic::through(&a, &m, &b).unwrap();
                let x = at(share * middle);
                let off = (whole.at(x.p)[0][0] - x.place[0]).abs();
                let half = Quintic::through(&a, &x, &m).unwrap();
                for n in 0..=100 {
                    let p = middle * n as f64 / 100.0;
                    assert!((half.at(p)[0][0] - f(p)).abs() <= 0.34 * off, "{middle} {share} {p}");
                }
            }
        }
    }
}
