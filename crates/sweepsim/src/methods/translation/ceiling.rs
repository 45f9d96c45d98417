//! The ceiling of a tool that stands along the lines.
//!
//! Over a line, the coverage count at the ceiling is the number of components of the times at which the tool covers the point at that height. At a
//! height at which a tool that stands along the lines is a cone or a cylinder, its section is a disc whose radius is linear in the time of a move: it covers a
//! point for one interval of times, or never. So the count is the number of moves whose discs cover the line, less the number of joints whose
//! disc does. Along a row of lines each of these sets is an interval, found from its two ends: the count of all its lines costs two additions.
//!
//! The jumps below the ceiling must add up to this number, which is as independent of them as the crossings above would be.

use super::curves::stands;
use super::discs::Around;
use crate::cutter::outline::{Outline, Shape};
use crate::methods::harvest::Collector;
use crate::methods::sheets::{Counts, numbers};
use crate::time::path_parts::PathPart;

/// How far the ceiling is from material and from the ends of the cone or cylinder, at least, in reaches of the tool.
pub(crate) const GAP: f64 = 1e-3;

/// A height above all material, at which the tool is a cone or a cylinder along some moves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UprightCeiling {
    pub z: f64,
    /// The tool's radius at the height `ζ` above its tip is `base + rate ζ`.
    base: f64,
    rate: f64,
}

impl UprightCeiling {
    /// The lowest one for these moves, if there is any. `top`: the highest material.
    pub fn new(outline: &Outline, reach: f64, parts: &[PathPart], top: f64) -> Option<Self> {
        let forwards = |part: &PathPart| {
            part.vertical_arc()
                .is_none_or(|vertical_arc| vertical_arc.goes_forwards())
        };
        if !outline.complete || !parts.iter().all(|part| stands(part) && forwards(part)) {
            return None;
        }
        let own = |part: &PathPart| match part.vertical_arc() {
            Some(vertical_arc) => vertical_arc.heights(),
            None => part.segment.tips().map(|tip| tip[2]),
        };
        let tips = || parts.iter().flat_map(own);
        let low = tips().fold(f64::INFINITY, f64::min);
        let high = tips().fold(f64::NEG_INFINITY, f64::max);
        let gap = GAP * reach;
        let mut best: Option<Self> = None;
        for piece in &outline.pieces {
            let Shape::Line { normal } = piece.shape else { continue };
            let (from, to) = (piece.from[1], piece.to[1]);
            if normal[0] <= 0.0 || to <= from {
                continue;
            }
            let z = top.max(high + from) + gap;
            let span = [z - high, z - low];
            // No other piece may be there: the section is one disc.
            let alone = outline
                .pieces
                .iter()
                .filter(|other| {
                    let [a, b] = other.heights();
                    a <= span[1] + gap && b >= span[0] - 0.5 * gap
                })
                .count()
                == 1;
            let rate = (piece.to[0] - piece.from[0]) / (to - from);
            // Along an arc the disc has to be always the same.
            let level_arc = parts.iter().filter(|part| part.level_arc().is_some());
            let rises = level_arc.map(|part| part.segment.travel()[2]);
            let vertical = parts
                .iter()
                .filter_map(|part| part.vertical_arc().map(|arc| arc.heights()));
            let mut rises = rises.chain(vertical.map(|[low, high]| high - low));
            let steady = rises.all(|rise| (rate * rise).abs() < STEADY * reach);
            if alone && steady && span[1] < to - gap && best.is_none_or(|best| z < best.z) {
                best = Some(Self {
                    z,
                    base: piece.from[0] - rate * from,
                    rate,
                });
            }
        }
        best
    }

    /// The disc along an arc.
    fn around(&self, part: &PathPart, slack: f64) -> Option<Around> {
        let level_arc = part.level_arc()?;
        let [a, b] = part.segment.tips().map(|tip| self.disc(tip).radius);
        Some(Around {
            arc: level_arc,
            radius: a,
            doubt: 4.0 * slack + (b - a).abs(),
        })
    }

