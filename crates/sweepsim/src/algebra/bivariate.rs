//! Coefficient lists of bivariate Bernstein forms on `[0, 1]²`, first variable fastest: what a tool's surfaces are made of
//! before they are cut into cells.

use sweepsim_spline::Bernstein;

/// Cuts are off the middle, so that what is symmetric does not lie on them.
pub(crate) const CUT: f64 = 0.492;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Form {
    pub degrees: [usize; 2],
    pub c: Vec<f64>,
}

impl Form {
    /// A form in two variables, or in one (then constant in the second).
    pub fn of(bernstein: &Bernstein) -> Self {
        let degree = |axis: usize| bernstein.degrees().get(axis).copied().unwrap_or(0);
        Self {
            degrees: [degree(0), degree(1)],
            c: bernstein.coefficients().to_vec(),
        }
    }

    fn from_fn(degrees: [usize; 2], mut f: impl FnMut(usize, usize) -> f64) -> Self {
        let mut c = Vec::with_capacity((degrees[0] + 1) * (degrees[1] + 1));
        for j in 0..=degrees[1] {
            for i in 0..=degrees[0] {
                c.push(f(i, j));
            }
        }
        Self { degrees, c }
    }

    pub fn at(&self, i: usize, j: usize) -> f64 {
        self.c[i + (self.degrees[0] + 1) * j]
    }

    pub fn largest(&self) -> f64 {
        self.c.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
    }

    /// The two factors of `a(u) b(v)`, where it is such a product up to rounding; constant factors have degree 0.
    pub fn factors(&self) -> Option<[Self; 2]> {
        let [p, q] = self.degrees;
        let corner = self.at(0, 0);
        let slack = 8.0 * f64::EPSILON * self.largest() * self.largest();
        let rank_one =
            (0..=q).all(|j| (0..=p).all(|i| (self.at(i, j) * corner - self.at(i, 0) * self.at(0, j)).abs() <= slack));
        if !rank_one || corner == 0.0 {
            return None;
        }
        let in_u = Self::from_fn([p, 0], |i, _| self.at(i, 0));
        let in_v = Self::from_fn([0, q], |_, j| self.at(0, j) / corner);
        Some([in_u.lowered(), in_v.lowered()])
    }

    /// Degree 0 where all coefficients are equal.
    pub fn lowered(self) -> Self {
        if self.c.iter().all(|c| *c == self.c[0]) {
            Self {
                degrees: [0, 0],
                c: vec![self.c[0]],
            }
        } else {
            self
        }
    }

    pub fn derivative(&self, axis: usize) -> Self {
        let [p, q] = self.degrees;
        let n = self.degrees[axis];
        if n == 0 {
            return Self {
                degrees: self.degrees,
                c: vec![0.0; self.c.len()],
            };
        }
        let factor = n as f64;
        if axis == 0 {
            Self::from_fn([p - 1, q], |i, j| factor * (self.at(i + 1, j) - self.at(i, j)))
        } else {
            Self::from_fn([p, q - 1], |i, j| factor * (self.at(i, j + 1) - self.at(i, j)))
        }
    }

    pub fn times(&self, other: &Self) -> Self {
        let ([p, q], [r, s]) = (self.degrees, other.degrees);
        let degrees = [p + r, q + s];
        let mut product = Self {
            degrees,
            c: vec![0.0; (p + r + 1) * (q + s + 1)],
        };
        for l in 0..=s {
            for k in 0..=r {
                let scaled = other.at(k, l) * binomial(r, k) * binomial(s, l);
                for j in 0..=q {
                    for i in 0..=p {
                        product.c[i + k + (p + r + 1) * (j + l)] +=
                            scaled * self.at(i, j) * binomial(p, i) * binomial(q, j);
                    }
                }
            }
        }
        for j in 0..=q + s {
            for i in 0..=p + r {
                product.c[i + (p + r + 1) * j] /= binomial(p + r, i) * binomial(q + s, j);
            }
        }
        product
    }

