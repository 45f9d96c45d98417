//! The frame of a move: along it, across it, and along the dexels.

use super::Local;
use crate::time::circles::LevelArc;
use crate::time::path_parts::{PartKind, PathPart};
use nalgebra::{Matrix3, Vector3};
use sweepsim_motion::{Segment, turned_back};

/// Horizontal travel shorter than this many roundings has no reliable direction.
pub(crate) const SHORTEST: f64 = 8.0;

/// A move without rotation, as closed forms need it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Heading {
    /// The tip at the start.
    pub tip: [f64; 3],
    /// `d`.
    pub way: [f64; 3],
    /// The horizontal direction of `d`.
    pub ahead: [f64; 2],
    /// The length of its horizontal part.
    pub length: f64,
    /// `|d|`.
    pub speed: f64,
    /// In `(q, p, z)`: the directions across the tool's axis in which it travels and to the left of that, and the axis.
    pub axes: [Local; 3],
    /// How far it travels across its own axis,
    pub across: f64,
    /// and along it.
    pub along: f64,
    /// Whether the tool's axis is exactly that of the dexels.
    pub upright: bool,
    /// The rounding error of coordinates.
    pub slack: f64,
}

/// Whether a tool turned by `turn` stands exactly along the dexels.
fn is_upright(turn: &Matrix3<f64>) -> bool {
    let up = [0.0, 0.0, 1.0];
    (0..3).all(|k| turn[(k, 2)] == up[k] && turn[(2, k)] == up[k])
}

/// Whether the tool stands exactly along the dexels all the time, and does not turn but with an arc.
pub(crate) fn stands(part: &PathPart) -> bool {
    let segment = &part.segment;
    let still = segment.turns().len() == 1 && is_upright(&segment.turns()[0]);
    match part.kind {
        PartKind::LevelArc(_) => true,
        PartKind::VerticalArc(_) => still,
        PartKind::Joins(_) | PartKind::Other => still && segment.is_arc(),
    }
}

/// The rounding error of the coordinates that closed forms compute, products of a few rounded numbers, from the one that all systems allow for: a
/// quarter of it, or 16 roundings of the largest coordinate.
pub(crate) fn slack(system_rounding: f64) -> f64 {
    0.25 * system_rounding
}

impl Heading {
    /// `None` for moves that turn, or have too little travel across the dexels. `system_rounding`: the rounding error that all systems allow for.
    pub fn new(segment: &Segment, system_rounding: f64) -> Option<Self> {
        if !segment.is_arc() || segment.turns().len() != 1 {
            return None;
        }
        let turn = segment.start();
        let way: Vector3<f64> = segment.travel().into();
        let slack = slack(system_rounding);
        let length = way.x.hypot(way.y);
        let own = turned_back(&turn, &way);
        let across = own.x.hypot(own.y);
        // NaN is refused, too.
        if !(length > SHORTEST * slack && across > SHORTEST * slack) {
            return None;
        }
        let ahead = [way.x / length, way.y / length];
        let local = |v: Vector3<f64>| seen(ahead, [v.x, v.y, v.z]);
        let [c, s] = [own.x / across, own.y / across];
        let upright = is_upright(&turn);
        let axes = if upright {
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
        } else {
            let [x, y, z] = [0, 1, 2].map(|k| turn.column(k).into_owned());
            [local(x * c + y * s), local(y * c - x * s), local(z)]
        };
        Some(Self {
            tip: segment.tips()[0],
            way: way.into(),
            ahead,
            length,
            speed: way.norm(),
            axes,
            across,
            along: own.z,
            upright,
            slack,
        })
    }

    /// The tangent of an arc, as long as the arc. `None` if it is too short.
    pub fn around(level_arc: &LevelArc, segment: &Segment, system_rounding: f64) -> Option<Self> {
        let (slack, length) = (slack(system_rounding), level_arc.length());
        let rise = segment.travel()[2];
        (length > SHORTEST * slack && rise.is_finite()).then(|| Self {
            tip: segment.tips()[0],
            way: [length, 0.0, rise],
            ahead: [1.0, 0.0],
            length,
            speed: length.hypot(rise),
            axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            across: length,
            along: rise,
            upright: true,
            slack,
        })
    }

    /// How far a tool turned by `turn` travels along its axis: as all headings have it.
    pub fn along_axis(turn: &Matrix3<f64>, way: [f64; 3]) -> f64 {
        turned_back(turn, &way.into()).z
    }

    /// `d_a/d_⊥`: the slope of the move, seen from the tool's axis.
    pub fn slope(&self) -> f64 {
        self.along / self.across
    }

    /// `d` in `(q, p, z)`.
    pub fn local_way(&self) -> Local {
        [self.length, 0.0, self.way[2]]
    }

    /// A direction in `(q, p, z)`, in space.
    pub fn in_space(&self, [q, p, z]: Local) -> [f64; 3] {
        let [x, y] = self.ahead;
        [x * q - y * p, y * q + x * p, z]
    }

    /// As [`in_space`](Self::in_space), of length 1.
    #[inline]
    pub fn unit_in_space(&self, direction: Local) -> [f32; 3] {
        let [x, y, z] = self.in_space(direction);
        let square = x * x + y * y + z * z;
        let scale = if square > 0.0 { square.sqrt().recip() } else { 1.0 };
        [x, y, z].map(|c| (c * scale) as f32)
    }

    /// A point of the tool's frame: `radius` in the direction with cosine `c` and sine `s` from that of the travel, at a height.
    pub fn point(&self, radius: f64, [c, s]: [f64; 2], height: f64) -> Local {
        let [e, f, a] = &self.axes;
        [0, 1, 2].map(|k| radius * (c * e[k] + s * f[k]) + height * a[k])
    }
}

fn seen([x, y]: [f64; 2], v: [f64; 3]) -> Local {
    [x * v[0] + y * v[1], x * v[1] - y * v[0], v[2]]
}
