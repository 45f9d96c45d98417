//! Budgets, cancellation and degenerate equations of curves and surfaces: what is left is named and covers what is lost.

use std::time::{Duration, Instant};
use sweepsim_solve::{Cause, CurveSolver, Curves, Enclosure, Monitor, SolveOptions, Surface, SurfaceSolver, System};
use sweepsim_spline::Bernstein;

fn unit(n: usize) -> Vec<Enclosure> {
    vec![Enclosure::UNIT; n]
}

/// `Σ (xⱼ − 1/2)² − r²`.
fn ball(n: usize, r: f64) -> Bernstein {
    (0..n).fold(Bernstein::constant(n, -r * r), |sum, j| {
        let x = Bernstein::variable(n, j).sub(&Bernstein::constant(n, 0.5));
        sum.add(&x.mul(&x))
    })
}

struct Stop;

impl Monitor for Stop {
    fn cancelled(&self) -> bool {
        true
    }
}

/// Options that end the search early, with the cause that they lead to.
fn early(base: &SolveOptions) -> Vec<(SolveOptions, Cause)> {
    let options = || base.clone();
    vec![
        (options().boxes(5), Cause::Boxes),
        (options().boxes(0), Cause::Boxes),
        (options().time(Some(Duration::ZERO)), Cause::Time),
    ]
}

/// Two ovals, two balls: nested, so that a search takes some dozens of boxes.
fn nested(n: usize) -> System {
    System::new(&unit(n), [ball(n, 0.37).mul(&ball(n, 0.33)).assumed_exact()]).unwrap()
}

fn curve_covered(curves: &Curves, what: &str) {
    for radius in [0.37, 0.33] {
        for k in 0..90 {
            let angle = f64::from(k) * std::f64::consts::TAU / 90.0;
            let p = [0.5 + radius * angle.cos(), 0.5 + radius * angle.sin()];
            let open = curves
                .singular
                .iter()
                .any(|s| s.bounds.iter().zip(p).all(|(b, x)| b.contains(x)));
            let near = |q: &sweepsim_solve::CurvePoint| (q.point[0] - p[0]).hypot(q.point[1] - p[1]) < 0.1;
            assert!(
                open || curves.curves.iter().any(|c| c.points.iter().any(near)),
                "{what}: {p:?}"
            );
        }
    }
}

#[test]
fn curves_keep_to_their_budgets() {
    let system = nested(2);
    let base = CurveSolver::new(1e-3).options;
    for (options, cause) in early(&base) {
        let curves = CurveSolver::with_options(1e-3, options).solve(&system, &()).unwrap();
        let named = curves.singular.iter().any(|s| s.cause == cause);
        // The time may already end the search on a face.
        assert!(named, "{cause}: {:?}", curves.singular);
        curve_covered(&curves, &cause.to_string());
    }
    let curves = CurveSolver::new(1e-3).solve(&system, &Stop).unwrap();
    assert!(curves.singular.iter().any(|s| s.cause == Cause::Cancelled));
    curve_covered(&curves, "cancelled");
    let all = CurveSolver::new(1e-3).solve(&system, &()).unwrap();
    assert_eq!((all.loops().count(), all.singular.len()), (2, 0));
}

#[test]
fn surfaces_keep_to_their_budgets() {
    let system = nested(3);
    let base = SurfaceSolver::new(0.05).options;
    let covered = |surface: &Surface, what: &str| {
        for k in 0..400 {
            // Points of Fibonacci's spiral.
            let z = 1.0 - (2.0 * f64::from(k) + 1.0) / 400.0;
            let angle = f64::from(k) * 2.399_963;
            let flat = (1.0 - z * z).sqrt();
            for radius in [0.37, 0.33] {
                let p = [flat * angle.cos(), flat * angle.sin(), z].map(|x| 0.5 + radius * x);
                let open = surface
                    .unresolved
                    .iter()
                    .any(|u| u.bounds.iter().zip(p).all(|(b, x)| b.contains(x)));
                let near = |v: &[f64; 3]| v.iter().zip(p).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt() < 0.2;
                assert!(open || surface.vertices.iter().any(near), "{what}: {p:?}");
            }
        }
    };
    for (options, cause) in early(&base) {
        let surface = SurfaceSolver::with_options(0.05, options).solve(&system, &()).unwrap();
        assert!(surface.unresolved.iter().any(|u| u.cause == cause), "{cause}");
        covered(&surface, &cause.to_string());
    }
    let surface = SurfaceSolver::new(0.05).solve(&system, &Stop).unwrap();
    assert!(surface.unresolved.iter().any(|u| u.cause == Cause::Cancelled));
    covered(&surface, "cancelled");
}

#[test]
fn equations_that_are_zero_up_to_rounding_do_not_flood() {
    let start = Instant::now();
    for n in [2, 3] {
        let degrees = vec![2; n];
        let mut sign = 1.0;
        let tiny = Bernstein::from_fn(&degrees, |_| {
            sign = -sign;
            sign * 1e-17
        })
        .unwrap();
        let noise = Bernstein::with_error(&degrees, tiny.coefficients().to_vec(), 1e-16).unwrap();
        for form in [Bernstein::constant(n, 0.0), noise] {
            let system = System::new(&unit(n), [form]).unwrap();
            if n == 2 {
                let curves = CurveSolver::new(1e-2).solve(&system, &()).unwrap();
                assert!(curves.curves.is_empty() && !curves.singular.is_empty());
                assert!(curves.singular.len() < 20, "{}", curves.singular.len());
            } else {
                let surface = SurfaceSolver::new(1e-1).solve(&system, &()).unwrap();
                assert!(surface.triangles.is_empty() && !surface.unresolved.is_empty());
                assert!(surface.unresolved.len() < 20, "{}", surface.unresolved.len());
            }
        }
    }
    assert!(start.elapsed() < Duration::from_secs(30), "{:?}", start.elapsed());
}
