//! Tilted planes, tip control and tool vectors: what the rotary axes have to do with coordinates.

use nalgebra::Vector3;

use super::interpreter::Reader;
use crate::drive::{Coordinates, Sense};
use crate::gcode::codes::{Code, MotionMode};
use crate::gcode::okuma;
use crate::gcode::syntax::block::Block;
use crate::machines::{SHORTEST, WorkFrame};
use crate::text::assumption::Assumption;
use crate::text::error::NcProblem;

impl Reader {
    /// Whether coordinates are those of the tip, outside of tilted planes as well.
    fn tip_control(&self) -> bool {
        self.tip.kinematics || self.tip.by_length
    }

    /// Switches tip control as the codes of a block say: the tool stays where it is.
    pub(crate) fn switch_control(&mut self) -> Result<(), NcProblem> {
        self.set_coordinates(self.modes.tilt.is_some())
    }

    /// What coordinates are from now on. Where that is another place, and a machine's pivots are not known, the path breaks.
    fn set_coordinates(&mut self, tilted: bool) -> Result<(), NcProblem> {
        let coordinates = if tilted || self.tip_control() {
            Coordinates::Tip
        } else {
            Coordinates::Axes
        };
        if coordinates == self.track.coordinates || self.track.abc == [0.0; 3] {
            self.track.coordinates = coordinates;
            return Ok(());
        }
        self.refuse_compensation("a change of tip control")?;
        self.track.set_coordinates(coordinates)?;
        if self.track.known().is_none() {
            self.track.leave([true; 3]);
        }
        Ok(())
    }

    /// G68.2 and G268, G68.4, G53.1 and G253, G254 and G255, G43.5, G234.
    pub(crate) fn tilt(&mut self, code: Code, block: &Block) -> Result<(), NcProblem> {
        match code {
            Code::TiltedPlane => {
                let Some(frame) = self.plane_of(block)? else {
                    return Ok(());
                };
                self.set_tilt(Some(frame))
            }
            Code::FurtherTilt => {
                let Some(before) = self.modes.tilt else {
                    return Err(NcProblem::syntax(
                        "G68.4 without a tilted plane: expected G68.2 before it",
                    ));
                };
                let Some(frame) = self.plane_of(block)? else {
                    return Ok(());
                };
                self.set_tilt(Some(before.then(&frame)))
            }
            Code::AlignTool => {
                let Some(tilt) = self.modes.tilt else {
                    return Err(NcProblem::syntax(
                        "G53.1 without a tilted plane: expected G68.2 before it",
                    ));
                };
                self.align(tilt.direction([0.0, 0.0, 1.0]))
            }
            Code::DynamicOffset(true) => {
                self.track.driver.prefer(Sense::Tool);
                // The work offset turns with the table, and the axes do not: the tool is along Z in these coordinates.
                let turn = self.track.driver.orientation(self.track.abc)?;
                self.modes.dynamic = true;
                self.set_tilt(Some(WorkFrame::with_matrix(turn, Vector3::zeros())))
            }
            Code::DynamicOffset(false) | Code::CancelTilt => {
                self.modes.dynamic = false;
                self.set_tilt(None)
            }
            _ => Ok(()),
        }
    }

    /// Okuma's `CALL`: of an offset that turns with the table to these angles, or of something that only the machine knows.
    pub(crate) fn call_okuma(&mut self, call: &str) -> Result<(), NcProblem> {
        let Some(angles) = okuma::turned_offset(call) else {
            let name = call.split_whitespace().next().unwrap_or("").to_owned();
            if self.track.strict() {
                let problem = NcProblem::syntax(format!(
                    "the subprogram {name} is missing: expected the moves written out"
                ));
                return Err(problem);
            }
            let taken = "left out; where the tool is then is known again from the next moves";
            let what = format!("{name}, a program of the machine");
            self.track.assume(Assumption::new(what, taken, "the moves written out"));
            self.track.leave([true; 3]);
            return Ok(());
        };
        self.track.driver.prefer(Sense::Tool);
        self.modes.dynamic = angles != [0.0; 3];
        let turn = self.track.driver.orientation(angles)?;
        self.set_tilt(
            self.modes
                .dynamic
                .then(|| WorkFrame::with_matrix(turn, Vector3::zeros())),
        )
    }

