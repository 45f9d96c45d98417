//! Misuse of public constructors: errors, never a panic.

use crate::monitors::Fold;
use crate::support::targets::{Answer, List};
use sweepsim_props::*;
use sweepsim_solve::{
    Bundle, BundleSolver, ChartOptions, ChartSolver, CurveSolver, Enclosure, Equation, Expression, Pieces, PointSolver,
    SolveOptions, SurfaceSolver, System,
};
use sweepsim_spline::Bernstein;

/// Any number, the odd ones often.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(f64::NAN),
        Just(f64::INFINITY),
        Just(f64::NEG_INFINITY),
        Just(0.0),
        Just(-0.0),
        Just(f64::MAX),
        Just(f64::MIN_POSITIVE),
        Just(5e-324),
        -2.0..2.0_f64,
        any::<f64>(),
    ]
}

/// A form of few variables, with any coefficients and any error.
fn form() -> impl Strategy<Value = Bernstein> {
    (collection::vec(0..4_usize, 1..4), number(), number()).prop_map(|(degrees, odd, error)| {
        let mut k = 0.0;
        let count = degrees.iter().map(|d| d + 1).product::<usize>();
        let mut coefficients: Vec<f64> = std::iter::repeat_with(|| {
            k += 1.0;
            (k * 0.7_f64).sin()
        })
        .take(count)
        .collect();
        coefficients[0] = odd;
        Bernstein::with_error(&degrees, coefficients, error).unwrap_or_else(|_| Bernstein::constant(degrees.len(), odd))
    })
}

fn enclosure() -> impl Strategy<Value = Enclosure> {
    prop_oneof![
        3 => Just(Enclosure::UNIT),
        1 => (number(), number()).prop_map(|(a, b)| Enclosure::hull(a, b)),
    ]
}

/// Few boxes: what matters is that nothing panics.
fn options() -> SolveOptions {
    SolveOptions::default().boxes(50)
}

proptest! {
    #[test]
    fn enclosures_bound_something(a in number(), b in number(), x in number()) {
        match Enclosure::new(a, b) {
            Ok(e) => prop_assert!(a <= b && e.lo() == a && e.hi() == b),
            Err(error) => prop_assert!(a > b || a.is_nan() || b.is_nan(), "{error}"),
        }
        let hull = Enclosure::hull(a, b);
        prop_assert!(hull.lo() <= hull.hi());
        prop_assert!([a, b].iter().all(|x| x.is_nan() || hull.contains(*x)));
        if let Some(both) = hull.intersection(Enclosure::UNIT) {
            prop_assert!(both.lo() <= both.hi());
            prop_assert_eq!(both.contains(x), hull.contains(x) && Enclosure::UNIT.contains(x));
        }
    }

    #[test]
    fn systems_of_anything_are_solved_or_refused(
        forms in collection::vec(form(), 0..4),
        domain in collection::vec(enclosure(), 0..5),
        region in collection::vec(enclosure(), 0..5),
        remainders in (number(), number()),
        smallest in number(),
        tolerance in number(),
    ) {
        let equations = forms.iter().map(|f| Equation::from(f).with_remainder(remainders.0, remainders.1));
        let bad = options().smallest(smallest);
        for system in [System::mapped(&domain, equations), System::mapped(&domain, &forms)] {
            let Ok(system) = system else { continue };
            for system in [Ok(system.clone()), system.within(&region)].into_iter().flatten() {
                for options in [options(), bad.clone()] {
                    let _ = PointSolver::new(options.clone()).solve(&system, &());
                    let _ = CurveSolver::with_options(tolerance, options.clone()).solve(&system, &());
                    let _ = SurfaceSolver::with_options(tolerance, options).solve(&system, &());
                }
            }
        }
    }

    #[test]
    fn expressions_of_anything_are_solved_or_refused(
        a in form(), b in form(), c in number(), domain in collection::vec(enclosure(), 1..4),
    ) {
        let (a, b) = (Expression::from(a), Expression::from(b));
        let whole = (a.clone() + b.clone() * c) / (b - a * c);
        if let Ok(system) = System::mapped(&domain, [whole]) {
            let _ = PointSolver::new(options()).solve(&system, &());
        }
    }

    #[test]
    fn charts_with_any_limits_end(
        smallest in number(), accept in number(), boxes in 0..60_u64, targets in collection::vec([number(), number()], 0..5),
    ) {
        let options = ChartOptions::default().boxes(boxes).smallest(smallest).accept(accept);
        let targets = List(targets);
        let mut answer = Answer::default();
        ChartSolver::new(options).solve(&mut Fold, [Enclosure::UNIT; 2], &targets, &mut answer, &());
        let (x, y) = (Bernstein::variable(2, 0), Bernstein::variable(2, 1));
        let one = Bernstein::constant(2, 1.0);
        let bundle = Bundle::new(vec![x.mul(&x).add(&y), x.mul(&y)], &one, vec![]).unwrap();
        BundleSolver::new(options).solve(&bundle, &Fold, &targets, &mut answer, &());
        prop_assert!(answer.found.iter().all(|found| targets.0[found.target].iter().all(|q| q.is_finite())));
    }

    #[test]
    fn bundles_of_anything_are_made_or_refused(
        numerators in collection::vec(form(), 0..4),
        zeros in collection::vec(form(), 0..4),
        weight in form(),
        (first, second) in (form(), form()),
    ) {
        if let Ok(bundle) = Bundle::<2>::new(numerators.clone(), &weight, zeros.clone()) {
            let _ = bundle.vanishes();
            let _ = bundle.where_signs_differ(first.clone(), second.clone());
        }
        if let Ok(bundle) = Bundle::<3>::new(numerators, &weight, zeros) {
            let _ = bundle.where_signs_differ(first, second);
        }
    }
}

#[test]
fn no_splines_make_no_system() {
    assert!(Pieces::new(&[]).is_err());
}
