//! Executes a program block by block.

use std::collections::HashSet;
use std::ops::Range;

use super::arc::ArcPlane;
use super::codes::{self, Code, Misc, MotionMode};
use super::lexer::{self, Located, Word};
use super::offsets::Offsets;
use super::state::State;
use super::title;
use crate::model::program::Program;
use crate::model::read_options::ReadOptions;
use crate::text::error::{NcError, NcProblem, TextPosition};

/// The most problems after the first one.
const MOST_FURTHER: usize = 100;

pub(super) fn read(text: &str, options: &ReadOptions) -> Result<Program, NcError> {
    if !(options.arc_tolerance > 0.0 && options.arc_tolerance.is_finite()) {
        let problem = NcProblem::value("the arc tolerance", options.arc_tolerance, "a positive number of mm");
        return Err(NcError::new(problem, None));
    }
    let mut reader = Reader {
        state: State::new(options),
        modes: Modes {
            motion: None,
            plane: [0, 1, 2],
            absolute: true,
            absolute_centres: false,
            inch: options.inch,
        },
        offsets: Offsets::default(),
        arc_tolerance: options.arc_tolerance,
        exact_arcs: options.exact_arcs,
        selected_tool: None,
        kinematics: options.machine.tip_control,
        length_control: false,
        begun: false,
        ended: false,
        uncertain: false,
    };
    let mut errors: Vec<NcError> = Vec::new();
    let mut messages = HashSet::new();
    let leader = title::leader(text);
    if leader > 0 {
        reader.state.notes.add(1, "text before the first `%`: ignored");
    }
    for (index, line) in text.lines().enumerate().skip(leader) {
        let number = index + 1;
        if let Err((problem, span)) = reader.line(line, number) {
            reader.go_on();
            if messages.insert(problem.to_string()) {
                let column = 1 + line[..span.start].chars().count();
                let width = line[span].chars().count();
                let position = TextPosition::in_line(number, line, column, width);
                errors.push(NcError::new(problem, Some(position)));
            }
        }
        if reader.ended || errors.len() > MOST_FURTHER {
            break;
        }
    }
    if let Some(error) = NcError::all(errors) {
        return Err(error);
    }
    if !reader.state.has_moved() {
        let line = text.lines().count().max(1);
        let problem = NcProblem::syntax("this program has no move: expected at least one with X, Y and Z known");
        return Err(NcError::new(problem, Some(TextPosition::in_line(line, "", 1, 1))));
    }
    Ok(reader.state.finish())
}

/// Modal state: in effect until another word changes it.
pub(super) struct Modes {
    pub(super) motion: Option<MotionMode>,
    pub(super) plane: ArcPlane,
    pub(super) absolute: bool,
    pub(super) absolute_centres: bool,
    pub(super) inch: bool,
}

pub(super) struct Reader {
    pub(super) state: State,
    pub(super) modes: Modes,
    pub(super) offsets: Offsets,
    pub(super) arc_tolerance: f64,
    pub(super) exact_arcs: bool,
    /// Selected by a T word, not yet in the spindle.
    pub(super) selected_tool: Option<u32>,
    /// Tip control by the machine's kinematics (M428).
    pub(super) kinematics: bool,
    /// Tip control by the length offset (G43.4).
    pub(super) length_control: bool,
    pub(super) begun: bool,
    pub(super) ended: bool,
    /// After a problem: what the program has said so far is not fully known.
    pub(super) uncertain: bool,
}

/// The words of a block, by letter.
pub(super) struct Values<'a>(pub(super) &'a [Word]);

impl Values<'_> {
    pub(super) fn get(&self, letter: char) -> Option<f64> {
        self.0.iter().find(|word| word.letter == letter).map(|word| word.value)
    }

    pub(super) fn span(&self, letter: char) -> Range<usize> {
        self.0
            .iter()
            .find(|word| word.letter == letter)
            .map_or(0..0, |word| word.span.clone())
    }

    pub(super) fn first(&self, letters: &str) -> Option<&Word> {
        self.0.iter().find(|word| letters.contains(word.letter))
    }

    /// The bytes from the first word to the last.
    pub(super) fn all(&self) -> Range<usize> {
        match (self.0.first(), self.0.last()) {
            (Some(first), Some(last)) => first.span.start..last.span.end,
            _ => 0..0,
        }
    }
}

