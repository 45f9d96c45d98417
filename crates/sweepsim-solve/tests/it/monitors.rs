//! Monitors: every solver asks them in its inner loops, and stops soon after they say so.

use crate::support;

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use support::targets::{Answer, List};
use sweepsim_solve::{
    Bundle, BundleSolver, Cause, ChartMap, ChartOptions, ChartSolver, CurveSolver, Enclosure, Fate, Monitor,
    PointSolver, Sample, SolveStatistics, SurfaceSolver, System,
};
use sweepsim_spline::Bernstein;

/// Cancels from a certain question on.
struct After {
    patience: u64,
    asked: AtomicU64,
}

impl After {
    fn new(patience: u64) -> Self {
        let asked = AtomicU64::new(0);
        Self { patience, asked }
    }

    fn asked(&self) -> u64 {
        self.asked.load(Ordering::Relaxed)
    }

    /// Questions after the first that was answered with `true`.
    fn overtime(&self) -> u64 {
        self.asked().saturating_sub(self.patience + 1)
    }
}

impl Monitor for After {
    fn cancelled(&self) -> bool {
        self.asked.fetch_add(1, Ordering::Relaxed) >= self.patience
    }
}

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

/// Thirty-six roots in the unit square.
fn waves() -> System {
    let wave = |axis: usize| {
        let factor = |k: u32| {
            let root = Bernstein::constant(2, (f64::from(k) + 0.5) / 6.0);
            Bernstein::variable(2, axis).sub(&root).scale(6.0)
        };
        (1..6).fold(factor(0), |p, k| p.mul(&factor(k)))
    };
    let mixed = [wave(0).add(&wave(1).scale(0.01)), wave(1).sub(&wave(0).scale(0.02))];
    System::new(&unit(2), &mixed).unwrap()
}

/// Runs a search with growing patience: it is cancelled each time, within `overtime` further questions, until patience outlasts it.
fn is_cancelled_soon(overtime: u64, search: impl Fn(&After) -> bool) {
    let mut cancelled = 0;
    for patience in [0, 1, 5, 20, 60] {
        let monitor = After::new(patience);
        assert!(
            search(&monitor),
            "patience of {patience}: nothing says that it was cancelled"
        );
        assert!(
            monitor.overtime() <= overtime,
            "patience of {patience}: {} further questions",
            monitor.overtime()
        );
        cancelled += 1;
    }
    assert_eq!(cancelled, 5);
    assert!(!search(&After::new(u64::MAX)));
}

#[test]
fn points_are_cancelled_soon() {
    let system = waves();
    is_cancelled_soon(0, |monitor| {
        let points = PointSolver::default().solve(&system, monitor).unwrap();
        points.unresolved.iter().any(|u| u.cause == Cause::Cancelled)
    });
}

#[cfg(feature = "rayon")]
#[test]
fn parallel_points_are_cancelled_soon() {
    let system = waves();
    // Each of the parts asks once.
    is_cancelled_soon(128, |monitor| {
        let points = PointSolver::default().solve_parallel(&system, monitor).unwrap();
        points.unresolved.iter().any(|u| u.cause == Cause::Cancelled)
    });
}

#[test]
fn curves_are_cancelled_soon() {
    let ovals = ball(2, 0.37).mul(&ball(2, 0.33)).assumed_exact();
    let system = System::new(&unit(2), [ovals]).unwrap();
    // The searches on the four faces ask once each.
    is_cancelled_soon(8, |monitor| {
        let curves = CurveSolver::new(1e-4).solve(&system, monitor).unwrap();
        curves.singular.iter().any(|s| s.cause == Cause::Cancelled)
    });
}

#[test]
fn the_tracing_of_a_long_polyline_is_cancelled() {
    let system = System::new(&unit(2), [ball(2, 0.4)]).unwrap();
    let all = After::new(u64::MAX);
    let curves = CurveSolver::new(1e-9).solve(&system, &all).unwrap();
    let points = curves.curves[0].points.len() as u64;
    let boxes = curves.statistics.boxes + curves.statistics.faces;
    assert!(
        points > 20 * boxes,
        "{points} points in {boxes} boxes: the test is vacuous"
    );
    assert!(all.asked() > points);
    let half = After::new(points / 2);
    let curves = CurveSolver::new(1e-9).solve(&system, &half).unwrap();
    assert!(curves.singular.iter().any(|s| s.cause == Cause::Cancelled));
    assert!(half.overtime() < 20, "{}", half.overtime());
}

