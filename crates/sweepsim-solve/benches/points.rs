//! How long points take on dense systems, and curves on a section of an envelope: `cargo bench -p sweepsim-solve`.

mod systems;

use criterion::{Criterion, criterion_group, criterion_main};
use sweepsim_solve::{CurveSolver, PointSolver};

fn points(c: &mut Criterion) {
    let mut solver = PointSolver::default();
    for named in systems::all() {
        let found = solver.solve(&named.system, &()).expect("a square system");
        println!("{}: {} roots, {:?}", named.name, found.roots.len(), found.statistics);
        assert!(named.roots == 0 || named.roots == found.roots.len());
        c.bench_function(named.name, |b| {
            b.iter(|| solver.solve(&named.system, &()).map(|p| p.roots.len()));
        });
    }
}

fn curves(c: &mut Criterion) {
    let named = systems::sphere_section();
    for tolerance in [1e-2, 1e-3, 1e-6] {
        let mut solver = CurveSolver::new(tolerance);
        let found = solver.solve(&named.system, &()).expect("a curve");
        let vertices: usize = found.curves.iter().map(|c| c.points.len()).sum();
        println!(
            "{}: {} arcs, {vertices} vertices, {:?}",
            named.name,
            found.curves.len(),
            found.statistics
        );
        c.bench_function(&format!("{} {tolerance:e}", named.name), |b| {
            b.iter(|| solver.solve(&named.system, &()).map(|f| f.curves.len()));
        });
    }
}

criterion_group!(benches, points, curves);
criterion_main!(benches);
