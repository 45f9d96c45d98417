//! Moves: lines, arcs, rounded corners and chamfers.

use super::interpreter::Reader;
use super::line::{Line, Located};
use crate::drive::Arc;
use crate::gcode::CircularArc;
use crate::text::error::NcProblem;

/// A corner that the next line rounds or cuts off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Corner {
    /// The programmed corner, where the tool does not go.
    at: [f64; 3],
    /// The radius of RND, or the length of CHF; set by that block.
    size: Option<(f64, bool)>,
}

/// The words of a move.
#[derive(Clone, Debug, Default)]
struct Words {
    /// X, Y, Z and A, B, C: value, and whether it is incremental.
    axes: [Option<(f64, bool)>; 6],
    /// PR and PA.
    polar: [Option<(f64, bool)>; 2],
    radius: Option<f64>,
    counter_clockwise: Option<bool>,
    normal: [Option<f64>; 3],
    tool: [Option<f64>; 3],
    rapid: bool,
    machine: bool,
}

const AXES: [&str; 6] = ["X", "Y", "Z", "A", "B", "C"];

impl Reader<'_> {
    fn words(&mut self, line: &Line) -> Result<Words, Located> {
        let mut words = Words::default();
        let mut index = 1;
        while index < line.tokens.len() {
            let token = &line.tokens[index];
            let mut text = token.text.clone();
            index += 1;
            // `F MAX`, `X +10`: a name and its value apart.
            let next = line.word(index);
            let letter_alone = text.len() <= 3
                && text.bytes().all(|b| b.is_ascii_alphabetic())
                && !matches!(text.as_str(), "RL" | "RR");
            if letter_alone
                && (next == "MAX"
                    || next == "AUTO"
                    || next.starts_with(|c: char| "+-".contains(c) || c.is_ascii_digit()))
            {
                text += next;
                index += 1;
            }
            let here = |problem| (problem, token.span.clone());
            let value = |reader: &Self, rest: &str| reader.parameters.value(rest).map_err(here);
            let (relative, name) = match text.strip_prefix('I') {
                Some(rest) => (true, rest.to_owned()),
                None => (false, text.clone()),
            };
            match name.as_str() {
                "R0" => {}
                "RL" | "RR" | "R+" | "R-" => {
                    return Err(here(NcProblem::unsupported(
                        format!("{name}: cutter compensation is"),
                        "expected R0 and the path of the tool's centre",
                    )));
                }
                "FMAX" => words.rapid = true,
                "FAUTO" | "F" => {}
                "DR+" => words.counter_clockwise = Some(true),
                "DR-" => words.counter_clockwise = Some(false),
                _ => {
                    let named = |prefix: &str| name.strip_prefix(prefix).filter(|rest| !rest.is_empty());
                    let vector = ["NX", "NY", "NZ", "TX", "TY", "TZ"]
                        .iter()
                        .position(|prefix| named(prefix).is_some());
                    let polar = ["PR", "PA"].iter().position(|prefix| named(prefix).is_some());
                    let axis = AXES.iter().position(|prefix| named(prefix).is_some());
                    if let Some(k) = vector {
                        let value = value(self, &name[2..])?;
                        let place = if k < 3 {
                            &mut words.normal[k]
                        } else {
                            &mut words.tool[k - 3]
                        };
                        *place = Some(value);
                    } else if let Some(k) = polar {
                        let value = value(self, &name[2..])?;
                        words.polar[k] = Some((if k == 0 { value * self.unit() } else { value }, relative));
                    } else if let Some(k) = axis {
                        if words.axes[k].is_some() {
                            return Err(here(NcProblem::syntax(format!(
                                "a second {} in one block: expected one",
                                AXES[k]
                            ))));
                        }
                        let value = value(self, &name[1..])?;
                        words.axes[k] = Some((if k < 3 { value * self.unit() } else { value }, relative));
                    } else if let Some(rest) = named("M") {
                        words.machine |= matches!(rest, "91" | "92");
                    } else if let Some(rest) = named("F") {
                        self.track.feed = Some(value(self, rest)?);
                    } else if let Some(rest) = named("R") {
                        words.radius = Some(value(self, rest)? * self.unit());
                    } else {
                        return Err(here(NcProblem::syntax(format!(
                            "{} in a move: expected axes, R0, F, M",
                            token.text
                        ))));
                    }
                }
            }
        }
        Ok(words)
    }

    pub(super) fn path(&mut self, line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        let kind = line.word(0);
        if matches!(kind, "RND" | "CHF") {
            return self.corner_block(line);
        }
        // CHF+5 and R+5 aside, moves have words.
        let words = self.words(line)?;
        if kind == "CC" {
            return self.centre_block(&words).map_err(whole);
        }
        // Codes come into effect before the move: tip control, spindle.
        let calls = self.codes(line)?;
        let mut abc = self.track.abc;
        for k in 0..3 {
            if let Some((value, relative)) = words.axes[3 + k] {
                let target = if relative { abc[k] + value } else { value };
                let nearest = target + 360.0 * ((abc[k] - target) / 360.0).round();
                abc[k] = if self.shortest && !relative { nearest } else { target };
            }
        }
        let linear = [0, 1, 2].map(|k| words.axes[k].is_some());
        if words.machine {
            self.track
                .note("moves in machine coordinates are left out: the path breaks here");
            self.track.turn_unknown(abc).map_err(whole)?;
            self.track.leave(linear);
            return Ok(());
        }
        if abc != self.track.abc && self.frames.tilted() && !self.tip_control {
            return Err(whole(NcProblem::unsupported(
                "turning an axis in a tilted plane is",
                "the plane would turn with it; expected PLANE RESET before it",
            )));
        }
        let goes = linear.contains(&true) || words.polar.iter().any(Option::is_some) || matches!(kind, "C" | "CP");
        if !goes && words.tool.iter().all(Option::is_none) {
            if abc != self.track.abc {
                match self.track.known() {
                    Some(here) if !words.rapid || self.tip_control || self.track.driver.kinematics().is_some() => {
                        self.track.line(here, abc, words.rapid).map_err(whole)?;
                    }
                    _ => {
                        self.track
                            .note("rotary axes turn where only the machine knows the tip: the path breaks here");
                        self.track.turn_unknown(abc).map_err(whole)?;
                    }
                }
            }
            if calls {
                self.drill().map_err(whole)?;
            }
            return Ok(());
        }
        let Some(target) = self.target(&words, kind, line)? else {
            return Ok(());
        };
        match kind {
            "L" | "LP" | "LN" => self.line_block(&words, target, abc, line)?,
            _ => self.arc_block(kind, &words, target, abc).map_err(whole)?,
        }
        if calls {
            self.drill().map_err(whole)?;
        }
        Ok(())
    }

    /// Where a block ends, in the frame; `None` if that is not known yet.
    fn target(&mut self, words: &Words, kind: &str, line: &Line) -> Result<Option<[f64; 3]>, Located> {
        let whole = |problem| (problem, line.all());
        let cuts = !words.rapid;
        let polar = words.polar.iter().any(Option::is_some) || matches!(kind, "LP" | "CP");
        let [u, v, _] = self.plane;
        for k in 0..3 {
            let relative = words.axes[k].is_some_and(|(_, relative)| relative);
            let given = words.axes[k].is_some() || polar && (k == u || k == v);
            if self.track.xyz[k].is_none() && (relative || cuts && !given) && !self.uncertain {
                self.track.note(format!("{} is not known here: taken as 0", AXES[k]));
                self.track.xyz[k] = Some(0.0);
            }
        }
        let mut xyz = match self.corner {
            Some(corner) => corner.at.map(Some),
            None => self.track.xyz,
        };
        if polar {
            let Some(centre) = self.centre else {
                return Err(whole(NcProblem::syntax(
                    "polar coordinates without a pole: expected CC before them",
                )));
            };
            let now = match (xyz[u], xyz[v]) {
                (Some(a), Some(b)) => Some([a - centre[0], b - centre[1]]),
                _ => None,
            };
            let need = || {
                whole(NcProblem::syntax(
                    "polar coordinates from an unknown position: expected a move to X, Y and Z before them",
                ))
            };
            let radius = match words.polar[0] {
                Some((radius, false)) => radius,
                Some((more, true)) => now.map(|now| now[0].hypot(now[1])).ok_or_else(need)? + more,
                None => now.map(|now| now[0].hypot(now[1])).ok_or_else(need)?,
            };
            let angle = match words.polar[1] {
                Some((angle, false)) => angle.to_radians(),
                Some((more, true)) => now.map(|now| now[1].atan2(now[0])).ok_or_else(need)? + more.to_radians(),
                None => now.map(|now| now[1].atan2(now[0])).ok_or_else(need)?,
            };
            xyz[u] = Some(centre[0] + radius * angle.cos());
            xyz[v] = Some(centre[1] + radius * angle.sin());
        }
        for k in 0..3 {
            if let Some((value, relative)) = words.axes[k] {
                xyz[k] = if relative {
                    xyz[k].map(|now| now + value)
                } else {
                    Some(value)
                };
            }
        }
        let [Some(x), Some(y), Some(z)] = xyz else {
            self.track.xyz = xyz;
            return Ok(None);
        };
        if self.track.known().is_none() && !matches!(kind, "L" | "LP" | "LN") {
            self.track.xyz = xyz;
            return Ok(None);
        }
        Ok(Some([x, y, z]))
    }

    fn centre_block(&mut self, words: &Words) -> Result<(), NcProblem> {
        let [u, v, _] = self.plane;
        let mut centre = [0.0; 2];
        let given = words.axes[u].is_some() || words.axes[v].is_some();
        for (place, k) in centre.iter_mut().zip([u, v]) {
            let now = self.track.xyz[k];
            *place = match (words.axes[k], now) {
                (Some((value, false)), _) => value,
                (Some((value, true)), Some(now)) => now + value,
                // The other coordinate stays that of the last centre; alone, CC is the current position.
                (None, Some(now)) => match self.centre {
                    Some(before) if given => before[usize::from(k == v)],
                    _ => now,
                },
                _ if self.uncertain => return Ok(()),
                _ => {
                    return Err(NcProblem::syntax(
                        "CC at an unknown position: expected its coordinates, or a move before it",
                    ));
                }
            };
        }
        self.centre = Some(centre);
        Ok(())
    }

    fn line_block(&mut self, words: &Words, target: [f64; 3], abc: [f64; 3], line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        if line.word(0) == "LN" && words.tool.iter().any(Option::is_some) {
            let vector = words.tool.map(|c| c.unwrap_or(0.0));
            if vector == [0.0; 3] {
                return Err(whole(NcProblem::syntax(
                    "the tool vector TX TY TZ is (0, 0, 0): expected a direction",
                )));
            }
            if !self.tip_control {
                return Err(whole(NcProblem::syntax(
                    "a tool vector without tip control: expected M128 or FUNCTION TCPM before it",
                )));
            }
            let direction = self.track.frame().direction(vector);
            return self.track.line_towards(target, direction, words.rapid).map_err(whole);
        }
        let follows = self.following().map(|next| next.word(0).to_owned());
        let start = match self.corner.take() {
            Some(corner) => self.turn_corner(corner, target, line)?,
            None => self.track.known(),
        };
        if let Some(start) = start {
            let [u, v, _] = self.plane;
            let way = [target[u] - start[u], target[v] - start[v]];
            if way[0].hypot(way[1]) > 0.0 {
                self.direction = Some(way);
            }
        }
        let rounds = follows.is_some_and(|next| next.starts_with("RND") || next.starts_with("CHF"));
        if rounds && !words.rapid && self.track.known().is_some() {
            if abc != self.track.abc {
                return Err(whole(NcProblem::unsupported(
                    "rounding where rotary axes turn is",
                    "expected a corner of lines",
                )));
            }
            self.corner = Some(Corner { at: target, size: None });
            return Ok(());
        }
        self.track.line(target, abc, words.rapid).map_err(whole)
    }

    /// `RND R5`, `CHF 2`.
    fn corner_block(&mut self, line: &Line) -> Result<(), Located> {
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
    fn turn_corner(&mut self, corner: Corner, target: [f64; 3], line: &Line) -> Result<Option<[f64; 3]>, Located> {
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

    fn arc_block(&mut self, kind: &str, words: &Words, target: [f64; 3], abc: [f64; 3]) -> Result<(), NcProblem> {
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