    fn disc(&self, [x, y, z]: [f64; 3]) -> Disc {
        Disc {
            centre: [x, y],
            radius: self.base + self.rate * (self.z - z),
        }
    }
}

/// By how much of the tool's reach a disc may grow along an arc: lines so near to its boundary are open.
const STEADY: f64 = 1e-8;

/// A line is beyond doubt on one side of an end that is this many times as far away as it may be off,
const WIDE: f64 = 4.0;
/// and this part of the distance of lines, since [`numbers`] may have a line more that is half as far outside.
const FRACTION: f64 = 2e-3;

#[derive(Clone, Copy, Debug)]
struct Disc {
    centre: [f64; 2],
    radius: f64,
}

/// All discs between two, with radii linear in the way.
struct Capsule {
    ends: [Disc; 2],
    ahead: [f64; 2],
    length: f64,
    /// Sine and cosine of the angle between the way and its outer tangents.
    lean: [f64; 2],
}

impl Capsule {
    fn new(a: Disc, b: Disc) -> Self {
        let way = [0, 1].map(|k| b.centre[k] - a.centre[k]);
        let length = way[0].hypot(way[1]);
        let sine = (a.radius - b.radius) / length;
        // One disc holds the other: the larger one, alone. So if they are one.
        if !(sine.abs() < 1.0) {
            let larger = if a.radius >= b.radius { a } else { b };
            return Self {
                ends: [larger; 2],
                ahead: [1.0, 0.0],
                length: 0.0,
                lean: [0.0, 1.0],
            };
        }
        Self {
            ends: [a, b],
            ahead: way.map(|c| c / length),
            length,
            lean: [sine, ((1.0 - sine) * (1.0 + sine)).sqrt()],
        }
    }

    /// The distance from the boundary, negative inside.
    fn distance(&self, x: f64, y: f64) -> f64 {
        let [a, b] = &self.ends;
        let (dx, dy) = (x - a.centre[0], y - a.centre[1]);
        let q = self.ahead[0] * dx + self.ahead[1] * dy;
        let p = (self.ahead[0] * dy - self.ahead[1] * dx).abs();
        let [s, c] = self.lean;
        let foot = q * c - p * s;
        // Coordinates are bounded: there is no need to care for overflow.
        let from = |dx: f64, dy: f64| (dx * dx + dy * dy).sqrt();
        if self.length == 0.0 || foot < 0.0 {
            from(dx, dy) - a.radius
        } else if foot > c * self.length {
            from(x - b.centre[0], y - b.centre[1]) - b.radius
        } else {
            p * c + q * s - a.radius
        }
    }

    fn extent(&self, k: usize) -> [f64; 2] {
        let [a, b] = &self.ends;
        [
            (a.centre[k] - a.radius).min(b.centre[k] - b.radius),
            (a.centre[k] + a.radius).max(b.centre[k] + b.radius),
        ]
    }

    /// About where a column enters and leaves it, and how far these places may be off.
    fn crossed(&self, x: f64, slack: f64) -> Option<[[f64; 2]; 2]> {
        let (mut range, mut off) = ([f64::INFINITY, f64::NEG_INFINITY], [slack; 2]);
        let mut add = |y: f64, error: f64| {
            if y < range[0] {
                (range[0], off[0]) = (y, error);
            }
            if y > range[1] {
                (range[1], off[1]) = (y, error);
            }
        };
        let discs = if self.length == 0.0 {
            &self.ends[..1]
        } else {
            &self.ends
        };
        for disc in discs {
            let across = x - disc.centre[0];
            let square = (disc.radius - across) * (disc.radius + across);
            if square > -8.0 * disc.radius * slack {
                let half = square.max(0.0).sqrt();
                let error = slack * (1.0 + disc.radius / half);
                add(disc.centre[1] - half, error);
                add(disc.centre[1] + half, error);
            }
        }
        if self.length > 0.0 {
            let [ux, uy] = self.ahead;
            let [s, c] = self.lean;
            for side in [1.0, -1.0] {
                let out = [s * ux - side * c * uy, s * uy + side * c * ux];
                let [a, b] = self
                    .ends
                    .map(|disc| [0, 1].map(|k| disc.centre[k] + disc.radius * out[k]));
                let slope = (b[1] - a[1]) / (b[0] - a[0]);
                let share = (x - a[0]) / (b[0] - a[0]);
                if (0.0..=1.0).contains(&share) {
                    add(a[1] + share * (b[1] - a[1]), slack * (1.0 + slope.abs()));
                }
            }
        }
        (range[0] <= range[1]).then_some([range, off])
    }
}

