//! Integration tests of `sweepsim-job`, in one binary: it links once.

mod certificates;
mod ci;
mod given;
mod memory;
mod scope;
mod walls;
