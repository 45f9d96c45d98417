//! The stored 1-D systems.

use super::solver_support::audit::audit_curves;
use super::stored::all;
use std::time::{Duration, Instant};
use sweepsim_solve::CurveSolver;

fn solver(tolerance: f64) -> CurveSolver {
    let mut solver = CurveSolver::new(tolerance);
    solver.options.time = Some(Duration::from_secs(60));
    solver
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn stored_curves_have_their_known_topology() {
    let systems = all();
    println!(
        "{:32} {:>5} {:>5} {:>5} {:>6} {:>9}  expected",
        "system", "loops", "arcs", "sing", "boxes", "time"
    );
    let mut failures = Vec::new();
    let only = std::env::var("SYSTEM").ok();
    for stored in systems
        .iter()
        .filter(|s| s.dimension == 1 && only.as_ref().is_none_or(|o| *o == s.name))
    {
        let system = stored.system().unwrap();
        let start = Instant::now();
        let curves = solver(1e-3).solve(&system, &()).unwrap();
        let time = start.elapsed();
        let (loops, arcs) = (curves.loops().count(), curves.arcs().count());
        let branches: Vec<usize> = curves.singular.iter().map(|s| s.branches.len()).collect();
        println!(
            "{:32} {loops:5} {arcs:5} {branches:?} {:6} {:9.3} ms  {} skin {:e} vertices {}",
            stored.name,
            curves.statistics.boxes,
            time.as_secs_f64() * 1e3,
            stored.expected,
            curves.skin,
            curves.curves.iter().map(|c| c.points.len()).sum::<usize>(),
        );
        audit_curves(&curves, &stored.bounds, &stored.name);
        let expected = |key: &str| stored.expected[key].as_u64().unwrap() as usize;
        let right = match stored.name.as_str() {
            // Four half-lines at a node; a cusp joins two; a point of its own beside an arc; figures eight.
            // It touches the region in a corner only: whether that is a point of it is not decided, but named.
            "c1_corner_arc" => (loops, arcs, &branches[..]) == (0, 0, &[0]),
            "c1_cross" => (loops, arcs, &branches[..]) == (0, 4, &[4]),
            "c1_cusp" => (loops, arcs, &branches[..]) == (0, 2, &[2]),
            "c1_isolated_point" => (loops, arcs, &branches[..]) == (0, 1, &[0]),
            "c1_viviani" | "c1_torus_tangent_plane" => (loops, arcs, &branches[..]) == (0, 2, &[4]),
            _ => (loops, arcs, branches.len()) == (expected("loops"), expected("arcs"), 0),
        };
        if !right {
            failures.push(stored.name.clone());
        }
    }
    assert!(failures.is_empty(), "{failures:?}");
}
