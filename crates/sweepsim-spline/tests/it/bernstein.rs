//! Every operation on Bernstein forms against exact rational arithmetic: the result's error bound holds.

use crate::common;

use common::{Exact, Random, assert_is, exact, within};
use dashu_ratio::RBig;
use sweepsim_props::*;
use sweepsim_spline::{Bernstein, MAX_DEGREE};

/// Forms of at most this many coefficients, so that the exact side stays quick.
const MOST: usize = 700;

fn pad(point: &[f64], n: usize) -> Vec<f64> {
    point[..n].to_vec()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: common::cases(96), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn sums_differences_products(seed in any::<u64>()) {
        let mut random = Random(seed);
        let (a, b) = (random.form(MOST), random.form(60));
        let (ea, eb) = (Exact::from(&a), Exact::from(&b));
        let at = |e: &Exact, p: &[f64]| e.value(&pad(p, e.degrees.len()));
        assert_is(&a.add(&b), &mut random, "a + b", |p| at(&ea, p) + at(&eb, p));
        assert_is(&a.sub(&b), &mut random, "a − b", |p| at(&ea, p) - at(&eb, p));
        assert_is(&a.mul(&b), &mut random, "a b", |p| at(&ea, p) * at(&eb, p));
        assert_is(&b.square(), &mut random, "b²", |p| at(&eb, p) * at(&eb, p));
        let factor = random.coefficient(1);
        assert_is(&a.scale(factor), &mut random, "c a", |p| at(&ea, p) * exact(factor));
        let n = a.variables();
        assert_is(&a.tensor_product(&b), &mut random, "a ⊗ b", |p| ea.value(&p[..n]) * eb.value(&p[n..]));
    }

    #[test]
    fn chains_keep_their_bound(seed in any::<u64>()) {
        // Errors go in as well as come out: (a b − c)² ∂ₓ(a + c)
        let mut random = Random(seed);
        let (a, b, c) = (random.form(40), random.form(40), random.form(40));
        let (ea, eb, ec) = (Exact::from(&a), Exact::from(&b), Exact::from(&c));
        let form = (&(&(&a * &b) - &c).square() * &(&a + &c).derivative(0)).split(0, 0.25).0;
        let (da, dc) = (ea.derivative(0), ec.derivative(0));
        assert_is(&form, &mut random, "chain", |p| {
            let mut p = p.to_vec();
            p[0] *= 0.25;
            let at = |e: &Exact| e.value(&pad(&p, e.degrees.len()));
            let d = at(&ea) * at(&eb) - at(&ec);
            &d * &d * (at(&da) + at(&dc))
        });
    }

    #[test]
    fn calculus(seed in any::<u64>()) {
        let mut random = Random(seed);
        let a = random.form(MOST);
        let ea = Exact::from(&a);
        let axis = random.below(a.variables());
        let derivative = ea.derivative(axis);
        assert_is(&a.derivative(axis), &mut random, "∂a", |p| derivative.value(p));
        let integral = ea.integral(axis);
        assert_is(&a.integral(axis), &mut random, "∫a", |p| integral.value(p));
        // The derivative of the integral is the form, and the order of derivatives does not matter.
        let back = a.integral(axis).derivative(axis);
        assert_is(&back, &mut random, "∂∫a", |p| ea.value(p));
        let other = random.below(a.variables());
        let (ab, ba) = (a.derivative(axis).derivative(other), a.derivative(other).derivative(axis));
        prop_assert!(ab.sub(&ba).may_vanish());
        let (mean, error) = a.mean();
        let sum = (0..a.coefficients().len()).fold(RBig::ZERO, |sum, i| sum + ea.coefficient(i));
        prop_assert!(within(&exact(mean), &(sum / RBig::from(a.coefficients().len())), error));
    }

    #[test]
    fn elevation_and_reduction(seed in any::<u64>()) {
        let mut random = Random(seed);
        let a = random.form(120);
        let ea = Exact::from(&a);
        let axis = random.below(a.variables());
        let by = 1 + random.below(4);
        let high = a.elevate(axis, by);
        assert_is(&high, &mut random, "elevated", |p| ea.value(p));
        let mut low = high;
        for _ in 0..by {
            low = low.reduce(axis).expect("was elevated");
        }
        prop_assert_eq!(low.degrees(), a.degrees());
        for (i, c) in low.coefficients().iter().enumerate() {
            prop_assert!(within(&exact(*c), &ea.coefficient(i), low.error()), "coefficient {} back", i);
        }
        // A form whose highest power is there is not reduced.
        let mut x = Bernstein::constant(a.variables(), 1.0);
        for _ in 0..=a.degree(axis) {
            x = x.mul(&Bernstein::variable(a.variables(), axis));
        }
        let size = a.magnitude().max(1.0);
        prop_assert!(a.add(&x.scale(size)).reduce(axis).is_none());
    }

    #[test]
    fn subdivision(seed in any::<u64>()) {
        let mut random = Random(seed);
        let a = random.form(MOST);
        let ea = Exact::from(&a);
        let axis = random.below(a.variables());
        let at = random.below(17) as f64 / 16.0;
        let (left, right) = a.split(axis, at);
        let moved = |p: &[f64], lo: f64, hi: f64| {
            let mut p = p.to_vec();
            p[axis] = ((p[axis] * 64.0).round() / 64.0).mul_add(hi - lo, lo);
            p
        };
        let few = |form: &Bernstein, random: &mut Random, what: &str, lo: f64, hi: f64| {
            let computed = Exact::from(form);
            for _ in 0..3 {
                let mut p = random.point(form.variables());
                p[axis] = (p[axis] * 64.0).round() / 64.0;
                let (x, y) = (computed.value(&p), ea.value(&moved(&p, lo, hi)));
                assert!(within(&x, &y, form.error()), "{what} at {p:?} {:e} {:e}", (&x - &y).to_f64().value(), form.error());
            }
        };
        few(&left, &mut random, "left", 0.0, at);
        few(&right, &mut random, "right", at, 1.0);
        let (mut in_place, mut other) = (a.clone(), Bernstein::constant(0, 1.0));
        in_place.split_into(axis, at, &mut other);
        prop_assert_eq!(&in_place, &right);
        prop_assert_eq!(&other, &left);
        let lo = random.below(65) as f64 / 32.0 - 0.5;
        let hi = random.below(65) as f64 / 32.0 - 0.5;
        few(&a.restrict(axis, lo, hi), &mut random, "restricted", lo, hi);
        few(&a.reverse(axis), &mut random, "reversed", 1.0, 0.0);
        // Join: the left part, carried on beyond its end.
        if at >= 0.25 && (1.0 / at).fract() == 0.0 {
            few(&left.restrict(axis, 0.0, 1.0 / at), &mut random, "joined", 0.0, 1.0);
        }
        let slice = a.slice(axis, at);
        let es = Exact::from(&slice);
        let mut p = random.point(a.variables());
        p[axis] = at;
        let mut q = p.clone();
        q.remove(axis);
        prop_assert!(within(&es.value(&q), &ea.value(&p), slice.error()));
        if at == 0.0 || at == 1.0 {
            prop_assert_eq!(slice.error(), 0.0);
        }
    }

    #[test]
    fn evaluation(seed in any::<u64>()) {
        let mut random = Random(seed);
        let a = random.form(MOST);
        let ea = Exact::from(&a);
        for outside in [false, true] {
            let mut p = random.point(a.variables());
            if outside {
                let axis = random.below(p.len());
                p[axis] = random.between(-3.0, 4.0);
            }
            let (value, error) = a.evaluate_with_error(&p);
            prop_assert!(within(&exact(value), &ea.value(&p), error));
            let mut gradient = vec![0.0; a.variables()];
            a.evaluate_gradient(&p, &mut gradient);
            let mut errors = vec![0.0; a.variables()];
            a.gradient_errors(&p, &mut errors);
            for (axis, slope) in gradient.iter().enumerate() {
                prop_assert!(within(&exact(*slope), &ea.derivative(axis).value(&p), errors[axis]));
            }
        }
        let count = 7;
        let points: Vec<f64> = (0..count).flat_map(|_| random.point(a.variables())).collect();
        let (mut values, mut gradients) = (vec![0.0; count], vec![0.0; points.len()]);
        prop_assert_eq!(a.evaluate_gradient_batch(&points, &mut values, &mut gradients), count);
        for (k, p) in points.chunks(a.variables()).enumerate() {
            let (value, error) = a.evaluate_with_error(p);
            prop_assert!((values[k] - value).abs() <= 2.0 * error);
            let mut gradient = vec![0.0; a.variables()];
            a.evaluate_gradient(p, &mut gradient);
            for (axis, slope) in gradient.iter().enumerate() {
                let mut errors = vec![0.0; a.variables()];
                a.gradient_errors(p, &mut errors);
                prop_assert!((gradients[k * a.variables() + axis] - slope).abs() <= 2.0 * errors[axis]);
            }
        }
        let mut alone = vec![0.0; count];
        a.evaluate_batch(&points, &mut alone);
        prop_assert_eq!(alone, values);
    }

    #[test]
    fn composition(seed in any::<u64>()) {
        let mut random = Random(seed);
        let degrees: Vec<usize> = (0..1 + random.below(3)).map(|_| random.below(4)).collect();
        let f = random.form_of(&degrees);
        let variables = 1 + random.below(2);
        let inner: Vec<Bernstein> = (0..f.variables())
            .map(|_| {
                let degrees: Vec<usize> = (0..variables).map(|_| random.below(3)).collect();
                let count = degrees.iter().map(|d| d + 1).product();
                // Few bits, so that the inner values are exact f64s below.
                Bernstein::new(&degrees, (0..count).map(|_| random.below(33) as f64 / 32.0).collect()).expect("a form")
            })
            .collect();
        let ef = Exact::from(&f);
        let composed = f.compose(&inner).expect("one form a variable");
        let computed = Exact::from(&composed);
        for _ in 0..3 {
            let y: Vec<f64> = (0..variables).map(|_| random.below(17) as f64 / 16.0).collect();
            let x: Vec<f64> = inner.iter().map(|g| Exact::from(g).value(&y).to_f64().value()).collect();
            prop_assert!(within(&computed.value(&y), &ef.value(&x), composed.error()));
        }
        let affine = f.compose_affine(&vec![(vec![0.25, -0.5], 0.5); f.variables()]).expect("rows");
        let ea = Exact::from(&affine);
        let y = [0.375, 0.625];
        prop_assert!(within(
            &ea.value(&y[..affine.variables()]),
            &ef.value(&vec![0.25 * y[0] - 0.5 * y[1] + 0.5; f.variables()]),
            affine.error()
        ));
        if f.variables() >= 2 {
            let axis = random.below(f.variables());
            let normal: Vec<f64> = (0..f.variables()).map(|i| if i == axis { 0.5 } else { 0.25 }).collect();
            let plane = f.restrict_to_hyperplane(axis, &normal, 0.5).expect("a plane");
            let mut p = random.point(f.variables() - 1).iter().map(|x| (x * 8.0).round() / 8.0).collect::<Vec<_>>();
            let value = Exact::from(&plane).value(&p);
            let x = 1.0 - p.iter().sum::<f64>() / 2.0;
            p.insert(axis, x);
            prop_assert!(within(&value, &ef.value(&p), plane.error()));
        }
    }

    #[test]
    fn more_variables(seed in any::<u64>()) {
        let mut random = Random(seed);
        let a = random.form(200);
        let n = a.variables();
        let total = n + random.below(3);
        let mut axes: Vec<usize> = (0..total).collect();
        for i in (1..total).rev() {
            axes.swap(i, random.below(i + 1));
        }
        axes.truncate(n);
        let wide = a.extend(total, &axes).expect("axes");
        prop_assert_eq!(wide.error(), 0.0);
        let p = random.point(total);
        let q: Vec<f64> = axes.iter().map(|&axis| p[axis]).collect();
        prop_assert_eq!(Exact::from(&wide).value(&p), Exact::from(&a).value(&q));
    }

    #[test]
    fn enclosures(seed in any::<u64>()) {
        let mut random = Random(seed);
        let a = random.form(60).mul(&random.form(30));
        let (lo, hi) = a.enclosure();
        let e = Exact::from(&a);
        for _ in 0..4 {
            let v = e.value(&random.point(a.variables()));
            prop_assert!(exact(lo) <= v && v <= exact(hi));
            prop_assert!(!a.excludes_zero() || v != RBig::ZERO);
        }
    }

    #[test]
    fn leibniz(seed in any::<u64>()) {
        let mut random = Random(seed);
        let (a, b) = (random.form(60), random.form(60));
        let axis = random.below(a.variables());
        let rule = &(&a.derivative(axis) * &b) + &(&a * &b.derivative(axis));
        prop_assert!((&a * &b).derivative(axis).sub(&rule).may_vanish());
        let second = (&a * &b).derivative(axis).derivative(axis);
        let rule = &(&(&a.derivative(axis).derivative(axis) * &b) + &(&a.derivative(axis) * &b.derivative(axis)).scale(2.0))
            + &(&a * &b.derivative(axis).derivative(axis));
        prop_assert!(second.sub(&rule).may_vanish());
    }
}

