//! Every operation on B-splines against exact rational arithmetic.

use crate::common;

use common::splines::{assert_is, knots, point, spline, value};
use common::{Exact, Random, exact, within};
use dashu_ratio::RBig;
use sweepsim_props::*;
use sweepsim_spline::{BSpline, BernsteinMap, KnotVector, SplineError};

proptest! {
    #![proptest_config(ProptestConfig { cases: common::cases(96), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn evaluation(seed in any::<u64>()) {
        let mut random = Random(seed);
        let (n, m) = (1 + random.below(3), 1 + random.below(3));
        let f = spline(&mut random, n, 5, m);
        for outside in [false, true] {
            let mut p = point(&mut random, &f);
            if outside {
                p[0] = random.below(160) as f64 / 16.0 - 5.0;
            }
            let (found, error) = f.evaluate_with_error(&p);
            for (k, &x) in found.iter().enumerate() {
                prop_assert!(within(&exact(x), &value(&f, k, &p), error));
            }
            let mut again = vec![0.0; m];
            f.evaluate_batch(&p, &mut again);
            prop_assert_eq!(&again, &found);
            // Derivatives by three ways agree: tables, Jacobian, derivative splines.
            let all = f.derivatives(&p, 2);
            let jacobian = f.jacobian(&p);
            for axis in 0..n {
                let mut orders = vec![0; n];
                orders[axis] = 1;
                let slope = all.get(&orders).expect("of order 1");
                let derived = f.derivative(axis).expect("a variable");
                let (by_spline, error) = derived.evaluate_with_error(&p);
                for k in 0..m {
                    let scale = 1e-11 * (1.0 + derived.magnitude() + f.magnitude() * 64.0) + error;
                    let slack = if outside { 1e6 * scale } else { scale };
                    prop_assert!((slope[k] - jacobian[(k, axis)]).abs() <= slack);
                    // A jump or kink at a knot: the values there may be those of the other side.
                    let smooth = f.knots()[axis].multiplicity(p[axis]) == 0 || f.knots()[axis].domain().0 == p[axis];
                    if !outside && smooth {
                        prop_assert!((slope[k] - by_spline[k]).abs() <= scale, "{} {} {}", slope[k], by_spline[k], scale);
                    }
                }
            }
        }
    }

    #[test]
    fn knots_in_and_out(seed in any::<u64>()) {
        let mut random = Random(seed);
        let n = 1 + random.below(3);
        let f = spline(&mut random, n, 5, 2);
        let axis = random.below(n);
        let x = f.domain()[axis].1 * (1 + random.below(30)) as f64 / 32.0;
        let times = random.below(f.degree(axis) + 2 - f.knots()[axis].multiplicity(x).min(f.degree(axis) + 1));
        let fine = f.insert_knot(axis, x, times).expect("inside");
        assert_is(&fine, &mut random, "inserted", |p, k| value(&f, k, p));
        let mut back = fine;
        for _ in 0..times {
            back = back.remove_knot(axis, x).expect("was inserted");
        }
        prop_assert_eq!(back.knots(), f.knots());
        for (a, b) in back.coefficients().iter().zip(f.coefficients()) {
            prop_assert!((a - b).abs() <= back.error());
        }
        let open = f.open(axis).expect("a variable");
        assert_is(&open, &mut random, "opened", |p, k| value(&f, k, p));
    }

    #[test]
    fn degrees_up_and_down(seed in any::<u64>()) {
        let mut random = Random(seed);
        let n = 1 + random.below(2);
        let f = spline(&mut random, n, 4, 1);
        let axis = random.below(n);
        let by = 1 + random.below(3);
        let high = f.elevate(axis, by).expect("a variable");
        assert_is(&high, &mut random, "elevated", |p, k| value(&f, k, p));
        let mut low = high;
        for _ in 0..by {
            low = low.reduce(axis).expect("was elevated");
        }
        assert_is(&low, &mut random, "reduced again", |p, k| value(&f, k, p));
        prop_assert_eq!(low.degree(axis), f.degree(axis));
    }

    #[test]
    fn pieces_and_back(seed in any::<u64>()) {
        let mut random = Random(seed);
        let n = 1 + random.below(3);
        let f = spline(&mut random, n, 4, 2);
        let pieces = f.pieces().expect("small");
        for piece in &pieces {
            let local: Vec<f64> = (0..n).map(|_| random.below(9) as f64 / 8.0).collect();
            // Inside the box, so that the exact value is of this piece.
            let p: Vec<f64> = local.iter().zip(&piece.ranges).map(|(s, (lo, hi))| lo + (hi - lo) * (0.125 + 0.75 * s)).collect();
            let q: Vec<f64> = local.iter().map(|s| 0.125 + 0.75 * s).collect();
            for (k, component) in piece.map.components().iter().enumerate() {
                prop_assert!(within(&Exact::from(component).value(&q), &value(&f, k, &p), component.error()));
            }
        }
        let maps: Vec<BernsteinMap> = pieces.into_iter().map(|p| p.map).collect();
        let back = BSpline::from_pieces(f.knots().to_vec(), &maps).expect("its own pieces");
        for (a, b) in back.coefficients().iter().zip(f.coefficients()) {
            prop_assert!((a - b).abs() <= back.error());
        }
        // On smoother knots they are not welcome.
        let vector = &f.knots()[0];
        if let Some(&x) = vector.breakpoints().get(1).filter(|&&x| x < vector.domain().1) {
            match f.remove_knot(0, x) {
                Ok(smoother) => assert_is(&smoother, &mut random, "removed", |p, k| value(&f, k, p)),
                Err(error) => {
                    let not_exact = matches!(error, SplineError::NotExact { .. });
                    prop_assert!(not_exact, "{}", error);
                }
            }
        }
    }

    #[test]
    fn algebra(seed in any::<u64>()) {
        let mut random = Random(seed);
        let n = 1 + random.below(2);
        let m = 1 + random.below(3);
        let (f, g) = (spline(&mut random, n, 3, m), spline(&mut random, n, 3, m));
        let v = |s: &BSpline, p: &[f64], k: usize| value(s, k, p);
        assert_is(&f.add(&g).expect("alike"), &mut random, "f + g", |p, k| v(&f, p, k) + v(&g, p, k));
        assert_is(&f.sub(&g).expect("alike"), &mut random, "f − g", |p, k| v(&f, p, k) - v(&g, p, k));
        assert_is(&f.mul(&g).expect("alike"), &mut random, "f g", |p, k| v(&f, p, k) * v(&g, p, k));
        assert_is(&f.dot(&g).expect("alike"), &mut random, "f · g", |p, _| {
            (0..m).fold(RBig::ZERO, |sum, k| sum + v(&f, p, k) * v(&g, p, k))
        });
        assert_is(&f.square_norm().expect("small"), &mut random, "|f|²", |p, _| {
            (0..m).fold(RBig::ZERO, |sum, k| sum + v(&f, p, k) * v(&f, p, k))
        });
        assert_is(&f.scale(0.3), &mut random, "0.3 f", |p, k| v(&f, p, k) * exact(0.3));
        let both = f.tensor_product(&g).expect("alike");
        assert_is(&both, &mut random, "f ⊗ g", |p, k| v(&f, &p[..n], k) * v(&g, &p[n..], k));
        let stacked = BSpline::stack(&[f.clone(), g.clone()]).expect("alike");
        assert_is(&stacked, &mut random, "(f, g)", |p, k| if k < m { v(&f, p, k) } else { v(&g, p, k - m) });
        let rows = vec![(vec![0.1; m], 0.7), (vec![-2.0; m], 0.0)];
        assert_is(&f.transform(&rows).expect("rows"), &mut random, "A f + b", |p, k| {
            (0..m).fold(exact(rows[k].1), |sum, i| sum + v(&f, p, i) * exact(rows[k].0[i]))
        });
        let (a, b) = (spline(&mut random, n, 2, 3), spline(&mut random, n, 2, 3));
        let cross = a.cross(&b).expect("three components");
        assert_is(&cross, &mut random, "a × b", |p, k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            v(&a, p, i) * v(&b, p, j) - v(&a, p, j) * v(&b, p, i)
        });
        prop_assert!(cross.dot(&a).expect("alike").may_vanish());
        let c = spline(&mut random, n, 1, 3);
        let triple = BSpline::determinant(&[a.clone(), b.clone(), c.clone()]).expect("square");
        assert_is(&triple, &mut random, "det", |p, _| {
            (0..3).fold(RBig::ZERO, |sum, k| sum + {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                (v(&a, p, i) * v(&b, p, j) - v(&a, p, j) * v(&b, p, i)) * v(&c, p, k)
            })
        });
    }

    #[test]
    fn calculus(seed in any::<u64>()) {
        let mut random = Random(seed);
        let n = 1 + random.below(2);
        let f = spline(&mut random, n, 4, 1);
        let axis = random.below(n);
        let integral = f.integral(axis).expect("a variable");
        // ∂∫f = f (with open ends), and the integral at the start is 0.
        let back = integral.derivative(axis).expect("a variable");
        assert_is(&back, &mut random, "∂∫f", |p, k| value(&f, k, p));
        prop_assert_eq!(integral.face(axis, false).expect("a face").magnitude(), 0.0);
        // The whole integral is the mean of the pieces' coefficients times the volumes.
        let (whole, error) = f.integral_over_domain().expect("small");
        let sum = f.pieces().expect("small").iter().fold((0.0, 0.0), |(sum, off), piece| {
            let volume: f64 = piece.ranges.iter().map(|(a, b)| b - a).product();
            let (mean, error) = piece.map.components()[0].mean();
            (sum + mean * volume, off + error * volume)
        });
        prop_assert!((whole[0] - sum.0).abs() <= error + sum.1 + 1e-13 * sum.0.abs());
        // The derivative: the exact one piece by piece.
        let derivative = f.derivative(axis).expect("a variable");
        let pieces = derivative.pieces().expect("small");
        for (own, whole) in pieces.iter().zip(f.pieces().expect("small")) {
            let length = whole.ranges[axis].1 - whole.ranges[axis].0;
            let truth = whole.map.components()[0].derivative(axis).scale(1.0 / length);
            prop_assert!(truth.sub(&own.map.components()[0]).may_vanish() || f.degree(axis) == 0);
        }
        // The product rule, and ∂∂ symmetric.
        let g = spline(&mut random, n, 3, 1);
        if f.degree(axis) > 0 && g.degree(axis) > 0 {
            let product = f.mul(&g).expect("alike").derivative(axis).expect("a variable");
            let rule = f.derivative(axis).expect("").mul(&g).expect("").add(&f.mul(&g.derivative(axis).expect("")).expect("")).expect("");
            prop_assert!(product.sub(&rule).expect("").may_vanish());
        }
        if n == 2 {
            let (xy, yx) = (
                f.derivative(0).expect("").derivative(1).expect(""),
                f.derivative(1).expect("").derivative(0).expect(""),
            );
            prop_assert!(xy.sub(&yx).expect("").may_vanish());
        }
    }

    #[test]
    fn enclosures(seed in any::<u64>()) {
        let mut random = Random(seed);
        let f = spline(&mut random, 2, 3, 2);
        let f = f.mul(&f).expect("alike");
        let ranges = f.enclosure();
        for _ in 0..4 {
            let p = point(&mut random, &f);
            for (k, &(lo, hi)) in ranges.iter().enumerate() {
                let v = value(&f, k, &p);
                prop_assert!(exact(lo) <= v && v <= exact(hi));
            }
        }
    }
}

