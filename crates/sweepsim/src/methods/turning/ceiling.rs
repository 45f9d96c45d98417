//! The ceiling of a tool that leans or turns.
//!
//! The level plane at the ceiling meets the tool only on a cylinder about its axis, or on the ball that it ends in, at
//! all times. With `w` from the tip to a line's point in that plane and `e` from the nearest point of the axis at or
//! above the centre of the ball, at the height `ζ = max(⟨w, a⟩, ζ_c)`, the tool covers the point where
//! `E = |e|² − r² < 0`, where
//!
//! ```text
//! e = w − ζ a,  E′/2 = −⟨e, b′ + ζ a′⟩,
//! E″/2 = S² + 2 τ⟨e, a′⟩ − ⟨e, a′⟩² − ⟨e, b″ + ζ a″⟩  on the cylinder,
//! E″/2 = |C′|² − ⟨e, C″⟩                              on the ball,
//! ```
//!
//! with the part `S` of `b′ + ζ a′` across the axis, `τ = ⟨b′, a⟩`, and the centre `C` of the ball. `E′` does not jump.
//! Where `E″ ≥ 0` for all lines, each is covered for one interval of times, or never. So the count of a line is the
//! number of spans at whose start it is not covered, but later, and one more if the tool covers it from the beginning.

mod span;

use super::axis_motion::{AxisMotion, Bounds, Moment};
use crate::cutter::outline::{Ball, Outline, Piece, Shape};
use crate::methods::harvest::Collector;
use crate::methods::sheets::Counts;
use crate::methods::translation::GAP;
use crate::time::path_parts::{PartKind, PathPart};
use span::CeilingSpan;
use sweepsim_motion::Segment;

/// The least vertical component of an axis.
const STEEP: f64 = 0.1;
/// A part is halved this many times at most.
const DEEPEST: u32 = 4;

/// A height above all material at which the tool is a cylinder, or a ball with a cylinder on it, along some moves.
#[derive(Clone, Debug)]
pub(crate) struct LeaningCeiling {
    pub z: f64,
    radius: f64,
    /// The height of the ball's centre; −∞ if the plane meets the cylinder only.
    centre: f64,
    /// Of each part, a height on the axis: what is farther from the tip is above the ceiling.
    pub highest: Vec<f64>,
    /// The parts, divided so that a line is covered for one interval of times.
    spans: Vec<(usize, [f64; 2])>,
}

/// Bounds of the poses along a part, of its control values.
struct Poses {
    /// The heights of the tip.
    tip: [f64; 2],
    /// The vertical component of the axis, and the longest horizontal part.
    rise: [f64; 2],
    lean: f64,
}

impl Poses {
    /// `None` where the tool is no solid of the kind that is counted here, or too steep.
    fn new(part: &PathPart) -> Option<Self> {
        let segment = &part.segment;
        if !matches!(part.kind, PartKind::Joins(_) | PartKind::Other) {
            return None;
        }
        let hull = |[low, high]: [f64; 2], at: f64| [low.min(at), high.max(at)];
        let nothing = [f64::INFINITY, f64::NEG_INFINITY];
        let (points, weights) = segment.points();
        let heights = points.iter().zip(weights).map(|(point, weight)| point.z / weight);
        let (mut rise, mut lean) = (nothing, 0.0_f64);
        for (turn, weight) in segment.turns().iter().zip(segment.weights()) {
            rise = hull(rise, turn[(2, 2)] / weight);
            lean = lean.max(turn[(2, 0)].hypot(turn[(2, 1)]) / weight);
        }
        (rise[0] > STEEP).then_some(Self {
            tip: heights.fold(nothing, hull),
            rise,
            lean,
        })
    }

    /// The greatest height of what is no higher on the axis than this, and no farther from it than `radius`.
    fn top(&self, height: f64, radius: f64) -> f64 {
        self.tip[1] + self.rise.map(|rise| height * rise).into_iter().fold(f64::MIN, f64::max) + radius * self.lean
    }

