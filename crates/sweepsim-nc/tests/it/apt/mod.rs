//! APT and CLSF.

mod arcs;
mod cycles;
mod errors;
mod statements;
mod tools;

use sweepsim_nc::{Program, ReadOptions, apt};

use crate::found::tips;

fn read(text: &str) -> Program {
    apt::read(text, &ReadOptions::default()).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

/// Reads with exact arcs.
fn exact(text: &str) -> Program {
    let mut options = ReadOptions::default();
    options.exact_arcs = true;
    apt::read(text, &options).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

fn error(text: &str) -> String {
    apt::read(text, &ReadOptions::default()).expect_err(text).to_string()
}

fn notes(program: &Program) -> Vec<&str> {
    program.notes.iter().map(|note| note.message.as_str()).collect()
}
