//! The slice functions against exact rational arithmetic.

use crate::common;

use common::{Exact, Random, exact, within};
use dashu_ratio::RBig;
use sweepsim_props::*;
use sweepsim_spline::{BernsteinError, kernel};

/// `n` numbers of a few bits, so that sums of them are exact, and one that is not.
fn numbers(random: &mut Random, n: usize) -> Vec<f64> {
    (0..n).map(|_| random.between(-1.0, 1.0)).collect()
}

/// A bound of the rounding of `steps` convex combinations of numbers below 1, with `|s| + |t|` to the power that steps
/// need.
fn bound(steps: usize, growth: f64) -> f64 {
    4.0 * f64::EPSILON * (steps + 1) as f64 * growth.powi(steps as i32)
}

fn value(degrees: &[usize], coefficients: &[f64], point: &[f64]) -> RBig {
    Exact::new(degrees, coefficients).value(point)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: common::cases(96), failure_persistence: None, ..ProptestConfig::default() })]

    /// Splitting along any variable of a tensor, at any length of lines (those known to the compiler and longer ones),
    /// and both kept parts.
    #[test]
    fn parts_are_the_form_on_its_parts(seed in any::<u64>(), p in 0..9_usize, q in 0..7_usize, copies in 1..4_usize, along_second in any::<bool>()) {
        let mut random = Random(seed);
        let size = (p + 1) * (q + 1);
        let c = numbers(&mut random, copies * size);
        let (degree, inner) = if along_second { (q, p + 1) } else { (p, 1) };
        // A number of few bits: its complement is exact.
        let t = random.below(257) as f64 / 256.0;
        let s = 1.0 - t;
        let (mut upper, mut lower) = (c.clone(), vec![f64::NAN; c.len()]);
        kernel::split(&mut upper, &mut lower, degree, inner, s, t);
        let (mut above, mut below) = (c.clone(), c.clone());
        kernel::keep_upper(&mut above, degree, inner, s, t);
        kernel::keep_lower(&mut below, degree, inner, s, t);
        prop_assert_eq!(&above, &upper);
        let (mut towards, mut away) = (c.clone(), vec![f64::NAN; c.len()]);
        kernel::split_at(&mut towards, &mut away, degree, inner, t);
        let x = random.below(65) as f64 / 64.0;
        let other = random.below(65) as f64 / 64.0;
        let point = |x: f64| if along_second { [other, x] } else { [x, other] };
        for copy in 0..copies {
            let of = |list: &[f64], x: f64| value(&[p, q], &list[copy * size..][..size], &point(x));
            prop_assert!(within(&of(&upper, x), &of(&c, t + s * x), bound(degree, 1.0)));
            prop_assert!(within(&of(&lower, x), &of(&c, t * x), bound(degree, 1.0)));
            prop_assert!(within(&of(&below, x), &of(&c, t * x), bound(degree, 1.0)));
            prop_assert!(within(&of(&towards, x), &of(&c, t + s * x), 2.0 * bound(degree, 1.0)));
            prop_assert!(within(&of(&away, x), &of(&c, t * x), 2.0 * bound(degree, 1.0)));
        }
    }

    /// Rectangles of any place, with degrees that have a fast path, that have tables, and that are too high for them.
    #[test]
    fn restriction_is_the_form_on_the_rectangle(seed in any::<u64>(), p in prop_oneof![0..8_usize, Just(33)], q in prop_oneof![0..8_usize, Just(12), Just(32)]) {
        let mut random = Random(seed);
        let size = (p + 1) * (q + 1);
        let c = numbers(&mut random, 2 * size);
        let mut side = || {
            let (a, b) = (random.below(129) as f64 / 128.0, random.below(129) as f64 / 128.0);
            if a == b { (0.0, 1.0) } else { (a.min(b), a.max(b)) }
        };
        let ((u0, u1), (v0, v1)) = (side(), side());
        let mut out = vec![f64::NAN; c.len()];
        kernel::restrict_rectangle(&c, [p, q], [u0, v0], [u1, v1], &mut out);
        let (x, y) = (random.below(17) as f64 / 16.0, random.below(17) as f64 / 16.0);
        for copy in 0..2 {
            let (found, whole) = (&out[copy * size..][..size], &c[copy * size..][..size]);
            let expected = value(&[p, q], whole, &[u0 + (u1 - u0) * x, v0 + (v1 - v0) * y]);
            prop_assert!(within(&value(&[p, q], found, &[x, y]), &expected, 2.0 * bound(2 * (p + q), 1.0)));
        }
    }

    /// Values and slopes of the basis, inside and outside the domain.
    #[test]
    fn basis_and_slopes(seed in any::<u64>(), degree in 0..20_usize) {
        let mut random = Random(seed);
        let x = random.between(-0.5, 1.5);
        let (mut only, mut values, mut slopes) = ([f64::NAN; 20], [f64::NAN; 20], [f64::NAN; 20]);
        kernel::basis(degree, x, &mut only);
        kernel::basis_with_slopes(degree, x, &mut values, &mut slopes);
        let growth = (1.0 - x).abs() + x.abs();
        for i in 0..=degree {
            let mut unit = vec![0.0; degree + 1];
            unit[i] = 1.0;
            let form = sweepsim_spline::Bernstein::new(&[degree], unit.clone()).map_err(|e: BernsteinError| TestCaseError::fail(e.to_string()))?;
            prop_assert_eq!(only[i].to_bits(), values[i].to_bits());
            prop_assert!(within(&exact(values[i]), &value(&[degree], &unit, &[x]), bound(degree, growth)));
            let slope = form.derivative(0);
            let expected = value(slope.degrees(), slope.coefficients(), &[x]);
            prop_assert!(within(&exact(slopes[i]), &expected, 2.0 * degree as f64 * bound(degree, growth)));
        }
    }

    /// Products, elevation, derivatives, Wronskians and values of lines; pairs of numbers stand for coefficients that
    /// are not numbers.
    #[test]
    fn lines(seed in any::<u64>(), p in 0..9_usize, q in 0..9_usize, by in 0..5_usize) {
        let mut random = Random(seed);
        let (a, b) = (numbers(&mut random, p + 1), numbers(&mut random, q + 1));
        let x = random.below(257) as f64 / 256.0;
        let on = |list: &[f64]| value(&[list.len() - 1], list, &[x]);
        let product: Vec<f64> = kernel::product(&a, &b, |a, b| a * b).collect();
        prop_assert_eq!(product.len(), p + q + 1);
        prop_assert!(within(&on(&product), &(on(&a) * on(&b)), bound(p.min(q) + 4, 1.0)));
        let raised: Vec<f64> = kernel::raised(&a, by).collect();
        prop_assert_eq!(raised.len(), p + by + 1);
        prop_assert!(within(&on(&raised), &on(&a), bound(p.min(by) + 4, 1.0)));
        let slope: Vec<f64> = kernel::derivative(&a).collect();
        prop_assert_eq!(slope.len(), p);
        let exact_slope = |list: &[f64]| {
            let n = RBig::from(list.len() as u64 - 1);
            let differences: Vec<RBig> = list.windows(2).map(|w| (exact(w[1]) - exact(w[0])) * &n).collect();
            let (x, y) = (exact(x), exact(1.0 - x));
            let mut line = differences;
            while line.len() > 1 {
                line = line.windows(2).map(|w| &w[0] * &y + &w[1] * &x).collect();
            }
            line.pop().unwrap_or(RBig::ZERO)
        };
        if p > 0 {
            prop_assert!(within(&on(&slope), &exact_slope(&a), 2.0 * p as f64 * bound(2, 1.0)));
            // a b′ − a′ b with b in the same degree.
            let b = numbers(&mut random, p + 1);
            let rate: Vec<f64> = kernel::wronskian(p, |i, j| a[i] * b[j] - a[j] * b[i]).collect();
            let expected = on(&a) * exact_slope(&b) - exact_slope(&a) * on(&b);
            prop_assert_eq!(rate.len(), 2 * p - 1);
            prop_assert!(within(&on(&rate), &expected, 2.0 * (p * p) as f64 * bound(p + 6, 1.0)));
        }
        let found = kernel::evaluate(&mut a.clone(), x).expect("coefficients");
        prop_assert!(within(&exact(found), &on(&a), bound(p, 1.0)));
        let (mut upper, mut lower) = (a.clone(), vec![0.0; p + 1]);
        kernel::split_line(&mut upper, &mut lower, 1.0 - x, x);
        let (mut as_tensor, mut below) = (a.clone(), vec![0.0; p + 1]);
        kernel::split(&mut as_tensor, &mut below, p, 1, 1.0 - x, x);
        prop_assert_eq!((upper, lower), (as_tensor, below));
    }
}

