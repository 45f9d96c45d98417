//! Zones: parts of the surface of a moving solid, and of time.
//!
//! A zone is a stretch of an outline, turned about its axis all around or between two angles, during a part of a
//! motion. What of it is at one time is in the hull of rings: circles about the axis with the radii of some points
//! around the outline; or between two angles, of three points for each of these, where the circle is left and where
//! tangents meet. Between the times, it is in the hull of those at both, but for the [bend](Stretch::bend).
//!
//! Angles are measured from a fixed vector `f`, less its part along the axis `a`. At the middle of the motion that is
//! nothing, so it is at most `s = sin(w/2)` if the axis turns by `w` in all; and the direction turns about the axis,
//! seen from the [tool](crate::motion), at the rate `|a′| s/√(1 − s²)`.

use crate::motion::{Placement, Stretch};
use crate::tool::{Body, P2, Piece};
use crate::tree::Reader;
use crate::vector::{V3, add, cross, dot, scaled, sub, unit};
use std::f64::consts::FRAC_PI_2;

/// A circle about an axis, with a ball around each of its points.
#[derive(Clone, Copy, Debug, Default)]
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
        let none = Self::default();
        Self { centre, ..none }
    }
}

impl Frame {
    pub fn new(stretch: Stretch) -> Option<Self> {
        let axis = stretch.at(0.5).axis;
        let least = (0..3).min_by(|i, j| axis[*i].abs().total_cmp(&axis[*j].abs()))?;
        let side = unit(&cross(&axis, &[0, 1, 2].map(|k| if k == least { 1.0 } else { 0.0 })))?;
        let turned = stretch.turning();
        let spin = SPIN * if turned <= MOST_TURNED { turned } else { f64::INFINITY };
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
        let with = |pieces| self.with(|zone| (zone.pieces, zone.is_whole) = (pieces, false));
        let between = |angles| self.with(|zone| zone.angles = Some(angles));
        let during = |times| self.with(|zone| zone.times = times);
        Some(match (kind, self.angles, &self.pieces[..]) {
            (10, ..) => {
                let [from, to] = self.times;
                let middle = 0.5 * (from + to);
                (to - from > SHORTEST).then(|| [[from, middle], [middle, to]].map(during).to_vec())?
            }
            (11, ..) if self.is_whole => self.pieces.iter().map(|piece| with(vec![piece.clone()])).collect(),
            (12, _, [piece]) if !self.is_whole => halves(piece)?.map(|half| with(vec![half])).to_vec(),
            (13, None, _) => [0.0, 1.0, 2.0, 3.0]
                .map(|k| between([k, k + 1.0].map(|k| FRAC_PI_2 * k)))
                .to_vec(),
            (13, Some([a, b]), _) => vec![between([a, 0.5 * (a + b)]), between([0.5 * (a + b), b])],
            (14, ..) => {
                let height = reader.float()?;
                let part = |side| {
                    let pieces = self.pieces.iter().filter_map(|piece| beyond(piece, height, side));
                    self.with(|zone| zone.pieces = pieces.collect())
                };
                vec![part(-1.0), part(1.0)]
            }
            _ => return None,
        })
    }

    fn with(&self, change: impl FnOnce(&mut Self)) -> Self {
        let mut zone = self.clone();
        change(&mut zone);
        zone
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
    let is_over = |p: &P2, by: f64| side * (p[1] - height) + by >= 0.0;
    match piece {
        Piece::Points(points) if !points.iter().any(|p| is_over(p, 0.0)) => None,
        Piece::Arc(centre, radius, _) if !is_over(centre, *radius) => None,
        Piece::Points(points) if points.len() == 2 => {
            let [a, b] = [points[0], points[1]];
            let cut = [a[0] + (b[0] - a[0]) * (height - a[1]) / (b[1] - a[1]), height];
            Some(Piece::Points(
                [a, b].map(|p| if is_over(&p, 0.0) { p } else { cut }).to_vec(),
            ))
        }
        _ => Some(piece.clone()),
    }
}
