//! Level arcs and helices: grazing curves and edges that turn about a centre.
//!
//! The tool stands along the dexels, so it may turn with the arc as one rigid body. In the frame that turns with it, the velocity is that of a translation
//! along the tangent, but for a turn about the tool's own axis, which moves none of its points out of its surface: the grazing curve is the one of the
//! [`Heading`] along the tangent. Seen from the centre, a point `(q, p)` of it (ahead of the tip, and to its left) lies at
//!
//! ```text
//! (R − σp, q),    s = (R − σp)² + q² = R² − 2 σ R p + ρ²
//! ```
//!
//! outwards and ahead, with `σ = 1` for arcs that turn left and `−1` for the others. The squared distance `s` takes the place of `p`, and the angle that of
//! `q`. On lines of the meridian, balls about the axis and edges, `ρ²` is a quadratic function of `p`, and the inverse of `s` a square root.

use super::curves::{Graph, Heading, Parabola, ring, slant, torus};
use super::rows::{Row, Sector};
use super::{Ceiling, Collector};
use crate::cutter::outline::{Outline, Piece, Rim, Shape};
use crate::methods::harvest::unit;
use crate::time::circles::Round;
use std::f64::consts::PI;
use sweepsim_dexel::Source;

/// A range of `s` narrower than this many margins is not searched: its lines are open.
const NARROW: f64 = 16.0;
/// An arc so small that rounding grows by more than this is left to the general method.
const MAGNIFIED: f64 = 1e4;
/// At an end of a curve, lines this close to the ends of the arc (in radians) may be on either side of it.
const BLUR: f64 = 1e-3;

/// A sweep of the grazing curves and edges of a tool along an arc. `source` gives the source at a time.
pub(crate) fn around(
    outline: &Outline,
    (heading, round): (&Heading, &Round),
    (lines, ceiling): (&mut Collector, Option<&Ceiling>),
    source: impl Fn(f64) -> Source,
    done: [&mut [bool]; 2],
) {
    let [patches, edges] = done;
    let mut bow = Bow {
        heading,
        round,
        highest: ceiling.map_or(f64::INFINITY, |ceiling| {
            let lowest = heading.tip[2].min(heading.tip[2] + heading.way[2]);
            ceiling.above(lowest, lines.lines.spacing())
        }),
        lines,
        source,
        side: round.side(),
    };
    for piece in &outline.pieces {
        if bow.piece(piece).is_some() {
            patches[piece.patches.clone()].fill(true);
        }
    }
    for rim in &outline.rims {
        if bow.rim(rim).is_some() {
            edges[rim.edges.clone()].fill(true);
        }
    }
}

/// The search along one arc.
struct Bow<'a, 'b, S> {
    heading: &'a Heading,
    round: &'a Round,
    lines: &'a mut Collector<'b>,
    source: S,
    /// What is this high above the tip is above the ceiling at all times.
    highest: f64,
    /// `σ`.
    side: f64,
}

/// A stretch of a graph over which `s` is monotone.
struct Bend {
    /// `p` where `s` is least, and where it is greatest.
    p: [f64; 2],
    s: [f64; 2],
    margins: [f64; 2],
    /// By which the jumps of the graph are multiplied.
    sense: i8,
}

/// What the sides of a line say of it.
enum Place {
    Outside,
    Near,
    /// With the cosine and the sine of the angle that the tool has turned by.
    Inside([f64; 2]),
}

