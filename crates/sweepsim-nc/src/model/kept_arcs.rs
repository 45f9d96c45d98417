//! Which arcs are worth keeping: see [`ReadOptions::level_arcs`] and [`ReadOptions::upright_arcs`].

use super::read_options::ReadOptions;
use sweepsim_motion::TipArc;

/// The largest radius of an arc that is kept, in millimetres: coordinates as large as that of its centre have fewer decimals.
const LARGEST: f64 = 1e4;
/// The same in tolerances of chords, by default ten times that of the dexels: finer dexels than these coordinates have decimals for would be refused.
const LARGEST_IN_CHORDS: f64 = 5e8;
/// The largest difference of the distances of its ends from its centre, and of their places along the normal of a plane along z.
const SPIRAL: f64 = 1e-9;
/// An arc in a plane along z is cheaper than this many chords with every kind of end: with a round corner already than two. Found by trial.
const WORTH: f64 = 8.0;

/// The kinds of arcs that are kept.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KeptArcs {
    all: bool,
    level: bool,
    upright: bool,
    /// How far chords may be from an arc.
    tolerance: f64,
}

impl KeptArcs {
    pub fn new(options: &ReadOptions) -> Self {
        Self {
            all: options.exact_arcs,
            level: options.level_arcs,
            upright: options.upright_arcs,
            tolerance: options.arc_tolerance,
        }
    }

    /// Whether no arc is kept.
    pub fn none(self) -> bool {
        !(self.all || self.level || self.upright)
    }

    /// Whether an arc between two tips is kept. `upright`: whether the tool stands along z all the time.
    pub fn keep(self, arc: &TipArc, [from, to]: [[f64; 3]; 2], upright: bool) -> bool {
        if self.all {
            return true;
        }
        let normal @ [x, y, z] = arc.normal();
        let level = [x, y] == [0.0; 2] && z.abs() == 1.0;
        if !upright || !(self.level && level || self.upright && z == 0.0) {
            return false;
        }
        let centre = arc.centre();
        let [a, b] = [from, to].map(|end| {
            let out: [f64; 3] = std::array::from_fn(|k| end[k] - centre[k]);
            let along: f64 = (0..3).map(|k| out[k] * normal[k]).sum();
            let across: [f64; 3] = std::array::from_fn(|k| out[k] - along * normal[k]);
            [across[0].hypot(across[1]).hypot(across[2]), along]
        });
        // A chord over 2h leaves r (1 − cos h) = 2 r sin²(h/2).
        let half = 2.0 * (self.tolerance / (2.0 * a[0])).sqrt().min(0.7).asin();
        let worth = level || arc.angle().abs() >= WORTH * 2.0 * half;
        let flat = level || (a[1] - b[1]).abs() <= SPIRAL;
        worth
            && flat
            && (a[0] - b[0]).abs() <= SPIRAL
            && a[0].max(b[0]) <= LARGEST.min(LARGEST_IN_CHORDS * self.tolerance)
    }
}