    /// The same function in higher degrees.
    pub fn raised(&self, degrees: [usize; 2]) -> Self {
        let by = [degrees[0] - self.degrees[0], degrees[1] - self.degrees[1]];
        if by == [0, 0] {
            return self.clone();
        }
        self.times(&Self {
            degrees: by,
            c: vec![1.0; (by[0] + 1) * (by[1] + 1)],
        })
    }

    /// `self − other`, in the larger degrees of the two.
    pub fn minus(&self, other: &Self) -> Self {
        let degrees = [0, 1].map(|a| self.degrees[a].max(other.degrees[a]));
        let (a, b) = (self.raised(degrees), other.raised(degrees));
        Self {
            degrees,
            c: a.c.iter().zip(&b.c).map(|(x, y)| x - y).collect(),
        }
    }
}

pub(crate) fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |b, i| b * (n - i) as f64 / (i + 1) as f64)
}

/// Cuts coefficient tensors of these degrees, one after the other, across an axis at the part `at`, into two of the same degrees.
pub(crate) fn cut(source: &[f64], [p, q]: [usize; 2], axis: usize, at: f64, lower: &mut [f64], upper: &mut [f64]) {
    upper.copy_from_slice(source);
    if axis == 0 {
        match p {
            0 => lower.copy_from_slice(source),
            1 => cut_lines::<2>(at, lower, upper),
            2 => cut_lines::<3>(at, lower, upper),
            3 => cut_lines::<4>(at, lower, upper),
            4 => cut_lines::<5>(at, lower, upper),
            5 => cut_lines::<6>(at, lower, upper),
            8 => cut_lines::<9>(at, lower, upper),
            _ => {
                for (lower, upper) in lower.chunks_exact_mut(p + 1).zip(upper.chunks_exact_mut(p + 1)) {
                    cut_line(at, lower, upper);
                }
            }
        }
        return;
    }
    let line = p + 1;
    let size = line * (q + 1);
    for (lower, upper) in lower.chunks_exact_mut(size).zip(upper.chunks_exact_mut(size)) {
        lower[..line].copy_from_slice(&upper[..line]);
        for level in 1..=q {
            for j in 0..=q - level {
                let (this, next) = upper[j * line..(j + 2) * line].split_at_mut(line);
                for (a, b) in this.iter_mut().zip(next) {
                    *a += at * (*b - *a);
                }
            }
            lower[level * line..(level + 1) * line].copy_from_slice(&upper[..line]);
        }
    }
}

/// As [`cut_line`], of all lines of a length known to the compiler.
fn cut_lines<const N: usize>(at: f64, lower: &mut [f64], upper: &mut [f64]) {
    for (lower, upper) in lower.chunks_exact_mut(N).zip(upper.chunks_exact_mut(N)) {
        let mut line = [0.0; N];
        line.copy_from_slice(upper);
        let mut first = [0.0; N];
        first[0] = line[0];
        for level in 1..N {
            for i in 0..N - level {
                line[i] += at * (line[i + 1] - line[i]);
            }
            first[level] = line[0];
        }
        lower.copy_from_slice(&first);
        upper.copy_from_slice(&line);
    }
}

/// De Casteljau's algorithm.
fn cut_line(at: f64, lower: &mut [f64], upper: &mut [f64]) {
    let n = upper.len();
    lower[0] = upper[0];
    for level in 1..n {
        for i in 0..n - level {
            upper[i] += at * (upper[i + 1] - upper[i]);
        }
        lower[level] = upper[0];
    }
}

/// The coefficients of forms of these degrees, one after the other in `source`, over the box from `lower` to `upper`: the values
/// of their blossoms there.
pub(crate) fn restrict(source: &[f64], degrees: [usize; 2], lower: [f64; 2], upper: [f64; 2], out: &mut [f64]) {
    let [p, q] = degrees;
    match p {
        0 => restrict_rows::<1>(source, q, lower, upper, out),
        1 => restrict_rows::<2>(source, q, lower, upper, out),
        2 => restrict_rows::<3>(source, q, lower, upper, out),
        3 => restrict_rows::<4>(source, q, lower, upper, out),
        4 => restrict_rows::<5>(source, q, lower, upper, out),
        5..12 if q < 12 => restrict_large::<12>(source, degrees, lower, upper, out),
        _ => restrict_large::<MOST>(source, degrees, lower, upper, out),
    }
}