/// High degree in one variable, many variables of low degree.
#[test]
fn degree_eight_and_four_variables() {
    let mut random = Random(11);
    for _ in 0..6 {
        let of = |random: &mut Random| {
            let vector = knots(random, 8, 1);
            let count = vector.count();
            BSpline::new(vec![vector], 1, random.coefficients(count)).expect("a spline")
        };
        let (f, g) = (of(&mut random), of(&mut random));
        assert_is(&f.mul(&g).expect("alike"), &mut random, "f g", |p, k| {
            value(&f, k, p) * value(&g, k, p)
        });
        assert_is(&f.add(&g).expect("alike"), &mut random, "f + g", |p, k| {
            value(&f, k, p) + value(&g, k, p)
        });
        assert_is(&f.elevate(0, 2).expect("small"), &mut random, "elevated", |p, k| {
            value(&f, k, p)
        });
    }
    let (f, g) = (spline(&mut random, 4, 1, 1), spline(&mut random, 4, 1, 1));
    assert_is(&f.mul(&g).expect("alike"), &mut random, "f g", |p, k| {
        value(&f, k, p) * value(&g, k, p)
    });
    assert_is(&f.sub(&g).expect("alike"), &mut random, "f − g", |p, k| {
        value(&f, k, p) - value(&g, k, p)
    });
}

/// Values and derivatives of a periodic spline are the same at both ends, up to the last that is continuous.
#[test]
fn periodic_splines_close() {
    let mut random = Random(3);
    for degree in 1..6 {
        let vector = KnotVector::periodic(degree, &[0.0, 0.5, 1.25, 2.0, 4.0]).expect("knots");
        let closed = BSpline::periodic(vec![vector], 2, &random.coefficients(8)).expect("a spline");
        let scale = 1e-12 * (1.0 + closed.magnitude());
        let (start, end) = (
            closed.derivatives(&[0.0], degree - 1),
            closed.derivatives(&[4.0], degree - 1),
        );
        for r in 0..degree {
            let (a, b) = (start.get(&[r]).expect("low"), end.get(&[r]).expect("low"));
            assert!(
                a.iter()
                    .zip(b)
                    .all(|(x, y)| (x - y).abs() <= scale * 1e3f64.powi(r as i32)),
                "{a:?} {b:?}"
            );
        }
    }
}
