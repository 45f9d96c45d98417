//! What a block does, in the order in which controls do it: modes, speeds, tool, spindle and coolant, offsets, the move, the end.

use super::control::calls::SourceLine;
use super::interpreter::{Reader, Step};
use crate::drive::Sense;
use crate::gcode::codes::{self, Code, LengthCode, Misc, MotionMode};
use crate::gcode::okuma;
use crate::gcode::syntax::block::{Block, Word};
use crate::model::program::Units;
use crate::model::read_options::Controller;
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcProblem};

/// What the G words of a block ask for besides modes.
#[derive(Default)]
struct Plan {
    /// A code that uses the coordinates, or sets an offset.
    action: Option<(Code, Word)>,
    machine_coordinates: bool,
    motion: Option<Word>,
    dwell: bool,
    changes_tool: bool,
    length: Option<(Code, Word)>,
    macro_call: Option<Word>,
}

impl Reader {
    /// Executes a block.
    pub(crate) fn perform(&mut self, block: &Block, here: SourceLine) -> Result<Step, Located> {
        for (target, value) in &block.assignments {
            self.assign(target, *value)
                .map_err(|problem| (problem, 0..usize::MAX))?;
        }
        if block.is_empty() {
            return Ok(Step::Next);
        }
        let has = |code: f64| block.words().iter().any(|w| (w.letter, w.value) == ('G', code));
        if has(66.0) {
            return self.begin_modal_macro(block).map_err(|problem| (problem, block.all()));
        }
        if has(67.0) {
            self.calls.modal = None;
        }
        if !has(65.0) {
            self.check_letters(block)?;
        }
        self.check_plane_blocks(block)
            .map_err(|problem| (problem, block.all()))?;
        self.keep_register(block)
            .map_err(|problem| (problem, block.span('D')))?;
        let fixture = self.fixture_offset(block);
        let plan = self.modal(block)?;
        if let Some(offset) = fixture {
            self.select(offset).map_err(|problem| (problem, block.span('E')))?;
            self.track.note("E is taken for a work offset, as on Fadal's controls");
        }
        let unit = self.unit();
        if let Some(trace) = &mut self.track.trace {
            trace.unit = unit;
        }
        if let Some(word) = plan.macro_call {
            return self.call_macro(block, here).map_err(|problem| (problem, word.span()));
        }
        let mut step = self.misc(block)?;
        if plan.changes_tool {
            self.change_tool(self.tools.selected)
                .map_err(|problem| (problem, block.all()))?;
        }
        (self.track.feed, self.track.feed_mode) = (self.feed(), self.modes.feed_mode);
        self.track.exact_stop = self.modes.exact_stop || self.modes.stops_here;
        let whole = |problem| (problem, block.all());
        self.switch_control().map_err(whole)?;
        if plan.dwell {
            self.dwell(block).map_err(whole)?;
        }
        if let Some((code, word)) = plan.length {
            let result = match code {
                Code::Length(code) => self.set_length(code, block),
                _ => self.use_length([0.0; 3]),
            };
            result.map_err(|problem| (problem, word.span()))?;
        }
        match plan.action {
            Some((code, word)) => {
                let tilts = matches!(
                    code,
                    Code::TiltedPlane | Code::FurtherTilt | Code::CancelTilt | Code::AlignTool | Code::DynamicOffset(_)
                );
                let result = if tilts {
                    self.tilt(code, block)
                } else {
                    self.act(code, block)
                };
                result.map_err(|problem| (problem, word.span()))?;
                // The words of a tilted plane are its own; the other codes may stand beside a move.
                if tilts && !matches!(code, Code::TiltedPlane | Code::FurtherTilt) {
                    self.motion(block, &plan)?;
                }
            }
            None if plan.dwell && plan.motion.is_none() => {}
            None => self.motion(block, &plan)?,
        }
        if plan.action.is_none()
            && block.first("XYZABC").is_some()
            && let Some((arguments, depth)) = self.calls.modal.clone()
            && depth == self.calls.levels.len()
        {
            step = self.call_macro(&arguments, here).map_err(whole)?;
        }
        // A subprogram is called, and the program ends, after the move.
        if let Some(word) = block.words().iter().rfind(|word| word.letter == 'M') {
            let span = word.span();
            match codes::m(word.value) {
                Misc::Call { by_block_number } => {
                    step = self
                        .call_program(block, by_block_number, here)
                        .map_err(|problem| (problem, span))?;
                }
                Misc::Return => step = self.leave_program(block, here).map_err(|problem| (problem, span))?,
                _ => {}
            }
        }
        Ok(step)
    }

