//! The moves of a block.

use super::interpreter::Reader;
use super::language::structures::Call;
use super::state::{Modal, Motion};
use super::words::{Action, Meaning, Word, Words, unknown_axis};
use crate::machines::SHORTEST;
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcProblem};

pub(super) const LINEAR: [&str; 3] = ["X", "Y", "Z"];
pub(super) const ROTARY: [&str; 3] = ["A", "B", "C"];
/// The axes by the names of the machine.
pub(super) const MACHINE_AXES: [&str; 3] = ["X1", "Y1", "Z1"];
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
                let left = self.track.leave_out_program(&name, &format!("{name}.SPF"));
                return left.map_err(|problem| (problem, word.span.clone()));
            }
            let modally = self.modal_word(&word.span);
            let times = words.plain("P").unwrap_or(1.0).clamp(1.0, 9999.0) as usize;
            let call = Call {
                name,
                values: Vec::new(),
                variables: Vec::new(),
                times,
                modally,
            };
            if modally {
                self.call_modally(Modal::Program(call));
            } else {
                self.pending = Some(call);
            }
        }
        if let Some(word) = words.any(&MACHINE_AXES).filter(|_| action.home.is_none()) {
            return Err((unknown_axis(&word.name), word.span.clone()));
        }
        let moves = |names: [&str; 3]| names.map(|name| words.get(name).is_some());
        let linear = moves(LINEAR);
        if let Some(kind) = action.pole {
            return self.set_pole(kind, words);
        }
        self.switch_compensation(action, words)?;
        let Some(first) = words.any(&[
            "X", "Y", "Z", "A", "B", "C", "A3", "B3", "C3", "I", "J", "K", "CR", "AR", "I1", "J1", "K1", "AP", "RP",
        ]) else {
            if action.side == Some(None) {
                if self.modes.round_ends && self.track.compensates() {
                    let problem =
                        NcProblem::unsupported("KONT with G40 alone is", "expected G40 with its move, or NORM");
                    return Err((problem, words.whole()));
                }
                self.track
                    .end_compensation(None)
                    .map_err(|problem| (problem, words.whole()))?;
            }
            return match action.home {
                Some(second) => self.go_home(second, words, action),
                None => Ok(()),
            };
        };
        let span = first.span.clone();
        let here = |problem| (problem, span.clone());
        let rotary = moves(ROTARY).contains(&true);
        let abc = self.angles(words)?;
        if let Some(second) = action.home {
            return self.go_home(second, words, action);
        }
        if action.machine {
            return self.go_in_machine_coordinates(words, abc);
        }
        if self.without_length() {
            if self.modes.motion == Motion::Rapid {
                self.track
                    .note("moves without the tool's length (D0) are left out: the path breaks here");
            } else {
                let taken = "left out: the path breaks there";
                let what = "where feed moves without the tool's length (D0) go";
                self.track.assume(Assumption::new(what, taken, "D1 before them"));
            }
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
            && words.any(&["AP", "RP"]).is_none()
            && direction.is_none()
            && self.track.known().is_none()
            && words.any(&["I", "J", "K", "CR", "AR"]).is_none()
        {
            // Only rotary axes turn, at a place that is not known.
            return self.track.turn_unknown(abc).map_err(here);
        }
        self.track.use_offset(&mut self.frames.work).map_err(here)?;
        let cuts = self.modes.motion != Motion::Rapid;
        let polar = words.any(&["AP", "RP"]).is_some();
        let Some(target) = self.target(words, cuts)? else {
            self.track.abc = abc;
            return Ok(());
        };
        if action.side == Some(None) {
            let rounds = self.modes.round_ends;
            self.track
                .end_compensation(Some(target).filter(|_| rounds))
                .map_err(here)?;
        }
        self.check_compensation().map_err(here)?;
        self.corner_at_end(action);
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
        if linear.contains(&true) || polar || rotary {
            match self.modes.modal_call.clone() {
                _ if self.stack.iter().any(|level| level.called_modally) => {}
                Some(Modal::Cycle(cycle)) => self
                    .track
                    .cycle_here(&cycle, self.modes.plane, self.uncertain)
                    .map_err(here)?,
                Some(Modal::Program(call)) => self.pending = Some(call),
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
        if vector.iter().all(|c| c.abs() < SHORTEST) {
            return Err((
                NcProblem::syntax("the tool vector is (0, 0, 0): expected a direction"),
                word.span.clone(),
            ));
        }
        Ok(Some(self.track.frame().direction(vector)))
    }

    pub(super) fn angles(&self, words: &Words) -> Result<[f64; 3], Located> {
        let mut abc = self.track.abc;
        for (k, name) in ROTARY.into_iter().enumerate() {
            let Some(word) = words.get(name) else { continue };
            let now = abc[k];
            let nearest = word.value + 360.0 * ((now - word.value) / 360.0).round();
            abc[k] = match word.meaning {
                Meaning::Incremental => now + word.value,
                Meaning::Plain if !self.modes.absolute => now + word.value,
                Meaning::Plain | Meaning::Absolute => word.value,
                Meaning::Positive if nearest < now => nearest + 360.0,
                Meaning::Negative if nearest > now => nearest - 360.0,
                Meaning::Shortest | Meaning::Positive | Meaning::Negative => nearest,
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
        let polar = self.polar(words)?;
        // As in other readers: what the program has not said is 0.
        let needed = |k: usize| {
            let word = words.get(LINEAR[k]);
            let relative = word.is_some_and(|word| self.relative(word));
            let given = word.is_some() && matches!(self.modes.motion, Motion::Feed);
            polar[k].is_none() && (relative || cuts && !given)
        };
        let needed = [0, 1, 2].map(needed);
        let known = self.uncertain || self.track.complete(|k| needed[k]);
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
            if polar[k].is_some() {
                xyz[k] = polar[k];
            }
            let kept = self.frames.kept[k].filter(|_| word.is_some() || polar[k].is_some());
            if kept.is_some() {
                self.frames.kept[k] = None;
                self.frames.kept_turned &= self.frames.kept.iter().any(Option::is_some);
            }
            if let Some(word) = word {
                let value = word.value * self.modes.unit();
                if let (true, Some(before)) = (relative, kept) {
                    xyz[k] = self.after_frame(before, xyz[k]);
                }
                xyz[k] = if relative {
                    xyz[k].map(|now| now + value)
                } else {
                    Some(value)
                };
            }
        }
        if !known {
            self.track.xyz = xyz;
            return Ok(None);
        }
        self.along_angle(words, &mut xyz)?;
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

    /// From where an incremental word counts that is the first of its axis after a change of the frame.
    fn after_frame(&mut self, before: f64, here: Option<f64>) -> Option<f64> {
        if here.is_none_or(|here| (here - before).abs() < 1e-9) {
            return here;
        }
        let turned = self.frames.kept_turned;
        let taken = match turned {
            true => "no: they go as far as they say",
            false => "yes, as controls are delivered ($SC_FRAME_OFFSET_INCR_PROG)",
        };
        let what = "whether incremental moves after another frame go by its offset too";
        let settle = "an absolute move of the axis after the frame";
        self.track.assume(Assumption::new(what, taken, settle));
        if turned { here } else { Some(before) }
    }

    pub(super) fn relative(&self, word: &Word) -> bool {
        word.meaning == Meaning::Incremental || word.meaning == Meaning::Plain && !self.modes.absolute
    }
}
