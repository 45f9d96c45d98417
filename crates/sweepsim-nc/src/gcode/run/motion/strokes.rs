//! Programmed moves, and the switch of cutter compensation.

use crate::drive::{CompensationSettings, Corners, DiameterAsked, Stroke};
use crate::gcode::run::interpreter::Reader;
use crate::gcode::run::tools::ToolRow;
use crate::gcode::syntax::block::Block;
use crate::gcode::syntax::expression::Variables;
use crate::model::read_options::Controller;
use crate::text::error::NcProblem;

impl Reader {
    /// Executes a programmed move, beside it if cutter compensation is on.
    pub(crate) fn give(&mut self, stroke: Stroke) -> Result<(), NcProblem> {
        self.pending.stretched = false;
        self.track.go(stroke)
    }

    /// D stays until another one, on controls of Fanuc's kind; on LinuxCNC it is about its own block.
    ///
    /// Fanuc reads a D beside a contour, without G41, as a change of the radius along the block.
    pub(crate) fn keep_register(&mut self, block: &Block) -> Result<(), NcProblem> {
        let has = |codes: &[f64]| {
            block
                .words()
                .iter()
                .any(|w| w.letter == 'G' && codes.contains(&w.value))
        };
        let register = block.get('D').filter(|d| *d >= 0.0 && d.fract() == 0.0);
        if self.rules.controller == Some(Controller::LinuxCnc) || has(&[41.1, 42.1, 65.0]) || register.is_none() {
            return Ok(());
        }
        self.modes.register = register;
        let Some(side) = self.track.side().filter(|_| !has(&[40.0, 41.0, 42.0])) else {
            return Ok(());
        };
        if (0.5 * self.cutter_diameter(register)?.abs() - side.radius).abs() > 1e-9 {
            return Err(NcProblem::unsupported(
                "a change of the radius while cutter compensation is on is",
                "expected G40, and G41 or G42 with the other D, before it",
            ));
        }
        Ok(())
    }

    /// The diameter D in the table, or the tool's own.
    pub(super) fn cutter_diameter(&mut self, d: Option<f64>) -> Result<f64, NcProblem> {
        let number = match d.or(self.modes.register) {
            Some(d) => Self::tool_number(d)?,
            None => self.track.tool.unwrap_or(0),
        };
        let row = self.tools.get(number).or((number == 0).then(ToolRow::default));
        match row.map(|row| row.diameter).or(self.tools.diameter(number)) {
            Some(diameter) => Ok(diameter),
            None => {
                let register = format!("D{number}");
                let assumed = self.track.assume_diameter(&DiameterAsked {
                    register: &register,
                    option: &register,
                    unit: self.unit(),
                    wear: self.tools.wear_alone,
                    unknown: 0.0,
                });
                assumed.ok_or_else(|| NcProblem::syntax(format!(
                    "the diameter D{number} for cutter compensation is not known: expected --diameters D{number}=… (in a job: `diameters`), a tool table, or G41.1 D with the diameter"
                )))
            }
        }
    }

    /// G41 and G42, by a number of the table (D) or by the diameter itself (G41.1).
    pub(crate) fn compensate(&mut self, left: bool, by_words: bool, block: &Block) -> Result<(), NcProblem> {
        if self.track.compensates() {
            return Err(NcProblem::unsupported(
                "a change of cutter compensation without G40 is",
                "expected G40 and a move between them",
            ));
        }
        if self.seen.uncertain && self.track.known().is_none() {
            return Ok(());
        }
        if self.modes.scaling.is_some() {
            return Err(NcProblem::unsupported(
                "cutter compensation in scaled coordinates is",
                "expected G50 before it",
            ));
        }
        let diameter = match (by_words, block.get('D')) {
            (true, Some(d)) => d * self.unit(),
            (true, None) => return Err(NcProblem::syntax("G41.1 without D: expected the tool's diameter")),
            (false, d) => self.cutter_diameter(d)?,
        };
        let linuxcnc = self.rules.controller == Some(Controller::LinuxCnc);
        let side = CompensationSettings {
            left: left != (diameter < 0.0),
            radius: 0.5 * diameter.abs(),
            corners: if self.fanuc() { Corners::Lines } else { Corners::Arcs },
            beside_next: self.fanuc(),
            round_ends: false,
            tangent: if linuxcnc { 0.05 } else { 1e-6 },
        };
        self.track.compensate(side, self.modes.plane)
    }
}
