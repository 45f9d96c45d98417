//! Circular pockets of Haas (`G12`, `G13`) and the moves of `G45` to `G48`.

use crate::gcode::codes::MotionMode;
use crate::gcode::run::interpreter::Reader;
use crate::gcode::syntax::block::Block;
use crate::model::read_options::Controller;
use crate::text::error::NcProblem;

/// The most circles of a pocket.
const MOST_CIRCLES: f64 = 1e5;

impl Reader {
    /// `G12` and `G13`: a pocket about the current point, or X and Y, down to Z.
    ///
    /// Source: Haas, *Mill Series Operator's Manual* (96-8000), G12 and G13 with *Circular Pocket Milling*: `I` is the radius of the first circle, or of the
    /// only one; `K` that of the last, `Q` the step between; `D` the tool's size, which all circles are smaller by. With `L` in `G91`, all is repeated at one more Z below. How
    /// the tool goes from the centre to a circle, from one to the next, and back, is in a figure only: on semicircles towards +X here, which is a note.
    pub(crate) fn circular_pocket(&mut self, counter_clockwise: bool, block: &Block) -> Result<(), NcProblem> {
        let name = if counter_clockwise { "G13" } else { "G12" };
        if !matches!(self.rules.controller, None | Some(Controller::Haas)) {
            return Err(NcProblem::unsupported(
                format!("{name} is"),
                "it is a circular pocket on Haas only; expected --controller haas",
            ));
        }
        self.refuse_compensation("a circular pocket")?;
        if self.modes.plane != [0, 1, 2] {
            return Err(NcProblem::unsupported(
                format!("{name} outside of the plane XY is"),
                "expected G17",
            ));
        }
        if let Some(word) = block.first("ABCJPR") {
            return Err(NcProblem::syntax(format!(
                "{} in {name}: expected X, Y, Z, I, K, Q, D, L and F",
                word.letter
            )));
        }
        let unit = self.unit();
        let length = |letter| block.get(letter).map(|value| value * unit);
        let Some(first) = length('I') else {
            return Err(NcProblem::syntax(format!(
                "{name} without I: expected the radius of the first circle"
            )));
        };
        let radius = match block.get('D') {
            Some(0.0) => 0.0,
            d => self.cutter_diameter(d)? / 2.0,
        };
        let circles = match (length('K'), length('Q')) {
            (None, _) => vec![first],
            (Some(_), None) => {
                return Err(NcProblem::syntax(format!(
                    "K without Q in {name}: expected the step between circles"
                )));
            }
            (Some(last), Some(step)) if step > 0.0 && last > first => {
                let count = ((last - first) / step - 1e-9).ceil();
                if count > MOST_CIRCLES {
                    return Err(NcProblem::value("the number of circles", count, "at most 100000"));
                }
                let between = (0..count as usize).map(|k| first + k as f64 * step);
                between.chain([last]).collect()
            }
            (Some(last), Some(_)) => {
                return Err(NcProblem::value(
                    format!("K of {name}"),
                    last / unit,
                    "greater than I, with Q above 0",
                ));
            }
        };
        if let Some(small) = circles.iter().find(|circle| !(**circle > radius)) {
            return Err(NcProblem::value(
                format!("I of {name}"),
                small / unit,
                format!("greater than the tool's radius, {}", radius / unit),
            ));
        }
        let repeats = block.get('L').unwrap_or(1.0);
        let expected = "a whole number from 1 on";
        let repeats = NcProblem::whole("L, the number of repeats", repeats, 1..=10_000, expected)?;
        if repeats > 1 && self.modes.absolute {
            return Err(NcProblem::syntax(format!(
                "L of {name} in G90: expected G91, where each repeat goes down by Z"
            )));
        }
        self.go_by(MotionMode::Rapid, block, ['X', 'Y', ' '])?;
        let motion = self.modes.motion;
        self.track.note(format!(
            "{name}: the tool goes to its circles and back on semicircles towards +X: the control may choose others"
        ));
        for _ in 0..repeats {
            self.go_by(MotionMode::Feed, block, [' ', ' ', 'Z'])?;
            self.track.circles(&circles, radius, counter_clockwise)?;
        }
        self.modes.motion = motion;
        Ok(())
    }

    /// A straight move by these words alone.
    fn go_by(&mut self, motion: MotionMode, block: &Block, letters: [char; 3]) -> Result<(), NcProblem> {
        let mut some = Block::default();
        for word in block.words().iter().filter(|word| letters.contains(&word.letter)) {
            some.push(*word).map_err(|(problem, _)| problem)?;
        }
        if some.is_empty() {
            Ok(())
        } else {
            self.go(motion, &some)
        }
    }

    /// `G45` to `G48`: the way of each axis of the block is longer or shorter by an offset, or by twice that.
    ///
    /// Sources: *SZGH-CNC1000MDb*, 3.25, after Fanuc's; Mitsubishi *M700V*, 12.6: the offset has the sign of the axis's way; without a way, `G91 X0` moves by the
    /// offset and `G91 X-0` against it, and `G90` moves nothing.
    pub(crate) fn stretch(&mut self, code: u32, block: &Block) -> Result<(), NcProblem> {
        let name = format!("G{code}");
        self.refuse_compensation(&name)?;
        let Some(motion @ (MotionMode::Rapid | MotionMode::Feed)) = self.modes.motion else {
            return Err(NcProblem::unsupported(
                format!("{name} outside of straight moves is"),
                "expected G0 or G1 with it",
            ));
        };
        if let Some(word) = block.first("ABCIJKR") {
            return Err(NcProblem::unsupported(
                format!("{} with {name} is", word.letter),
                "expected X, Y, Z",
            ));
        }
        if self.modes.absolute && self.pending.stretched {
            return Err(NcProblem::unsupported(
                format!("{name} right after another such move in G90 is"),
                "controls disagree on where its way begins; expected G91",
            ));
        }
        if self.modes.polar {
            return Err(NcProblem::syntax(format!(
                "{name} in polar coordinates: expected G15 before it"
            )));
        }
        let offset = match block.get('H') {
            Some(h) => {
                let number = Self::tool_number(h)?;
                match self.tools.get(number) {
                    Some(row) => row.offset[2],
                    None => {
                        return Err(NcProblem::syntax(format!(
                            "the offset H{number} is not known: expected it in the tool table"
                        )));
                    }
                }
            }
            None => self.cutter_diameter(block.get('D'))? / 2.0,
        };
        let offset = match code {
            45 => offset,
            46 => -offset,
            47 => 2.0 * offset,
            _ => -2.0 * offset,
        };
        let words = self.lengths(block, ['X', 'Y', 'Z']);
        let mut end = match self.track.known() {
            Some(here) => here,
            None if self.seen.uncertain => return Ok(()),
            None => {
                return Err(NcProblem::syntax(format!(
                    "{name} from an unknown position: expected a move to X, Y and Z before it"
                )));
            }
        };
        for k in 0..3 {
            let Some(word) = words[k] else { continue };
            let way = if self.modes.absolute { word - end[k] } else { word };
            if way != 0.0 || !self.modes.absolute {
                end[k] += way + if way.is_sign_negative() { -offset } else { offset };
            }
        }
        let rapid = motion == MotionMode::Rapid;
        self.give(self.stroke_to(end, self.track.abc, rapid))?;
        self.pending.stretched = true;
        Ok(())
    }
}