/// Four variables, degree 8 in each: the largest that the crate is tested for, times a small one.
#[test]
fn four_variables_of_degree_eight() {
    let mut random = Random(4);
    let a = random.form_of(&[8, 8, 8, 8]);
    let b = random.form_of(&[2, 1, 2, 1]);
    let (ea, eb) = (Exact::from(&a), Exact::from(&b));
    assert_is(&a.mul(&b), &mut random, "a b", |p| ea.value(p) * eb.value(p));
    assert_is(&a.add(&b), &mut random, "a + b", |p| ea.value(p) + eb.value(p));
    assert_is(&a.derivative(3), &mut random, "∂a", |p| ea.derivative(3).value(p));
}

#[test]
fn high_degrees_work_and_the_highest_end_as_unknown() {
    let mut random = Random(9);
    let a = random.form_of(&[70]);
    let ea = Exact::from(&a);
    assert_is(&a.mul(&a), &mut random, "a²", |p| ea.value(p) * ea.value(p));
    assert_is(&a.elevate(0, 30), &mut random, "elevated", |p| ea.value(p));
    let most = random.form_of(&[MAX_DEGREE]);
    assert_eq!(most.mul(&a).error(), f64::INFINITY);
    assert_eq!(most.elevate(0, 1).error(), f64::INFINITY);
    assert!(Bernstein::new(&[MAX_DEGREE + 1], vec![0.0; MAX_DEGREE + 2]).is_err());
    let half = random.form_of(&[MAX_DEGREE / 2]);
    let eh = Exact::from(&half);
    assert_is(&half.mul(&half), &mut random, "high", |p| eh.value(p) * eh.value(p));
}

