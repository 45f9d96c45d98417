//! The lines that a disc covers while its centre moves along an arc, counted one by one.

use crate::methods::harvest::Collector;
use crate::methods::sheets::numbers;
use crate::time::circles::LevelArc;
use std::f64::consts::PI;

/// A disc along an arc.
#[derive(Clone, Copy, Debug)]
pub(super) struct Around {
    pub arc: LevelArc,
    pub radius: f64,
    /// How far its boundary may be off.
    pub doubt: f64,
}

impl Around {
    /// The extent of all discs along an axis.
    pub fn extent(&self, axis: usize) -> [f64; 2] {
        let arc = &self.arc;
        let offset = axis as f64 * 0.5 * PI;
        let start = arc.from[1].atan2(arc.from[0]) - offset;
        let ends = [start.min(start + arc.angle), start.max(start + arc.angle)];
        let mut range = [ends[0].cos().min(ends[1].cos()), ends[0].cos().max(ends[1].cos())];
        for (k, whole) in [(1, 0.0), (0, PI)] {
            let turns = |angle: f64| ((angle - whole) / (2.0 * PI)).floor();
            if turns(ends[0]) != turns(ends[1]) {
                range[k] = if k == 1 { 1.0 } else { -1.0 };
            }
        }
        let centre = arc.centre[axis];
        [
            centre + arc.radius * range[0] - self.radius,
            centre + arc.radius * range[1] + self.radius,
        ]
    }

    /// For how many intervals of times a point is covered; `None` if it is too close to a boundary.
    ///
    /// The centre of the disc is near enough while it is within an angle `δ` of the point's direction.
    fn count(&self, [x, y]: [f64; 2]) -> Option<i32> {
        let (arc, radius) = (&self.arc, self.radius);
        let [dx, dy] = [x - arc.centre[0], y - arc.centre[1]];
        let distance = dx.hypot(dy);
        let near = |a: f64, b: f64| !((a - b).abs() > self.doubt);
        let end = |share: f64| {
            let [ox, oy] = arc.out(share);
            (dx - arc.radius * ox).hypot(dy - arc.radius * oy)
        };
        if near(distance, arc.radius + radius)
            || near(distance, (arc.radius - radius).abs())
            || near(end(0.0), radius)
            || near(end(1.0), radius)
        {
            return None;
        }
        let cosine = (arc.radius * arc.radius + distance * distance - radius * radius) / (2.0 * arc.radius * distance);
        if cosine >= 1.0 {
            return Some(0);
        }
        // NaN in the centre: covered always.
        if !(cosine > -1.0) {
            return Some(1);
        }
        let width = cosine.acos();
        let [fx, fy] = arc.from;
        let own = (arc.side() * (dy * fx - dx * fy)).atan2(dx * fx + dy * fy);
        let meets = |turn: f64| own + turn - width <= arc.angle.abs() && own + turn + width >= 0.0;
        Some(
            [-2.0 * PI, 0.0, 2.0 * PI]
                .map(|turn| i32::from(meets(turn)))
                .iter()
                .sum(),
        )
    }

    /// Calls `add` with each line that is covered, and how often; those at a boundary are open.
    pub fn each(&self, lines: &mut Collector, mut add: impl FnMut(usize, usize, i32)) {
        let lattice = lines.lines;
        let wide = |k: usize| {
            let [low, high] = self.extent(k);
            numbers(lattice, k, [low - self.doubt, high + self.doubt])
        };
        let (Some(is), Some(js)) = (wide(0), wide(1)) else {
            return;
        };
        for i in is[0]..=is[1] {
            let x = lattice.coordinate(0, i);
            for j in js[0]..=js[1] {
                match self.count([x, lattice.coordinate(1, j)]) {
                    Some(0) => {}
                    Some(count) => add(i, j, count),
                    None if lattice.asks(i, j) => lines.open(lattice.line(i, j)),
                    None => {}
                }
            }
        }
    }
}
