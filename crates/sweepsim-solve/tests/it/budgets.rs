//! Budgets of time and vertices: kept in every loop, with what was found until then.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use sweepsim_solve::{
    Bernstein, Cause, CurveSolver, Enclosure, Monitor, PointSolver, SolveOptions, SurfaceSolver, System,
};

/// `Σ (xⱼ − 1/2)² − 0.4²` on the unit box.
fn ball(n: usize) -> System {
    let form = (0..n).fold(Bernstein::constant(n, -0.16), |sum, j| {
        let x = Bernstein::variable(n, j).sub(&Bernstein::constant(n, 0.5));
        sum.add(&x.mul(&x))
    });
    System::new(&vec![Enclosure::UNIT; n], [form]).unwrap()
}

/// Time that this thread has spent on a processor, so that other work on the machine does not count; elapsed time where Linux does not tell.
fn spent(start: Instant) -> Duration {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = text.split_whitespace().next().and_then(|x| x.parse().ok());
    nanoseconds.map_or_else(|| start.elapsed(), Duration::from_nanos)
}

/// Linux counts time on a processor by ticks of up to 4 ms.
const ALLOWANCE: Duration = Duration::from_millis(5);

/// Remembers when it was asked last, in time on a processor.
struct LastAsked(Instant, AtomicU64);

impl Monitor for LastAsked {
    fn cancelled(&self) -> bool {
        self.1.store(spent(self.0).as_nanos() as u64, Ordering::Relaxed);
        false
    }
}

/// Runs this within a fifth more than the budget. However busy the machine is, what comes after the monitor was asked last takes no more than that fifth and
/// what the solver keeps of its time for it.
fn in_time<T>(budget: Duration, kept: Duration, run: impl FnOnce(&dyn Monitor) -> T) -> T {
    let start = Instant::now();
    let before = spent(start);
    let monitor = LastAsked(start, AtomicU64::new(before.as_nanos() as u64));
    let result = run(&monitor);
    let after = spent(start);
    let took = after - before;
    assert!(took <= budget * 6 / 5 + ALLOWANCE, "{took:?} of {budget:?}");
    let last = after - Duration::from_nanos(monitor.1.into_inner());
    assert!(
        last <= budget / 5 + kept + ALLOWANCE,
        "{last:?} after the end of {budget:?}"
    );
    result
}

fn with_time(base: &SolveOptions, budget: Duration) -> SolveOptions {
    base.clone().time(Some(budget))
}

#[test]
fn curve_tracing_ends_with_its_time() {
    let system = ball(2);
    let budget = Duration::from_millis(200);
    // Far more vertices than this time and the default number of vertices suffice for.
    let tolerance = 1e-14;
    let options = with_time(&CurveSolver::new(tolerance).options, budget).vertices(usize::MAX);
    let curves = in_time(budget, Duration::ZERO, |monitor| {
        CurveSolver::with_options(tolerance, options).solve(&system, monitor)
    })
    .unwrap();
    assert!(curves.singular.iter().any(|s| s.cause == Cause::Time));
}

#[test]
fn many_open_cells_are_assembled_in_time() {
    // An equation that vanishes along a line with multiplicity 2 never settles: the time ends the search with many cells open.
    let x = Bernstein::variable(3, 0).sub(&Bernstein::constant(3, 0.3));
    let y = Bernstein::variable(3, 1).sub(&Bernstein::constant(3, 0.3));
    let system = System::new(&[Enclosure::UNIT; 3], [x.mul(&x), y.mul(&y)]).unwrap();
    let budget = Duration::from_millis(200);
    let mut options = with_time(&CurveSolver::new(1e-3).options, budget);
    options.unresolved = usize::MAX;
    let curves = in_time(budget, Duration::ZERO, |monitor| {
        CurveSolver::with_options(1e-3, options).solve(&system, monitor)
    })
    .unwrap();
    assert!(!curves.singular.is_empty());
}

