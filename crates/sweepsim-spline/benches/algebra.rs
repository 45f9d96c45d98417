//! The figures that `README.md` states: `cargo bench -p sweepsim-spline`.
#![allow(missing_docs, reason = "criterion's macros make public functions")]

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use sweepsim_spline::{BSpline, Bernstein, KnotVector, RationalSpline};

/// Numbers that repeat from run to run.
fn numbers(count: usize, mut seed: u64) -> Vec<f64> {
    (0..count)
        .map(|_| {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 53) as f64
        })
        .collect()
}

fn trivariate(seed: u64) -> Bernstein {
    Bernstein::new(&[4, 4, 2], numbers(75, seed)).expect("a form")
}

fn evaluation(c: &mut Criterion) {
    let form = trivariate(1);
    let count = 1024;
    let points = numbers(3 * count, 2);
    let (mut values, mut gradients) = (vec![0.0; count], vec![0.0; 3 * count]);
    let mut group = c.benchmark_group("evaluate (4,4,2)");
    group.throughput(Throughput::Elements(count as u64));
    group.bench_function("Bernstein, value and gradient, 1024 points", |b| {
        b.iter(|| form.evaluate_gradient_batch(black_box(&points), &mut values, &mut gradients));
    });
    group.bench_function("Bernstein, value, 1024 points", |b| {
        b.iter(|| form.evaluate_batch(black_box(&points), &mut values));
    });
    let knots = [(4, 4), (4, 4), (2, 4)].map(|(p, spans)| KnotVector::uniform(p, spans, 0.0, 1.0).expect("knots"));
    let total = knots.iter().map(KnotVector::count).product();
    let spline = BSpline::new(knots.to_vec(), 1, numbers(total, 3)).expect("a spline");
    group.bench_function("B-spline, value and gradient, 1024 points", |b| {
        b.iter(|| spline.evaluate_jacobian_batch(black_box(&points), &mut values, &mut gradients));
    });
    group.finish();
    c.bench_function("evaluate (4,4,2), one point, value and gradient", |b| {
        let mut gradient = [0.0; 3];
        b.iter(|| form.evaluate_gradient(black_box(&[0.3, 0.6, 0.1]), &mut gradient));
    });
}

fn algebra(c: &mut Criterion) {
    let (f, g) = (trivariate(1), trivariate(2));
    c.bench_function("product (4,4,2) × (4,4,2)", |b| {
        b.iter(|| black_box(&f).mul(black_box(&g)))
    });
    for axis in 0..3 {
        c.bench_function(&format!("split (4,4,2) in place, variable {axis}"), |b| {
            let (mut right, mut left) = (f.clone(), f.clone());
            b.iter_batched_ref(
                || (),
                |()| {
                    // Halves of halves tend to a constant: the same work whatever the numbers.
                    right.split_into(black_box(axis), 0.5, &mut left);
                    std::mem::swap(&mut right, &mut left);
                },
                BatchSize::SmallInput,
            );
        });
    }
    c.bench_function("enclosure (4,4,2)", |b| b.iter(|| black_box(&f).enclosure()));
    c.bench_function("derivative (4,4,2)", |b| b.iter(|| black_box(&f).derivative(1)));
    c.bench_function("compose (4,4,2) with a cubic curve", |b| {
        let curve: Vec<Bernstein> = (0..3)
            .map(|i| Bernstein::new(&[3], numbers(4, i)).expect("a form"))
            .collect();
        b.iter(|| f.compose(black_box(&curve)));
    });
}

fn splines(c: &mut Criterion) {
    let knots = || KnotVector::uniform(3, 10, 0.0, 1.0).expect("knots");
    let surface = BSpline::new(vec![knots(), knots()], 3, numbers(3 * 169, 4)).expect("a surface");
    c.bench_function("bicubic 10 × 10: insert a knot", |b| {
        b.iter(|| surface.insert_knot(0, black_box(0.33), 1))
    });
    c.bench_function("bicubic 10 × 10: all pieces", |b| {
        b.iter(|| black_box(&surface).pieces())
    });
    c.bench_function("bicubic 10 × 10: |F|²", |b| {
        b.iter(|| black_box(&surface).square_norm())
    });
    c.bench_function("bicubic 10 × 10: F_u × F_v", |b| {
        b.iter(|| {
            let (u, v) = (surface.derivative(0), surface.derivative(1));
            u.and_then(|u| u.cross(&v?))
        });
    });
    c.bench_function("bicubic 10 × 10: normal cone", |b| {
        b.iter(|| black_box(&surface).normal_cone())
    });
    let circle = RationalSpline::circle([0.0, 0.0], 1.0).expect("a circle");
    c.bench_function("circle: one point", |b| b.iter(|| circle.evaluate(black_box(&[1.3]))));
}

criterion_group!(benches, evaluation, algebra, splines);
criterion_main!(benches);
