//! Expressions that are never expanded have the solutions of the expanded ones.

use crate::support;

use std::f64::consts::{FRAC_PI_4, LN_2, PI, TAU};
use support::planted::Random;
use sweepsim_solve::{
    Cause, CurveSolver, Enclosure, Equation, Expression, MAX_STEPS, PointSolver, Points, SurfaceSolver, System,
    SystemError,
};
use sweepsim_spline::Bernstein;

fn unit(n: usize) -> Vec<Enclosure> {
    vec![Enclosure::UNIT; n]
}

fn solve<E: Into<Equation>>(equations: Vec<E>) -> Points {
    let system = System::new(&unit(equations.len()), equations).unwrap();
    PointSolver::default().solve(&system, &()).unwrap()
}

/// Roots match one to one, by enclosures.
fn same(a: &Points, b: &Points, what: &str) {
    assert_eq!(a.roots.len(), b.roots.len(), "{what}");
    assert!(
        a.unresolved.is_empty() && b.unresolved.is_empty(),
        "{what}: {a:?} {b:?}"
    );
    for root in &a.roots {
        let meets = |other: &&sweepsim_solve::Root| {
            let mut sides = root.enclosure.iter().zip(&other.enclosure);
            sides.all(|(x, y)| x.lo() <= y.hi() && y.lo() <= x.hi())
        };
        assert_eq!(b.roots.iter().filter(meets).count(), 1, "{what}: {root:?}");
        assert!(
            b.roots.iter().find(meets).unwrap().orientation == root.orientation,
            "{what}"
        );
    }
}

fn form(degrees: &[usize], random: &mut Random, lo: f64, hi: f64) -> Bernstein {
    Bernstein::from_fn(degrees, |_| lo + (hi - lo) * random.unit()).unwrap()
}

#[test]
fn products_and_sums_have_the_roots_of_the_expanded() {
    let mut random = Random(21);
    let mut roots = 0;
    for number in 0..100 {
        let f: Vec<Bernstein> = (0..6).map(|_| form(&[2, 2], &mut random, -1.0, 1.0)).collect();
        let expanded = vec![f[0].mul(&f[1]).add(&f[2]), f[3].mul(&f[4]).sub(&f[5].scale(0.5))];
        let e: Vec<Expression> = f.iter().map(Expression::from).collect();
        let kept = vec![
            e[0].clone() * e[1].clone() + e[2].clone(),
            e[3].clone() * e[4].clone() - e[5].clone() * 0.5,
        ];
        let (expanded, kept) = (solve(expanded), solve(kept));
        same(&kept, &expanded, &number.to_string());
        roots += kept.roots.len();
    }
    assert!(roots > 50, "{roots}");
}

#[test]
fn quotients_need_no_common_denominator() {
    let mut random = Random(22);
    let mut roots = 0;
    for number in 0..100 {
        let mut pair = || {
            let top = form(&[2, 2], &mut random, -1.0, 1.0);
            (top, form(&[2, 2], &mut random, 0.5, 1.5))
        };
        let (a, b, c, d) = (pair(), pair(), pair(), pair());
        // a/a' + b/b' = 0.1 and c/c' = d/d'.
        let common = a.0.mul(&b.1).add(&b.0.mul(&a.1)).sub(&a.1.mul(&b.1).scale(0.1));
        let expanded = vec![common, c.0.mul(&d.1).sub(&d.0.mul(&c.1))];
        let quotient = |p: &(Bernstein, Bernstein)| Expression::from(&p.0) / Expression::from(&p.1);
        let kept = vec![
            quotient(&a) + quotient(&b) - Expression::constant(0.1),
            quotient(&c) - quotient(&d),
        ];
        let (expanded, kept) = (solve(expanded), solve(kept));
        same(&kept, &expanded, &number.to_string());
        roots += kept.roots.len();
    }
    assert!(roots > 50, "{roots}");
}

#[test]
fn curves_and_surfaces_of_products_have_their_topology() {
    let ball = |n: usize, centre: f64, r: f64| {
        (0..n).fold(Bernstein::constant(n, -r * r), |sum, j| {
            let x = Bernstein::variable(n, j).sub(&Bernstein::constant(n, centre));
            sum.add(&x.mul(&x))
        })
    };
    // Two circles apart, never multiplied out; two nested spheres; a sphere as a quotient.
    let circles = Expression::from(ball(2, 0.3, 0.2)) * Expression::from(ball(2, 0.7, 0.25));
    let system = System::new(&unit(2), [circles]).unwrap();
    let curves = CurveSolver::new(1e-3).solve(&system, &()).unwrap();
    assert_eq!((curves.loops().count(), curves.curves.len()), (2, 2));
    assert!(curves.singular.is_empty());
    let spheres = Expression::from(ball(3, 0.5, 0.2)) * Expression::from(ball(3, 0.5, 0.4));
    let system = System::new(&unit(3), [spheres]).unwrap();
    let surface = SurfaceSolver::new(0.1).solve(&system, &()).unwrap();
    assert_eq!((surface.euler_characteristic(), surface.components()), (4, 2));
    assert!(surface.unresolved.is_empty());
    let weight = Bernstein::constant(3, 1.0).add(&Bernstein::variable(3, 2));
    let sphere = Expression::from(ball(3, 0.5, 0.3)) / Expression::from(weight);
    let system = System::new(&unit(3), [sphere]).unwrap();
    let surface = SurfaceSolver::new(0.1).solve(&system, &()).unwrap();
    assert_eq!((surface.euler_characteristic(), surface.components()), (2, 1));
    assert!(surface.unresolved.is_empty());
}