    fn motion(&mut self, block: &Block, plan: &Plan) -> Result<(), Located> {
        let whole = |problem| (problem, block.all());
        if self.modes.motion == Some(MotionMode::Nurbs) {
            let given = plan.motion.is_some() || block.first("XYZABCPLIJKQR").is_some();
            return if given {
                self.control_point(block).map_err(whole)
            } else {
                Ok(())
            };
        }
        let letters = match self.modes.motion {
            Some(MotionMode::Cycle(_)) => "XYZABCR",
            // Words that arcs need, where there is no other use for them.
            _ if block.has('M') || plan.length.is_some() => "XYZABC",
            _ => "XYZABCIJKR",
        };
        let used = block.first(letters);
        if let Some(word) = block.after_comma() {
            self.check_after_comma(word, used.is_some())
                .map_err(|problem| (problem, word.span()))?;
        }
        match (used, self.modes.motion) {
            (None, Some(MotionMode::Arc { .. })) if plan.motion.is_some() => Err(whole(NcProblem::syntax(
                "an arc without an end or a centre: expected X, Y, Z, I, J, K or R",
            ))),
            (None, _) => Ok(()),
            // The block with the motion code may be the one with the problem.
            (Some(_), None) if self.seen.uncertain => {
                if self.rules.lenient {
                    self.track
                        .note("left out: a move after a problem, until its kind is known again");
                }
                Ok(())
            }
            (Some(_), None) if plan.machine_coordinates && self.starts_in_rapid() => {
                self.go_in_machine_coordinates(MotionMode::Rapid, block).map_err(whole)
            }
            (Some(_), None) if self.starts_in_rapid() => {
                let motion = self.modes.before_cycle.unwrap_or_else(|| {
                    let (what, taken) = (
                        "the kind of moves before the first motion code",
                        "G0, as most controls start",
                    );
                    self.track.assume(Assumption::new(what, taken, "G0 or G1 before them"));
                    MotionMode::Rapid
                });
                self.modes.motion = Some(motion);
                self.motion(block, plan)
            }
            (Some(word), None) => {
                let problem = NcProblem::syntax(format!(
                    "{} without a motion code: expected G0, G1, G2 or G3 here or before",
                    word.letter
                ));
                Err((problem, word.span()))
            }
            (Some(_), Some(motion)) => {
                if self.rules.strict
                    && self.rules.controller == Some(Controller::LinuxCnc)
                    && !matches!(motion, MotionMode::Rapid | MotionMode::Thread | MotionMode::RigidTap)
                    && self.modes.feed.is_none_or(|feed| feed <= 0.0)
                {
                    return Err(whole(NcProblem::syntax(
                        "a feed move without a feed: expected F before it",
                    )));
                }
                if self.seen.units.is_none() {
                    self.seen.units = Some(if self.modes.inch { Units::Inch } else { Units::Mm });
                }
                if plan.machine_coordinates {
                    self.go_in_machine_coordinates(motion, block).map_err(whole)
                } else {
                    self.track.use_offset(&mut self.offsets.work).map_err(whole)?;
                    match motion {
                        MotionMode::Cycle(cycle) => self.cycle(cycle, block).map_err(whole),
                        _ => self.go(motion, block).map_err(whole),
                    }
                }
            }
        }
    }

    /// Whether moves without a motion code are those that the control starts with: LinuxCNC has none, and strict readers.
    pub(crate) fn starts_in_rapid(&self) -> bool {
        !self.track.strict() && self.rules.controller != Some(Controller::LinuxCnc)
    }

