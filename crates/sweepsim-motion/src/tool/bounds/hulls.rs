//! Convex solids of revolution that cover a tool.
//!
//! Every point of a tool has one of its surface as high and no nearer to the axis. So what of a tool is between two
//! heights is in the hull of what of the surface is there, and of the axis, turned about it.

use super::polygon::{corners, hull};
use super::slivers::Sliver;
use super::{Convex, Surface};

pub(super) fn hulls(surface: &Surface) -> Vec<Convex> {
    let mut all = Vec::new();
    divide(surface, surface.heights(), &mut all);
    all
}

/// In one solid, or two where it is farthest from the surface.
fn divide(surface: &Surface, heights: [f64; 2], into: &mut Vec<Convex>) {
    let [low, high] = heights;
    // What ends at the lower height is in the solid below.
    let is_own = |own: &&Sliver| own.heights()[1] > low || low == surface.heights()[0];
    let points = surface
        .meeting(heights)
        .filter(is_own)
        .flat_map(|own| own.far_between(heights));
    let mut sides = hull(points.collect(), surface.tolerance);
    let depth = |far: f64, height: f64| {
        let off = sides.iter().map(|side| -side.off([far, height]));
        off.fold(f64::INFINITY, f64::min)
    };
    let own = surface
        .samples(heights)
        .map(|sample| (depth(sample.far, sample.height), sample.height));
    let deepest = own.max_by(|a, b| a.0.total_cmp(&b.0));
    if let Some(at) = surface.division(heights, deepest) {
        divide(surface, [low, at], into);
        divide(surface, [at, high], into);
        return;
    }
    for side in &mut sides {
        side.reach += surface.rounding;
    }
    into.extend(corners(&sides, surface.size));
}
