//! How long the 0-D solver takes on dense systems: `cargo bench -p sweepsim-solve`.

mod systems;

use criterion::{Criterion, criterion_group, criterion_main};
use sweepsim_solve::PointSolver;

fn points(c: &mut Criterion) {
    let mut solver = PointSolver::default();
    for named in systems::all() {
        let found = solver.solve(&named.system, &mut ()).expect("a square system");
        println!("{}: {} roots, {:?}", named.name, found.roots.len(), found.statistics);
        assert!(named.roots == 0 || named.roots == found.roots.len());
        c.bench_function(named.name, |b| {
            b.iter(|| solver.solve(&named.system, &mut ()).map(|p| p.roots.len()));
        });
    }
}

criterion_group!(benches, points);
criterion_main!(benches);
