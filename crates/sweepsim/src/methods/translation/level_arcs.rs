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

mod ends;

use super::arc_place::ArcPlace;
use super::curves::{Beside, Graph, Heading, Parabola, Turned, TurnedPoint, ring, slant, torus};
use super::rows::{Row, Sector};
use crate::cutter::outline::{Outline, Piece, Rim, Shape};
use crate::methods::harvest::{Collector, unit};
use crate::time::circles::LevelArc;
use ends::Bend;
use std::f64::consts::PI;
use sweepsim_dexel::Source;

/// A range of `s` narrower than this many margins is not searched: its lines are open.
const NARROW: f64 = 16.0;
/// An arc so small that rounding grows by more than this is left to the general method.
const MAGNIFIED: f64 = 1e4;
/// At an end of a curve, lines this close to the ends of the arc (in radians) may be on either side of it.
const BLUR: f64 = 1e-3;

/// A sweep of the grazing curves and edges of a tool along an arc. `source` gives the source at a time.
pub(crate) fn sweep_level_arc(
    outline: &Outline,
    (heading, arc): (&Heading, &LevelArc),
    (lines, highest): (&mut Collector, f64),
    source: impl Fn(f64) -> Source,
    done: [&mut [bool]; 2],
) {
    let mut search = LevelArcSearch {
        heading,
        arc,
        highest,
        lines,
        source,
        side: arc.side(),
        end: ArcPlace::<f64>::end(arc.angle),
    };
    outline.settle(&mut search, LevelArcSearch::piece, LevelArcSearch::rim, done);
}

/// The search along one arc.
struct LevelArcSearch<'a, 'b, S> {
    heading: &'a Heading,
    arc: &'a LevelArc,
    lines: &'a mut Collector<'b>,
    source: S,
    /// What is this high above the tip is above the ceiling at all times.
    highest: f64,
    /// `σ`.
    side: f64,
    /// The turn to the end of the arc.
    end: [f64; 2],
}

