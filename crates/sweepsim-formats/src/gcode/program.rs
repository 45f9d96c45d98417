//! Block by block: what each word of a program does to the [`Machine`].

use std::ops::Range;

use super::Options;
use super::arc::{Arc, Plane};
use super::codes::{self, Code, Misc, Motion};
use super::lexer::{self, Located, Word};
use super::machine::{Machine, Target};
use super::offsets::Offsets;
use crate::error::{FormatError, Problem};
use crate::program::Program;
use crate::text;

/// Millimetres of an inch.
const INCH: f64 = 25.4;

pub(super) fn read(text: &str, options: &Options) -> Result<Program, FormatError> {
    if !(options.arc_tolerance > 0.0 && options.arc_tolerance.is_finite()) {
        let problem = Problem::value("the arc tolerance", options.arc_tolerance, "a positive number of mm");
        return Err(FormatError::new(problem, None));
    }
    let mut reader = Reader {
        machine: Machine::new(options),
        modes: Modes {
            motion: None,
            plane: [0, 1, 2],
            absolute: true,
            absolute_centres: false,
            inch: options.inch,
        },
        offsets: Offsets::default(),
        arc_tolerance: options.arc_tolerance,
        selected_tool: None,
        kinematics: options.tip_control,
        length_control: false,
        begun: false,
        ended: false,
    };
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        reader.line(line, number).map_err(|(problem, span)| {
            let column = 1 + line[..span.start].chars().count();
            let width = line[span].chars().count();
            FormatError::new(problem, Some(text::place_in_line(number, line, column, width)))
        })?;
        if reader.ended {
            break;
        }
    }
    if !reader.machine.has_moved() {
        let line = text.lines().count().max(1);
        let problem = Problem::syntax("there is no move in this program: expected at least one with X, Y and Z known");
        return Err(FormatError::new(problem, Some(text::place_in_line(line, "", 1, 1))));
    }
    Ok(reader.machine.finish())
}

/// What holds until another word says otherwise.
struct Modes {
    motion: Option<Motion>,
    plane: Plane,
    absolute: bool,
    absolute_centres: bool,
    inch: bool,
}

struct Reader {
    machine: Machine,
    modes: Modes,
    offsets: Offsets,
    arc_tolerance: f64,
    /// By a T word, not yet in the spindle.
    selected_tool: Option<u32>,
    /// Tip control by the machine's kinematics (M428),
    kinematics: bool,
    /// or by the length offset (G43.4).
    length_control: bool,
    begun: bool,
    ended: bool,
}

/// The words of a block with a number for each letter.
struct Values<'a>(&'a [Word]);

impl Values<'_> {
    fn get(&self, letter: char) -> Option<f64> {
        self.0.iter().find(|word| word.letter == letter).map(|word| word.value)
    }

    fn span(&self, letter: char) -> Range<usize> {
        self.0
            .iter()
            .find(|word| word.letter == letter)
            .map_or(0..0, |word| word.span.clone())
    }

    fn first(&self, letters: &str) -> Option<&Word> {
        self.0.iter().find(|word| letters.contains(word.letter))
    }

    /// From the first word to the last.
    fn all(&self) -> Range<usize> {
        match (self.0.first(), self.0.last()) {
            (Some(first), Some(last)) => first.span.start..last.span.end,
            _ => 0..0,
        }
    }
}

/// The letter as it appears in a message: `G5.1`, `M98`.
fn code_name(word: &Word) -> String {
    format!("{}{}", word.letter, word.value)
}

impl Reader {
    fn line(&mut self, line: &str, number: usize) -> Result<(), Located> {
        let block = lexer::block(line)?;
        if block.tape {
            self.ended = self.begun;
            return Ok(());
        }
        if block.optional && !block.words.is_empty() {
            self.machine
                .notes
                .add(number, "optional blocks (`/`) are read as all others");
        }
        if !block.words.is_empty() {
            self.begun = true;
            self.block(&Values(&block.words), number)?;
        }
        Ok(())
    }

