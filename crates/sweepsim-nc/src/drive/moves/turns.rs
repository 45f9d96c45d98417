//! Turning the tool into a direction, between moves.

use nalgebra::Vector3;

use crate::drive::driver::Coordinates;
use crate::drive::track::Track;
use crate::machines::Position;
use crate::text::error::NcProblem;

impl Track {
    /// Turns the tool into a direction of the part's frame. Whether the path breaks there: the machine has to be known, and its linear axes
    /// to stand still, which `rapid` says by giving the kind of the move.
    pub fn turn_to(&mut self, direction: [f64; 3], rapid: Option<bool>) -> Result<bool, NcProblem> {
        self.refuse_contour("a turn of the tool")?;
        let now = Vector3::from(self.direction()?);
        if (now - Vector3::from(direction).normalize()).norm() < 1e-12 {
            return Ok(false);
        }
        if self.driver.knows_rotaries() {
            let abc = self.driver.angles(direction, self.abc)?;
            return self.turn_to_angles(abc, rapid);
        }
        self.direct = Some(direction);
        self.leave([true; 3]);
        Ok(true)
    }

    /// Turns the rotary axes to angles, as [`turn_to`](Self::turn_to) does.
    pub fn turn_to_angles(&mut self, abc: [f64; 3], rapid: Option<bool>) -> Result<bool, NcProblem> {
        if let Some(rapid) = rapid
            && self.turn_in_place(abc, rapid)?
        {
            return Ok(false);
        }
        self.abc = abc;
        self.direct = None;
        self.leave([true; 3]);
        Ok(true)
    }

    /// Turns the rotary axes while the linear ones stand still, if all are known.
    fn turn_in_place(&mut self, abc: [f64; 3], rapid: bool) -> Result<bool, NcProblem> {
        let Some(xyz) = self.known().filter(|_| self.driver.kinematics().is_some()) else {
            return Ok(false);
        };
        let here = self.frame.point(xyz);
        let axes = match self.coordinates {
            Coordinates::Axes => Some(here),
            Coordinates::Tip => self.driver.axes_at(here, self.abc),
        };
        let Some(axes) = axes else { return Ok(false) };
        let frame = std::mem::take(&mut self.frame);
        let coordinates = std::mem::replace(&mut self.coordinates, Coordinates::Axes);
        self.xyz = axes.map(Some);
        let result = self.straight(axes, abc, rapid);
        (self.frame, self.coordinates) = (frame, coordinates);
        result?;
        let there = match coordinates {
            Coordinates::Axes => axes,
            Coordinates::Tip => self.driver.tip(&Position::new(axes, abc))?,
        };
        self.xyz = self.frame.inverse_point(there).map_or([None; 3], |xyz| xyz.map(Some));
        Ok(true)
    }
}
