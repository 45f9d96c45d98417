//! The surface of a tool in small parts, as they are seen from the axis.
//!
//! A point of a part of a surface is a mean of its control points `P`. Its distance `ρ` from the axis is a convex
//! function of it, at most the mean of theirs; and at least its length along any unit vector `u` across the axis, which
//! is the mean of `⟨u, P⟩`. So in the half-plane `(ρ, ζ)`, the part is on the side of the axis of the hull of all
//! `(ρ(P), ζ(P))`, and beyond that of all `(⟨u, P⟩, ζ(P))`.

use crate::profile::Bezier;
use nalgebra::{Vector3, Vector4};
use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashSet};
use sweepsim_spline::Bernstein;

pub(super) type Corners = [Vector3<f64>; 4];

/// A part of a surface.
pub(super) struct Sliver {
    /// It is not nearer to the axis than this chain of `(ρ, ζ)`, which is convex and rises,
    near: Vec<[f64; 2]>,
    /// and not beyond this one.
    far: Vec<[f64; 2]>,
    /// The corners of a part of a patch: `(u, v)` = 00, 10, 11, 01.
    corners: Option<Corners>,
    thickness: f64,
    controls: Controls,
}

/// The control points that a part is a mean of.
pub(super) enum Controls {
    Meridian(Bezier),
    Net(Net),
}

/// The control points of a part of a patch, times their weights, and the weights; `u` comes first.
#[derive(Clone)]
pub(super) struct Net {
    degrees: [usize; 2],
    points: Vec<Vector4<f64>>,
}

impl Net {
    pub fn new(position: &[Bernstein; 3], weight: &Bernstein) -> Self {
        let form = |k: usize, i: usize| position[k].coefficients()[i];
        let point = |(i, w): (usize, &f64)| Vector4::new(form(0, i), form(1, i), form(2, i), *w);
        Self {
            degrees: [weight.degree(0), weight.degree(1)],
            points: weight.coefficients().iter().enumerate().map(point).collect(),
        }
    }

    /// Both halves (de Casteljau).
    fn halves(&self, axis: usize) -> [Self; 2] {
        let [n, m] = self.degrees.map(|degree| degree + 1);
        let (count, step, lines, next) = if axis == 0 { (n, 1, m, n) } else { (m, n, n, 1) };
        let (mut low, mut high) = (self.clone(), self.clone());
        for line in 0..lines {
            let at = |k: usize| line * next + k * step;
            for level in 0..count {
                low.points[at(level)] = high.points[at(0)];
                for k in 0..count - 1 - level {
                    high.points[at(k)] = (high.points[at(k)] + high.points[at(k + 1)]) * 0.5;
                }
            }
        }
        [low, high]
    }
}

impl Sliver {
    /// All is rounded to multiples of `unit`: then what is level is so, and what is turned about the axis is the same.
    fn new(controls: Controls, unit: f64) -> Self {
        let rounded = |p: [f64; 2]| p.map(|c| (c / unit).round() * unit);
        let (near, far, corners) = match &controls {
            Controls::Meridian(curve) => {
                let points: Vec<[f64; 2]> = curve.points.iter().map(|p| rounded([p.x, p.y])).collect();
                (points.clone(), points, None)
            }
            Controls::Net(net) => {
                let points: Vec<Vector3<f64>> = net.points.iter().map(|p| p.xyz() / p.w).collect();
                let mean: Vector3<f64> = points.iter().sum();
                let u = Vector3::new(mean.x, mean.y, 0.0).try_normalize(0.0);
                let u = u.unwrap_or_else(Vector3::x);
                let near = points.iter().map(|p| rounded([u.dot(p), p.z])).collect();
                let far = points.iter().map(|p| rounded([p.x.hypot(p.y), p.z])).collect();
                let (n, last) = (net.degrees[0], points.len() - 1);
                (near, far, Some([0, n, last, last - n].map(|k| points[k])))
            }
        };
        Self {
            thickness: thickness(&near, &far),
            near: chain(near, -1.0),
            far: chain(far, 1.0),
            corners,
            controls,
        }
    }

    /// Both halves, cut so that they are thinner.
    fn halves(&self, unit: f64) -> [Self; 2] {
        match &self.controls {
            Controls::Meridian(curve) => {
                <[Bezier; 2]>::from(curve.halves()).map(|half| Self::new(Controls::Meridian(half), unit))
            }
            Controls::Net(net) => {
                let [u, v] = [0, 1].map(|axis| net.halves(axis).map(|half| Self::new(Controls::Net(half), unit)));
                let thickest = |halves: &[Self; 2]| halves[0].thickness.max(halves[1].thickness);
                if thickest(&u) <= thickest(&v) { u } else { v }
            }
        }
    }

    /// The heights of its lowest and its highest point, at least.
    pub fn heights(&self) -> [f64; 2] {
        [self.far[0][1], self.far[self.far.len() - 1][1]]
    }

