//! The four ways to find where dexel lines cross the boundary of a sweep.
//!
//! All of them solve the same equations: [`search`] sets them up as maps of [`envelope`](crate::envelope), and passes each map to a
//! [`CrossingMethod`](method::CrossingMethod). A method only determines how the preimages of the lines are found; their meaning is the same for all.

pub(crate) mod charts;
pub(crate) mod harvest;
pub(crate) mod lattice;
pub(crate) mod lines;
pub(crate) mod method;
pub(crate) mod planes;
pub(crate) mod search;
pub(crate) mod sheets;
pub(crate) mod surface;
pub(crate) mod translation;
pub(crate) mod turning;
pub(crate) mod workspace;
