//! The `sweepsim` command.
fn main() {}