/// Parts of a constant are that constant to the bit, at any place: `s a + t a` would not be.
#[test]
fn split_at_keeps_constants() {
    for degree in 0..12 {
        for inner in [1, 2, 3] {
            let c = vec![0.1 + 0.2; 4 * inner * (degree + 1)];
            let (mut upper, mut lower) = (c.clone(), vec![0.0; c.len()]);
            kernel::split_at(&mut upper, &mut lower, degree, inner, 0.492);
            assert_eq!((&upper, &lower), (&c, &c));
        }
    }
}

/// Slices of any length: what is not a whole block, or finds no room, is left alone.
#[test]
fn odd_lengths_do_not_panic() {
    for (upper, lower, degree, inner) in [
        (0, 0, 3, 1),
        (5, 3, 1, 1),
        (7, 7, 2, 0),
        (3, 9, 2, 3),
        (10, 2, 0, 4),
        (13, 12, 3, 2),
    ] {
        let (mut a, mut b) = (vec![1.0; upper], vec![2.0; lower]);
        kernel::split(&mut a, &mut b, degree, inner, 0.5, 0.5);
        kernel::keep_upper(&mut a, degree, inner, 0.5, 0.5);
        kernel::keep_lower(&mut a, degree, inner, 0.5, 0.5);
        kernel::restrict_rectangle(&a, [degree, inner], [0.2; 2], [0.7; 2], &mut b);
        kernel::split_line(&mut a, &mut b, 0.5, 0.5);
    }
    let none: [f64; 0] = [];
    assert_eq!(kernel::product(&none, &[1.0], |a, b| a * b).count(), 0);
    assert_eq!(kernel::raised(&none, 3).count() + kernel::derivative(&none).count(), 0);
    assert_eq!(kernel::wronskian(0, |_, _| 1.0).count(), 0);
    assert_eq!(kernel::evaluate(&mut none.clone(), 0.5), None);
}