#[test]
fn overflow_and_underflow_are_covered() {
    let huge = Bernstein::new(&[2], vec![1e308, -1e308, 1e308]).expect("finite");
    assert_eq!(huge.add(&huge).error(), f64::INFINITY);
    assert_eq!(huge.mul(&huge).enclosure(), (f64::NEG_INFINITY, f64::INFINITY));
    let (mut far, mut left) = (huge.clone(), huge.clone());
    far.split_into(0, 1e10, &mut left);
    assert_eq!(far.error(), f64::INFINITY);
    let (mut nan, mut left) = (huge.clone(), huge);
    nan.split_into(0, f64::NAN, &mut left);
    assert_eq!((nan.error(), left.error()), (f64::INFINITY, f64::INFINITY));
    let tiny = Bernstein::new(&[2], vec![3e-170, -1e-160, 2e-165]).expect("finite");
    let et = Exact::from(&tiny);
    let mut random = Random(1);
    assert_is(&tiny.mul(&tiny), &mut random, "tiny²", |p| et.value(p) * et.value(p));
    let tiniest = Bernstein::new(&[2], vec![5e-324, -5e-324, 1e-323]).expect("finite");
    let et = Exact::from(&tiniest);
    assert_is(&tiniest.scale(0.3), &mut random, "scaled", |p| et.value(p) * exact(0.3));
    assert_is(&tiniest.elevate(0, 3), &mut random, "elevated", |p| et.value(p));
    assert_is(&tiniest.derivative(0), &mut random, "derived", |p| {
        et.derivative(0).value(p)
    });
}
