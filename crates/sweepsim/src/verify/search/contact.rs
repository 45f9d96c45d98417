//! Contact is no overlap.
//!
//! A shank that follows its cutter along a wall touches it, and so does a cutter that leaves the slot it has made. Positions are exact to a fraction of
//! the tolerance only, so whether a line in such a wall counts as inside is arbitrary, and over its whole length. An overlap is therefore real only if it
//! is longer than the tolerance and is still there when the solid is moved by the tolerance in each of four directions across the line.
//!
//! Where a neighbouring line is met at the same heights, the solid reaches beyond the tolerance on that side, unless something hides between the two. Such
//! lines are not asked for, except the deepest: what is found has at least one line that was moved in all directions.

use super::Arena;
use crate::error::SweepError;
use crate::time::path_parts::{PartKind, PathPart};
use crate::verify::lines::Lines;
use crate::verify::solid::MovingSolid;
use nalgebra::Matrix3;

/// So many of the deepest overlaps are asked first where one is enough.
const FEW: usize = 8;

impl Arena<'_> {
    /// The part of an overlap that is more than contact. Its deepest interval is asked for in any case, so that it is not empty by neighbours alone.
    pub fn confirmed(&mut self, solid: &MovingSolid, parts: &[PathPart], common: Lines) -> Result<Lines, SweepError> {
        let Some((deepest, _)) = common.longest() else {
            return Ok(common);
        };
        let mut sure = common.clone();
        for (side, shift) in self.shifts().into_iter().enumerate() {
            let asked = sure.on_lines_where(|line| line == deepest || !common.has_neighbour(self.grid, line, side));
            let kept = self.moved(solid, parts, shift, &asked)?;
            if kept.of_line(deepest).is_empty() {
                return self.withstood(solid, parts, common);
            }
            sure = sure.replaced(&asked, &kept);
        }
        Ok(sure)
    }

    /// Whether an overlap is more than contact; if so, it need not be searched for what is not. Otherwise what of it is.
    pub fn certified(&mut self, solid: &MovingSolid, parts: &[PathPart], common: Lines) -> Result<Lines, SweepError> {
        let few = common.deepest(FEW);
        if !self.withstood(solid, parts, few)?.is_empty() {
            return Ok(common);
        }
        self.withstood(solid, parts, common)
    }

    /// Away from the neighbours of a line, in the order of [`Lines::has_neighbour`].
    fn shifts(&self) -> [[f64; 3]; 4] {
        let step = self.options.tolerance;
        [[step, 0.0, 0.0], [-step, 0.0, 0.0], [0.0, step, 0.0], [0.0, -step, 0.0]]
    }

    /// What is still there when the solid is moved in each of four directions.
    pub(super) fn withstood(
        &mut self,
        solid: &MovingSolid,
        parts: &[PathPart],
        mut common: Lines,
    ) -> Result<Lines, SweepError> {
        for shift in self.shifts() {
            if common.is_empty() {
                break;
            }
            common = self.moved(solid, parts, shift, &common)?;
        }
        Ok(common)
    }

    /// What is still there when the solid is moved.
    fn moved(
        &mut self,
        solid: &MovingSolid,
        parts: &[PathPart],
        shift: [f64; 3],
        common: &Lines,
    ) -> Result<Lines, SweepError> {
        let moved = |part: &PathPart| PathPart {
            segment: part.segment.moved(&Matrix3::identity(), shift),
            kind: match part.kind {
                PartKind::LevelArc(arc) => PartKind::LevelArc(arc.moved([shift[0], shift[1]])),
                PartKind::VerticalArc(arc) => PartKind::VerticalArc(arc.moved(shift)),
                ref other => other.clone(),
            },
            ..part.clone()
        };
        let moved: Vec<PathPart> = parts.iter().map(moved).collect();
        let swept = self.swept(solid, &moved, common)?;
        Ok(common.common(&swept, self.options.tolerance))
    }
}
