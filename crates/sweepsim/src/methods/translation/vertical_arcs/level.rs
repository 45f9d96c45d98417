//! Arcs across the dexels of a tool whose axis lies in the arc's plane: as dexels along y see an arc of `G18` of a tool
//! that stands along z.
//!
//! In this plane, `q` is the coordinate across the axis and `p` the one along it, from the arc's centre; the tip is at
//! `r (cos θ, sin θ)`. A line is a point `(q, p)` there, seen from the tip at `x = q − r cos θ` and at the height `ζ =
//! p − r sin θ`. The tool covers it as far as `y² = ρ² − x²` on both sides of the plane, and where `y` is extreme in
//! time, there is the envelope: the jump is the sign of the second derivative of the height.

use super::crosswise::{Crossing, CrosswisePoint};
use super::roots::{Root, Search};
use super::{CERTAIN, Chord, END, Rolling};
use crate::algebra::certain::certainly_within;
use crate::cutter::outline::Ball;
use crate::methods::sheets::Undecided::{self, Close};
use crate::methods::sheets::intervals::{Range, scaled};
use crate::methods::translation::quarter::Quarter;
use sweepsim_dexel::Source;

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
    /// The lines over what is swept by a part of the tool of this radius and between these heights.
    pub(super) fn each_level(
        &mut self,
        radius: f64,
        [low, high]: Range,
        visit: impl FnMut(&mut Self, usize, [f64; 2]) -> Result<(), Undecided>,
    ) {
        let r = self.arc.radius;
        let [q, p] = self.directions.map(|range| range.map(|c| r * c));
        let ranges = [[p[0] + low, p[1] + high], [q[0] - radius, q[1] + radius]];
        self.each(self.arc.centre, ranges, visit);
    }

    /// Both crossings of a line.
    fn faces(&mut self, line: usize, face: &Face, share: f64) {
        let Face { half, normal, jump } = *face;
        let [across, along, up] = normal;
        for side in [1.0, -1.0] {
            let z = self.arc.centre[2] + side * half;
            let jump = if side > 0.0 { jump } else { -jump };
            self.crossing(line, z, jump, [across, along, side * up], share);
        }
    }

    /// A ball is nearest to a line, or farthest from it, in the direction of the line from the arc of its own centre.
    pub(super) fn level_ball(&mut self, ball: &Ball) {
        let (r, big, slack) = (self.arc.radius, ball.radius, self.slack);
        let heights = [ball.centre - big, ball.centre + big];
        self.each_level(big, heights, |own, line, [q, p]| {
            let p = p - ball.centre;
            let distance = (q * q + p * p).sqrt();
            let error = 4.0 * slack / distance;
            if !(error < 1e-3) {
                // The centre of the arc.
                return if r < big + 8.0 * slack { Err(Close) } else { Ok(()) };
            }
            for side in [1.0, -1.0] {
                let direction = [side * q / distance, side * p / distance];
                let off = distance - side * r;
                let Some(Chord { half, certain, .. }) = own.chord(big, off, slack) else {
                    continue;
                };
                let Some(share) = own.share(direction, error)? else {
                    continue;
                };
                if !certain {
                    return Err(Close);
                }
                let normal = [direction[0] * side * off, direction[1] * side * off, half];
                if certainly_within(normal[1], ball.ends, 4.0 * slack + r * error).ok_or(Close)? {
                    let jump = if side > 0.0 { -1 } else { 1 };
                    own.faces(line, &Face { half, normal, jump }, share);
                }
            }
            Ok(())
        });
    }

    /// A cylinder between two heights, whose normal is `out` across the axis: where it is widest, and all of it where
    /// the tool moves along its axis.
    pub(super) fn level_wall(&mut self, radius: f64, heights: Range, out: f64) {
        let [before, after] = self.rates.map(|rate| rate < 0.0);
        let turn = (before != after).then(|| self.turn([1.0, 0.0]));
        let (slack, wide) = (self.slack, END * self.slack);
        self.each_level(radius, heights, |own, line, [q, p]| {
            own.widest(line, [q, p], (radius, heights, out))?;
            let Some((top, share)) = turn else { return Ok(()) };
            let x = q - top * own.arc.radius;
            let inside = certainly_within(p, heights, wide);
            let Some(Chord { half, certain, .. }) = own.chord(radius, x, slack).filter(|_| inside != Some(false))
            else {
                return Ok(());
            };
            // Next to the axis, the sign of `g` is open.
            if inside.is_none() || !certain || !(x.abs() > wide) {
                return Err(Close);
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
        (half, heights, out): (f64, Range, f64),
    ) -> Result<(), Undecided> {
        let (r, slack) = (self.arc.radius, self.slack);
        let Some((sine, error)) = self.other(0, q / r, 4.0 * slack / r)? else {
            return Ok(());
        };
        for sine in [sine, -sine] {
            let inside = certainly_within(p - r * sine, heights, END * slack + 2.0 * q.abs() * error);
            if inside == Some(false) {
                continue;
            }
            if let Some(share) = self.share([q / r, sine], error)? {
                inside.ok_or(Close)?;
                let (normal, jump) = ([0.0, 0.0, out], -1);
                self.faces(line, &Face { half, normal, jump }, share);
            }
        }
        Ok(())
    }

    /// The lines that a cone or a torus passes.
    pub(super) fn level_quarter(&mut self, quarter: &Quarter) {
        let spans = self.quadrants();
        let slack = self.slack.max(quarter.rounding());
        let heights = scaled(quarter.climb, quarter.ends);
        self.each_level(quarter.radii[1], heights, |own, line, place| {
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
    fn extreme(&mut self, line: usize, crossing: &Crossing, root: Root<CrosswisePoint>) -> Result<(), Undecided> {
        let Root { at, error, grows } = root;
        let (square, doubt) = crossing.square(&at);
        if square < -doubt {
            return Ok(());
        }
        let Some(share) = self.share([at.c, at.s], error)? else {
            return Ok(());
        };
        if !(square > CERTAIN * doubt) {
            return Err(Close);
        }
        let half = square.sqrt();
        let normal = crossing.normal(&at, half);
        let jump = if grows { 1 } else { -1 };
        self.faces(line, &Face { half, normal, jump }, share);
        Ok(())
    }
}
