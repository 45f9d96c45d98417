//! Polynomials over a box as sums of Bernstein forms in disjoint variables, in double-double precision.
//!
//! Coefficients are kept *scaled*, multiplied by the binomial coefficients of their index: then a product is a plain convolution, and raising
//! the degree is the product with a power of `(1 − u) + u`. Each unscaled coefficient of a product is a mean of products of coefficients, so errors grow
//! by the sizes of the factors only.

use super::numbers::{ROUNDING, Real};
use crate::coefficients::MAX_DEGREE;
use crate::numbers::Double;
use crate::{Enclosure, Equation};
use sweepsim_spline::Bernstein;

/// Products with more coefficients than this, or that take more multiplications, are left unexpanded.
const MOST_COEFFICIENTS: usize = 1 << 16;
const MOST_WORK: usize = 1 << 22;
/// Rounding of numbers so small that it is no longer relative.
const UNDERFLOW: f64 = 4e-322;

/// A form in some of the variables.
#[derive(Clone, Debug)]
struct Block {
    /// One degree per variable of the domain.
    degrees: Vec<usize>,
    /// Scaled coefficients, first variable fastest.
    scaled: Vec<Double>,
    /// Bound on the unscaled coefficients.
    size: f64,
    /// Bound on the errors of the unscaled coefficients.
    error: f64,
}

/// A sum of forms that share no variables; a constant only alone.
#[derive(Clone, Debug)]
pub(super) struct Polynomial {
    blocks: Vec<Block>,
    variables: usize,
}

/// Binomial coefficients of one row, exact: they have at most 60 bits.
fn binomials(degree: usize) -> Vec<Double> {
    let mut row = vec![Double::new(1.0); degree + 1];
    for k in 1..=degree {
        let factor = Double::new((degree + 1 - k) as f64);
        row[k] = row[k - 1].mul(factor).div(Double::new(k as f64));
        // Exactly whole: divisions may leave a rounding error in the last place.
        let whole =
            Double::new(row[k].hi.round()).add(Double::new((row[k].sub(Double::new(row[k].hi.round())).hi).round()));
        row[k] = whole;
    }
    row
}

fn count(degrees: &[usize]) -> Option<usize> {
    degrees.iter().try_fold(1usize, |product, d| {
        let next = product.checked_mul(d + 1)?;
        (*d <= MAX_DEGREE && next <= MOST_COEFFICIENTS).then_some(next)
    })
}

fn absolute(x: Double) -> f64 {
    (x.hi.abs() + x.lo.abs()) * (1.0 + 4.0 * f64::EPSILON)
}

/// The index of the next coefficient, first variable fastest.
fn next_index(index: &mut [usize], degrees: &[usize]) {
    for (i, d) in index.iter_mut().zip(degrees) {
        *i += 1;
        if *i <= *d {
            break;
        }
        *i = 0;
    }
}

impl Block {
    fn constant(variables: usize, number: Real) -> Self {
        Self {
            degrees: vec![0; variables],
            scaled: vec![number.value],
            size: absolute(number.value),
            error: number.error,
        }
    }

    fn is_constant(&self) -> bool {
        self.degrees.iter().all(|d| *d == 0)
    }

    fn shares(&self, other: &Self) -> bool {
        self.degrees.iter().zip(&other.degrees).any(|(a, b)| *a > 0 && *b > 0)
    }

    /// The product; `None` if it is too large, or not finite.
    fn multiply(&self, other: &Self) -> Option<Self> {
        let degrees: Vec<usize> = self.degrees.iter().zip(&other.degrees).map(|(a, b)| a + b).collect();
        let length = count(&degrees)?;
        if self.scaled.len().checked_mul(other.scaled.len())? > MOST_WORK {
            return None;
        }
        // The place of an index of a factor in the product.
        let places = |own: &[usize]| -> Vec<usize> {
            let mut places = vec![0];
            let mut step = 1;
            for (d, all) in own.iter().zip(&degrees) {
                places = (0..=*d)
                    .flat_map(|i| places.iter().map(move |p| p + i * step))
                    .collect();
                step *= all + 1;
            }
            places
        };
        let (first, second) = (places(&self.degrees), places(&other.degrees));
        let mut scaled = vec![Double::default(); length];
        for (a, p) in self.scaled.iter().zip(&first) {
            for (b, q) in other.scaled.iter().zip(&second) {
                scaled[p + q] = scaled[p + q].add(a.mul(*b));
            }
        }
        // Each coefficient is a sum of at most as many products as the smaller factor has coefficients.
        let terms = (2 * self.scaled.len().min(other.scaled.len()) + 16) as f64;
        let size = self.size * other.size;
        let error = self.error * other.size
            + self.size * other.error
            + self.error * other.error
            + terms * (ROUNDING * size + UNDERFLOW);
        Self {
            degrees,
            scaled,
            size: (size + error) * (1.0 + 8.0 * f64::EPSILON),
            error: error * (1.0 + 8.0 * f64::EPSILON),
        }
        .finite()
    }

