//! The search for the moves that touch material, and for the time at which they first do.
//!
//! Stock only shrinks: for a run of moves with material `S₀` before it and `S₁` after it, each `S(t)` lies between them. If what the solid sweeps in the
//! run meets no `S₀`, the run is safe; otherwise it is halved, the first half first, since its end is the second half's beginning. What is left are single
//! moves, independent of each other, for the search in time.
//!
//! *Contact.* A shank that follows its cutter along a wall touches it, and so does a cutter that leaves the slot it has made. Positions are exact to a
//! fraction of the tolerance only, so whether a line in such a wall counts as inside is arbitrary, and over its whole length. An overlap is therefore real
//! only if it is longer than the tolerance and is still there when the solid is moved by the tolerance in each of four directions across the line.

use super::lines::Lines;
use super::solid::MovingSolid;
use crate::error::SweepError;
use crate::methods::line_mask::LineMask;
use crate::sweep::{Options, UnresolvedDexel};
use crate::time::path_parts::PathPart;
use nalgebra::Matrix3;
use std::ops::Range;
use sweepsim_dexel::{Grid, Interval};
use sweepsim_solve::Monitor;

/// What touches the material, and what removes it meanwhile.
#[derive(Clone, Copy)]
pub(super) struct Touching<'a> {
    /// What must not touch.
    pub probe: &'a MovingSolid<'a>,
    /// What removes material; `None` if nothing does.
    pub eater: Option<&'a MovingSolid<'a>>,
    /// Whether the probe is the eater itself. It touches what it then removes.
    pub own: bool,
    /// Whether contact is no overlap.
    pub strict: bool,
}

/// A move that touches material.
#[derive(Clone, Debug)]
pub(super) struct Touch {
    /// Number of the move.
    pub number: usize,
    /// When, as a fraction of the move.
    pub time: f64,
    /// What it touches first.
    pub first: Lines,
    /// All that it touches. For a body, what even the end of the move has not removed, if there is such material.
    pub all: Lines,
}

/// A move that meets material which was there before it.
pub(super) struct Suspect {
    pub number: usize,
    /// What there was on the lines that it meets.
    pub material: Lines,
    /// What it meets.
    pub met: Lines,
}

/// One grid, and what is needed to sweep solids on it.
pub(super) struct Arena<'a> {
    pub grid: &'a Grid,
    pub options: &'a Options,
    pub monitor: &'a dyn Monitor,
    /// Dexels of sweeps that could not be certified.
    pub unresolved: Vec<UnresolvedDexel>,
    /// Moves whose search ran out of its budget, by number.
    pub undecided: Vec<usize>,
}

impl<'a> Arena<'a> {
    pub fn new(grid: &'a Grid, options: &'a Options, monitor: &'a dyn Monitor) -> Self {
        Self {
            grid,
            options,
            monitor,
            unresolved: Vec::new(),
            undecided: Vec::new(),
        }
    }

    /// What a solid sweeps on the lines of `material`.
    pub fn swept(
        &mut self,
        solid: &MovingSolid,
        parts: &[PathPart],
        material: &Lines,
    ) -> Result<Vec<(u32, Vec<Interval>)>, SweepError> {
        let Some(mask) = LineMask::new(self.grid, material.numbers()) else {
            return Ok(Vec::new());
        };
        let swept = solid.swept(parts, self.grid, &mask, self.options, self.monitor)?;
        self.unresolved.extend(swept.unresolved);
        Ok(swept.lines)
    }

    /// The material that a solid meets along these parts.
    pub fn overlap(
        &mut self,
        solid: &MovingSolid,
        parts: &[PathPart],
        material: &Lines,
        strict: bool,
    ) -> Result<Lines, SweepError> {
        let swept = self.swept(solid, parts, material)?;
        let common = material.common(&swept, self.options.tolerance);
        self.confirmed(solid, parts, common, strict)
    }

    /// The part of an overlap that is more than contact.
    pub fn confirmed(
        &mut self,
        solid: &MovingSolid,
        parts: &[PathPart],
        mut common: Lines,
        strict: bool,
    ) -> Result<Lines, SweepError> {
        let step = self.options.tolerance;
        let shifts = [[step, 0.0, 0.0], [-step, 0.0, 0.0], [0.0, step, 0.0], [0.0, -step, 0.0]];
        for shift in shifts {
            if common.is_empty() || !strict {
                break;
            }
            let moved: Vec<PathPart> = parts
                .iter()
                .map(|part| PathPart {
                    segment: part.segment.moved(&Matrix3::identity(), shift),
                    ..part.clone()
                })
                .collect();
            let swept = self.swept(solid, &moved, &common)?;
            common = common.common(&swept, self.options.tolerance);
        }
        Ok(common)
    }

    /// The moves of a run that may touch `material`, which is all there is on some lines before the run.
    pub fn touches(
        &mut self,
        touching: Touching,
        moves: Range<usize>,
        material: &Lines,
        found: &mut Vec<Suspect>,
    ) -> Result<(), SweepError> {
        let parts = touching.probe.slice(touching.probe.parts(moves.clone()));
        let met = self.overlap(touching.probe, parts, material, touching.strict)?;
        if met.is_empty() {
            return Ok(());
        }
        let material = material.on_lines_of(&met);
        if moves.len() == 1 {
            let number = moves.start;
            found.push(Suspect { number, material, met });
            return Ok(());
        }
        let middle = moves.start + moves.len() / 2;
        self.touches(touching, moves.start..middle, &material, found)?;
        let rest = match touching.eater {
            Some(eater) => {
                let parts = eater.slice(eater.parts(moves.start..middle));
                material.without(&self.swept(eater, parts, &material)?)
            }
            None => material,
        };
        self.touches(touching, middle..moves.end, &rest, found)
    }
}
