//! Integration tests of `sweepsim-job`, in one binary: it links once.

mod aside;
mod cache;
mod certificates;
mod ci;
mod given;
mod machine;
mod memory;
mod quickstart;
mod registers;
mod scope;
mod surface;
mod walls;
