//! The moves of a block.

use crate::drive::CircularArc;
use crate::drive::{Bend, Stroke};
use crate::gcode::codes::MotionMode;
use crate::gcode::run::interpreter::Reader;
use crate::gcode::syntax::block::{Block, Word};
use crate::gcode::syntax::expression::Variables;
use crate::machines::WorkFrame;
use crate::model::program::FeedMode;
use crate::text::assumption::Assumption;
use crate::text::error::NcProblem;

impl Reader {
    /// The rotary angles at the end of a block.
    fn angles(&self, block: &Block) -> [f64; 3] {
        let mut abc = self.track.abc;
        for (angle, letter) in abc.iter_mut().zip(['A', 'B', 'C']) {
            if let Some(value) = block.get(letter) {
                *angle = if self.modes.absolute { value } else { *angle + value };
            }
        }
        abc
    }

    /// G53: a move in machine coordinates. Unless those are known, its end in the part's frame is not.
    pub(crate) fn go_in_machine_coordinates(&mut self, motion: MotionMode, block: &Block) -> Result<(), NcProblem> {
        self.refuse_compensation("a move in machine coordinates")?;
        if !matches!(motion, MotionMode::Rapid | MotionMode::Feed) {
            return Err(NcProblem::syntax("G53 with an arc or a cycle: expected G0 or G1"));
        }
        let words = self.lengths(block, ['X', 'Y', 'Z']);
        let [x, y, z] = words;
        let [a, b, c] = ['A', 'B', 'C'].map(|letter| block.get(letter));
        if self
            .track
            .go_to_machine([x, y, z, a, b, c], motion == MotionMode::Rapid)?
        {
            return Ok(());
        }
        if self.offsets.knows_machine()
            && let [x, y, z] = self.control_position()
            && let [Some(x), Some(y), Some(z)] = [words[0].or(x), words[1].or(y), words[2].or(z)]
        {
            self.track.use_offset(&mut self.offsets.work)?;
            return self.go_to_control([x, y, z], motion == MotionMode::Rapid);
        }
        self.track
            .note("moves in machine coordinates are left out: the path breaks here");
        self.track.abc = self.angles(block);
        self.track.leave(words.map(|word| word.is_some()));
        Ok(())
    }

    /// A straight move of the control's point.
    pub(crate) fn go_to_control(&mut self, control: [f64; 3], rapid: bool) -> Result<(), NcProblem> {
        let Some(inverse) = self.frame_map().inverse() else {
            return Ok(());
        };
        let end = inverse.point(std::array::from_fn(|k| control[k] - self.tools.length.offset[k]));
        self.give(self.stroke_to(end, self.track.abc, rapid))
    }

    pub(crate) fn stroke_to(&self, end: [f64; 3], abc: [f64; 3], rapid: bool) -> Stroke {
        self.track.stroke(end, abc, rapid, None, self.modes.plane)
    }

