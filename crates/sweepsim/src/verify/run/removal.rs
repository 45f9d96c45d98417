//! What runs and single moves remove, and how the cutter engages in it.

use crate::error::SweepError;
use crate::time::path_parts::PathPart;
use crate::verify::driver::{Solids, Work};
use crate::verify::lines::Lines;
use crate::verify::record::{Extent, TileRemoval};
use crate::verify::search::Swept;
use nalgebra::Vector3;
use rayon::prelude::*;
use std::ops::Range;
use sweepsim_dexel::{Grid, Interval};

/// Times at which the tool is placed in a move that turns, or follows a curve.
const TIMES: usize = 128;
/// The most points of an interval in such a move.
const POINTS: usize = 16;

impl Work<'_> {
    /// What each move of a run removes.
    pub(super) fn each_move(
        &mut self,
        path: usize,
        solids: &Solids,
        moves: Range<usize>,
        cut: &[(u32, Vec<Interval>)],
        swept: &[Swept],
    ) {
        let grid = *self.remaining.grid();
        let [dx, dy] = grid.spacing();
        let mut material = Lines::of(&self.remaining, cut.iter().map(|(line, _)| *line));
        for (number, swept) in moves.zip(swept) {
            let removed = material.common(swept, 0.0);
            let parts = solids.cutter.slice(solids.cutter.parts(number..number + 1));
            if !removed.is_empty() {
                self.done.moves.push(TileRemoval {
                    path,
                    number,
                    volume: removed.length() * dx * dy,
                    extent: engagement(&removed, &grid, parts),
                });
            }
            self.done.each[path] = number + 1;
            material.remove(swept);
        }
    }

    /// What the cutter sweeps in each move of a run, near the stock.
    pub(super) fn swept_by_each(&self, solids: &Solids, moves: Range<usize>) -> Result<Vec<Swept>, SweepError> {
        let swept = |number: usize| {
            let one = number..number + 1;
            let grid = self.remaining.grid();
            let swept =
                solids
                    .cutter
                    .swept_near(one, (grid, self.top()), &self.heights, &self.options, self.monitor)?;
            Ok(swept.lines)
        };
        moves.into_par_iter().with_max_len(1).map(swept).collect()
    }

    /// Removes what a run has swept.
    pub(super) fn remove(&mut self, path: usize, cut: &[(u32, Vec<Interval>)]) {
        if cut.is_empty() {
            return;
        }
        self.changes += 1;
        let grid = *self.remaining.grid();
        let [dx, dy] = grid.spacing();
        let before = Lines::of(&self.remaining, cut.iter().map(|(line, _)| *line));
        self.done.volumes[path] += before.common(cut, 0.0).length() * dx * dy;
        let pieces: Vec<(u32, Interval)> = cut
            .iter()
            .flat_map(|(line, intervals)| intervals.iter().map(|interval| (*line, *interval)))
            .collect();
        self.remaining
            .remove(&pieces, self.options.tolerance)
            .expect("swept intervals have positive lengths, on lines of the grid");
        let mut window = [[usize::MAX, 0]; 2];
        for (line, _) in cut {
            self.heights.update(&self.remaining, *line);
            let (i, j) = grid.place(*line as usize);
            for (range, n) in window.iter_mut().zip([i, j]) {
                *range = [range[0].min(n), range[1].max(n)];
            }
        }
        self.heights.refresh(window[0], window[1]);
    }
}

/// Ranges of the coordinates of some points.
#[derive(Default)]
struct Points(Option<Extent>);

impl Points {
    fn add(&mut self, place: [f64; 3]) {
        let own = Extent::of(place);
        self.0 = Some(self.0.map_or(own, |all| all.hull(own)));
    }
}

/// A direction perpendicular to a unit vector.
fn across(axis: Vector3<f64>) -> Vector3<f64> {
    let k = axis.iamin();
    let mut other = Vector3::zeros();
    other[k] = 1.0;
    axis.cross(&other).normalize()
}

/// Depth and width of the material that a move removes (see [`MoveRemoval`](crate::verify::MoveRemoval)), as ranges along the tool's axis and across the feed, in the frame of the
/// grid. The third range is a width at right angles to the second, if there is one.
fn engagement(removed: &Lines, grid: &Grid, parts: &[PathPart]) -> Option<Extent> {
    match parts {
        [part] if part.segment.is_arc() && part.segment.turns().len() == 1 => straight(removed, grid, part),
        [] => None,
        _ => along(removed, grid, parts),
    }
}

