//! A tool whose axis lies in the arc's plane and across the dexels, along an arc that dives along the dexels: as dexels along x see an arc of `G18` of a tool that stands along z.
//!
//! The section of a line has two halves, at `± v` along the dexels from the axis, mirror images of each other. At the height `ζ` along the axis, `v² = ρ² − p²`.

use super::quarter::{Lengthwise, Quarter};
use super::roots::{Open, Root, Search};
use super::sheet::{Parallel, SheetPoint};
use super::{ArcPlace, Directions, ROUNDING, Rolling};
use crate::cutter::outline::{Piece, Rim, Shape};
use sweepsim_dexel::Source;

impl<S: Fn(f64) -> Source> Rolling<'_, '_, S> {
    /// Whether a piece is settled.
    pub(super) fn lengthwise(&mut self, piece: &Piece) -> bool {
        match piece.shape {
            // It is seen edge-on.
            Shape::Line { normal: [0.0, _] } => true,
            Shape::Line { normal: [out, 0.0] } => {
                self.wall(piece.from[0], [piece.from[1], piece.to[1]], out);
                true
            }
            _ => {
                let quarters = Quarter::all(piece, self.slack);
                for quarter in quarters.iter().flatten() {
                    self.quarter(quarter);
                }
                quarters.is_some()
            }
        }
    }

    /// `±ζ` of two places along the axis, ascending.
    fn along(&self, heights: [f64; 2]) -> [f64; 2] {
        let [aq, ..] = self.axis;
        let [a, b] = heights.map(|height| aq * height);
        [a.min(b), a.max(b)]
    }

    /// A cylinder, whose normal is `out` across the axis: all of it where the tool moves along its axis.
    fn wall(&mut self, radius: f64, heights: [f64; 2], out: f64) {
        let [[before, after], [opposite_before, opposite_after]] =
            [out, -out].map(|up| self.rates.map(|rate| up * rate < 0.0));
        let changes = [
            i8::from(after) - i8::from(before),
            i8::from(opposite_after) - i8::from(opposite_before),
        ];
        if changes == [0; 2] {
            return;
        }
        let (top, share) = self.turn([0.0, 1.0]);
        let source = (self.source)(share);
        let [low, high] = self.along(heights);
        let wide = 8.0 * self.slack;
        let doubt = 8.0 * self.slack * (radius + self.slack);
        let level = self.arc.centre[2] + top * self.arc.radius;
        let ranges = [[-radius, radius], [low - wide, high + wide]];
        self.each(self.arc.centre, ranges, |own, (i, j), [q, p]| {
            let (line, half_chord_sq) = (own.lines.lines.line(i, j), (radius - p) * (radius + p));
            if half_chord_sq < -doubt || q < low - wide || q > high + wide {
                return;
            }
            if !(half_chord_sq > 64.0 * doubt) || q < low + wide || q > high - wide {
                own.lines.open(line);
                return;
            }
            let half = half_chord_sq.sqrt();
            for (change, side) in changes.into_iter().zip([1.0, -1.0]) {
                if change != 0 {
                    let normal = own.in_space([0.0, out * p / radius, out * side * half / radius]);
                    let jump = if out * side > 0.0 { -change } else { change };
                    own.lines.crossing(line, level + side * half, jump, normal, source);
                }
            }
        });
    }

    /// The lines that a sharp edge passes.
    pub(super) fn edge_lengthwise(&mut self, rim: &Rim) {
        let (r, big) = (self.arc.radius, rim.radius);
        let place = self.axis[0] * rim.height;
        let [low, high] = self.directions[0].map(|cosine| place + r * cosine);
        self.each(self.arc.centre, [[-big, big], [low, high]], |own, (i, j), [q, p]| {
            let mark = own.lines.mark();
            if own.passes(rim, (i, j), [q - place, p]).is_err() {
                own.lines.forget(mark);
                own.lines.open(own.lines.lines.line(i, j));
            }
        });
    }

