//! The tool at rest between two moves, not along the dexels: a line meets a plane of it once, a cone, a cylinder or a
//! ball up to twice.
//!
//! Coordinates of the tool: `a` across its axis, in the vertical plane of it, with the dexels' direction `(s, 0, k)`;
//! `b` across both, so horizontal; `ζ` along the axis. Seen from the tip, a line is at `q` along the horizontal part of
//! the axis, and at `b` across it. In the tool's coordinates it is
//!
//! ```text
//! s ζ = q + k a
//! ```
//!
//! with one unknown, `a`. On a line of the meridian, `n_ρ ρ + n_ζ ζ = w`, so `(n_ρ s)² (a² + b²) = (u − n_ζ k a)²` with
//! `u = s w − n_ζ q`. The slope of `n_ρ ρ + n_ζ ζ` along the dexel is that of the normal, `n_z`, by which all errors
//! are divided.

use super::super::curves::{Heading, Local};
use super::super::rows::Floor;
use super::Neighbour;
use super::cone_sign_changes::wedges;
use super::cones::Cone;
use crate::algebra::certain::certainly_within;
use crate::cutter::outline::{Outline, Piece, Shape};
use crate::methods::harvest::{Collector, unit};
use nalgebra::Matrix3;
use sweepsim_dexel::Source;

/// A face of which a dexel is a tangent, but for this angle, is left to the general method.
pub(super) const PARALLEL: f64 = 1e-6;
/// But for planes as narrow as this part of the spacing, as they are seen: lines that meet them are open.
const CLEAR: f64 = 64.0;
/// Cones that are flatter than this, but no planes, are left to it, too.
const FLAT: f64 = 1e-3;

/// A side of the placement: the move there in the tool's coordinates, or whether the tool counts as moving inwards
/// beyond an end.
#[derive(Clone, Copy, Debug)]
pub(super) enum AtRestSide {
    Along([f64; 3]),
    Beyond(bool),
}

/// The planes, cones, cylinders and balls of a tool turned by `turn`, at rest with its tip at `tip`.
pub(crate) fn leaning(
    outline: &Outline,
    (turn, tip, slack): (&Matrix3<f64>, [f64; 3], f64),
    sides: [Neighbour; 2],
    (lines, highest): (&mut Collector, f64),
    source: Source,
    done: &mut [bool],
) {
    let axis = [turn[(0, 2)], turn[(1, 2)], turn[(2, 2)]];
    let s = axis[0].hypot(axis[1]);
    if !(s > 0.0) {
        return;
    }
    let (ahead, k) = ([axis[0] / s, axis[1] / s], axis[2]);
    let mut leaning = Leaning {
        floor: Floor {
            tip,
            ahead,
            rounding: slack,
        },
        tilt: [s, k],
        sides: sides.map(|side| match side {
            Neighbour::Beyond(negative) => AtRestSide::Beyond(negative),
            Neighbour::Along([x, y, z]) => {
                let [q, p] = [ahead[0] * x + ahead[1] * y, ahead[0] * y - ahead[1] * x];
                // Along the axis as the headings of both moves have it.
                let along = Heading::along_axis(turn, [x, y, z]);
                AtRestSide::Along([s * z - k * q, p, along])
            }
        }),
        lines,
        source,
    };
    for piece in &outline.pieces {
        if piece.heights()[0] > highest || leaning.piece(piece).is_some() {
            done[piece.patches.clone()].fill(true);
        }
    }
}

pub(super) struct Leaning<'a, 'b> {
    pub floor: Floor,
    /// Sine and cosine of the angle between the axis and the dexels.
    pub tilt: [f64; 2],
    pub sides: [AtRestSide; 2],
    lines: &'a mut Collector<'b>,
    source: Source,
}

/// Where a line meets a surface, in the tool's coordinates.
pub(super) struct LeaningPoint {
    /// Above the tip, along the dexel.
    pub height: f64,
    /// The normal, of any length.
    pub normal: [f64; 3],
    /// By how much the normal may be off across the tool's axis, and along it.
    pub error: [f64; 2],
    /// Whether it lies between the ends of the piece beyond doubt; `None` if that is open.
    pub inside: Option<bool>,
}

/// The points of a line: their number is not certain for a tangent.
pub(super) enum Points {
    Two([Option<LeaningPoint>; 2]),
    Tangent,
}

