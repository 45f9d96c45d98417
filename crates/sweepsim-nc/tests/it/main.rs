//! Integration tests of `sweepsim-nc`, in one binary: it links once.

mod contents;
mod harmless;
mod kinematics;
mod machines;
mod programs;
mod tables;
