//! Pockets: a control says in its own words what a pocket is, and the moves are made here.

use std::f64::consts::TAU;

use super::contour::Bend;
use super::track::Track;
use crate::text::error::NcProblem;

impl Track {
    /// Goes around circles about the position in the plane XY, each smaller by the tool's radius: to each and back on semicircles towards +X.
    pub fn circles(&mut self, circles: &[f64], tool: f64, counter_clockwise: bool) -> Result<(), NcProblem> {
        let Some(centre) = self.known() else { return Ok(()) };
        let turn = if counter_clockwise { TAU } else { -TAU };
        let [x, y, z] = centre;
        let mut bow = |end: f64, centre: f64, sweep: f64| {
            let mut stroke = self.stroke([x + end, y, z], self.abc, false, None, [0, 1, 2]);
            let centre = [x + centre, y];
            stroke.bend = Some(Bend { centre, sweep });
            self.go(stroke)
        };
        let mut at = 0.0;
        for circle in circles.iter().map(|circle| circle - tool).chain([0.0]) {
            bow(circle, 0.5 * (at + circle), 0.5 * turn)?;
            if circle > 0.0 {
                bow(circle, 0.0, turn)?;
            }
            at = circle;
        }
        Ok(())
    }
}
