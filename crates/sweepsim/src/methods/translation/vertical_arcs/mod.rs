//! Arcs of the tip in a plane along the dexels, of a tool that does not turn.
//!
//! The line and the arc's plane are parallel, so that only the section of the tool at the distance `p` of the line from that plane matters, and how it is moved along a circle. In the
//! plane, with `q` ahead of the arc's centre, `z` up, and the arc at `r (cos α, sin α)`:
//!
//! - the section of a ball of radius `R` is a circle of radius `ρ`, `ρ² = R² − p²`, which sweeps the circles of radii `s = r ± ρ` about the ball's centre at the centre of the arc:
//!   a line meets them where `cos α = q/s`;
//! - a sharp edge of an upright tool is met at `±ρ` from its centre, and so where `r cos α = q ∓ ρ`;
//! - a disc of an upright tool where the arc is lowest or highest, and its cylinder never;
//! - a tool whose axis is perpendicular to the arc's plane has a circle in each section, as a ball has, but for the normal;
//! - the section of a cone or a torus of an upright tool sweeps the curves that are parallel to it at the distance `r`: one equation in one unknown for each line.
//!
//! With the outward normal `N = (ν cos α, p, ν sin α)`, `ν = s − r`, the `g` of a ball has the derivative `−r s` along a line, but for a positive factor: it falls where `s > 0`.

mod ball;
mod crosswise;
mod edge;
mod lengthwise;
mod level;
mod parallel;
mod quarter;
mod roots;
mod sheet;
mod slice;

use super::arc_place::ArcPlace;
use super::rows::{Floor, Row, rows};
use super::{Ceiling, Collector};
use crate::cutter::outline::{Outline, Piece, Shape};
use crate::methods::harvest::unit;
use crate::time::circles::VerticalArc;
use ball::ball;
use nalgebra::Vector3;
use sheet::Sheet;
use std::f64::consts::FRAC_PI_2;
use sweepsim_dexel::Source;
use sweepsim_motion::{Segment, SegmentEnd};

/// Angles of the arc are cut off at places that are exact to a few roundings.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A sweep of a tool along an arc. `source` gives the source at a share of its time.
pub(crate) fn sweep_vertical_arc(
    outline: &Outline,
    (arc, segment, slack, height_tolerance): (&VerticalArc, &Segment, f64, f64),
    (lines, ceiling): (&mut Collector, Option<&Ceiling>),
    source: impl Fn(f64) -> Source,
    done: [&mut [bool]; 2],
) {
    let [patches, edges] = done;
    // The centre of a wide arc has fewer digits than the tool.
    let far = arc.centre.iter().fold(arc.radius, |far, c| far.max(c.abs()));
    let slack = slack.max(16.0 * f64::EPSILON * far);
    if !(slack < 0.25 * height_tolerance) {
        return;
    }
    let turn = segment.start();
    let axis: Vector3<f64> = turn.column(2).into_owned();
    let [ux, uy] = arc.ahead;
    let own = [ux * axis.x + uy * axis.y, ux * axis.y - uy * axis.x, axis.z];
    let mut rolling = Rolling {
        arc,
        slack,
        axis: own,
        directions: arc.directions(),
        rates: [SegmentEnd::Start, SegmentEnd::Finish].map(|end| {
            let [x, y, z] = segment.velocity(end)[1];
            if arc.level { ux * x + uy * y } else { z }
        }),
        highest: ceiling.map_or(f64::INFINITY, |ceiling| {
            ceiling.above(arc.heights()[0], lines.lines.spacing())
        }),
        lines,
        source,
    };
    let stance = match own {
        _ if arc.level => Stance::Level,
        [0.0, 0.0, 1.0] => Stance::Upright,
        [0.0, 1.0 | -1.0, 0.0] => Stance::Across,
        [1.0 | -1.0, 0.0, 0.0] => Stance::Within,
        _ => Stance::Other,
    };
    for piece in &outline.pieces {
        if rolling.piece(piece, stance) {
            patches[piece.patches.clone()].fill(true);
        }
    }
    for rim in &outline.rims {
        match stance {
            Stance::Upright if rim.height <= rolling.highest => rolling.rim(rim),
            Stance::Upright => {}
            Stance::Across => rolling.edge_across(rim),
            Stance::Within => rolling.edge_lengthwise(rim),
            Stance::Level => rolling.level_edge(rim),
            Stance::Other => continue,
        }
        edges[rim.edges.clone()].fill(true);
    }
}

/// How the tool's axis lies.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stance {
    /// Along the dexels.
    Upright,
    /// Perpendicular to the arc's plane.
    Across,
    /// In the arc's plane, and perpendicular to the dexels.
    Within,
    /// In the arc's plane, to the left of `ahead`, with the dexels perpendicular to the plane.
    Level,
    Other,
}

/// The search along one arc.
struct Rolling<'a, 'b, S> {
    arc: &'a VerticalArc,
    /// The rounding error of coordinates.
    slack: f64,
    /// The tool's axis, `(q, p, z)`.
    axis: [f64; 3],
    /// The ranges of `cos α` and `sin α`.
    directions: [[f64; 2]; 2],
    /// The velocity along the dexels at the ends, but for positive factors; for a plane across them, that across the tool's axis.
    rates: [f64; 2],
    /// What is this high above the tip is above the ceiling at all times.
    highest: f64,
    lines: &'a mut Collector<'b>,
    source: S,
}

/// The directions with a given cosine.
#[derive(Clone, Copy, Debug)]
enum Directions {
    None,
    /// It is too close to 1 or −1: whether one of them may be on the arc.
    Level(bool),
    /// The sine, of both signs, and the error of the angles.
    Pair(f64, f64),
}

