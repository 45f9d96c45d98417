//! Zones: parts of the surface of a moving solid, and of time.
//!
//! A zone is a stretch of an outline, turned about its axis all around or between two angles, during a part of a
//! motion. What of it is at one time is in the hull of rings: circles about the axis with the radii of some points
//! around the outline; or between two angles, of three points for each of these, where the circle is left and where
//! tangents meet. Between the times, it is in the hull of those at both, but for the [bend](Stretch::bend).
//!
//! Angles are measured from a fixed vector `f`, less its part along the axis `a`. At the middle of the motion that is
//! nothing, so it is at most `s = sin(w/2)` if the axis turns by `w` in all; and the direction turns about the axis, seen
//! from the [tool](crate::motion), at the rate `|a′| s/√(1 − s²)`.

use crate::motion::{Placement, Stretch};
use crate::tool::{Body, P2, Piece};
use crate::tree::Reader;
use crate::vector::{V3, add, cross, dot, scaled, sub, unit};
use std::f64::consts::FRAC_PI_2;

/// A circle about an axis, with a ball around each of its points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ring {
    pub centre: V3,
    pub axis: V3,
    pub radius: f64,
    pub thick: f64,
}

/// What angles are measured from, on a motion.
pub(crate) struct Frame {
    pub stretch: Stretch,
    side: V3,
    /// The angle of a point changes by no more in a time of 1.
    spin: f64,
}

#[derive(Clone)]
pub(crate) struct Zone {
    pieces: Vec<Piece>,
    /// Before pieces are looked at one by one: arcs count as the balls that they are part of.
    is_whole: bool,
    angles: Option<P2>,
    /// With all that is between it and the axis.
    is_filled: bool,
    pub times: [f64; 2],
}

/// A motion that turns by more has no angles; on others, `s/√(1 − s²)` is less than [`SPIN`].
const MOST_TURNED: f64 = 1.8;
const SPIN: f64 = 1.3;
/// Wider sectors are taken as the whole ring.
const WIDEST: f64 = 2.0;
/// Nothing is divided farther in time.
const SHORTEST: f64 = 1e-12;

impl Ring {
    pub fn point(centre: V3) -> Self {
        let (axis, radius, thick) = ([0.0; 3], 0.0, 0.0);
        Self {
            centre,
            axis,
            radius,
            thick,
        }
    }
}

impl Frame {
    pub fn new(stretch: Stretch) -> Option<Self> {
        let axis = stretch.at(0.5).axis;
        let least = (0..3).min_by(|i, j| axis[*i].abs().total_cmp(&axis[*j].abs()))?;
        let side = unit(&cross(&axis, &[0, 1, 2].map(|k| if k == least { 1.0 } else { 0.0 })))?;
        let turned = stretch.turning();
        let spin = if turned <= MOST_TURNED {
            SPIN * turned
        } else {
            f64::INFINITY
        };
        Some(Self { stretch, side, spin })
    }

    fn point(&self, at: &Placement, [radius, height]: P2, angle: f64) -> V3 {
        let x = sub(&self.side, &scaled(&at.axis, dot(&self.side, &at.axis)));
        let x = unit(&x).unwrap_or(self.side);
        let (sin, cos) = angle.sin_cos();
        let out = add(&scaled(&x, cos), &scaled(&cross(&at.axis, &x), sin));
        add(&add(&at.tip, &scaled(&at.axis, height)), &scaled(&out, radius))
    }
}

impl Zone {
    /// All of the surface of a solid, all along a motion; or all of the solid, where it begins.
    pub fn whole(body: &Body, is_filled: bool) -> Self {
        Self {
            pieces: body.pieces.clone(),
            is_whole: true,
            angles: None,
            is_filled,
            times: [0.0, if is_filled { 0.0 } else { 1.0 }],
        }
    }

    /// Points around the outline, and the radii of balls around them, whose hull has it.
    pub fn profile(&self) -> Vec<(P2, f64)> {
        let of = |piece: &Piece| match piece {
            Piece::Points(points) => points.iter().map(|point| (*point, 0.0)).collect(),
            Piece::Arc(centre, radius, _) if self.is_whole => vec![(*centre, *radius)],
            Piece::Arc(centre, radius, [from, to]) => {
                let tangents = radius / (0.5 * (to - from)).cos();
                let all = [(*from, *radius), (0.5 * (from + to), tangents), (*to, *radius)];
                all.map(|(angle, r)| (at(centre, angle, r), 0.0)).to_vec()
            }
        };
        self.pieces.iter().flat_map(of).collect()
    }

