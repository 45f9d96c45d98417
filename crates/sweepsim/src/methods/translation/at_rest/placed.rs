//! The tool at rest between two moves, standing along the dexels: over a line there is one point of each stretch of the meridian, at the line's
//! distance from the axis.

use super::super::curves::stands;
use super::ball_sign_changes::Lune;
use super::radial::{Hypot, Radial, Stretch, StretchPoint};
use crate::cutter::outline::{Outline, Piece, Shape};
use crate::methods::harvest::{Collector, unit};
use crate::methods::sheets::numbers;
use crate::time::path_parts::PathPart;
use sweepsim_dexel::{Crossing, Source};
use sweepsim_motion::SegmentEnd;

/// So much of the distance of lines is more than [`numbers`] may go beyond a range.
const FRACTION: f64 = 2e-3;

/// The motion on one side of a placement.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Neighbour {
    /// A move without rotation, along this vector.
    Along([f64; 3]),
    /// Beyond the end of the path; whether that counts as moving inwards.
    Beyond(bool),
}

impl Neighbour {
    /// An end of a move of a tool that does not turn, or that stands along the dexels: a turn about its own axis moves no point out of its surface.
    pub fn of(part: &PathPart, end: SegmentEnd) -> Option<Self> {
        if part.vertical_arc().is_some() {
            return Some(Self::Along(part.segment.velocity(end)[1]));
        }
        if !(part.segment.is_arc() && part.segment.turns().len() == 1 || stands(part)) {
            return None;
        }
        let travel = part.segment.travel();
        Some(Self::Along(match (part.level_arc(), end) {
            (None, _) => travel,
            (Some(level_arc), end) => {
                let [x, y] = level_arc.ahead(if end == SegmentEnd::Start { 0.0 } else { 1.0 });
                [x * level_arc.length(), y * level_arc.length(), travel[2]]
            }
        }))
    }
}

/// The placement at a joint of two moves, or at an end of the path.
pub(crate) fn placements(
    outline: &Outline,
    (tip, slack): ([f64; 3], f64),
    sides: [Neighbour; 2],
    (lines, highest): (&mut Collector, f64),
    source: Source,
    done: &mut [bool],
) {
    let mut placed = Placed {
        highest,
        tip,
        slack,
        sides,
        lines,
        source,
    };
    for piece in &outline.pieces {
        placed.piece(piece);
        done[piece.patches.clone()].fill(true);
    }
}

struct Placed<'a, 'b> {
    /// What is this high above the tip is above the ceiling.
    highest: f64,
    tip: [f64; 3],
    slack: f64,
    sides: [Neighbour; 2],
    lines: &'a mut Collector<'b>,
    source: Source,
}

/// A sign, if it is certain.
fn negative(g: f64, error: f64) -> Option<bool> {
    // NaN is uncertain.
    if g < -error {
        Some(true)
    } else if g > error {
        Some(false)
    } else {
        None
    }
}

impl Placed<'_, '_> {
    fn piece(&mut self, piece: &Piece) {
        if piece.heights()[0] > self.highest {
            return;
        }
        match piece.shape {
            Shape::Line { normal } => {
                let [from, to] = piece.below(self.highest);
                let ends = if from[0] <= to[0] { [from, to] } else { [to, from] };
                let slope = (ends[1][1] - ends[0][1]) / (ends[1][0] - ends[0][0]);
                let line = Radial::Line {
                    height: ends[0][1],
                    slope,
                    normal,
                };
                self.stretch(&line, [ends[0][0], ends[1][0]]);
            }
            Shape::Arc {
                centre, radius, out, ..
            } => {
                for [(from, _), (to, _)] in piece.quarters() {
                    let rho = [from, to].map(|angle| centre[0] + radius * angle.cos());
                    let arc = Radial::Arc {
                        centre,
                        radius,
                        half: (0.5 * (from + to)).sin().signum(),
                        out,
                    };
                    self.stretch(&arc, [rho[0].min(rho[1]), rho[0].max(rho[1])]);
                }
            }
        }
    }