    /// The G words: modes at once, the rest as a plan.
    fn modal(&mut self, block: &Block) -> Result<Plan, Located> {
        let mut plan = Plan::default();
        self.modes.stops_here = false;
        if !block.has('G') {
            return Ok(plan);
        }
        for &word in block.words().iter().filter(|word| word.letter == 'G') {
            let fail = |problem| Err((problem, word.span()));
            let okuma = okuma::code(word.value, block).filter(|_| self.rules.controller == Some(Controller::Okuma));
            let code = match okuma.unwrap_or_else(|| codes::g_in(word.value, block)) {
                Code::Probe if self.track.strict() => Code::Refused("probing is"),
                code => code,
            };
            match code {
                Code::Motion(motion) => {
                    if plan.motion.replace(word).is_some() {
                        return fail(NcProblem::syntax(
                            "a second motion code in one block: expected one of G0, G1, G2 and G3",
                        ));
                    }
                    if motion != MotionMode::Nurbs {
                        self.check_curve().map_err(|problem| (problem, word.span()))?;
                    }
                    if let MotionMode::Cycle(_) = motion
                        && self.modes.motion != Some(motion)
                    {
                        self.begin_cycle();
                        let plain = |motion: &MotionMode| {
                            matches!(motion, MotionMode::Rapid | MotionMode::Feed | MotionMode::Arc { .. })
                        };
                        self.modes.before_cycle = self.modes.motion.filter(plain).or(self.modes.before_cycle);
                    }
                    self.modes.motion = Some(motion);
                }
                // G0 in the same block stays in effect.
                Code::CancelMotion => {
                    let given = plan.motion.is_some() && !matches!(self.modes.motion, Some(MotionMode::Cycle(_)));
                    self.modes.motion = self.modes.motion.filter(|_| given);
                }
                Code::Plane(plane) => {
                    if plane != self.modes.plane {
                        self.refuse_compensation("a change of the plane")
                            .map_err(|problem| (problem, word.span()))?;
                    }
                    self.modes.plane = plane;
                }
                Code::Inch(inch) => self.modes.inch = inch,
                Code::InchOrCycle(inch) => {
                    self.modes.inch = inch;
                    self.track.note("G70 and G71 are taken as inches and millimetres");
                }
                Code::StopHere => self.modes.stops_here = true,
                // Grbl's G61 is its only mode: an exact path.
                Code::ExactStop(on) => self.modes.exact_stop = on && self.rules.controller != Some(Controller::Grbl),
                Code::Blending => {
                    self.modes.exact_stop = false;
                    if let Some(tolerance) = block.get('P').filter(|p| *p > 0.0) {
                        self.track.note(format!(
                            "G64 P{tolerance}: corners may be rounded by as much; the path is read as programmed"
                        ));
                    }
                }
                Code::Absolute(absolute) => self.modes.absolute = absolute,
                Code::AbsoluteCentres(absolute) => {
                    self.modes.absolute_centres = absolute;
                    self.seen.centres = true;
                }
                Code::Feed(mode) => self.modes.feed_mode = mode,
                Code::ChangeTool => plan.changes_tool = true,
                Code::ChangeToolOnTheWay => {
                    (plan.changes_tool, plan.motion) = (true, Some(word));
                    self.modes.motion = Some(MotionMode::Rapid);
                }
                Code::RetractToPlane(to_plane) => self.modes.retract_to_plane = to_plane,
                Code::TipControl(on) => (self.tip.by_length, self.tip.vectors) = (on, false),
                Code::TipVectors => (self.tip.by_length, self.tip.vectors) = (true, true),
                Code::TipControlByLetters => {
                    self.track.driver.prefer(Sense::Tool);
                    (self.tip.by_length, self.tip.vectors) = (true, false);
                }
                Code::CancelLength => {
                    self.tip.by_length = false;
                    plan.length = Some((Code::CancelLength, word));
                }
                Code::Length(code) => {
                    self.tip.by_length = false;
                    let by_words = matches!(code, LengthCode::Words | LengthCode::Add) && !block.has('H');
                    let slot = Some((Code::Length(code), word));
                    if by_words {
                        if plan.action.is_some() {
                            return fail(two_users(&word));
                        }
                        plan.action = slot;
                    } else {
                        plan.length = slot;
                    }
                }
                Code::Compensation { left, by_words } => self
                    .compensate(left, by_words, block)
                    .map_err(|problem| (problem, word.span()))?,
                Code::CancelCompensation => self
                    .track
                    .end_compensation(None)
                    .map_err(|problem| (problem, word.span()))?,
                Code::MachineCoordinates => plan.machine_coordinates = true,
                Code::Polar(on) => (self.modes.polar, self.modes.polar_words) = (on, [None; 2]),
                code @ (Code::WorkOffset(_) | Code::WorkOffsetByWord | Code::CancelRotation | Code::CancelScale) => {
                    self.act(code, block).map_err(|problem| (problem, word.span()))?;
                }
                Code::Dwell => plan.dwell = true,
                Code::MacroCall => plan.macro_call = Some(word),
                code @ (Code::Ignored(_)
                | Code::UnknownCycle(_)
                | Code::Home { .. }
                | Code::SetHome { .. }
                | Code::Probe
                | Code::ReturnLevel
                | Code::SetOffsets
                | Code::LocalShift
                | Code::ShiftHere
                | Code::CancelShift { .. }
                | Code::RestoreShift
                | Code::Rotate
                | Code::TiltedPlane
                | Code::FurtherTilt
                | Code::EndCurve
                | Code::CircularPocket { .. }
                | Code::Stretch(_)
                | Code::CancelTilt
                | Code::AlignTool
                | Code::DynamicOffset(_)
                | Code::Scale
                | Code::Mirror
                | Code::CancelMirror) => {
                    if plan.action.replace((code, word)).is_some() {
                        return fail(two_users(&word));
                    }
                }
                Code::Harmless => {}
                Code::Refused(what) => {
                    return fail(NcProblem::unsupported(
                        format!("{}: {what}", word.name()),
                        "the path of the tool would be unknown; expected G0, G1, G2 or G3",
                    ));
                }
                Code::SplineOrMode | Code::SplineOrContouring | Code::Unknown => {
                    return fail(NcProblem::unsupported(
                        format!("{} is", word.name()),
                        "it could move the tool; expected a code of RS-274",
                    ));
                }
            }
        }
        Ok(plan)
    }
}

fn two_users(word: &Word) -> NcProblem {
    NcProblem::syntax(format!(
        "{} next to another code that uses the coordinates: expected one of them per block",
        word.name()
    ))
}
