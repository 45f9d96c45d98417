//! Arcs about the axis of a tool that leans or lies: those of programs in tilted planes.
//!
//! The tool turns with the arc about the arc's axis, which is parallel to its own. Its surfaces touch their envelope in the plane of both axes, but for a tiny rise: where a tool of radius `ρ(ζ)` goes along
//! an arc of radius `R`, that is a surface of revolution about the arc's axis with the radius `R ± ρ(ζ)`. In coordinates `(x, y, z)` about this axis, `z` along it, `x` steepest upwards across it and `y`
//! horizontal, a dexel line has one `y`; `x` and `z` are linear along it, with the slopes `a` and `b` in a parameter `w`: `z` itself if the axis is closer to the dexels than to the horizontal plane, otherwise `x`. So both are as accurate as
//! coordinates are, however little the tool leans. With `ϱ² = x² + y²`, a line meets
//!
//! - a cylinder or a cone where `ϱ = ± (R ± ρ(z))`, convex in `w`;
//! - a ball or a torus where `(ϱ − R′)² + (z − ζ_c)² = r²` with the circle of centres of radius `R′ = R ± ρ_c`: the second derivative is `2 (a² + b² − a² R′ y²/ϱ³)`, whose sign changes at no more than two places;
//! - a sharp edge in its plane, where the law of cosines gives the angles of the arc;
//! - a disc nowhere.
//!
//! The rise, `lift` at a time, is no more than tips are displaced. So it moves crossings by as much, but decides no more than whether lines as near as that to an end are left open, and the sign of `g` on
//! discs: as along a straight move.

mod cone;
mod rim;
mod roots;
mod tube;

use super::Collector;
use super::arc_place::ArcPlace;
use super::curves::Heading;
use super::rows::{Floor, Row, rows};
use crate::cutter::outline::{Outline, Piece, Shape};
use crate::methods::harvest::unit;
use crate::time::circles::ArcAboutAxis;
use nalgebra::Vector3;
use roots::Open;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use sweepsim_dexel::Source;
use sweepsim_motion::Segment;

/// Angles of the arc are cut off at places that are exact to a few roundings.
const ROUNDING: f64 = 8.0 * f64::EPSILON;
/// A rise of less than this many rounding errors has no sign.
const SHORTEST: f64 = 4.0;
/// The part of what heights may be off by that the rise may bend surfaces of revolution.
const BENT: f64 = 0.05;
/// How far the tool has risen is as good as exact where the tip's direction is off by less than this: the rise is at most a hundredth of the tolerance.
const STILL: f64 = 1e-4;
/// Lines that are closer than this many roundings to the arc's axis are open.
const AXIS: f64 = 64.0;

/// A sweep of a tool along an arc. `source` gives the source at a share of its time.
pub(crate) fn sweep_arc_about_axis(
    outline: &Outline,
    (arc, segment, slack, height_tolerance): (&ArcAboutAxis, &Segment, f64, f64),
    lines: &mut Collector,
    source: impl Fn(f64) -> Source,
    done: [&mut [bool]; 2],
) {
    // The centre of a wide arc has fewer digits than the tool.
    let far = arc.centre.iter().fold(arc.radius, |far, c| far.max(c.abs()));
    let slack = slack.max(16.0 * f64::EPSILON * far);
    let rise = Heading::along_axis(&segment.start(), segment.travel());
    if !(rise.abs() > SHORTEST * slack) {
        return;
    }
    let slope = rise / (arc.radius * arc.angle.abs());
    let along = Along::tilted(arc.tilt);
    let fine = slack * along.height.abs();
    let ends = || outline.pieces.iter().flat_map(|piece| [piece.from[0], piece.to[0]]);
    let widest = ends().fold(0.0, f64::max);
    let mut orbit = Orbit {
        arc,
        slack,
        fine,
        coarse: fine + 2.0 * rise.abs(),
        height_tolerance,
        along,
        rise,
        slope,
        sectors: sectors(arc, widest),
        lines,
        source,
    };
    outline.settle(&mut orbit, Orbit::piece, Orbit::rim, done);
}

/// The number of parts of an arc that are almost straight, seen from a tool of this radius.
fn sectors(arc: &ArcAboutAxis, widest: f64) -> usize {
    let bow = (0.5 * widest / arc.radius).min(1.0);
    let most = 2.0 * (1.0 - bow).acos();
    ((arc.angle.abs() / most).ceil() as usize).clamp(1, 64)
}

