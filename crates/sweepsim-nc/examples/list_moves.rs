//! Lists the moves of a program: of a file, or of a small one below.
//!
//! `cargo run -p sweepsim-nc --example list_moves [FILE.nc]`

use std::path::Path;
use sweepsim_nc::{NcError, Program, ReadOptions, gcode, read_file};

const PROGRAM: &str = "\
%
(a pocket's corner)
G21 G90 G54
T1 M6
S8000 M3
G0 X0 Y0 Z5
G1 Z-2 F300
G1 X20 F800
G3 X25 Y5 I0 J5
G1 Y15
G0 Z5
M30
%
";

fn read() -> Result<Program, NcError> {
    let mut options = ReadOptions::default();
    options.exact_arcs = true;
    match std::env::args().nth(1) {
        Some(file) => read_file(Path::new(&file), &options),
        None => gcode::read(PROGRAM, &options),
    }
}

fn main() {
    let program = match read() {
        Ok(program) => program,
        Err(error) => {
            eprintln!("{error}");
            std::process::exit(2);
        }
    };
    for pose in &program.poses {
        let kind = if pose.rapid { "rapid" } else { "feed" };
        let [x, y, z]: [f64; 3] = pose.pose.tip();
        println!("line {:>4}  {kind:>5} to ({x:.3}, {y:.3}, {z:.3})", pose.line);
    }
    for note in &program.notes {
        println!("{note}");
    }
}
