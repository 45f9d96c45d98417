//! Integration tests of `sweepsim-job`, in one binary: it links once.

mod certificates;
mod ci;
mod memory;
mod quickstart;
mod scope;
mod walls;
