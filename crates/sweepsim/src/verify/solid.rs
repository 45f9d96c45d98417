//! A solid that moves along a path: the cutter, or a body that moves with it.

use crate::error::SweepError;
use crate::methods::lattice::LineMask;
use crate::sweep::heights::{Box3, HeightMap, window};
use crate::sweep::{CHUNK, Method, Options, Plan, SpareLists, SweptLines};
use crate::time::path_parts::PathPart;
use crate::time::swept_box::swept_box;
use nalgebra::{Matrix3, Vector3};
use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;
use sweepsim_dexel::Grid;
use sweepsim_motion::{Path, Segment, Tool};
use sweepsim_solve::Monitor;

/// So many parts of a path have a box in common.
const BLOCK: usize = 32;

/// A solid and its path, prepared.
pub struct MovingSolid<'a> {
    tool: &'a Tool,
    plan: Plan,
    /// One box for each part of the path, which holds all that the solid sweeps there.
    boxes: Vec<Box3>,
    /// One for each block of parts.
    hulls: Vec<Box3>,
    lists: SpareLists,
}

/// A bound on how far any point of the solid moves.
fn travel(segment: &Segment, reach: f64) -> f64 {
    let (points, weights) = segment.points();
    let tips: Vec<Vector3<f64>> = points
        .iter()
        .zip(&weights)
        .map(|(point, weight)| point / *weight)
        .collect();
    let turns = segment.turns().iter().zip(segment.weights());
    let turns: Vec<Matrix3<f64>> = turns.map(|(turn, weight)| turn / *weight).collect();
    // A rational curve with positive weights meets no plane more often than its control polygon does, hence is no longer (Cauchy, Crofton).
    let tip: f64 = tips.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
    let turn: f64 = turns.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
    tip + reach * turn
}

/// The box that holds some boxes.
fn hull(boxes: &[Box3]) -> Box3 {
    let none = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    let both = |a: Box3, b: &Box3| std::array::from_fn(|k| [a[k][0].min(b[k][0]), a[k][1].max(b[k][1])]);
    boxes.iter().fold(none, both)
}

impl<'a> MovingSolid<'a> {
    /// Along some moves of a path. `grids`: those on which it will be swept; all of them in one frame.
    pub fn new(
        tool: &'a Tool,
        (path, moves): (&Path, Range<usize>),
        grids: &[Grid],
        options: &Options,
    ) -> Result<Self, SweepError> {
        let extent = grids.iter().flat_map(|grid| grid.min().into_iter().chain(grid.max()));
        let plan = Plan::of_moves((tool, path, moves), grids[0].frame(), extent, options)?;
        Ok(Self::planned(tool, plan, options))
    }

    /// The same solid along another path. It will be swept on the same grids, one of which is `grid`.
    pub fn along(&self, path: &Path, grid: &Grid, options: &Options) -> Result<Self, SweepError> {
        let plan = self.plan.along((self.tool, path), grid.frame(), options)?;
        Ok(Self::planned(self.tool, plan, options))
    }

    fn planned(tool: &'a Tool, plan: Plan, options: &Options) -> Self {
        let cylinder = tool.bounding_cylinder();
        // More than all displacements together.
        let margin = options.tolerance;
        let boxes = plan.parts.iter().map(|part| swept_box(&part.segment, cylinder, margin));
        let boxes: Vec<Box3> = boxes.collect();
        Self {
            hulls: boxes.chunks(BLOCK).map(hull).collect(),
            boxes,
            tool,
            plan,
            lists: SpareLists::default(),
        }
    }

    /// The parts of these moves.
    pub fn parts(&self, moves: Range<usize>) -> Range<usize> {
        let at = |number: usize| self.plan.parts.partition_point(|part| (part.number as usize) < number);
        at(moves.start)..at(moves.end)
    }

    /// These parts themselves.
    pub fn slice(&self, parts: Range<usize>) -> &[PathPart] {
        &self.plan.parts[parts]
    }

    /// The motion between two times of a move, from 0 to 1, in generic position.
    ///
    /// The displacement of a move's tips is spread over its whole length. What a short part has of it is lost in rounding, and then a flat end that moves
    /// sideways has `g` of any sign, and another one at each end of the part. So each part drifts as a tool that stands still does.
    pub fn within(&self, number: usize, window: [f64; 2]) -> Vec<PathPart> {
        let whole = self.slice(self.parts(number..number + 1));
        let mut out = Vec::with_capacity(whole.len());
        let Some(first) = whole.first() else { return out };
        // What slides along itself does so without turning.
        let axis = first.segment.start().column(2).into_owned();
        let drift = self.plan.tolerances.standstill(axis) / whole.len() as f64;
        for (n, part) in whole.iter().enumerate() {
            // The stored times are rounded; the parts of most moves are of equal duration.
            let even = 1.0 / whole.len() as f64;
            let [start, share] = match part.vertical_arc() {
                Some(_) => [part.start, part.share].map(f64::from),
                None => [n as f64 * even, even],
            };
            let local = window.map(|time| ((time - start) / share).clamp(0.0, 1.0));
            let [from, to] = local.map(|time| part.segment.at_time(time).clamp(0.0, 1.0));
            if to > from {
                let by = [drift * out.len() as f64, drift * (out.len() + 1) as f64];
                let segment = part.segment.part(from, to).displaced(by);
                let times = [start + from * share, (to - from) * share].map(|x| x as f32);
                out.push(PathPart::new(segment, part.number, times));
            }
        }
        out
    }

