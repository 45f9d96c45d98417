//! Random B-splines, and their values in exact arithmetic.

use super::{Random, exact, within};
use dashu_ratio::RBig;
use sweepsim_spline::{BSpline, KnotVector};

/// The value of component `k`, exactly, by the recurrence of de Boor and Cox.
pub fn value(spline: &BSpline, k: usize, point: &[f64]) -> RBig {
    let mut values: Vec<RBig> = spline.points().map(|p| exact(p[k])).collect();
    for (vector, &x) in spline.knots().iter().zip(point) {
        let span = vector.span(x);
        let (p, t) = (vector.degree(), vector.knots());
        let x = exact(x);
        let mut basis = vec![RBig::ONE];
        for j in 1..=p {
            let mut saved = RBig::ZERO;
            for r in 0..j {
                let (below, above) = (exact(t[span + 1 + r - j]), exact(t[span + 1 + r]));
                let share = &basis[r] / (&above - &below);
                basis[r] = &saved + (&above - &x) * &share;
                saved = (&x - &below) * &share;
            }
            basis.push(saved);
        }
        values = values
            .chunks(vector.count())
            .map(|line| {
                let own = &line[span - p..=span];
                own.iter().zip(&basis).fold(RBig::ZERO, |sum, (c, b)| sum + c * b)
            })
            .collect();
    }
    values.swap_remove(0)
}

/// Open, floating or periodic knots with few bits, on `[0, end]`.
pub fn knots(random: &mut Random, degree: usize, end: usize) -> KnotVector {
    let mut inner = Vec::new();
    for _ in 0..random.below(4) {
        let x = (1 + random.below(8 * end - 1)) as f64 / 8.0;
        for _ in 0..1 + random.below(degree + 1) {
            if inner.iter().filter(|&&y| y == x).count() <= degree {
                inner.push(x);
            }
        }
    }
    inner.sort_by(f64::total_cmp);
    let mut list = vec![0.0];
    list.extend(inner);
    list.push(end as f64);
    let open = KnotVector::open(degree, &list).expect("knots");
    match random.below(4) {
        0 => {
            let mut knots = open.knots().to_vec();
            let last = knots.len() - 1;
            for i in 0..degree {
                knots[i] -= (degree - i) as f64 / 4.0;
                knots[last - i] += (degree - i) as f64 / 4.0;
            }
            KnotVector::new(degree, knots).expect("knots")
        }
        1 => KnotVector::periodic(degree, &[0.0, 0.25, end as f64]).expect("knots"),
        _ => open,
    }
}

pub fn spline(random: &mut Random, variables: usize, most: usize, dimension: usize) -> BSpline {
    let knots: Vec<KnotVector> = (0..variables)
        .map(|axis| {
            let degree = random.below(most + 1);
            knots(random, degree, axis + 1)
        })
        .collect();
    let count = knots.iter().map(KnotVector::count).product::<usize>() * dimension;
    let coefficients = random.coefficients(count);
    BSpline::new(knots, dimension, coefficients).expect("a spline")
}

/// A point of the domain with few bits.
pub fn point(random: &mut Random, spline: &BSpline) -> Vec<f64> {
    spline
        .domain()
        .iter()
        .map(|&(lo, hi)| lo + (hi - lo) * random.below(65) as f64 / 64.0)
        .collect()
}

pub fn assert_is(spline: &BSpline, random: &mut Random, what: &str, truth: impl Fn(&[f64], usize) -> RBig) {
    assert!(spline.is_finite(), "{what}: nothing known of {spline}");
    for _ in 0..3 {
        let p = point(random, spline);
        for k in 0..spline.dimension() {
            let (a, b) = (value(spline, k, &p), truth(&p, k));
            assert!(
                within(&a, &b, spline.error()),
                "{what} at {p:?}: off by {:e}, bound {:e}\n{spline}",
                (&a - &b).to_f64().value(),
                spline.error()
            );
        }
    }
}
