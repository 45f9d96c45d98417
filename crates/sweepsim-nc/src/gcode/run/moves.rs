//! The moves of a block.

use std::f64::consts::TAU;

use super::interpreter::Reader;
use super::tools::ToolRow;
use crate::gcode::codes::MotionMode;
use crate::gcode::motion::arc::CircularArc;
use crate::gcode::motion::compensation::{Bend, Compensation, Item, Side, Stroke};
use crate::gcode::motion::state::MoveEnd;
use crate::gcode::syntax::block::{Block, Word};
use crate::gcode::syntax::expression::Variables;
use crate::gcode::trace::Canonical;
use crate::model::read_options::Controller;
use crate::text::error::NcProblem;

impl Reader {
    /// The rotary angles at the end of a block.
    fn angles(&self, block: &Block) -> [f64; 3] {
        let mut abc = self.state.abc;
        for (angle, letter) in abc.iter_mut().zip(['A', 'B', 'C']) {
            if let Some(value) = block.get(letter) {
                *angle = if self.modes.absolute { value } else { *angle + value };
            }
        }
        abc
    }

    /// The position along an axis is not known from now on.
    pub(crate) fn forget(&mut self, k: usize) {
        self.at[k] = None;
        if !self.map.is_shift() {
            // Turned coordinates need both X and Y.
            self.at = [None; 3];
        }
        self.state.xyz = self.map.partial(self.at);
    }

    /// G53: a move in machine coordinates. Unless those are known, its end in the part's frame is not.
    pub(crate) fn go_in_machine_coordinates(&mut self, motion: MotionMode, block: &Block) -> Result<(), NcProblem> {
        self.refuse_compensation("a move in machine coordinates")?;
        if !matches!(motion, MotionMode::Rapid | MotionMode::Feed) {
            return Err(NcProblem::syntax("G53 with an arc or a cycle: expected G0 or G1"));
        }
        let words = self.lengths(block, ['X', 'Y', 'Z']);
        if self.machine_known
            && let [x, y, z] = self.control_position()
            && let [Some(x), Some(y), Some(z)] = [words[0].or(x), words[1].or(y), words[2].or(z)]
        {
            return self.go_to_control([x, y, z], motion == MotionMode::Rapid);
        }
        self.state
            .note("moves in machine coordinates are left out: the path breaks here");
        for k in 0..3 {
            if words[k].is_some() {
                self.forget(k);
            }
        }
        self.state.abc = self.angles(block);
        self.state.leave();
        Ok(())
    }

    /// A straight move of the control's point.
    pub(crate) fn go_to_control(&mut self, control: [f64; 3], rapid: bool) -> Result<(), NcProblem> {
        let Some(inverse) = self.frame_map().inverse() else {
            return Ok(());
        };
        let end = inverse.apply(std::array::from_fn(|k| control[k] - self.length[k]));
        let stroke = self.stroke_to(end, self.state.abc, rapid);
        self.give(stroke)
    }

    pub(crate) fn stroke_to(&self, end: [f64; 3], abc: [f64; 3], rapid: bool) -> Stroke {
        Stroke {
            end,
            abc,
            rapid,
            bend: None,
            plane: self.modes.plane,
            place: self.state.place,
            feed: if rapid { None } else { self.modes.feed },
            feed_mode: self.modes.feed_mode,
        }
    }

    /// X and Y of G16 are a radius and an angle.
    pub(crate) fn polar(&self, words: [Option<f64>; 3]) -> Result<[Option<f64>; 3], NcProblem> {
        let [u, v, _] = self.modes.plane;
        if !self.modes.polar || (words[u].is_none() && words[v].is_none()) {
            return Ok(words);
        }
        let (Some(radius), Some(angle)) = (words[u], words[v]) else {
            return Err(NcProblem::unsupported(
                "polar coordinates without both radius and angle are",
                "expected both in each block of G16",
            ));
        };
        if !self.modes.absolute {
            return Err(NcProblem::unsupported(
                "incremental polar coordinates are",
                "expected G90 with G16",
            ));
        }
        // Angles are degrees, whatever the unit of lengths is.
        let (sin, cos) = (angle / self.unit()).to_radians().sin_cos();
        let mut found = words;
        found[u] = Some(radius * cos);
        found[v] = Some(radius * sin);
        Ok(found)
    }

