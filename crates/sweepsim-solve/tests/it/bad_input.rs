//! Bad and degenerate input: structured errors or open boxes, never a panic, a hang or a flood.

use std::time::{Duration, Instant};
use sweepsim_solve::{
    Cause, Enclosure, Equation, Monitor, PointSolver, SolveError, SolveOptions, System, SystemError, UnresolvedBox,
};
use sweepsim_spline::Bernstein;

fn unit(n: usize) -> Vec<Enclosure> {
    vec![Enclosure::UNIT; n]
}

fn solve(forms: &[Bernstein]) -> sweepsim_solve::Points {
    let start = Instant::now();
    let system = System::new(&unit(forms.len()), forms).unwrap();
    let points = PointSolver::default().solve(&system, &()).unwrap();
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", points.statistics);
    let most = SolveOptions::default().unresolved;
    assert!(
        points.unresolved.len() <= most,
        "{} open boxes",
        points.unresolved.len()
    );
    points
}

#[test]
fn domains_are_checked() {
    let x = Bernstein::variable(1, 0);
    for (lo, hi) in [
        (0.0, 0.0),
        (1.0, 0.0),
        (f64::NAN, 1.0),
        (0.0, f64::NAN),
        (f64::NEG_INFINITY, 0.0),
        (-f64::MAX, f64::MAX),
        (1e17, 1e17 + 16.0),
    ] {
        let Ok(side) = Enclosure::new(lo, hi) else {
            assert!(lo > hi || lo.is_nan() || hi.is_nan(), "{lo} {hi}");
            continue;
        };
        let bad = System::mapped(&[side], [&x]);
        assert_eq!(bad.unwrap_err(), SystemError::Domain { variable: 0 }, "{lo} {hi}");
    }
}

#[test]
fn remainders_are_checked() {
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let equation = Equation::from(Bernstein::variable(1, 0)).with_remainder(bad, 0.0);
        assert_eq!(
            System::new(&unit(1), [equation]).unwrap_err(),
            SystemError::NotFinite { equation: 0 }
        );
    }
    let empty = Equation::sum(Vec::new());
    assert_eq!(
        System::new(&unit(1), [empty]).unwrap_err(),
        SystemError::EmptySum { equation: 0 }
    );
}

#[test]
fn counts_are_checked() {
    let system = System::new(&unit(2), [Bernstein::variable(2, 0)]).unwrap();
    let error = PointSolver::default().solve(&system, &()).unwrap_err();
    assert_eq!(
        error,
        SolveError::Equations {
            equations: 1,
            variables: 2,
            expected: 2
        }
    );
    let system = System::new(&unit(1), [Bernstein::variable(1, 0)]).unwrap();
    for smallest in [0.0, -1.0, f64::NAN, 2.0] {
        let mut solver = PointSolver::new(SolveOptions::default().smallest(smallest));
        assert_eq!(solver.solve(&system, &()).unwrap_err(), SolveError::Smallest);
    }
    let nine = vec![Enclosure::UNIT; 9];
    let error = System::new(&nine, [Bernstein::variable(9, 0)]).unwrap_err();
    assert_eq!(error, SystemError::Variables { variables: 9 });
}

#[test]
fn an_equation_that_is_zero_leaves_the_box_open() {
    let zero = Bernstein::constant(2, 0.0);
    let points = solve(&[
        zero.clone(),
        Bernstein::variable(2, 1).sub(&Bernstein::constant(2, 0.5)),
    ]);
    assert!(points.roots.is_empty());
    assert_eq!(points.unresolved.len(), 1);
    assert_eq!(points.unresolved[0].cause, Cause::Vanishing);
    // Zero up to its stated error.
    let noise = Bernstein::with_error(&[1, 1], vec![1e-17, -1e-17, 1e-17, 0.0], 1e-16).unwrap();
    let points = solve(&[noise, Bernstein::variable(2, 1).sub(&Bernstein::constant(2, 0.5))]);
    assert_eq!(points.unresolved.len(), 1);
    // Zero, but the other equation has no root: nothing is open.
    let points = solve(&[zero, Bernstein::constant(2, 1.0)]);
    assert!(points.roots.is_empty() && points.unresolved.is_empty());
}

