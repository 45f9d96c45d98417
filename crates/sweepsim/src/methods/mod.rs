//! The four ways to find where dexel lines cross the boundary of a sweep.
//!
//! All of them solve the same equations: [`search`] poses them, as maps of [`envelope`](crate::envelope), and hands each map to a
//! [`CrossingMethod`](method::CrossingMethod). A method only says how the preimages of the lines are found; what they mean is the same for all.

pub(crate) mod charts;
pub(crate) mod harvest;
pub(crate) mod lattice;
pub(crate) mod lines;
pub(crate) mod method;
mod placement;
pub(crate) mod planes;
pub(crate) mod search;
pub(crate) mod surface;
pub(crate) mod workspace;
