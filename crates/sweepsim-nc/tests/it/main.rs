//! Integration tests of `sweepsim-nc`, in one binary: it links once.

mod contents;
mod harmless;
mod machines;
mod programs;
mod tables;