    /// Takes unknown coordinates as 0, before a move that needs them.
    fn assume(&mut self, needed: impl Fn(usize) -> bool) {
        for k in 0..3 {
            if self.at[k].is_none() && needed(k) {
                let axis = ['X', 'Y', 'Z'][k];
                self.state.note(format!("{axis} is not known here: taken as 0"));
                self.at[k] = Some(0.0);
            }
        }
        self.state.xyz = self.map.partial(self.at);
    }

    /// A move in the program's coordinates.
    pub(crate) fn go(&mut self, motion: MotionMode, block: &Block) -> Result<(), NcProblem> {
        let words = self.polar(self.lengths(block, ['X', 'Y', 'Z']))?;
        let abc = self.angles(block);
        if self.turn_alone(block, motion, abc)? {
            return Ok(());
        }
        let abc = self.aim(block, motion, abc)?;
        let vector = self.has_vector(block, motion);
        let cuts = motion != MotionMode::Rapid;
        let unknown = self.known_position().is_none();
        if self.uncertain && unknown && (cuts || !self.modes.absolute) {
            // Nothing is assumed about a position that an earlier problem has made unknown.
            for k in 0..3 {
                if let Some(word) = words[k] {
                    self.at[k] = self.modes.absolute.then_some(word);
                }
            }
            self.state.xyz = self.map.partial(self.at);
            self.state.abc = abc;
            if self.lenient {
                self.state
                    .note("left out: a move after a problem, until its start is known again");
            }
            return Ok(());
        }
        if unknown && (cuts || !self.modes.absolute) {
            for k in (0..3).filter(|&k| self.at[k].is_none()) {
                self.offsets.know(k)?;
            }
            let relative = !self.modes.absolute || matches!(motion, MotionMode::Arc { .. });
            self.assume(|k| words[k].is_none() || relative);
        }
        let mut to = self.at;
        for k in 0..3 {
            if let Some(word) = words[k] {
                to[k] = Some(match to[k] {
                    Some(now) if !self.modes.absolute => now + word,
                    _ => {
                        self.offsets.know(k)?;
                        word
                    }
                });
            }
        }
        if self.modes.tilt.is_none() && (!self.map.is_shift() || self.map.add != [0.0; 3]) {
            self.state.note(if self.offsets.made_by_shift() {
                "work offsets set by the program are applied"
            } else {
                "work offsets set by the program are applied: poses are in machine coordinates"
            });
        }
        let [Some(x), Some(y), Some(z)] = to else {
            // A rapid towards the first known position.
            self.at = to;
            self.state.xyz = self.map.partial(to);
            self.state.abc = abc;
            return Ok(());
        };
        let end = [x, y, z];
        if cuts && self.known_position().is_none() {
            self.state
                .note("the start of this feed move is unknown: the path begins at its end");
        }
        let mut stroke = self.stroke_to(end, abc, !cuts);
        match (motion, self.known_position()) {
            (MotionMode::Arc { counter_clockwise }, Some(start)) => {
                if self.straight_next {
                    return Err(NcProblem::syntax(
                        "an arc right after the end of cutter compensation: expected a straight move first",
                    ));
                }
                let arc = self.arc(counter_clockwise, start, end, block)?;
                stroke.bend = Some(Bend {
                    centre: arc.centre,
                    sweep: arc.sweep,
                });
            }
            (MotionMode::RigidTap, Some(start)) => {
                self.give(stroke)?;
                let back = self.stroke_to(start, abc, false);
                return self.give(back);
            }
            _ if !vector && Self::has_spare_centre(block) => {
                return Err(NcProblem::syntax(
                    "I, J, K or R outside an arc: expected G2 or G3 with them",
                ));
            }
            _ => {}
        }
        self.give(stroke)
    }

    /// Whether a straight move has words of an arc.
    fn has_spare_centre(block: &Block) -> bool {
        // G33's K is a pitch; M codes have words of their own.
        let other = |w: &Word| w.letter == 'G' && (w.value == 33.0 || w.value == 28.0);
        block.first("IJKR").is_some() && !block.has('M') && !block.words().iter().any(other)
    }

