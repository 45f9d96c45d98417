//! Convex solids of revolution that a tool holds.
//!
//! A polygon beside the axis is between sides, and no part of the surface is in it if each is beyond one of these. Then
//! all of it is inside of the tool, or none, which one of its points tells.

use super::polygon::{Side, corners, hull};
use super::slivers::{Corners, Sliver};
use super::{Convex, Surface};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// A point about which the surface turns by this part is inside.
const TURNED: f64 = 0.9;
/// Solids are extended by all that is beside them, or half of it, a quarter, and so on: as many are tried.
const STEPS: i32 = 8;

pub(super) fn cores(surface: &Surface) -> Vec<Convex> {
    let mut all = Vec::new();
    divide(surface, surface.heights(), &mut all);
    all
}

/// In one solid, or two where the surface is deepest in it.
fn divide(surface: &Surface, heights: [f64; 2], into: &mut Vec<Convex>) {
    let [low, high] = heights;
    let points = surface.samples(heights).map(|sample| [sample.near, sample.height]);
    let near = |own: &Sliver| own.near_between(heights).collect::<Vec<_>>();
    let own: Vec<_> = surface
        .meeting(heights)
        .map(near)
        .filter(|points| !points.is_empty())
        .collect();
    // Samples are not at all ends.
    let walls = || {
        own.iter()
            .filter(|points| points.iter().any(|p| p[1] != points[0][1]))
            .flatten()
    };
    let at = |height: f64| {
        let all = walls().filter(|p| p[1] == height).copied();
        all.min_by(|a, b| a[0].total_cmp(&b[0]))
    };
    let mut sides = hull(
        points.chain([low, high].into_iter().filter_map(at)).collect(),
        surface.tolerance,
    );
    let deepest = retreat(&mut sides, &own);
    if let Some(at) = surface.division(heights, deepest) {
        divide(surface, [low, at], into);
        divide(surface, [at, high], into);
        return;
    }
    if sides.len() < 3 {
        return;
    }
    for side in &mut sides {
        side.reach -= surface.rounding;
    }
    extend(surface, &mut sides);
    let solid = corners(&sides, surface.size);
    let is_inside = |solid: &Convex| {
        let middle = 0.5 * (solid[0][1] + solid[solid.len() - 1][1]);
        match surface.ends {
            Some([from, to]) => (from..to).contains(&middle),
            None => turned(&surface.corners, middle) > TURNED,
        }
    };
    into.extend(solid.filter(is_inside));
}

/// Moves sides until each part of the surface, of which these are the nearest points, is beyond one of them. By how
/// much most, and at which height.
fn retreat(sides: &mut [Side], parts: &[Vec<[f64; 2]>]) -> Option<(f64, f64)> {
    let known = sides.to_vec();
    let mut deepest: Option<(f64, f64)> = None;
    for points in parts {
        let off = |side: &Side| {
            let own = points.iter().map(|p| (side.off(*p), p[1]));
            own.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default()
        };
        let best = known.iter().map(off).enumerate().max_by(|a, b| a.1.0.total_cmp(&b.1.0));
        let Some((best, (off, height))) = best.filter(|(_, (off, _))| *off < 0.0) else {
            continue;
        };
        sides[best].reach = sides[best].reach.min(known[best].reach + off);
        if deepest.is_none_or(|(depth, _)| depth < -off) {
            deepest = Some((-off, height));
        }
    }
    deepest
}

/// Moves the lowest and the highest side as far as the others keep off the surface there.
fn extend(surface: &Surface, sides: &mut [Side]) {
    let last = sides.len() - 1;
    let [low, high] = [-sides[0].reach, sides[last].reach];
    let [bottom, top] = surface.heights();
    let is_free = |heights: [f64; 2], sides: &[Side]| {
        surface.meeting(heights).all(|own| {
            let points: Vec<_> = own.near_between(heights).collect();
            sides[1..last]
                .iter()
                .any(|side| points.iter().all(|p| side.off(*p) >= 0.0))
        })
    };
    let parts = || (0..STEPS).map(|k| 0.5_f64.powi(k));
    if let Some(end) = { parts().map(|part| low + (bottom - low) * part) }.find(|end| is_free([*end, low], sides)) {
        sides[0] = Side::above(end + surface.rounding);
    }
    if let Some(end) = { parts().map(|part| high + (top - high) * part) }.find(|end| is_free([high, *end], sides)) {
        sides[last] = Side::below(end - surface.rounding);
    }
}

/// How often a surface turns about a point of the axis: the solid angle of its parts, with corners joined by triangles.
fn turned(surface: &[Corners], height: f64) -> f64 {
    let from = |corner: Vector3<f64>| corner - Vector3::new(0.0, 0.0, height);
    let of = |[a, b, c, d]: Corners| solid_angle([a, b, c]) + solid_angle([a, c, d]);
    surface.iter().map(|corners| of(corners.map(from))).sum::<f64>() / (4.0 * PI)
}

/// Van Oosterom and Strackee, *The solid angle of a plane triangle*, 1983.
fn solid_angle([a, b, c]: [Vector3<f64>; 3]) -> f64 {
    let [p, q, r] = [a, b, c].map(|corner| corner.norm());
    let above = a.dot(&b.cross(&c));
    let beside = p * q * r + a.dot(&b) * r + b.dot(&c) * p + c.dot(&a) * q;
    2.0 * above.atan2(beside)
}
