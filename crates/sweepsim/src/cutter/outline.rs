//! A tool of revolution, prepared for closed forms.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::Range;
use sweepsim_motion::{MeridianCurve, MeridianShape, Tool};

/// A circle whose centre is this close to the axis, in roundings of its size, counts as being about the axis.
const ON_AXIS: f64 = 4.0 * f64::EPSILON;

/// A line or arc of the meridian.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shape {
    Line {
        /// Unit normal, `(ρ, ζ)`.
        normal: [f64; 2],
    },
    Arc {
        /// `(ρ, ζ)`; with `ρ` exactly 0 for a circle about the axis.
        centre: [f64; 2],
        radius: f64,
        /// The range of angles, ascending.
        angles: [f64; 2],
        /// 1 where the normal points away from the centre, −1 where it points to it.
        out: f64,
    },
}

/// A piece of the outline with a closed form.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    pub from: [f64; 2],
    pub to: [f64; 2],
    pub shape: Shape,
    pub patches: Range<usize>,
}

/// The part of a ball between two heights on the tool's axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    /// The height of its centre.
    pub centre: f64,
    pub radius: f64,
    /// The range of heights from the centre; infinite beyond a pole.
    pub ends: [f64; 2],
}

/// A sharp edge: a circle about the axis.
#[derive(Clone, Debug)]
pub(crate) struct Rim {
    pub radius: f64,
    pub height: f64,
    /// The unit normals of the faces before and after it, `(ρ, ζ)`.
    pub normals: [[f64; 2]; 2],
    pub edges: Range<usize>,
}

/// The outline of a tool of revolution, as far as it has closed forms.
#[derive(Clone, Debug)]
pub(crate) struct Outline {
    /// Whether all pieces have a closed form.
    pub(crate) complete: bool,
    pub(crate) pieces: Vec<Piece>,
    pub(crate) rims: Vec<Rim>,
}

impl Outline {
    /// Marks the patches and the edges that a search settles: `piece` and `rim` return `None` for those that it does not.
    pub fn settle<S>(
        &self,
        search: &mut S,
        piece: impl Fn(&mut S, &Piece) -> Option<()>,
        rim: impl Fn(&mut S, &Rim) -> Option<()>,
        [patches, edges]: [&mut [bool]; 2],
    ) {
        for own in &self.pieces {
            if piece(search, own).is_some() {
                patches[own.patches.clone()].fill(true);
            }
        }
        for own in &self.rims {
            if rim(search, own).is_some() {
                edges[own.edges.clone()].fill(true);
            }
        }
    }
}

/// The normal of the envelope at a sharp edge, of any length: in the fan of the two faces, where `g = 0`. `sides` is `g` on
/// both, of which one is negative.
#[inline]
pub(crate) fn fan_normal([first, second]: &[[f64; 2]; 2], [a, b]: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|k| first[k] * b.abs() + second[k] * a.abs())
}

impl Rim {
    /// The normal of the envelope, outwards and along the axis, for a motion in this direction, and whether `g` is negative
    /// on the first face: `Some(None)` if both faces move inwards or both outwards, `None` if that is in doubt.
    #[inline]
    pub fn envelope(&self, [out, along]: [f64; 2], doubt: f64) -> Option<Option<([f64; 2], bool)>> {
        let sides = self.normals.map(|[n, m]| n * out + m * along);
        let [a, b] = sides;
        let certain = a.abs() > doubt && b.abs() > doubt;
        let bounds = (a < 0.0) != (b < 0.0);
        certain.then(|| bounds.then(|| (fan_normal(&self.normals, sides), a < 0.0)))
    }
}

/// The normal of a direction: to the right.
fn right([x, y]: [f64; 2]) -> [f64; 2] {
    [y, -x]
}

impl Outline {
    /// `None` if the tool is not one of revolution.
    pub fn new(tool: &Tool) -> Option<Self> {
        let curves = tool.meridians();
        if curves.is_empty() {
            return None;
        }
        let pieces: Vec<Piece> = curves.iter().filter_map(piece).collect();
        let rim = |pair: &[MeridianCurve]| {
            let [before, after] = pair else { return None };
            (!after.edges.is_empty()).then(|| Rim {
                radius: after.from[0],
                height: after.from[1],
                normals: [right(before.directions[1]), right(after.directions[0])],
                edges: after.edges.clone(),
            })
        };
        let rims = curves.windows(2).filter_map(rim).collect();
        let complete = pieces.len() == curves.len();
        Some(Self { complete, pieces, rims })
    }
}