    fn block(&mut self, values: &Values, line: usize) -> Result<(), Located> {
        self.check_letters(values, line)?;
        let mut action: Option<(Code, Range<usize>)> = None;
        let mut machine_coordinates = false;
        let mut motion_words = 0;
        for word in values.0.iter().filter(|word| word.letter == 'G') {
            let fail = |problem| Err((problem, word.span.clone()));
            match codes::g(word.value) {
                Code::Motion(motion) => {
                    self.modes.motion = Some(motion);
                    motion_words += 1;
                    if motion_words > 1 {
                        return fail(Problem::syntax(
                            "a second motion code in one block: expected one of G0 G1 G2 G3",
                        ));
                    }
                }
                Code::CancelMotion => self.modes.motion = None,
                Code::Plane(plane) => self.modes.plane = plane,
                Code::Inch(inch) => self.modes.inch = inch,
                Code::Absolute(absolute) => self.modes.absolute = absolute,
                Code::AbsoluteCentres(absolute) => self.modes.absolute_centres = absolute,
                Code::TipControl(on) => self.length_control = on,
                Code::LengthOffset => self.length_control = false,
                Code::WorkOffset(index) => self.offsets.active = index,
                Code::MachineCoordinates => machine_coordinates = true,
                code @ (Code::Dwell
                | Code::Home
                | Code::SetOffsets
                | Code::LocalShift
                | Code::ShiftHere
                | Code::CancelShift { .. }
                | Code::RestoreShift) => {
                    if action.replace((code, word.span.clone())).is_some() {
                        return fail(Problem::syntax(format!(
                            "{} beside another code that takes the coordinates: expected one of them in a block",
                            code_name(word)
                        )));
                    }
                }
                Code::Harmless => {}
                Code::Refused(what) => {
                    return fail(Problem::unsupported(
                        format!("{}: {what}", code_name(word)),
                        "the tool's way would not be known; expected G0 G1 G2 G3",
                    ));
                }
                Code::Unknown => {
                    return fail(Problem::unsupported(
                        format!("{} is", code_name(word)),
                        "it could change the tool's way; expected a code of RS-274",
                    ));
                }
            }
        }
        let ends = self.misc(values, line)?;
        self.machine.tip_control = self.kinematics || self.length_control;
        let whole = |problem| (problem, values.all());
        match action {
            Some((Code::Dwell, _)) => {}
            Some((code, span)) => self.act(code, values, line).map_err(|problem| (problem, span))?,
            None => match (values.first("XYZABCIJKR"), self.modes.motion) {
                (None, _) => {}
                (Some(word), None) => {
                    let problem = Problem::syntax(format!(
                        "{} without a motion code: expected G0, G1, G2 or G3 here or before",
                        word.letter
                    ));
                    return Err((problem, word.span.clone()));
                }
                (Some(_), Some(motion)) => {
                    if machine_coordinates {
                        self.leave_frame(values, line);
                    } else {
                        self.offsets.use_active().map_err(whole)?;
                        self.go(motion, values, line).map_err(whole)?;
                    }
                }
            },
        }
        self.ended = ends;
        Ok(())
    }

    /// Letters at most once, and none that moves the tool in a way not known here.
    fn check_letters(&mut self, values: &Values, line: usize) -> Result<(), Located> {
        for (index, word) in values.0.iter().enumerate() {
            let fail = |problem| Err((problem, word.span.clone()));
            match word.letter {
                'G' | 'M' => continue,
                'N' | 'A' | 'B' | 'C' | 'X' | 'Y' | 'Z' | 'I' | 'J' | 'K' | 'R' | 'F' | 'S' | 'T' | 'P' | 'Q' | 'L'
                | 'H' | 'D' => {}
                'U' | 'V' | 'W' => {
                    return fail(Problem::unsupported(
                        format!("the axis {} is", word.letter),
                        "expected X Y Z A B C",
                    ));
                }
                'E' if values
                    .0
                    .iter()
                    .any(|w| w.letter == 'M' && (62.0..=68.0).contains(&w.value)) => {}
                'E' => {
                    return fail(Problem::unsupported(
                        "E words are",
                        "it could be an exponent or an extruder; expected numbers without exponent",
                    ));
                }
                'O' => {
                    let alone = values.0.iter().all(|w| matches!(w.letter, 'O' | 'N'));
                    if !alone || self.machine.has_moved() {
                        return fail(Problem::unsupported(
                            "O-words (subroutines, loops) are",
                            "expected a program without them",
                        ));
                    }
                    self.machine.notes.add(line, "program number: ignored");
                }
                letter => self
                    .machine
                    .notes
                    .add(line, format!("{letter} words are not understood: ignored")),
            }
            if values.0[..index].iter().any(|before| before.letter == word.letter) {
                return fail(Problem::syntax(format!(
                    "a second {} in one block: expected one",
                    word.letter
                )));
            }
        }
        Ok(())
    }

