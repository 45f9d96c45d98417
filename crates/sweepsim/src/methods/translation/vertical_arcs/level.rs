//! Arcs across the dexels of a tool whose axis lies in the arc's plane: as dexels along y see an arc of `G18` of a tool that stands along z.
//!
//! In this plane, `q` is the coordinate across the axis and `p` the one along it, from the arc's centre; the tip is at `r (cos θ, sin θ)`. A line is a point `(q, p)` there, seen from the tip at
//! `x = q − r cos θ` and at the height `ζ = p − r sin θ`. The tool covers it as far as `y² = ρ² − x²` on both sides of the plane, and where `y` is extreme in time, there is the envelope: the jump is the
//! sign of the second derivative of the height.

use super::crosswise::Crossing;
use super::quarter::Quarter;
use super::roots::{Open, Root, Search};
use super::{ArcPlace, Directions, Rolling};
use crate::cutter::outline::{Ball, Piece, Rim, Shape};
use sweepsim_dexel::Source;

/// A vanishing distance is beyond doubt from so many times its error on.
const CERTAIN: f64 = 64.0;
/// Ends are this many rounding errors wide.
const END: f64 = 8.0;

/// The face of a tool over a line at one time.
struct Face {
    /// Half of what the tool covers.
    half: f64,
    /// The outward normal across the axis, along it, and along the dexels on the upper side.
    normal: [f64; 3],
    /// The jump on the upper side.
    jump: i8,
}

impl<S: Fn(f64) -> Source> Rolling<'_, '_, S> {
    /// Whether a piece is settled.
    pub(super) fn level(&mut self, piece: &Piece) -> bool {
        if let Some(part) = piece.ball() {
            self.level_ball(&part);
            return true;
        }
        match piece.shape {
            // It is seen edge-on.
            Shape::Line { normal: [0.0, _] } => true,
            Shape::Line { normal: [out, 0.0] } => {
                let (from, to) = (piece.from[1], piece.to[1]);
                self.level_wall(piece.from[0], [from.min(to), from.max(to)], out);
                true
            }
            _ => {
                let quarters = Quarter::all(piece, self.slack);
                for quarter in quarters.iter().flatten() {
                    self.level_quarter(quarter);
                }
                quarters.is_some()
            }
        }
    }

    /// The lines over what is swept by a part of the tool of this radius and between these heights.
    fn each_level(
        &mut self,
        radius: f64,
        [low, high]: [f64; 2],
        mut visit: impl FnMut(&mut Self, usize, [f64; 2]) -> Result<(), Open>,
    ) {
        let r = self.arc.radius;
        let [q, p] = self.directions.map(|range| range.map(|c| r * c));
        let ranges = [[p[0] + low, p[1] + high], [q[0] - radius, q[1] + radius]];
        self.each(self.arc.centre, ranges, |own, (i, j), place| {
            let (mark, line) = (own.lines.mark(), own.lines.lines.line(i, j));
            if visit(own, line, place).is_err() {
                own.lines.forget(mark);
                own.lines.open(line);
            }
        });
    }

    /// Both crossings of a line.
    fn faces(&mut self, line: usize, face: &Face, share: f64) {
        let Face { half, normal, jump } = *face;
        let [across, along, up] = normal;
        for side in [1.0, -1.0] {
            let z = self.arc.centre[2] + side * half;
            let normal = self.in_space([across, along, side * up]);
            let source = (self.source)(share);
            let jump = if side > 0.0 { jump } else { -jump };
            self.lines.crossing(line, z, jump, normal, source);
        }
    }

    /// The half of what covers a line, if that is certain. `None` beside the tool.
    fn half(&self, square: f64, doubt: f64) -> Result<Option<f64>, Open> {
        if square < -doubt {
            Ok(None)
        } else if square > CERTAIN * doubt {
            Ok(Some(square.sqrt()))
        } else {
            Err(Open)
        }
    }

    /// A ball is nearest to a line, or farthest from it, in the direction of the line from the arc of its own centre.
    fn level_ball(&mut self, ball: &Ball) {
        let big = ball.radius;
        let heights = [ball.centre - big, ball.centre + big];
        self.each_level(big, heights, |own, line, [q, p]| {
            let (r, slack, p) = (own.arc.radius, own.slack, p - ball.centre);
            let distance = (q * q + p * p).sqrt();
            let error = 4.0 * slack / distance;
            if !(error < 1e-3) {
                // The centre of the arc.
                return if r < big + 8.0 * slack { Err(Open) } else { Ok(()) };
            }
            for side in [1.0, -1.0] {
                let direction = [side * q / distance, side * p / distance];
                let share = match own.place(direction, error) {
                    ArcPlace::Outside => continue,
                    place => place,
                };
                let off = distance - side * r;
                let square = (big - off) * (big + off);
                let Some(half) = own.half(square, 8.0 * slack * (big + slack))? else {
                    continue;
                };
                let ArcPlace::Inside(share) = share else {
                    return Err(Open);
                };
                let normal = [direction[0] * side * off, direction[1] * side * off, half];
                let doubt = 4.0 * slack + r * error;
                let [low, high] = ball.ends;
                if normal[1] < low - doubt || normal[1] > high + doubt {
                    continue;
                }
                if !(normal[1] > low + doubt && normal[1] < high - doubt) {
                    return Err(Open);
                }
                let jump = if side > 0.0 { -1 } else { 1 };
                own.faces(line, &Face { half, normal, jump }, share);
            }
            Ok(())
        });
    }