#[test]
fn curves_have_no_more_vertices_than_allowed() {
    let system = ball(2);
    let mut solver = CurveSolver::new(1e-9);
    let all: usize = solver
        .solve(&system, &())
        .unwrap()
        .curves
        .iter()
        .map(|c| c.points.len())
        .sum();
    assert!(all > 4_000, "{all}");
    for vertices in [0, 1, 10, 1_000] {
        let options = solver.options.clone().vertices(vertices);
        let curves = CurveSolver::with_options(1e-9, options).solve(&system, &()).unwrap();
        let some: usize = curves.curves.iter().map(|c| c.points.len()).sum();
        assert!(some <= vertices, "{some} of {vertices}");
        assert!(curves.singular.iter().any(|s| s.cause == Cause::Vertices));
        // What is not traced is covered.
        for k in 0..90 {
            let angle = f64::from(k) * std::f64::consts::TAU / 90.0;
            let p = [0.5 + 0.4 * angle.cos(), 0.5 + 0.4 * angle.sin()];
            let open = curves
                .singular
                .iter()
                .any(|s| s.bounds.iter().zip(p).all(|(b, x)| b.contains(x)));
            let near = |q: &sweepsim_solve::CurvePoint| (q.point[0] - p[0]).hypot(q.point[1] - p[1]) < 1e-3;
            assert!(
                open || curves.curves.iter().any(|c| c.points.iter().any(near)),
                "{vertices}: {p:?}"
            );
        }
    }
    let exactly = solver.options.clone().vertices(all + 64);
    let whole = CurveSolver::with_options(1e-9, exactly).solve(&system, &()).unwrap();
    assert_eq!((whole.loops().count(), whole.singular.len()), (1, 0));
}

#[test]
fn surfaces_end_with_their_time_and_vertices() {
    let system = ball(3);
    let budget = Duration::from_millis(300);
    let options = with_time(&SurfaceSolver::new(1e-9).options, budget);
    let surface = in_time(budget, Duration::ZERO, |monitor| {
        SurfaceSolver::with_options(1e-9, options).solve(&system, monitor)
    })
    .unwrap();
    assert!(surface.unresolved.iter().any(|u| u.cause == Cause::Time));

    let options = SurfaceSolver::new(0.01).options.vertices(100);
    let surface = SurfaceSolver::with_options(0.01, options).solve(&system, &()).unwrap();
    assert!(surface.vertices.len() <= 100 && surface.unresolved.iter().any(|u| u.cause == Cause::Vertices));
}

/// A mesh in the making: most of the time goes into checking neighbours and placing vertices, not into boxes.
#[test]
fn meshing_ends_with_the_time() {
    let system = ball(3);
    let start = Instant::now();
    let mesh = SurfaceSolver::new(2e-3).solve(&system, &()).unwrap();
    let whole = start.elapsed();
    assert!(mesh.unresolved.is_empty());
    for share in [0.3, 0.5, 0.7, 0.85, 0.95] {
        let budget = whole.mul_f64(share);
        let options = with_time(&SurfaceSolver::new(2e-3).options, budget);
        in_time(budget, Duration::ZERO, |monitor| {
            SurfaceSolver::with_options(2e-3, options).solve(&system, monitor)
        })
        .unwrap();
    }
}

/// Systems that take longer than any budget here: a surface of solutions in space, a curve of solutions in the plane next to roots, many unknowns.
fn endless() -> Vec<System> {
    let sphere = |n: usize, square: f64| {
        (0..n).fold(Bernstein::constant(n, -square), |sum, j| {
            let x = Bernstein::variable(n, j).sub(&Bernstein::constant(n, 0.47));
            sum.add(&x.mul(&x))
        })
    };
    let plane = |n: usize, j: usize, at: f64| Bernstein::variable(n, j).sub(&Bernstein::constant(n, at));
    let surface = (0..3).map(|j| sphere(3, 0.16).mul(&plane(3, j, 0.3)));
    let curve = (0..2).map(|j| sphere(2, 0.16).mul(&plane(2, j, 0.3)));
    // Every product of two variables appears: 52,000 coefficients, 3 ms a box.
    let many = (0..8).map(|j| sphere(8, 0.5).mul(&plane(8, j, 0.3 + 0.02 * j as f64)));
    vec![
        System::new(&[Enclosure::UNIT; 3], surface.collect::<Vec<_>>()).unwrap(),
        System::new(&[Enclosure::UNIT; 2], curve.collect::<Vec<_>>()).unwrap(),
        System::new(&[Enclosure::UNIT; 8], many.collect::<Vec<_>>()).unwrap(),
    ]
}

#[test]
fn points_end_with_their_time() {
    for (number, system) in endless().iter().enumerate() {
        // A box of the last one takes 3 ms, and beside other work twice as long: too much for the least budget.
        for milliseconds in [20, 60, 250].into_iter().skip(usize::from(number == 2)) {
            let budget = Duration::from_millis(milliseconds);
            let mut solver = PointSolver::new(with_time(&SolveOptions::default(), budget));
            let points = in_time(budget, budget / 10, |monitor| solver.solve(system, monitor)).unwrap();
            let out_of_time = points.unresolved.iter().any(|u| u.cause == Cause::Time);
            assert!(out_of_time || number == 1, "{number}, {milliseconds} ms");
        }
    }
}