impl Piece {
    /// The ends of a line as far as it is below a height, at least; some of it is.
    pub(crate) fn below(&self, height: f64) -> [[f64; 2]; 2] {
        let cut = |from: [f64; 2], to: [f64; 2]| {
            if to[1] <= height {
                return to;
            }
            let share = (height - from[1]) / (to[1] - from[1]);
            [from[0] + share * (to[0] - from[0]), height]
        };
        if self.from[1] <= self.to[1] {
            [self.from, cut(self.from, self.to)]
        } else {
            [cut(self.to, self.from), self.to]
        }
    }

    /// The ball that it is a part of, if its normal points away from a centre on the axis.
    pub(crate) fn ball(&self) -> Option<Ball> {
        let Shape::Arc {
            centre: [0.0, centre],
            radius,
            out: 1.0,
            ..
        } = self.shape
        else {
            return None;
        };
        let [low, high] = if self.from[1] < self.to[1] {
            [self.from, self.to]
        } else {
            [self.to, self.from]
        };
        // Poles are no ends.
        let end = |[rho, zeta]: [f64; 2], pole: f64| if rho == 0.0 { pole } else { zeta - centre };
        Some(Ball {
            centre,
            radius,
            ends: [end(low, f64::NEG_INFINITY), end(high, f64::INFINITY)],
        })
    }

    /// The parts of an arc over which radius and height are monotone, by ascending angle: angle and `(ρ, ζ)` at both ends of each.
    pub(crate) fn quarters(&self) -> Vec<[(f64, [f64; 2]); 2]> {
        let Shape::Arc {
            centre,
            radius,
            angles: [first, last],
            out,
        } = self.shape
        else {
            return Vec::new();
        };
        let [low, high] = if out > 0.0 {
            [self.from, self.to]
        } else {
            [self.to, self.from]
        };
        let number = |angle: f64| angle / FRAC_PI_2;
        let mut places = vec![(first, low)];
        for cut in number(first).floor() as i64 + 1..number(last).ceil() as i64 {
            let [e, f] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]][cut.rem_euclid(4) as usize];
            let place = [centre[0] + radius * e, centre[1] + radius * f];
            places.push((cut as f64 * FRAC_PI_2, place));
        }
        places.push((last, high));
        places.windows(2).map(|pair| [pair[0], pair[1]]).collect()
    }

    /// The range of `ζ`.
    pub(crate) fn heights(&self) -> [f64; 2] {
        let ends = [self.from[1].min(self.to[1]), self.from[1].max(self.to[1])];
        match self.shape {
            Shape::Line { .. } => ends,
            // Of the whole circle, if it passes its lowest or highest point.
            Shape::Arc {
                centre, radius, angles, ..
            } => {
                let turns = |angle: f64| ((angle - FRAC_PI_2) / PI).floor();
                if turns(angles[0]) == turns(angles[1]) {
                    ends
                } else {
                    [ends[0].min(centre[1] - radius), ends[1].max(centre[1] + radius)]
                }
            }
        }
    }
}

fn piece(curve: &MeridianCurve) -> Option<Piece> {
    let shape = match curve.shape {
        MeridianShape::Line => Shape::Line {
            normal: right(curve.directions[0]),
        },
        MeridianShape::Arc {
            centre: [rho, zeta],
            radius,
            start,
            sweep,
        } => {
            let near = rho.abs() <= ON_AXIS * (radius + zeta.abs());
            let end = start + sweep;
            Shape::Arc {
                centre: [if near { 0.0 } else { rho }, zeta],
                radius,
                angles: [start.min(end), start.max(end)],
                out: sweep.signum(),
            }
        }
        _ => return None,
    };
    Some(Piece {
        from: curve.from,
        to: curve.to,
        shape,
        patches: curve.patches.clone(),
    })
}
