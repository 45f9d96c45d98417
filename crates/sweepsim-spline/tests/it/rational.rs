//! Rational forms and splines, and the shapes made of them.

use crate::common;

use common::{Random, exact, within};
use dashu_ratio::RBig;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use sweepsim_props::*;
use sweepsim_spline::{BSpline, Bernstein, KnotVector, RationalBernstein, RationalSpline, SplineError};

fn spline(random: &mut Random, variables: usize, dimension: usize) -> RationalSpline {
    let knots: Vec<KnotVector> = (0..variables)
        .map(|_| KnotVector::uniform(1 + random.below(3), 1 + random.below(3), 0.0, 2.0).expect("knots"))
        .collect();
    let count: usize = knots.iter().map(KnotVector::count).product();
    let points: Vec<f64> = (0..count * dimension).map(|_| random.between(-2.0, 2.0)).collect();
    let weights: Vec<f64> = (0..count).map(|_| random.between(0.2, 3.0)).collect();
    RationalSpline::new(knots, dimension, &points, &weights).expect("a spline")
}

fn close(a: &[f64], b: &[f64], slack: f64) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(x, y)| (x - y).abs() <= slack)
}

/// The exact quotient of the homogeneous Bernstein pieces' exact values.
fn exact_value(map: &RationalBernstein, local: &[f64], k: usize) -> RBig {
    let value = |f: &Bernstein| common::Exact::from(f).value(local);
    value(&map.numerators()[k]) / value(map.weight())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: common::cases(64), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn splines(seed in any::<u64>()) {
        let mut random = Random(seed);
        let (n, m) = (1 + random.below(2), 3);
        let f = spline(&mut random, n, m);
        let g = spline(&mut random, n, m);
        let p: Vec<f64> = (0..n).map(|_| random.between(0.01, 1.99)).collect();
        let (x, error) = f.evaluate_with_error(&p);
        let (y, _) = g.evaluate_with_error(&p);
        // Within the bound of the exact value, by way of the pieces.
        for piece in f.pieces().expect("small") {
            let local: Vec<f64> = piece.ranges.iter().map(|_| random.below(15) as f64 / 16.0).collect();
            let at: Vec<f64> = piece.ranges.iter().zip(&local).map(|((lo, hi), s)| lo + (hi - lo) * s).collect();
            let (near, bound) = f.evaluate_with_error(&at);
            // The piece has its own error, in numerator and weight; the least weight is 0.2.
            let forms = piece.map.to_homogeneous();
            for (k, x) in near.iter().enumerate() {
                let own = forms.error() * (1.0 + x.abs()) / 0.1;
                prop_assert!(within(&exact(*x), &exact_value(&piece.map, &local, k), bound + own));
            }
            prop_assert!(close(&piece.map.evaluate(&local), &near, 1e-12));
        }
        prop_assert!(error < 1e-11);
        for ((lo, hi), x) in f.enclosure().into_iter().zip(&x) {
            prop_assert!(lo <= *x && *x <= hi);
        }
        let sum: Vec<f64> = x.iter().zip(&y).map(|(a, b)| a + b).collect();
        prop_assert!(close(&f.add(&g).expect("alike").evaluate(&p), &sum, 1e-11));
        let difference: Vec<f64> = x.iter().zip(&y).map(|(a, b)| a - b).collect();
        prop_assert!(close(&f.sub(&g).expect("alike").evaluate(&p), &difference, 1e-11));
        let product: Vec<f64> = x.iter().zip(&y).map(|(a, b)| a * b).collect();
        prop_assert!(close(&f.mul(&g).expect("alike").evaluate(&p), &product, 1e-11));
        prop_assert!(close(&f.dot(&g).expect("alike").evaluate(&p), &[product.iter().sum()], 1e-11));
        let cross = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
        prop_assert!(close(&f.cross(&g).expect("alike").evaluate(&p), &cross, 1e-11));
        let all = f.derivatives(&p, 2);
        let jacobian = f.jacobian(&p);
        for axis in 0..n {
            let mut orders = vec![0; n];
            orders[axis] = 1;
            let slope = all.get(&orders).expect("of order 1");
            let by_spline = f.derivative(axis).expect("a variable");
            prop_assert!(close(slope, &by_spline.evaluate(&p), 1e-8));
            prop_assert!(close(slope, &jacobian.column(axis).iter().copied().collect::<Vec<_>>(), 1e-9));
            orders[axis] = 2;
            let second = by_spline.derivative(axis).expect("a variable").evaluate(&p);
            prop_assert!(close(all.get(&orders).expect("of order 2"), &second, 1e-5));
        }
        for (what, same) in [
            ("inserted", f.insert_knot(0, 0.7, 1)),
            ("elevated", f.elevate(0, 2)),
            ("opened", f.open(0)),
            ("back", f.insert_knot(0, 0.7, 1).and_then(|s| s.remove_knot(0, 0.7))),
            ("reduced", f.elevate(0, 1).and_then(|s| s.reduce(0))),
        ] {
            prop_assert!(close(&same.expect(what).evaluate(&p), &x, 1e-10), "{}", what);
        }
        let (left, right) = f.split(0, 1.1).expect("inside");
        let half = if p[0] < 1.1 { &left } else { &right };
        prop_assert!(close(&half.evaluate(&p), &x, 1e-11));
        prop_assert!(close(&left.join(&right, 0).expect("halves").evaluate(&p), &x, 1e-11));
        if n == 2 {
            let normal = f.normal().expect("a surface");
            for axis in 0..2 {
                let tangent: Vec<f64> = jacobian.column(axis).iter().copied().collect();
                let v = normal.evaluate(&p);
                let dot: f64 = v.iter().zip(&tangent).map(|(a, b)| a * b).sum();
                prop_assert!(dot.abs() <= 1e-8 * (1.0 + v.iter().map(|x| x.abs()).sum::<f64>()));
            }
        }
    }

    #[test]
    fn forms(seed in any::<u64>()) {
        let mut random = Random(seed);
        let mut map = || {
            let mut form = |lo: f64| {
                let c = (0..6).map(|_| random.between(lo, 2.0)).collect();
                Bernstein::new(&[2, 1], c).expect("a form")
            };
            RationalBernstein::new(vec![form(-2.0), form(-2.0), form(-2.0)], form(0.3)).expect("positive")
        };
        let (f, g) = (map(), map());
        let p = [0.3, 0.6];
        let (x, y) = (f.evaluate(&p), g.evaluate(&p));
        let sum: Vec<f64> = x.iter().zip(&y).map(|(a, b)| a + b).collect();
        prop_assert!(close(&f.add(&g).expect("alike").evaluate(&p), &sum, 1e-12));
        prop_assert!(close(&f.sub(&f).expect("alike").evaluate(&p), &[0.0; 3], 1e-12));
        prop_assert!(close(&f.cross(&g).expect("alike").dot(&f).expect("alike").evaluate(&p), &[0.0], 1e-11));
        let slope = f.derivative(0).expect("positive").evaluate(&p);
        prop_assert!(close(f.derivatives(&p, 1).get(&[1, 0]).expect("of order 1"), &slope, 1e-10));
        let (left, _) = f.split(1, 0.75).expect("positive");
        prop_assert!(close(&left.evaluate(&[0.3, 0.8]), &x, 1e-12));
        prop_assert!(close(&f.slice(1, 0.6).expect("positive").evaluate(&[0.3]), &x, 1e-12));
        for ((lo, hi), x) in f.enclosure().into_iter().zip(&x) {
            prop_assert!(lo <= *x && *x <= hi);
        }
    }

    #[test]
    fn arcs_are_round(start in -7.0f64..7.0, sweep in -TAU..TAU, radius in 0.1f64..100.0) {
        let arc = RationalSpline::arc(&[1.0, 2.0], &[radius, 0.0], &[0.0, radius], start, sweep).expect("an arc");
        let (_, end) = arc.domain()[0];
        for i in 0..=20 {
            let p = arc.evaluate(&[end * f64::from(i) / 20.0]);
            prop_assert!(((p[0] - 1.0).hypot(p[1] - 2.0) - radius).abs() < 1e-12 * (1.0 + radius));
        }
        let last = arc.evaluate(&[end]);
        let angle = start + sweep;
        prop_assert!(close(&last, &[1.0 + radius * angle.cos(), 2.0 + radius * angle.sin()], 1e-11 * (1.0 + radius)));
    }
}

