//! Moves: lines, arcs, rounded corners and chamfers.

use super::interpreter::Reader;
use super::language::line::Line;
use super::words::{Datum, MoveWords};
use crate::machines::SHORTEST;
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcProblem};

/// The place that `PR` and `PA` give about a pole, from where the tool is: what is not given stays.
pub(super) fn polar_point(
    centre: Option<[f64; 2]>,
    [radius, angle]: [Option<(f64, bool)>; 2],
    now: Option<[f64; 2]>,
) -> Result<[f64; 2], NcProblem> {
    let Some(centre) = centre else {
        return Err(NcProblem::syntax(
            "polar coordinates without a pole: expected CC before them",
        ));
    };
    let out = now.map(|now| [now[0] - centre[0], now[1] - centre[1]]);
    let need =
        || NcProblem::syntax("polar coordinates from an unknown position: expected a move to X, Y and Z before them");
    let counted = |given: Option<(f64, bool)>, now: Option<f64>| match given {
        Some((value, false)) => Ok(value),
        Some((more, true)) => now.map(|now| now + more).ok_or_else(need),
        None => now.ok_or_else(need),
    };
    let radius = counted(radius, out.map(|[x, y]| x.hypot(y)))?;
    let angle = counted(angle, out.map(|[x, y]| y.atan2(x).to_degrees()))?.to_radians();
    Ok([centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()])
}

