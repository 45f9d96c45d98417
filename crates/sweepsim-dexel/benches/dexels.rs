//! Updates a second, set operations on whole grids, triangles a second.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use sweepsim_dexel::{Dexels, Grid, Interval, Source, Stock, TriDexels};

const CELLS: usize = 300;

fn grid() -> Grid {
    Grid::new([-10.0, -10.0], [10.0, 10.0], [CELLS, CELLS]).expect("a grid")
}

fn block() -> Dexels {
    let stock = Stock::Block {
        min: [-9.0, -9.0, -5.0],
        max: [9.0, 9.0, 5.0],
    };
    stock.dexels(&grid()).expect("a block")
}

/// Short cuts all over the grid, as those of a path.
fn cuts() -> Vec<(usize, Interval)> {
    let count = CELLS * CELLS;
    (0..200_000_usize)
        .map(|k| {
            let z = (k.wrapping_mul(2_654_435_761) >> 7 & 1023) as f64 * 0.01 - 5.0;
            let mut cut = Interval::between(z, z + 0.3);
            cut.lower.source = Source::Cut {
                path: 0,
                segment: (k / 500) as u32,
                t: 0.25,
            };
            cut.upper.source = cut.lower.source;
            // Runs of neighbouring lines.
            ((k / 40 * 7919 + k % 40) % count, cut)
        })
        .collect()
}

fn updates(c: &mut Criterion) {
    let (stock, cuts) = (block(), cuts());
    let mut group = c.benchmark_group("updates");
    group
        .sample_size(10)
        .throughput(Throughput::Elements(cuts.len() as u64));
    group.bench_function("unite", |b| {
        b.iter(|| {
            let mut dexels = Dexels::empty(grid());
            cuts.iter()
                .for_each(|(index, cut)| dexels.unite(*index, &[*cut]).expect("a line of the grid"));
            dexels
        })
    });
    group.bench_function("subtract", |b| {
        b.iter(|| {
            let mut dexels = stock.clone();
            cuts.iter()
                .for_each(|(index, cut)| dexels.subtract(*index, &[*cut]).expect("a line of the grid"));
            dexels
        })
    });
    group.finish();
}

fn whole(c: &mut Criterion) {
    let stock = block();
    let mut other = Dexels::empty(grid());
    cuts()
        .iter()
        .for_each(|(index, cut)| other.unite(*index, &[*cut]).expect("a line of the grid"));
    let mut group = c.benchmark_group("whole grids");
    group
        .sample_size(10)
        .throughput(Throughput::Elements(grid().len() as u64));
    group.bench_function("block", |b| b.iter(block));
    group.bench_function("subtract_all", |b| {
        b.iter(|| {
            let mut dexels = stock.clone();
            dexels.subtract_all(black_box(&other)).expect("one grid");
            dexels
        })
    });
    group.bench_function("volume", |b| b.iter(|| black_box(&other).volume()));
    group.finish();
}

fn meshes(c: &mut Criterion) {
    let cylinder = Stock::Cylinder {
        base: [-8.0, -3.0, 0.0],
        axis: [16.0, 6.0, 3.0],
        radius: 5.0,
        height: 17.0,
    };
    let dexels = cylinder.dexels(&grid()).expect("a cylinder");
    let mut group = c.benchmark_group("meshes");
    let triangles = dexels.surface().unwrap().triangles.len();
    group.sample_size(10).throughput(Throughput::Elements(triangles as u64));
    group.bench_function("surface", |b| b.iter(|| black_box(&dexels).surface()));
    let solid = TriDexels::new([-10.0; 3], [10.0; 3], [150; 3], &cylinder).expect("a cylinder");
    let triangles = solid.surface().unwrap().triangles.len();
    group.throughput(Throughput::Elements(triangles as u64));
    group.bench_function("sharp", |b| b.iter(|| black_box(&solid).surface()));
    group.finish();
}

criterion_group!(benches, updates, whole, meshes);
criterion_main!(benches);
