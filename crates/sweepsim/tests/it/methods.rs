//! All methods give the same dexels; a sweep is what closed forms say.

use sweepsim::{Method, Monitor, Options, SweepError, sweep};
use sweepsim_dexel::{Dexels, End, Grid};
use sweepsim_motion::{Path, Pose, Profile, ProfileSegment, Tool, Turn};
use sweepsim_props::*;

fn pose(tip: [f64; 3], axis: [f64; 3]) -> Pose {
    Pose::new(tip, axis).unwrap()
}

fn tools() -> Vec<Tool> {
    let line = |to| ProfileSegment::Line { to };
    let form = Profile::new(
        [0.0, 0.0],
        vec![
            line([2.0, 0.0]),
            line([2.0, 2.0]),
            ProfileSegment::Arc {
                to: [8.0, 8.0],
                centre: [8.0, 2.0],
                turn: Turn::Cw,
            },
            line([8.0, 30.0]),
            line([0.0, 30.0]),
        ],
    )
    .unwrap();
    vec![
        Tool::ball(5.0, 30.0).unwrap(),
        Tool::flat(5.0, 30.0).unwrap(),
        Tool::bull(5.0, 1.0, 30.0).unwrap(),
        Tool::from_profile(form),
    ]
}

/// How steep a surface is: how far an end moves if the line or the surface does, up to what is stored of its normal.
fn steepness(end: &End) -> f64 {
    1.0 / (f64::from(end.normal[2].abs()) - 1e-4).max(1e-5)
}

/// Same numbers of intervals, ends within what two lines moved differently may differ by: a hundredth of it, and more
/// along walls.
fn assert_same(a: &Dexels, b: &Dexels, tolerance: f64) {
    for index in 0..a.grid().len() {
        let (p, q) = (a.at(index), b.at(index));
        assert_eq!(p.len(), q.len(), "dexel {:?}", a.grid().place(index));
        for (p, q) in p.iter().zip(q) {
            for (a, b) in [(&p.lower, &q.lower), (&p.upper, &q.upper)] {
                let most = tolerance.max(0.01 * tolerance * steepness(a));
                assert!((a.z - b.z).abs() <= most, "{p:?} {q:?}");
            }
        }
    }
}

fn vector(reach: f64) -> impl Strategy<Value = [f64; 3]> {
    [-reach..reach, -reach..reach, -reach..reach]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]
    #[test]
    fn all_methods_agree(
        tool in 0..4usize,
        tips in collection::vec(vector(12.0), 2..4),
        leans in collection::vec(vector(0.8), 4),
    ) {
        let poses = tips.iter().zip(&leans).map(|(tip, lean)| pose(*tip, [lean[0], lean[1], 1.0])).collect();
        let path = Path::new(poses).unwrap();
        let grid = Grid::new([-25.0, -25.0], [25.0, 25.0], [11, 13]).unwrap();
        let tool = &tools()[tool];
        let charts = sweep(tool, &path, &grid, &Options::new(1e-6), &()).unwrap();
        prop_assert!(charts.statistics.unresolved.is_empty());
        for method in [Method::Lines, Method::Planes, Method::Surface] {
            let other = sweep(tool, &path, &grid, &Options::new(1e-6).method(method), &()).unwrap();
            prop_assert!(other.statistics.unresolved.is_empty(), "{method}");
            // The same roots of the same systems. The last step of Newton's method is at most 5e-6 of the parameters'
            // ranges, whose second derivatives are some 100: 1e-9 in space, and more in z along a wall.
            assert_same(&charts.volume, &other.volume, 1e-7);
        }
    }
}

#[test]
fn a_flat_end_moved_sideways_is_a_slot() {
    let tool = Tool::flat(5.0, 30.0).unwrap();
    let path = Path::new(vec![
        pose([-20.0, 0.0, 3.0], [0.0, 0.0, 1.0]),
        pose([20.0, 0.0, 3.0], [0.0, 0.0, 1.0]),
    ])
    .unwrap();
    // Lines at ±5 run along the walls.
    let grid = Grid::new([-30.5, -7.5], [30.5, 7.5], [61, 15]).unwrap();
    let result = sweep(&tool, &path, &grid, &Options::new(1e-6), &()).unwrap();
    assert!(result.statistics.unresolved.is_empty());
    for index in 0..grid.len() {
        let (i, j) = grid.place(index);
        let (x, y) = (grid.x(i), grid.y(j));
        let outside = (x.abs() - 20.0).max(0.0).hypot(y) - 5.0;
        let intervals = result.volume.at(index);
        if outside.abs() > 1e-6 {
            assert_eq!(intervals.len(), usize::from(outside < 0.0), "at {x}, {y}");
        }
        for interval in intervals {
            // Tips move by at most 1 % of the tolerance.
            assert!((interval.lower.z - 3.0).abs() <= 2e-8 && (interval.upper.z - 33.0).abs() <= 2e-8);
        }
    }
}

#[test]
fn the_same_bytes_at_any_thread_count() {
    let poses = (0..40)
        .map(|k| {
            let a = f64::from(k) * 0.15;
            pose(
                [12.0 * a.cos(), 9.0 * a.sin(), a.sin()],
                [0.3 * a.sin(), 0.2 * a.cos(), 1.0],
            )
        })
        .collect();
    let path = Path::new(poses).unwrap();
    let grid = Grid::new([-20.0, -20.0], [20.0, 20.0], [40, 40]).unwrap();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| sweep(&tools()[2], &path, &grid, &Options::new(1e-6), &()).unwrap())
    };
    let one = run(1);
    assert!(one.statistics.covered > 500);
    for threads in [2, 5] {
        let many = run(threads);
        assert_eq!(one.statistics, many.statistics);
        for index in 0..grid.len() {
            assert_eq!(one.volume.at(index), many.volume.at(index));
        }
    }
}

#[test]
fn a_sweep_can_be_cancelled_and_refuses_bad_tolerances() {
    struct Stop;
    impl Monitor for Stop {
        fn cancelled(&self) -> bool {
            true
        }
    }
    let path = Path::new(vec![
        pose([0.0; 3], [0.0, 0.0, 1.0]),
        pose([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
    ])
    .unwrap();
    let grid = Grid::new([-6.0, -6.0], [6.0, 6.0], [12, 12]).unwrap();
    let tool = &tools()[0];
    assert_eq!(
        sweep(tool, &path, &grid, &Options::default(), &Stop).err(),
        Some(SweepError::Cancelled)
    );
    for bad in [0.0, -1.0, f64::INFINITY] {
        assert_eq!(
            sweep(tool, &path, &grid, &Options::new(bad), &()).err(),
            Some(SweepError::Tolerance(bad))
        );
    }
    assert!(matches!(
        sweep(tool, &path, &grid, &Options::new(1e-13), &()).err(),
        Some(SweepError::TooFine { .. })
    ));
}
