//! A stretch of a cone or torus with one height at each radius and one radius at each height, and the curves parallel to its sections by planes along the axis, seen along the axis.
//!
//! The unknown is the height, taken with the sign with which it grows with the radius: then a stretch looks like a [`Sheet`], and the bounds of one serve both.

use super::roots::{Bounds, Curve};
use super::sheet::{Meridian, Parallel, Sheet, SheetPoint};
use crate::cutter::outline::{Monotone, Piece, Shape};

/// Cones are left to charts that are flatter or steeper than this.
const FLATTEST: f64 = 1e-6;
/// So are tori that are smaller than so many rounding errors.
const SMALLEST: f64 = 1e6;

#[derive(Clone, Copy, Debug)]
pub(super) struct Quarter {
    pub sheet: Sheet,
    /// The sign with which heights grow with the radius.
    pub climb: f64,
    /// Heights with that sign, ascending.
    pub ends: [f64; 2],
    pub curve: Profile,
}

/// The meridian by `x`, the height with its sign.
#[derive(Clone, Copy, Debug)]
pub(super) enum Profile {
    /// The normal, and `dρ/dx`.
    Cone { normal: [f64; 2], rate: f64 },
    /// `ρ = middle + side √(tube² − (x − level)²)`
    Torus {
        middle: f64,
        level: f64,
        tube: f64,
        /// The sign of `e`.
        side: f64,
    },
}

/// The coordinate along the axis of a curve parallel to a section, at a distance `p` from the axis: `Q(x) = x + side r ν(x)`, where `ν = −sign e |f| ρ/√D`, with `D` of [`Parallel`], is the part of
/// the section's unit normal along the axis, with the sign of `x`. `Q′` is that of [`Parallel`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Lengthwise<'a> {
    pub quarter: &'a Quarter,
    pub parallel: Parallel<'a>,
}

impl Quarter {
    /// Those of a cone or a torus, in any order. `None` for other pieces, and for those that almost have no width.
    pub fn all(piece: &Piece, slack: f64) -> Option<Vec<Self>> {
        let ends = [piece.from, piece.to].map(|[rho, zeta]| [rho.max(0.0), zeta]);
        match piece.shape {
            Shape::Line {
                normal: normal @ [e, f],
            } => {
                let [thin, wide] = if ends[0][0] < ends[1][0] {
                    ends
                } else {
                    [ends[1], ends[0]]
                };
                (e.abs() > FLATTEST && f.abs() > FLATTEST && thin[0] < wide[0] && thin[1] != wide[1]).then(|| {
                    let climb = 1.0_f64.copysign(wide[1] - thin[1]);
                    vec![Self {
                        sheet: Sheet {
                            radii: [thin[0], wide[0]],
                            curve: Meridian::Cone {
                                normal,
                                from: thin,
                                rate: (wide[1] - thin[1]) / (wide[0] - thin[0]),
                            },
                            up: 1.0_f64.copysign(f),
                            out: 1.0,
                        },
                        climb,
                        ends: [climb * thin[1], climb * wide[1]],
                        curve: Profile::Cone {
                            normal,
                            rate: (wide[0] - thin[0]) / (wide[1] - thin[1]).abs(),
                        },
                    }]
                })
            }
            Shape::Arc {
                centre, radius, out, ..
            } => {
                if !(radius > SMALLEST * slack) {
                    return None;
                }
                let quarter = |[(from, a), (to, b)]: [(f64, [f64; 2]); 2]| {
                    let [a, b] = [a, b].map(|[rho, zeta]| [rho.max(0.0), zeta]);
                    let (f, e) = (0.5 * (from + to)).sin_cos();
                    let [side, up] = [1.0_f64.copysign(e), 1.0_f64.copysign(f)];
                    let climb = -side * up;
                    let [low, high] = [a, b].map(|[_, zeta]| climb * zeta);
                    let ends = [low.min(high), low.max(high)];
                    // What is shorter is at most an end of its neighbour.
                    (ends[1] - ends[0] > slack).then(|| Self {
                        sheet: Sheet {
                            radii: [a[0].min(b[0]), a[0].max(b[0])],
                            curve: Meridian::Torus {
                                centre,
                                tube: radius,
                                bend: radius.recip(),
                            },
                            up,
                            out,
                        },
                        climb,
                        ends,
                        curve: Profile::Torus {
                            middle: centre[0],
                            level: climb * centre[1],
                            tube: radius,
                            side,
                        },
                    })
                };
                Some(piece.monotone(Monotone::Both).into_iter().filter_map(quarter).collect())
            }
        }
    }

