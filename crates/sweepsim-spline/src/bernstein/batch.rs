//! Values and gradients at many points: several points side by side in the lanes of a vector share each coefficient.
//!
//! The first (fastest) variable is contracted first: that leaves the least for the others. Every stage keeps, beside
//! the value, one array for each variable already contracted by its slope.

use super::Bernstein;
use smallvec::SmallVec;

/// The number of points processed side by side.
///
/// Eight: with two numbers per register, this is enough to hide the latency of an addition.
const LANES: usize = 8;

type Lane = [f64; LANES];
type Lanes = SmallVec<[Lane; 64]>;

const ZERO: Lane = [0.0; LANES];

impl Bernstein {
    /// The values at many points: `points` has `variables()` coordinates per point, `values` room for one number each.
    ///
    /// Evaluates as many points as both slices have room for, and returns their number. For a form in no variables,
    /// there is one point for each place in `values`.
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// let product = &Bernstein::variable(2, 0) * &Bernstein::variable(2, 1);
    /// let mut values = [0.0; 2];
    /// assert_eq!(product.evaluate_batch(&[0.5, 0.5, 1.0, 0.25], &mut values), 2);
    /// assert_eq!(values, [0.25, 0.25]);
    /// ```
    pub fn evaluate_batch(&self, points: &[f64], values: &mut [f64]) -> usize {
        self.batch::<false>(points, values, &mut [])
    }

    /// Values and gradients at many points: as [`evaluate_batch`](Self::evaluate_batch), and `gradients` has room for
    /// `variables()` numbers per point, laid out as `points`.
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// let product = &Bernstein::variable(2, 0) * &Bernstein::variable(2, 1);
    /// let (mut values, mut gradients) = ([0.0; 1], [0.0; 2]);
    /// assert_eq!(product.evaluate_gradient_batch(&[0.5, 0.25], &mut values, &mut gradients), 1);
    /// assert_eq!((values, gradients), ([0.125], [0.25, 0.5]));
    /// ```
    pub fn evaluate_gradient_batch(&self, points: &[f64], values: &mut [f64], gradients: &mut [f64]) -> usize {
        self.batch::<true>(points, values, gradients)
    }

    fn batch<const SLOPES: bool>(&self, points: &[f64], values: &mut [f64], gradients: &mut [f64]) -> usize {
        let n = self.variables();
        if n == 0 {
            values.fill(self.coefficients[0]);
            return values.len();
        }
        let mut count = values.len().min(points.len() / n);
        if SLOPES {
            count = count.min(gradients.len() / n);
        }
        let mut work = Work::default();
        let mut start = 0;
        while start < count {
            let used = LANES.min(count - start);
            self.block::<SLOPES>(&points[start * n..(start + used) * n], used, &mut work);
            for lane in 0..used {
                values[start + lane] = work.stages[0][0][lane];
                if SLOPES {
                    for axis in 0..n {
                        gradients[(start + lane) * n + axis] = work.stages[axis + 1][0][lane];
                    }
                }
            }
            start += used;
        }
        count
    }