    /// The arc of a block.
    fn arc(
        &mut self,
        counter_clockwise: bool,
        start: [f64; 3],
        end: [f64; 3],
        block: &Block,
    ) -> Result<CircularArc, NcProblem> {
        let turns = block.get('P').unwrap_or(1.0);
        if turns.fract() != 0.0 || !(1.0..=1e4).contains(&turns) {
            return Err(NcProblem::value(
                "the number of turns P",
                turns,
                "a whole number from 1 on",
            ));
        }
        if let Some(word) = block
            .first("LQ")
            .filter(|word| word.value != 0.0 && (word.letter, word.value) != ('L', 1.0))
        {
            return Err(NcProblem::unsupported(
                format!("{} in an arc (turns, repeats or a spiral) is", word.letter),
                "expected P for further turns",
            ));
        }
        let plane = self.modes.plane;
        let [u, v, w] = plane;
        let words = self.lengths(block, ['I', 'J', 'K']);
        let ends = (start, end);
        let arc = match block.get('R') {
            Some(_) if words.iter().any(Option::is_some) => {
                return Err(NcProblem::syntax(
                    "an arc with both R and a centre: expected R, or I, J, K",
                ));
            }
            Some(radius) => CircularArc::with_radius(ends, plane, radius * self.unit(), counter_clockwise, turns),
            None => {
                let centre = match (self.modes.absolute_centres, words[u], words[v]) {
                    (true, Some(cu), Some(cv)) => {
                        self.offsets.know(u)?;
                        self.offsets.know(v)?;
                        [cu, cv]
                    }
                    (false, None, None) | (true, _, _) => {
                        return Err(NcProblem::syntax(format!(
                            "this arc has no centre: expected {} and {}, or R",
                            ['I', 'J', 'K'][u],
                            ['I', 'J', 'K'][v]
                        )));
                    }
                    (false, cu, cv) => [start[u] + cu.unwrap_or(0.0), start[v] + cv.unwrap_or(0.0)],
                };
                let arc = CircularArc::about(ends, plane, centre, counter_clockwise, turns);
                match (arc, words[w].filter(|offset| *offset != 0.0)) {
                    (Ok(arc), Some(height)) => {
                        let absolute = self.modes.absolute_centres.then_some(height);
                        arc.check_third(height, absolute).map(|()| arc)
                    }
                    (arc, _) => arc,
                }
            }
        };
        arc.map_err(NcProblem::syntax)
    }

    /// Executes a programmed move, beside it if cutter compensation is on.
    pub(crate) fn give(&mut self, stroke: Stroke) -> Result<(), NcProblem> {
        let from = self.known_position();
        let end = stroke.end;
        self.straight_next = false;
        if !stroke.rapid && self.compensation.as_ref().is_none_or(Compensation::is_idle) {
            self.state.feed = stroke.feed;
            self.state.start_here()?;
        }
        match &mut self.compensation {
            None => {
                if let Some(from) = from {
                    self.actual = from;
                }
                self.emit(&stroke)?;
            }
            Some(compensation) => {
                let Some(from) = from else {
                    return Err(NcProblem::syntax(
                        "cutter compensation from an unknown position: expected a move to X, Y and Z before it",
                    ));
                };
                if stroke.abc != self.state.abc {
                    return Err(NcProblem::unsupported(
                        "rotary moves while cutter compensation is on are",
                        "expected G40 before them",
                    ));
                }
                let mut items = Vec::new();
                let result = compensation.add(from, stroke, &mut items);
                self.emit_all(items)?;
                result?;
            }
        }
        self.at = end.map(Some);
        Ok(())
    }

    fn emit_all(&mut self, items: impl IntoIterator<Item = Item>) -> Result<(), NcProblem> {
        for item in items {
            match item {
                Item::Stroke(stroke) => self.emit(&stroke)?,
                Item::Event(kind, place) => self.state.event(kind, place)?,
            }
        }
        Ok(())
    }

    /// A move of the tool, as it is.
    fn emit(&mut self, stroke: &Stroke) -> Result<(), NcProblem> {
        self.trace_stroke(stroke);
        let start = std::mem::replace(&mut self.actual, stroke.end);
        let place = std::mem::replace(&mut self.state.place, stroke.place);
        self.state.feed = stroke.feed;
        self.state.feed_mode = stroke.feed_mode;
        let target = MoveEnd {
            xyz: self.map.apply(stroke.end),
            abc: stroke.abc,
        };
        let result = match stroke.bend {
            None => self.state.line_to(target, stroke.rapid),
            Some(bend) => self.bend(start, stroke, bend, target),
        };
        self.state.place = place;
        result
    }