    /// A cylinder between two heights, whose normal is `out` across the axis: where it is widest, and all of it where the tool moves along its axis.
    fn level_wall(&mut self, radius: f64, heights: [f64; 2], out: f64) {
        let [before, after] = self.rates.map(|rate| rate < 0.0);
        let turn = (before != after).then(|| self.turn([1.0, 0.0]));
        self.each_level(radius, heights, |own, line, [q, p]| {
            own.widest(line, [q, p], (radius, heights, out))?;
            let Some((top, share)) = turn else { return Ok(()) };
            let (r, slack) = (own.arc.radius, own.slack);
            let x = q - top * r;
            let doubt = END * slack * (radius + slack);
            let (near, wide) = ((radius - x) * (radius + x), END * slack);
            if near < -doubt || p < heights[0] - wide || p > heights[1] + wide {
                return Ok(());
            }
            let inside = p > heights[0] + wide && p < heights[1] - wide;
            let Some(half) = own.half(near, doubt)? else {
                return Ok(());
            };
            // Next to the axis, the sign of `g` is open.
            if !inside || !(x.abs() > wide) {
                return Err(Open);
            }
            // `g` has the sign of `x` times the rate.
            let jump = if (x > 0.0) == before { 1 } else { -1 };
            let normal = [out * x, 0.0, out * half];
            own.faces(line, &Face { half, normal, jump }, share);
            Ok(())
        });
    }

    /// Where a line is in the plane of the axis and the dexels.
    fn widest(
        &mut self,
        line: usize,
        [q, p]: [f64; 2],
        (radius, heights, out): (f64, [f64; 2], f64),
    ) -> Result<(), Open> {
        let (r, slack) = (self.arc.radius, self.slack);
        let (sine, error) = match self.directions_by(0, q / r, 4.0 * slack / r) {
            Directions::None | Directions::Level(false) => return Ok(()),
            Directions::Level(true) => return Err(Open),
            Directions::Pair(sine, error) => (sine, error),
        };
        for sine in [sine, -sine] {
            let place = self.place([q / r, sine], error);
            let (height, wide) = (p - r * sine, END * slack + 2.0 * q.abs() * error);
            let outside = height < heights[0] - wide || height > heights[1] + wide;
            if outside || matches!(place, ArcPlace::Outside) {
                continue;
            }
            let inside = height > heights[0] + wide && height < heights[1] - wide;
            match place {
                ArcPlace::Inside(share) if inside => {
                    let (half, normal, jump) = (radius, [0.0, 0.0, out], -1);
                    self.faces(line, &Face { half, normal, jump }, share);
                }
                _ => return Err(Open),
            }
        }
        Ok(())
    }

    /// The lines that a sharp edge passes.
    pub(super) fn level_edge(&mut self, rim: &Rim) {
        let (place, big) = (rim.height, rim.radius);
        self.each_level(big, [place; 2], |own, line, [q, p]| {
            let (r, slack) = (own.arc.radius, own.slack);
            let sine = (p - place) / r;
            let (cosine, error) = match own.directions_by(1, sine, 4.0 * slack / r) {
                Directions::None | Directions::Level(false) => return Ok(()),
                Directions::Level(true) => return Err(Open),
                Directions::Pair(cosine, error) => (cosine, error),
            };
            for cosine in [cosine, -cosine] {
                let place = own.place([cosine, sine], error);
                let (x, off) = (q - r * cosine, 2.0 * slack + r * error);
                if matches!(place, ArcPlace::Outside) {
                    continue;
                }
                let square = (big - x) * (big + x);
                let Some(half) = own.half(square, 4.0 * off * (big + off))? else {
                    continue;
                };
                let ArcPlace::Inside(share) = place else {
                    return Err(Open);
                };
                // The direction of the motion, on the edge outwards and along the axis.
                let turn = own.arc.side();
                let (across, along) = (-turn * sine * x / big, turn * cosine);
                let doubt = 2.0 * (off / big + error) + 16.0 * f64::EPSILON;
                let Some(([radial, axial], first)) = rim.envelope([across, along], doubt).ok_or(Open)? else {
                    continue;
                };
                let jump = if first == (along > 0.0) { -1 } else { 1 };
                let normal = [radial * x / big, axial, radial * half / big];
                own.faces(line, &Face { half, normal, jump }, share);
            }
            Ok(())
        });
    }

    /// The lines that a cone or a torus passes.
    fn level_quarter(&mut self, quarter: &Quarter) {
        let [a, b] = quarter.ends.map(|end| quarter.climb * end);
        let spans = self.quadrants();
        self.each_level(quarter.sheet.radii[1], [a.min(b), a.max(b)], |own, line, place| {
            let slack = own.slack.max(quarter.rounding());
            for span in &spans {
                let crossing = Crossing::new(quarter, (own.arc.radius, slack), place, span.quadrant);
                let Some([from, to]) = crossing.angles_between_ends(span.angles) else {
                    continue;
                };
                let search = Search {
                    curve: crossing,
                    y: 0.0,
                    mirror: 1.0,
                };
                let all = [f64::NEG_INFINITY, f64::INFINITY];
                search.roots([from, to], all, |root| own.extreme(line, &search.curve, root))?;
            }
            Ok(())
        });
    }

    /// Where what is covered over a line is extreme.
    fn extreme(
        &mut self,
        line: usize,
        crossing: &Crossing,
        root: Root<super::crosswise::CrosswisePoint>,
    ) -> Result<(), Open> {
        let Root { at, error, grows } = root;
        let share = match self.place([at.c, at.s], error) {
            ArcPlace::Outside => return Ok(()),
            place => place,
        };
        let (square, doubt) = crossing.square(&at);
        let Some(half) = self.half(square, doubt)? else {
            return Ok(());
        };
        let ArcPlace::Inside(share) = share else {
            return Err(Open);
        };
        let normal = crossing.normal(&at, half);
        let jump = if grows { 1 } else { -1 };
        self.faces(line, &Face { half, normal, jump }, share);
        Ok(())
    }
}
