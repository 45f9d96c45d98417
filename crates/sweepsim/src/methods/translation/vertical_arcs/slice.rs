//! A tool whose axis is perpendicular to the arc's plane, along a level arc that is seen from its side: a line meets only the circle of the tool at the line's own height along
//! the axis, which sweeps two circles about the arc's centre.

use super::{ArcPlace, Directions, Rolling};
use crate::cutter::outline::{Piece, Rim, Shape};
use crate::methods::translation::stretches::{Ring, Stretch};
use sweepsim_dexel::Source;

/// Ends of a piece are this many rounding errors wide.
const END: f64 = 8.0;

impl<S: Fn(f64) -> Source> Rolling<'_, '_, S> {
    /// Whether a piece is settled.
    pub(super) fn slices(&mut self, piece: &Piece) -> bool {
        if let Shape::Line { normal: [0.0, _] } = piece.shape {
            self.flat(piece.from[1], piece.from[0].max(piece.to[0]));
            return true;
        }
        let stretches = Stretch::all(piece);
        for stretch in stretches.iter().flatten() {
            for side in [1.0, -1.0] {
                self.slice(stretch, side);
            }
        }
        stretches.is_some()
    }

    /// No line meets a sharp edge, except in its plane.
    pub(super) fn edge_across(&mut self, rim: &Rim) {
        self.flat(rim.height, rim.radius);
    }

    /// Leaves the lines open that lie in a plane across the axis.
    fn flat(&mut self, height: f64, reach: f64) {
        let ([.., ap, _], arc, slack) = (self.axis, self.arc, self.slack);
        let [low, high] = self.directions[0].map(|cosine| arc.radius * cosine);
        let (place, wide) = (ap * height, END * slack);
        let ranges = [[place - wide, place + wide], [low - reach, high + reach]];
        self.each(arc.centre, ranges, |own, (i, j), [q, p]| {
            let along = (p - place).abs() <= wide;
            if along && q >= ranges[1][0] - wide && q <= ranges[1][1] + wide {
                own.lines.open(own.lines.lines.line(i, j));
            }
        });
    }

    /// The outer or the inner circles that a stretch sweeps.
    fn slice(&mut self, stretch: &Stretch, side: f64) {
        let ([.., ap, _], arc, slack) = (self.axis, self.arc, self.slack);
        let r = arc.radius;
        let radii = stretch.radii.map(|rho| r + side * rho);
        let corners = radii.map(|s| self.directions[0].map(|cosine| s * cosine));
        let all = corners.iter().flatten();
        let q = all.fold([f64::INFINITY, f64::NEG_INFINITY], |range, q| {
            [range[0].min(*q), range[1].max(*q)]
        });
        let ends = stretch.heights.map(|height| ap * height);
        let p = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        let wide = END * slack;
        let ranges = [p, q].map(|[low, high]| [low - wide, high + wide]);
        self.each(arc.centre, ranges, |own, (i, j), [q, p]| {
            let [low, high] = stretch.heights;
            let height = ap * p;
            if height < low - wide || height > high + wide {
                return;
            }
            let line = own.lines.lines.line(i, j);
            let inside = height > low + wide && height < high - wide;
            match stretch.at(height, slack) {
                Some(ring) if inside => own.ring(&ring, side, line, q),
                _ => {
                    let [least, most] = ranges[1];
                    if q >= least - wide && q <= most + wide {
                        own.lines.open(line);
                    }
                }
            }
        });
    }

    /// A line and the circle of radius `r + side ρ`.
    #[inline]
    fn ring(&mut self, ring: &Ring, side: f64, line: usize, q: f64) {
        let arc = self.arc;
        let off = 2.0 * self.slack * (2.0 + ring.rate);
        let s = arc.radius + side * ring.radius;
        if !(s.abs() > 16.0 * off) || !(ring.radius > 16.0 * off) {
            // About a point, or next to the axis.
            if q.abs() <= s.abs() + 32.0 * off {
                self.lines.open(line);
            }
            return;
        }
        let cosine = q / s;
        let error = (2.0 * self.slack + cosine.abs() * off) / s.abs();
        let (sine, error) = match self.directions(cosine, error) {
            Directions::None | Directions::Level(false) => return,
            Directions::Level(true) => {
                self.lines.open(line);
                return;
            }
            Directions::Pair(sine, error) => (sine, error),
        };
        for sine in [sine, -sine] {
            match self.place([cosine, sine], error) {
                ArcPlace::Outside => {}
                ArcPlace::Near => {
                    self.lines.open(line);
                    return;
                }
                ArcPlace::Inside(share) => {
                    let jump = if side * s * sine > 0.0 { -1 } else { 1 };
                    let across = side * ring.normal[0];
                    let normal = self.in_space([across * cosine, self.axis[1] * ring.normal[1], across * sine]);
                    let source = (self.source)(share);
                    self.lines
                        .crossing(line, arc.centre[2] + s * sine, jump, normal, source);
                }
            }
        }
    }
}