/// All intervals, with the lower end of each and its length.
fn pieces(removed: &Lines, grid: &Grid) -> impl Iterator<Item = (Vector3<f64>, f64)> {
    removed.0.iter().flat_map(move |(line, heights)| {
        let (i, j) = grid.place(*line as usize);
        heights
            .iter()
            .map(move |[lower, upper]| (Vector3::new(grid.x(i), grid.y(j), *lower), upper - lower))
    })
}

/// The tool does not turn, and its tip follows a line: all is linear along an interval, but for the move's two ends.
fn straight(removed: &Lines, grid: &Grid, part: &PathPart) -> Option<Extent> {
    let axis = part.segment.start().column(2).into_owned();
    let (tip, way) = (
        Vector3::from(part.segment.tips()[0]),
        Vector3::from(part.segment.travel()),
    );
    let feed = way - axis * way.dot(&axis);
    // A plunge: there is no direction across the feed, so take both.
    let plunge = feed.norm() <= 1e-6 * way.norm() || feed.norm() == 0.0;
    let sideways = if plunge {
        across(axis)
    } else {
        axis.cross(&feed).normalize()
    };
    let other = if plunge { axis.cross(&sideways) } else { sideways };
    let rate = if plunge {
        Vector3::zeros()
    } else {
        feed / feed.norm_squared()
    };
    let rise = if plunge { 0.0 } else { way.dot(&axis) };
    let mut extent = Points::default();
    for (lower, length) in pieces(removed, grid) {
        let from = lower - tip;
        let mut put = |height: f64| {
            let point = from + Vector3::z() * height;
            let time = point.dot(&rate).clamp(0.0, 1.0);
            extent.add([point.dot(&axis) - time * rise, point.dot(&sideways), point.dot(&other)]);
        };
        put(0.0);
        put(length);
        for time in [0.0, 1.0] {
            let height = (time - from.dot(&rate)) / rate.z;
            if height > 0.0 && height < length {
                put(height);
            }
        }
    }
    extent.0
}

/// A placement of the tool: its tip, its axis, and how both change from the placement before to the next.
struct Placement {
    tip: Vector3<f64>,
    axis: Vector3<f64>,
    change: [Vector3<f64>; 2],
}

fn placements(parts: &[PathPart]) -> Vec<Placement> {
    let each = (TIMES / parts.len()).max(2);
    let mut places: Vec<[Vector3<f64>; 2]> = Vec::with_capacity(each * parts.len() + 1);
    for (n, part) in parts.iter().enumerate() {
        for k in usize::from(n > 0)..=each {
            let (turn, tip) = part.segment.at(k as f64 / each as f64);
            places.push([Vector3::from(tip), turn.column(2).into_owned()]);
        }
    }
    (0..places.len())
        .map(|k| {
            let (before, after) = (places[k.saturating_sub(1)], places[(k + 1).min(places.len() - 1)]);
            Placement {
                tip: places[k][0],
                axis: places[k][1],
                change: [after[0] - before[0], after[1] - before[1]],
            }
        })
        .collect()
}

/// Any move, at a number of times and points.
fn along(removed: &Lines, grid: &Grid, parts: &[PathPart]) -> Option<Extent> {
    let places = placements(parts);
    let spacing = grid.spacing();
    let step = spacing[0].min(spacing[1]);
    let mut extent = Points::default();
    for (lower, length) in pieces(removed, grid) {
        let count = ((length / step).ceil().max(1.0) as usize).min(POINTS);
        for n in 0..=count {
            let point = lower + Vector3::z() * (length * n as f64 / count as f64);
            // The earliest of those nearest to the axis.
            let mut best = (f64::INFINITY, &places[0]);
            for place in &places {
                let from = point - place.tip;
                let distance = from.norm_squared() - from.dot(&place.axis).powi(2);
                if distance < best.0 {
                    best = (distance, place);
                }
            }
            let place = best.1;
            let from = point - place.tip;
            let height = from.dot(&place.axis);
            let feed = place.change[0] + place.change[1] * height;
            let sideways = place.axis.cross(&feed);
            let sideways = if sideways.norm() > 1e-9 * feed.norm() {
                sideways.normalize()
            } else {
                across(place.axis)
            };
            extent.add([height, from.dot(&sideways), 0.0]);
        }
    }
    extent.0
}