    /// A bound on how far any point of the solid moves along these parts.
    pub fn travel(&self, parts: &[PathPart]) -> f64 {
        parts
            .iter()
            .map(|part| travel(&part.segment, self.plan.cutter.reach))
            .sum()
    }

    /// A box that holds all that the solid sweeps in a move.
    pub fn reaches(&self, number: usize) -> Option<Box3> {
        let boxes = &self.boxes[self.parts(number..number + 1)];
        (!boxes.is_empty()).then(|| hull(boxes))
    }

    /// The parts of these moves that come near material, in runs of consecutive ones, and the lines with that material.
    pub fn near(&self, moves: Range<usize>, grid: &Grid, material: &HeightMap) -> Vec<(Range<usize>, Vec<u32>)> {
        let mut runs: Vec<(Range<usize>, Vec<u32>)> = Vec::new();
        // The lines of the last run: neighbouring parts share most of them.
        let (mut marked, mut has_marks) = (vec![0_u64; grid.len().div_ceil(64)], false);
        let parts = self.parts(moves);
        let mut from = parts.start;
        // Blocks of parts that are beside the grid are left out at once.
        let near_blocks = std::iter::from_fn(|| {
            let own = from..parts.end.min((from / BLOCK + 1) * BLOCK);
            from = own.end;
            (!own.is_empty()).then_some(own)
        });
        let near_blocks = near_blocks.filter(|own| window(grid, &self.hulls[own.start / BLOCK]).is_some());
        for at in near_blocks.flatten() {
            let Some(window) = window(grid, &self.boxes[at]) else {
                continue;
            };
            let starts = !matches!(runs.last(), Some((run, _)) if run.end == at && run.len() < CHUNK);
            if starts
                && std::mem::take(&mut has_marks)
                && let Some((_, lines)) = runs.last()
            {
                lines.iter().for_each(|line| marked[*line as usize / 64] = 0);
            }
            let (mut is_near, mut lines) = (false, Vec::new());
            material.visit(window, self.boxes[at][2], &mut |line| {
                is_near = true;
                let (word, bit) = (&mut marked[line as usize / 64], 1 << (line % 64));
                if *word & bit == 0 {
                    *word |= bit;
                    lines.push(line);
                }
                true
            });
            has_marks |= is_near;
            match runs.last_mut() {
                _ if !is_near => {}
                Some((run, all)) if !starts => {
                    run.end = at + 1;
                    all.append(&mut lines);
                }
                _ => runs.push((at..at + 1, lines)),
            }
        }
        runs
    }

    /// What the solid sweeps of the lines whose material it comes near.
    pub fn swept_near(
        &self,
        moves: Range<usize>,
        (grid, top): (&Grid, f64),
        material: &HeightMap,
        options: &Options,
        monitor: &dyn Monitor,
    ) -> Result<SweptLines, SweepError> {
        let mut all = Vec::new();
        for (parts, lines) in self.near(moves, grid, material) {
            let Some(mask) = LineMask::new(grid, lines) else {
                continue;
            };
            all.push(self.swept(self.slice(parts), (grid, top), &mask, options, monitor)?);
        }
        Ok(SweptLines::united(all))
    }

    /// What the solid sweeps of the marked lines along these parts, up to `top`.
    pub fn swept(
        &self,
        parts: &[PathPart],
        (grid, top): (&Grid, f64),
        mask: &LineMask,
        options: &Options,
        monitor: &dyn Monitor,
    ) -> Result<SweptLines, SweepError> {
        // Masks are for charts and closed forms.
        let method = match options.method {
            Method::General => Method::General,
            _ => Method::Mixed,
        };
        let options = options.clone().method(method);
        let mut job = self
            .plan
            .job((self.tool, self.plan.parts.len()), grid, &options, monitor);
        job.lists = Arc::clone(&self.lists);
        let short = match method {
            Method::Mixed => self.plan.short.shortest(self.tool, parts, top + self.plan.gap()),
            _ => None,
        };
        if let Some((_, short)) = short {
            job = job.with_tool(short);
        }
        job.mask = Some(Cow::Borrowed(mask));
        let swept = parts.chunks(CHUNK).map(|chunk| job.swept_lines(chunk));
        Ok(SweptLines::united(swept.collect::<Result<_, _>>()?))
    }
}
