//! Moves that keep their orientation, in closed form: see `docs/algorithms/translations.md`.
//!
//! Legend: `d` the displacement of the tip during the move; `q` the coordinate along its horizontal part, `p` the one across it (to its left), `z`
//! along the dexels. `(ρ, ζ)` radius and height of the tool's meridian, `κ = n_ζ/n_ρ` the slope of its normal, `φ` the azimuth about the tool's axis.
//! The envelope condition `⟨N, d⟩ = 0` does not contain the time, so the envelope is a curve on the tool, moved along `d`: over a line, `p` selects
//! the point of the curve, and `q` the time.
//!
//! Every decision (which curve, which time, which sign) is taken only beyond its rounding error; a line for which one is closer is left open, and
//! solved by the general method.

mod arc_place;
mod at_rest;
mod ceiling;
mod curves;
mod discs;
mod grazing;
mod level_arcs;
mod quarter;
mod rows;
mod straight;
mod vertical_arcs;

pub(crate) use at_rest::{Neighbour, leaning, placements};
pub(crate) use ceiling::{GAP, UprightCeiling};
pub(crate) use curves::{Heading, slack, stands};
pub(crate) use grazing::{Grazed, Grazing, Patches};
pub(crate) use level_arcs::sweep_level_arc;
pub(crate) use straight::sweep_straight;
pub(crate) use vertical_arcs::sweep_vertical_arc;