#[test]
fn a_continuum_does_not_flood() {
    // The same curve twice, a curve and its multiple, a curve and its square.
    let circle = Bernstein::from_fn(&[2, 2], |i| [0.25, -0.25, 0.25][i[0]] + [0.25, -0.25, 0.25][i[1]] - 0.1).unwrap();
    for other in [circle.clone(), circle.scale(-3.7), circle.mul(&circle)] {
        let points = solve(&[circle.clone(), other]);
        assert!(points.roots.is_empty());
        let local = |u: &UnresolvedBox| matches!(u.cause, Cause::Flood | Cause::Smallest | Cause::Vanishing);
        assert!(points.unresolved.iter().all(local));
        // Little else is: the boxes are no larger than a few parts in a hundred of the domain.
        assert!(
            points
                .unresolved
                .iter()
                .all(|u| u.bounds.iter().all(|b| b.radius() < 0.03))
        );
        // The circle is covered.
        for k in 0..64 {
            let angle = f64::from(k) * std::f64::consts::TAU / 64.0;
            let radius = 0.1f64.sqrt();
            let p = [0.5 + radius * angle.cos(), 0.5 + radius * angle.sin()];
            let near = |b: &Enclosure, x: f64| b.lo() - 1e-9 <= x && x <= b.hi() + 1e-9;
            assert!(
                points
                    .unresolved
                    .iter()
                    .any(|u| u.bounds.iter().zip(p).all(|(b, x)| near(b, x)))
            );
        }
    }
}

#[test]
fn budgets_hold_and_name_what_is_left() {
    struct Stop;
    impl Monitor for Stop {
        fn cancelled(&self) -> bool {
            true
        }
    }
    let wave = |axis: usize| {
        let factor = |k: u32| {
            let root = Bernstein::constant(2, (f64::from(k) + 0.5) / 6.0);
            Bernstein::variable(2, axis).sub(&root).scale(6.0)
        };
        (1..6).fold(factor(0), |p, k| p.mul(&factor(k)))
    };
    let mixed = [wave(0).add(&wave(1).scale(0.01)), wave(1).sub(&wave(0).scale(0.02))];
    let system = System::new(&unit(2), &mixed).unwrap();
    let all = PointSolver::default().solve(&system, &()).unwrap();
    assert!(all.roots.len() > 30 && all.unresolved.is_empty());
    let limited = |options: SolveOptions, cause: Cause, monitor: &dyn Monitor| {
        let points = PointSolver::new(options).solve(&system, monitor).unwrap();
        assert!(points.unresolved.iter().any(|u| u.cause == cause), "{cause}");
        for root in &all.roots {
            let found = points.roots.iter().any(|r| r.point == root.point);
            let open = points
                .unresolved
                .iter()
                .any(|u| u.bounds.iter().zip(&root.point).all(|(b, x)| b.contains(*x)));
            assert!(found || open, "{cause}: {:?} lost", root.point);
        }
    };
    let options = SolveOptions::default;
    limited(options().boxes(20), Cause::Boxes, &());
    limited(options().depth(3), Cause::Depth, &());
    limited(options().time(Some(Duration::ZERO)), Cause::Time, &());
    limited(options(), Cause::Cancelled, &Stop);
}

#[test]
fn a_domain_of_few_numbers_says_so() {
    let far = |units: f64| [Enclosure::new(1.0, 1.0 + units * f64::EPSILON).unwrap()];
    let parse = |units| System::parse(&["x = 1"], &["x"], &far(units));
    assert!(parse(66.0).is_ok());
    let error = parse(60.0).unwrap_err().to_string();
    assert!(
        error.contains("side 0") && error.contains("64 units in the last place"),
        "{error}"
    );
}
