//! Cutter compensation.

use super::interpreter::Reader;
use super::moves::MoveWords;
use crate::drive::{CompensationSettings, Corners};
use crate::text::error::NcProblem;

impl Reader<'_> {
    /// `RL` and `RR`: from this move on.
    pub(super) fn compensate(&mut self, left: bool, words: &MoveWords, kind: &str) -> Result<(), NcProblem> {
        if self.modes.compensated == Some(left) && self.track.compensates() {
            return Ok(());
        }
        if !matches!(kind, "L" | "LP") || words.rapid && words.machine {
            return Err(NcProblem::syntax(
                "cutter compensation begins with a straight line: expected RL or RR in L or LP before this block",
            ));
        }
        if self.uncertain && self.track.known().is_none() {
            return Ok(());
        }
        let Some(radius) = self.cutter_radius() else {
            let Some(tool) = self.track.tool else {
                return Err(NcProblem::syntax(
                    "cutter compensation without a tool: expected TOOL CALL before it",
                ));
            };
            return Err(NcProblem::syntax(format!(
                "the radius of tool {tool} for cutter compensation is not known: expected it in the tool table, or TOOL DEF {tool} L… R…"
            )));
        };
        self.modes.compensated = Some(left);
        let side = CompensationSettings {
            left: left == (radius >= 0.0),
            radius: radius.abs(),
            corners: Corners::Arcs,
            beside_next: true,
            round_ends: false,
            tangent: 1e-6,
        };
        self.track.compensate(side, self.modes.plane)
    }

    /// The radius of the tool with the oversize of its call.
    pub(super) fn cutter_radius(&mut self) -> Option<f64> {
        let tool = self.track.tool?;
        let table = self.options.tool_offsets.get(&tool).map(|offset| offset.diameter);
        let table = table.or(self.options.diameters.get(&tool).copied());
        let known = self.modes.radii.get(&tool).copied();
        let known = known.or(table.map(|diameter| 0.5 * diameter));
        let radius = match known {
            Some(radius) => radius,
            None => {
                let (register, unit) = (format!("the radius of tool {tool}"), self.unit());
                let assumed = self.track.assume_diameter(&register, &format!("D{tool}"), unit, false);
                0.5 * assumed?
            }
        };
        Some(radius + self.modes.oversize)
    }
}
