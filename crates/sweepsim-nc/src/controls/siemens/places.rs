//! Moves to places that only the machine knows: `SUPA`, `G53` and `G153`, `G74` and `G75`.

use std::ops::Range;

use super::interpreter::Reader;
use super::moves::{LINEAR, MACHINE_AXES, ROTARY};
use super::state::Motion;
use super::words::{Action, Words};
use crate::text::error::{Located, NcProblem};

/// That of the first word of an axis.
fn axes_span(words: &Words) -> Range<usize> {
    let axes = [LINEAR, ROTARY, MACHINE_AXES].concat();
    words.any(&axes).map_or(0..0, |word| word.span.clone())
}

impl Reader<'_> {
    /// `G74` to the reference point, or `G75` to the first fixed point: the axes that the block names go there, whatever values they have.
    pub(super) fn go_home(&mut self, second: bool, words: &Words, action: &Action) -> Result<(), Located> {
        let here = |problem| (problem, axes_span(words));
        let linear = [0, 1, 2].map(|k| words.any(&[LINEAR[k], MACHINE_AXES[k]]).is_some());
        let rotary = ROTARY.map(|name| words.get(name).is_some());
        if !linear.contains(&true) && !rotary.contains(&true) {
            let problem = NcProblem::syntax("G74 or G75 without an axis: expected X, Y, Z …");
            return Err(here(problem));
        }
        let named = |letter: char| match "XYZ".find(letter) {
            Some(k) => linear[k],
            None => "ABC".find(letter).is_some_and(|k| rotary[k]),
        };
        let first = action.fixed_point.is_none_or(|number| number == 1.0);
        if (first || !second) && self.track.go_home(second, named).map_err(here)? {
            return Ok(());
        }
        self.track
            .note("moves to the machine's fixed points are left out: the path breaks here");
        let zeroed = std::array::from_fn(|k| if rotary[k] { 0.0 } else { self.track.abc[k] });
        self.track.turn_unknown(zeroed).map_err(here)?;
        self.track.leave(linear);
        Ok(())
    }

    /// In machine coordinates: of the spindle's nose after `D0`, else of the tip, where the tool is along Z.
    pub(super) fn go_in_machine_coordinates(&mut self, words: &Words, abc: [f64; 3]) -> Result<(), Located> {
        let here = |problem| (problem, axes_span(words));
        let straight = matches!(self.modes.motion, Motion::Rapid | Motion::Feed);
        if let (true, Some((nose, length))) = (straight, self.track.machine_place()) {
            let raised = if self.without_length() { 0.0 } else { length };
            // The tool's length is along Z unless it follows the tool.
            let along_z = raised == 0.0 || !self.modes.tip_control || self.track.direction().map_err(here)?[2] == 1.0;
            let mut goal = [None; 6];
            for (k, name) in LINEAR.into_iter().enumerate() {
                let Some(word) = words.get(name) else { continue };
                let value = word.value * self.modes.unit();
                let above = if k == 2 { raised } else { 0.0 };
                goal[k] = Some(if self.relative(word) {
                    nose[k] + value
                } else {
                    value + above
                });
            }
            for (k, name) in ROTARY.into_iter().enumerate() {
                goal[3 + k] = words.get(name).map(|_| abc[k]);
            }
            let rapid = self.modes.motion == Motion::Rapid;
            if along_z && self.track.go_to_machine(goal, rapid).map_err(here)? {
                return Ok(());
            }
        }
        self.track
            .note("moves in machine coordinates are left out: the path breaks here");
        self.track.turn_unknown(abc).map_err(here)?;
        self.track.leave(LINEAR.map(|name| words.get(name).is_some()));
        Ok(())
    }
}
