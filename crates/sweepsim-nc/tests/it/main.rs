//! Integration tests of `sweepsim-nc`, in one binary: it links once.

mod machines;
mod programs;
mod tables;
