//! The search for the moves that touch material, and for the time at which they first do.
//!
//! Stock only shrinks: for a run of moves with material `S₀` before it and `S₁` after it, each `S(t)` lies between them. If what the solid sweeps in the
//! run meets no `S₀`, the run is safe; otherwise it is halved, the first half first, since its end is the second half's beginning. A single move is
//! halved in time, until no point of the solid moves farther than the tolerance.
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

/// The largest number of halves that the search in one move examines.
const MOST_WINDOWS: usize = 4096;

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

impl Arena<'_> {
    /// What a solid sweeps on the lines of `material`.
    fn swept(
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
    fn overlap(
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

    /// All moves of a run that touch `material`, which is all there is on some lines before the run.
    pub fn touches(
        &mut self,
        touching: Touching,
        moves: Range<usize>,
        material: &Lines,
        found: &mut Vec<Touch>,
    ) -> Result<(), SweepError> {
        let parts = touching.probe.slice(touching.probe.parts(moves.clone()));
        let met = self.overlap(touching.probe, parts, material, touching.strict)?;
        if met.is_empty() {
            return Ok(());
        }
        let material = material.on_lines_of(&met);
        if moves.len() == 1 {
            found.extend(self.within_move(touching, moves.start, material, met)?);
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

    /// The first time at which a move touches material, given all that it meets of the material before it.
    fn within_move(
        &mut self,
        touching: Touching,
        number: usize,
        material: Lines,
        met: Lines,
    ) -> Result<Option<Touch>, SweepError> {
        let found = if touching.own || touching.eater.is_none() {
            Some(self.first_of_static(touching, number, material, met.clone())?)
        } else {
            self.first_of_shrinking(touching, number, &material)?
        };
        let Some((time, first)) = found else { return Ok(None) };
        let mut all = met;
        if let (Some(eater), false) = (touching.eater, touching.own) {
            let parts = eater.slice(eater.parts(number..number + 1));
            let left = all
                .without(&self.swept(eater, parts, &all)?)
                .longer_than(self.options.tolerance);
            all = if left.is_empty() { first.clone() } else { left };
        }
        Ok(Some(Touch {
            number,
            time,
            first,
            all,
        }))
    }

    /// The first time at which a move meets material that nothing removes before.
    fn first_of_static(
        &mut self,
        touching: Touching,
        number: usize,
        mut material: Lines,
        met: Lines,
    ) -> Result<(f64, Lines), SweepError> {
        let (mut window, mut first) = ([0.0, 1.0], met);
        loop {
            let middle = 0.5 * (window[0] + window[1]);
            let parts = touching.probe.within(number, [window[0], middle]);
            if touching.probe.travel(&touching.probe.within(number, window)) <= self.options.tolerance
                || parts.is_empty()
                || middle <= window[0]
            {
                return Ok((window[0], first));
            }
            let met = self.overlap(touching.probe, &parts, &material, touching.strict)?;
            if met.is_empty() {
                window[0] = middle;
            } else {
                material = material.on_lines_of(&met);
                (window[1], first) = (middle, met);
            }
        }
    }

    /// The first time at which a move meets material that is removed while it goes.
    fn first_of_shrinking(
        &mut self,
        touching: Touching,
        number: usize,
        material: &Lines,
    ) -> Result<Option<(f64, Lines)>, SweepError> {
        // Windows still to look at, the earliest on top, with the material before each; without it if it is that left by the window just done.
        let mut open: Vec<[f64; 2]> = vec![[0.0, 1.0]];
        let mut before = material.clone();
        let mut seen = 0;
        while let Some(window) = open.pop() {
            seen += 1;
            if seen > MOST_WINDOWS {
                self.undecided.push(number);
                return Ok(None);
            }
            let parts = touching.probe.within(number, window);
            let met = self.overlap(touching.probe, &parts, &before, touching.strict)?;
            let middle = 0.5 * (window[0] + window[1]);
            let short = touching.probe.travel(&parts) <= self.options.tolerance || middle <= window[0];
            if !met.is_empty() && !short {
                open.extend([[middle, window[1]], [window[0], middle]]);
                continue;
            }
            if let Some(eater) = touching.eater {
                let eaten = self.swept(eater, &eater.within(number, window), &before)?;
                let left = met.without(&eaten).longer_than(self.options.tolerance);
                if !left.is_empty() {
                    return Ok(Some((window[0], left)));
                }
                before = before.without(&eaten);
            }
        }
        Ok(None)
    }
}