    /// The same polynomial with at least these degrees.
    fn elevated(&self, degrees: &[usize]) -> Option<Self> {
        let mut out = self.clone();
        for (j, wanted) in degrees.iter().enumerate() {
            let by = wanted.saturating_sub(out.degrees[j]);
            if by > 0 {
                let mut one = Self::constant(degrees.len(), Real::exact(1.0));
                one.degrees[j] = by;
                one.scaled = binomials(by);
                out = out.multiply(&one)?;
            }
        }
        Some(out)
    }

    fn add(&self, other: &Self) -> Option<Self> {
        let degrees: Vec<usize> = self
            .degrees
            .iter()
            .zip(&other.degrees)
            .map(|(a, b)| *a.max(b))
            .collect();
        count(&degrees)?;
        let (mut sum, second) = (self.elevated(&degrees)?, other.elevated(&degrees)?);
        for (a, b) in sum.scaled.iter_mut().zip(&second.scaled) {
            *a = a.add(*b);
        }
        let size = sum.size + second.size;
        sum.error = (sum.error + second.error + 4.0 * (ROUNDING * size + UNDERFLOW)) * (1.0 + 4.0 * f64::EPSILON);
        // Far from the origin, `x − p` is much smaller than `x`, and products of such differences err by their own sizes.
        sum.size = (size * (1.0 + 4.0 * f64::EPSILON)).min(sum.largest());
        sum.finite()
    }

    /// A bound on the unscaled coefficients, those meant and those computed, from the coefficients themselves.
    fn largest(&self) -> f64 {
        let rows: Vec<Vec<Double>> = self.degrees.iter().map(|d| binomials(*d)).collect();
        let mut index = vec![0usize; self.degrees.len()];
        let mut largest: f64 = 0.0;
        for c in &self.scaled {
            let binomial: f64 = rows.iter().zip(&index).map(|(row, i)| row[*i].hi).product();
            largest = largest.max(absolute(*c) / binomial);
            next_index(&mut index, &self.degrees);
        }
        (largest + self.error) * (1.0 + 4.0 * (self.degrees.len() + 2) as f64 * f64::EPSILON) + UNDERFLOW
    }

    fn finite(self) -> Option<Self> {
        let finite =
            self.size.is_finite() && self.error.is_finite() && self.scaled.iter().all(|c| (c.hi + c.lo).is_finite());
        finite.then_some(self)
    }

    /// The unscaled coefficients, with a bound of their error.
    fn unscaled(&self) -> (Vec<Double>, f64) {
        let rows: Vec<Vec<Double>> = self.degrees.iter().map(|d| binomials(*d)).collect();
        let mut index = vec![0usize; self.degrees.len()];
        let mut coefficients = Vec::with_capacity(self.scaled.len());
        for c in &self.scaled {
            let mut value = *c;
            for (row, i) in rows.iter().zip(&index) {
                if *i > 0 && *i + 1 < row.len() {
                    value = value.div(row[*i]);
                }
            }
            coefficients.push(value);
            next_index(&mut index, &self.degrees);
        }
        let steps = (2 * self.degrees.len() + 4) as f64;
        let error = (self.error + steps * (ROUNDING * self.size + UNDERFLOW)) * (1.0 + 4.0 * f64::EPSILON);
        (coefficients, error)
    }

    /// The form with coefficients of one number each.
    fn form(&self) -> Option<Bernstein> {
        let (coefficients, error) = self.unscaled();
        let rounded = coefficients.iter().fold(0.0, |m: f64, c| m.max(c.lo.abs()));
        let whole = coefficients.iter().map(|c| c.hi).collect();
        Bernstein::with_error(&self.degrees, whole, (error + rounded) * (1.0 + 4.0 * f64::EPSILON)).ok()
    }

    /// The equation with coefficients of two numbers each, unless one suffices.
    fn pairs(&self) -> Option<Equation> {
        let (coefficients, error) = self.unscaled();
        if coefficients.iter().all(|c| c.lo == 0.0) {
            return self.form().map(Equation::from);
        }
        let pairs: Vec<(f64, f64)> = coefficients.iter().map(|c| (c.hi, c.lo)).collect();
        Equation::of_pairs(&self.degrees, &pairs, error).ok()
    }
}