    /// The rounding error of its coordinates, at least.
    pub fn rounding(&self) -> f64 {
        let own = match self.curve {
            Profile::Cone { .. } => 0.0,
            Profile::Torus {
                middle, level, tube, ..
            } => middle.abs() + level.abs() + tube,
        };
        16.0 * f64::EPSILON * (own + self.sheet.radii[1] + self.ends[0].abs().max(self.ends[1].abs()))
    }

    /// The sign of `e`.
    pub fn side(&self) -> f64 {
        match self.curve {
            Profile::Cone { normal, .. } => 1.0_f64.copysign(normal[0]),
            Profile::Torus { side, .. } => side,
        }
    }

    /// Where it is at least as wide as `p`: the range of the place from which on it is. `None` if it is nowhere.
    pub fn from(&self, p: f64, slack: f64) -> Option<[f64; 2]> {
        let [[thin, wide], [low, high]] = [self.sheet.radii, self.ends];
        let (p, doubt) = (p.abs(), 8.0 * slack);
        if p < thin - doubt {
            return Some([low; 2]);
        }
        if p > wide + doubt {
            return None;
        }
        let range = match self.curve {
            Profile::Cone { rate, .. } => {
                let (place, off) = (low + (p - thin) / rate, doubt * (1.0 + 1.0 / rate));
                [place - off, place + off]
            }
            Profile::Torus {
                middle,
                level,
                tube,
                side,
            } => {
                let half_chord_sq = (tube - (p - middle)) * (tube + (p - middle));
                let doubt = 4.0 * doubt * tube;
                let [near, far] =
                    [half_chord_sq - doubt, half_chord_sq + doubt].map(|half_chord_sq| half_chord_sq.max(0.0).sqrt());
                if side > 0.0 {
                    [level - far, level - near]
                } else {
                    [level + near, level + far]
                }
            }
        };
        Some([range[0].max(low), range[1].min(high).max(low)])
    }
}

impl Lengthwise<'_> {
    /// By how much `Q` is off.
    fn error(&self, [v, rho]: [f64; 2], square: f64, norm_sq: f64) -> f64 {
        let Parallel { sheet, p, r, slack, .. } = self.parallel;
        if !self.parallel.known(rho, norm_sq) {
            return f64::INFINITY;
        }
        // Those of `x`, by the terms of `ν′`, and of `ρ` and `p`.
        let top = rho * v * v * sheet.bend() + square * p * p + 2.0 * square.sqrt() * p.abs() * rho;
        slack * (8.0 + 4.0 * r * top / (norm_sq * norm_sq.sqrt()))
    }
}

