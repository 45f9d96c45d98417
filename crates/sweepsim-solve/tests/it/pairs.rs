//! Coefficients of two numbers each: what one number would round away.

use crate::support::expression::{Polynomial, exact};
use sweepsim_solve::{Enclosure, Equation, PointSolver, Points, System};

fn solve(equations: Vec<Equation>, n: usize) -> Points {
    let system = System::mapped(&vec![Enclosure::UNIT; n], equations).unwrap();
    PointSolver::default().solve(&system, &()).unwrap()
}

/// `a x + b y − c`.
fn plane(a: f64, b: f64, c: f64) -> Polynomial {
    Polynomial::variable(0, 2)
        .scale(&exact(a))
        .add(&Polynomial::variable(1, 2).scale(&exact(b)))
        .add(&Polynomial::constant(-exact(c), 2))
}

#[test]
fn a_grid_of_nine_roots_a_millionth_apart() {
    let gap = 2f64.powi(-20);
    let unit = [Enclosure::UNIT; 2];
    // Roots of x + y/4 and of y − x/4 are 1/2 + k gap, each for k = −1, 0, 1.
    let product = |a: f64, b: f64| {
        (-1..=1).fold(Polynomial::constant(exact(1.0), 2), |p, k| {
            p.mul(&plane(a, b, 0.5 + f64::from(k) * gap))
        })
    };
    let system = [product(1.0, 0.25), product(-0.25, 1.0)];
    let points = solve(system.iter().map(|p| p.pairs(&unit)).collect(), 2);
    assert_eq!((points.roots.len(), points.unresolved.len()), (9, 0), "{points:?}");
    for i in -1..=1 {
        for j in -1..=1 {
            // x + y/4 = s, y − x/4 = t: y = (4 t + s)/(17/4), x = s − y/4.
            let (s, t) = (0.5 + f64::from(i) * gap, 0.5 + f64::from(j) * gap);
            let y = (4.0 * t + s) * 4.0 / 17.0;
            let root = [s - y / 4.0, y];
            let near = |e: &[Enclosure]| {
                e.iter()
                    .zip(root)
                    .all(|(e, x)| e.lo() - 1e-15 <= x && x <= e.hi() + 1e-15)
            };
            assert_eq!(points.roots.iter().filter(|r| near(&r.enclosure)).count(), 1, "{i} {j}");
        }
    }
    // With one number each, the data do not determine nine roots; nothing is claimed, and the cluster is named.
    let rounded = solve(system.iter().map(|p| p.equation(&unit)).collect(), 2);
    assert!(rounded.roots.is_empty() && rounded.unresolved.len() == 1, "{rounded:?}");
    assert!(rounded.unresolved[0].bounds.iter().all(|b| b.radius() < 1e-4));
}

#[test]
fn wilkinson_with_pairs_is_complete() {
    for degree in [20, 30, 40] {
        let root = |k: u32| dashu_ratio::RBig::from(k) / dashu_ratio::RBig::from(degree + 1);
        let factor = |k: u32| Polynomial::variable(0, 1).add(&Polynomial::constant(-root(k), 1));
        let product = (1..=degree).fold(Polynomial::constant(exact(1.0), 1), |p, k| p.mul(&factor(k)));
        let points = solve(vec![product.pairs(&[Enclosure::UNIT])], 1);
        assert_eq!(
            (points.roots.len(), points.unresolved.len()),
            (degree as usize, 0),
            "{degree}"
        );
        for (k, found) in (1..=degree).zip(&points.roots) {
            let e = found.enclosure[0];
            assert!(exact(e.lo()) <= root(k) && root(k) <= exact(e.hi()), "{degree}: {k}");
        }
    }
}

#[test]
fn pairs_of_numbers_are_checked() {
    assert!(Equation::of_pairs(&[1], &[(0.0, 0.0)], 0.0).is_err());
    assert!(Equation::of_pairs(&[1], &[(0.0, f64::NAN), (1.0, 0.0)], 0.0).is_err());
    assert!(Equation::of_pairs(&[1], &[(0.0, 0.0), (f64::INFINITY, 0.0)], 0.0).is_err());
    // The parts may come in any order of size, and the smaller may be the larger of the two.
    let equation = Equation::of_pairs(&[1], &[(2f64.powi(-70), -0.25), (1e-30, 0.75)], 0.0).unwrap();
    let points = solve(vec![equation], 1);
    assert_eq!((points.roots.len(), points.unresolved.len()), (1, 0));
    assert!(points.roots[0].enclosure[0].contains(0.25 - 2f64.powi(-70)));
}
