//! Expressions that are never expanded have the solutions of the expanded ones.

use crate::support;

use support::planted::Random;
use sweepsim_solve::{
    CurveSolver, Enclosure, Equation, Expression, MAX_FORMS, PointSolver, Points, SurfaceSolver, System, SystemError,
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
    assert!(points.unresolved.iter().all(|u| u.bounds[0].radius() < 1e-9));
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
    let many = (0..MAX_FORMS).fold(x(), |e, _| e + x());
    let error = System::new(&unit(1), [many]).unwrap_err();
    assert_eq!(error, SystemError::TooManyForms { equation: 0 });
    // Too deep: 1 + (1 + (1 + …)).
    let deep = (0..40).fold(x(), |e, _| Expression::constant(1.0) + e);
    let error = System::new(&unit(1), [deep]).unwrap_err();
    assert_eq!(error, SystemError::TooManyForms { equation: 0 });
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
    // Division by zero, everywhere: open, not a panic.
    let points = solve(vec![x() / Expression::constant(0.0)]);
    assert!(points.roots.is_empty() && !points.unresolved.is_empty());
}
