//! The direction of a move, seen from the tool.

use super::super::curves::SHORTEST;
use super::super::rows::{Floor, Ground, Ring};
use super::chart::Range;
use super::polar::{Centre, Wedge};
use super::tree::widened;
use crate::algebra::ranges::{Triples, products};
use crate::cutter::cells::Cells;
use crate::cutter::patch_forms::PatchForms;
use crate::time::circles::LevelArc;
use nalgebra::{Matrix3, Vector3};
use sweepsim_motion::{Segment, turned_back};

/// Directions that agree in so many parts of a unit share their cells: far more than the displacements of tips change them by.
const FINENESS: f64 = 1_048_576.0;
/// So no component of a direction is farther than this from the one that stands for it: rounded, and made a unit vector again.
const SPREAD: f64 = 4.0 / FINENESS;
/// The spread of a spin in units of that of directions over the radius. A spin is the length of the direction's horizontal part over the radius: members of a family differ from it by half the spread in each component, which makes
/// `√½` of these units, and by half the spread of the radius, `½` of them; and like those, its spread is at least twice that.
const SPREAD_OF_SPIN: f64 = 3.0;

/// The direction of travel at the start of an arc, in the coordinates of a tool of revolution that stands along the dexels: how such a tool has turned about its own axis is arbitrary. Not
/// along the seams of its patches, nor across them.
const START: [f64; 2] = [0.761_245_135, 0.648_464_164];

/// A move without rotation, or an arc with which the tool turns, in the direction in which its family goes: arcs turn left.
#[derive(Clone, Debug)]
pub(super) struct DirectedMotion {
    /// The height of the tip, and its rise.
    pub from: f64,
    pub rise: f64,
    /// Of the way, in `q`.
    pub length: f64,
    pub ground: Ground,
    /// Whether it is traversed backwards: then the time runs from 1 to 0.
    reversed: bool,
    pub system_rounding: f64,
    pub own: Directions,
    /// The tool's turn, and the directions of `q` at the start and of the way, in space.
    turn: Matrix3<f64>,
    ahead: [f64; 2],
    way: [f64; 3],
}

/// Directions, in the tool's coordinates.
#[derive(Clone, Debug)]
pub(super) struct Directions {
    /// Those of `q`, `p` and `z`.
    pub rows: [[f64; 3]; 3],
    /// The unit vector along the way.
    pub way: [f64; 3],
    /// No component of a direction that these stand for differs by more.
    pub spread: f64,
    /// Whether the move goes the other way. A family is for both ways.
    pub backwards: bool,
    /// Of an arc.
    pub centre: Option<Centre>,
    /// The angular velocity about the dexels' direction, with the velocity of the tip as long as [`way`](Self::way) says: that of an arc with which a tool turns that is not of revolution.
    pub spin: f64,
    /// No spin that this one stands for differs by more.
    pub spin_spread: f64,
}

/// What all directions of a family have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Key {
    turn: [u64; 9],
    ahead: [i32; 2],
    way: [i32; 3],
    /// Of an arc.
    radius: Option<u64>,
}

impl Directions {
    fn new(turn: &Matrix3<f64>, [x, y]: [f64; 2], way: [f64; 3], spread: f64) -> Self {
        let seen = |v: [f64; 3]| turn.tr_mul(&Vector3::from(v)).into();
        Self {
            rows: [seen([x, y, 0.0]), seen([-y, x, 0.0]), seen([0.0, 0.0, 1.0])],
            way: turned_back(turn, &way.into()).into(),
            spread,
            backwards: false,
            centre: None,
            spin: 0.0,
            spin_spread: 0.0,
        }
    }

    /// The same of an arc. `turns`: the tool, which is not of revolution.
    fn around(self, centre: Centre, turns: bool) -> Self {
        let [x, y, _] = self.way;
        let (spin, spin_spread) = if turns {
            (x.hypot(y) / centre.radius, SPREAD_OF_SPIN * self.spread / centre.radius)
        } else {
            (0.0, 0.0)
        };
        Self {
            centre: Some(centre),
            spin,
            spin_spread,
            ..self
        }
    }

