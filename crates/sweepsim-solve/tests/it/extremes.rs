//! High degrees, many variables, tight clusters, extreme scales: nothing is lost, nothing panics.

use crate::support;

use support::expression::{Polynomial, exact};
use sweepsim_solve::{CurveSolver, Enclosure, Equation, PointSolver, Points, System};
use sweepsim_spline::Bernstein;

fn unit(n: usize) -> Vec<Enclosure> {
    vec![Enclosure::UNIT; n]
}

fn solve(system: &System) -> Points {
    PointSolver::default().solve(system, &()).unwrap()
}

/// `Π (x − rₖ)` as an exact polynomial in variable `axis` of `n`.
fn product(roots: &[f64], axis: usize, n: usize) -> Polynomial {
    let one = Polynomial::constant(exact(1.0), n);
    roots.iter().fold(one, |p, r| {
        let factor = Polynomial::variable(axis, n).add(&Polynomial::constant(-exact(*r), n));
        p.mul(&factor)
    })
}

#[test]
fn high_degrees_lose_no_root() {
    for degree in [8, 16, 24, 32, 48, 63] {
        let roots: Vec<f64> = (0..degree).map(|k| (f64::from(k) + 0.5) / f64::from(degree)).collect();
        let form = product(&roots, 0, 1).bernstein(&unit(1));
        let found = solve(&System::new(&unit(1), [&form]).unwrap());
        for r in &roots {
            let certified = found.roots.iter().filter(|x| x.enclosure[0].contains(*r)).count();
            let open = found.unresolved.iter().filter(|u| u.bounds[0].contains(*r)).count();
            assert!(certified + open >= 1 && certified <= 1, "degree {degree}: {r}");
        }
        println!(
            "degree {degree}: {} certified, {} open",
            found.roots.len(),
            found.unresolved.len()
        );
        // Bernstein coefficients of such products are well conditioned for a while.
        assert!(degree > 24 || found.roots.len() == roots.len(), "{degree}");
    }
}

#[test]
fn clusters_of_simple_roots_are_told_apart() {
    for spacing in [1e-2, 1e-3, 1e-4, 1e-5] {
        let roots = [0.5 - spacing, 0.5, 0.5 + spacing];
        let forms = [0, 1].map(|axis| product(&roots, axis, 2).bernstein(&unit(2)));
        let found = solve(&System::new(&unit(2), &forms).unwrap());
        assert_eq!(
            (found.roots.len(), found.unresolved.len()),
            (9, 0),
            "{spacing} {:?} {:?}",
            found.unresolved,
            found.statistics
        );
    }
}

#[test]
fn eight_unknowns() {
    // (xᵢ − 0.3)(xᵢ − 0.8) + 0.01 xᵢ₊₁ xᵢ₊₂ = 0: near each of 2⁸ corners one root.
    let n = 8;
    let equations: Vec<Equation> = (0..n)
        .map(|i| {
            let factors = [(i + 1) % n, (i + 2) % n].map(|j| Polynomial::variable(j, n));
            let coupling = factors[0].mul(&factors[1]).scale(&exact(0.01));
            product(&[0.3, 0.8], i, n).add(&coupling).equation(&unit(n))
        })
        .collect();
    let found = solve(&System::new(&unit(n), equations).unwrap());
    assert_eq!(
        (found.roots.len(), found.unresolved.len()),
        (256, 0),
        "{:?}",
        found.statistics
    );
}

#[test]
fn scales_do_not_matter() {
    let circle = Bernstein::from_fn(&[2, 2], |i| [0.25, -0.25, 0.25][i[0]] + [0.25, -0.25, 0.25][i[1]] - 0.1).unwrap();
    let line = Bernstein::variable(2, 0)
        .sub(&Bernstein::variable(2, 1))
        .assumed_exact();
    for (a, b) in [(1e-300, 1e300), (1e-160, 1e-160), (5e-290, 3.0), (1e307, 1e307)] {
        let forms = [circle.scale(a).assumed_exact(), line.scale(b).assumed_exact()];
        for bounds in [[1e-200, 1e-200], [1e150, 1e-150], [1.0, 1e8]] {
            let domain = bounds.map(|w: f64| Enclosure::new(-w, w).unwrap());
            let found = solve(&System::mapped(&domain, &forms).unwrap());
            assert_eq!(
                (found.roots.len(), found.unresolved.len()),
                (2, 0),
                "{a} {b} {bounds:?}"
            );
        }
        let curve = System::new(&unit(2), [&forms[0]]).unwrap();
        let curves = CurveSolver::new(1e-2).solve(&curve, &()).unwrap();
        assert_eq!((curves.loops().count(), curves.curves.len()), (1, 1));
    }
}

#[test]
fn constants_and_linear_systems() {
    let constant = System::new(&unit(1), [&Bernstein::constant(1, 3.0)]).unwrap();
    assert!(solve(&constant).roots.is_empty());
    // An infinite coefficient sum of tiny and huge: 1e-16 x − 1e-17.
    let small = Bernstein::new(&[1], vec![-1e-17, 9e-17]).unwrap();
    let found = solve(&System::new(&unit(1), [&small]).unwrap());
    assert_eq!(found.roots.len(), 1);
    assert!(found.roots[0].enclosure[0].contains(0.1));
    // All of an equation's weight at one corner.
    let corner = Bernstein::from_fn(&[5, 5], |i| if i == [0, 0] { 1.0 } else { -1e-12 }).unwrap();
    let other = Bernstein::variable(2, 0)
        .sub(&Bernstein::variable(2, 1).scale(0.7))
        .assumed_exact();
    let found = solve(&System::new(&unit(2), [&corner, &other]).unwrap());
    assert_eq!((found.roots.len(), found.unresolved.len()), (1, 0), "{found:?}");
}