    #[inline]
    fn passes(&mut self, rim: &Rim, (i, j): (usize, usize), [q, p]: [f64; 2]) -> Result<(), Open> {
        let (slack, r, big, [aq, ..]) = (self.slack, self.arc.radius, rim.radius, self.axis);
        let half_chord_sq = (big - p) * (big + p);
        let doubt = 8.0 * slack * (big + slack);
        if half_chord_sq < -doubt {
            return Ok(());
        }
        let (sine, error) = match self.directions(q / r, 4.0 * slack / r) {
            Directions::None | Directions::Level(false) => return Ok(()),
            Directions::Level(true) => return Err(Open),
            Directions::Pair(sine, error) => (sine, error),
        };
        let line = self.lines.lines.line(i, j);
        let half = half_chord_sq.max(0.0).sqrt();
        let off = 2.0 * slack * (1.0 + p.abs() / half);
        for sine in [sine, -sine] {
            let share = match self.place([q / r, sine], error) {
                ArcPlace::Outside => continue,
                ArcPlace::Near => return Err(Open),
                ArcPlace::Inside(share) => share,
            };
            if !(half_chord_sq > 64.0 * doubt) {
                return Err(Open);
            }
            // The direction of the motion, on the edge along the axis and outwards.
            let turn = self.arc.side();
            let (along, up) = (-turn * sine * aq, turn * q / r);
            for arm in [half, -half] {
                let doubt = 2.0 * (off / big + error) + 16.0 * f64::EPSILON;
                let out = arm * up / big;
                let Some(([radial, axial], first)) = rim.envelope([out, along], doubt).ok_or(Open)? else {
                    continue;
                };
                let jump = if first == (along * arm > 0.0) { -1 } else { 1 };
                let normal = self.in_space([axial * aq, radial * p / big, radial * arm / big]);
                let source = (self.source)(share);
                let z = self.arc.centre[2] + r * sine + arm;
                self.lines.crossing(line, z, jump, normal, source);
            }
        }
        Ok(())
    }

    /// The lines that a cone or a torus passes.
    fn quarter(&mut self, quarter: &Quarter) {
        let (arc, outer) = (self.arc, quarter.sheet.radii[1]);
        let [low, high] = self.directions[0].map(|cosine| arc.radius * cosine);
        let [from, to] = self.along(quarter.ends.map(|end| quarter.climb * end));
        let ranges = [[-outer, outer], [from + low, to + high]];
        self.each(arc.centre, ranges, |own, (i, j), place| {
            let mark = own.lines.mark();
            for side in [1.0, -1.0] {
                if own.meets(quarter, side, (i, j), place).is_err() {
                    own.lines.forget(mark);
                    own.lines.open(own.lines.lines.line(i, j));
                    return;
                }
            }
        });
    }

    #[inline]
    fn meets(&mut self, quarter: &Quarter, side: f64, line: (usize, usize), [q, p]: [f64; 2]) -> Result<(), Open> {
        let r = self.arc.radius;
        let slack = self.slack.max(quarter.rounding());
        let mirror = quarter.climb * self.axis[0];
        // Of `side ν`, which is `mirror cos α`.
        let [a, b] = self.directions[0].map(|cosine| mirror * cosine);
        let normals = if side * quarter.side() > 0.0 {
            [-1.0, 0.0]
        } else {
            [0.0, 1.0]
        };
        let low = a.min(b).max(normals[0]);
        let high = a.max(b).min(normals[1]);
        if !(low <= high + ROUNDING) {
            return Ok(());
        }
        let Some(from) = quarter.from(p, slack) else {
            return Ok(());
        };
        let to = [quarter.ends[1]; 2];
        let (y, margin) = (mirror * q, 8.0 * slack + ROUNDING * r);
        let clip = [y - r * high - margin, y - r * low + margin];
        if clip[1] < from[0] || clip[0] > to[1] {
            return Ok(());
        }
        let parallel = Parallel {
            sheet: &quarter.sheet,
            p,
            r,
            side,
            slack,
        };
        let search = Search {
            curve: Lengthwise { quarter, parallel },
            y,
            mirror,
        };
        search.roots([from, to], clip, |root| self.both(&search, root, line))
    }

    /// What both halves of the section have at a solution.
    fn both(
        &mut self,
        search: &Search<Lengthwise>,
        root: Root<SheetPoint>,
        (i, j): (usize, usize),
    ) -> Result<(), Open> {
        let Search {
            curve: Lengthwise { quarter, parallel },
            y,
            mirror,
        } = search;
        let (r, sheet, [aq, ..]) = (parallel.r, parallel.sheet, self.axis);
        let Root { at, error, grows } = root;
        let cosine = mirror * parallel.side * at.nu;
        let off = (at.q - y).abs() + 2.0 * parallel.slack + error;
        let (sine, error) = match self.directions(cosine, off / r) {
            Directions::None | Directions::Level(false) => return Ok(()),
            Directions::Level(true) => return Err(Open),
            Directions::Pair(sine, error) => (parallel.side * quarter.side() * sine, error),
        };
        let axial = aq * sheet.out * sheet.up * at.square.sqrt();
        let radial = sheet.out * at.e / at.rho;
        for half in [1.0, -1.0] {
            let sine = half * sine;
            let share = match self.place([cosine, sine], error) {
                ArcPlace::Outside => continue,
                ArcPlace::Near => return Err(Open),
                ArcPlace::Inside(share) => share,
            };
            let v = half * at.v;
            let z = self.arc.centre[2] + r * sine + v;
            let jump = if (sine > 0.0) == grows { -1 } else { 1 };
            let normal = self.in_space([axial, radial * parallel.p, radial * v]);
            let source = (self.source)(share);
            self.lines
                .crossing(self.lines.lines.line(i, j), z, jump, normal, source);
        }
        Ok(())
    }
}
