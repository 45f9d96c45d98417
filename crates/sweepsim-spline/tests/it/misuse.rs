//! Misuse: sizes that do not fit, numbers that are not finite, points outside. Errors, never a panic.

use sweepsim_props::collection::vec;
use sweepsim_props::*;
use sweepsim_spline::{
    BSpline, Bernstein, BernsteinError, BernsteinMap, KnotVector, RationalBernstein, RationalError, RationalSpline,
    SplineError,
};

/// Numbers as users get them wrong.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -10.0..10.0,
        1 => Just(0.0),
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(f64::NEG_INFINITY),
        1 => Just(1e308),
        1 => Just(5e-324)
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn forms(degrees in vec(0..5_usize, 0..4), numbers in vec(number(), 0..40), error in number()) {
        let expected: usize = degrees.iter().map(|d| d + 1).product();
        let finite = numbers.iter().all(|c| c.is_finite());
        let made = Bernstein::new(&degrees, numbers.clone());
        prop_assert_eq!(made.is_ok(), numbers.len() == expected && finite);
        let made = Bernstein::with_error(&degrees, numbers.clone(), error);
        prop_assert!(made.is_err() || (numbers.len() == expected && finite && error >= 0.0));
        prop_assert!(Bernstein::new(&[usize::MAX, 3], numbers).is_err());
    }

    /// Knots that are accepted are sorted, finite and enough, whichever way they are made.
    #[test]
    fn knots(degree in 0..5_usize, mut numbers in vec(number(), 0..14), sorted in any::<bool>(), spans in 0..5_usize) {
        if sorted {
            numbers.sort_by(f64::total_cmp);
        }
        let two = [numbers.first().copied().unwrap_or(0.0), numbers.last().copied().unwrap_or(1.0)];
        let all = [
            KnotVector::new(degree, numbers.clone()),
            KnotVector::open(degree, &numbers),
            KnotVector::periodic(degree, &numbers),
            KnotVector::uniform(degree, spans, two[0], two[1]),
            KnotVector::bernstein(degree, two[0], two[1]),
        ];
        for knots in all.into_iter().flatten() {
            prop_assert!(knots.knots().iter().all(|t| t.is_finite()) && knots.knots().is_sorted());
            let (lo, hi) = knots.domain();
            prop_assert!(lo < hi && knots.count() > knots.degree());
        }
        prop_assert!(KnotVector::new(usize::MAX, numbers).is_err());
    }

    #[test]
    fn splines(sizes in vec((0..4_usize, 1..4_usize), 0..3), dimension in 0..4_usize, numbers in vec(number(), 0..60), weights in vec(number(), 0..20)) {
        let knots: Vec<KnotVector> = sizes.iter().map(|&(p, n)| KnotVector::uniform(p, n, 0.0, 1.0).expect("knots")).collect();
        let points: usize = knots.iter().map(KnotVector::count).product();
        let good = dimension > 0 && numbers.len() == points * dimension && numbers.iter().all(|c| c.is_finite());
        let made = BSpline::new(knots.clone(), dimension, numbers.clone());
        prop_assert!(made.is_err() || good);
        let _ = BSpline::periodic(knots.clone(), dimension, &numbers);
        let chunks: Vec<&[f64]> = numbers.chunks(dimension.max(1)).collect();
        let _ = BSpline::from_points(knots.clone(), &chunks);
        let made = RationalSpline::new(knots, dimension, &numbers, &weights);
        prop_assert!(made.is_err() || (weights.len() == points && weights.iter().all(|w| *w > 0.0)));
    }

    #[test]
    fn shapes(a in vec(number(), 9), radius in number(), turn in number()) {
        let three = |k: usize| [a[k], a[k + 1], a[k + 2]];
        let finite = |spline: &RationalSpline| spline.control_points().all(|(point, w)| w > 0.0 && point.iter().all(|c| c.is_finite()));
        let made = RationalSpline::circle([a[0], a[1]], radius);
        prop_assert!(made.is_err() || made.as_ref().is_ok_and(finite));
        let made = RationalSpline::arc(&three(0), &three(3), &three(6), radius, turn);
        prop_assert!(made.is_err() || made.as_ref().is_ok_and(finite));
        if let Ok(curve) = made {
            let turned = curve.revolve(three(3), three(6), turn);
            prop_assert!(turned.is_err() || turned.as_ref().is_ok_and(finite));
        }
    }

    /// The checked evaluation accepts exactly the points of the domain, and then agrees with the plain one.
    #[test]
    fn points(point in vec(prop_oneof![8 => 0.0..=1.0, 1 => number()], 0..4)) {
        let inside = point.len() == 2 && point.iter().all(|x| (0.0..=1.0).contains(x));
        let form = Bernstein::variable(2, 0).mul(&Bernstein::variable(2, 1));
        let map = BernsteinMap::new(vec![form.clone(), Bernstein::variable(2, 1)]);
        let weight = Bernstein::constant(2, 2.0);
        let rational = RationalBernstein::new(vec![form.clone()], weight).expect("positive");
        let line = || KnotVector::bernstein(1, 0.0, 1.0).expect("knots");
        let spline = BSpline::new(vec![line(), line()], 1, vec![0.0, 1.0, 2.0, 5.0]).expect("a spline");
        let nurbs = RationalSpline::new(vec![line(), line()], 1, &[0.0, 1.0, 2.0, 5.0], &[1.0, 2.0, 1.0, 1.0]).expect("a spline");
        if inside {
            prop_assert_eq!(form.try_evaluate(&point), Ok(form.evaluate(&point)));
            prop_assert_eq!(map.try_evaluate(&point), Ok(map.evaluate(&point)));
            prop_assert_eq!(rational.try_evaluate(&point), Ok(rational.evaluate(&point)));
            prop_assert_eq!(spline.try_evaluate(&point), Ok(spline.evaluate(&point)));
            prop_assert_eq!(nurbs.try_evaluate(&point), Ok(nurbs.evaluate(&point)));
        } else {
            let expected = |error: &BernsteinError| matches!(error, BernsteinError::Coordinates { .. } | BernsteinError::Outside { .. });
            prop_assert!(form.try_evaluate(&point).is_err_and(|error| expected(&error)));
            prop_assert!(map.try_evaluate(&point).is_err_and(|error| expected(&error)));
            prop_assert!(rational.try_evaluate(&point).is_err_and(|error| matches!(error, RationalError::Form(error) if expected(&error))));
            let expected = |error: SplineError| matches!(error, SplineError::Count { .. } | SplineError::Outside { .. });
            prop_assert!(spline.try_evaluate(&point).is_err_and(expected));
            prop_assert!(nurbs.try_evaluate(&point).is_err_and(expected));
        }
    }
}
