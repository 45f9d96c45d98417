//! Arcs of the tip in a plane along the dexels, of a tool that does not turn.
//!
//! The line and the arc's plane are parallel, so that only the section of the tool at the distance `p` of the line from
//! that plane matters, and how it is moved along a circle. In the plane, with `q` ahead of the arc's centre, `z` up,
//! and the arc at `r (cos α, sin α)`:
//!
//! - the section of a ball of radius `R` is a circle of radius `ρ`, `ρ² = R² − p²`, which sweeps the circles of radii
//!   `s = r ± ρ` about the ball's centre at the centre of the arc: a line meets them where `cos α = q/s`;
//! - a sharp edge of an upright tool is met at `±ρ` from its centre, and so where `r cos α = q ∓ ρ`;
//! - a disc of an upright tool where the arc is lowest or highest, and its cylinder never;
//! - a tool whose axis is perpendicular to the arc's plane has a circle in each section, as a ball has, but for the
//!   normal;
//! - the section of a cone or a torus, of a tool that is upright or lies in the arc's plane, sweeps the curves that are
//!   parallel to it at the distance `r`: one equation in one unknown for each line.
//!
//! With the outward normal `N = (ν cos α, p, ν sin α)`, `ν = s − r`, the `g` of a ball has the derivative `−r s` along
//! a line, but for a positive factor: it falls where `s > 0`.

mod circles;
mod crosswise;
mod edges;
mod level;
mod roots;
mod section;
mod walls;

use super::arc_place::ArcPlace;
use super::quarter::{Quarter, STEEPEST};
use super::rows::Floor;
use crate::cutter::outline::{Outline, Piece, Rim, Shape};
use crate::methods::harvest::{Collector, unit};
use crate::methods::sheets::Undecided::{self, Close};
use crate::methods::sheets::intervals::{Range, hull};
use crate::time::circles::VerticalArc;
use nalgebra::Vector3;
use std::f64::consts::FRAC_PI_2;
use sweepsim_dexel::Source;
use sweepsim_motion::{Segment, SegmentEnd};

/// What vanishes is beyond doubt from so many times its error on.
const CERTAIN: f64 = 64.0;
/// Ends are this many rounding errors wide.
const END: f64 = 8.0;
/// Angles of the arc are cut off at places that are exact to a few roundings.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A sweep of a tool along an arc. `source` gives the source at a share of its time.
pub(crate) fn sweep_vertical_arc(
    outline: &Outline,
    (arc, segment, slack, height_tolerance): (&VerticalArc, &Segment, f64, f64),
    (lines, highest): (&mut Collector, f64),
    source: impl Fn(f64) -> Source,
    done: [&mut [bool]; 2],
) {
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
        end: ArcPlace::<f64>::end(arc.angle),
        axis: own,
        stance: match own {
            _ if arc.level => Stance::Level,
            [0.0, 0.0, 1.0] => Stance::Upright,
            [0.0, 1.0 | -1.0, 0.0] => Stance::Across,
            [1.0 | -1.0, 0.0, 0.0] => Stance::Within,
            _ => Stance::Other,
        },
        directions: arc.directions(),
        rates: [SegmentEnd::Start, SegmentEnd::Finish].map(|end| {
            let [x, y, z] = segment.velocity(end)[1];
            if arc.level { ux * x + uy * y } else { z }
        }),
        highest,
        lines,
        source,
    };
    outline.settle(&mut rolling, Rolling::piece, Rolling::rim, done);
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
    /// The turn to its end.
    end: [f64; 2],
    /// The tool's axis, `(q, p, z)`.
    axis: [f64; 3],
    stance: Stance,
    /// The ranges of `cos α` and `sin α`.
    directions: [Range; 2],
    /// The velocity along the dexels at the ends, but for positive factors; for a plane across them, that across the
    /// tool's axis.
    rates: [f64; 2],
    /// What is this high above the tip is above the ceiling at all times.
    highest: f64,
    lines: &'a mut Collector<'b>,
    source: S,
}

/// Half of what a circle or a ball covers of a line.
struct Chord {
    half: f64,
    /// How far off it may be.
    off: f64,
    /// Whether it is beyond that.
    certain: bool,
}

impl<S: Fn(f64) -> Source> Rolling<'_, '_, S> {
    /// `None` if there is no closed form.
    fn piece(&mut self, piece: &Piece) -> Option<()> {
        let stance = self.stance;
        if stance == Stance::Upright && piece.heights()[0] > self.highest {
            return Some(());
        }
        if let Some(ball) = piece.ball() {
            if stance == Stance::Level {
                self.level_ball(&ball);
            } else {
                self.ball(&ball);
            }
            return Some(());
        }
        match (stance, piece.shape) {
            (Stance::Other, _) => return None,
            (Stance::Across, Shape::Line { normal: [0.0, _] }) => {
                self.flat(piece.from[1], piece.from[0].max(piece.to[0]));
            }
            (Stance::Across, _) => return self.slices(piece),
            (Stance::Upright, Shape::Line { normal: [0.0, up] }) => {
                self.disc(piece.from[1], hull(piece.from[0], piece.to[0]), up);
            }
            // They are seen edge-on.
            (
                Stance::Upright,
                Shape::Line {
                    normal: [1.0, _] | [_, 0.0],
                },
            )
            | (_, Shape::Line { normal: [0.0, _] }) => {}
            (_, Shape::Line { normal: [out, 0.0] }) => {
                let (radius, heights) = (piece.from[0], hull(piece.from[1], piece.to[1]));
                if stance == Stance::Level {
                    self.level_wall(radius, heights, out);
                } else {
                    self.wall(radius, heights, out);
                }
            }
            (_, Shape::Line { normal: [_, up] }) if up.abs() <= STEEPEST => return None,
            _ => {
                for quarter in &Quarter::all(piece, self.slack, stance == Stance::Upright)? {
                    match stance {
                        Stance::Level => self.level_quarter(quarter),
                        _ => self.quarter(quarter, stance == Stance::Within),
                    }
                }
            }
        }
        Some(())
    }

