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

use crate::found::{assert_near, tips};

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