impl Leaning<'_, '_> {
    /// `None` if there is no closed form.
    fn piece(&mut self, piece: &Piece) -> Option<()> {
        let ([s, k], slack) = (self.tilt, self.floor.rounding);
        let [from, to] = [piece.from, piece.to];
        let radii = [from[0].min(to[0]), from[0].max(to[0])];
        let heights = [from[1].min(to[1]), from[1].max(to[1])];
        match piece.shape {
            Shape::Line { normal: [0.0, up] } => {
                let reach = radii[1];
                let middle = s * from[1];
                let range = [middle - k.abs() * reach, middle + k.abs() * reach];
                if k == 0.0 {
                    // Lines in its plane only.
                    self.visit([[-reach, reach], range], |_, _| Points::Tangent);
                    return Some(());
                }
                let [before, after] = [0, 1].map(|n| self.negative(n, [0.0, 0.0, up], [0.0; 2]));
                if before == after {
                    return Some(());
                }
                if k.abs() < PARALLEL {
                    // Hardly a line meets it, if any.
                    if !((k.abs() * reach + slack) * CLEAR < self.lines.lines.spacing()) {
                        return None;
                    }
                    self.visit([[-reach, reach], range], |_, _| Points::Tangent);
                    return Some(());
                }
                let error = 8.0 * slack / k.abs();
                self.visit([[-reach, reach], range], |q, b| {
                    let a = (s * from[1] - q) / k;
                    let rho = (a * a + b * b).sqrt();
                    // The centre is no end.
                    let inside =
                        certainly_within(rho, [if radii[0] == 0.0 { -1.0 } else { radii[0] }, radii[1]], error);
                    let point = LeaningPoint {
                        height: a * s + from[1] * k,
                        normal: [0.0, 0.0, up],
                        error: [0.0; 2],
                        inside,
                    };
                    Points::Two([Some(point), None])
                });
            }
            Shape::Line { normal } => {
                if normal[0].abs() < FLAT {
                    return None;
                }
                let wedges = wedges(normal, &self.sides);
                let many = wedges.len() > 1;
                for wedge in wedges {
                    let cone = Cone {
                        normal,
                        tilt: self.tilt,
                        slack,
                        weight: normal[0] * from[0] + normal[1] * from[1],
                        ends: [radii, heights],
                    };
                    let across = wedge.across(radii);
                    let along = wedge.along([from, to], self.tilt);
                    self.visit([across, along], |q, b| cone.points([q, b], many.then_some(&wedge)));
                }
            }
            Shape::Arc {
                centre: [0.0, middle],
                radius,
                out,
                ..
            } => {
                let place = s * middle;
                let poles = [from, to].map(|end| end[0] == 0.0);
                let low = if from[1] < to[1] { poles[0] } else { poles[1] };
                let high = if from[1] < to[1] { poles[1] } else { poles[0] };
                let ends = [
                    if low { f64::NEG_INFINITY } else { heights[0] },
                    if high { f64::INFINITY } else { heights[1] },
                ];
                let range = [place - radius, place + radius];
                self.visit([[-radius, radius], range], |q, b| {
                    let across = q - place;
                    let square = (radius - b) * (radius + b) - across * across;
                    if square < -64.0 * slack * radius {
                        return Points::Two([None, None]);
                    }
                    if square < 64.0 * slack * radius {
                        return Points::Tangent;
                    }
                    let half = square.sqrt();
                    let error = 8.0 * slack * radius / half;
                    Points::Two([-half, half].map(|rise| {
                        let [a, along] = [s * rise - k * across, s * across + k * rise];
                        Some(LeaningPoint {
                            height: k * middle + rise,
                            normal: [a, b, along].map(|c| out * c / radius),
                            error: [error / radius; 2],
                            inside: certainly_within(middle + along, ends, error),
                        })
                    }))
                });
            }
            Shape::Arc { .. } if k == 0.0 => self.lying(piece)?,
            Shape::Arc { .. } => return None,
        }
        Some(())
    }

    /// Whether `g` is negative on one side, if that is certain.
    fn negative(&self, side: usize, normal: [f64; 3], [across, along]: [f64; 2]) -> Option<bool> {
        let d = match self.sides[side] {
            AtRestSide::Beyond(negative) => return Some(negative),
            AtRestSide::Along(d) => d,
        };
        let g = normal[0] * d[0] + normal[1] * d[1] + normal[2] * d[2];
        // With a normal along the axis, g is a product.
        let level = normal[0] == 0.0 && normal[1] == 0.0;
        let rounding = 16.0 * f64::EPSILON;
        let error = (d[0].abs() + d[1].abs()) * (across + rounding) + d[2].abs() * (along + rounding * normal[2].abs());
        if level || g.abs() > error { Some(g < 0.0) } else { None }
    }

    /// The lines with `b` and `q` in these ranges; `meet` tells where each meets the surface.
    pub fn visit(&mut self, ranges: [[f64; 2]; 2], meet: impl Fn(f64, f64) -> Points) {
        let (lattice, floor) = (self.lines.lines, self.floor);
        floor.each(lattice, ranges, 8.0, |line, [b, q]| match meet(q, b) {
            Points::Tangent => self.lines.open(line),
            Points::Two(points) => {
                for point in points.into_iter().flatten() {
                    self.point(&point, line);
                }
            }
        });
    }

    #[inline]
    fn point(&mut self, point: &LeaningPoint, line: usize) {
        if point.inside == Some(false) {
            return;
        }
        let [before, after] = [0, 1].map(|n| self.negative(n, point.normal, point.error));
        if before.is_some() && before == after {
            return;
        }
        let (Some(before), Some(after), Some(true)) = (before, after, point.inside) else {
            self.lines.open(line);
            return;
        };
        let ([s, k], [a, b, c]) = (self.tilt, point.normal);
        let seen: Local = [s * c - k * a, b, s * a + k * c];
        let change = i8::from(after) - i8::from(before);
        let jump = if seen[2] > 0.0 { -change } else { change };
        let [ux, uy] = self.floor.ahead;
        let normal = [ux * seen[0] - uy * seen[1], uy * seen[0] + ux * seen[1], seen[2]];
        let z = self.floor.tip[2] + point.height;
        self.lines.crossing(line, z, jump, unit(normal.into()), self.source);
    }
}