impl UprightCeiling {
    /// How often the lines are covered; those closer than rounding to an end of that are open.
    pub fn counts(&self, parts: &[PathPart], slack: f64, lines: &mut Collector) -> Option<Counts> {
        let tips = |part: &PathPart| part.segment.tips().map(|tip| self.disc(tip));
        let around: Vec<Around> = parts.iter().filter_map(|part| self.around(part, slack)).collect();
        let moves: Vec<Capsule> = parts
            .iter()
            .filter(|part| part.level_arc().is_none())
            .map(|part| {
                let [a, b] = tips(part);
                Capsule::new(a, b)
            })
            .collect();
        let joints = parts.iter().skip(1).map(|part| {
            let [a, _] = tips(part);
            Capsule::new(a, a)
        });
        let hull = |k: usize| {
            let straight = moves.iter().map(|capsule| capsule.extent(k));
            let ranges = straight.chain(around.iter().map(|disc| disc.extent(k)));
            let whole = ranges.fold([f64::INFINITY, f64::NEG_INFINITY], |a, b| {
                [a[0].min(b[0]), a[1].max(b[1])]
            });
            [whole[0] - slack, whole[1] + slack]
        };
        let mut counts = Counts::over(lines.lines, [hull(0), hull(1)])?;
        for capsule in &moves {
            capsule.add(1, slack, (&mut counts, lines));
        }
        for disc in &around {
            disc.each(lines, |i, j, count| counts.put(i, [j, j], count));
        }
        for capsule in joints {
            capsule.add(-1, slack, (&mut counts, lines));
        }
        Some(counts)
    }
}

impl Capsule {
    /// Counts the lines in a capsule once; those at its boundary are open.
    fn add(&self, by: i32, slack: f64, (counts, lines): (&mut Counts, &mut Collector)) {
        let lattice = lines.lines;
        let [low, high] = self.extent(0);
        let Some(is) = numbers(lattice, 0, [low - slack, high + slack]) else {
            return;
        };
        let around = lattice.grid.spacing()[1];
        for i in is[0]..=is[1] {
            let x = lattice.coordinate(0, i);
            let Some([[from, to], off]) = self.crossed(x, slack) else {
                continue;
            };
            // Where no line is close to the ends, those between them need no look. Columns close to the outermost points may be close to the boundary everywhere.
            let close = off.map(|off| WIDE * off + FRACTION * around);
            let within = x - low > 2.0 * WIDE * slack && high - x > 2.0 * WIDE * slack;
            if within && close[0] + close[1] < around {
                let sure = numbers(lattice, 1, [from + close[0], to - close[1]]);
                if sure == numbers(lattice, 1, [from - close[0], to + close[1]]) {
                    if let Some(range) = sure {
                        counts.put(i, range, by);
                    }
                    continue;
                }
            }
            let Some([mut a, mut b]) = numbers(lattice, 1, [from - around, to + around]) else {
                continue;
            };
            // A convex set: from the ends inwards.
            let mut outside = |j: usize| {
                let distance = self.distance(x, lattice.coordinate(1, j));
                let near = !(distance.abs() > slack);
                if near && lattice.asks(i, j) {
                    lines.open(lattice.line(i, j));
                }
                near || distance > 0.0
            };
            while a <= b && outside(a) {
                a += 1;
            }
            while b > a && outside(b) {
                b -= 1;
            }
            if a <= b {
                counts.put(i, [a, b], by);
            }
        }
    }
}
