//! How long a million lines take.

use std::fmt::Write;
use std::time::Instant;

use sweepsim_nc::{ReadOptions, gcode};

/// Lines as a finishing program has them.
fn lines(count: usize) -> String {
    let mut text = String::from("G21 G90 G17\nT1 M6\nS9000 M3\nG0 X0 Y0 Z5\nG1 Z0 F900\n");
    for k in 0..count {
        let s = k as f64 * 1e-3;
        let (x, y, z) = (50.0 * s.sin(), 50.0 * s.cos(), -1e-5 * k as f64);
        let _ = writeln!(text, "X{x:.4} Y{y:.4} Z{z:.4}");
    }
    text
}

#[test]
fn long_programs_take_time_in_proportion() {
    let text = lines(20_000);
    let program = gcode::read(&text, &ReadOptions::default()).unwrap();
    assert!(program.poses.len() > 19_000);
}

/// `cargo test -p sweepsim-nc --test it a_million_lines -- --ignored --nocapture`
#[test]
#[ignore = "a measurement"]
fn a_million_lines() {
    let text = lines(1_000_000);
    for _ in 0..3 {
        let start = Instant::now();
        let program = gcode::read(&text, &ReadOptions::default()).unwrap();
        println!(
            "{} poses of {} bytes in {:?}",
            program.poses.len(),
            text.len(),
            start.elapsed()
        );
    }
}
