//! Programmed moves, and the switch of cutter compensation.

use crate::drive::{CompensationSettings, Corner, CornerShape, Corners, DiameterAsked, Stroke, end_at_angle};
use crate::gcode::codes::MotionMode;
use crate::gcode::run::interpreter::Reader;
use crate::gcode::run::tools::ToolRow;
use crate::gcode::syntax::block::{Block, Word};
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

    /// What a word after a comma needs.
    pub(crate) fn check_after_comma(&self, word: &Word, moves: bool) -> Result<(), NcProblem> {
        let name = format!(",{}", word.letter);
        if self.rules.controller == Some(Controller::LinuxCnc) {
            return Err(NcProblem::unsupported(
                format!("{name} on LinuxCNC is"),
                "expected the corner or the end written out",
            ));
        }
        if !moves {
            return Err(NcProblem::syntax(format!(
                "{name} without a move: expected it in the block of one"
            )));
        }
        match self.modes.motion {
            Some(MotionMode::Feed) => Ok(()),
            Some(MotionMode::Arc { .. }) if word.letter != 'A' => Ok(()),
            Some(MotionMode::Rapid) if word.letter != 'A' => Err(NcProblem::unsupported(
                format!("{name} at a rapid is"),
                "expected it between two feed moves",
            )),
            _ => Err(NcProblem::syntax(format!("{name} in a move of this kind: expected G1"))),
        }
    }

    /// The corner at the end of the move of this block, if it has one.
    pub(super) fn corner_at_end(&mut self, block: &Block) -> Result<(), NcProblem> {
        let Some(word) = block.corner else { return Ok(()) };
        let size = word.value * self.unit();
        if !(size > 0.0) {
            return Err(NcProblem::value(format!(",{}", word.letter), word.value, "positive"));
        }
        let (name, shape) = match word.letter {
            'R' => (",R", CornerShape::Round(size)),
            _ => (",C", CornerShape::Cut(size)),
        };
        self.track.corner_next(Corner {
            shape,
            plane: self.modes.plane,
            place: self.track.place,
            feed: None,
            word: name,
            strict: true,
        });
        Ok(())
    }

    /// The coordinate that `,A` leaves to the angle of the line.
    pub(super) fn along_angle(&self, block: &Block, mut to: [Option<f64>; 3]) -> Result<[Option<f64>; 3], NcProblem> {
        let Some(word) = block.angle else { return Ok(to) };
        let [u, v, _] = self.modes.plane;
        let given = [u, v].map(|k| block.has(['X', 'Y', 'Z'][k]));
        if given[0] == given[1] {
            let problem = ",A beside both coordinates of the plane, or neither: expected one";
            return Err(NcProblem::syntax(problem));
        }
        let here = self.track.xyz;
        let ([Some(a), Some(b)], [Some(x), Some(y)]) = ([u, v].map(|k| here[k]), [u, v].map(|k| to[k])) else {
            return Ok(to);
        };
        let end = end_at_angle([a, b], [x, y], given[0], word.value.to_radians());
        let [a, b] = end.ok_or_else(|| NcProblem::value(",A", word.value, "an angle at which the line gets there"))?;
        (to[u], to[v]) = (Some(a), Some(b));
        Ok(to)
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