    fn bend(&mut self, start: [f64; 3], stroke: &Stroke, bend: Bend, target: MoveEnd) -> Result<(), NcProblem> {
        let arc = CircularArc {
            start,
            end: stroke.end,
            plane: stroke.plane,
            centre: bend.centre,
            sweep: bend.sweep,
        };
        let Some(arc) = arc.mapped(&self.map) else {
            return Err(NcProblem::unsupported(
                "arcs in coordinates with unequal scales are",
                "expected the same scale for all axes",
            ));
        };
        if self.exact_arcs {
            let exact = arc.exact().map_err(|error| NcProblem::syntax(error.to_string()))?;
            return self.state.arc_to(target, exact);
        }
        let chords = arc.chords(self.arc_tolerance).map_err(NcProblem::syntax)?;
        self.state.notes.add_str(self.state.place.line, &self.chord_note);
        let from = self.state.abc;
        for chord in 1..chords {
            let s = chord as f64 / chords as f64;
            let abc = std::array::from_fn(|k| from[k] + s * (target.abc[k] - from[k]));
            self.state.line_to(MoveEnd { xyz: arc.at(s), abc }, false)?;
        }
        self.state.line_to(target, false)
    }

    fn trace_stroke(&mut self, stroke: &Stroke) {
        let unit = self.unit();
        let Some(trace) = &mut self.trace else { return };
        let [x, y, z] = stroke.end.map(|x| x / unit);
        let [a, b, c] = stroke.abc;
        trace.push(match stroke.bend {
            Some(bend) => {
                let turns = ((bend.sweep.abs() - 1e-6) / TAU).floor() as i32 + 1;
                Canonical::Arc {
                    plane: stroke.plane,
                    end: [x, y, z],
                    centre: bend.centre.map(|x| x / unit),
                    turns: if bend.sweep > 0.0 { turns } else { -turns },
                    abc: stroke.abc,
                }
            }
            None if stroke.rapid => Canonical::Traverse([x, y, z, a, b, c]),
            None => Canonical::Feed([x, y, z, a, b, c]),
        });
    }

    /// G41 and G42, by a number of the table (D) or by the diameter itself (G41.1).
    pub(crate) fn compensate(&mut self, left: bool, by_words: bool, block: &Block) -> Result<(), NcProblem> {
        if self.compensation.is_some() {
            return Err(NcProblem::unsupported(
                "a change of cutter compensation without G40 is",
                "expected G40 and a move between them",
            ));
        }
        if self.modes.scaling.is_some() {
            return Err(NcProblem::unsupported(
                "cutter compensation in scaled coordinates is",
                "expected G50 before it",
            ));
        }
        let diameter = match (by_words, block.get('D')) {
            (true, Some(d)) => d * self.unit(),
            (true, None) => return Err(NcProblem::syntax("G41.1 without D: expected the tool's diameter")),
            (false, d) => {
                let number = match d {
                    Some(d) => Self::tool_number(d)?,
                    None => self.state.tool.unwrap_or(0),
                };
                let row = self.tools.get(number).or((number == 0).then(ToolRow::default));
                let Some(row) = row else {
                    return Err(NcProblem::syntax(format!(
                        "the diameter D{number} for cutter compensation is not known: expected it in the tool table, or G41.1 D with the diameter"
                    )));
                };
                row.diameter
            }
        };
        let Some(at) = self.known_position() else {
            return Err(NcProblem::syntax(
                "cutter compensation from an unknown position: expected a move to X, Y and Z before it",
            ));
        };
        let linuxcnc = self.controller == Some(Controller::LinuxCnc);
        let side = Side {
            left: left != (diameter < 0.0),
            radius: 0.5 * diameter.abs(),
            fanuc: self.fanuc(),
            tangent: if linuxcnc { 0.05 } else { 1e-6 },
        };
        self.actual = at;
        self.compensation = Some(Compensation::new(side, self.modes.plane, at));
        Ok(())
    }

    /// G40.
    pub(crate) fn finish_compensation(&mut self) -> Result<(), NcProblem> {
        if let Some(compensation) = self.compensation.take() {
            self.straight_next =
                compensation.side.radius > 0.0 && Some(compensation.current()) != self.known_position();
            self.emit_all(compensation.finish())?;
        }
        Ok(())
    }
}
