//! Cutter compensation.

use crate::controls::heidenhain::interpreter::Reader;
use crate::controls::heidenhain::words::MoveWords;
use crate::drive::{CompensationSettings, Corners, DiameterAsked};
use crate::text::error::NcProblem;

impl Reader<'_> {
    /// `RL` and `RR`: from this move on.
    pub(in crate::controls::heidenhain) fn compensate(
        &mut self,
        left: bool,
        words: &MoveWords,
        kind: &str,
    ) -> Result<(), NcProblem> {
        if self.modes.compensated == Some(left) && self.track.compensates() {
            return Ok(());
        }
        if !matches!(kind, "L" | "LP") || words.rapid && words.machine.is_some() {
            return Err(NcProblem::syntax(
                "cutter compensation begins with a straight line: expected RL or RR in L or LP before this block",
            ));
        }
        if self.uncertain && self.track.known().is_none() {
            return Ok(());
        }
        if self.track.is_recording() {
            self.modes.compensated = Some(left);
            return self.track.compensate(self.side(left, 0.0), self.modes.plane);
        }
        let Some(tool) = self.track.tool.or(Some(0).filter(|_| !self.track.strict())) else {
            let problem = "cutter compensation without a tool: expected TOOL CALL before it";
            return Err(NcProblem::syntax(problem));
        };
        let radius = self.cutter_radius(0.0).ok_or_else(|| {
            NcProblem::syntax(format!(
                "the radius of tool {tool} for cutter compensation is not known: expected it in the tool table, or TOOL DEF {tool} L… R…"
            ))
        })?;
        self.modes.compensated = Some(left);
        self.track.compensate(self.side(left, radius), self.modes.plane)
    }

    fn side(&self, left: bool, radius: f64) -> CompensationSettings {
        CompensationSettings {
            left: left == (radius >= 0.0),
            radius: radius.abs(),
            corners: Corners::Arcs,
            beside_next: true,
            round_ends: false,
            tangent: 1e-6,
        }
    }

    /// The radius of the tool with the oversize of its call. `unknown`: its diameter where nobody tells it, in mm.
    pub(in crate::controls::heidenhain) fn cutter_radius(&mut self, unknown: f64) -> Option<f64> {
        let tool = self.track.tool.unwrap_or(0);
        let known = self.given_radius(tool);
        let radius = match known {
            Some(radius) => radius,
            None => {
                let asked = DiameterAsked {
                    register: &format!("the radius of tool {tool}"),
                    option: &format!("D{tool}"),
                    unit: self.unit(),
                    wear: self.options.wear_registers && unknown == 0.0,
                    unknown,
                };
                0.5 * self.track.assume_diameter(&asked)?
            }
        };
        Some(radius + self.modes.oversize)
    }

    /// The radius of a tool in the control's table, or in the program.
    fn given_radius(&self, tool: u32) -> Option<f64> {
        let table = self.options.tool_offsets.get(&tool).map(|offset| offset.diameter);
        let table = table.or(self.options.diameters.get(&tool).copied());
        let own = self.modes.radii.get(&tool).copied();
        own.or(table.map(|diameter| 0.5 * diameter))
    }

    /// The radius of the tool in the spindle, if anything tells it.
    pub(in crate::controls::heidenhain) fn known_radius(&mut self) -> Option<f64> {
        let given = self.given_radius(self.track.tool?);
        let unit = self.unit();
        given.or_else(|| self.track.tool_diameter(unit).map(|diameter| 0.5 * diameter))
    }
}