    /// The angular velocity and the velocity of the tip, in the tool's coordinates.
    pub fn twist(&self) -> [[f64; 3]; 2] {
        [self.rows[2].map(|x| x * self.spin), self.way]
    }

    /// The velocity of a point of the tool.
    pub fn velocity(&self, point: &Vector3<f64>) -> Vector3<f64> {
        let [spin, way] = self.twist().map(Vector3::from);
        way + spin.cross(point)
    }

    /// Whether these stand for others.
    fn are_near(&self, others: &Self) -> bool {
        let pairs = self.rows.iter().zip(&others.rows).chain([(&self.way, &others.way)]);
        let radii = match (&self.centre, &others.centre) {
            (Some(a), Some(b)) => (a.radius - b.radius).abs() <= 0.5 * a.spread,
            (a, b) => a.is_none() && b.is_none(),
        };
        let mut numbers = pairs.flat_map(|(a, b)| a.iter().zip(b));
        let spins = (self.spin - others.spin).abs() <= 0.5 * self.spin_spread;
        radii && spins && numbers.all(|(a, b)| (a - b).abs() <= 0.5 * self.spread)
    }

    /// A cell as it is seen from the centre of an arc, if its points may be off by so much.
    pub fn wedge(&self, position: &Triples, off: f64) -> Option<Wedge> {
        Some(self.centre.as_ref()?.wedge(&self.rows, position, off))
    }

    /// The ranges of `q` and `p` over a cell with these control points, which may be off by so much, with the rounding error of coordinates.
    pub fn ranges(&self, position: &Triples, off: f64, system_rounding: f64) -> [Range; 2] {
        match (&self.centre, self.wedge(position, off)) {
            (Some(centre), Some(wedge)) => [
                wedge.q(system_rounding),
                widened(wedge.p(centre.spread), system_rounding),
            ],
            _ => [0, 1].map(|k| widened(products(&[self.rows[k]], position), off + system_rounding)),
        }
    }

    /// The ranges of the derivatives of `q` and `p` along one variable over a prepared cell, where those of its points may be off by so much; and by how much that of `p`
    /// may differ over a family.
    pub fn slopes(
        &self,
        (element, cells, cell): (&PatchForms, &Cells, u32),
        wedge: Option<&Wedge>,
        (axis, off): (usize, f64),
    ) -> ([Range; 2], f64) {
        let along = |row: &[f64; 3]| widened(cells.slope_products(element, cell, axis, &[*row]), off);
        match wedge {
            None => ([along(&self.rows[0]), along(&self.rows[1])], off),
            Some(wedge) => {
                let axes = wedge.axes.each_ref().map(along);
                (wedge.slopes(axes), off + wedge.blur(axes))
            }
        }
    }
}

/// A radius to 20 bits.
fn rounded_radius(radius: f64) -> f64 {
    const REST: u64 = (1 << 32) - 1;
    f64::from_bits((radius.to_bits() + (1 << 31)) & !REST)
}

fn unit<const N: usize>(v: [f64; N]) -> [f64; N] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