    /// Another tilted plane, or none.
    pub(crate) fn set_tilt(&mut self, tilt: Option<WorkFrame>) -> Result<(), NcProblem> {
        if tilt == self.modes.tilt {
            return Ok(());
        }
        // In tilted planes coordinates are the tip's; the frame changes while they are.
        if tilt.is_some() {
            self.set_coordinates(true)?;
        }
        self.reframe(|reader| reader.modes.tilt = tilt)?;
        if tilt.is_none() {
            self.set_coordinates(false)?;
        }
        Ok(())
    }

    /// Turns the tool into a direction of the part's frame.
    fn align(&mut self, direction: [f64; 3]) -> Result<(), NcProblem> {
        self.refuse_compensation("a turn of the tool")?;
        let rapid = self.modes.motion != Some(MotionMode::Feed);
        if self.track.turn_to(direction, Some(rapid))? {
            self.track
                .note("the tool is turned into a tilted plane: the path breaks here");
        }
        Ok(())
    }

    /// The angles at the end of a block with a tool vector (`G43.5` with I, J, K), or those given.
    pub(crate) fn aim(&mut self, block: &Block, motion: MotionMode, abc: [f64; 3]) -> Result<[f64; 3], NcProblem> {
        if !self.has_vector(block, motion) {
            return Ok(abc);
        }
        let vector = ['I', 'J', 'K'].map(|letter| block.get(letter).unwrap_or(0.0));
        if vector.iter().all(|c| c.abs() < SHORTEST) {
            return Err(NcProblem::syntax(
                "the tool vector I J K is (0, 0, 0): expected a direction",
            ));
        }
        let direction = self.track.frame().direction(vector);
        if self.track.driver.knows_rotaries() {
            return self.track.driver.angles(direction, abc);
        }
        if !self.tip_control() {
            return Err(NcProblem::syntax(
                "a tool vector without tip control: expected G43.5 before it",
            ));
        }
        self.refuse_compensation("a turn of the tool")?;
        // The start of the move still has the old direction.
        if motion != MotionMode::Rapid {
            self.track.begin(false)?;
        }
        self.track.direct = Some(direction);
        Ok(abc)
    }

    /// Whether I, J and K of a block are a tool vector.
    pub(crate) fn has_vector(&self, block: &Block, motion: MotionMode) -> bool {
        self.tip.vectors
            && self.tip.by_length
            && matches!(motion, MotionMode::Rapid | MotionMode::Feed)
            && block.first("IJK").is_some()
    }

    /// A block that turns rotary axes where coordinates say nothing of the tip: whether that is all it does.
    pub(crate) fn turn_alone(&mut self, block: &Block, motion: MotionMode, abc: [f64; 3]) -> Result<bool, NcProblem> {
        if abc == self.track.abc {
            return Ok(false);
        }
        let alone = block.first("XYZIJKR").is_none();
        if self.modes.tilt.is_some() && !self.tip_control() {
            if !(self.modes.dynamic && alone && motion == MotionMode::Rapid) {
                return Err(NcProblem::unsupported(
                    "turning an axis in a tilted plane is",
                    "the plane would turn with it; expected G69 or G255 before it",
                ));
            }
            self.turn_away(abc)?;
            self.tilt(Code::DynamicOffset(true), block)?;
            return Ok(true);
        }
        let unknown = self.track.coordinates == Coordinates::Axes && self.track.driver.kinematics().is_none();
        if unknown && alone && motion == MotionMode::Rapid {
            self.turn_away(abc)?;
            return Ok(true);
        }
        Ok(false)
    }

    fn turn_away(&mut self, abc: [f64; 3]) -> Result<(), NcProblem> {
        self.refuse_compensation("a turn of the rotary axes")?;
        self.track
            .note("rotary axes turn where only the machine knows the tip: the path breaks here");
        self.track.turn_unknown(abc)
    }
}
