//! All real roots of a polynomial on an interval, by its derivatives.
//!
//! Between two consecutive roots of its derivative a polynomial is monotone, so it has one root there or none, and a
//! change of sign tells. That recursion ends at a constant. Roots where the sign does not change (double roots) are
//! given when the value at a root of the derivative is 0 to rounding.

/// Coefficients of a polynomial of degree at most 4, of `1, x, x², …`.
pub type Polynomial = [f64; 5];

fn value(p: &[f64], x: f64) -> f64 {
    p.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// The root of a polynomial with a change of sign on `[a, b]`, by Newton steps kept in a shrinking bracket.
fn bracketed(p: &[f64], derivative: &[f64], mut a: f64, mut b: f64) -> f64 {
    let rising = value(p, b) > 0.0;
    let mut x = 0.5 * (a + b);
    for _ in 0..100 {
        let y = value(p, x);
        if y == 0.0 {
            return x;
        }
        if (y > 0.0) == rising {
            b = x;
        } else {
            a = x;
        }
        let newton = x - y / value(derivative, x);
        let next = if newton > a && newton < b {
            newton
        } else {
            0.5 * (a + b)
        };
        if (next - x).abs() <= f64::EPSILON * x.abs().max(1e-3) || b - a <= f64::EPSILON * b.abs().max(a.abs()) {
            return next;
        }
        x = next;
    }
    x
}

/// The real roots of `polynomial` on `[a, b]`, ascending.
#[must_use]
pub fn roots_between(polynomial: &Polynomial, a: f64, b: f64) -> Vec<f64> {
    let mut roots = Vec::with_capacity(8);
    let degree = polynomial.iter().rposition(|&c| c != 0.0).unwrap_or(0);
    add_roots(&polynomial[..=degree], a, b, &mut roots);
    roots
}

fn add_roots(p: &[f64], a: f64, b: f64, roots: &mut Vec<f64>) {
    roots.clear();
    if p.len() < 2 {
        return;
    }
    let mut derivative = [0.0; 4];
    for i in 1..p.len() {
        derivative[i - 1] = p[i] * i as f64;
    }
    let derivative = &derivative[..p.len() - 1];
    add_roots(derivative, a, b, roots);
    let mut knots = [a; 6];
    let count = roots.len().min(4);
    knots[1..=count].copy_from_slice(&roots[..count]);
    knots[count + 1] = b;
    roots.clear();
    let largest = a.abs().max(b.abs());
    let size: f64 = p.iter().rev().fold(0.0, |sum, c| sum * largest + c.abs());
    let rounding = 4.0 * f64::EPSILON * size;
    let mut left = value(p, knots[0]);
    for i in 0..=count {
        let right = value(p, knots[i + 1]);
        if (left < 0.0 && right > 0.0) || (left > 0.0 && right < 0.0) {
            roots.push(bracketed(p, derivative, knots[i], knots[i + 1]));
        } else if right.abs() <= rounding {
            roots.push(knots[i + 1]);
        }
        left = right;
    }
    if value(p, a) == 0.0 {
        roots.insert(0, a);
    }
    roots.truncate(p.len() - 1);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The quartic with the four given roots.
    fn planted(r: [f64; 4]) -> Polynomial {
        let mut p = [1.0, 0.0, 0.0, 0.0, 0.0];
        for (n, root) in r.into_iter().enumerate() {
            for i in (0..=n + 1).rev() {
                p[i] = if i > 0 { p[i - 1] } else { 0.0 } - root * p[i];
            }
        }
        p
    }

    #[test]
    fn planted_roots_are_found() {
        let mut state = 7_u64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
        };
        let mut tried = 0;
        while tried < 2000 {
            let mut r = [next(), next(), next(), next()];
            r.sort_by(f64::total_cmp);
            let gap = r.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
            if gap < 1e-3 {
                continue;
            }
            tried += 1;
            let found = roots_between(&planted(r), -1.0, 1.0);
            assert_eq!(found.len(), 4, "{r:?}: {found:?}");
            for (x, y) in found.iter().zip(r) {
                // A root moves by the coefficients' rounding (16 ε in all) over the slope (at least gap³).
                assert!((x - y).abs() < 16.0 * f64::EPSILON / gap.powi(3), "{r:?}: {found:?}");
            }
        }
    }

    #[test]
    fn fewer_roots_and_lower_degrees() {
        assert_eq!(roots_between(&[1.0, 0.0, 0.0, 0.0, 1.0], -9.0, 9.0), [0.0; 0]);
        assert_eq!(roots_between(&[0.0; 5], -9.0, 9.0), [0.0; 0]);
        assert_eq!(roots_between(&[-6.0, 3.0, 0.0, 0.0, 0.0], -9.0, 9.0), [2.0]);
        assert_eq!(roots_between(&[-6.0, 3.0, 0.0, 0.0, 0.0], -9.0, 1.0), [0.0; 0]);
        let found = roots_between(&[-4.0, 0.0, 1.0, 0.0, 0.0], -9.0, 9.0);
        assert!(found.len() == 2 && (found[0] + 2.0).abs() < 1e-15 && (found[1] - 2.0).abs() < 1e-15);
    }
}