    /// Its rings, those of the first time first; and whether they are points.
    pub fn rings(&self, frame: &Frame) -> (Vec<Ring>, bool) {
        let [from, to] = self.times;
        let spin = frame.spin * (to - from);
        let angles = self.angles.map(|[a, b]| [a - spin, b + spin]);
        let angles = angles.filter(|[a, b]| b - a <= WIDEST && !self.is_whole);
        let (mut rings, profile) = (Vec::new(), self.profile());
        for time in [from, to].into_iter().take(if to > from { 2 } else { 1 }) {
            let at = frame.stretch.at(time);
            for (place, thick) in &profile {
                let Some([a, b]) = angles else {
                    rings.push(Ring {
                        centre: add(&at.tip, &scaled(&at.axis, place[1])),
                        axis: at.axis,
                        radius: place[0].abs(),
                        thick: *thick,
                    });
                    continue;
                };
                let half = 0.5 * (b - a);
                let mut add = |radius, angle| rings.push(Ring::point(frame.point(&at, [radius, place[1]], angle)));
                add(place[0], a);
                add(place[0], b);
                add(place[0] / half.cos(), a + half);
                if self.is_filled {
                    add(0.0, a);
                }
            }
        }
        (rings, angles.is_some())
    }

    /// Its parts, as a node divides it. `None` if there is no such node.
    pub fn parts(&self, kind: u8, reader: &mut Reader) -> Option<Vec<Self>> {
        let with = |pieces: Vec<Piece>| Self {
            pieces,
            is_whole: false,
            ..self.clone()
        };
        let between = |angles: P2| Self {
            angles: Some(angles),
            ..self.clone()
        };
        Some(match (kind, self.angles) {
            (10, _) => {
                let [from, to] = self.times;
                let middle = 0.5 * (from + to);
                let during = |times| Self { times, ..self.clone() };
                (to - from > SHORTEST).then(|| vec![during([from, middle]), during([middle, to])])?
            }
            (11, _) if self.is_whole => self.pieces.iter().map(|piece| with(vec![piece.clone()])).collect(),
            (12, _) => match (&self.pieces[..], self.is_whole) {
                ([piece], false) => halves(piece)?.map(|half| with(vec![half])).to_vec(),
                _ => return None,
            },
            (13, None) => (0..4)
                .map(|k| between([k, k + 1].map(|k| FRAC_PI_2 * f64::from(k))))
                .collect(),
            (13, Some([a, b])) => vec![between([a, 0.5 * (a + b)]), between([0.5 * (a + b), b])],
            (14, _) => {
                let height = reader.float()?;
                let part = |side: f64| {
                    let pieces = self.pieces.iter().filter_map(|piece| beyond(piece, height, side));
                    Self {
                        pieces: pieces.collect(),
                        ..self.clone()
                    }
                };
                vec![part(-1.0), part(1.0)]
            }
            _ => return None,
        })
    }
}

fn at(centre: &P2, angle: f64, radius: f64) -> P2 {
    [centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()]
}

/// Both halves of a line or an arc.
fn halves(piece: &Piece) -> Option<[Piece; 2]> {
    match piece {
        Piece::Points(points) => {
            let [a, b] = points[..] else { return None };
            let middle = [0, 1].map(|k| 0.5 * (a[k] + b[k]));
            Some([[a, middle], [middle, b]].map(|ends| Piece::Points(ends.to_vec())))
        }
        Piece::Arc(centre, radius, [from, to]) => {
            let middle = 0.5 * (from + to);
            Some([[*from, middle], [middle, *to]].map(|angles| Piece::Arc(*centre, *radius, angles)))
        }
    }
}

/// What of a piece is above a height, or below it for a `side` of −1; of what is no line, all if some of it may be.
fn beyond(piece: &Piece, height: f64, side: f64) -> Option<Piece> {
    let over = |zeta: f64| side * (zeta - height);
    match piece {
        Piece::Points(points) => {
            let [a, b] = match points[..] {
                [a, b] => [a, b],
                _ => return points.iter().any(|p| over(p[1]) >= 0.0).then(|| piece.clone()),
            };
            let cut = || {
                let share = (height - a[1]) / (b[1] - a[1]);
                [a[0] + (b[0] - a[0]) * share, height]
            };
            let ends = match [a, b].map(|p| over(p[1]) >= 0.0) {
                [true, true] => [a, b],
                [true, false] => [a, cut()],
                [false, true] => [cut(), b],
                [false, false] => return None,
            };
            Some(Piece::Points(ends.to_vec()))
        }
        Piece::Arc(centre, radius, _) => (over(centre[1]) + radius >= 0.0).then(|| piece.clone()),
    }
}