    /// The signs that `g` has all over a stretch with constant normals, or normals along the axis; otherwise `None`.
    fn constant(&self, normal: [f64; 2]) -> [Option<bool>; 2] {
        self.sides.map(|side| match side {
            Neighbour::Beyond(negative) => Some(negative),
            Neighbour::Along([x, y, z]) => {
                let (up, out) = (normal[1] * z, (normal[0] * x.hypot(y)).abs());
                // With no part of it across the axis, the sign is that of a product.
                if out == 0.0 {
                    Some(up < 0.0)
                } else {
                    negative(up, out * (1.0 + 1e-9))
                }
            }
        })
    }

    fn stretch(&mut self, radial: &Radial, [inner, outer]: [f64; 2]) {
        let signs = match radial {
            Radial::Line { normal, .. } => self.constant(*normal),
            Radial::Arc { .. } => [None; 2],
        };
        if let [Some(before), Some(after)] = signs
            && before == after
        {
            return;
        }
        let (line_error, tx) = (2.0 * self.slack, self.tip[0]);
        let inner = if inner <= line_error { -1.0 } else { inner };
        let lattice = self.lines.lines;
        let [across, along] = lattice.grid.spacing();
        let lune = match radial {
            Radial::Arc {
                centre, radius, half, ..
            } if centre[0] == 0.0 => Some(Lune::new(*radius, *half, &self.sides, line_error, along)),
            _ => None,
        };
        let reach = outer + line_error;
        let Some([first, last]) = numbers(lattice, 0, [tx - reach, tx + reach]) else {
            return;
        };
        let stretch = Stretch::new(radial, [inner, outer], line_error, &self.sides);
        let level = self.level(radial, signs).filter(|_| inner < 0.0);
        for i in first..=last {
            let x = lattice.coordinate(0, i) - tx;
            let half = (reach * reach - x * x).max(0.0).sqrt() + line_error;
            // The hole in the middle.
            let free = inner - line_error;
            let gap = if free > x.abs() {
                (free * free - x * x).sqrt() - line_error
            } else {
                -1.0
            };
            let ranges = if gap > 0.0 {
                [[-half, -gap], [gap, half]]
            } else {
                [[-half, half], [f64::INFINITY, f64::NEG_INFINITY]]
            };
            let marks = match &lune {
                // Beside the edge of the hole, lines along it may be close to it.
                Some(_) if inner > 0.0 && (inner - x.abs()).abs() < across => None,
                Some(lune) => lune.marks(x).map(|marks| (lune, marks)),
                None => None,
            };
            let mut next = 0;
            if let Some(crossing) = level {
                let within = outer - 2.0 * line_error;
                let sure = (within * within - x * x).max(0.0).sqrt() - line_error;
                self.lines(&stretch, (i, x), [-half, -sure], &mut next);
                self.disc(i, sure, crossing, &mut next);
            }
            for range in ranges {
                let marked = marks
                    .as_ref()
                    .and_then(|(lune, marks)| Some((marks.places(), [lune.margin(range[0])?, lune.margin(range[1])?])));
                match marked {
                    None => self.lines(&stretch, (i, x), range, &mut next),
                    Some((places, margins)) => self.between(&stretch, (i, x), (range, margins), places, &mut next),
                }
            }
        }
    }

    /// What all lines well inside a level disc have, on which the signs of `g` differ before and after.
    fn level(&self, radial: &Radial, signs: [Option<bool>; 2]) -> Option<Crossing> {
        match (*radial, signs) {
            (
                Radial::Line {
                    height,
                    slope: 0.0,
                    normal: [0.0, up],
                },
                [Some(before), Some(_)],
            ) => Some(Crossing {
                z: self.tip[2] + height,
                jump: if (up > 0.0) == before { 1 } else { -1 },
                normal: unit(nalgebra::Vector3::new(0.0, 0.0, up)),
                source: self.source,
            }),
            _ => None,
        }
    }

    /// The lines of a column that are less than `half` from its middle, but for those before `next`: all have this crossing.
    fn disc(&mut self, i: usize, half: f64, crossing: Crossing, next: &mut usize) {
        let (lattice, ty) = (self.lines.lines, self.tip[1]);
        let half = half - FRACTION * lattice.grid.spacing()[1];
        let Some([low, high]) = numbers(lattice, 1, [ty - half, ty + half]) else {
            return;
        };
        let asked = (low.max(*next)..=high).filter(|j| lattice.asks(i, *j));
        let numbered = asked.map(|j| (lattice.line(i, j) as u32, crossing));
        self.lines.harvest.crossings.extend(numbered);
        *next = (*next).max(high + 1);
    }