/// A code as it appears in messages: `G5.1`, `M98`.
fn code_name(word: &Word) -> String {
    format!("{}{}", word.letter, word.value)
}

impl Reader {
    /// Goes on after a problem, to find others: where the tool is now is not known.
    fn go_on(&mut self) {
        self.uncertain = true;
        self.state.xyz = [None; 3];
        self.state.leave();
        self.modes.motion = None;
    }

    fn line(&mut self, line: &str, number: usize) -> Result<(), Located> {
        if !self.state.has_moved()
            && let Some(title) = title::of(line)
        {
            self.begun = true;
            self.state.notes.add(number, format!("title {title:?}: ignored"));
            return Ok(());
        }
        let block = lexer::block(line)?;
        if block.tape {
            self.ended = self.begun;
            return Ok(());
        }
        if block.optional && !block.words.is_empty() {
            self.state.notes.add(number, "optional blocks (`/`) are executed");
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
            match codes::g_in(word.value, values) {
                Code::Motion(motion) => {
                    self.modes.motion = Some(motion);
                    motion_words += 1;
                    if motion_words > 1 {
                        return fail(NcProblem::syntax(
                            "a second motion code in one block: expected one of G0, G1, G2 and G3",
                        ));
                    }
                }
                Code::CancelMotion => self.modes.motion = None,
                Code::Plane(plane) => self.modes.plane = plane,
                Code::Inch(inch) => self.modes.inch = inch,
                Code::InchOrCycle(inch) => {
                    self.modes.inch = inch;
                    self.state
                        .notes
                        .add(line, "G70 and G71 are taken as inches and millimetres");
                }
                Code::Blending => {
                    if let Some(tolerance) = values.get('P').filter(|p| *p > 0.0) {
                        let message = format!(
                            "G64 P{tolerance}: corners may be rounded by as much; the path is read as programmed"
                        );
                        self.state.notes.add(line, message);
                    }
                }
                Code::Absolute(absolute) => self.modes.absolute = absolute,
                Code::AbsoluteCentres(absolute) => self.modes.absolute_centres = absolute,
                Code::TipControl(on) => self.length_control = on,
                Code::LengthOffset => self.length_control = false,
                Code::WorkOffset(index) => self.offsets.active = index,
                Code::MachineCoordinates => machine_coordinates = true,
                code @ (Code::Dwell
                | Code::Ignored(_)
                | Code::Home
                | Code::SetOffsets
                | Code::LocalShift
                | Code::ShiftHere
                | Code::CancelShift { .. }
                | Code::RestoreShift) => {
                    if action.replace((code, word.span.clone())).is_some() {
                        return fail(NcProblem::syntax(format!(
                            "{} next to another code that uses the coordinates: expected one of them per block",
                            code_name(word)
                        )));
                    }
                }
                Code::Harmless => {}
                Code::Refused(what) => {
                    return fail(NcProblem::unsupported(
                        format!("{}: {what}", code_name(word)),
                        "the path of the tool would be unknown; expected G0, G1, G2 or G3",
                    ));
                }
                Code::SplineOrMode | Code::SplineOrContouring | Code::Unknown => {
                    return fail(NcProblem::unsupported(
                        format!("{} is", code_name(word)),
                        "it could move the tool; expected a code of RS-274",
                    ));
                }
            }
        }
        let ends = self.misc(values, line)?;
        self.state.tip_control = self.kinematics || self.length_control;
        let whole = |problem| (problem, values.all());
        match action {
            Some((Code::Dwell, _)) => {}
            Some((Code::Ignored(note), _)) => self.state.notes.add(line, note),
            Some((code, span)) => self.act(code, values, line).map_err(|problem| (problem, span))?,
            None => match (values.first("XYZABCIJKR"), self.modes.motion) {
                (None, _) => {}
                // The block with the motion code may be the one with the problem.
                (Some(_), None) if self.uncertain => {}
                (Some(word), None) => {
                    let problem = NcProblem::syntax(format!(
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

    /// Each letter at most once, and none that could move the tool in an unknown way.
    fn check_letters(&mut self, values: &Values, line: usize) -> Result<(), Located> {
        for (index, word) in values.0.iter().enumerate() {
            let fail = |problem| Err((problem, word.span.clone()));
            match word.letter {
                'G' | 'M' => continue,
                'N' | 'A' | 'B' | 'C' | 'X' | 'Y' | 'Z' | 'I' | 'J' | 'K' | 'R' | 'F' | 'S' | 'T' | 'P' | 'Q' | 'L'
                | 'H' | 'D' => {}
                'U' | 'V' | 'W' => {
                    return fail(NcProblem::unsupported(
                        format!("the axis {} is", word.letter),
                        "expected X Y Z A B C",
                    ));
                }
                'E' if values.0.iter().any(|w| {
                    (w.letter == 'M' && (62.0..=68.0).contains(&w.value)) || (w.letter == 'G' && w.value == 187.0)
                }) => {}
                'E' => {
                    return fail(NcProblem::unsupported(
                        "E words are",
                        "it could be an exponent or an extruder; expected numbers without exponent",
                    ));
                }
                'O' => {
                    let alone = values.0.iter().all(|w| matches!(w.letter, 'O' | 'N'));
                    if !alone || self.state.has_moved() {
                        return fail(NcProblem::unsupported(
                            "O-words (subroutines, loops) are",
                            "expected a program without them",
                        ));
                    }
                    self.state.notes.add(line, "program number: ignored");
                }
                letter => self
                    .state
                    .notes
                    .add(line, format!("{letter} words are not understood: ignored")),
            }
            if values.0[..index].iter().any(|before| before.letter == word.letter) {
                return fail(NcProblem::syntax(format!(
                    "a second {} in one block: expected one",
                    word.letter
                )));
            }
        }
        Ok(())
    }

    /// Executes F, T and M words. Returns whether the program ends.
    fn misc(&mut self, values: &Values, line: usize) -> Result<bool, Located> {
        if let Some(feed) = values.get('F') {
            self.state.feed = Some(feed);
        }
        let number = |letter, value: f64| {
            if value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value) {
                Ok(value as u32)
            } else {
                Err((
                    NcProblem::value("a tool number", value, "a whole number"),
                    values.span(letter),
                ))
            }
        };
        if let Some(tool) = values.get('T') {
            let tool = number('T', tool)?;
            self.selected_tool = Some(tool);
            // Programs without a tool change name their tool by a T word alone.
            self.state.tool.get_or_insert(tool);
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
                Misc::Return if values.first("PLQ").is_none() => {
                    self.state
                        .notes
                        .add(line, "M99 ends the program here; a machine may start it again");
                    ends = true;
                }
                Misc::Return => {
                    let problem = NcProblem::unsupported("M99: jumps are", "expected M99 alone, or M30");
                    return Err((problem, word.span.clone()));
                }
                Misc::Refused(what) => {
                    let what = format!("{}: {what}", code_name(word));
                    let problem = NcProblem::unsupported(what, "expected a program without them");
                    return Err((problem, word.span.clone()));
                }
                Misc::Unknown => self
                    .state
                    .notes
                    .add(line, format!("{} is not understood: ignored", code_name(word))),
            }
        }
        Ok(ends)
    }

    /// The new tool continues from the current position, on a separate path.
    fn change_tool(&mut self, tool: Option<u32>) {
        if tool.is_some() && tool != self.state.tool {
            self.state.tool = tool;
            self.state.leave();
        }
    }
}