    /// X and Y of G16 are a radius and an angle, of which each stays until it is given again (Fanuc B-63944EN, *Polar coordinate command*).
    pub(crate) fn polar(&mut self, words: [Option<f64>; 3]) -> Result<[Option<f64>; 3], NcProblem> {
        let [u, v, _] = self.modes.plane;
        if !self.modes.polar || (words[u].is_none() && words[v].is_none()) {
            return Ok(words);
        }
        if !self.modes.absolute {
            return Err(NcProblem::unsupported(
                "incremental polar coordinates are",
                "expected G90 with G16",
            ));
        }
        let [radius, angle] = self.modes.polar_words;
        let given = [words[u].or(radius), words[v].or(angle)];
        let [Some(radius), Some(angle)] = given else {
            return Err(NcProblem::syntax(
                "polar coordinates without both radius and angle: expected both in the first block of G16",
            ));
        };
        self.modes.polar_words = given;
        // Angles are degrees, whatever the unit of lengths is.
        let (sin, cos) = (angle / self.unit()).to_radians().sin_cos();
        let mut found = words;
        found[u] = Some(radius * cos);
        found[v] = Some(radius * sin);
        Ok(found)
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
        let unknown = self.track.known().is_none();
        if unknown && (cuts || !self.modes.absolute) {
            for k in (0..3).filter(|&k| self.track.xyz[k].is_none() && !self.seen.uncertain) {
                self.offsets.know(k)?;
            }
            let relative = !self.modes.absolute || matches!(motion, MotionMode::Arc { .. });
            // A rapid needs no more than the axes that it names.
            let needed = |k: usize| match cuts {
                true => words[k].is_none() || relative,
                false => words[k].is_some(),
            };
            // Nothing is assumed about a position that an earlier problem has made unknown.
            if self.seen.uncertain || !self.track.complete(needed) {
                for k in 0..3 {
                    if let Some(word) = words[k] {
                        self.track.xyz[k] = self.modes.absolute.then_some(word);
                    }
                }
                self.track.abc = abc;
                if self.seen.uncertain && self.rules.lenient {
                    self.track
                        .note("left out: a move after a problem, until its start is known again");
                }
                return Ok(());
            }
        }
        let mut to = self.track.xyz;
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
        let to = self.along_angle(block, to)?;
        if self.modes.tilt.is_none() && *self.track.frame() != WorkFrame::default() {
            self.track.note(if self.offsets.work.is_given() {
                "the place that is given for the work offset is applied"
            } else if self.offsets.made_by_shift() || !self.offsets.work.is_placed() {
                "work offsets set by the program are applied"
            } else {
                "work offsets set by the program are applied: poses are in machine coordinates"
            });
        }
        let [Some(x), Some(y), Some(z)] = to else {
            // A rapid towards the first known position.
            self.track.xyz = to;
            self.track.abc = abc;
            return Ok(());
        };
        let end = [x, y, z];
        self.track.places.named = Some(words.map(|word| word.is_some()));
        if !matches!(motion, MotionMode::Curve { .. }) {
            self.modes.curve_tangent = None;
        }
        let mut stroke = self.stroke_to(end, abc, !cuts);
        if matches!(motion, MotionMode::Thread | MotionMode::RigidTap) {
            stroke.feed = Some(self.pitch(motion, block)? * (self.unit() / self.program_unit()));
            stroke.feed_mode = FeedMode::PerRevolution;
        }
        match (motion, self.track.known()) {
            (MotionMode::Arc { counter_clockwise }, Some(start)) => {
                if self.track.starts_beside() {
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
            (MotionMode::Curve { cubic }, Some(start)) => return self.curve(cubic, start, stroke, block),
            (MotionMode::RigidTap, Some(start)) => {
                self.give(stroke)?;
                return self.give(Stroke { end: start, ..stroke });
            }
            (MotionMode::Thread, _) => {}
            _ if !vector && Self::has_spare_centre(block) => {
                return Err(NcProblem::syntax(
                    "I, J, K or R outside an arc: expected G2 or G3 with them",
                ));
            }
            _ => {}
        }
        self.corner_at_end(block)?;
        self.give(stroke)
    }

    /// The way in one revolution: `K`, or on Fanuc and Haas `F`.
    fn pitch(&mut self, motion: MotionMode, block: &Block) -> Result<f64, NcProblem> {
        let fanuc = self.fanuc();
        if let Some(word) = block.first("IJR").filter(|_| motion == MotionMode::Thread) {
            return Err(NcProblem::unsupported(
                format!("{} in a thread is", word.letter),
                "expected a straight move and its pitch K",
            ));
        }
        let given = block.get('K').or(if fanuc {
            block.get('F').or(self.modes.feed)
        } else {
            None
        });
        self.modes.pitch = given.or(self.modes.pitch);
        match self.modes.pitch {
            Some(pitch) if pitch > 0.0 => Ok(pitch),
            Some(pitch) => Err(NcProblem::value("the pitch of a thread", pitch, "a positive number")),
            None => Err(NcProblem::syntax(if fanuc {
                "a thread without its pitch: expected F, the way in one revolution"
            } else {
                "a thread without its pitch: expected K, the way in one revolution"
            })),
        }
    }

    /// Whether a straight move has words of an arc.
    fn has_spare_centre(block: &Block) -> bool {
        // M codes have words of their own.
        let other = |w: &Word| w.letter == 'G' && w.value == 28.0;
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
        NcProblem::whole("the number of turns P", turns, 1..=10_000, "a whole number from 1 on")?;
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
                if self.modes.absolute_centres && !self.seen.centres {
                    let what = "the centres of arcs (I, J, K)";
                    let taken = "absolute coordinates: taken from the start of each arc, some have no radius";
                    self.track
                        .assume(Assumption::new(what, taken, "G90.1 or G91.1 in the program"));
                }
                let arc = CircularArc::about(ends, plane, centre, counter_clockwise, turns);
                self.seen.odd_arcs |= arc.is_err() && !self.seen.centres;
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
}
