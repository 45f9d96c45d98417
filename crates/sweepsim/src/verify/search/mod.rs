//! The search for the moves that touch material, and for the time at which they first do.
//!
//! Stock only shrinks: for a run of moves with material `S₀` before it and `S₁` after it, each `S(t)` lies between them. If what the solid sweeps in the
//! run meets no `S₀`, the run is safe. Otherwise its moves are taken one by one: what each of them removes gives the material before the next, and then
//! they are independent of each other.

mod contact;
mod moment;
mod moves;

use super::lines::Lines;
use super::solid::MovingSolid;
use crate::error::SweepError;
use crate::methods::lattice::LineMask;
use crate::sweep::{Options, UnresolvedDexel};
use crate::time::path_parts::PathPart;
use sweepsim_dexel::{Grid, Interval};
use sweepsim_solve::Monitor;

/// What touches the material, and what removes it meanwhile.
#[derive(Clone, Copy)]
pub(super) struct Touching<'a> {
    /// What must not touch.
    pub probe: &'a MovingSolid<'a>,
    /// What removes material; `None` if nothing does.
    pub eater: Option<&'a MovingSolid<'a>>,
    /// Whether the probe is a cutter itself. It touches what it then removes.
    pub own: bool,
    /// Whether contact is no overlap.
    pub strict: bool,
    /// The solid itself, if the probe is a larger one about it.
    pub itself: Option<&'a MovingSolid<'a>>,
}

impl<'a> Touching<'a> {
    /// Of what nothing removes.
    pub fn still(probe: &'a MovingSolid<'a>, itself: Option<&'a MovingSolid<'a>>) -> Self {
        Self {
            probe,
            eater: None,
            own: false,
            strict: true,
            itself,
        }
    }
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
    /// Only the larger solid touches.
    pub near: bool,
    /// Whether `all` is there throughout, and not removed by the same move later.
    pub stays: bool,
    /// All that it touches. For a body, what even the end of the move has not removed, if there is such material.
    pub all: Lines,
}

impl Touch {
    /// Takes in what else the same move touches.
    fn join(&mut self, more: Self) {
        if more.time < self.time {
            (self.time, self.first) = (more.time, more.first);
        }
        self.all = self.all.united(&more.all);
    }
}

/// What a solid sweeps of some lines, sorted by line.
pub(super) type Swept = Vec<(u32, Vec<Interval>)>;

/// One grid, and what is needed to sweep solids on it.
pub(super) struct Arena<'a> {
    pub grid: &'a Grid,
    /// No material is higher.
    pub top: f64,
    pub options: &'a Options,
    pub monitor: &'a dyn Monitor,
    /// Dexels of sweeps that could not be certified.
    pub unresolved: Vec<UnresolvedDexel>,
    /// Moves whose search ran out of its budget, by number.
    pub undecided: Vec<usize>,
}

impl<'a> Arena<'a> {
    pub fn new((grid, top): (&'a Grid, f64), options: &'a Options, monitor: &'a dyn Monitor) -> Self {
        Self {
            grid,
            top,
            options,
            monitor,
            unresolved: Vec::new(),
            undecided: Vec::new(),
        }
    }

    /// What a solid sweeps on the lines of `material`.
    pub fn swept(&mut self, solid: &MovingSolid, parts: &[PathPart], material: &Lines) -> Result<Swept, SweepError> {
        let Some(mask) = LineMask::new(self.grid, material.numbers()) else {
            return Ok(Vec::new());
        };
        let swept = solid.swept(parts, (self.grid, self.top), &mask, self.options, self.monitor)?;
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
        if strict {
            self.confirmed(solid, parts, common)
        } else {
            Ok(common)
        }
    }
}
