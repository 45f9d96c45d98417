//! G-code: expressions, flow, cycles, cutter compensation, offsets, errors.

mod compensation;
mod corners;
mod curves;
mod cycles;
mod errors;
mod events;
mod flow;
mod frames;
mod shop_codes;
mod speed;
mod tilted_arcs;

use sweepsim_nc::gcode::read;
use sweepsim_nc::{Controller, Program, ReadOptions};

fn options(controller: Controller) -> ReadOptions {
    let mut options = ReadOptions::default();
    options.controller = Some(controller);
    options
}

#[track_caller]
fn program_with(text: &str, options: &ReadOptions) -> Program {
    read(text, options).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

#[track_caller]
fn program(text: &str) -> Program {
    program_with(text, &ReadOptions::default())
}

fn tips(program: &Program) -> Vec<[f64; 3]> {
    program.poses.iter().map(|pose| pose.pose.tip()).collect()
}

/// Whether two lists of points agree to 1e-9 mm.
#[track_caller]
fn assert_near(found: &[[f64; 3]], expected: &[[f64; 3]]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (a, b) in found.iter().zip(expected) {
        assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-9), "{found:?}\n{expected:?}");
    }
}
