//! Stretches of a meridian with one radius at each height: of a tool that lies across the dexels, a line is at one height all along.

use crate::cutter::outline::{Monotone, Piece, Shape};
use std::f64::consts::PI;

/// Cones that are flatter than this, but no discs, are left to charts.
const FLATTEST: f64 = 1e-6;

/// An arc is flat where its normal is nearer to the axis than 90° less this angle.
const FLAT: f64 = 1.52;

/// A range of heights of a stretch.
pub(super) struct HeightRange {
    /// The first one counts, the last one does not.
    pub heights: [f64; 2],
    /// At both ends, if the arc is flat nowhere between.
    pub normals: Option<[[f64; 2]; 2]>,
}

/// A stretch of the meridian with one radius at each height.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    /// Ascending.
    pub heights: [f64; 2],
    /// Bounds.
    pub radii: [f64; 2],
    curve: Curve,
}

#[derive(Clone, Copy, Debug)]
enum Curve {
    Line {
        from: [f64; 2],
        normal: [f64; 2],
    },
    Arc {
        centre: [f64; 2],
        radius: f64,
        /// 1 on the outer side of the centre, −1 on the inner one.
        side: f64,
        out: f64,
    },
}

/// The circle of a stretch at a height.
pub(super) struct Ring {
    pub radius: f64,
    /// How far off it may be, for each unit of the height's error.
    pub rate: f64,
    /// The same for the slope of the normal, `n_ζ/n_ρ`.
    pub turn: f64,
    pub normal: [f64; 2],
}

impl Stretch {
    /// `None` for discs and for what is almost one.
    pub fn all(piece: &Piece) -> Option<Vec<Self>> {
        let (from, to) = (piece.from, piece.to);
        let sorted = |a: f64, b: f64| [a.min(b), a.max(b)];
        match piece.shape {
            Shape::Line { normal } => (normal[0].abs() > FLATTEST).then(|| {
                vec![Self {
                    heights: sorted(from[1], to[1]),
                    radii: sorted(from[0], to[0]),
                    curve: Curve::Line { from, normal },
                }]
            }),
            Shape::Arc {
                centre, radius, out, ..
            } => {
                let stretch = |[(a, from), (b, to)]: [(f64, [f64; 2]); 2]| {
                    let side = 1.0_f64.copysign((0.5 * (a + b)).cos());
                    let [low, high] = sorted(from[0], to[0]);
                    // The widest place of the circle may lie between.
                    let passes = (a / PI).floor() != (b / PI).floor();
                    let widest = centre[0] + side * radius;
                    let radii = if passes {
                        [low.min(widest), high.max(widest)]
                    } else {
                        [low, high]
                    };
                    (from[1] != to[1]).then(|| Self {
                        heights: sorted(from[1], to[1]),
                        radii: radii.map(|rho| rho.max(0.0)),
                        curve: Curve::Arc {
                            centre,
                            radius,
                            side,
                            out,
                        },
                    })
                };
                Some(
                    piece
                        .monotone(Monotone::Height)
                        .into_iter()
                        .filter_map(stretch)
                        .collect(),
                )
            }
        }
    }

    /// `None` where it is almost perpendicular to the axis.
    #[inline]
    pub fn at(&self, height: f64, slack: f64) -> Option<Ring> {
        match self.curve {
            Curve::Line { from, normal } => {
                let rate = -normal[1] / normal[0];
                Some(Ring {
                    radius: from[0] + rate * (height - from[1]),
                    rate: rate.abs(),
                    turn: 0.0,
                    normal,
                })
            }
            Curve::Arc {
                centre,
                radius,
                side,
                out,
            } => {
                let h = height - centre[1];
                let half_chord_sq = (radius - h) * (radius + h);
                if !(half_chord_sq > 512.0 * slack * (radius + slack)) {
                    return None;
                }
                let wide = half_chord_sq.sqrt();
                Some(Ring {
                    radius: centre[0] + side * wide,
                    rate: h.abs() / wide,
                    turn: radius * radius / (wide * half_chord_sq),
                    normal: [out * side * wide / radius, out * h / radius],
                })
            }
        }
    }

    /// Its parts by height, ascending and without gaps: where an arc is not [`FLAT`], with the normals at the ends of the part.
    pub fn parts(&self) -> Vec<HeightRange> {
        let [low, high] = self.heights;
        let bounds = [f64::NEG_INFINITY, f64::INFINITY];
        let whole = |normals| {
            vec![HeightRange {
                heights: bounds,
                normals,
            }]
        };
        let (centre, radius, side, out) = match self.curve {
            Curve::Line { normal, .. } => return whole(Some([normal; 2])),
            Curve::Arc {
                centre,
                radius,
                side,
                out,
            } => (centre, radius, side, out),
        };
        let (rise, wide) = FLAT.sin_cos();
        let steep = [
            (centre[1] - radius * rise).max(low),
            (centre[1] + radius * rise).min(high),
        ];
        if !(steep[0] < steep[1]) {
            return whole(None);
        }
        let normal = |height: f64| {
            let up = ((height - centre[1]) / radius).clamp(-rise, rise);
            [out * side * (1.0 - up * up).sqrt().max(wide), out * up]
        };
        let [from, to] = [0, 1].map(|k| {
            if steep[k] == self.heights[k] {
                bounds[k]
            } else {
                steep[k]
            }
        });
        let part = |heights: [f64; 2], normals| (heights[0] < heights[1]).then_some(HeightRange { heights, normals });
        [
            part([bounds[0], from], None),
            part([from, to], Some(steep.map(normal))),
            part([to, bounds[1]], None),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}
