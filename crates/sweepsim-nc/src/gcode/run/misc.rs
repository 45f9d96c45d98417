//! Speeds, tools, spindle, coolant, stops and dwells.

use super::interpreter::{Reader, Step};
use crate::gcode::codes::{self, Misc, SpindleTurning};
use crate::gcode::okuma_title;
use crate::gcode::syntax::block::Block;
use crate::gcode::syntax::cursor::Cursor;
use crate::model::event::EventKind;
use crate::model::read_options::Controller;
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcProblem};

impl Reader {
    /// Executes F, S, T and M words. What comes after the block, unless it calls.
    pub(crate) fn misc(&mut self, block: &Block) -> Result<Step, Located> {
        let whole = |problem| (problem, block.all());
        if let Some(feed) = block.get('F') {
            (self.modes.feed, self.modes.feed_in_inches) = (Some(feed), self.modes.inch);
        }
        if let Some(speed) = block.get('S') {
            let changed = self.modes.speed.replace(speed) != Some(speed);
            if changed && self.modes.spindle != SpindleTurning::Stopped && !block.has('M') {
                self.turn_spindle(self.modes.spindle).map_err(whole)?;
            }
        }
        if let Some(word) = block.word('T') {
            let tool = Self::tool_number(word.value).map_err(|problem| (problem, word.span()))?;
            self.tools.selected = Some(tool);
            // Programs without a tool change name their tool by a T word alone.
            if self.track.tool.is_none() {
                self.track.take_tool(Some(tool));
                self.update_frame();
            }
        }
        if !block.has('M') {
            return Ok(Step::Next);
        }
        let mut step = Step::Next;
        let okuma = self.rules.controller == Some(Controller::Okuma);
        for &word in block.words().iter().filter(|word| word.letter == 'M') {
            let at = |problem| (problem, word.span());
            match codes::m(word.value) {
                // To the level of G71, or to R.
                _ if okuma && matches!(word.value, 53.0 | 54.0) => self.modes.retract_to_plane = word.value == 54.0,
                Misc::Harmless => {}
                Misc::End => step = Step::End,
                Misc::Stop => self.track.event(EventKind::Stop).map_err(at)?,
                Misc::OptionalStop => self.track.event(EventKind::OptionalStop).map_err(at)?,
                Misc::Spindle(turning) => {
                    self.modes.spindle = turning;
                    self.turn_spindle(self.modes.spindle).map_err(at)?;
                }
                Misc::Coolant(coolant) => self.track.event(EventKind::Coolant(coolant)).map_err(at)?,
                Misc::ToolChange => self.change_tool(self.tools.selected).map_err(at)?,
                Misc::SetTool => {
                    let tool = block.get('Q').map(Self::tool_number).transpose().map_err(at)?;
                    self.change_tool(tool).map_err(at)?;
                }
                Misc::TipControl(on) => self.tip.kinematics = on,
                Misc::Call { .. } | Misc::Return => {
                    let several = block.words().iter().filter(|w| w.letter == 'M').count() > 1;
                    let last = block.words().iter().rfind(|w| w.letter == 'M');
                    if several && last != Some(&word) {
                        return Err(at(NcProblem::syntax(format!(
                            "{} next to another M code: expected it in a block of its own",
                            word.name()
                        ))));
                    }
                }
                Misc::SaveModes => self.level().modes = Some(Box::new(self.modes.clone())),
                Misc::SaveModesForCall => {
                    let modes = Some(Box::new(self.modes.clone()));
                    let frame = self.level();
                    frame.modes = modes;
                    frame.restore_modes = true;
                }
                Misc::ForgetModes => {
                    let frame = self.level();
                    frame.modes = None;
                    frame.restore_modes = false;
                }
                Misc::RestoreModes => match self.level().modes.clone() {
                    Some(modes) => self.modes = *modes,
                    None => {
                        return Err(at(NcProblem::syntax(
                            "M72 without M70 before it: there are no saved modes",
                        )));
                    }
                },
                Misc::Refused(what) => {
                    let what = format!("{}: {what}", word.name());
                    return Err(at(NcProblem::unsupported(what, "expected a program without them")));
                }
                Misc::Unknown => self.track.note(format!("{} is not understood: ignored", word.name())),
            }
        }
        Ok(step)
    }

    /// What only the control knows: an assumption, or an error if none may be made.
    pub(super) fn left_to_control(&mut self, what: String, taken: &str, settle: &str) -> Result<(), NcProblem> {
        if self.track.strict() {
            return Err(NcProblem::syntax(format!(
                "{what} is left to the control: expected {settle}"
            )));
        }
        self.track.assume(Assumption::new(what, taken, settle));
        Ok(())
    }

    /// G4, by P or by X in seconds.
    pub(crate) fn dwell(&mut self, block: &Block) -> Result<(), NcProblem> {
        let seconds = self.dwell_word(block).or(block.get('X')).unwrap_or(0.0);
        self.track.rest(seconds)
    }

    /// P of a dwell, in seconds: Fanuc's and Haas's are in milliseconds, if they have no decimal point.
    pub(super) fn dwell_word(&self, block: &Block) -> Option<f64> {
        block.word('P').map(|word| match self.rules.fanuc() && word.whole {
            true => word.value / 1000.0,
            false => word.value,
        })
    }

    /// Settings of Grbl and TinyG.
    pub(super) fn command(&mut self, line: &str, cursor: Cursor) -> Result<Step, Located> {
        if let Some(title) = okuma_title(line) {
            self.track.program.title.get_or_insert_with(|| title.to_owned());
            return Ok(Step::Next);
        }
        let upper = line.trim().to_ascii_uppercase();
        if upper.starts_with("$H") {
            self.track
                .note("moves to the machine's home are left out: the path breaks here");
            self.track.leave([true; 3]);
        } else if upper.starts_with("$J") {
            let problem = NcProblem::unsupported("jogging ($J) is", "expected G0 or G1");
            return Err((problem, cursor.at..line.len()));
        } else {
            self.track.note("settings of the control (`$…`, `{…}`) are ignored");
        }
        Ok(Step::Next)
    }
}
