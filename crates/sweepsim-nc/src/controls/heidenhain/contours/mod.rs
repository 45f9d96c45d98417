//! Contours: arcs, corners, cutter compensation, approach and departure.

mod approach;
mod arcs;
mod compensation;
mod free;
