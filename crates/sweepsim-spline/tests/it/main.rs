//! Integration tests of `sweepsim-spline`, in one binary: it links once.

mod bernstein;
mod bounds;
mod common;
mod formats;
mod rational;
mod spline;
mod stored;
mod total;
