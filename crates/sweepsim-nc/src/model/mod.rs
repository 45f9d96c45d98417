//! What reading a program takes and gives.

pub(crate) mod event;
pub(crate) mod kept_arcs;
pub(crate) mod names;
pub(crate) mod pose;
pub(crate) mod poses;
pub(crate) mod positions;
pub(crate) mod program;
pub(crate) mod read_options;
pub(crate) mod stock;
pub(crate) mod times;
pub(crate) mod tool;
pub(crate) mod usage;