    /// `None` if there is no closed form.
    fn rim(&mut self, rim: &Rim) -> Option<()> {
        match self.stance {
            Stance::Upright if rim.height > self.highest => {}
            Stance::Upright => self.upright_edge(rim),
            // No line meets it, except in its plane.
            Stance::Across => self.flat(rim.height, rim.radius),
            Stance::Within => self.lying_edge(rim),
            Stance::Level => self.level_edge(rim),
            Stance::Other => return None,
        }
        Some(())
    }

    /// The lines in ranges of `p` and `q` from a point, with their `q` and `p`: what they have, or that they are open.
    fn each(
        &mut self,
        tip: [f64; 3],
        ranges: [Range; 2],
        mut visit: impl FnMut(&mut Self, usize, [f64; 2]) -> Result<(), Undecided>,
    ) {
        let floor = Floor {
            tip,
            ahead: self.arc.ahead,
            rounding: self.slack,
        };
        floor.each(self.lines.lines, ranges, END, |line, [p, q]| {
            let mark = self.lines.mark();
            if visit(self, line, [q, p]).is_err() {
                self.lines.forget(mark);
                self.lines.open(line);
            }
        });
    }

    /// Adds a crossing, with a normal `(q, p, z)` of any length, after a share of the way.
    fn crossing(&mut self, line: usize, z: f64, jump: i8, [q, p, up]: [f64; 3], share: f64) {
        let [x, y] = self.arc.ahead;
        let normal = unit(Vector3::new(x * q - y * p, y * q + x * p, up));
        let source = (self.source)(share);
        self.lines.crossing(line, z, jump, normal, source);
    }

    /// Half of the chord of a circle or a ball at a distance that is known up to an error. `None` beside it.
    fn chord(&self, radius: f64, distance: f64, error: f64) -> Option<Chord> {
        let square = (radius - distance) * (radius + distance);
        // Coordinates that are off by this much change it by as much.
        let doubt = 8.0 * error * (radius + error);
        let certain = square > CERTAIN * doubt;
        let (half, off) = if certain {
            let half = square.sqrt();
            (half, 2.0 * error * (1.0 + distance.abs() / half))
        } else {
            (0.0, ((CERTAIN + 2.0) * doubt).sqrt() + 4.0 * error)
        };
        (square >= -doubt).then_some(Chord { half, off, certain })
    }

    /// Where the velocity in a direction, that of the [`rates`](Self::rates), changes its sign: 1 if that is where the
    /// tip has gone farthest in it, −1 if it is farthest behind; and the share of the way.
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

    /// Where a direction is on the arc, whose angle is known up to an error.
    fn place(&self, [c, s]: [f64; 2], error: f64) -> ArcPlace {
        let arc = self.arc;
        let ([x, y], side) = (arc.from, arc.side());
        let [cosine, sine] = [c * x + s * y, side * (s * x - c * y)];
        let share = || sine.atan2(cosine) / arc.angle.abs();
        ArcPlace::new([cosine, sine], self.end, error + ROUNDING, share)
    }

    /// The share of the way at a direction; `None` if it is not on the arc.
    fn share(&self, direction: [f64; 2], error: f64) -> Result<Option<f64>, Undecided> {
        match self.place(direction, error) {
            ArcPlace::Outside => Ok(None),
            ArcPlace::Near => Err(Close),
            ArcPlace::Inside(share) => Ok(Some(share)),
        }
    }

    /// Of the directions with a cosine (0) or sine (1) that is known up to an error, the other one, which has both
    /// signs, and the error of the angles. `None` if they are not on the arc.
    fn other(&self, k: usize, value: f64, error: f64) -> Result<Option<(f64, f64)>, Undecided> {
        let [low, high] = self.directions[k];
        let error = error + ROUNDING;
        if value > high + error || value < low - error {
            return Ok(None);
        }
        let square = (1.0 - value) * (1.0 + value);
        // The angle is off by the error over the other one, to first order.
        if square > CERTAIN * error {
            let other = square.sqrt();
            return Ok(Some((other, 1.25 * error / other)));
        }
        let mut extreme = [0.0; 2];
        extreme[k] = 1.0_f64.copysign(value);
        // The value is this far from the extreme at most, and the angle the root of twice that.
        let wide = (2.0 * ((CERTAIN + 2.0) * error)).sqrt() + ROUNDING;
        match self.place(extreme, wide.min(FRAC_PI_2)) {
            ArcPlace::Outside => Ok(None),
            ArcPlace::Near | ArcPlace::Inside(_) => Err(Close),
        }
    }
}
