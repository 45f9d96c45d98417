//! Which arcs are worth keeping: see [`ReadOptions::level_arcs`], [`ReadOptions::upright_arcs`] and [`ReadOptions::tilted_arcs`].

use super::read_options::ReadOptions;
use sweepsim_motion::TipArc;

/// The largest radius of an arc that is kept, in millimetres: coordinates as large as that of its centre have fewer decimals.
const LARGEST: f64 = 1e4;
/// The same in tolerances of chords, by default ten times that of the dexels: finer dexels than these coordinates have decimals for would be refused.
const LARGEST_IN_CHORDS: f64 = 5e8;
/// The largest difference of the distances of its ends from its centre, and of their places along the normal of a plane that is not level; and how far it may leave the plane across the axis of a tool that leans.
const SPIRAL: f64 = 1e-9;
/// An arc in a plane along z is cheaper than this many chords with every kind of end: with a round corner already than two. Found by trial.
const WORTH: f64 = 8.0;
/// The same for an arc about the axis of a tool that leans, which is exact for what some 50 to 110 chords cost.
const WORTH_TILTED: f64 = 30.0;

/// How an arc that is not kept in any case lies to z and to the tool.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stance {
    /// It turns about z, and the tool stands along z.
    Level,
    /// It lies in a plane along z, and the tool stands along z.
    Upright,
    /// It turns about the axis of a tool that leans.
    Tilted,
}

impl Stance {
    fn new(arc: &TipArc, radius: f64, axis: [f64; 3]) -> Option<Self> {
        let normal @ [x, y, z] = arc.normal();
        if axis == [0.0, 0.0, 1.0] {
            let level = [x, y] == [0.0; 2] && z.abs() == 1.0;
            return match level {
                true => Some(Self::Level),
                false => (z == 0.0).then_some(Self::Upright),
            };
        }
        let along: f64 = (0..3).map(|k| axis[k] * normal[k]).sum();
        let off = (0..3).map(|k| (normal[k] - axis[k] * along.signum()).abs());
        (off.fold(0.0, f64::max) * radius <= SPIRAL).then_some(Self::Tilted)
    }
}

/// The kinds of arcs that are kept.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KeptArcs {
    all: bool,
    level: bool,
    upright: bool,
    tilted: bool,
    /// How far chords may be from an arc.
    tolerance: f64,
}

impl KeptArcs {
    pub fn new(options: &ReadOptions) -> Self {
        Self {
            all: options.exact_arcs,
            level: options.level_arcs,
            upright: options.upright_arcs,
            tilted: options.tilted_arcs,
            tolerance: options.arc_tolerance,
        }
    }

    /// Whether no arc is kept.
    pub fn none(self) -> bool {
        !(self.all || self.level || self.upright || self.tilted)
    }

    /// Whether an arc between two tips is kept. `axis`: the direction of the tool, a unit vector, if it is the same all the time.
    pub fn keep(self, arc: &TipArc, [from, to]: [[f64; 3]; 2], axis: Option<[f64; 3]>) -> bool {
        if self.all {
            return true;
        }
        let (centre, normal) = (arc.centre(), arc.normal());
        let [a, b] = [from, to].map(|end| {
            let out: [f64; 3] = std::array::from_fn(|k| end[k] - centre[k]);
            let along: f64 = (0..3).map(|k| out[k] * normal[k]).sum();
            let across: [f64; 3] = std::array::from_fn(|k| out[k] - along * normal[k]);
            [across[0].hypot(across[1]).hypot(across[2]), along]
        });
        let radius = a[0].max(b[0]);
        let Some(stance) = axis.and_then(|axis| Stance::new(arc, radius, axis)) else {
            return false;
        };
        let (asked, least) = match stance {
            Stance::Level => (self.level, 0.0),
            Stance::Upright => (self.upright, WORTH),
            Stance::Tilted => (self.tilted, WORTH_TILTED),
        };
        // A chord over 2h leaves r (1 − cos h) = 2 r sin²(h/2).
        let half = 2.0 * (self.tolerance / (2.0 * a[0])).sqrt().min(0.7).asin();
        let worth = arc.angle().abs() >= least * 2.0 * half;
        let flat = stance == Stance::Level || (a[1] - b[1]).abs() <= SPIRAL;
        asked
            && worth
            && flat
            && (a[0] - b[0]).abs() <= SPIRAL
            && radius <= LARGEST.min(LARGEST_IN_CHORDS * self.tolerance)
    }
}
