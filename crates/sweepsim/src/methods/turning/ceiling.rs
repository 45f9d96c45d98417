//! The ceiling of a tool that leans or turns.
//!
//! The level plane at the ceiling meets the tool only on a cylinder about its axis, or on the ball that it ends in, at all times. With `w` from the tip to
//! a line's point in that plane and `e` from the nearest point of the axis at or above the centre of the ball, at the height `ζ = max(⟨w, a⟩, ζ_c)`,
//! the tool covers the point where `E = |e|² − r² < 0`, where
//!
//! ```text
//! e = w − ζ a,    E′/2 = −⟨e, b′ + ζ a′⟩,    E″/2 = S² + 2 τ⟨e, a′⟩ − ⟨e, a′⟩² − ζ⟨e, a″⟩    on the cylinder,
//!                                            E″/2 = |C′|² − ⟨e, C″⟩                             on the ball,
//! ```
//!
//! with the part `S` of `b′ + ζ a′` across the axis, `τ = ⟨b′, a⟩`, and the centre `C` of the ball. `E′` does not jump. Where `E″ ≥ 0` for all lines, each is
//! covered for one interval of times, or never. So the count of a line is the number of spans at whose start it is not covered, but later, and one more
//! if the tool covers it from the beginning.

use super::axis_motion::{AxisMotion, Bounds, Moment};
use crate::cutter::outline::{Ball, Outline, Piece, Shape};
use crate::methods::ceiling::Counts;
use crate::methods::harvest::Collector;
use crate::methods::sheets::{around, numbers};
use crate::methods::translation::GAP;
use crate::time::path_parts::{PartKind, PathPart};
use nalgebra::Vector3;
use sweepsim_motion::Segment;

