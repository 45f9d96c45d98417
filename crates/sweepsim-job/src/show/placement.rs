//! Placements of a tool along its moves, for show: the way between two of them is taken as a chord.

use sweepsim::motion::{Path, Pose, Segment, Tool};

/// A placement of a tool.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    pub tip: [f64; 3],
    pub axis: [f64; 3],
    pub side: [f64; 3],
}

fn mixed(a: [f64; 3], b: [f64; 3], t: f64) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * t)
}

pub(crate) fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

impl Placement {
    pub fn of(segment: &Segment, t: f64) -> Self {
        let (turn, tip) = segment.at(t);
        Self {
            tip,
            axis: turn.column(2).into_owned().into(),
            side: turn.column(0).into_owned().into(),
        }
    }

    /// The placement at a time (0 to 1) of a move.
    pub fn at(path: &Path, number: usize, time: f64, reach: f64) -> Self {
        // They have equal durations; motions that are no SLERP are followed to a thousandth of the tool's length.
        let segments = path.segments(number, reach, 1e-3 * reach);
        let at = time * segments.len() as f64;
        let index = (at as usize).min(segments.len() - 1);
        Self::of(&segments[index], at - index as f64)
    }

    /// The placement at the start of a path.
    pub fn first(path: &Path) -> Option<Self> {
        if path.moves() == 0 {
            return None;
        }
        path.segments(0, 1.0, 1.0).first().map(|segment| Self::of(segment, 0.0))
    }

    pub fn between(&self, other: &Self, t: f64) -> Self {
        Self {
            tip: mixed(self.tip, other.tip, t),
            axis: mixed(self.axis, other.axis, t),
            side: mixed(self.side, other.side, t),
        }
    }

    /// How far the tool is from another placement: tip and a point up its axis.
    pub fn far(&self, other: &Self, reach: f64) -> f64 {
        let up = |place: &Self| [0, 1, 2].map(|k| place.tip[k] + reach * place.axis[k]);
        distance(self.tip, other.tip).max(distance(up(self), up(other)))
    }

    pub fn pose(&self, tool: &Tool) -> Option<Pose> {
        if tool.is_revolved() {
            Pose::new(self.tip, self.axis).ok()
        } else {
            Pose::with_side(self.tip, self.axis, self.side).ok()
        }
    }

    /// Where a point of the tool is.
    pub fn point(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let turned = self.direction([x, y, z]);
        [0, 1, 2].map(|k| self.tip[k] + turned[k])
    }

    /// Where a direction of the tool points.
    pub fn direction(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let (u, w) = (self.side, self.axis);
        let v = [0, 1, 2].map(|k| w[(k + 1) % 3] * u[(k + 2) % 3] - w[(k + 2) % 3] * u[(k + 1) % 3]);
        [0, 1, 2].map(|k| x * u[k] + y * v[k] + z * w[k])
    }
}

/// The placements along a move up to a time (0 to 1) of it, without its first: chords are within `room` of the motion.
pub(crate) fn placements(path: &Path, number: usize, until: f64, reach: f64, room: f64) -> Vec<Placement> {
    fn split(
        segment: &Segment,
        [a, b]: [(f64, Placement); 2],
        reach: f64,
        room: f64,
        depth: u32,
        out: &mut Vec<Placement>,
    ) {
        let near = |t: f64| {
            let at = Placement::of(segment, a.0 + (b.0 - a.0) * t);
            at.far(&a.1.between(&b.1, t), reach) <= room
        };
        // A full turn comes back to where it began.
        if depth == 0 || (near(0.5) && near(0.23)) {
            out.push(b.1);
            return;
        }
        let t = 0.5 * (a.0 + b.0);
        let middle = (t, Placement::of(segment, t));
        split(segment, [a, middle], reach, room, depth - 1, out);
        split(segment, [middle, b], reach, room, depth - 1, out);
    }
    let mut out = Vec::new();
    let segments = path.segments(number, reach, room);
    // They have equal durations.
    let end = until * segments.len() as f64;
    for (k, segment) in segments.iter().enumerate() {
        let until = (end - k as f64).min(1.0);
        if until > 0.0 {
            let ends = [0.0, until].map(|t| (t, Placement::of(segment, t)));
            split(segment, ends, reach, room, 7, &mut out);
        }
    }
    out
}
