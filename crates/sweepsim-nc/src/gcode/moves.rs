//! The moves of a block.

use super::arc::CircularArc;
use super::codes::{Code, MotionMode};
use super::interpreter::{Reader, Values};
use super::state::MoveEnd;
use crate::text::error::NcProblem;

/// Millimetres per inch.
const INCH: f64 = 25.4;

/// Whether a block has a rotary word other than 0.
fn turns(values: &Values) -> bool {
    ['A', 'B', 'C']
        .into_iter()
        .any(|letter| values.get(letter).is_some_and(|value| value != 0.0))
}

impl Reader {
    fn unit(&self) -> f64 {
        if self.modes.inch { INCH } else { 1.0 }
    }

    /// X, Y, Z in millimetres, as written.
    fn lengths(&self, values: &Values, letters: [char; 3]) -> [Option<f64>; 3] {
        letters.map(|letter| values.get(letter).map(|value| value * self.unit()))
    }

    /// The rotary angles at the end of a block.
    fn angles(&self, values: &Values) -> [f64; 3] {
        let mut abc = self.state.abc;
        for (angle, letter) in abc.iter_mut().zip(['A', 'B', 'C']) {
            if let Some(value) = values.get(letter) {
                *angle = if self.modes.absolute { value } else { *angle + value };
            }
        }
        abc
    }

    /// A move in machine coordinates: its end in the part's frame is unknown.
    pub(super) fn leave_frame(&mut self, values: &Values, line: usize) {
        self.state
            .notes
            .add(line, "moves in machine coordinates are left out: the path breaks here");
        for (coordinate, letter) in self.state.xyz.iter_mut().zip(['X', 'Y', 'Z']) {
            if values.get(letter).is_some() {
                *coordinate = None;
            }
        }
        self.state.abc = self.angles(values);
        self.state.leave();
    }

    pub(super) fn act(&mut self, code: Code, values: &Values, line: usize) -> Result<(), NcProblem> {
        let words = self.lengths(values, ['X', 'Y', 'Z']);
        let here_unknown = (0..3).any(|k| words[k].is_some() && self.state.xyz[k].is_none());
        match code {
            // An earlier problem has made the position unknown; see `Reader::go_on`.
            Code::SetOffsets | Code::ShiftHere if self.uncertain && here_unknown => {}
            Code::RestoreShift if self.uncertain => {}
            Code::Home => {
                let any = values.first("XYZABC").is_some();
                for k in 0..3 {
                    if !any || words[k].is_some() {
                        self.state.xyz[k] = None;
                    }
                }
                for (angle, letter) in self.state.abc.iter_mut().zip(['A', 'B', 'C']) {
                    if !any || values.get(letter).is_some() {
                        *angle = 0.0;
                    }
                }
                self.state
                    .notes
                    .add(line, "moves to the machine's home are left out: the path breaks here");
                self.state.leave();
            }
            Code::SetOffsets => {
                let index = values.get('P').unwrap_or(0.0);
                match values.get('L') {
                    // Of L1, L10 and L11 it is a tool's radius.
                    Some(2.0 | 20.0) if values.get('R').is_some_and(|r| r != 0.0) => {
                        return Err(NcProblem::unsupported("work offsets that turn are", "expected X, Y, Z"));
                    }
                    Some(2.0) => {
                        if turns(values) {
                            return Err(NcProblem::unsupported("work offsets that turn are", "expected X, Y, Z"));
                        }
                        self.offsets.set(index, words)?;
                    }
                    Some(20.0) => {
                        self.check_angles(values, "G10 L20")?;
                        self.offsets.set_here(index, words, self.state.xyz)?;
                    }
                    _ => self.state.notes.add(line, "G10 other than L2 and L20 is ignored"),
                }
            }
            Code::LocalShift => {
                if turns(values) {
                    return Err(NcProblem::unsupported("work offsets that turn are", "expected X, Y, Z"));
                }
                self.offsets.set_local(words);
            }
            Code::ShiftHere => {
                self.check_angles(values, "G92")?;
                let fresh = !self.state.has_moved();
                let before = self.state.xyz;
                self.offsets.shift_here(words, &mut self.state.xyz, fresh)?;
                if self.state.xyz != before {
                    self.state.notes.add(
                        line,
                        "G92 before the first move: the tool is taken to be there, in the part's frame",
                    );
                }
            }
            Code::CancelShift { forget } => {
                if let Some(word) = values.first("XYZABC").filter(|word| !forget || word.value != 0.0) {
                    return Err(NcProblem::syntax(format!(
                        "{}{} next to a code that ends a G92: expected none{}",
                        word.letter,
                        word.value,
                        if forget { ", or 0" } else { "" }
                    )));
                }
                // Fanuc names the axes: G92.1 X0.
                let any = values.first("XYZABC").is_some();
                let axes = words.map(|word| !any || word.is_some());
                let fresh = !self.state.has_moved();
                self.offsets.cancel_shift(forget, axes, &mut self.state.xyz, fresh);
            }
            Code::RestoreShift => {
                if let Some(word) = values.first("XYZABC") {
                    return Err(NcProblem::syntax(format!(
                        "{} next to G92.3: expected none",
                        word.letter
                    )));
                }
                self.offsets.restore_shift()?;
            }
            _ => {}
        }
        Ok(())
    }

