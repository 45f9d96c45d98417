//! The direction of a move, seen from the tool.

use super::super::curves::SHORTEST;
use super::super::rows::Floor;
use super::chart::{Range, widened};
use crate::cutter::cells::Cells;
use crate::cutter::patch_forms::PatchForms;
use nalgebra::{Matrix3, Vector3};
use sweepsim_motion::{Segment, turned_back};

/// Directions that agree in so many parts of a unit share their cells: far more than the displacements of tips change them by.
const FINENESS: f64 = 1_048_576.0;
/// So no component of a direction is farther than this from the one that stands for it: rounded, and made a unit vector again.
const SPREAD: f64 = 4.0 / FINENESS;
/// A move without rotation, in the direction in which its family goes.
#[derive(Clone, Debug)]
pub(super) struct DirectedMotion {
    /// The height of the tip, and its rise.
    pub from: f64,
    pub rise: f64,
    /// Of the way, in `q`.
    pub length: f64,
    pub floor: Floor,
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
}

/// What all directions of a family have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Key {
    turn: [u64; 9],
    ahead: [i32; 2],
    way: [i32; 3],
}

impl Directions {
    fn new(turn: &Matrix3<f64>, [x, y]: [f64; 2], way: [f64; 3], spread: f64) -> Self {
        let seen = |v: [f64; 3]| turn.tr_mul(&Vector3::from(v)).into();
        Self {
            rows: [seen([x, y, 0.0]), seen([-y, x, 0.0]), seen([0.0, 0.0, 1.0])],
            way: turned_back(turn, &way.into()).into(),
            spread,
        }
    }

    /// Whether these stand for others.
    fn are_near(&self, others: &Self) -> bool {
        let pairs = self.rows.iter().zip(&others.rows).chain([(&self.way, &others.way)]);
        let mut numbers = pairs.flat_map(|(a, b)| a.iter().zip(b));
        numbers.all(|(a, b)| (a - b).abs() <= 0.5 * self.spread)
    }

    /// The ranges of the derivatives of `q` and `p` along one variable over a prepared cell, where those of its points may be off by so much.
    pub fn slopes(&self, (element, cells, cell): (&PatchForms, &Cells, u32), (axis, off): (usize, f64)) -> [Range; 2] {
        [0, 1].map(|k| widened(cells.slope_products(element, cell, axis, &[self.rows[k]]), off))
    }
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
            floor,
            reversed,
            system_rounding,
            own: Directions::new(&turn, ahead, way.map(|x| x / size), 0.0),
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
        let key = Key {
            turn: bits,
            ahead: ahead.map(|x| x as i32),
            way: way.map(|x| x as i32),
        };
        let directions = Directions::new(&self.turn, unit(ahead), unit(way), SPREAD);
        directions.are_near(&self.own).then_some((key, directions))
    }

    /// A share of the time of the move.
    pub fn time(&self, share: f64) -> f64 {
        if self.reversed { 1.0 - share } else { share }
    }
}
