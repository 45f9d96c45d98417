//! Tilted planes, tip control and tool vectors: what the rotary axes have to do with coordinates.

use super::interpreter::Reader;
use crate::drive::{Coordinates, Sense};
use crate::gcode::codes::{Code, MotionMode};
use crate::gcode::motion::map::Map;
use crate::gcode::syntax::block::Block;
use crate::machines::{Position, SHORTEST, WorkFrame};
use crate::text::error::NcProblem;

/// A frame as a map from the program's coordinates.
fn map_of(frame: &WorkFrame) -> Map {
    let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|unit| frame.direction(unit));
    Map {
        matrix: Some(std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]))),
        add: frame.origin(),
    }
}

impl Reader {
    /// Switches tip control as the codes of a block say: the tool stays where it is.
    pub(crate) fn switch_control(&mut self) -> Result<(), NcProblem> {
        let on = self.kinematics || self.length_control;
        self.change_coordinates(|reader| reader.state.tip_control = on)
    }

    /// A change of what coordinates are. Where that is another place, and a machine's pivots are not known, the path breaks.
    fn change_coordinates(&mut self, change: impl FnOnce(&mut Self)) -> Result<(), NcProblem> {
        let before = self.state.coordinates();
        change(self);
        let after = self.state.coordinates();
        if before == after || self.state.abc == [0.0; 3] {
            return Ok(());
        }
        self.refuse_compensation("a change of tip control")?;
        let abc = self.state.abc;
        let there = self.state.known().and_then(|xyz| match after {
            Coordinates::Tip => self.state.driver.tip(&Position::new(xyz, abc)).ok(),
            Coordinates::Axes => self.state.driver.axes_at(xyz, abc),
        });
        match there.zip(self.map.inverse()) {
            Some((xyz, inverse)) => {
                self.at = inverse.apply(xyz).map(Some);
                self.state.xyz = xyz.map(Some);
            }
            None => self.lose_place(),
        }
        Ok(())
    }

    /// Where the tip is becomes unknown: the path breaks.
    fn lose_place(&mut self) {
        self.at = [None; 3];
        self.state.xyz = [None; 3];
        self.state.leave();
    }

    /// G68.2 and G268, G68.4, G53.1 and G253, G254 and G255, G43.5, G234.
    pub(crate) fn tilt(&mut self, code: Code, block: &Block) -> Result<(), NcProblem> {
        match code {
            Code::TiltedPlane => {
                let Some(frame) = self.plane_of(block)? else {
                    return Ok(());
                };
                self.set_tilt(Some(map_of(&frame)))
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
                self.set_tilt(Some(before.after(&map_of(&frame))))
            }
            Code::AlignTool => {
                let Some(tilt) = self.modes.tilt else {
                    return Err(NcProblem::syntax(
                        "G53.1 without a tilted plane: expected G68.2 before it",
                    ));
                };
                self.align(tilt.apply_direction([0.0, 0.0, 1.0]))
            }
            Code::DynamicOffset(true) => {
                self.state.driver.prefer(Sense::Tool);
                // The work offset turns with the table, and the axes do not: the tool is along Z in these coordinates.
                let turn = self.state.driver.orientation(self.state.abc)?;
                let map = Map {
                    matrix: Some(std::array::from_fn(|i| std::array::from_fn(|j| turn[(i, j)]))),
                    add: [0.0; 3],
                };
                self.modes.dynamic = true;
                self.set_tilt(Some(map))
            }
            Code::DynamicOffset(false) | Code::CancelTilt => {
                self.modes.dynamic = false;
                self.set_tilt(None)
            }
            _ => Ok(()),
        }
    }

    /// Another tilted plane, or none.
    pub(crate) fn set_tilt(&mut self, tilt: Option<Map>) -> Result<(), NcProblem> {
        if tilt == self.modes.tilt {
            return Ok(());
        }
        // In tilted planes coordinates are the tip's; the frame changes while they are.
        if tilt.is_some() {
            self.change_coordinates(|reader| reader.state.tilted = true)?;
        }
        self.reframe(|reader| {
            reader.modes.tilt = tilt;
            Ok(())
        })?;
        if tilt.is_none() {
            self.change_coordinates(|reader| reader.state.tilted = false)?;
        }
        Ok(())
    }

    /// Turns the tool into a direction of the part's frame.
    fn align(&mut self, direction: [f64; 3]) -> Result<(), NcProblem> {
        let now = match self.state.direct {
            Some(direct) => direct,
            None => self.state.driver.axis(self.state.abc)?,
        };
        let length = direction.iter().map(|c| c * c).sum::<f64>().sqrt();
        if now.iter().zip(direction).all(|(a, b)| (a - b / length).abs() < 1e-12) {
            return Ok(());
        }
        self.refuse_compensation("a turn of the tool")?;
        if self.state.driver.knows_rotaries() {
            let abc = self.state.driver.angles(direction, self.state.abc)?;
            let rapid = self.modes.motion != Some(MotionMode::Feed);
            if let (true, Some(inverse)) = (self.known_position().is_some(), self.map.inverse())
                && let Some(xyz) = self.state.turn_in_place(abc, rapid)?
            {
                self.at = inverse.apply(xyz).map(Some);
                return Ok(());
            }
            self.state.abc = abc;
            self.state.direct = None;
        } else {
            self.state.direct = Some(direction);
        }
        self.state
            .note("the tool is turned into a tilted plane: the path breaks here");
        self.lose_place();
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
        let direction = self.map.apply_direction(vector);
        if self.state.driver.knows_rotaries() {
            return self.state.driver.angles(direction, abc);
        }
        if !self.state.tip_control {
            return Err(NcProblem::syntax(
                "a tool vector without tip control: expected G43.5 before it",
            ));
        }
        self.refuse_compensation("a turn of the tool")?;
        // The start of the move still has the old direction.
        if motion != MotionMode::Rapid {
            self.state.start_here()?;
        }
        self.state.direct = Some(direction);
        Ok(abc)
    }

    /// Whether I, J and K of a block are a tool vector.
    pub(crate) fn has_vector(&self, block: &Block, motion: MotionMode) -> bool {
        self.vectors
            && self.length_control
            && matches!(motion, MotionMode::Rapid | MotionMode::Feed)
            && block.first("IJK").is_some()
    }

    /// A block that turns rotary axes where coordinates say nothing of the tip: whether that is all it does.
    pub(crate) fn turn_alone(&mut self, block: &Block, motion: MotionMode, abc: [f64; 3]) -> Result<bool, NcProblem> {
        if abc == self.state.abc {
            return Ok(false);
        }
        let alone = block.first("XYZIJKR").is_none();
        if self.state.tilted && !self.state.tip_control {
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
        let unknown = self.state.coordinates() == Coordinates::Axes && self.state.driver.kinematics().is_none();
        if unknown && alone && motion == MotionMode::Rapid {
            self.turn_away(abc)?;
            return Ok(true);
        }
        Ok(false)
    }

    fn turn_away(&mut self, abc: [f64; 3]) -> Result<(), NcProblem> {
        self.refuse_compensation("a turn of the rotary axes")?;
        self.state.driver.axis(abc)?;
        self.state
            .note("rotary axes turn where only the machine knows the tip: the path breaks here");
        self.state.abc = abc;
        self.state.direct = None;
        self.lose_place();
        Ok(())
    }
}
