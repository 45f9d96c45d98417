//! Where two compensated moves join: at inside corners where their offsets meet, and round outside corners.

use std::f64::consts::{PI, TAU};

use super::compensation::Compensation;
use super::corner::{Curve, Flat, cross, dot, inside_corner, length, minus, nearest_meeting, outside_corner, plus};
use super::stroke::{Bend, Corners, Item, Stroke, flat, set};
use crate::text::error::NcProblem;

/// The largest turn at which the tool goes to the meeting of the offsets: Siemens's usual machine data.
const LARGEST_MEETING: f64 = 100.0 / 180.0 * PI + 1e-9;

/// Moves that turn by less, in radians, are meant to be tangential: rounded numbers make their offsets miss each other.
const SMALL: f64 = 0.05;

impl Compensation {
    /// Joins the waiting move with the next one, whose offset starts in `start` along `t`, on `curve`; the corner is at `p`.
    pub(super) fn join(
        &mut self,
        p: Flat,
        start: Flat,
        t: Flat,
        curve: &Curve,
        stroke: &Stroke,
        out: &mut Vec<Item>,
    ) -> Result<(), NcProblem> {
        if self.entry {
            if self.side.round_ends {
                self.check_front(p, t, flat(self.plane, self.start))?;
            }
            return self.flush_to(start, false, out);
        }
        let toward = if self.side.left { 1.0 } else { -1.0 };
        // Positive at inside corners.
        let angle = (toward * cross(self.tangent, t)).atan2(dot(self.tangent, t));
        let small = self.side.tangent;
        if angle.abs() <= small {
            return self.flush(out);
        }
        // Where the contour turns back, the tool goes round its tip, unless the moves part from each other towards the tool's side: then it
        // is a wedge. Their curvatures decide.
        let curvature = match stroke.bend {
            Some(bend) => bend.sweep.signum() / length(minus(p, bend.centre)),
            None => 0.0,
        };
        let wedge = toward * (curvature + self.curvature) < -1e-12;
        let reversed = angle.abs() > PI - small;
        let goes_round = if reversed { !wedge } else { angle < 0.0 };
        if goes_round {
            let turn = if angle < 0.0 { -angle } else { TAU - angle };
            if self.side.corners == Corners::Meetings && turn <= LARGEST_MEETING {
                let end = flat(self.plane, self.current);
                match outside_corner(&self.curve, end, curve, start, p) {
                    Some(at) => return self.flush_to(at, true, out),
                    // On an arc.
                    None if turn < SMALL => {}
                    None => {
                        return Err(NcProblem::syntax(
                            "the offsets of both moves do not meet outside of this corner: expected G450",
                        ));
                    }
                }
            }
            self.flush(out)?;
            self.outside(p, start, t, turn, stroke, out);
            return Ok(());
        }
        let end = flat(self.plane, self.current);
        let is_small = angle < SMALL && length(minus(end, start)) < SMALL * self.side.radius;
        let shortened = inside_corner(&self.curve, end, curve, start, p);
        match shortened.or_else(|| nearest_meeting(&self.curve, curve, p).filter(|_| !is_small)) {
            Some(at) => self.flush_to(at, false, out),
            None if is_small => self.flush(out),
            None => Err(NcProblem::syntax(format!(
                "the tool of radius {} mm does not fit into this inside corner",
                self.side.radius
            ))),
        }
    }

    /// Goes round an outside corner.
    fn outside(&mut self, p: Flat, start: Flat, t: Flat, turn: f64, stroke: &Stroke, out: &mut Vec<Item>) {
        let radius = self.side.radius;
        let plane = self.plane;
        let mut go = |this: &mut Self, at: Flat, bend: Option<Bend>| {
            let mut end = this.current;
            set(plane, &mut end, at);
            this.current = end;
            out.push(Item::Stroke(Stroke {
                end,
                bend,
                plane,
                ..*stroke
            }));
        };
        if self.side.corners != Corners::Lines {
            let sweep = if self.side.left { -turn } else { turn };
            go(self, start, Some(Bend { centre: p, sweep }));
        } else if turn <= PI / 2.0 + 1e-9 {
            let reach = radius * (0.5 * turn).tan();
            let tip = plus(flat(plane, self.current), reach, self.tangent);
            go(self, tip, None);
            go(self, start, None);
        } else {
            let beyond = plus(flat(plane, self.current), radius, self.tangent);
            go(self, beyond, None);
            go(self, plus(start, -radius, t), None);
            go(self, start, None);
        }
        self.start = self.current;
    }
}