impl<S: Fn(f64) -> Source> Rolling<'_, '_, S> {
    /// Whether it is settled.
    fn piece(&mut self, piece: &Piece, stance: Stance) -> bool {
        let upright = stance == Stance::Upright;
        if upright && piece.heights()[0] > self.highest {
            return true;
        }
        if stance == Stance::Level {
            return self.level(piece);
        }
        if let Some(part) = piece.ball() {
            ball(self, &part);
            return true;
        }
        match stance {
            Stance::Across => return self.slices(piece),
            Stance::Within => return self.lengthwise(piece),
            Stance::Upright | Stance::Level | Stance::Other => {}
        }
        match piece.shape {
            // No line meets an upright wall.
            Shape::Line { normal: [1.0, _] } if upright => true,
            Shape::Line { normal: [0.0, up] } if upright => {
                let radii = [piece.from[0].min(piece.to[0]), piece.from[0].max(piece.to[0])];
                self.disc(piece.from[1], radii, up);
                true
            }
            _ if upright => {
                let sheets = Sheet::all(piece, self.slack);
                for sheet in sheets.iter().flatten() {
                    self.sheet(sheet);
                }
                sheets.is_some()
            }
            _ => false,
        }
    }

    /// The lines in ranges of `p` and `q` from a point, with their `q` and `p`.
    fn each(
        &mut self,
        tip: [f64; 3],
        ranges: [[f64; 2]; 2],
        mut visit: impl FnMut(&mut Self, (usize, usize), [f64; 2]),
    ) {
        let ahead = self.arc.ahead;
        let floor = Floor {
            tip,
            ahead,
            rounding: self.slack,
        };
        let lattice = self.lines.lines;
        rows(lattice, &floor, ranges, |Row { i, j, x }| {
            for j in j[0]..=j[1] {
                let y = lattice.coordinate(1, j) - tip[1];
                if lattice.asks(i, j) {
                    visit(self, (i, j), [ahead[0] * x + ahead[1] * y, ahead[0] * y - ahead[1] * x]);
                }
            }
        });
    }

    /// Where the velocity in a direction, that of the [`rates`](Self::rates), changes its sign: 1 if that is where the tip has gone farthest in it, −1 if it is farthest behind; and the share of the way.
    fn turn(&self, towards: [f64; 2]) -> (f64, f64) {
        let top = if self.rates[0] > self.rates[1] { 1.0 } else { -1.0 };
        let share = match self.place(towards.map(|c| top * c), 0.0) {
            ArcPlace::Inside(share) => share,
            // At an end but for rounding.
            _ if (self.rates[0].abs()) < self.rates[1].abs() => 0.0,
            _ => 1.0,
        };
        (top, share)
    }

    /// A disc or ring with this normal along the axis: all of it where the tool is highest or lowest.
    fn disc(&mut self, height: f64, [inner, outer]: [f64; 2], up: f64) {
        let [before, after] = self.rates.map(|rate| up * rate < 0.0);
        if before == after {
            return;
        }
        let (top, share) = self.turn([0.0, 1.0]);
        let change = i8::from(after) - i8::from(before);
        let jump = if up > 0.0 { -change } else { change };
        let [x, y, z] = self.arc.centre;
        let z = z + height + top * self.arc.radius;
        let (error, source) = (4.0 * self.slack, (self.source)(share));
        let inner = if inner == 0.0 { f64::NEG_INFINITY } else { inner };
        self.each([x, y, z], [[-outer, outer]; 2], |own, (i, j), [q, p]| {
            let (rho, line) = ((q * q + p * p).sqrt(), own.lines.lines.line(i, j));
            if rho > inner + error && rho < outer - error {
                own.lines.crossing(line, z, jump, [0.0, 0.0, up as f32], source);
            } else if rho > inner - error && rho < outer + error {
                own.lines.open(line);
            }
        });
    }

    /// Where a direction is on the arc, whose angle is known up to an error.
    fn place(&self, [c, s]: [f64; 2], error: f64) -> ArcPlace {
        let arc = self.arc;
        let ([x, y], side) = (arc.from, arc.side());
        let turn = [c * x + s * y, side * (s * x - c * y)];
        ArcPlace::share(turn, arc.angle.abs(), error + ROUNDING)
    }

    /// The directions with a cosine that is known up to an error.
    fn directions(&self, cosine: f64, error: f64) -> Directions {
        self.directions_by(0, cosine, error)
    }

    /// The directions with this cosine (0) or sine (1), that is known up to an error. [`Directions`] speaks of the other one.
    fn directions_by(&self, k: usize, value: f64, error: f64) -> Directions {
        let [low, high] = self.directions[k];
        let error = error + ROUNDING;
        if value > high + error || value < low - error {
            return Directions::None;
        }
        let square = (1.0 - value) * (1.0 + value);
        // The angle is off by the error over the other one, to first order.
        if !(square > 64.0 * error) {
            let mut extreme = [0.0; 2];
            extreme[k] = 1.0_f64.copysign(value);
            // The value is this far from the extreme at most, and the angle the root of twice that.
            let wide = (2.0 * (66.0 * error)).sqrt() + ROUNDING;
            let place = self.place(extreme, wide.min(FRAC_PI_2));
            return Directions::Level(!matches!(place, ArcPlace::Outside));
        }
        let other = square.sqrt();
        Directions::Pair(other, 1.25 * error / other)
    }

    /// A direction `(q, p, z)` in space.
    fn in_space(&self, [q, p, z]: [f64; 3]) -> [f32; 3] {
        let [x, y] = self.arc.ahead;
        unit(Vector3::new(x * q - y * p, y * q + x * p, z))
    }
}