impl DirectedMotion {
    /// `None` for moves that turn, or have too little travel across the dexels. `system_rounding`: the rounding error of
    /// coordinates that all systems allow for.
    pub fn new(segment: &Segment, system_rounding: f64) -> Option<Self> {
        if !segment.is_arc() || segment.turns().len() != 1 {
            return None;
        }
        let [mut from, to] = segment.tips();
        let mut way = segment.travel();
        let length = way[0].hypot(way[1]);
        let size = length.hypot(way[2]);
        // NaN is refused, too.
        if !(length > SHORTEST * system_rounding && size.is_finite()) {
            return None;
        }
        // The first component that is not almost 0 is positive.
        let reversed = way[..2]
            .iter()
            .map(|x| (x / length * FINENESS).round())
            .find(|x| *x != 0.0)
            .is_some_and(|x| x < 0.0);
        if reversed {
            (from, way) = (to, way.map(|x| -x));
        }
        let (turn, ahead) = (segment.start(), [way[0] / length, way[1] / length]);
        let floor = Floor {
            tip: from,
            ahead,
            rounding: system_rounding,
        };
        Some(Self {
            from: from[2],
            rise: way[2],
            length,
            ground: Ground::Floor(floor),
            reversed,
            system_rounding,
            own: Directions {
                backwards: reversed,
                ..Directions::new(&turn, ahead, way.map(|x| x / size), 0.0)
            },
            turn,
            ahead,
            way,
        })
    }

    /// An arc of a tool that stands along the dexels and turns with it, and the same as a segment. `None` if it is too short.
    ///
    /// In the frame that turns with the arc, the velocity of a tool of revolution is that of a translation along the tangent, but for a turn about the tool's own axis, which moves no point
    /// out of its surface: `g` is that of the translation. Other tools keep that turn.
    pub fn around(level_arc: &LevelArc, segment: &Segment, system_rounding: f64) -> Option<Self> {
        let (radius, angle) = (level_arc.radius, level_arc.angle.abs());
        let [first, last] = segment.tips();
        let climb = segment.travel()[2];
        if !(level_arc.length() > SHORTEST * system_rounding && level_arc.length().hypot(climb).is_finite()) {
            return None;
        }
        let reversed = level_arc.angle < 0.0;
        let (from, rise, out) = if reversed {
            (last[2], -climb, level_arc.out(1.0))
        } else {
            (first[2], climb, level_arc.from)
        };
        let ahead = unit(match level_arc.tool_x {
            None => START,
            // The tangent to the left, as seen along the tool's x and y: the same at both ends.
            Some([x, y]) => {
                let [a, b] = level_arc.from;
                [a * y - b * x, a * x + b * y]
            }
        });
        let (turn, centre) = (Matrix3::identity(), Centre { radius, spread: 0.0 });
        let way = [ahead[0] * radius * angle, ahead[1] * radius * angle, rise];
        let ring = Ring {
            centre: level_arc.centre,
            radius,
            from: out,
            rounding: system_rounding,
        };
        let own = Directions::new(&turn, ahead, unit(way), 0.0).around(centre, level_arc.tool_x.is_some());
        Some(Self {
            from,
            rise,
            length: angle,
            ground: Ground::Ring(ring),
            reversed,
            system_rounding,
            own: Directions {
                backwards: reversed,
                ..own
            },
            turn,
            ahead,
            way,
        })
    }

    /// The family of a motion: a function of its own direction alone, so that results do not depend on which motions were taken before.
    pub fn family(&self) -> Option<(Key, Directions)> {
        let rounded = |x: f64| (x * FINENESS).round();
        let (ahead, way) = (self.ahead.map(rounded), unit(self.way).map(rounded));
        let mut bits = [0; 9];
        for (bits, x) in bits.iter_mut().zip(self.turn.iter()) {
            *bits = x.to_bits();
        }
        let centre = self.own.centre.map(|centre| {
            let radius = rounded_radius(centre.radius);
            let spread = SPREAD * radius;
            Centre { radius, spread }
        });
        let key = Key {
            turn: bits,
            ahead: ahead.map(|x| x as i32),
            way: way.map(|x| x as i32),
            radius: centre.map(|centre| centre.radius.to_bits()),
        };
        let mut directions = Directions::new(&self.turn, unit(ahead), unit(way), SPREAD);
        if let Some(centre) = centre {
            directions = directions.around(centre, self.own.spin > 0.0);
        }
        directions.are_near(&self.own).then_some((key, directions))
    }

    /// A share of the time of the move.
    pub fn time(&self, share: f64) -> f64 {
        if self.reversed { 1.0 - share } else { share }
    }
}
