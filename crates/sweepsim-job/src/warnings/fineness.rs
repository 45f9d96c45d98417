//! Cells and tolerances that are too coarse for what is cut.

use super::extent::within;
use super::paths::named;
use crate::base::words::length;
use std::collections::BTreeMap;
use sweepsim_formats::{Job, JobPath};
use sweepsim_motion::Tool;

/// A tool that leans by less than this cosine cuts with its side: its whole radius counts.
const UPRIGHT: f64 = 0.9;

/// A tolerance as large as a cell.
pub(super) fn tolerance(job: &Job) -> Option<String> {
    let cell = coarsest(job);
    (job.tolerance > cell).then(|| {
        format!(
            "the tolerance of {} mm is larger than a cell of {} mm: steps between neighbouring dexels are noise",
            length(job.tolerance),
            length(cell)
        )
    })
}

/// Tools that fit between two dexels, at the depth that they reach.
pub(super) fn cells(job: &Job, has_stock: bool) -> Vec<String> {
    let cell = coarsest(job);
    let top = has_stock
        .then(|| within(&job.stock, job.grid.frame()))
        .flatten()
        .map(|[_, high]| high[2]);
    // The narrowest cut of each tool.
    let mut narrow: BTreeMap<u32, (f64, usize)> = BTreeMap::new();
    for (number, path) in job.paths.iter().enumerate() {
        let radius = cut_radius(job, path, &job.tools[&path.tool], top);
        if radius > 0.0 && radius < cell {
            let known = narrow.entry(path.tool).or_insert((radius, number));
            if radius < known.0 {
                *known = (radius, number);
            }
        }
    }
    narrow
        .into_iter()
        .map(|(tool, (radius, number))| {
            format!(
                "cells of {} mm are too coarse for tool {tool}, which cuts only {} mm wide in {}: grooves may be missed between dexels; expected cells of at most {} mm (--cells)",
                length(cell),
                length(2.0 * radius),
                named(job, number),
                length(radius)
            )
        })
        .collect()
}

/// The larger distance of two dexels.
fn coarsest(job: &Job) -> f64 {
    let [dx, dy] = job.grid.spacing();
    dx.max(dy)
}

/// The radius of the tool at the height of the stock's top when it is deepest; all of its radius where that is not
/// known.
fn cut_radius(job: &Job, path: &JobPath, tool: &Tool, top: Option<f64>) -> f64 {
    let whole = tool.bounding_cylinder().radius;
    let frame = job.grid.frame();
    let Some(top) = top else { return whole };
    let mut lowest = f64::INFINITY;
    for pose in path.path.poses_in_order(0) {
        if frame.turn_from_world(pose.axis())[2] > UPRIGHT {
            lowest = lowest.min(frame.from_world(pose.tip())[2]);
        } else {
            return whole;
        }
    }
    match top - lowest {
        depth if depth > 0.0 => tool.radius_below(depth),
        // It stays above the stock, which has a warning of its own.
        _ => 0.0,
    }
}
