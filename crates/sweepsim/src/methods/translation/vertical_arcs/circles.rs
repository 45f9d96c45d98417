//! What has a circle in the section of a line by a plane along the arc: balls, and all of a tool whose axis is
//! perpendicular to the arc's plane. It sweeps two circles about the arc's centre.

use super::{Chord, END, Rolling};
use crate::algebra::certain::certainly_within;
use crate::cutter::outline::{Ball, Piece};
use crate::methods::sheets::Undecided::{self, Close};
use crate::methods::sheets::intervals::{Range, hull, mul, scaled, wider};
use crate::methods::translation::quarter::Quarter;
use sweepsim_dexel::Source;

impl<S: Fn(f64) -> Source> Rolling<'_, '_, S> {
    /// Where a line meets the circle of radius `s`, which is off by `off` at most: both directions, with the error of
    /// the angle.
    #[inline]
    fn circle(
        &mut self,
        q: f64,
        (s, off): (f64, f64),
        mut visit: impl FnMut(&mut Self, [f64; 2], f64) -> Result<(), Undecided>,
    ) -> Result<(), Undecided> {
        if !(s.abs() > 16.0 * off) {
            // About a point.
            return if q.abs() <= s.abs() + 32.0 * off {
                Err(Close)
            } else {
                Ok(())
            };
        }
        let cosine = q / s;
        let error = (2.0 * self.slack + cosine.abs() * off) / s.abs();
        if let Some((sine, error)) = self.other(0, cosine, error)? {
            for sine in [sine, -sine] {
                visit(self, [cosine, sine], error)?;
            }
        }
        Ok(())
    }

    /// A ball, of a tool in any orientation.
    pub(super) fn ball(&mut self, ball: &Ball) {
        let (arc, slack) = (self.arc, self.slack);
        let ([aq, ap, az], [ux, uy]) = (self.axis, arc.ahead);
        let (q, p) = (ball.centre * aq, ball.centre * ap);
        let [x, y, z] = arc.centre;
        // Where the ball's centre is when the tip is at that of the arc.
        let middle = [x + ux * q - uy * p, y + uy * q + ux * p, z + ball.centre * az];
        let (r, big) = (arc.radius, ball.radius);
        let [cosines, sines] = self.directions;
        for side in [1.0, -1.0] {
            // Of an upright tool, `ν sin α` is the height: it may be on the other half all the time.
            if aq == 0.0 && ap == 0.0 {
                let along = mul(scaled(side * az, sines), [0.0, big]);
                let ends = wider(ball.ends, 8.0 * slack);
                if along[1] < ends[0] || along[0] > ends[1] {
                    continue;
                }
            }
            let radii = if side > 0.0 { [r, r + big] } else { [r - big, r] };
            self.each(middle, [[-big, big], mul(radii, cosines)], |own, line, [q, p]| {
                let Some(Chord { half, off, certain }) = own.chord(big, p, slack) else {
                    return Ok(());
                };
                let (nu, s) = (side * half, r + side * half);
                own.circle(q, (s, off), |own, [c, sine], error| {
                    let normal = [nu * c, p, nu * sine];
                    let along = normal[0] * aq + normal[1] * ap + normal[2] * az;
                    let inside = certainly_within(along, ball.ends, off + half * error + 2.0 * slack);
                    if inside == Some(false) {
                        return Ok(());
                    }
                    let Some(share) = own.share([c, sine], error)? else {
                        return Ok(());
                    };
                    if inside.is_none() || !certain {
                        return Err(Close);
                    }
                    let jump = if (normal[2] > 0.0) == (s > 0.0) { -1 } else { 1 };
                    own.crossing(line, middle[2] + s * sine, jump, normal, share);
                    Ok(())
                })
            });
        }
    }

    /// A piece of a tool whose axis is perpendicular to the arc's plane: a line meets only the circle at its own height
    /// along the axis. `None` if there is no closed form.
    pub(super) fn slices(&mut self, piece: &Piece) -> Option<()> {
        for quarter in &Quarter::all(piece, self.slack, false)? {
            for side in [1.0, -1.0] {
                self.slice(quarter, side);
            }
        }
        Some(())
    }

    /// The outer or the inner circles that a quarter sweeps.
    fn slice(&mut self, quarter: &Quarter, side: f64) {
        let ([.., ap, _], arc, slack) = (self.axis, self.arc, self.slack);
        let [inner, outer] = quarter.radii.map(|rho| arc.radius + side * rho);
        let (heights, wide) = (quarter.heights(), END * slack);
        let swept = wider(mul(hull(inner, outer), self.directions[0]), wide);
        let ranges = [wider(scaled(ap, heights), wide), swept];
        self.each(arc.centre, ranges, |own, line, [q, p]| {
            let height = ap * p;
            let inside = certainly_within(height, heights, wide);
            let ring = match (inside, quarter.ring(height, slack)) {
                (Some(false), _) => return Ok(()),
                (Some(true), Some(ring)) => ring,
                _ if q >= swept[0] - wide && q <= swept[1] + wide => return Err(Close),
                _ => return Ok(()),
            };
            let off = 2.0 * slack * (2.0 + ring.rate);
            let s = arc.radius + side * ring.radius;
            // Next to the axis.
            if !(ring.radius > 16.0 * off) && q.abs() <= s.abs() + 32.0 * off {
                return Err(Close);
            }
            own.circle(q, (s, off), |own, [c, sine], error| {
                let Some(share) = own.share([c, sine], error)? else {
                    return Ok(());
                };
                let jump = if side * s * sine > 0.0 { -1 } else { 1 };
                let across = side * ring.normal[0];
                let normal = [across * c, ap * ring.normal[1], across * sine];
                own.crossing(line, arc.centre[2] + s * sine, jump, normal, share);
                Ok(())
            })
        });
    }

    /// Leaves the lines open that lie in a plane across the axis, which is perpendicular to the arc's plane: no other
    /// line meets a disc or a sharp edge there.
    pub(super) fn flat(&mut self, height: f64, reach: f64) {
        let wide = END * self.slack;
        let place = self.axis[1] * height;
        let ranges: [Range; 2] = [
            [place - wide, place + wide],
            wider(self.directions[0].map(|cosine| self.arc.radius * cosine), reach),
        ];
        self.each(self.arc.centre, ranges, |_, _, [q, p]| {
            let along = (p - place).abs() <= wide;
            if along && q >= ranges[1][0] - wide && q <= ranges[1][1] + wide {
                Err(Close)
            } else {
                Ok(())
            }
        });
    }
}
