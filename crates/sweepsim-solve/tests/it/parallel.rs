//! On several threads: the same roots as on one, and the same answer for any number of threads.
#![cfg(feature = "rayon")]

use crate::support;

use support::planted::{Random, audit, case};
use sweepsim_solve::{Cause, CurveSolver, Enclosure, Monitor, PointSolver, SurfaceSolver, System};

struct Stop;

impl Monitor for Stop {
    fn cancelled(&self) -> bool {
        true
    }
}

fn in_pool<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(work)
}

#[test]
fn threads_change_no_answer() {
    let mut random = Random(9);
    let mut roots = 0;
    for number in 0..60 {
        let n = 1 + number % 3;
        let points: Vec<Vec<f64>> = (0..4 - n)
            .map(|_| (0..n).map(|_| random.coordinate()).collect())
            .collect();
        let case = case(&points, &mut random);
        let system = System::new(&vec![Enclosure::UNIT; n], &case.forms).unwrap();
        let solve = |threads| in_pool(threads, || PointSolver::default().solve_parallel(&system, &()).unwrap());
        let [one, two, five] = [1, 2, 5].map(solve);
        assert_eq!(one, two, "{number}");
        assert_eq!(one, five, "{number}");
        audit(&case, &one, &number.to_string());
        let serial = PointSolver::default().solve(&system, &()).unwrap();
        assert_eq!(serial.roots.len(), one.roots.len(), "{number}");
        roots += one.roots.len();
    }
    assert!(roots > 60, "{roots}");
}

#[test]
fn stopping_leaves_boxes_open() {
    let mut random = Random(10);
    let points: Vec<Vec<f64>> = (0..5).map(|_| vec![random.unit(), random.unit()]).collect();
    let case = case(&points, &mut random);
    let system = System::new(&[Enclosure::UNIT; 2], &case.forms).unwrap();
    let stopped = PointSolver::default().solve_parallel(&system, &Stop).unwrap();
    assert!(stopped.unresolved.iter().any(|u| u.cause == Cause::Cancelled));
    audit(&case, &stopped, "stopped");
}

const CURVES: [&str; 6] = [
    "x^2 + y^2 = 1",
    "(x^2 + y^2)^2 = x^2 - y^2",
    "y^2 = x^3",
    "(x^2 + y^2 - 1)*(x^2 + 4*y^2 - 2)",
    "8*x^4 - 8*x^2 = 8*y^4 - 8*y^2 + 0.01",
    "sin(3*x)*cos(2*y) = 0.2",
];

#[test]
fn threads_change_no_curve() {
    for text in CURVES {
        let domain = [Enclosure::new(-2.0, 2.1).unwrap(); 2];
        let system = System::parse(&[text], &["x", "y"], &domain).unwrap();
        let solver = || CurveSolver::new(1e-4);
        let one = in_pool(1, || solver().solve_parallel(&system, &()).unwrap());
        for threads in [2, 5] {
            let many = in_pool(threads, || solver().solve_parallel(&system, &()).unwrap());
            assert_eq!(one, many, "{text}, {threads} threads");
        }
        let serial = solver().solve(&system, &()).unwrap();
        assert_eq!(
            (&serial.curves, &serial.singular),
            (&one.curves, &one.singular),
            "{text}"
        );
        assert!(!serial.curves.is_empty());
    }
    let system = System::parse(
        &["x^2 + y^2 = 1"],
        &["x", "y"],
        &[Enclosure::new(-2.0, 2.1).unwrap(); 2],
    )
    .unwrap();
    let cubic = in_pool(3, || {
        CurveSolver::new(1e-9).cubics().solve_parallel(&system, &()).unwrap()
    });
    assert_eq!(
        cubic.curves,
        CurveSolver::new(1e-9).cubics().solve(&system, &()).unwrap().curves
    );
    let stopped = CurveSolver::new(1e-4).solve_parallel(&system, &Stop).unwrap();
    assert!(stopped.singular.iter().any(|s| s.cause == Cause::Cancelled));
}

#[test]
fn threads_change_no_surface() {
    for (text, euler) in [
        ("x^2 + y^2 + z^2 = 1", 2),
        ("(x^2 + y^2 + z^2 + 0.75)^2 = 4*(x^2 + y^2)", 0),
        ("sin(2*x) + y^2 + z^2 = 0.5", 2),
    ] {
        let domain = [(-1.7, 1.6), (-1.6, 1.8), (-1.5, 1.7)].map(|(lo, hi)| Enclosure::new(lo, hi).unwrap());
        let system = System::parse(&[text], &["x", "y", "z"], &domain).unwrap();
        let solver = || SurfaceSolver::new(0.1);
        let one = in_pool(1, || solver().solve_parallel(&system, &()).unwrap());
        for threads in [2, 5] {
            let many = in_pool(threads, || solver().solve_parallel(&system, &()).unwrap());
            assert_eq!(one, many, "{text}, {threads} threads");
        }
        let serial = solver().solve(&system, &()).unwrap();
        assert_eq!(serial.vertices.len(), one.vertices.len(), "{text}");
        let sorted = |s: &sweepsim_solve::Surface| {
            let mut v = s.vertices.clone();
            v.sort_by(|a, b| a.partial_cmp(b).unwrap());
            v
        };
        assert_eq!(sorted(&serial), sorted(&one), "{text}");
        if text.starts_with(['x', '(']) {
            assert_eq!((one.euler_characteristic(), one.unresolved.len()), (euler, 0), "{text}");
        }
    }
    let system = System::parse(
        &["x^2 + y^2 + z^2 = 1"],
        &["x", "y", "z"],
        &[Enclosure::new(-1.7, 1.6).unwrap(); 3],
    )
    .unwrap();
    let stopped = SurfaceSolver::new(0.1).solve_parallel(&system, &Stop).unwrap();
    assert!(stopped.unresolved.iter().any(|u| u.cause == Cause::Cancelled));
}