/// The search along one arc.
struct Orbit<'a, 'b, S> {
    arc: &'a ArcAboutAxis,
    /// The rounding error of coordinates, that of places on a line, and how far the rise may move a surface in addition.
    slack: f64,
    fine: f64,
    coarse: f64,
    /// Heights may be off by this much.
    height_tolerance: f64,
    along: Along,
    rise: f64,
    /// The rise over the length of the arc.
    slope: f64,
    /// The arc is searched in so many parts, and
    sectors: usize,
    lines: &'a mut Collector<'b>,
    source: S,
}

/// How fast `x`, `z` and the height grow along a line with its parameter.
#[derive(Clone, Copy, Debug)]
struct Along {
    x: f64,
    z: f64,
    height: f64,
}

impl Along {
    fn tilted([s, k]: [f64; 2]) -> Self {
        if s < k.abs() {
            Self {
                x: s / k,
                z: 1.0,
                height: k.recip(),
            }
        } else {
            Self {
                x: 1.0,
                z: k / s,
                height: s.recip(),
            }
        }
    }

    /// By how much `x` in a given height `z` is off for each unit that `z` is.
    fn shear(self) -> f64 {
        (self.x / self.z).abs()
    }
}

/// A line about the arc's axis.
#[derive(Clone, Copy, Debug)]
struct View {
    place: (usize, usize),
    y: f64,
    /// Where the parameter is 0: `x` or `z` is 0 there.
    x: f64,
    z: f64,
    height: f64,
}

/// The part of the arc that is looked at, as shares of it: a crossing belongs to one part only.
#[derive(Clone, Copy, Debug)]
struct Sector {
    shares: [f64; 2],
}

/// Where a line meets the envelope.
struct EnvelopePoint {
    /// The parameter of the line,
    w: f64,
    /// and its error.
    error: f64,
    /// The direction from the arc's axis to the tip, of any length, and the error of its angle.
    tip: [f64; 2],
    askew: f64,
    /// The normal: along that direction, across it, and along the axis.
    normal: [f64; 3],
    jump: i8,
}

/// The length of a vector of coordinates, which are far from overflow: `hypot` takes ten times as long.
fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

/// The parameters between which a number with this value at 0 and this slope goes from one bound to the other. The slope is not 0.
fn between(start: f64, growth: f64, [low, high]: [f64; 2]) -> [f64; 2] {
    let [a, b] = [low, high].map(|end| (end - start) / growth);
    [a.min(b), a.max(b)]
}

/// The range of the cosine between two angles.
fn cosines([low, high]: [f64; 2]) -> [f64; 2] {
    let passes = |angle: f64| ((high - angle) / TAU).floor() >= ((low - angle) / TAU).ceil();
    let [a, b] = [low.cos(), high.cos()];
    [
        if passes(PI) { -1.0 } else { a.min(b) },
        if passes(0.0) { 1.0 } else { a.max(b) },
    ]
}

/// The products of two ranges.
fn products(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let all = [a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]];
    all.into_iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], c| {
            [low.min(c), high.max(c)]
        })
}

impl<S: Fn(f64) -> Source> Orbit<'_, '_, S> {
    /// `None` if it is left to charts.
    fn piece(&mut self, piece: &Piece) -> Option<()> {
        match piece.shape {
            // `g` has one sign on all of it, at all times.
            Shape::Line { normal: [0.0, _] } => Some(()),
            Shape::Line { normal } => self.cone(piece, normal),
            Shape::Arc { .. } => self.tube(piece),
        }
    }

    /// Whether the rise bends a surface by so little: by `ρ`, or `r`, times the square of its slope.
    fn is_straight(&self, radius: f64, slope: f64) -> bool {
        radius * slope * slope <= BENT * self.height_tolerance
    }

    /// The parts of the arc, with the ranges of `x` and `y` of directions from its axis to the tip.
    fn parts(&self) -> Vec<(Sector, [[f64; 2]; 2])> {
        let [x, y] = self.arc.from;
        let (start, angle, count) = (y.atan2(x), self.arc.angle, self.sectors);
        let part = |n: usize| {
            let shares = [n, n + 1].map(|n| n as f64 / count as f64);
            let [a, b] = shares.map(|share| start + share * angle);
            let range = [a.min(b), a.max(b)];
            let directions = [cosines(range), cosines(range.map(|angle| angle - FRAC_PI_2))];
            let open = [
                if n == 0 { f64::NEG_INFINITY } else { shares[0] },
                if n + 1 == count { f64::INFINITY } else { shares[1] },
            ];
            (Sector { shares: open }, directions)
        };
        (0..count).map(part).collect()
    }