impl<S: Fn(f64) -> Source> LevelArcSearch<'_, '_, S> {
    /// `None` if there is no closed form.
    fn piece(&mut self, piece: &Piece) -> Option<()> {
        if piece.heights()[0] > self.highest {
            return Some(());
        }
        let heading = self.heading;
        let square = self.arc.radius * self.arc.radius;
        match piece.shape {
            Shape::Line { normal } => {
                let graphs = slant::slants(heading, piece.below(self.highest), normal)?;
                let cosine = heading.slope() * normal[1] / normal[0];
                let parabola = Parabola {
                    base: square,
                    bow: ((1.0 - cosine) * (1.0 + cosine)).recip(),
                    least: square * cosine * cosine,
                    radius: self.arc.radius,
                };
                self.all(&graphs, parabola, |_, _, _| None);
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
                    radius: self.arc.radius,
                };
                let beside = self.beside();
                self.all(&graphs, parabola, |ring, s, beyond| Some(ring.near(&beside, s, beyond)));
            }
            Shape::Arc {
                centre,
                radius,
                angles,
                out,
            } => {
                let graphs = torus::stretches(heading, centre, radius, angles, out)?;
                let beside = self.beside();
                let Beside { radius, side, .. } = beside;
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
                        let turn = |p: f64| graph.square_at(&beside, if p == ends[0] { range[0] } else { range[1] });
                        let bend = self.bend(graph, [ends[0].min(ends[1]), ends[0].max(ends[1])], turn);
                        self.sweep(graph, &bend, |search, s| {
                            let near = if search.is_near(s) {
                                graph.near(range, &beside, s)
                            } else {
                                None
                            };
                            near.or_else(|| {
                                let p = graph.invert_about(range, radius, side, s)?;
                                Some(search.seen(graph, &bend, s, (p, search.is_near(s))))
                            })
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
        let outer = self.arc.radius + rim.radius;
        let growth = 1.0 + 5.0 * outer / self.arc.radius;
        if !(growth < MAGNIFIED) {
            return None;
        }
        let heading = Heading {
            slack: self.heading.slack * growth,
            ..*self.heading
        };
        let graphs = ring::rim(&heading, rim)?;
        let parabola = Parabola {
            base: self.arc.radius * self.arc.radius + rim.radius * rim.radius,
            bow: 0.0,
            least: 0.0,
            radius: self.arc.radius,
        };
        let beside = self.beside();
        self.all(&graphs, parabola, |ring, s, beyond| Some(ring.near(&beside, s, beyond)));
        Some(())
    }

    fn beside(&self) -> Beside {
        Beside {
            radius: self.arc.radius,
            side: self.side,
            slack: self.heading.slack,
        }
    }

    /// `near` gives the point of a graph at `s` where that is [near](Self::is_near), if it has more digits than from `p`.
    fn all<G: Turned>(
        &mut self,
        graphs: &[G],
        parabola: Parabola,
        near: impl Fn(&G, f64, bool) -> Option<TurnedPoint>,
    ) {
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
                let bend = self.bend(graph, span, |_| parabola.least);
                let beyond = turn.is_some_and(|turn| side * (0.5 * (span[0] + span[1]) - turn) > 0.0);
                self.sweep(graph, &bend, |search, s| {
                    let seen = if search.is_near(s) {
                        near(graph, s, beyond)
                    } else {
                        None
                    };
                    seen.or_else(|| {
                        let (p, near) = parabola.invert(s, beyond);
                        Some(search.seen(graph, &bend, s, (side * p, near)))
                    })
                });
            }
        }
    }

    /// Leaves the lines open over what a span sweeps that is too narrow to be searched.
    fn sliver<G: Graph>(&mut self, graph: &G) {
        let slack = self.heading.slack;
        let ([low, high], own, [back, front]) = (graph.span(), graph.margins(), graph.reach());
        let radial = [low - own[0], high + own[1]].map(|p| self.arc.radius - self.side * p);
        let radial = [radial[0].min(radial[1]), radial[0].max(radial[1])];
        let squares = |[a, b]: [f64; 2]| {
            let least = if a <= 0.0 && b >= 0.0 { 0.0 } else { (a * a).min(b * b) };
            [least, (a * a).max(b * b)]
        };
        let [a, b] = [squares(radial), squares([back, front])];
        let margin = 8.0 * slack * (radial[1].abs() + front.abs().max(back.abs()));
        let range = [a[0] + b[0] - margin, a[1] + b[1] + margin];
        self.leave(self.sector(radial, [back, front], range), range);
    }

    /// Leaves the lines of a sector open, with `s` in a range.
    fn leave(&mut self, sector: Sector, range: [f64; 2]) {
        let lattice = self.lines.lines;
        let (arc, lines) = (self.arc, &mut *self.lines);
        sector.rows(lattice, self.heading.slack, |Row { i, j, x }| {
            for j in j[0]..=j[1] {
                let y = lattice.coordinate(1, j) - arc.centre[1];
                let s = x * x + y * y;
                if s >= range[0] && s <= range[1] && lattice.asks(i, j) {
                    lines.open(lattice.line(i, j));
                }
            }
        });
    }

    /// Where lines may lie whose points of the tool are in a rectangle, outwards and ahead of the centre, with `s` in a range.
    fn sector(&self, radial: [f64; 2], [back, front]: [f64; 2], s: [f64; 2]) -> Sector {
        let arc = self.arc;
        let corners = radial.map(|out| [back, front].map(|q| q.atan2(out)));
        let all = corners.iter().flatten();
        let range = all.fold([f64::INFINITY, f64::NEG_INFINITY], |r, a| [r[0].min(*a), r[1].max(*a)]);
        // Angles of a rectangle about the centre, or behind it, are in no interval.
        let off = NARROW * self.heading.slack;
        let behind = radial[0].min(radial[1]) <= off && back <= off && front >= -off;
        let start = arc.from[1].atan2(arc.from[0]);
        let angles = if behind {
            [0.0, 2.0 * PI]
        } else {
            let [a, b] = [range[0] - BLUR, range[1] + arc.angle.abs() + BLUR].map(|angle| start + self.side * angle);
            [a.min(b), a.max(b)]
        };
        Sector {
            centre: arc.centre,
            radii: s.map(|s| s.max(0.0).sqrt()),
            angles,
        }
    }

    /// The lines over what a bend sweeps. `find` gives the point at a value of `s`.
    fn sweep<G: Graph>(&mut self, graph: &G, bend: &Bend, find: impl Fn(&Self, f64) -> Option<TurnedPoint>) {
        let [low, high] = bend.s;
        let margins = bend.margins;
        let wide = [low - margins[0], high + margins[1]];
        let sure = [low + margins[0], high - margins[1]];
        let (arc, side, slack) = (self.arc, self.side, self.heading.slack);
        let turn = arc.angle.abs();
        let radial = bend.p.map(|p| arc.radius - side * p);
        if !(high - low > NARROW * (margins[0] + margins[1])) {
            // Next to the centre, angles are not certain.
            let (radial, reach) = if self.is_near(wide[1]) {
                ([-wide[1].sqrt(), wide[1].sqrt()], [-wide[1].sqrt(), wide[1].sqrt()])
            } else {
                (radial, graph.reach())
            };
            self.leave(self.sector(radial, reach, wide), wide);
            return;
        }
        let sector = self.sector(radial, graph.reach(), wide);
        let lattice = self.lines.lines;
        sector.rows(lattice, slack, |Row { i, j, x }| {
            for j in j[0]..=j[1] {
                let y = lattice.coordinate(1, j) - arc.centre[1];
                let s = x * x + y * y;
                if s < wide[0] || s > wide[1] || !lattice.asks(i, j) {
                    continue;
                }
                let doubtful = s < sure[0] || s > sure[1];
                let Some(TurnedPoint { out, point, error }) = find(self, s.clamp(low, high)) else {
                    self.lines.open(lattice.line(i, j));
                    continue;
                };
                if point.jump == 0 && point.certain && !doubtful {
                    continue;
                }
                let error = if doubtful {
                    // Along a curve that is tangent to a circle about the centre, angles change with the square root of the distance.
                    let margin = if s < sure[0] { margins[0] } else { margins[1] };
                    BLUR.max(2.0 * (margin / s).sqrt())
                } else {
                    error
                };
                let place = self.place([x, y], [out, point.q], s, error);
                let line = lattice.line(i, j);
                match place {
                    ArcPlace::Outside => {}
                    ArcPlace::Inside([c, n]) if point.certain && !doubtful => {
                        let t = n.atan2(c) / turn;
                        let [fx, fy] = arc.from;
                        // Outwards and ahead after the turn.
                        let outward = [c * fx - side * n * fy, c * fy + side * n * fx];
                        let ahead = [-side * outward[1], side * outward[0]];
                        let [nq, np, nz] = point.normal;
                        let normal = [
                            nq * ahead[0] - side * np * outward[0],
                            nq * ahead[1] - side * np * outward[1],
                            nz,
                        ];
                        let z = self.heading.tip[2] + t * self.heading.way[2] + point.z;
                        let normal = unit(normal.into());
                        let source = (self.source)(t);
                        self.lines.crossing(line, z, point.jump * bend.sense, normal, source);
                    }
                    _ => self.lines.open(line),
                }
            }
        });
    }
}
