//! Integration tests of `sweepsim-spline`, in one binary: it links once.

mod bernstein;
mod bounds;
mod common;
mod kernel;
mod misuse;
mod rational;
mod spline;
mod spline_domains;
mod stored;
mod total;
