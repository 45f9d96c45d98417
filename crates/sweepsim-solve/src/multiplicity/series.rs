//! Polynomials in a few complex variables, truncated, with a bound of what they leave out: sums of powers of `t` on the polydisc `abs(tₖ) ≤ 1`.
//!
//! Coefficients are double-double numbers. What a product has beyond the top degree, and what its arithmetic rounds, goes into the bound.

use crate::numbers::Double;

/// The most variables.
pub(super) const MOST: usize = 3;
/// A bound on the error of a product and its addition to a sum, relative to the sizes of both: each operation errs by `2⁻¹⁰⁰` at most.
const ROUNDING: f64 = f64::from_bits((1023 - 96) << 52);

/// Which powers a series has, in the order of their degrees, and which of them products belong to.
#[derive(Debug)]
pub(super) struct Powers {
    pub exponents: Vec<[u8; MOST]>,
    /// For each pair of powers, the number of their product; `usize::MAX` beyond the top degree.
    products: Vec<usize>,
}

impl Powers {
    /// All powers of so many variables up to a degree.
    pub(super) fn new(variables: usize, top: u8) -> Self {
        let mut exponents: Vec<[u8; MOST]> = Vec::new();
        for degree in 0..=top {
            let limit = |k: usize| if k < variables { degree } else { 0 };
            for a in 0..=limit(0) {
                for b in 0..=limit(1) {
                    for c in 0..=limit(2) {
                        if a + b + c == degree {
                            exponents.push([a, b, c]);
                        }
                    }
                }
            }
        }
        let number = |e: [u8; MOST]| exponents.iter().position(|x| *x == e).unwrap_or(usize::MAX);
        let mut products = Vec::with_capacity(exponents.len() * exponents.len());
        for x in &exponents {
            for y in &exponents {
                products.push(number(std::array::from_fn(|k| x[k] + y[k])));
            }
        }
        Self { exponents, products }
    }

    pub(super) fn len(&self) -> usize {
        self.exponents.len()
    }

    pub(super) fn degree(&self, number: usize) -> u8 {
        self.exponents[number].iter().sum()
    }

    /// The number of a variable's first power.
    pub(super) fn variable(&self, k: usize) -> usize {
        let mut exponents = [0; MOST];
        exponents[k] = 1;
        self.exponents.iter().position(|x| *x == exponents).unwrap_or(0)
    }
}

/// A series, within `rest` of the function that it stands for on the polydisc.
#[derive(Clone, Debug)]
pub(super) struct Series {
    pub c: Vec<Double>,
    pub rest: f64,
}

impl Series {
    pub(super) fn zero(powers: &Powers) -> Self {
        Self {
            c: vec![Double::default(); powers.len()],
            rest: 0.0,
        }
    }

    pub(super) fn constant(powers: &Powers, value: Double) -> Self {
        let mut series = Self::zero(powers);
        series.c[0] = value;
        series
    }

    /// A bound on its size on the polydisc.
    pub(super) fn size(&self) -> f64 {
        self.size_of(|_| true)
    }

    /// The same, of the powers with these numbers and of the rest.
    pub(super) fn size_of(&self, with: impl Fn(usize) -> bool) -> f64 {
        let sum: f64 = (0..self.c.len()).filter(|k| with(*k)).map(|k| self.c[k].hi.abs()).sum();
        (sum + self.rest) * (1.0 + 1e-13)
    }

    /// Adds a multiple of another series.
    pub(super) fn add_multiple(&mut self, other: &Self, factor: Double) {
        let mut sizes = 0.0;
        for (x, y) in self.c.iter_mut().zip(&other.c) {
            let term = y.mul(factor);
            *x = x.add(term);
            sizes += x.hi.abs() + term.hi.abs();
        }
        self.rest += other.rest * factor.hi.abs() * (1.0 + 1e-13) + ROUNDING * sizes;
    }

    /// Adds a product of two series.
    pub(super) fn add_product(&mut self, powers: &Powers, a: &Self, b: &Self) {
        let count = powers.len();
        let (mut sizes, mut beyond) = (0.0, 0.0);
        for (i, x) in a.c.iter().enumerate() {
            if x.hi == 0.0 {
                continue;
            }
            for (y, target) in b.c.iter().zip(&powers.products[i * count..]) {
                match self.c.get_mut(*target) {
                    Some(sum) => {
                        let term = x.mul(*y);
                        *sum = sum.add(term);
                        sizes += sum.hi.abs() + term.hi.abs();
                    }
                    None => beyond += x.hi.abs() * y.hi.abs(),
                }
            }
        }
        let rests = a.rest * b.size() + a.size() * b.rest;
        self.rest += (beyond + rests) * (1.0 + 1e-12) + ROUNDING * sizes;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_and_their_rests_hold_the_values() {
        // (1 + t/2 + u/3)⁴ up to degree 3, at points of the polydisc's real part.
        let powers = Powers::new(2, 3);
        assert_eq!(powers.len(), 10);
        let mut line = Series::constant(&powers, Double::new(1.0));
        line.c[powers.variable(0)] = Double::new(0.5);
        line.c[powers.variable(1)] = Double::new(0.25);
        let mut power = Series::constant(&powers, Double::new(1.0));
        for _ in 0..4 {
            let mut next = Series::zero(&powers);
            next.add_product(&powers, &power, &line);
            power = next;
        }
        let mut farthest: f64 = 0.0;
        for k in 0..=20 {
            for l in 0..=20 {
                let (t, u) = (f64::from(k) / 10.0 - 1.0, f64::from(l) / 10.0 - 1.0);
                let value: f64 = (0..powers.len())
                    .map(|i| {
                        let e = powers.exponents[i];
                        power.c[i].hi * t.powi(i32::from(e[0])) * u.powi(i32::from(e[1]))
                    })
                    .sum();
                let exact = (1.0 + 0.5 * t + 0.25 * u).powi(4);
                farthest = farthest.max((value - exact).abs());
            }
        }
        // Degree 4 is left out, of size (3/4)⁴ at the corner.
        assert!(
            farthest <= power.rest && farthest > 0.3 && power.rest < 0.32,
            "{farthest} {}",
            power.rest
        );
    }
}