impl<S: Fn(f64) -> Source> Bow<'_, '_, S> {
    /// `None` if there is no closed form.
    fn piece(&mut self, piece: &Piece) -> Option<()> {
        if piece.heights()[0] > self.highest {
            return Some(());
        }
        let heading = self.heading;
        let square = self.round.radius * self.round.radius;
        match piece.shape {
            Shape::Line { normal } => {
                let graphs = slant::slants(heading, piece.below(self.highest), normal)?;
                let cosine = heading.slope() * normal[1] / normal[0];
                let parabola = Parabola {
                    base: square,
                    bow: ((1.0 - cosine) * (1.0 + cosine)).recip(),
                    least: square * cosine * cosine,
                    radius: self.round.radius,
                };
                self.all(&graphs, parabola);
            }
            Shape::Arc {
                centre,
                radius,
                angles,
                out,
            } if centre[0] == 0.0 => {
                let poles = [piece.from[0] == 0.0, piece.to[0] == 0.0];
                let poles = if out > 0.0 { poles } else { [poles[1], poles[0]] };
                let graphs = ring::ball(heading, [centre[1], radius], angles, poles, out)?;
                let [sine, cosine] = [heading.along, heading.across].map(|v| v / heading.speed);
                let bow = cosine * cosine;
                let parabola = Parabola {
                    base: square + sine * sine * radius * radius,
                    bow,
                    least: sine * sine * (radius * radius - square / bow),
                    radius: self.round.radius,
                };
                self.all(&graphs, parabola);
            }
            Shape::Arc {
                centre,
                radius,
                angles,
                out,
            } => {
                let graphs = torus::stretches(heading, centre, radius, angles, out)?;
                let (radius, side) = (self.round.radius, self.side);
                let halves: Option<Vec<_>> = graphs.iter().map(|torus| torus.halves_about(radius, side)).collect();
                let halves = halves?;
                for (graph, halves) in graphs.iter().zip(halves) {
                    let ([low, high], margins) = (graph.span(), graph.margins());
                    if !(high - low > NARROW * (margins[0] + margins[1])) {
                        self.sliver(graph);
                        continue;
                    }
                    for range in halves.into_iter().flatten() {
                        let ends = range.map(|e| graph.across(e));
                        let bend = self.bend(graph, [ends[0].min(ends[1]), ends[0].max(ends[1])]);
                        self.sweep(graph, &bend, |s| {
                            let p = graph.invert_about(range, radius, side, s)?;
                            Some((p, 2.0 * s.sqrt() < radius))
                        });
                    }
                }
            }
        }
        Some(())
    }

    fn rim(&mut self, rim: &Rim) -> Option<()> {
        if rim.height > self.highest {
            return Some(());
        }
        // p is as accurate as (s − base) / 2R.
        let outer = self.round.radius + rim.radius;
        let growth = 1.0 + 5.0 * outer / self.round.radius;
        if !(growth < MAGNIFIED) {
            return None;
        }
        let heading = Heading {
            slack: self.heading.slack * growth,
            ..*self.heading
        };
        let graphs = ring::rim(&heading, rim)?;
        let parabola = Parabola {
            base: self.round.radius * self.round.radius + rim.radius * rim.radius,
            bow: 0.0,
            least: 0.0,
            radius: self.round.radius,
        };
        self.all(&graphs, parabola);
        Some(())
    }

    fn all<G: Graph>(&mut self, graphs: &[G], parabola: Parabola) {
        let side = self.side;
        let turn = parabola.turn().map(|p| side * p);
        for graph in graphs {
            let [low, high] = graph.span();
            let margins = graph.margins();
            if !(high - low > NARROW * (margins[0] + margins[1])) {
                self.sliver(graph);
                continue;
            }
            let spans = match turn {
                Some(turn) if turn > low && turn < high => [Some([low, turn]), Some([turn, high])],
                _ => [Some([low, high]), None],
            };
            for span in spans.into_iter().flatten() {
                let bend = self.bend(graph, span);
                let beyond = turn.is_some_and(|turn| side * (0.5 * (span[0] + span[1]) - turn) > 0.0);
                self.sweep(graph, &bend, |s| {
                    let (p, near) = parabola.invert(s, beyond);
                    Some((side * p, near))
                });
            }
        }
    }