#[test]
fn surfaces_are_cancelled_soon() {
    let system = System::new(&unit(3), [ball(3, 0.4)]).unwrap();
    let search = |monitor: &After| {
        let surface = SurfaceSolver::new(0.05).solve(&system, monitor).unwrap();
        let cancelled = surface.unresolved.iter().any(|u| u.cause == Cause::Cancelled);
        assert!(!cancelled || surface.triangles.is_empty(), "an unfinished mesh");
        cancelled
    };
    is_cancelled_soon(0, search);
    // Meshing asks as well.
    let all = After::new(u64::MAX);
    assert!(!search(&all));
    let late = After::new(all.asked() - 1);
    assert!(search(&late) && late.overtime() == 0);
}

/// `(x² + y, x y)` on the unit square: singular where `y = 2 x²`.
pub struct Fold;

impl ChartMap<2> for Fold {
    type Cell = [Enclosure; 2];
    type Seen = ();

    fn bounds(&self, cell: &Self::Cell) -> [Enclosure; 2] {
        *cell
    }

    fn values(&mut self, [x, y]: &Self::Cell) -> Option<[Enclosure; 2]> {
        let sum = Enclosure::new(x.lo() * x.lo() + y.lo() - 1e-15, x.hi() * x.hi() + y.hi() + 1e-15).unwrap();
        Some([
            sum,
            Enclosure::new(x.lo() * y.lo() - 1e-15, x.hi() * y.hi() + 1e-15).unwrap(),
        ])
    }

    fn jacobian(&mut self, [x, y]: &Self::Cell) -> [[Enclosure; 2]; 2] {
        [
            [
                Enclosure::new(2.0 * x.lo(), 2.0 * x.hi()).unwrap(),
                Enclosure::new(1.0, 1.0).unwrap(),
            ],
            [*y, *x],
        ]
    }

    fn split(&mut self, cell: &Self::Cell, axis: usize) -> [Self::Cell; 2] {
        let middle = 0.5 * (cell[axis].lo() + cell[axis].hi());
        let (mut lower, mut upper) = (*cell, *cell);
        lower[axis] = Enclosure::new(cell[axis].lo(), middle).unwrap();
        upper[axis] = Enclosure::new(middle, cell[axis].hi()).unwrap();
        [lower, upper]
    }

    fn evaluate(&self, &[x, y]: &[f64; 2]) -> Sample<2, ()> {
        Sample {
            value: [x * x + y, x * y],
            jacobian: [[2.0 * x, 1.0], [y, x]],
            seen: (),
        }
    }

    fn scales(&self) -> [f64; 2] {
        [1.0; 2]
    }

    fn rounding(&self) -> [f64; 2] {
        [1e-15; 2]
    }
}

/// Images of a lattice of `side²` points, away from the fold.
fn images(side: u32) -> List<2> {
    let at = |k: u32| (f64::from(k) + 0.37) / f64::from(side);
    let lattice = (0..side).flat_map(|i| (0..side).map(move |k| [at(i), at(k)]));
    List(lattice.map(|x| Fold.evaluate(&x).value).collect())
}

#[test]
fn charts_are_cancelled_soon() {
    let targets = images(40);
    // Each box of the stack asks once more.
    is_cancelled_soon(60, |monitor| {
        let mut answer = Answer::default();
        let mut solver = ChartSolver::new(ChartOptions::default());
        solver.solve(&mut Fold, [Enclosure::UNIT; 2], &targets, &mut answer, monitor);
        if monitor.patience == u64::MAX {
            assert!(answer.found.len() + answer.open.len() >= targets.0.len());
        }
        answer.open.iter().any(|u| u.cause == Cause::Cancelled)
    });
}

