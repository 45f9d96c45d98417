//! Moves that keep their orientation, in closed form: see `docs/algorithms/translations.md`.
//!
//! Legend: `d` the displacement of the tip during the move; `q` the coordinate along its horizontal part, `p` the one across it (to its left), `z`
//! along the dexels. `(ρ, ζ)` radius and height of the tool's meridian, `κ = n_ζ/n_ρ` the slope of its normal, `φ` the azimuth about the tool's axis.
//! The envelope condition `⟨N, d⟩ = 0` does not contain the time, so the envelope is a curve on the tool, moved along `d`: over a line, `p` selects
//! the point of the curve, and `q` the time.
//!
//! Every decision (which curve, which time, which sign) is taken only beyond its rounding error; a line for which one is closer is left open, and
//! solved by the general method.

mod bend;
mod ceiling;
mod discs;
mod graph;
mod heading;
mod placed;
mod ring;
mod rows;
mod slant;
mod strip;
mod torus;

pub(crate) use bend::around;
pub(crate) use ceiling::{Ceiling, GAP, close};
pub(crate) use heading::{Heading, slack, stands};
pub(crate) use placed::{Neighbour, placements};
pub(crate) use strip::envelope;

use crate::methods::harvest::Harvest;
use crate::methods::lattice::Lattice;
use sweepsim_dexel::{Crossing, Source};
use sweepsim_solve::Cause;

/// A vector in the coordinates `(q, p, z)` of a move.
pub(crate) type Local = [f64; 3];

/// The sum `a + s b`.
fn along(a: &Local, s: f64, b: &Local) -> Local {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

fn dot(a: &Local, b: &Local) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Collects crossings of the lines of a lattice.
pub(crate) struct Collector<'a> {
    pub lines: &'a Lattice<'a>,
    pub harvest: &'a mut Harvest,
}

impl Collector<'_> {
    #[inline]
    fn crossing(&mut self, line: usize, z: f64, jump: i8, normal: [f32; 3], source: Source) {
        let crossing = Crossing {
            z,
            jump,
            normal,
            source,
        };
        self.harvest.crossings.push((line as u32, crossing));
    }

    /// Leaves a line to the general method.
    fn open(&mut self, line: usize) {
        self.harvest.open.push((line as u32, Cause::Smallest));
    }
}
