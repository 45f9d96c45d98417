//! Arcs, rounded corners and chamfers.

use super::interpreter::Reader;
use super::line::{Line, Located};
use super::moves::Words;
use crate::drive::Arc;
use crate::gcode::CircularArc;
use crate::text::error::NcProblem;

/// A corner that the next line rounds or cuts off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Corner {
    /// The programmed corner, where the tool does not go.
    pub at: [f64; 3],
    /// The radius of RND, or the length of CHF; set by that block.
    pub size: Option<(f64, bool)>,
}

impl Reader<'_> {
    /// `RND R5`, `CHF 2`.
    pub(super) fn corner_block(&mut self, line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        let rounds = line.word(0) == "RND";
        let text = line.word(1).trim_start_matches('R').to_owned();
        let size = self.parameters.value(&text).map_err(whole)? * self.unit();
        if !(size > 0.0) {
            return Err(whole(NcProblem::value(
                if rounds {
                    "the radius of RND"
                } else {
                    "the length of CHF"
                },
                size,
                "positive",
            )));
        }
        match &mut self.corner {
            Some(corner) => {
                corner.size = Some((size, rounds));
                let next_is_line = self
                    .following()
                    .is_some_and(|next| next.word(0) == "L" || next.word(0) == "LP");
                if next_is_line {
                    return Ok(());
                }
                let problem = NcProblem::unsupported(
                    format!("{} before other than a line is", line.word(0)),
                    "expected it between two L",
                );
                Err(whole(problem))
            }
            None if self.uncertain => Ok(()),
            None => {
                let problem = NcProblem::unsupported(
                    format!("{} after other than a feed line is", line.word(0)),
                    "expected it between two L",
                );
                Err(whole(problem))
            }
        }
    }

    /// Goes around a corner; gives its end, where the next line starts.
    pub(super) fn turn_corner(
        &mut self,
        corner: Corner,
        target: [f64; 3],
        line: &Line,
    ) -> Result<Option<[f64; 3]>, Located> {
        let whole = |problem| (problem, line.all());
        let (Some(start), Some((size, rounds))) = (self.track.known(), corner.size) else {
            return Ok(self.track.known());
        };
        let [u, v, w] = self.plane;
        if start[w] != corner.at[w] || target[w] != corner.at[w] {
            return Err(whole(NcProblem::unsupported(
                "RND and CHF at corners out of the plane are",
                "expected both lines in the plane",
            )));
        }
        let back = [start[u] - corner.at[u], start[v] - corner.at[v]];
        let on = [target[u] - corner.at[u], target[v] - corner.at[v]];
        let (a, b) = (back[0].hypot(back[1]), on[0].hypot(on[1]));
        let (cross, dot) = (back[0] * on[1] - back[1] * on[0], back[0] * on[0] + back[1] * on[1]);
        if !(a > 0.0 && b > 0.0) || cross.abs() <= 1e-12 * a * b {
            // Straight on: there is no corner.
            let abc = self.track.abc;
            self.track.line(corner.at, abc, false).map_err(whole)?;
            return Ok(Some(corner.at));
        }
        // Half of the angle between both lines.
        let half = 0.5 * cross.abs().atan2(dot);
        let cut = if rounds { size / half.tan() } else { size };
        if cut > a * (1.0 + 1e-12) || cut > b * (1.0 + 1e-12) {
            return Err(whole(NcProblem::value(
                if rounds {
                    "the radius of RND"
                } else {
                    "the length of CHF"
                },
                size,
                format!("smaller: its corner takes {cut} mm of lines of {a} and {b} mm"),
            )));
        }
        let along = |way: [f64; 2], length: f64| {
            let mut point = corner.at;
            point[u] += way[0] * cut / length;
            point[v] += way[1] * cut / length;
            point
        };
        let (first, second) = (along(back, a), along(on, b));
        let abc = self.track.abc;
        self.track.line(first, abc, false).map_err(whole)?;
        if rounds {
            // The centre lies on the bisector.
            let middle = [back[0] / a + on[0] / b, back[1] / a + on[1] / b];
            let length = middle[0].hypot(middle[1]);
            let reach = size / half.sin();
            let mut centre = corner.at;
            centre[u] += middle[0] / length * reach;
            centre[v] += middle[1] / length * reach;
            // A corner to the left is turned counter-clockwise.
            let left = cross < 0.0;
            let sweep = std::f64::consts::PI - 2.0 * half;
            let mut normal = [0.0; 3];
            normal[w] = 1.0;
            let arc = Arc {
                end: second,
                centre,
                normal,
                sweep: if left { sweep } else { -sweep },
            };
            self.track.arc(&arc, abc).map_err(whole)?;
        } else {
            self.track.line(second, abc, false).map_err(whole)?;
        }
        Ok(Some(second))
    }

    pub(super) fn arc_block(
        &mut self,
        kind: &str,
        words: &Words,
        target: [f64; 3],
        abc: [f64; 3],
    ) -> Result<(), NcProblem> {
        let Some(start) = self.track.known() else { return Ok(()) };
        let plane = self.plane;
        let [u, v, w] = plane;
        let ends = (start, target);
        let sense = words.counter_clockwise;
        let need_sense = || NcProblem::syntax("an arc without its sense: expected DR+ or DR-");
        let need_centre = || NcProblem::syntax("an arc without a centre: expected CC before it");
        let arc = match kind {
            "C" => CircularArc::about(
                ends,
                plane,
                self.centre.ok_or_else(need_centre)?,
                sense.ok_or_else(need_sense)?,
                1.0,
            ),
            "CP" => {
                let centre = self.centre.ok_or_else(need_centre)?;
                let counter_clockwise = sense.ok_or_else(need_sense)?;
                // An incremental angle may be more than a turn: IPA+1080 with IZ is a thread.
                let turns = match words.polar[1] {
                    Some((angle, true)) => {
                        if (angle > 0.0) != counter_clockwise {
                            return Err(NcProblem::value("IPA", angle, "of the sign of DR"));
                        }
                        (angle.abs() / 360.0 - 1e-9).floor().max(0.0) + 1.0
                    }
                    _ => 1.0,
                };
                if turns > 1e4 {
                    return Err(NcProblem::value(
                        "the number of turns of an arc",
                        turns,
                        "at most 10000",
                    ));
                }
                CircularArc::about(ends, plane, centre, counter_clockwise, turns)
            }
            "CR" => {
                let radius = words
                    .radius
                    .ok_or_else(|| NcProblem::syntax("CR without R: expected the radius"))?;
                CircularArc::with_radius(ends, plane, radius, sense.ok_or_else(need_sense)?, 1.0)
            }
            _ => {
                let Some(way) = self.direction else {
                    return Err(NcProblem::syntax(
                        "CT without a move before it: expected a line or an arc that it continues",
                    ));
                };
                let chord = [target[u] - start[u], target[v] - start[v]];
                let length = way[0].hypot(way[1]);
                let normal = [-way[1] / length, way[0] / length];
                let across = normal[0] * chord[0] + normal[1] * chord[1];
                let square = chord[0] * chord[0] + chord[1] * chord[1];
                if !(across.abs() > 1e-9 * square.sqrt()) {
                    let problem = "CT ends straight ahead: expected an end beside the direction of the last move";
                    return Err(NcProblem::syntax(problem));
                }
                let reach = square / (2.0 * across);
                let centre = [start[u] + normal[0] * reach, start[v] + normal[1] * reach];
                CircularArc::about(ends, plane, centre, across > 0.0, 1.0)
            }
        }
        .map_err(NcProblem::syntax)?;
        let out = [arc.end[u] - arc.centre[0], arc.end[v] - arc.centre[1]];
        self.direction = Some(if arc.sweep > 0.0 {
            [-out[1], out[0]]
        } else {
            [out[1], -out[0]]
        });
        let mut centre = [0.0; 3];
        let mut normal = [0.0; 3];
        centre[u] = arc.centre[0];
        centre[v] = arc.centre[1];
        centre[w] = start[w];
        normal[w] = 1.0;
        let made = Arc {
            end: arc.end,
            centre,
            normal,
            sweep: arc.sweep,
        };
        self.track.arc(&made, abc)
    }
}