#[test]
fn a_chart_of_many_targets_is_cancelled_among_them() {
    // Where x is near 1 and y near 0, one box is a chart.
    let corner = [Enclosure::new(0.9, 1.0).unwrap(), Enclosure::new(0.0, 0.1).unwrap()];
    let lattice =
        (0..90).flat_map(|i| (0..90).map(move |k| [0.9005 + 1e-3 * f64::from(i), 5e-4 + 1e-3 * f64::from(k)]));
    let targets = List(lattice.map(|x| Fold.evaluate(&x).value).collect());
    let search = |monitor: &After| {
        let mut answer = Answer::default();
        let mut solver = ChartSolver::new(ChartOptions::default());
        solver.solve(&mut Fold, corner, &targets, &mut answer, monitor);
        (answer, solver.statistics)
    };
    let (all, statistics) = search(&After::new(u64::MAX));
    assert_eq!((all.found.len(), all.open.len()), (targets.0.len(), 0));
    assert!(statistics.boxes < 10, "{}", statistics.boxes);
    let soon = After::new(10);
    let (some, statistics) = search(&soon);
    assert!(statistics.evaluations < 500, "{}", statistics.evaluations);
    assert!(some.open.iter().all(|u| u.cause == Cause::Cancelled));
    assert!(some.found.len() + some.open.len() >= targets.0.len());
}

#[test]
fn bundles_are_cancelled_soon() {
    let (x, y) = (Bernstein::variable(2, 0), Bernstein::variable(2, 1));
    let numerators = vec![x.mul(&x).add(&y), x.mul(&y)];
    let bundle = Bundle::new(numerators, &Bernstein::constant(2, 1.0), vec![]).unwrap();
    let targets = images(60);
    let search = |monitor: &After| {
        let mut answer = Answer::default();
        let mut solver = BundleSolver::new(ChartOptions::default());
        solver.solve(&bundle, &Fold, &targets, &mut answer, monitor);
        (answer, solver.statistics)
    };
    let all = After::new(u64::MAX);
    let (answer, statistics) = search(&all);
    assert!(answer.found.len() + answer.open.len() >= targets.0.len());
    for patience in [0, 10, all.asked() / 2] {
        let monitor = After::new(patience);
        let (some, part) = search(&monitor);
        assert!(some.open.iter().any(|u| u.cause == Cause::Cancelled), "{patience}");
        assert!(part.evaluations <= statistics.evaluations * 2 / 3, "{patience}");
    }
}

/// Counts fates.
#[derive(Default)]
struct Count(Mutex<Vec<Fate>>);

impl Monitor for Count {
    fn visits(&self) -> bool {
        true
    }

    fn visit(&self, bounds: &[Enclosure], _: u32, fate: Fate) {
        assert!(bounds.iter().all(|b| b.lo() < b.hi()));
        self.0.lock().unwrap().push(fate);
    }
}

impl Count {
    fn fates(self) -> Vec<Fate> {
        self.0.into_inner().unwrap()
    }
}

#[test]
fn monitors_see_every_box() {
    let x = Bernstein::from_fn(&[3], |i| [1.0, -2.0, 2.0, -1.0][i[0]]).unwrap();
    let count = Count::default();
    let points = PointSolver::default()
        .solve(&System::new(&unit(1), [&x]).unwrap(), &count)
        .unwrap();
    let fates = count.fates();
    assert_eq!(fates.len() as u64, points.statistics.boxes);
    let certified = fates.iter().filter(|f| **f == Fate::Certified).count();
    assert_eq!(certified, points.roots.len());

    let nested = |n| System::new(&unit(n), [ball(n, 0.37).mul(&ball(n, 0.33)).assumed_exact()]).unwrap();
    let count = Count::default();
    let curves = CurveSolver::new(1e-3).solve(&nested(2), &count).unwrap();
    let SolveStatistics { boxes, faces, .. } = curves.statistics;
    let fates = count.fates();
    assert_eq!(fates.len() as u64, boxes);
    assert!(faces > 0, "splits are searched for crossings");
    assert!(fates.contains(&Fate::Certified));

    let count = Count::default();
    let surface = SurfaceSolver::new(0.05).solve(&nested(3), &count).unwrap();
    let fates = count.fates();
    assert_eq!(fates.len() as u64, surface.statistics.boxes);
    assert!(fates.contains(&Fate::Certified));
}