    /// What of it is between two heights is beyond the hull of these points, if there are any.
    pub fn near_between(&self, heights: [f64; 2]) -> impl Iterator<Item = [f64; 2]> + '_ {
        between(&self.near, heights)
    }

    /// And on the side of the axis of the hull of these.
    pub fn far_between(&self, heights: [f64; 2]) -> impl Iterator<Item = [f64; 2]> + '_ {
        between(&self.far, heights)
    }
}

/// Of the hull of points, what is farthest from the axis (with a `side` of −1, nearest to it), as it rises.
pub(super) fn chain(mut points: Vec<[f64; 2]>, side: f64) -> Vec<[f64; 2]> {
    // Andrew's monotone chain, with the last of points as high.
    points.sort_by(|a, b| a[1].total_cmp(&b[1]).then((side * a[0]).total_cmp(&(side * b[0]))));
    let mut chain: Vec<[f64; 2]> = Vec::new();
    for p in points {
        while let Some(last) = chain.last() {
            let is_inner = match chain[..] {
                _ if last[1] == p[1] => true,
                [.., a, b] => side * ((b[1] - a[1]) * (p[0] - a[0]) - (b[0] - a[0]) * (p[1] - a[1])) >= 0.0,
                _ => false,
            };
            if !is_inner {
                break;
            }
            chain.pop();
        }
        chain.push(p);
    }
    chain
}

/// The corners of a rising chain between two heights, with its points there.
fn between(chain: &[[f64; 2]], [low, high]: [f64; 2]) -> impl Iterator<Item = [f64; 2]> + '_ {
    let own = chain.iter().copied().filter(move |p| p[1] >= low && p[1] <= high);
    own.chain([low, high].into_iter().filter_map(|height| crossing(chain, height)))
}

/// Where a rising chain passes through a height.
pub(super) fn crossing(chain: &[[f64; 2]], height: f64) -> Option<[f64; 2]> {
    let above = chain.partition_point(|p| p[1] < height);
    let (a, b) = (chain.get(above.checked_sub(1)?)?, chain.get(above)?);
    Some([a[0] + (b[0] - a[0]) * (height - a[1]) / (b[1] - a[1]), height])
}

/// How far points are from a line between some of them, together; or those of both kinds from each other.
fn thickness(near: &[[f64; 2]], far: &[[f64; 2]]) -> f64 {
    let all = || near.iter().chain(far);
    let end = |k: usize, side: f64| all().max_by(|a, b| (side * a[k]).total_cmp(&(side * b[k]))).copied();
    let ways = [0, 1].map(|k| {
        let [a, b] = [-1.0, 1.0].map(|side| end(k, side).unwrap_or_default());
        [b[0] - a[0], b[1] - a[1]]
    });
    let [p, q] = ways.map(|way| way[0].hypot(way[1]));
    let (way, length) = if p > q { (ways[0], p) } else { (ways[1], q) };
    let across = |p: &[f64; 2]| (way[0] * p[1] - way[1] * p[0]) / length.max(f64::MIN_POSITIVE);
    let most = |side: f64| all().map(|p| side * across(p)).fold(f64::NEG_INFINITY, f64::max);
    let apart = near.iter().zip(far).map(|(near, far)| far[0] - near[0]);
    apart.fold(most(1.0) + most(-1.0), f64::max)
}

/// The thickest comes first.
struct ByThickness(Sliver);

impl Ord for ByThickness {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.thickness.total_cmp(&other.0.thickness)
    }
}

impl PartialOrd for ByThickness {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for ByThickness {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for ByThickness {}

/// A surface in parts no thicker than the tolerance, as far as so many do, each kind once; and the corners of all. What
/// is seen of them is rounded to multiples of a unit.
pub(super) fn slivers(
    surface: impl Iterator<Item = Controls>,
    (tolerance, unit, most): (f64, f64, usize),
) -> (Vec<Sliver>, Vec<Corners>) {
    let mut all: BinaryHeap<ByThickness> = surface.map(|part| ByThickness(Sliver::new(part, unit))).collect();
    while all.len() < most && all.peek().is_some_and(|thickest| thickest.0.thickness > tolerance) {
        if let Some(ByThickness(thickest)) = all.pop() {
            all.extend(thickest.halves(unit).map(ByThickness));
        }
    }
    let mut parts: Vec<Sliver> = all.into_iter().map(|own| own.0).collect();
    let corners = parts.iter().filter_map(|own| own.corners).collect();
    let mut known = HashSet::new();
    let bits = |chain: &[[f64; 2]]| chain.iter().map(|p| p.map(f64::to_bits)).collect::<Vec<_>>();
    parts.retain(|own| known.insert([bits(&own.near), bits(&own.far)]));
    (parts, corners)
}