    /// Leaves the lines open over what a span sweeps that is too narrow to be searched.
    fn sliver<G: Graph>(&mut self, graph: &G) {
        let slack = self.heading.slack;
        let ([low, high], own, [back, front]) = (graph.span(), graph.margins(), graph.reach());
        let radial = [low - own[0], high + own[1]].map(|p| self.round.radius - self.side * p);
        let radial = [radial[0].min(radial[1]), radial[0].max(radial[1])];
        let squares = |[a, b]: [f64; 2]| {
            let least = if a <= 0.0 && b >= 0.0 { 0.0 } else { (a * a).min(b * b) };
            [least, (a * a).max(b * b)]
        };
        let [a, b] = [squares(radial), squares([back, front])];
        let margin = 8.0 * slack * (radial[1].abs() + front.abs().max(back.abs()));
        let range = [a[0] + b[0] - margin, a[1] + b[1] + margin];
        let lattice = self.lines.lines;
        let sector = self.sector(radial, [back, front], range);
        let (round, lines) = (self.round, &mut *self.lines);
        sector.rows(lattice, slack, |Row { i, j, x }| {
            for j in j[0]..=j[1] {
                let y = lattice.coordinate(1, j) - round.centre[1];
                let s = x * x + y * y;
                if s >= range[0] && s <= range[1] && lattice.asks(i, j) {
                    lines.open(lattice.line(i, j));
                }
            }
        });
    }

    /// Where lines may lie whose points of the tool are in a rectangle, outwards and ahead of the centre, with `s` in a range.
    fn sector(&self, radial: [f64; 2], [back, front]: [f64; 2], s: [f64; 2]) -> Sector {
        let round = self.round;
        let corners = radial.map(|out| [back, front].map(|q| q.atan2(out)));
        let all = corners.iter().flatten();
        let range = all.fold([f64::INFINITY, f64::NEG_INFINITY], |r, a| [r[0].min(*a), r[1].max(*a)]);
        // Angles of a rectangle about the centre, or behind it, are in no interval.
        let behind = radial[0].min(radial[1]) <= 0.0 && back <= 0.0 && front >= 0.0;
        let start = round.from[1].atan2(round.from[0]);
        let angles = if behind {
            [0.0, 2.0 * PI]
        } else {
            let [a, b] = [range[0] - BLUR, range[1] + round.angle.abs() + BLUR].map(|angle| start + self.side * angle);
            [a.min(b), a.max(b)]
        };
        Sector {
            centre: round.centre,
            radii: s.map(|s| s.max(0.0).sqrt()),
            angles,
        }
    }

    /// `s` at a point of a graph.
    fn square(&self, q: f64, p: f64) -> f64 {
        let out = self.round.radius - self.side * p;
        out * out + q * q
    }

    /// A span over which `s` is known to be monotone.
    fn bend<G: Graph>(&self, graph: &G, span: [f64; 2]) -> Bend {
        let slack = self.heading.slack;
        let whole = graph.span();
        let own = graph.margins();
        let end = |k: usize| {
            let p = span[k];
            let q = graph.at(p).q;
            let s = self.square(q, p);
            // Where the graph ends, it may end elsewhere.
            let inner = span[k] + if k == 0 { 2.0 } else { -2.0 } * own[k];
            let shift = if p == whole[k] {
                2.0 * (s - self.square(graph.at(inner).q, inner)).abs()
            } else {
                0.0
            };
            // Where s turns, the distance from the centre is as accurate as coordinates are, also if it is almost 0.
            let off = if p == whole[k] {
                8.0 * slack * (self.round.radius + p.abs() + q.abs())
            } else {
                let near = 8.0 * slack * (1.0 + graph.at(p).slope.abs());
                near * (2.0 * s.sqrt() + near)
            };
            (p, s, shift + off)
        };
        let ends = [end(0), end(1)];
        let falls = ends[1].1 < ends[0].1;
        let [a, b] = if falls { [ends[1], ends[0]] } else { ends };
        // The left of the tool is inside for arcs that turn left.
        let sense = if falls == (self.side > 0.0) { 1 } else { -1 };
        Bend {
            p: [a.0, b.0],
            s: [a.1, b.1],
            margins: [a.2, b.2],
            sense,
        }
    }