    /// Visits the lines that pass through a box about the arc's axis.
    fn each(&mut self, [x, y, z]: [[f64; 2]; 3], mut visit: impl FnMut(&mut Self, &View)) {
        let (arc, steep) = (self.arc, self.along.z == 1.0);
        let [s, k] = arc.tilt;
        let margin = 2.0 * self.coarse;
        // Horizontally, along the axis.
        let back = products([k; 2], x);
        let ahead = [s * z[0] - back[1] - margin, s * z[1] - back[0] + margin];
        let [ux, uy] = arc.ahead;
        let floor = Floor {
            tip: arc.centre,
            ahead: arc.ahead,
            rounding: self.slack,
        };
        let lattice = self.lines.lines;
        let right = [-y[1] - margin, margin - y[0]];
        rows(lattice, &floor, [right, ahead], |Row { i, j, x }| {
            for j in j[0]..=j[1] {
                let y = lattice.coordinate(1, j) - arc.centre[1];
                let (q, level) = (ux * x + uy * y, uy * x - ux * y);
                if q < ahead[0] || q > ahead[1] || !lattice.asks(i, j) {
                    continue;
                }
                let (x, z, up) = if steep {
                    (-q / k, 0.0, -s * q / k)
                } else {
                    (0.0, q / s, k * q / s)
                };
                let view = View {
                    place: (i, j),
                    y: level,
                    x,
                    z,
                    height: arc.centre[2] + up,
                };
                visit(self, &view);
            }
        });
    }

    fn open(&mut self, view: &View) {
        let (i, j) = view.place;
        self.lines.open(self.lines.lines.line(i, j));
    }

    /// Where a direction is on the arc; its angle is known up to an error.
    fn place(&self, [x, y]: [f64; 2], error: f64) -> ArcPlace {
        let ([fx, fy], side, angle) = (self.arc.from, self.arc.side(), self.arc.angle.abs());
        let turn = [x * fx + y * fy, side * (y * fx - x * fy)];
        ArcPlace::share(turn, angle, (error + ROUNDING) * length(x, y))
    }

    /// The zero of a function of a line's parameter and of the lift, from a guess, with its slope there, the last step, and
    /// the lift; the tip is in the direction `tip` of the arc's axis.
    fn zero(
        &self,
        (mut w, y): (f64, f64),
        tip: impl Fn(f64) -> [f64; 2],
        value: &impl Fn(f64, f64) -> [f64; 2],
    ) -> (f64, [f64; 3]) {
        let (mut slope, mut step) = (0.0, f64::INFINITY);
        let mut lift = self.lift(tip(w));
        for _ in 0..4 {
            let [f, d] = value(w, lift);
            (slope, step) = (d, f / d);
            w -= step;
            if step.abs() <= 0.1 * self.slack {
                break;
            }
            if (self.along.x * step).abs() > STILL * y.abs() {
                lift = self.lift(tip(w));
            }
        }
        (w, [slope, step, lift])
    }

    /// How far the tool has risen where the tip is in a direction.
    fn lift(&self, [x, y]: [f64; 2]) -> f64 {
        let ([fx, fy], side) = (self.arc.from, self.arc.side());
        let (cosine, sine) = (x * fx + y * fy, side * (y * fx - x * fy));
        self.rise * (sine.atan2(cosine) / self.arc.angle.abs()).clamp(0.0, 1.0)
    }

    /// A crossing, if the tip comes there in this part of the arc.
    fn settle(&mut self, view: &View, sector: Sector, point: &EnvelopePoint) -> Result<(), Open> {
        let share = match self.place(point.tip, point.askew) {
            ArcPlace::Outside => return Ok(()),
            ArcPlace::Near => return Err(Open),
            ArcPlace::Inside(share) => share,
        };
        if share < sector.shares[0] || share >= sector.shares[1] {
            return Ok(());
        }
        // NaN is in doubt.
        if !(point.error * self.along.height.abs() <= 0.5 * self.height_tolerance) {
            return Err(Open);
        }
        let far = length(point.tip[0], point.tip[1]);
        let [x, y] = point.tip.map(|c| c / far);
        let [radial, level, along] = point.normal;
        let [up, right, axis] = self.arc.axes();
        let normal: Vector3<f64> = up * (x * radial - y * level) + right * (y * radial + x * level) + axis * along;
        let (i, j) = view.place;
        let line = self.lines.lines.line(i, j);
        let height = view.height + point.w * self.along.height;
        self.lines
            .crossing(line, height, point.jump, unit(normal), (self.source)(share));
        Ok(())
    }
}