#[test]
fn poles_are_no_roots() {
    let pole = || Expression::from(Bernstein::variable(1, 0).sub(&Bernstein::constant(1, 0.3)));
    // 1/(x − 0.3) changes sign at 0.3 without a root.
    let points = solve(vec![Expression::constant(1.0) / pole()]);
    assert!(points.roots.is_empty());
    assert!(points.unresolved.iter().all(|u| u.bounds[0].contains(0.3)));
    // 1/(x − 0.3) = 2 at 0.8, besides.
    let points = solve(vec![Expression::constant(1.0) / pole() - Expression::constant(2.0)]);
    assert_eq!(points.roots.len(), 1);
    assert!(points.roots[0].enclosure[0].contains(0.8));
    assert!(points.unresolved.is_empty());
}

#[test]
fn remainders_count_within_expressions() {
    // x + r(x) with |r| ≤ 0.01, times 3, equal to 1.5: the root is within 0.01 of 0.5.
    let x = Equation::from(Bernstein::variable(1, 0)).with_remainder(0.01, 0.05);
    let points = solve(vec![Expression::from(x) * 3.0 - Expression::constant(1.5)]);
    assert_eq!((points.roots.len(), points.unresolved.len()), (1, 0));
    let enclosure = points.roots[0].enclosure[0];
    assert!(enclosure.lo() <= 0.49 && enclosure.hi() >= 0.51 && enclosure.radius() < 0.011);
    let whole = Expression::from(Bernstein::variable(1, 0)) * 3.0 - Expression::constant(1.5);
    let points = solve(vec![Equation::from(whole).with_remainder(0.03, 0.15)]);
    assert_eq!((points.roots.len(), points.unresolved.len()), (1, 0));
    let enclosure = points.roots[0].enclosure[0];
    assert!(enclosure.lo() <= 0.49 && enclosure.hi() >= 0.51 && enclosure.radius() < 0.011);
}

#[test]
fn bad_expressions_are_errors() {
    let x = || Expression::from(Bernstein::variable(1, 0));
    let many = (0..MAX_STEPS).fold(x(), |e, _| -e);
    let error = System::new(&unit(1), [many]).unwrap_err();
    assert_eq!(
        error,
        SystemError::TooManySteps {
            equation: 0,
            steps: 2 * MAX_STEPS + 1
        }
    );
    let error = System::new(&unit(1), [x() * f64::NAN]).unwrap_err();
    assert_eq!(error, SystemError::NotFinite { equation: 0 });
    let plane = Expression::from(Bernstein::variable(2, 0)) + x();
    let error = System::new(&unit(1), [plane]).unwrap_err();
    assert_eq!(
        error,
        SystemError::FormVariables {
            equation: 0,
            variables: 2,
            expected: 1
        }
    );
    // Division by zero, everywhere: not defined anywhere, so nowhere zero.
    let points = solve(vec![x() / Expression::constant(0.0)]);
    assert!(points.roots.is_empty() && points.unresolved.is_empty());
}

#[test]
fn an_expression_has_as_many_forms_as_it_likes() {
    // Σ 1/(k + x), k = 1 … 40, in either of two variables: forty forms in each equation.
    let sum = |axis: usize| {
        (1..=40).fold(Expression::constant(-3.5), |sum, k| {
            let form = Bernstein::variable(2, axis).add(&Bernstein::constant(2, f64::from(k)));
            sum + Expression::constant(1.0) / Expression::from(form)
        })
    };
    let points = solve(vec![sum(0), sum(1)]);
    assert_eq!((points.roots.len(), points.unresolved.len()), (1, 0));
    let x = points.roots[0].point[0];
    let value: f64 = (1..=40).map(|k| 1.0 / (f64::from(k) + x)).sum();
    assert!((value - 3.5).abs() < 1e-14 && points.roots[0].point[1] == x);
    // A chain as deep as it is long, and a curve and a surface of ten forms.
    let chain = (0..200).fold(Expression::from(Bernstein::variable(1, 0)), |e, _| {
        Expression::constant(1.0) + Expression::constant(1.0) * e
    });
    let points = solve(vec![chain - Expression::constant(200.25)]);
    assert_eq!((points.roots.len(), points.unresolved.len()), (1, 0));
    assert!(points.roots[0].enclosure[0].contains(0.25));
    let ball = |n: usize| {
        (0..10).fold(Expression::constant(-0.09), |sum, k| {
            let x = Bernstein::variable(n, k % n).sub(&Bernstein::constant(n, 0.5));
            let share = if k % n == k { 1.0 } else { 0.1 };
            sum + Expression::from(x).powi(2) * share
        })
    };
    let curves = CurveSolver::new(1e-3)
        .solve(&System::new(&unit(2), [ball(2)]).unwrap(), &())
        .unwrap();
    assert_eq!(
        (curves.loops().count(), curves.curves.len(), curves.singular.len()),
        (1, 1, 0)
    );
    let surface = SurfaceSolver::new(0.1)
        .solve(&System::new(&unit(3), [ball(3)]).unwrap(), &())
        .unwrap();
    assert_eq!(
        (
            surface.euler_characteristic(),
            surface.components(),
            surface.unresolved.len()
        ),
        (2, 1, 0)
    );
}