    /// Contracts all variables for up to [`LANES`] points; leaves value and slopes at `work.stages[..][0]`.
    fn block<const SLOPES: bool>(&self, points: &[f64], used: usize, work: &mut Work) {
        let n = self.variables();
        let arrays = if SLOPES { n + 1 } else { 1 };
        if work.stages.len() < arrays {
            work.stages.resize(arrays, Lanes::new());
        }
        for axis in 0..n {
            let mut x = ZERO;
            for lane in 0..LANES {
                x[lane] = points[lane.min(used - 1) * n + axis];
            }
            let length = self.degrees[axis] + 1;
            basis_lanes::<SLOPES>(self.degrees[axis], &x, &mut work.basis, &mut work.slope);
            if axis == 0 {
                let rows = self.coefficients.len() / length;
                let (head, tail) = work.stages.split_at_mut(1);
                fit(&mut head[0], rows);
                if SLOPES {
                    fit(&mut tail[0], rows);
                }
                let (basis, slopes) = (&work.basis[..length], &work.slope[..]);
                for (k, row) in self.coefficients.chunks_exact(length).enumerate() {
                    let mut value = ZERO;
                    if SLOPES {
                        let mut slope = ZERO;
                        for ((&c, b), d) in row.iter().zip(basis).zip(slopes) {
                            for lane in 0..LANES {
                                value[lane] += c * b[lane];
                                slope[lane] += c * d[lane];
                            }
                        }
                        tail[0][k] = slope;
                    } else {
                        for (&c, b) in row.iter().zip(basis) {
                            for lane in 0..LANES {
                                value[lane] += c * b[lane];
                            }
                        }
                    }
                    head[0][k] = value;
                }
                continue;
            }
            if SLOPES {
                let (head, tail) = work.stages.split_at_mut(axis + 1);
                contract(&head[0], &mut tail[0], &work.slope);
                for earlier in &mut head[1..] {
                    contract_in_place(earlier, &work.basis);
                }
            }
            contract_in_place(&mut work.stages[0], &work.basis);
        }
    }
}

#[derive(Default)]
struct Work {
    /// The value, then the slopes by the variables, with the variables so far contracted.
    stages: SmallVec<[Lanes; 5]>,
    basis: SmallVec<[Lane; 16]>,
    slope: SmallVec<[Lane; 16]>,
}

fn fit(lanes: &mut Lanes, length: usize) {
    lanes.resize(length, ZERO);
}

#[inline]
fn dot(row: &[Lane], weights: &[Lane]) -> Lane {
    let mut sum = ZERO;
    for (value, weight) in row.iter().zip(weights) {
        for lane in 0..LANES {
            sum[lane] += value[lane] * weight[lane];
        }
    }
    sum
}

fn contract(from: &Lanes, to: &mut Lanes, weights: &[Lane]) {
    fit(to, from.len() / weights.len());
    for (sum, row) in to.iter_mut().zip(from.chunks_exact(weights.len())) {
        *sum = dot(row, weights);
    }
}

fn contract_in_place(values: &mut Lanes, weights: &[Lane]) {
    let rows = values.len() / weights.len();
    for k in 0..rows {
        values[k] = dot(&values[k * weights.len()..(k + 1) * weights.len()], weights);
    }
    values.truncate(rows);
}

/// The basis at the points `x`, and its slope.
fn basis_lanes<const SLOPES: bool>(
    degree: usize,
    x: &Lane,
    basis: &mut SmallVec<[Lane; 16]>,
    slope: &mut SmallVec<[Lane; 16]>,
) {
    basis.clear();
    basis.resize(degree + 1, ZERO);
    basis[0] = [1.0; LANES];
    let mut s = ZERO;
    for lane in 0..LANES {
        s[lane] = 1.0 - x[lane];
    }
    for step in 1..degree {
        raise_lanes(basis, step, x, &s);
    }
    if SLOPES {
        slope.clear();
        slope.resize(degree + 1, ZERO);
        let factor = degree as f64;
        for i in 0..=degree {
            for lane in 0..LANES {
                let below = if i > 0 { basis[i - 1][lane] } else { 0.0 };
                let here = if i < degree { basis[i][lane] } else { 0.0 };
                slope[i][lane] = factor * (below - here);
            }
        }
    }
    if degree > 0 {
        raise_lanes(basis, degree, x, &s);
    }
}

fn raise_lanes(basis: &mut [Lane], step: usize, x: &Lane, s: &Lane) {
    for i in (1..=step).rev() {
        let below = basis[i - 1];
        let here = basis[i];
        for lane in 0..LANES {
            // At i = step, `here` is still zero.
            basis[i][lane] = s[lane] * here[lane] + x[lane] * below[lane];
        }
    }
    for lane in 0..LANES {
        basis[0][lane] *= s[lane];
    }
}
