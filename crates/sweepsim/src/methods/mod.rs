//! The four ways to find the crossings of dexel lines with the boundary of a sweep.

pub(crate) mod lattice;
pub(crate) mod lines;
pub(crate) mod planes;
pub(crate) mod search;