    /// F, T and M words. Says whether the program ends.
    fn misc(&mut self, values: &Values, line: usize) -> Result<bool, Located> {
        if let Some(feed) = values.get('F') {
            self.machine.feed = Some(feed);
        }
        let number = |letter, value: f64| {
            if value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value) {
                Ok(value as u32)
            } else {
                Err((
                    Problem::value("a tool number", value, "a whole number"),
                    values.span(letter),
                ))
            }
        };
        if let Some(tool) = values.get('T') {
            let tool = number('T', tool)?;
            self.selected_tool = Some(tool);
            // Programs without a tool change name their tool by the T word alone.
            self.machine.tool.get_or_insert(tool);
        }
        let mut ends = false;
        for word in values.0.iter().filter(|word| word.letter == 'M') {
            match codes::m(word.value) {
                Misc::Harmless => {}
                Misc::End => ends = true,
                Misc::ToolChange => self.change_tool(self.selected_tool),
                Misc::SetTool => {
                    let tool = values.get('Q').map(|tool| number('Q', tool)).transpose()?;
                    self.change_tool(tool);
                }
                Misc::TipControl(on) => self.kinematics = on,
                Misc::Refused => {
                    let what = format!("{} (subroutines) is", code_name(word));
                    let problem = Problem::unsupported(what, "expected a program without calls");
                    return Err((problem, word.span.clone()));
                }
                Misc::Unknown => self
                    .machine
                    .notes
                    .add(line, format!("{} is not understood: ignored", code_name(word))),
            }
        }
        Ok(ends)
    }

    /// Another tool goes on from where the machine stands, on a path of its own.
    fn change_tool(&mut self, tool: Option<u32>) {
        if tool.is_some() && tool != self.machine.tool {
            self.machine.tool = tool;
            self.machine.leave();
        }
    }

    fn unit(&self) -> f64 {
        if self.modes.inch { INCH } else { 1.0 }
    }

    /// X, Y, Z in millimetres, as written.
    fn lengths(&self, values: &Values, letters: [char; 3]) -> [Option<f64>; 3] {
        letters.map(|letter| values.get(letter).map(|value| value * self.unit()))
    }

    /// The angles that a block goes to.
    fn angles(&self, values: &Values) -> [f64; 3] {
        let mut abc = self.machine.abc;
        for (angle, letter) in abc.iter_mut().zip(['A', 'B', 'C']) {
            if let Some(value) = values.get(letter) {
                *angle = if self.modes.absolute { value } else { *angle + value };
            }
        }
        abc
    }

    /// A move in machine coordinates: where it ends in the part's frame is not known.
    fn leave_frame(&mut self, values: &Values, line: usize) {
        self.machine
            .notes
            .add(line, "moves in machine coordinates are left out: the path breaks here");
        for (coordinate, letter) in self.machine.xyz.iter_mut().zip(['X', 'Y', 'Z']) {
            if values.get(letter).is_some() {
                *coordinate = None;
            }
        }
        self.machine.abc = self.angles(values);
        self.machine.leave();
    }

    fn act(&mut self, code: Code, values: &Values, line: usize) -> Result<(), Problem> {
        let words = self.lengths(values, ['X', 'Y', 'Z']);
        match code {
            Code::Home => {
                let any = values.first("XYZABC").is_some();
                for k in 0..3 {
                    if !any || words[k].is_some() {
                        self.machine.xyz[k] = None;
                    }
                }
                for (angle, letter) in self.machine.abc.iter_mut().zip(['A', 'B', 'C']) {
                    if !any || values.get(letter).is_some() {
                        *angle = 0.0;
                    }
                }
                self.machine
                    .notes
                    .add(line, "moves to the machine's home are left out: the path breaks here");
                self.machine.leave();
            }
            Code::SetOffsets => {
                if values.get('R').is_some_and(|r| r != 0.0) || values.first("ABC").is_some_and(|w| w.value != 0.0) {
                    return Err(Problem::unsupported("work offsets that turn are", "expected X, Y, Z"));
                }
                let index = values.get('P').unwrap_or(0.0);
                match values.get('L') {
                    Some(2.0) => self.offsets.set(index, words)?,
                    Some(20.0) => self.offsets.set_here(index, words, self.machine.xyz)?,
                    _ => self.machine.notes.add(line, "G10 other than L2 and L20 is ignored"),
                }
            }
            Code::LocalShift => self.offsets.set_local(words),
            Code::ShiftHere => self.offsets.shift_here(words, self.machine.xyz)?,
            Code::CancelShift { forget } => self.offsets.cancel_shift(forget),
            Code::RestoreShift => self.offsets.restore_shift(),
            _ => {}
        }
        Ok(())
    }

    /// A move in the part's frame.
    fn go(&mut self, motion: Motion, values: &Values, line: usize) -> Result<(), Problem> {
        let words = self.lengths(values, ['X', 'Y', 'Z']);
        let abc = self.angles(values);
        let cuts = motion != Motion::Rapid;
        if cuts || !self.modes.absolute {
            let relative = !self.modes.absolute || matches!(motion, Motion::Arc { .. });
            self.machine.assume(line, |k| words[k].is_none() || relative);
        }
        let mut xyz = self.machine.xyz;
        for k in 0..3 {
            if let Some(word) = words[k] {
                xyz[k] = Some(match xyz[k] {
                    Some(now) if !self.modes.absolute => now + word,
                    _ => word + self.offsets.total()[k],
                });
            }
        }
        if self.offsets.total() != [0.0; 3] {
            self.machine.notes.add(
                line,
                "the program's work offsets are included: poses are in the frame of the machine",
            );
        }
        let [Some(x), Some(y), Some(z)] = xyz else {
            // A rapid move on the way to the first place that is known.
            self.machine.xyz = xyz;
            self.machine.abc = abc;
            return Ok(());
        };
        let target = Target { xyz: [x, y, z], abc };
        if cuts {
            if self.machine.known().is_none() {
                self.machine.notes.add(
                    line,
                    "where this cutting move starts is not known: the path begins at its end",
                );
            }
            self.machine.start_here(line)?;
        }
        match (motion, self.machine.known()) {
            (Motion::Arc { counter_clockwise }, Some(start)) => {
                self.arc(counter_clockwise, start, target, values, line)
            }
            _ if values.first("IJK").is_some() => {
                Err(Problem::syntax("I, J, K outside an arc: expected G2 or G3 with them"))
            }
            _ => self.machine.line_to(target, !cuts, line),
        }
    }

    fn arc(
        &mut self,
        counter_clockwise: bool,
        start: [f64; 3],
        target: Target,
        values: &Values,
        line: usize,
    ) -> Result<(), Problem> {
        let turns = values.get('P').unwrap_or(1.0);
        if turns.fract() != 0.0 || !(1.0..=1e4).contains(&turns) {
            return Err(Problem::value(
                "the number of turns P",
                turns,
                "a whole number from 1 on",
            ));
        }
        let plane = self.modes.plane;
        let [u, v, w] = plane;
        let offsets = self.lengths(values, ['I', 'J', 'K']);
        let ends = (start, target.xyz);
        let arc = match values.get('R') {
            Some(_) if offsets.iter().any(Option::is_some) => {
                return Err(Problem::syntax(
                    "an arc with both R and a centre: expected R, or I, J, K",
                ));
            }
            Some(radius) => Arc::with_radius(ends, plane, radius * self.unit(), counter_clockwise, turns),
            None => {
                if offsets[w].is_some_and(|offset| offset != 0.0) {
                    return Err(Problem::syntax(format!(
                        "{} does not belong to the arc's plane: expected {} and {}",
                        ['I', 'J', 'K'][w],
                        ['I', 'J', 'K'][u],
                        ['I', 'J', 'K'][v]
                    )));
                }
                let total = self.offsets.total();
                let centre = match (self.modes.absolute_centres, offsets[u], offsets[v]) {
                    (true, Some(cu), Some(cv)) => [cu + total[u], cv + total[v]],
                    (false, None, None) | (true, _, _) => {
                        return Err(Problem::syntax(format!(
                            "this arc has no centre: expected {} and {}, or R",
                            ['I', 'J', 'K'][u],
                            ['I', 'J', 'K'][v]
                        )));
                    }
                    (false, cu, cv) => [start[u] + cu.unwrap_or(0.0), start[v] + cv.unwrap_or(0.0)],
                };
                Arc::about(ends, plane, centre, counter_clockwise, turns)
            }
        }
        .map_err(Problem::syntax)?;
        let chords = arc.chords(self.arc_tolerance).map_err(Problem::syntax)?;
        self.machine.notes.add(
            line,
            format!("arcs are divided into chords within {} mm", self.arc_tolerance),
        );
        let from = self.machine.abc;
        for chord in 1..=chords {
            let s = chord as f64 / chords as f64;
            let abc = std::array::from_fn(|k| {
                if chord == chords {
                    target.abc[k]
                } else {
                    from[k] + s * (target.abc[k] - from[k])
                }
            });
            self.machine.line_to(Target { xyz: arc.at(s), abc }, false, line)?;
        }
        Ok(())
    }
}