/// As [`restrict`], for a degree `P − 1` known to the compiler.
fn restrict_rows<const P: usize>(source: &[f64], q: usize, lower: [f64; 2], upper: [f64; 2], out: &mut [f64]) {
    match q {
        0 => restrict_small::<P, 1>(source, lower, upper, out),
        1 => restrict_small::<P, 2>(source, lower, upper, out),
        2 => restrict_small::<P, 3>(source, lower, upper, out),
        3 => restrict_small::<P, 4>(source, lower, upper, out),
        4 => restrict_small::<P, 5>(source, lower, upper, out),
        5..12 => restrict_large::<12>(source, [P - 1, q], lower, upper, out),
        _ => restrict_large::<MOST>(source, [P - 1, q], lower, upper, out),
    }
}

/// As [`restrict`], for any degrees below `M`.
fn restrict_large<const M: usize>(
    source: &[f64],
    [p, q]: [usize; 2],
    lower: [f64; 2],
    upper: [f64; 2],
    out: &mut [f64],
) {
    let (rows, columns) = (
        blossoms::<M>(p, lower[0], upper[0]),
        blossoms::<M>(q, lower[1], upper[1]),
    );
    let mut line = [0.0; M];
    let count = (p + 1) * (q + 1);
    for (source, out) in source.chunks_exact(count).zip(out.chunks_exact_mut(count)) {
        for j in 0..=q {
            for i in 0..=p {
                out[i + (p + 1) * j] = (0..=p).map(|k| rows[i][k] * source[k + (p + 1) * j]).sum();
            }
        }
        for i in 0..=p {
            for (j, x) in line[..=q].iter_mut().enumerate() {
                *x = (0..=q).map(|k| columns[j][k] * out[i + (p + 1) * k]).sum();
            }
            for (j, x) in line[..=q].iter().enumerate() {
                out[i + (p + 1) * j] = *x;
            }
        }
    }
}

/// As [`restrict`], for degrees `P − 1` and `Q − 1` known to the compiler.
fn restrict_small<const P: usize, const Q: usize>(source: &[f64], lower: [f64; 2], upper: [f64; 2], out: &mut [f64]) {
    let (rows, columns) = (
        blossoms::<P>(P - 1, lower[0], upper[0]),
        blossoms::<Q>(Q - 1, lower[1], upper[1]),
    );
    for (source, out) in source.chunks_exact(P * Q).zip(out.chunks_exact_mut(P * Q)) {
        let mut half = [[0.0; P]; Q];
        for j in 0..Q {
            for i in 0..P {
                half[j][i] = (0..P).map(|k| rows[i][k] * source[k + P * j]).sum();
            }
        }
        for j in 0..Q {
            for i in 0..P {
                out[i + P * j] = (0..Q).map(|k| columns[j][k] * half[k][i]).sum();
            }
        }
    }
}

/// Row `k`: the weights of the coefficients in the blossom of degree `n` at `n − k` times `lower` and `k` times `upper`.
fn blossoms<const N: usize>(n: usize, lower: f64, upper: f64) -> [[f64; N]; N] {
    let mut rows = [[0.0; N]; N];
    for (k, row) in rows[..=n].iter_mut().enumerate() {
        row[0] = 1.0;
        for level in 1..=n {
            let at = if level <= k { upper } else { lower };
            for i in (0..=level).rev() {
                let left = if i > 0 { row[i - 1] } else { 0.0 };
                row[i] = (1.0 - at) * row[i] + at * left;
            }
        }
    }
    rows
}

