//! Faces that go round are divided: no face of the result has a seam or a pole.

use super::ends::Labels;
use super::groups::{Groups, group};
use crate::chart::{Chart, Label, across, wrapped};
use crate::net::Net;
use crate::surface::Surface;
use nalgebra::Vector3;
use std::f64::consts::PI;
use sweepsim_dexel::AnalyticSurface as A;

/// Faces that reach farther round than this are divided.
const FARTHEST: f64 = 1.94 * PI;
/// How often faces are divided anew: a whole ball first into halves, then into quarters.
const TIMES: usize = 5;
/// Directions that are tried for a pole, and for a division.
const POLES: usize = 48;
const TRIED: usize = 32;
/// The sine from a pole within which no point of a face may be.
const FROM_POLE: f64 = 0.2;

/// Divides faces until none goes round.
pub(crate) fn split(net: &Net, labels: &mut Labels, cell: f64) -> Groups {
    for _ in 0..TIMES {
        let groups = group(net, &labels.of);
        let corners = corners(net, &groups);
        let mut divided = false;
        for face in 0..groups.count() {
            if !groups.is_free(face) {
                divided |= divide(net, labels, &groups, &corners, face, cell);
            }
        }
        if !divided {
            return groups;
        }
    }
    group(net, &labels.of)
}

/// The vertices where three faces or more meet.
fn corners(net: &Net, groups: &Groups) -> Vec<bool> {
    let mut borders = vec![0_u8; net.mesh.vertices.len()];
    for half in 0..net.across.len() {
        if groups.of[half / 3] != groups.of[net.across[half] as usize / 3] {
            let count = &mut borders[net.from(half) as usize];
            *count = count.saturating_add(1);
        }
    }
    borders.into_iter().map(|count| count > 2).collect()
}

/// Divides a face if it must be; says whether labels have changed.
fn divide(net: &Net, labels: &mut Labels, groups: &Groups, corners: &[bool], face: usize, cell: f64) -> bool {
    let number = groups.label[face];
    let label = labels.all[number as usize].clone();
    let triangles = groups.triangles(face);
    let place = |triangle: u32| Vector3::from(net.ends.ends[net.end_of(triangle as usize) as usize].place);
    let pole_needed = matches!(label.surface, Surface::Analytic(A::Sphere { .. })) && label.pole.is_none();
    let mut chart = Chart::new(&label);
    if pole_needed {
        let normals: Vec<Vector3<f64>> = triangles
            .iter()
            .filter_map(|t| (place(*t) - chart.origin).try_normalize(0.0))
            .collect();
        let Some(pole) = pole(&normals) else {
            // Through the middle of the face, where it meets no corner.
            let middle: Vector3<f64> = normals.iter().sum();
            let axis = middle
                .try_normalize(1e-3 * normals.len() as f64)
                .unwrap_or(Vector3::z());
            chart.axes = [across(axis), axis.cross(&across(axis)), axis];
            let angle = free_angle(net, groups, corners, face, &chart);
            return cut(net, labels, groups, face, chart.through_axis(angle), label.clone());
        };
        let with_pole = Label {
            pole: Some(pole),
            ..label
        };
        labels.all.push(with_pole);
        let own = labels.all.len() as u32 - 1;
        for triangle in triangles {
            labels.of[net.end_of(*triangle as usize) as usize] = own;
        }
        // Dividers that it had, it has still.
        let old: Vec<_> = labels
            .dividers
            .iter()
            .map(|(pair, plane)| (*pair, plane.clone()))
            .collect();
        for ((a, b), plane) in old {
            if let Some(other) = [(a, b), (b, a)]
                .into_iter()
                .find_map(|(x, y)| (x == number).then_some(y))
            {
                labels.dividers.insert((other.min(own), other.max(own)), plane.clone());
            }
        }
        return true;
    }
    // What turns has no axis to divide it by: where it goes round, no face is found.
    if matches!(label.surface, Surface::Swept(_)) {
        return false;
    }
    for k in 0..2 {
        if chart.periodic()[k] && goes_round(net, groups, face, |p| angle(&chart, p, k, cell), &place) {
            let plane = if k == 0 {
                chart.through_axis(free_angle(net, groups, corners, face, &chart))
            } else {
                chart.across_axis()
            };
            return cut(net, labels, groups, face, plane, label);
        }
    }
    false
}