#[test]
fn solids_of_revolution() {
    // A half circle turned around its diameter: the unit sphere.
    let half = RationalSpline::arc(&[0.0; 3], &[0.0, 0.0, -1.0], &[1.0, 0.0, 0.0], 0.0, PI).expect("an arc");
    let sphere = half.revolve([0.0; 3], [0.0, 0.0, 2.0], TAU).expect("a sphere");
    for (u, v) in [(0.1, 0.2), (1.3, 3.9), (0.5, 2.0), (1.0, 1.0)] {
        let p = sphere.evaluate(&[u, v]);
        assert!((p[0].hypot(p[1]).hypot(p[2]) - 1.0).abs() < 1e-14);
        // The normal is along the radius.
        let n = sphere.normal().expect("a surface").evaluate(&[u, v]);
        let length = n[0].hypot(n[1]).hypot(n[2]);
        let cosine: f64 = n.iter().zip(&p).map(|(a, b)| a * b).sum::<f64>() / length;
        assert!((cosine.abs() - 1.0).abs() < 1e-12);
    }
    // A disk moved along its axis, a quarter of a ring turned to a solid.
    let circle = RationalSpline::circle([0.0, 0.0], 2.0).expect("a circle");
    let lifted = circle
        .transform(&[(vec![1.0, 0.0], 0.0), (vec![0.0, 1.0], 0.0), (vec![0.0, 0.0], 5.0)])
        .expect("rows");
    let cylinder = lifted.extrude(&[0.0, 0.0, 3.0]).expect("a cylinder");
    let p = cylinder.evaluate(&[2.5, 0.5]);
    assert!((p[0].hypot(p[1]) - 2.0).abs() < 1e-14 && (p[2] - 6.5).abs() < 1e-14);
    let quarter = RationalSpline::arc(&[0.0; 3], &[1.0, 0.0, 0.0], &[0.0, 1.0, 0.0], 0.0, FRAC_PI_2).expect("an arc");
    let outer = quarter.transform(&[
        (vec![2.0, 0.0, 0.0], 0.0),
        (vec![0.0, 2.0, 0.0], 0.0),
        (vec![0.0, 0.0, 2.0], 0.0),
    ]);
    let ring = quarter.ruled(&outer.expect("rows")).expect("a ring");
    let p = ring.evaluate(&[0.4, 0.5]);
    assert!((p[0].hypot(p[1]) - 1.5).abs() < 1e-14);
    let degenerate = |what| Err(SplineError::Degenerate { what });
    assert_eq!(half.revolve([0.0; 3], [0.0; 3], 1.0), degenerate("direction"));
    assert_eq!(half.revolve([0.0; 3], [0.0, 0.0, 1.0], 7.0), degenerate("angle"));
    assert_eq!(RationalSpline::circle([0.0; 2], -1.0), degenerate("radius"));
}