/// Adds the constant among the blocks to the one in which it cancels most: on a domain far from the origin, `x − p` is small, although neither `x` nor `p` is.
fn absorb(blocks: &mut Vec<Block>, constant: usize) -> Option<()> {
    let constant = blocks.swap_remove(constant);
    let mut best: Option<(f64, usize, Block)> = None;
    for (place, block) in blocks.iter().enumerate() {
        let sum = block.add(&constant)?;
        let saved = block.size - sum.size;
        if best.as_ref().is_none_or(|(most, ..)| saved > *most) {
            best = Some((saved, place, sum));
        }
    }
    if let Some((_, place, sum)) = best {
        blocks[place] = sum;
    }
    Some(())
}

impl Polynomial {
    pub(super) fn constant(variables: usize, number: Real) -> Self {
        Self {
            blocks: vec![Block::constant(variables, number)],
            variables,
        }
    }

    /// A coordinate, on the domain: its ends are the coefficients, exactly.
    pub(super) fn variable(number: usize, domain: &[Enclosure]) -> Self {
        let side = domain[number];
        let mut block = Block::constant(domain.len(), Real::exact(side.lo()));
        block.degrees[number] = 1;
        block.scaled.push(Double::new(side.hi()));
        block.size = side.magnitude();
        Self {
            blocks: vec![block],
            variables: domain.len(),
        }
    }

    /// Its value, if it is a number.
    pub(super) fn number(&self) -> Option<Real> {
        match &self.blocks[..] {
            [block] if block.is_constant() => Some(Real {
                value: block.scaled[0],
                error: block.error,
            }),
            _ => None,
        }
    }

    /// The sum; `None` if it is too large, or not finite.
    pub(super) fn add(&self, other: &Self) -> Option<Self> {
        let mut blocks = self.blocks.clone();
        for next in &other.blocks {
            let mut sum = next.clone();
            let mut rest = Vec::with_capacity(blocks.len() + 1);
            for block in blocks {
                if block.shares(&sum) || (block.is_constant() && sum.is_constant()) {
                    sum = block.add(&sum)?;
                } else {
                    rest.push(block);
                }
            }
            rest.push(sum);
            blocks = rest;
        }
        let constant = blocks.iter().position(Block::is_constant);
        if let Some(constant) = constant.filter(|_| blocks.len() > 1) {
            absorb(&mut blocks, constant)?;
        }
        Some(Self {
            blocks,
            variables: self.variables,
        })
    }

    /// The product; `None` if it is too large, or not finite.
    pub(super) fn multiply(&self, other: &Self) -> Option<Self> {
        let mut product: Option<Self> = None;
        for a in &self.blocks {
            for b in &other.blocks {
                let term = Self {
                    blocks: vec![a.multiply(b)?],
                    variables: self.variables,
                };
                product = Some(match product {
                    Some(sum) => sum.add(&term)?,
                    None => term,
                });
            }
        }
        product
    }

    /// A power of at least 1.
    pub(super) fn power(&self, exponent: u32) -> Option<Self> {
        // Whatever depends on a variable reaches the largest degree long before.
        if exponent as usize > MAX_DEGREE && self.number().is_none() {
            return None;
        }
        let (mut result, mut base, mut left): (Option<Self>, Self, u32) = (None, self.clone(), exponent);
        while left > 0 {
            if left & 1 == 1 {
                result = Some(match result {
                    Some(r) => r.multiply(&base)?,
                    None => base.clone(),
                });
            }
            left >>= 1;
            if left > 0 {
                base = base.multiply(&base)?;
            }
        }
        result
    }

    /// The quotient by a number; `None` if that may be 0.
    pub(super) fn divide(&self, divisor: Real) -> Option<Self> {
        let size = absolute(divisor.value);
        if !(size > 2.0 * divisor.error) {
            return None;
        }
        let value = Double::new(1.0).div(divisor.value);
        // |1/d − 1/d̃| ≤ error / (|d| |d̃|).
        let error = divisor.error / (size * (size - divisor.error)) * (1.0 + 8.0 * f64::EPSILON)
            + 8.0 * (ROUNDING * absolute(value) + UNDERFLOW);
        let inverse = Real { value, error };
        self.multiply(&Self::constant(self.variables, inverse))
    }

    /// As an equation over the domain; `None` if a number is not finite. A single form keeps all digits of its coefficients, since clusters of roots
    /// may need them; sums of forms in different variables are rounded.
    pub(super) fn equation(&self) -> Option<Equation> {
        if let [form] = &self.blocks[..] {
            return form.pairs();
        }
        let forms: Option<Vec<Bernstein>> = self.blocks.iter().map(Block::form).collect();
        forms.map(Equation::sum)
    }
}