impl Reader<'_> {
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
        let calls = self.codes(line)? || self.modes.calls_after_moves;
        let mut abc = self.track.abc;
        for k in 0..3 {
            if let Some((value, relative)) = words.axes[3 + k] {
                let target = if relative { abc[k] + value } else { value };
                let nearest = target + 360.0 * ((abc[k] - target) / 360.0).round();
                abc[k] = if self.modes.shortest && !relative {
                    nearest
                } else {
                    target
                };
            }
        }
        let linear = [0, 1, 2].map(|k| words.axes[k].is_some());
        if words.side == Some(None) && self.track.compensates() {
            self.track.end_compensation(None).map_err(whole)?;
        } else if let Some(Some(left)) = words.side {
            self.compensate(left, &words, kind).map_err(whole)?;
        }
        if let Some(way) = words.retract {
            return self
                .retract(
                    way,
                    words.rapid || !line.tokens.iter().any(|token| token.text.starts_with('F')),
                )
                .map_err(whole);
        }
        if let Some(datum) = words.machine {
            return self.go_from_datum(datum, &words, abc).map_err(whole);
        }
        if abc != self.track.abc && self.frames.tilted() && !self.modes.tip_control {
            let normal = self.frames.total(self.modes.plane).direction([0.0, 0.0, 1.0]);
            let axis = self.track.driver.axis(abc).map_err(whole)?;
            let alone = !linear.contains(&true);
            if alone && (0..3).all(|k| (axis[k] - normal[k]).abs() < 1e-6) {
                // The axes turn the tool to the plane that there is.
                if self.track.turn_to_angles(abc, Some(words.rapid)).map_err(whole)? {
                    self.track
                        .note("the rotary axes turn the tool to the plane: the path breaks here");
                }
                return Ok(());
            }
            return Err(whole(NcProblem::unsupported(
                "turning an axis in a tilted plane is",
                "the plane would turn with it; expected PLANE RESET before it",
            )));
        }
        let goes = linear.contains(&true) || words.polar.iter().any(Option::is_some) || matches!(kind, "C" | "CP");
        if !goes && words.tool.iter().all(Option::is_none) {
            if abc != self.track.abc {
                match self.track.known() {
                    Some(here)
                        if !words.rapid || self.modes.tip_control || self.track.driver.kinematics().is_some() =>
                    {
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
                self.call_cycle(line)?;
            }
            return Ok(());
        }
        let Some(target) = self.target(&words, kind, line)? else {
            return if calls { self.call_cycle(line) } else { Ok(()) };
        };
        self.modes.last_rapid = words.rapid;
        self.corner_ahead(words.rapid, abc)?;
        match kind {
            "L" | "LP" | "LN" => self.line_block(&words, target, abc, line)?,
            _ => self.arc_block(kind, &words, target, abc).map_err(whole)?,
        }
        if calls {
            self.call_cycle(line)?;
        }
        Ok(())
    }

    /// `M91`: in machine coordinates of the spindle's nose. What `M92` is measured from, no machine says here.
    fn go_from_datum(&mut self, datum: Datum, words: &MoveWords, abc: [f64; 3]) -> Result<(), NcProblem> {
        let place = self.track.machine_place().filter(|_| datum == Datum::Machine);
        if let Some((nose, _)) = place {
            let goal = std::array::from_fn(|k| {
                let (value, relative) = words.axes[k]?;
                Some(match k {
                    3.. => abc[k - 3],
                    _ if relative => nose[k] + value,
                    _ => value,
                })
            });
            if self.track.go_to_machine(goal, words.rapid)? {
                return Ok(());
            }
        }
        self.track
            .note("moves in machine coordinates are left out: the path breaks here");
        self.track.turn_unknown(abc)?;
        self.track.leave([0, 1, 2].map(|k| words.axes[k].is_some()));
        Ok(())
    }

    /// `M140`: back along the tool, by so much or to the end of the travel.
    fn retract(&mut self, way: Option<f64>, rapid: bool) -> Result<(), NcProblem> {
        let (Some(way), Some(here)) = (way, self.track.known()) else {
            if way.is_none() {
                let taken = "the move is left out; where the tool is then is known again from the next moves";
                let what = "the end of the travel along the tool (M140 MB MAX)";
                self.track
                    .assume(Assumption::new(what, taken, "M140 MB with a length").harmless());
            }
            self.track.leave([true; 3]);
            return Ok(());
        };
        let axis = self.track.direction()?;
        let at = self.track.frame().point(here);
        let back = std::array::from_fn(|k| at[k] + way * axis[k]);
        let target = self.track.frame().inverse_point(back).unwrap_or(here);
        self.track.line(target, self.track.abc, rapid)
    }

    /// Where a block ends, in the frame; `None` if that is not known yet.
    fn target(&mut self, words: &MoveWords, kind: &str, line: &Line) -> Result<Option<[f64; 3]>, Located> {
        let whole = |problem| (problem, line.all());
        let cuts = !words.rapid;
        let polar = words.polar.iter().any(Option::is_some) || matches!(kind, "LP" | "CP" | "CTP");
        let [u, v, _] = self.modes.plane;
        self.track.use_offset(&mut self.frames.work).map_err(whole)?;
        if self.frames.order_unknown && self.frames.transformed() {
            let what = "the order of a shift or a plane that comes after a mirror, a rotation or a scale";
            let taken = "the shift and the plane first, then the mirror, the rotation and the scale";
            let settle = "cycles 8, 10, 11 and 26 after cycle 7 and PLANE";
            self.track.assume(Assumption::new(what, taken, settle));
        }
        let needed = |k: usize| {
            let relative = words.axes[k].is_some_and(|(_, relative)| relative);
            let given = words.axes[k].is_some() || polar && (k == u || k == v);
            relative || cuts && !given
        };
        if !self.uncertain && !self.track.complete(needed) {
            for k in 0..3 {
                if let Some((value, false)) = words.axes[k] {
                    self.track.xyz[k] = Some(value);
                }
            }
            return Ok(None);
        }
        let mut xyz = self.track.xyz;
        if polar {
            let now = xyz[u].zip(xyz[v]).map(|(a, b)| [a, b]);
            let at = polar_point(self.modes.centre, words.polar, now).map_err(whole)?;
            (xyz[u], xyz[v]) = (Some(at[0]), Some(at[1]));
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

    fn centre_block(&mut self, words: &MoveWords) -> Result<(), NcProblem> {
        let [u, v, _] = self.modes.plane;
        let mut centre = [0.0; 2];
        let given = words.axes[u].is_some() || words.axes[v].is_some();
        for (place, k) in centre.iter_mut().zip([u, v]) {
            let now = self.track.xyz[k];
            *place = match (words.axes[k], now) {
                (Some((value, false)), _) => value,
                (Some((value, true)), Some(now)) => now + value,
                // The other coordinate stays that of the last centre; alone, CC is the current position.
                (None, Some(now)) => match self.modes.centre {
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
        self.modes.centre = Some(centre);
        Ok(())
    }

    fn line_block(&mut self, words: &MoveWords, target: [f64; 3], abc: [f64; 3], line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        let oversized = self.modes.oversize != 0.0 || self.modes.corner_oversize != 0.0;
        if oversized && words.normal.iter().any(Option::is_some) {
            return Err(whole(NcProblem::unsupported(
                "LN with surface normals and a tool with DR or DR2 is",
                "expected DR+0 and DR2+0: the path of the tool itself",
            )));
        }
        if line.word(0) == "LN" && words.tool.iter().any(Option::is_some) {
            let vector = words.tool.map(|c| c.unwrap_or(0.0));
            if vector.iter().all(|c| c.abs() < SHORTEST) {
                return Err(whole(NcProblem::syntax(
                    "the tool vector TX TY TZ is (0, 0, 0): expected a direction",
                )));
            }
            if !self.modes.tip_control {
                return Err(whole(NcProblem::syntax(
                    "a tool vector without tip control: expected M128 or FUNCTION TCPM before it",
                )));
            }
            let direction = self.track.frame().direction(vector);
            return self.track.line_towards(target, direction, words.rapid).map_err(whole);
        }
        self.track.line(target, abc, words.rapid).map_err(whole)
    }
}