    /// The lines of a column near its ends and some places, and between those of them where the signs of `g` differ.
    fn between(
        &mut self,
        stretch: &Stretch,
        (i, x): (usize, f64),
        ([low, high], margins): ([f64; 2], [f64; 2]),
        places: &[[f64; 2]],
        next: &mut usize,
    ) {
        if !(low < high) {
            return;
        }
        self.lines(stretch, (i, x), [low, low + margins[0]], next);
        let mut from = low;
        let end = [high, margins[1]];
        let inner = places.iter().filter(|[y, _]| *y > low && *y < high);
        for [y, off] in inner.chain([&end]).copied() {
            let middle = 0.5 * (from + y);
            let rho = x.hypot_fast(middle);
            let (certain, change) = self.change(&stretch.at(rho), [x, middle], rho, stretch.line_error);
            let begin = if certain && change == 0 { y - off } else { from };
            self.lines(stretch, (i, x), [begin, y + off], next);
            from = y;
        }
    }

    /// The lines of a column in a range, but for those before `next`.
    fn lines(&mut self, stretch: &Stretch, (i, x): (usize, f64), range: [f64; 2], next: &mut usize) {
        let [_, ty, tz] = self.tip;
        let lattice = self.lines.lines;
        let Stretch {
            inner,
            outer,
            line_error,
            ..
        } = *stretch;
        let Some([low, high]) = numbers(lattice, 1, range.map(|y| ty + y)) else {
            return;
        };
        for j in low.max(*next)..=high {
            let y = lattice.coordinate(1, j) - ty;
            let rho = x.hypot_fast(y);
            if rho < inner - line_error || rho > outer + line_error || stretch.same([x, y], rho) {
                continue;
            }
            let point = stretch.at(rho);
            let (certain, change) = self.change(&point, [x, y], rho, line_error);
            if certain && change == 0 {
                continue;
            }
            if !lattice.asks(i, j) {
                continue;
            }
            let line = lattice.line(i, j);
            if !certain || rho < inner + line_error || rho > outer - line_error {
                self.lines.open(line);
                continue;
            }
            let [n_rho, n_zeta] = point.normal;
            let jump = if n_zeta > 0.0 { -change } else { change };
            let normal = nalgebra::Vector3::new(n_rho * x / rho, n_rho * y / rho, n_zeta);
            self.lines
                .crossing(line, tz + point.height, jump, unit(normal), self.source);
        }
        *next = (*next).max(high + 1);
    }

    /// Whether the signs of `g` before and after are certain, and the difference `[g₊ < 0] − [g₋ < 0]`.
    #[inline]
    fn change(&self, point: &StretchPoint, [x, y]: [f64; 2], rho: f64, line_error: f64) -> (bool, i8) {
        let [n_rho, n_zeta] = point.normal;
        let ratio = if rho > 0.0 { n_rho / rho } else { 0.0 };
        let mut certain = true;
        let sign = |side: &Neighbour| match side {
            Neighbour::Beyond(negative) => (true, i8::from(*negative)),
            Neighbour::Along([dx, dy, dz]) => {
                let out = ratio * (x * dx + y * dy);
                let g = out + n_zeta * dz;
                // As the normal turns, its part across the axis changes with the other one: hardly where a wall is widest.
                let turned = point.bend * n_zeta.abs();
                let error = (dx.abs() + dy.abs()) * (line_error * (ratio.abs() + turned) + 8.0 * f64::EPSILON)
                    + dz.abs() * (line_error * point.bend + 8.0 * f64::EPSILON);
                let sure = n_rho == 0.0 || g.abs() > error;
                (sure, i8::from(g < 0.0))
            }
        };
        let [before, after] = [&self.sides[0], &self.sides[1]].map(sign);
        certain &= before.0 && after.0;
        (certain, after.1 - before.1)
    }
}
