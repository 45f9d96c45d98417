//! Solves one of the benchmark systems repeatedly, to count instructions (and allocations) per solution:
//!
//! `perf stat -e instructions:u target/release/examples/repeat wilk_grid_8x8 1000`

#[path = "../benches/systems/mod.rs"]
mod systems;

use sweepsim_solve::{CurveSolver, PointSolver};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "dense_deg8_2d".to_owned());
    let times: u32 = arguments.next().map_or(Ok(1), |t| t.parse())?;
    let (mut found, mut boxes) = (0, 0);
    // Two that take too long for the benches.
    let large = [(7, "quadrics_7"), (8, "quadrics_8")].into_iter().find(|l| l.1 == name);
    let large = large.map(|(n, name)| systems::quadrics(n, name));
    if let Some(named) = large.or_else(|| systems::all().into_iter().find(|s| s.name == name)) {
        assert!(named.system.coefficients() > 0);
        let mut solver = PointSolver::default();
        for _ in 0..times {
            let points = solver.solve(&named.system, &())?;
            found = points.roots.len();
            boxes = points.statistics.boxes;
        }
        assert!(times == 0 || named.roots == 0 || named.roots == found);
    } else {
        let named = systems::sphere_section();
        let mut solver = CurveSolver::new(1e-3);
        for _ in 0..times {
            found = solver.solve(&named.system, &())?.curves.len();
        }
    }
    println!("{name}: {found} solutions, {boxes} boxes, {times} times");
    Ok(())
}