#[test]
fn bad_weights_are_named() {
    let knots = KnotVector::bernstein(1, 0.0, 1.0).expect("knots");
    for weight in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let bad = RationalSpline::new(vec![knots.clone()], 1, &[0.0, 1.0], &[1.0, weight]);
        assert!(matches!(bad, Err(SplineError::Weight { index: 1, .. })), "{bad:?}");
    }
}

#[test]
fn fits() {
    let knots = || {
        vec![
            KnotVector::uniform(3, 5, -1.0, 1.0).expect("knots"),
            KnotVector::uniform(4, 3, 0.0, 2.0).expect("knots"),
        ]
    };
    // Splines of the space come back; also by least squares.
    let mut random = Random(5);
    let count = 8 * 7;
    let f = BSpline::new(knots(), 2, (0..2 * count).map(|_| random.between(-1.0, 1.0)).collect()).expect("a spline");
    let fit = BSpline::interpolate_function(knots(), 2, |x, y| f.evaluate_into(x, y)).expect("a fit");
    assert!(fit.residual < 1e-13);
    let sites: Vec<Vec<f64>> = f
        .domain()
        .iter()
        .map(|(lo, hi)| (0..30).map(|i| lo + (hi - lo) * f64::from(i) / 29.0).collect())
        .collect();
    let mut values = Vec::new();
    for y in &sites[1] {
        for x in &sites[0] {
            values.extend(f.evaluate(&[*x, *y]));
        }
    }
    let fit = BSpline::approximate(knots(), &sites, 2, &values).expect("a fit");
    assert!(fit.residual < 1e-13);
    for (a, b) in fit.spline.coefficients().iter().zip(f.coefficients()) {
        assert!((a - b).abs() < 1e-12);
    }
    // The error falls with the fourth power of the width of a span.
    let error = |spans| {
        let knots = KnotVector::uniform(3, spans, 0.0, 3.0).expect("knots");
        BSpline::interpolate_function(vec![knots], 1, |x, y| y[0] = x[0].sin().exp())
            .expect("a fit")
            .residual
    };
    assert!(error(40) < error(20) / 12.0);
    let points: Vec<[f64; 2]> = (0..12).map(|i| [f64::from(i), f64::from(i * i % 7)]).collect();
    let fit = BSpline::curve_through(&points, 3).expect("a curve");
    assert!(fit.residual < 1e-12);
    assert!(matches!(
        BSpline::curve_through(&[[0.0], [0.0]], 1),
        Err(SplineError::Degenerate { what: "chord" })
    ));
    // Two sites in one place.
    let knots = KnotVector::bernstein(2, 0.0, 1.0).expect("knots");
    let singular = BSpline::interpolate(vec![knots], &[vec![0.0, 0.0, 1.0]], 1, &[0.0, 0.0, 1.0]);
    assert_eq!(singular, Err(SplineError::Singular { axis: 0 }));
}
