//! On several threads: the same roots as on one, and the same answer for any number of threads.
#![cfg(feature = "rayon")]

use crate::support;

use support::planted::{Random, audit, case};
use sweepsim_solve::{Cause, Enclosure, Monitor, PointSolver, System};

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