    /// The height on the axis from which on all that is no farther from it than `radius` is above a level.
    fn beyond(&self, z: f64, radius: f64) -> f64 {
        ((z - self.tip[0] + radius * self.lean) / self.rise[0]).max(0.0)
    }
}

/// What cylinders about the axis are asked for.
struct Asked<'a> {
    outline: &'a Outline,
    poses: &'a [Poses],
    /// The highest material, and how far the ceiling is from it and from the ends of the cylinder, at least.
    top: f64,
    gap: f64,
    /// Coordinates on the tool this close are the same.
    same: f64,
}

impl Asked<'_> {
    /// The largest radius of what begins below a height.
    fn widest(&self, height: f64) -> f64 {
        let pieces = self.outline.pieces.iter().filter(|piece| piece.heights()[0] < height);
        let radii = pieces.map(|piece| match piece.shape {
            Shape::Line { .. } => piece.from[0].max(piece.to[0]),
            Shape::Arc { centre, radius, .. } => centre[0] + radius,
        });
        radii.fold(0.0, f64::max)
    }

    /// The lowest ceiling on a cylinder, without spans, unless it is so high that the tool cut off is shorter.
    fn on(&self, piece: &Piece) -> Option<LeaningCeiling> {
        if !matches!(piece.shape, Shape::Line { normal: [1.0, _] }) {
            return None;
        }
        let (radius, [low, high], gap) = (piece.from[0], piece.heights(), self.gap);
        let near = |a: f64, b: f64| (a - b).abs() <= self.same;
        // No other piece is beside it.
        let is_below = |other: &&Piece| other.heights()[1] <= low || near(other.heights()[1], low);
        let is_above = |other: &Piece| other.heights()[0] >= high || near(other.heights()[0], high);
        let others = self
            .outline
            .pieces
            .iter()
            .filter(|other| other.patches != piece.patches);
        let (below, above): (Vec<&Piece>, Vec<&Piece>) = others.partition(is_below);
        if !above.into_iter().all(is_above) {
            return None;
        }
        let is_end =
            |ball: &Ball| near(ball.radius, radius) && near(ball.centre, low) && ball.ends[0] == f64::NEG_INFINITY;
        let ball = match below[..] {
            [one] => one.ball().filter(is_end),
            _ => None,
        };
        let own = self.widest(high);
        let bottoms = self.poses.iter().map(|poses| poses.top(low, own));
        let z = gap
            + match ball {
                Some(_) => self.top,
                None => bottoms.fold(self.top, f64::max),
            };
        let wide = self.widest(f64::INFINITY);
        let ends = self.poses.iter().map(|poses| poses.beyond(z + gap, wide));
        let fits = ends.fold(0.0, f64::max) < high - gap && z <= self.top + own + gap;
        fits.then(|| LeaningCeiling {
            z,
            radius,
            centre: ball.map_or(f64::NEG_INFINITY, |ball| ball.centre),
            highest: self.poses.iter().map(|poses| poses.beyond(z, own)).collect(),
            spans: Vec::new(),
        })
    }
}

impl LeaningCeiling {
    /// The lowest one for these moves, if there is any. `top`: the highest material.
    pub fn new(outline: &Outline, reach: f64, parts: &[PathPart], top: f64) -> Option<Self> {
        if !outline.complete {
            return None;
        }
        let poses = parts.iter().map(Poses::new).collect::<Option<Vec<_>>>()?;
        let asked = Asked {
            outline,
            poses: &poses,
            top,
            gap: GAP * reach,
            same: 4.0 * f64::EPSILON * reach,
        };
        let found = outline.pieces.iter().filter_map(|piece| asked.on(piece));
        let mut lowest = found.min_by(|a, b| a.z.total_cmp(&b.z))?;
        for (number, part) in parts.iter().enumerate() {
            lowest.divide(number, &motion(&part.segment)?)?;
        }
        Some(lowest)
    }

