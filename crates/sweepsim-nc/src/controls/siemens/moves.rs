//! The moves of a block.

use nalgebra::Vector3;

use super::cursor::Located;
use super::interpreter::Reader;
use super::words::{Action, Meaning, Modal, Motion, Word, Words};
use crate::drive::Arc;
use crate::gcode::CircularArc;
use crate::text::error::NcProblem;

const LINEAR: [&str; 3] = ["X", "Y", "Z"];
const ROTARY: [&str; 3] = ["A", "B", "C"];
const VECTOR: [&str; 3] = ["A3", "B3", "C3"];

impl Reader<'_> {
    pub(super) fn moves(&mut self, words: &Words, action: &Action) -> Result<(), Located> {
        if let Some(word) = words.any(&[
            "U", "V", "W", "E", "A2", "B2", "C2", "A4", "B4", "C4", "A5", "B5", "C5", "LEAD", "TILT", "THETA",
        ]) {
            let problem = NcProblem::unsupported(
                format!("the word {} is", word.name),
                "expected X Y Z A B C, or A3 B3 C3",
            );
            return Err((problem, word.span.clone()));
        }
        if let Some(word) = words.get("L") {
            let name = format!("L{}", word.value);
            if !self.knows(&name) {
                let problem = NcProblem::unsupported(
                    format!("{name} is"),
                    format!("there is no subprogram {name}.SPF beside this file"),
                );
                return Err((problem, word.span.clone()));
            }
            self.pending = Some((
                name,
                Vec::new(),
                words.plain("P").unwrap_or(1.0).clamp(1.0, 9999.0) as usize,
            ));
        }
        let moves = |names: [&str; 3]| names.map(|name| words.get(name).is_some());
        let linear = moves(LINEAR);
        let Some(first) = words.any(&[
            "X", "Y", "Z", "A", "B", "C", "A3", "B3", "C3", "I", "J", "K", "CR", "AR", "I1", "J1", "K1",
        ]) else {
            if action.home {
                return Err((
                    NcProblem::syntax("G74 or G75 without an axis: expected X, Y, Z …"),
                    0..0,
                ));
            }
            return Ok(());
        };
        let span = first.span.clone();
        let here = |problem| (problem, span.clone());
        let rotary = moves(ROTARY).contains(&true);
        let abc = self.angles(words)?;
        if action.home {
            self.track
                .note("moves to the machine's fixed points are left out: the path breaks here");
            let zeroed: [f64; 3] = std::array::from_fn(|k| {
                if words.get(ROTARY[k]).is_some() {
                    0.0
                } else {
                    self.track.abc[k]
                }
            });
            self.track.turn_unknown(zeroed).map_err(here)?;
            self.track.leave(linear);
            return Ok(());
        }
        if action.machine || self.without_length() {
            self.track.note(if action.machine {
                "moves in machine coordinates are left out: the path breaks here"
            } else {
                "moves without the tool's length (D0) are left out: the path breaks here"
            });
            self.track.turn_unknown(abc).map_err(here)?;
            self.track.leave(linear);
            return Ok(());
        }
        if rotary && self.frames.swivelled && abc != self.track.abc && !self.modes.tip_control {
            return Err(here(NcProblem::unsupported(
                "turning an axis in a swivelled plane is",
                "the plane would turn with it; expected CYCLE800() before it",
            )));
        }
        let direction = self.vector(words)?;
        if !linear.contains(&true)
            && direction.is_none()
            && self.track.known().is_none()
            && words.any(&["I", "J", "K", "CR", "AR"]).is_none()
        {
            // Only rotary axes turn, at a place that is not known.
            return self.track.turn_unknown(abc).map_err(here);
        }
        self.use_offset().map_err(here)?;
        let cuts = self.modes.motion != Motion::Rapid;
        let Some(target) = self.target(words, cuts)? else {
            self.track.abc = abc;
            return Ok(());
        };
        match (self.modes.motion, direction) {
            (Motion::Arc { .. } | Motion::Through | Motion::Tangential, None) => self.arc(words, target, abc)?,
            (Motion::Arc { .. } | Motion::Through | Motion::Tangential, Some(_)) => {
                return Err(here(NcProblem::unsupported(
                    "arcs with tool vectors are",
                    "expected short lines",
                )));
            }
            _ if words.any(&["I", "J", "K", "CR", "AR", "I1", "J1", "K1"]).is_some() => {
                return Err(here(NcProblem::syntax(
                    "I, J, K, CR or AR outside an arc: expected G2, G3 or CIP with them",
                )));
            }
            (_, Some(direction)) => self.track.line_towards(target, direction, !cuts).map_err(here)?,
            (_, None) => self.track.line(target, abc, !cuts).map_err(here)?,
        }
        if linear.contains(&true) || rotary {
            match self.modes.modal_call.clone() {
                Some((depth, _)) if depth != self.depth() => {}
                Some((_, Modal::Cycle(cycle))) => self.drill(&cycle).map_err(here)?,
                Some((_, Modal::Program(name, values))) => self.pending = Some((name, values, 1)),
                None => {}
            }
        }
        Ok(())
    }

    /// The direction of the tool in the part's frame, from `A3`, `B3`, `C3`.
    fn vector(&self, words: &Words) -> Result<Option<[f64; 3]>, Located> {
        let Some(word) = words.any(&VECTOR) else {
            return Ok(None);
        };
        if !self.modes.tip_control {
            let problem = NcProblem::syntax("tool vectors without TRAORI: expected TRAORI before them");
            return Err((problem, word.span.clone()));
        }
        let vector = VECTOR.map(|name| words.plain(name).unwrap_or(0.0));
        if vector == [0.0; 3] {
            return Err((
                NcProblem::syntax("the tool vector is (0, 0, 0): expected a direction"),
                word.span.clone(),
            ));
        }
        Ok(Some(self.track.frame().direction(vector)))
    }

    fn angles(&self, words: &Words) -> Result<[f64; 3], Located> {
        let mut abc = self.track.abc;
        for (k, name) in ROTARY.into_iter().enumerate() {
            let Some(word) = words.get(name) else { continue };
            let now = abc[k];
            let nearest = word.value + 360.0 * ((now - word.value) / 360.0).round();
            abc[k] = match word.meaning {
                Meaning::Incremental => now + word.value,
                Meaning::Plain if !self.modes.absolute => now + word.value,
                Meaning::Plain | Meaning::Absolute => word.value,
                Meaning::Shortest => nearest,
                Meaning::Positive => {
                    if nearest < now {
                        nearest + 360.0
                    } else {
                        nearest
                    }
                }
                Meaning::Negative => {
                    if nearest > now {
                        nearest - 360.0
                    } else {
                        nearest
                    }
                }
            };
            if !(abc[k].abs() < 1e9) {
                return Err((
                    NcProblem::value(format!("the angle {name}"), abc[k], "smaller"),
                    word.span.clone(),
                ));
            }
        }
        Ok(abc)
    }

    /// Where the block ends, in the frame; `None` if it is not known yet.
    fn target(&mut self, words: &Words, cuts: bool) -> Result<Option<[f64; 3]>, Located> {
        let mut xyz = self.track.xyz;
        for (k, name) in LINEAR.into_iter().enumerate() {
            let word = words.get(name);
            if word
                .is_some_and(|word| !matches!(word.meaning, Meaning::Plain | Meaning::Absolute | Meaning::Incremental))
            {
                let problem = NcProblem::syntax("DC, ACP and ACN are for rotary axes: expected AC or IC");
                return Err((problem, words.span(name)));
            }
            let relative = word.is_some_and(|word| self.relative(word));
            if self.track.xyz[k].is_none()
                && (relative || cuts && (word.is_none() || !matches!(self.modes.motion, Motion::Feed)))
                && !self.uncertain
            {
                // As in other readers: what the program has not said is 0.
                self.track.note(format!("{name} is not known here: taken as 0"));
                self.track.xyz[k] = Some(0.0);
                xyz[k] = Some(0.0);
            }
            if let Some(word) = word {
                let value = word.value * self.modes.unit();
                xyz[k] = if relative {
                    xyz[k].map(|now| now + value)
                } else {
                    Some(value)
                };
            }
        }
        if let [Some(x), Some(y), Some(z)] = xyz {
            if self.track.known().is_none()
                && matches!(
                    self.modes.motion,
                    Motion::Arc { .. } | Motion::Through | Motion::Tangential
                )
            {
                self.track.xyz = xyz;
                return Ok(None);
            }
            return Ok(Some([x, y, z]));
        }
        self.track.xyz = xyz;
        Ok(None)
    }

    fn relative(&self, word: &Word) -> bool {
        word.meaning == Meaning::Incremental || word.meaning == Meaning::Plain && !self.modes.absolute
    }

    fn arc(&mut self, words: &Words, target: [f64; 3], abc: [f64; 3]) -> Result<(), Located> {
        let whole = words
            .any(&["X", "Y", "Z", "I", "J", "K", "CR", "AR", "I1"])
            .map_or(0..0, |word| word.span.clone());
        let fail = |message: String| (NcProblem::syntax(message), whole.clone());
        let Some(start) = self.track.known() else { return Ok(()) };
        let plane = self.modes.plane;
        let [u, v, w] = plane;
        let unit = self.modes.unit();
        let turns = words.plain("TURN").unwrap_or(0.0);
        if turns.fract() != 0.0 || !(0.0..=999.0).contains(&turns) {
            return Err((
                NcProblem::value("TURN", turns, "a whole number from 0 to 999"),
                words.span("TURN"),
            ));
        }
        let ends = (start, target);
        let Motion::Arc { counter_clockwise } = self.modes.motion else {
            if self.modes.motion == Motion::Tangential {
                let problem = NcProblem::unsupported("CT is", "expected G2 or G3 with a centre");
                return Err((problem, whole));
            }
            return self.through(words, start, target, abc, whole);
        };
        let centre_words = ["I", "J", "K"];
        let centre = |k: usize| {
            words.get(centre_words[k]).map(|word| {
                let value = word.value * unit;
                // Centres are from the start, also in G90.
                if word.meaning == Meaning::Absolute {
                    value
                } else {
                    start[k] + value
                }
            })
        };
        let arc = if let Some(radius) = words.plain("CR") {
            CircularArc::with_radius(ends, plane, radius * unit, counter_clockwise, 1.0 + turns)
        } else if words.any(&centre_words).is_some() {
            let at = [centre(u).unwrap_or(start[u]), centre(v).unwrap_or(start[v])];
            if let Some(angle) = words.plain("AR") {
                // An opening angle with a centre gives the end.
                if !(angle > 0.0 && angle < 360.0) {
                    return Err((NcProblem::value("AR", angle, "between 0 and 360"), words.span("AR")));
                }
                let sweep = if counter_clockwise { angle } else { -angle }.to_radians();
                let (sin, cos) = sweep.sin_cos();
                let from = [start[u] - at[0], start[v] - at[1]];
                let mut end = target;
                end[u] = at[0] + cos * from[0] - sin * from[1];
                end[v] = at[1] + sin * from[0] + cos * from[1];
                CircularArc::about((start, end), plane, at, counter_clockwise, 1.0 + turns)
            } else {
                CircularArc::about(ends, plane, at, counter_clockwise, 1.0 + turns)
            }
        } else if let Some(angle) = words.plain("AR") {
            if !(angle > 0.0 && angle < 360.0) {
                return Err((NcProblem::value("AR", angle, "between 0 and 360"), words.span("AR")));
            }
            let chord = (target[u] - start[u]).hypot(target[v] - start[v]);
            let radius = 0.5 * chord / (0.5 * angle.to_radians()).sin();
            let signed = if angle > 180.0 { -radius } else { radius };
            CircularArc::with_radius(ends, plane, signed, counter_clockwise, 1.0 + turns)
        } else {
            return Err(fail(format!(
                "this arc has no centre: expected {} and {}, CR= or AR=",
                centre_words[u], centre_words[v]
            )));
        }
        .map_err(fail)?;
        let mut centre = [0.0; 3];
        let mut normal = [0.0; 3];
        centre[u] = arc.centre[0];
        centre[v] = arc.centre[1];
        centre[w] = start[w];
        normal[w] = 1.0;
        let arc = Arc {
            end: arc.end,
            centre,
            normal,
            sweep: arc.sweep,
        };
        self.track.arc(&arc, abc).map_err(|problem| (problem, whole))
    }

    /// An arc through an intermediate point (`CIP` with `I1`, `J1`, `K1`), in any plane.
    fn through(
        &mut self,
        words: &Words,
        start: [f64; 3],
        end: [f64; 3],
        abc: [f64; 3],
        whole: std::ops::Range<usize>,
    ) -> Result<(), Located> {
        let unit = self.modes.unit();
        let middle: [f64; 3] = std::array::from_fn(|k| match words.get(["I1", "J1", "K1"][k]) {
            Some(word) if self.relative(word) => start[k] + word.value * unit,
            Some(word) => word.value * unit,
            None => start[k],
        });
        let (a, b, c) = (Vector3::from(start), Vector3::from(middle), Vector3::from(end));
        let (p, q) = (b - a, c - a);
        let normal = p.cross(&q);
        let size = normal.norm();
        if !(size > 1e-9 * p.norm() * q.norm()) {
            let problem =
                NcProblem::syntax("the three points of CIP lie on a line: expected an intermediate point beside it");
            return Err((problem, whole));
        }
        // The circumcentre of the triangle.
        let to_centre = (q * p.norm_squared() - p * q.norm_squared()).cross(&normal) / (2.0 * size * size);
        let centre = a + to_centre;
        let unit_normal = normal / size;
        let (from, to) = (a - centre, c - centre);
        let sweep = unit_normal
            .dot(&from.cross(&to))
            .atan2(from.dot(&to))
            .rem_euclid(std::f64::consts::TAU);
        let arc = Arc {
            end,
            centre: centre.into(),
            normal: unit_normal.into(),
            sweep,
        };
        self.track.arc(&arc, abc).map_err(|problem| (problem, whole))
    }
}