/// Gives the two sides of a plane labels of their own.
fn cut(net: &Net, labels: &mut Labels, groups: &Groups, face: usize, plane: Surface, label: Label) -> bool {
    let below = |triangle: u32| {
        let place = net.ends.ends[net.end_of(triangle as usize) as usize].place;
        plane.at(place.into()).is_some_and(|(d, _)| d < 0.0)
    };
    let triangles = groups.triangles(face);
    let lower = triangles.iter().filter(|t| below(**t)).count();
    if lower == 0 || lower == triangles.len() {
        return false;
    }
    let first = labels.all.len() as u32;
    labels.all.extend([label.clone(), label]);
    for triangle in triangles {
        labels.of[net.end_of(*triangle as usize) as usize] = first + u32::from(below(*triangle));
    }
    let number = groups.label[face];
    let old: Vec<_> = labels
        .dividers
        .iter()
        .map(|(pair, plane)| (*pair, plane.clone()))
        .collect();
    for ((a, b), before) in old {
        if let Some(other) = [(a, b), (b, a)]
            .into_iter()
            .find_map(|(x, y)| (x == number).then_some(y))
        {
            for own in [first, first + 1] {
                labels.dividers.insert((other.min(own), other.max(own)), before.clone());
            }
        }
    }
    labels.dividers.insert((first, first + 1), plane);
    true
}

/// An angle of a chart, unless the tip of a cone is so near that those of neighbours may be anything.
fn angle(chart: &Chart, p: Vector3<f64>, k: usize, cell: f64) -> Option<f64> {
    let at_tip = matches!(chart.surface, Surface::Analytic(A::Cone { .. })) && (p - chart.origin).norm() < 1.2 * cell;
    if at_tip { None } else { chart.uv(p)[k] }
}

/// Whether an angle does not come back to itself somewhere on a face, or reaches too far round.
fn goes_round(
    net: &Net,
    groups: &Groups,
    face: usize,
    angle: impl Fn(Vector3<f64>) -> Option<f64>,
    place: &impl Fn(u32) -> Vector3<f64>,
) -> bool {
    let mut known = std::collections::BTreeMap::new();
    let mut starts = groups.triangles(face).iter();
    let start = starts.find_map(|start| Some((*start, angle(place(*start))?)));
    known.extend(start);
    let mut next: Vec<u32> = known.keys().copied().collect();
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    while let Some(triangle) = next.pop() {
        let here = known[&triangle];
        range = [range[0].min(here), range[1].max(here)];
        for k in 0..3 {
            let other = net.across[3 * triangle as usize + k] / 3;
            if groups.of[other as usize] as usize != face {
                continue;
            }
            let Some(there) = angle(place(other)).map(|there| here + wrapped(there - here)) else {
                continue;
            };
            match known.get(&other) {
                Some(before) if (before - there).abs() > PI => return true,
                Some(_) => {}
                None => {
                    known.insert(other, there);
                    next.push(other);
                }
            }
        }
    }
    range[1] - range[0] > FARTHEST
}

/// An angle about the axis of a chart with no corner of a face near it or opposite.
fn free_angle(net: &Net, groups: &Groups, corners: &[bool], face: usize, chart: &Chart) -> f64 {
    let mut angles = Vec::new();
    for triangle in groups.triangles(face) {
        for vertex in net.mesh.triangles[*triangle as usize] {
            if corners[vertex as usize] {
                let off = net.place(vertex) - chart.origin;
                angles.push(chart.axes[1].dot(&off).atan2(chart.axes[0].dot(&off)));
            }
        }
    }
    let free = |angle: f64| {
        let sines = angles.iter().map(|a| (a - angle).sin().abs());
        sines.fold(1.0, f64::min)
    };
    let mut best = (0.0, free(0.0));
    for k in 1..TRIED {
        let angle = PI * k as f64 / TRIED as f64;
        if free(angle) > best.1 + 1e-9 {
            best = (angle, free(angle));
        }
    }
    best.0
}

/// A direction that is far from all of these, and so is its opposite.
fn pole(normals: &[Vector3<f64>]) -> Option<Vector3<f64>> {
    let golden = PI * (3.0 - 5f64.sqrt());
    let spread = (0..POLES).map(|k| {
        let z = (k as f64 + 0.5) / POLES as f64;
        let (s, c) = (golden * k as f64).sin_cos();
        let r = (1.0 - z * z).sqrt();
        Vector3::new(r * c, r * s, z)
    });
    let axes = [Vector3::z(), Vector3::x(), Vector3::y()];
    let nearest = |pole: &Vector3<f64>| normals.iter().fold(0.0_f64, |most, n| most.max(n.dot(pole).abs()));
    let far = (1.0 - FROM_POLE * FROM_POLE).sqrt();
    let all = axes.into_iter().chain(spread).map(|pole| (nearest(&pole), pole));
    let best = all.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (best.0 < far).then_some(best.1)
}