    /// Rotary words of a code that sets coordinates: allowed where they change nothing.
    fn check_angles(&self, values: &Values, code: &str) -> Result<(), NcProblem> {
        for (angle, letter) in self.state.abc.into_iter().zip(['A', 'B', 'C']) {
            if values.get(letter).is_some_and(|value| value != angle) {
                return Err(NcProblem::unsupported(
                    format!("{code} with {letter} other than the current {angle} degrees is"),
                    "expected X, Y, Z",
                ));
            }
        }
        Ok(())
    }

    /// A move in the part's frame.
    pub(super) fn go(&mut self, motion: MotionMode, values: &Values, line: usize) -> Result<(), NcProblem> {
        let words = self.lengths(values, ['X', 'Y', 'Z']);
        let abc = self.angles(values);
        let cuts = motion != MotionMode::Rapid;
        if self.uncertain && self.state.known().is_none() && (cuts || !self.modes.absolute) {
            // Nothing is assumed about a position that an earlier problem has made unknown.
            for k in 0..3 {
                if let Some(word) = words[k] {
                    self.state.xyz[k] = self.modes.absolute.then(|| word + self.offsets.total()[k]);
                }
            }
            self.state.abc = abc;
            return Ok(());
        }
        if cuts || !self.modes.absolute {
            for k in (0..3).filter(|&k| self.state.xyz[k].is_none()) {
                self.offsets.know(k)?;
            }
            let relative = !self.modes.absolute || matches!(motion, MotionMode::Arc { .. });
            self.state.assume(line, |k| words[k].is_none() || relative);
        }
        let mut xyz = self.state.xyz;
        for k in 0..3 {
            if let Some(word) = words[k] {
                xyz[k] = Some(match xyz[k] {
                    Some(now) if !self.modes.absolute => now + word,
                    _ => {
                        self.offsets.know(k)?;
                        word + self.offsets.total()[k]
                    }
                });
            }
        }
        if self.offsets.total() != [0.0; 3] {
            self.state.notes.add(
                line,
                if self.offsets.made_by_shift() {
                    "work offsets set by the program are applied"
                } else {
                    "work offsets set by the program are applied: poses are in machine coordinates"
                },
            );
        }
        let [Some(x), Some(y), Some(z)] = xyz else {
            // A rapid towards the first known position.
            self.state.xyz = xyz;
            self.state.abc = abc;
            return Ok(());
        };
        let target = MoveEnd { xyz: [x, y, z], abc };
        if cuts {
            if self.state.known().is_none() {
                self.state.notes.add(
                    line,
                    "the start of this feed move is unknown: the path begins at its end",
                );
            }
            self.state.start_here(line)?;
        }
        match (motion, self.state.known()) {
            (MotionMode::Arc { counter_clockwise }, Some(start)) => {
                self.arc(counter_clockwise, start, target, values, line)
            }
            _ if values.first("IJKR").is_some() => Err(NcProblem::syntax(
                "I, J, K or R outside an arc: expected G2 or G3 with them",
            )),
            _ => self.state.line_to(target, !cuts, line),
        }
    }

    fn arc(
        &mut self,
        counter_clockwise: bool,
        start: [f64; 3],
        target: MoveEnd,
        values: &Values,
        line: usize,
    ) -> Result<(), NcProblem> {
        let turns = values.get('P').unwrap_or(1.0);
        if turns.fract() != 0.0 || !(1.0..=1e4).contains(&turns) {
            return Err(NcProblem::value(
                "the number of turns P",
                turns,
                "a whole number from 1 on",
            ));
        }
        if let Some(word) = values
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
        let offsets = self.lengths(values, ['I', 'J', 'K']);
        let ends = (start, target.xyz);
        let arc = match values.get('R') {
            Some(_) if offsets.iter().any(Option::is_some) => {
                return Err(NcProblem::syntax(
                    "an arc with both R and a centre: expected R, or I, J, K",
                ));
            }
            Some(radius) => CircularArc::with_radius(ends, plane, radius * self.unit(), counter_clockwise, turns),
            None => {
                let total = self.offsets.total();
                let centre = match (self.modes.absolute_centres, offsets[u], offsets[v]) {
                    (true, Some(cu), Some(cv)) => {
                        self.offsets.know(u)?;
                        self.offsets.know(v)?;
                        [cu + total[u], cv + total[v]]
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
                match (arc, offsets[w].filter(|offset| *offset != 0.0)) {
                    (Ok(arc), Some(height)) => {
                        let absolute = self.modes.absolute_centres.then_some(height + total[w]);
                        arc.check_third(height, absolute).map(|()| arc)
                    }
                    (arc, _) => arc,
                }
            }
        }
        .map_err(NcProblem::syntax)?;
        if self.exact_arcs {
            let exact = arc.exact().map_err(|error| NcProblem::syntax(error.to_string()))?;
            return self.state.arc_to(target, exact, line);
        }
        let chords = arc.chords(self.arc_tolerance).map_err(NcProblem::syntax)?;
        self.state.notes.add(
            line,
            format!("arcs are divided into chords within {} mm", self.arc_tolerance),
        );
        let from = self.state.abc;
        for chord in 1..=chords {
            let s = chord as f64 / chords as f64;
            let abc = std::array::from_fn(|k| {
                if chord == chords {
                    target.abc[k]
                } else {
                    from[k] + s * (target.abc[k] - from[k])
                }
            });
            self.state.line_to(MoveEnd { xyz: arc.at(s), abc }, false, line)?;
        }
        Ok(())
    }
}