/// The least vertical component of an axis.
const STEEP: f64 = 0.1;
/// A part is halved this many times at most,
const DEEPEST: u32 = 4;
/// and what is left of it for one line.
const DEEPEST_LINE: u32 = 12;

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
        if !segment.is_arc() || !matches!(part.kind, PartKind::Joins(_) | PartKind::Other) {
            return None;
        }
        let [a, b] = segment.tips().map(|tip| tip[2]);
        let (mut rise, mut lean) = ([f64::INFINITY, f64::NEG_INFINITY], 0.0_f64);
        for (turn, weight) in segment.turns().iter().zip(segment.weights()) {
            let up = turn[(2, 2)] / weight;
            rise = [rise[0].min(up), rise[1].max(up)];
            lean = lean.max(turn[(2, 0)].hypot(turn[(2, 1)]) / weight);
        }
        (rise[0] > STEEP).then_some(Self {
            tip: [a.min(b), a.max(b)],
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

impl LeaningCeiling {
    /// The lowest one for these moves, if there is any. `top`: the highest material.
    pub fn new(outline: &Outline, reach: f64, parts: &[PathPart], top: f64) -> Option<Self> {
        if !outline.complete {
            return None;
        }
        let poses = parts.iter().map(Poses::new).collect::<Option<Vec<_>>>()?;
        let gap = GAP * reach;
        let near = |a: f64, b: f64| (a - b).abs() <= 4.0 * f64::EPSILON * reach;
        // Of what begins below a height.
        let widest = |height: f64| {
            let pieces = outline.pieces.iter().filter(|piece| piece.heights()[0] < height);
            let radii = pieces.map(|piece| match piece.shape {
                Shape::Line { .. } => piece.from[0].max(piece.to[0]),
                Shape::Arc { centre, radius, .. } => centre[0] + radius,
            });
            radii.fold(0.0, f64::max)
        };
        let mut best: Option<Self> = None;
        for piece in &outline.pieces {
            if !matches!(piece.shape, Shape::Line { normal: [1.0, _] }) {
                continue;
            }
            let (radius, [low, high]) = (piece.from[0], piece.heights());
            // No other piece is beside it.
            let is_below = |other: &Piece| other.heights()[1] <= low || near(other.heights()[1], low);
            let is_above = |other: &Piece| other.heights()[0] >= high || near(other.heights()[0], high);
            let others = outline.pieces.iter().filter(|other| other.patches != piece.patches);
            let (below, above): (Vec<&Piece>, Vec<&Piece>) = others.partition(|other| is_below(other));
            if !above.into_iter().all(is_above) {
                continue;
            }
            let is_end =
                |ball: &Ball| near(ball.radius, radius) && near(ball.centre, low) && ball.ends[0] == f64::NEG_INFINITY;
            let ball = match below[..] {
                [one] => one.ball().filter(is_end),
                _ => None,
            };
            let own = widest(high);
            let mut z = top;
            if ball.is_none() {
                z = poses.iter().map(|poses| poses.top(low, own)).fold(z, f64::max);
            }
            z += gap;
            let ends = poses.iter().map(|poses| poses.beyond(z + gap, widest(f64::INFINITY)));
            if ends.fold(0.0, f64::max) < high - gap && best.as_ref().is_none_or(|best| z < best.z) {
                best = Some(Self {
                    z,
                    radius,
                    centre: ball.map_or(f64::NEG_INFINITY, |ball| ball.centre),
                    highest: poses.iter().map(|poses| poses.beyond(z, own)).collect(),
                    spans: Vec::new(),
                });
            }
        }
        let mut best = best?;
        for (number, part) in parts.iter().enumerate() {
            best.divide(number, &motion(&part.segment)?)?;
        }
        Some(best)
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
            .map(|end| (self.z - end.tip.z).abs())
            .into_iter()
            .fold(0.0, f64::max);
        let most = (above + self.radius) / bounds.rise[0] + self.radius + bounds.speed * bounds.length;
        [above, most]
    }

    /// Whether `E` is convex for all lines that the tool covers at any time of the span.
    fn is_convex(&self, ends: [&Moment; 2], bounds: &Bounds) -> bool {
        let (rise, half) = (bounds.rise[0], 0.5 * bounds.length);
        if !(rise > STEEP) {
            return false;
        }
        let [above, most] = self.heights(ends, bounds);
        let reach = self.radius + (bounds.speed + most.max(self.centre) * bounds.rate) * bounds.length;
        let least = |speeds: [f64; 2], change: f64| (speeds[0].min(speeds[1]) - change).max(0.0);
        // `S` where the axis meets the plane, which other lines are at most this far away from.
        let middle = ends.map(|end| {
            let height = (self.z - end.tip.z) / end.axis.z;
            (end.velocity - end.axis * end.along + end.rate * height).norm()
        });
        let drift = (bounds.speed + above * bounds.rate / rise) * bounds.rate / rise
            + above / rise * bounds.bend
            + 2.0 * bounds.speed * bounds.rate;
        let across = least(middle, half * drift + reach * bounds.lean[1] / rise * bounds.rate);
        let along = ends.map(|end| end.along.abs()).into_iter().fold(0.0, f64::max) + half * bounds.speed * bounds.rate;
        let turn = reach * bounds.rate;
        let cylinder = across * across >= 1.01 * (2.0 * along * turn + turn * turn + most * reach * bounds.bend);
        let ball = || {
            let bow = self.centre.abs() * bounds.bend;
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

/// The section at the ceiling at one time.
struct CeilingSection {
    moment: Moment,
    /// How far it is above the tip.
    above: f64,
    square: f64,
    centre: f64,
}

impl CeilingSection {
    /// `e` and `ζ`.
    #[inline]
    fn arm(&self, [x, y]: [f64; 2]) -> (Vector3<f64>, f64) {
        let own = &self.moment;
        let way = Vector3::new(x - own.tip.x, y - own.tip.y, self.above);
        let height = way.dot(&own.axis);
        let height = if height > self.centre { height } else { self.centre };
        (way - own.axis * height, height)
    }

    /// `E`.
    #[inline]
    fn value(&self, line: [f64; 2]) -> f64 {
        self.arm(line).0.norm_squared() - self.square
    }

    /// Of the lines of a column.
    fn values(&self, x: f64, y: &[f64], values: &mut [f64]) {
        for (value, y) in values.iter_mut().zip(y) {
            *value = self.value([x, *y]);
        }
    }

    /// `E′`.
    #[inline]
    fn slope(&self, line: [f64; 2]) -> f64 {
        let (arm, height) = self.arm(line);
        -2.0 * arm.dot(&(self.moment.velocity + self.moment.rate * height))
    }
}

/// A span of time in which a line is covered once at most.
struct CeilingSpan<'a> {
    ceiling: &'a LeaningCeiling,
    motion: AxisMotion,
    ends: [CeilingSection; 2],
    /// The lines that may be covered.
    area: [[f64; 2]; 2],
    /// Of `E`.
    doubt: f64,
}

impl<'a> CeilingSpan<'a> {
    fn new(ceiling: &'a LeaningCeiling, motion: AxisMotion, [from, to]: [f64; 2], slack: f64) -> Option<Self> {
        let moments = [motion.at(from), motion.at(to)];
        let bounds = motion.bounds([&moments[0], &moments[1]]);
        let rise = bounds.rise[0];
        // The axis meets the plane at `b + a h/a_z`, on a way with this bound of its second derivative.
        let [above, _] = ceiling.heights([&moments[0], &moments[1]], &bounds);
        let speed = (bounds.speed + above * bounds.rate / rise) / rise;
        let bend = (2.0 * speed * bounds.rate + above * bounds.bend / rise) / rise;
        let bow = bend * bounds.lean[1] + 2.0 * speed * bounds.rate + above / rise * bounds.bend;
        let middles = moments.map(|moment| {
            let share = (ceiling.z - moment.tip.z) / moment.axis.z;
            [0, 1].map(|k| moment.tip[k] + moment.axis[k] * share)
        });
        let area = around(&middles, ceiling.radius / rise + bounds.sag(bow) + slack);
        Some(Self {
            ceiling,
            ends: moments.map(|moment| ceiling.section(moment)),
            motion,
            area,
            doubt: 16.0 * slack * ceiling.radius,
        })
    }

    /// Counts the lines that come under the tool.
    fn add(&self, first: bool, (counts, lines): (&mut Counts, &mut Collector)) {
        let lattice = lines.lines;
        let (Some(is), Some(js)) = (numbers(lattice, 0, self.area[0]), numbers(lattice, 1, self.area[1])) else {
            return;
        };
        let y: Vec<f64> = (js[0]..=js[1]).map(|j| lattice.coordinate(1, j)).collect();
        let mut values = [vec![0.0; y.len()], vec![0.0; y.len()]];
        for i in is[0]..=is[1] {
            let x = lattice.coordinate(0, i);
            for (end, values) in self.ends.iter().zip(&mut values) {
                end.values(x, &y, values);
            }
            for (at, j) in (js[0]..=js[1]).enumerate() {
                match self.enters([x, y[at]], [values[0][at], values[1][at]], first) {
                    Some(false) => {}
                    Some(true) => counts.put(i, [j, j], 1),
                    None if lattice.asks(i, j) => lines.open(lattice.line(i, j)),
                    None => {}
                }
            }
        }
    }

    /// Whether a line comes under the tool, or is there when the `first` span begins; `None` if that is open.
    #[inline]
    fn enters(&self, line: [f64; 2], values: [f64; 2], first: bool) -> Option<bool> {
        if values[0] < -self.doubt {
            return Some(first);
        }
        if !(values[0] > self.doubt && values[1].abs() > self.doubt) {
            return None;
        }
        if values[1] < 0.0 {
            return Some(true);
        }
        let [from, to] = &self.ends;
        let slopes = [from.slope(line), to.slope(line)];
        if slopes[0] >= 0.0 || slopes[1] <= 0.0 {
            return Some(false);
        }
        self.passes(
            line,
            [
                (from.moment.t, values[0], slopes[0]),
                (to.moment.t, values[1], slopes[1]),
            ],
        )
    }

    /// Whether a line is covered in between: times, values and slopes of `E`.
    #[cold]
    fn passes(&self, line: [f64; 2], [mut from, mut to]: [(f64, f64, f64); 2]) -> Option<bool> {
        for _ in 0..DEEPEST_LINE {
            // Above both tangents.
            let ((t, value, slope), (u, other, rise)) = (from, to);
            let crossing = (other - value + slope * t - rise * u) / (slope - rise);
            if slope >= 0.0 || rise <= 0.0 || value + slope * (crossing - t) > self.doubt {
                return Some(false);
            }
            // NaN is in the middle.
            let middle = if crossing > t && crossing < u {
                crossing
            } else {
                0.5 * (t + u)
            };
            let section = self.ceiling.section(self.motion.at(middle));
            let own = (middle, section.value(line), section.slope(line));
            if own.1.abs() <= self.doubt {
                return None;
            }
            if own.1 < 0.0 {
                return Some(true);
            }
            if own.2 < 0.0 {
                from = own;
            } else {
                to = own;
            }
        }
        None
    }
}

impl LeaningCeiling {
    fn section(&self, moment: Moment) -> CeilingSection {
        CeilingSection {
            above: self.z - moment.tip.z,
            square: self.radius * self.radius,
            centre: self.centre,
            moment,
        }
    }
}