impl Curve for Lengthwise<'_> {
    type Point = SheetPoint;

    #[inline]
    fn at(&self, x: f64) -> SheetPoint {
        let Quarter { sheet, ends, curve, .. } = self.quarter;
        let Parallel { p, r, side, .. } = self.parallel;
        let (rho, e, square) = match *curve {
            Profile::Cone {
                normal: [e, f], rate, ..
            } => (sheet.radii[0] + rate * (x - ends[0]), e, f * f),
            Profile::Torus {
                middle,
                level,
                tube,
                side,
            } => {
                let k = x - level;
                let e = side * ((tube - k) * (tube + k)).max(0.0).sqrt() / tube;
                (middle + e * tube, e, (k / tube) * (k / tube))
            }
        };
        let v = ((rho - p) * (rho + p)).max(0.0).sqrt();
        let norm_sq = v * v + square * p * p;
        let nu = if norm_sq > 0.0 {
            -self.quarter.side() * rho * (square / norm_sq).sqrt()
        } else {
            0.0
        };
        SheetPoint {
            x,
            v,
            rho,
            e,
            square,
            nu,
            q: x + side * r * nu,
            norm_sq,
        }
    }

    #[inline]
    fn slope(&self, at: &SheetPoint) -> f64 {
        self.parallel.growth(at)
    }

    fn bounds(&self, [a, b]: [&SheetPoint; 2]) -> Bounds {
        match self.parallel.growths([a, b]) {
            Some((slope, norm_sq)) => Bounds {
                slope,
                error: self.error([b.v, b.rho], a.square.max(b.square), norm_sq),
            },
            None => Bounds::UNKNOWN,
        }
    }

    fn error_at(&self, at: &SheetPoint) -> f64 {
        self.error([at.v, at.rho], at.square, at.norm_sq)
    }

    fn slack(&self) -> f64 {
        self.parallel.slack
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;
    use sweepsim_props::*;

    fn pieces() -> impl Strategy<Value = Piece> {
        let shape = (-1.0..4.0_f64, 0.1..4.0_f64, -PI..PI, 0.1..6.0_f64).prop_map(|(centre, tube, from, angle)| {
            let at = |angle: f64| [centre + tube * angle.cos(), 0.5 + tube * angle.sin()];
            Piece {
                from: at(from),
                to: at(from + angle),
                shape: Shape::Arc {
                    centre: [centre, 0.5],
                    radius: tube,
                    angles: [from, from + angle],
                    out: 1.0,
                },
                patches: 0..0,
            }
        });
        let cone = (-PI..PI, 0.0..2.0_f64, 0.1..4.0_f64).prop_map(|(angle, a, length)| Piece {
            from: [a, 0.0],
            to: [a - length * angle.sin(), length * angle.cos()],
            shape: Shape::Line {
                normal: [angle.cos(), angle.sin()],
            },
            patches: 0..0,
        });
        // On one side of the axis.
        prop_oneof![shape, cone].prop_filter("a meridian", |piece| match piece.shape {
            Shape::Line { .. } => piece.to[0] > 0.0,
            Shape::Arc {
                centre,
                radius,
                angles: [from, to],
                ..
            } => (0..=1000).all(|n| centre[0] + radius * (from + (to - from) * f64::from(n) / 1000.0).cos() > 1e-3),
        })
    }

    proptest! {
        /// `Q′` is the derivative, `ν` the normal, and both are within their bounds; the section starts where it is said to.
        #[test]
        fn bounds_hold(piece in pieces(), share in 0.01..1.0_f64, r in 0.1..9.0_f64, positive in any::<bool>(), places in [0.0..1.0_f64, 0.0..1.0]) {
            for quarter in Quarter::all(&piece, 1e-14).unwrap_or_default() {
                let Quarter { sheet, ends, climb, .. } = &quarter;
                let p = sheet.radii[1] * share;
                let side = if positive { 1.0 } else { -1.0 };
                let curve = Lengthwise { quarter: &quarter, parallel: Parallel { sheet, p, r, side, slack: 1e-14 } };
                let from = quarter.from(p, 1e-14).unwrap();
                prop_assert!(from[0] >= ends[0] && from[1] <= ends[1] && from[0] <= from[1]);
                let start = curve.at(from[1]);
                prop_assert!(start.rho > p - 1e-9 && (from[0] == ends[0] || start.rho < p + 1e-5), "{start:?} {p}");
                prop_assume!(ends[1] - from[1] > 1e-3);
                let place = |share: f64| from[1] + (ends[1] - from[1]) * (0.001 + 0.998 * share);
                let [a, b] = [place(places[0].min(places[1])), place(places[0].max(places[1]))];
                let bounds = curve.bounds([&curve.at(a), &curve.at(b)]);
                for n in 0..=40 {
                    let at = curve.at(a + (b - a) * f64::from(n) / 40.0);
                    prop_assert!((sheet.height(&at) - climb * at.x).abs() < 1e-9 + 1e-7 / at.square, "{at:?}");
                    let slope = curve.slope(&at);
                    prop_assert!(slope >= bounds.slope[0] && slope <= bounds.slope[1], "{slope} {bounds:?}");
                    let h = 1e-6 * (at.x - from[1]).min(ends[1] - at.x).min(0.1);
                    let [before, after] = [at.x - h, at.x + h].map(|x| curve.at(x));
                    if at.norm_sq > 1e-2 && at.v > 1e-2 && at.e.abs() > 1e-2 && h > 1e-9 {
                        let found = (after.q - before.q) / (2.0 * h);
                        prop_assert!((found - slope).abs() < 1e-4 * (1.0 + slope.abs() + r / at.norm_sq) / at.e.abs(), "{found} {slope}");
                        // The section is the graph of `v`.
                        let widens = (after.v - before.v) / (2.0 * h);
                        let along = -quarter.side() * widens / (1.0 + widens * widens).sqrt();
                        prop_assert!((along - at.nu).abs() < 1e-3 / at.norm_sq, "{along} {}", at.nu);
                    }
                }
            }
        }
    }
}