    /// The lines over what a bend sweeps. `invert` gives `p` for a value of `s`, and whether it is as accurate as `√s`.
    fn sweep<G: Graph>(&mut self, graph: &G, bend: &Bend, invert: impl Fn(f64) -> Option<(f64, bool)>) {
        let [low, high] = bend.s;
        let margins = bend.margins;
        if !(high - low > NARROW * (margins[0] + margins[1])) {
            self.sliver(graph);
            return;
        }
        let wide = [low - margins[0], high + margins[1]];
        let sure = [low + margins[0], high - margins[1]];
        let (round, side, slack) = (self.round, self.side, self.heading.slack);
        let turn = round.angle.abs();
        let radial = bend.p.map(|p| round.radius - side * p);
        let sector = self.sector(radial, graph.reach(), wide);
        let lattice = self.lines.lines;
        sector.rows(lattice, slack, |Row { i, j, x }| {
            for j in j[0]..=j[1] {
                let y = lattice.coordinate(1, j) - round.centre[1];
                let s = x * x + y * y;
                if s < wide[0] || s > wide[1] || !lattice.asks(i, j) {
                    continue;
                }
                let doubtful = s < sure[0] || s > sure[1];
                let Some((p, near)) = invert(s.clamp(low, high)) else {
                    self.lines.open(lattice.line(i, j));
                    continue;
                };
                let p = p.clamp(bend.p[0].min(bend.p[1]), bend.p[0].max(bend.p[1]));
                let spot = graph.at(p);
                if spot.jump == 0 && spot.certain && !doubtful {
                    continue;
                }
                let out = round.radius - side * p;
                let error = if doubtful {
                    BLUR
                } else {
                    let far = round.radius + p.abs() + spot.q.abs();
                    let distance = s.sqrt();
                    // Of the point, and of s; then of p, and of the angle.
                    let (own, square) = if near {
                        let own = slack * (8.0 + 4.0 * spot.slope.abs());
                        (own, own * (distance + own))
                    } else {
                        (4.0 * slack, 4.0 * slack * (far + distance))
                    };
                    let off = square / (2.0 * (p - side * round.radius + spot.q * spot.slope)).abs();
                    own / distance + off * (out * spot.slope + side * spot.q).abs() / s
                };
                let place = self.place([x, y], [out, spot.q], s, error);
                let line = lattice.line(i, j);
                match place {
                    Place::Outside => {}
                    Place::Inside([c, n]) if spot.certain && !doubtful => {
                        let t = n.atan2(c) / turn;
                        let [fx, fy] = round.from;
                        // Outwards and ahead after the turn.
                        let outward = [c * fx - side * n * fy, c * fy + side * n * fx];
                        let ahead = [-side * outward[1], side * outward[0]];
                        let [nq, np, nz] = spot.normal;
                        let normal = [
                            nq * ahead[0] - side * np * outward[0],
                            nq * ahead[1] - side * np * outward[1],
                            nz,
                        ];
                        let z = self.heading.tip[2] + t * self.heading.way[2] + spot.z;
                        let normal = unit(normal.into());
                        let source = (self.source)(t);
                        self.lines.crossing(line, z, spot.jump * bend.sense, normal, source);
                    }
                    _ => self.lines.open(line),
                }
            }
        });
    }

    /// Where a line lies along the arc of a point that starts at `(out, ahead)` from the centre. `error`: of angles.
    fn place(&self, [x, y]: [f64; 2], [out, ahead]: [f64; 2], s: f64, error: f64) -> Place {
        let [fx, fy] = self.round.from;
        let own = [x * fx + y * fy, self.side * (y * fx - x * fy)];
        // The angle from the point to the line, as a complex number.
        let c = own[0] * out + own[1] * ahead;
        let n = own[1] * out - own[0] * ahead;
        let (end_sine, end_cosine) = self.round.angle.abs().sin_cos();
        let end = n * end_cosine - c * end_sine;
        let error = error * s;
        if n < -error || end > error {
            Place::Outside
        } else if n > error && end < -error {
            Place::Inside([c / s, n / s])
        } else {
            Place::Near
        }
    }
}