#[test]
fn functions_are_solved_where_they_are_defined() {
    let x = || Expression::from(Bernstein::variable(1, 0));
    let c = Expression::constant;
    let third = 0.5f64.asin() / 10.0;
    let cases: [(Expression, Vec<f64>); 8] = [
        (
            (x() * 10.0).sin() - c(0.5),
            vec![third, PI / 10.0 - third, TAU / 10.0 + third, 3.0 * PI / 10.0 - third],
        ),
        (
            (x() * 10.0).cos(),
            (0..3).map(|k| (f64::from(k) + 0.5) * PI / 10.0).collect(),
        ),
        ((x() * 3.0).tan() - c(1.0), vec![FRAC_PI_4 / 3.0]),
        (x().exp() - c(2.0), vec![LN_2]),
        // Not defined on the left half.
        ((x() - c(0.5)).ln() + c(2.0), vec![0.5 + (-2.0f64).exp()]),
        ((x() - c(0.5)).sqrt() - c(0.25), vec![0.5625]),
        ((x() * 3.0).atan() - c(1.0), vec![1.0f64.tan() / 3.0]),
        ((x() - c(0.5)).powi(4) - c(1.0 / 256.0), vec![0.25, 0.75]),
    ];
    for (number, (expression, expected)) in cases.into_iter().enumerate() {
        let points = solve(vec![expression]);
        assert!(points.unresolved.is_empty(), "{number}: {:?}", points.unresolved);
        let found: Vec<f64> = points.roots.iter().map(|r| r.point[0]).collect();
        assert_eq!(found.len(), expected.len(), "{number}: {found:?} {expected:?}");
        for (a, b) in found.iter().zip(&expected) {
            assert!((a - b).abs() < 1e-14, "{number}: {a} {b}");
        }
    }
}

#[test]
fn nothing_is_certified_where_a_function_is_not_smooth() {
    let x = || Expression::from(Bernstein::variable(1, 0));
    // √(x − 0.3) ends at its zero.
    let points = solve(vec![(x() - Expression::constant(0.3)).sqrt()]);
    assert!(points.roots.is_empty() && points.unresolved.iter().any(|u| u.bounds[0].contains(0.3)));
    // (√x)² − 0.25, defined from 0 on.
    let shifted = (x() * 2.0 - Expression::constant(1.0)).sqrt().powi(2) - Expression::constant(0.25);
    let points = solve(vec![shifted]);
    assert_eq!((points.roots.len(), points.unresolved.len()), (1, 0));
    assert!(points.roots[0].enclosure[0].contains(0.625));
    // 1/(1/x) is x except at 0, where it is not defined.
    let one = || Expression::constant(1.0);
    let points = solve(vec![one() / (one() / (x() - Expression::constant(0.4)))]);
    assert!(points.roots.is_empty() && points.unresolved.iter().all(|u| u.bounds[0].contains(0.4)));
}

#[test]
fn solutions_at_the_end_of_a_functions_domain_are_named() {
    let unit = [Enclosure::new(-1.0, 2.0).unwrap(); 2];
    for (texts, at) in [
        (["sqrt(x) = 0", "y = 1/3"], [0.0, 1.0 / 3.0]),
        (["sqrt(x - 1/4) = y", "y = 0"], [0.25, 0.0]),
        (["sqrt(x) + sqrt(y) = 0", "x = y"], [0.0, 0.0]),
        (["x*ln(x) = 0", "y + x = 1/2"], [0.0, 0.5]),
    ] {
        let system = System::parse(&texts, &["x", "y"], &unit).unwrap();
        let points = PointSolver::default().solve(&system, &()).unwrap();
        let holds = |bounds: &[Enclosure]| bounds.iter().zip(at).all(|(b, x)| b.contains(x));
        let open: Vec<_> = points.unresolved.iter().filter(|u| holds(&u.bounds)).collect();
        assert_eq!(open.len(), 1, "{texts:?}: {points:?}");
        assert_eq!(open[0].cause, Cause::NotDifferentiable, "{texts:?}: {points:?}");
        assert!(open[0].bounds.iter().all(|b| b.radius() < 1e-6), "{texts:?}: {open:?}");
    }
}
