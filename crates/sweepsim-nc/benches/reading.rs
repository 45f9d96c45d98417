//! How long reading takes: a million lines as a finishing program has them, by format. Under a second is wanted.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::fmt::Write;
use sweepsim_nc::{ReadOptions, apt, gcode};

const LINES: usize = 1_000_000;

/// A program with this beginning, and a line for each point.
fn program(head: &str, line: impl Fn(&mut String, [f64; 3])) -> String {
    let mut text = String::from(head);
    for k in 0..LINES {
        let s = k as f64 * 1e-3;
        line(&mut text, [50.0 * s.sin(), 50.0 * s.cos(), -1e-5 * k as f64]);
    }
    text
}

fn reading(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("a million lines");
    group.sample_size(10).throughput(Throughput::Elements(LINES as u64));
    let head = "G21 G90 G17\nT1 M6\nS9000 M3\nG0 X0 Y0 Z5\nG1 Z0 F900\n";
    // Writing to a String cannot fail.
    let text = program(head, |text, [x, y, z]| {
        let _ = writeln!(text, "X{x:.4} Y{y:.4} Z{z:.4}");
    });
    group.bench_function("G-code", |bencher| {
        bencher.iter(|| {
            gcode::read(&text, &ReadOptions::default())
                .expect("a program")
                .poses
                .len()
        });
    });
    let text = program("UNITS/MM\nLOADTL/1\nFEDRAT/900\n", |text, [x, y, z]| {
        let _ = writeln!(text, "GOTO/{x:.4},{y:.4},{z:.4},0.0,0.6,0.8");
    });
    group.bench_function("APT", |bencher| {
        bencher.iter(|| {
            apt::read(&text, &ReadOptions::default())
                .expect("a program")
                .poses
                .len()
        });
    });
    group.finish();
}

criterion_group!(benches, reading);
criterion_main!(benches);
