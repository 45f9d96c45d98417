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
mod rows;
mod straight;
mod stretches;
mod vertical_arcs;

pub(crate) use at_rest::{Neighbour, leaning, placements};
pub(crate) use ceiling::{Ceiling, GAP, close};
pub(crate) use curves::{Heading, slack, stands};
pub(crate) use grazing::{Grazed, Grazing, Patches};
pub(crate) use level_arcs::sweep_level_arc;
pub(crate) use rows::numbers;
pub(crate) use straight::sweep_straight;
pub(crate) use vertical_arcs::sweep_vertical_arc;

use crate::methods::harvest::Harvest;
use crate::methods::lattice::Lattice;
use sweepsim_dexel::{Crossing, Source};
use sweepsim_solve::Cause;

/// Collects crossings of the lines of a lattice.
pub(crate) struct Collector<'a> {
    pub lines: &'a Lattice<'a>,
    pub harvest: &'a mut Harvest,
}

impl Collector<'_> {
    #[inline]
    pub fn crossing(&mut self, line: usize, z: f64, jump: i8, normal: [f32; 3], source: Source) {
        let crossing = Crossing {
            z,
            jump,
            normal,
            source,
        };
        self.harvest.crossings.push((line as u32, crossing));
    }

    /// Leaves a line to the general method.
    pub fn open(&mut self, line: usize) {
        self.harvest.open.push((line as u32, Cause::Smallest));
    }

    /// The number of crossings and open lines so far.
    pub fn mark(&self) -> [usize; 2] {
        [self.harvest.crossings.len(), self.harvest.open.len()]
    }

    /// Drops what came after a mark.
    pub fn forget(&mut self, [crossings, open]: [usize; 2]) {
        self.harvest.crossings.truncate(crossings);
        self.harvest.open.truncate(open);
    }
}