/// Values and derivatives of the Bernstein polynomials of degree `n` at `x` (also outside `[0, 1]`).
pub(crate) fn basis(n: usize, x: f64, value: &mut [f64; MOST], slope: &mut [f64; MOST]) {
    value[0] = 1.0;
    slope[0] = 0.0;
    let y = 1.0 - x;
    for level in 1..=n {
        if level == n {
            // The derivatives come from the polynomials of degree n − 1.
            slope[0] = -(n as f64) * value[0];
            for i in 1..n {
                slope[i] = n as f64 * (value[i - 1] - value[i]);
            }
            slope[n] = n as f64 * value[n - 1];
        }
        value[level] = x * value[level - 1];
        for i in (1..level).rev() {
            value[i] = y * value[i] + x * value[i - 1];
        }
        value[0] *= y;
    }
}

/// One more than the largest degree of a coefficient tensor.
pub(crate) const MOST: usize = 32;

#[cfg(test)]
mod tests {
    use super::*;

    fn value(form: &Form, u: f64, v: f64) -> f64 {
        let (mut a, mut b, mut s) = ([0.0; MOST], [0.0; MOST], [0.0; MOST]);
        basis(form.degrees[0], u, &mut a, &mut s);
        basis(form.degrees[1], v, &mut b, &mut s);
        (0..=form.degrees[1])
            .map(|j| (0..=form.degrees[0]).map(|i| a[i] * b[j] * form.at(i, j)).sum::<f64>())
            .sum()
    }

    #[test]
    fn algebra_agrees_with_values() {
        let f = Form {
            degrees: [2, 1],
            c: vec![1.0, -2.0, 0.5, 3.0, 1.5, -1.0],
        };
        let g = Form {
            degrees: [1, 2],
            c: vec![0.5, 2.0, -1.0, 1.0, 4.0, 0.25],
        };
        for (u, v) in [(0.0, 0.0), (0.3, 0.8), (1.0, 0.5), (1.2, -0.1)] {
            let (a, b) = (value(&f, u, v), value(&g, u, v));
            assert!((value(&f.times(&g), u, v) - a * b).abs() < 1e-13 * (1.0 + a.abs() * b.abs()));
            assert!((value(&f.minus(&g), u, v) - (a - b)).abs() < 1e-13);
            let h = 1e-6;
            let slope = (value(&f, u + h, v) - value(&f, u - h, v)) / (2.0 * h);
            assert!((value(&f.derivative(0), u, v) - slope).abs() < 1e-8);
        }
        let (mut lower, mut upper) = (vec![0.0; 6], vec![0.0; 6]);
        for axis in [0, 1] {
            cut(&f.c, f.degrees, axis, 0.3, &mut lower, &mut upper);
            let part = |c: &[f64]| Form {
                degrees: f.degrees,
                c: c.to_vec(),
            };
            let at = |x: f64| if axis == 0 { (x, 0.7) } else { (0.7, x) };
            let (l, u) = (at(0.3 * 0.4), at(0.3 + 0.7 * 0.4));
            assert!((value(&part(&lower), at(0.4).0, at(0.4).1) - value(&f, l.0, l.1)).abs() < 1e-14);
            assert!((value(&part(&upper), at(0.4).0, at(0.4).1) - value(&f, u.0, u.1)).abs() < 1e-14);
        }
    }

    #[test]
    fn restrictions_of_all_degrees_agree_with_values() {
        for (p, q) in (0..16).flat_map(|p| (0..16).map(move |q| (p, q))) {
            let count = (p + 1) * (q + 1);
            let c: Vec<f64> = (0..2 * count).map(|i| ((i * 7 + 3) % 11) as f64 - 5.0).collect();
            let (lower, upper) = ([0.2, 0.35], [0.7, 0.9]);
            let mut out = vec![0.0; 2 * count];
            restrict(&c, [p, q], lower, upper, &mut out);
            for k in 0..2 {
                let form = |c: &[f64]| Form {
                    degrees: [p, q],
                    c: c[k * count..][..count].to_vec(),
                };
                let at = |k: usize, x: f64| lower[k] + x * (upper[k] - lower[k]);
                for (u, v) in [(0.0, 1.0), (0.3, 0.8)] {
                    let error = value(&form(&out), u, v) - value(&form(&c), at(0, u), at(1, v));
                    assert!(error.abs() < 1e-13, "{p} {q}: {error}");
                }
            }
        }
    }
}