    /// Divides a part; `None` if that does not help.
    fn divide(&mut self, part: usize, motion: &AxisMotion) -> Option<()> {
        let mut waiting = vec![(0.0, 1.0, 0)];
        while let Some((from, to, depth)) = waiting.pop() {
            let ends = [motion.at(from), motion.at(to)];
            let ends = [&ends[0], &ends[1]];
            if self.is_convex(ends, &motion.bounds(ends)) {
                self.spans.push((part, [from, to]));
            } else if depth < DEEPEST {
                let middle = 0.5 * (from + to);
                waiting.push((middle, to, depth + 1));
                waiting.push((from, middle, depth + 1));
            } else {
                return None;
            }
        }
        Some(())
    }

    /// How far the plane is above the tip, at most, and along the axis from there to any line that the tool covers in
    /// the span, at any time of it.
    fn heights(&self, ends: [&Moment; 2], bounds: &Bounds) -> [f64; 2] {
        let above = ends
            .map(|end| (self.z - end.tip.z).abs() + bounds.sag(bounds.acceleration))
            .into_iter()
            .fold(0.0, f64::max);
        let far = if self.centre.is_finite() {
            self.centre.abs()
        } else {
            0.0
        };
        let most = far.max((above + self.radius) / bounds.rise[0]) + self.radius + bounds.speed * bounds.length;
        [above, most]
    }

    /// Whether `E` is convex for all lines that the tool covers at any time of the span.
    fn is_convex(&self, ends: [&Moment; 2], bounds: &Bounds) -> bool {
        let (rise, half) = (bounds.rise[0], 0.5 * bounds.length);
        if !(rise > STEEP) {
            return false;
        }
        let [above, most] = self.heights(ends, bounds);
        let reach = self.radius + (bounds.speed + most * bounds.rate) * bounds.length;
        let least = |speeds: [f64; 2], change: f64| (speeds[0].min(speeds[1]) - change).max(0.0);
        // `S` where the axis meets the plane, which other lines are at most this far away from.
        let middle = ends.map(|end| {
            let height = (self.z - end.tip.z) / end.axis.z;
            (end.velocity - end.axis * end.along + end.rate * height).norm()
        });
        let drift = bounds.acceleration
            + (bounds.speed + above * bounds.rate / rise) * bounds.rate / rise
            + above / rise * bounds.bend
            + 2.0 * bounds.speed * bounds.rate;
        let across = least(middle, half * drift + reach * bounds.lean[1] / rise * bounds.rate);
        let along = ends.map(|end| end.along.abs()).into_iter().fold(0.0, f64::max) + half * bounds.along();
        let turn = reach * bounds.rate;
        let cylinder = across * across >= 1.01 * (2.0 * along * turn + turn * turn + reach * bounds.bow(most));
        let ball = || {
            let bow = bounds.bow(self.centre);
            let slow = least(
                ends.map(|end| (end.velocity + end.rate * self.centre).norm()),
                half * bow,
            );
            slow * slow >= 1.01 * reach * bow
        };
        cylinder && (self.centre == f64::NEG_INFINITY || ball())
    }

    /// How often the lines are covered; those closer than rounding to an end of that are open.
    pub fn counts(&self, parts: &[PathPart], slack: f64, lines: &mut Collector) -> Option<Counts> {
        let spans: Vec<CeilingSpan> = self
            .spans
            .iter()
            .filter_map(|(part, times)| CeilingSpan::new(self, motion(&parts[*part].segment)?, *times, slack))
            .collect();
        let hull = |k: usize| {
            let ranges = spans.iter().map(|span| span.area[k]);
            ranges.fold([f64::INFINITY, f64::NEG_INFINITY], |a, b| {
                [a[0].min(b[0]), a[1].max(b[1])]
            })
        };
        let mut counts = Counts::over(lines.lines, [hull(0), hull(1)])?;
        for (number, span) in spans.iter().enumerate() {
            span.add(number == 0, (&mut counts, lines));
        }
        Some(counts)
    }
}

fn motion(segment: &Segment) -> Option<AxisMotion> {
    AxisMotion::new(segment).or_else(|| AxisMotion::still(segment))
}

#[cfg(test)]
mod tests;
