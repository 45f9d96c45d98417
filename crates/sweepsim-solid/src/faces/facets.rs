//! Faces without a surface: triangles of the mesh, some of whose sides may have become several edges.

use super::flat::start;
use crate::chart::across;
use crate::edges::{Curve, Edge, Placed};
use crate::net::Net;
use crate::parts::{Face, Use};
use crate::surface::Surface;
use nalgebra::Vector3;
use sweepsim_dexel::AnalyticSurface as A;

/// The face of a triangle, or faces where its corners are farther than `most` from a plane; `None` if it has no area.
pub(super) fn facets(
    net: &Net,
    triangle: usize,
    loops: Vec<Vec<Use>>,
    placed: &mut Placed,
    most: f64,
) -> Option<Vec<Face>> {
    let whole = facet(net, triangle, loops, placed)?;
    let off = |used: &Use| start(used, placed).is_some_and(|p| whole.surface.off(p) > most);
    let [only] = &whole.loops[..] else {
        return Some(vec![whole]);
    };
    if only.len() < 4 || !only.iter().any(off) {
        return Some(vec![whole]);
    }
    let parts = cut(only, whole.axes[2], placed)?;
    parts.into_iter().map(|part| flat_face(vec![part], placed)).collect()
}

/// Cuts a polygon into triangles by new edges, each time where the new triangle is the least thin.
fn cut(polygon: &[Use], normal: Vector3<f64>, placed: &mut Placed) -> Option<Vec<Vec<Use>>> {
    let mut rest = polygon.to_vec();
    let mut parts = Vec::new();
    while rest.len() > 3 {
        let corners: Vec<Vector3<f64>> = rest.iter().filter_map(|used| start(used, placed)).collect();
        let count = corners.len();
        // Of each corner the triangle with its neighbours: how thick it is.
        let thickness = |k: usize| {
            let [a, b, c] = [k, k + 1, k + 2].map(|at| corners[at % count]);
            let sides = [b - a, c - b, a - c].map(|side| side.norm_squared());
            let area = (b - a).cross(&(c - a)).dot(&normal);
            let inside = |p: &Vector3<f64>| {
                let left = |from: Vector3<f64>, to: Vector3<f64>| (to - from).cross(&(p - from)).dot(&normal) >= 0.0;
                left(a, b) && left(b, c) && left(c, a)
            };
            let others = (3..count).map(|off| corners[(k + off) % count]);
            let free = others.into_iter().all(|p| !inside(&p));
            let longest = sides.into_iter().fold(0.0, f64::max);
            if free { area / longest } else { f64::NEG_INFINITY }
        };
        let best = (0..count).max_by(|a, b| thickness(*a).total_cmp(&thickness(*b)))?;
        rest.rotate_left(best);
        let [from, to] = [0, 2].map(|k| rest[k]);
        let vertex = |(edge, forward): Use| {
            let edge = placed.edges[edge as usize].as_ref()?;
            Some((edge.vertices[usize::from(!forward)], edge.ends[usize::from(!forward)]))
        };
        let ((a, p), (b, q)) = (vertex(from)?, vertex(to)?);
        let new = placed.edges.len() as u32;
        placed.edges.push(Some(Edge {
            vertices: [a, b],
            ends: [p, q],
            curve: Curve::Line,
        }));
        parts.push(vec![rest[0], rest[1], (new, false)]);
        rest.splice(0..2, [(new, true)]);
    }
    parts.push(rest);
    Some(parts)
}

/// The plane of a triangle without a surface; `None` if what moved its corners left it no area, or turned it over.
fn facet(net: &Net, triangle: usize, loops: Vec<Vec<Use>>, placed: &Placed) -> Option<Face> {
    let corners = corners(loops.first()?, placed);
    let (normal, flat) = (doubled_area(&corners), 1e-6 * longest(&corners)?.norm_squared());
    let own = net.area(triangle);
    let moved = corners
        .iter()
        .any(|p| net.mesh.triangles[triangle].iter().all(|v| net.place(*v) != *p));
    // The mesh has triangles without area, too.
    if moved && (normal.norm() <= flat || own.norm() > flat && normal.dot(&own) <= 0.0) {
        return None;
    }
    flat_face(loops, placed)
}

fn corners(only: &[Use], placed: &Placed) -> Vec<Vector3<f64>> {
    only.iter().filter_map(|used| start(used, placed)).collect()
}

/// Twice the area of a polygon, along its normal.
fn doubled_area(corners: &[Vector3<f64>]) -> Vector3<f64> {
    let around = |k: usize| corners[(k + 1) % corners.len()] - corners[0];
    (0..corners.len())
        .map(|k| (corners[k] - corners[0]).cross(&around(k)))
        .sum()
}

/// The longest side of a polygon; `None` of fewer than three corners.
fn longest(corners: &[Vector3<f64>]) -> Option<Vector3<f64>> {
    let count = corners.len();
    let sides = (0..count).map(|k| corners[(k + 1) % count] - corners[k]);
    let longest = sides.max_by(|a, b| a.norm().total_cmp(&b.norm()))?;
    (count > 2).then_some(longest)
}

/// A face of the plane through the first corner, across the polygon's area.
fn flat_face(loops: Vec<Vec<Use>>, placed: &Placed) -> Option<Face> {
    let corners = corners(loops.first()?, placed);
    let longest = longest(&corners)?;
    let flat = 1e-6 * longest.norm_squared();
    let along = longest.try_normalize(0.0)?;
    let normal = doubled_area(&corners)
        .try_normalize(flat)
        .unwrap_or_else(|| across(along));
    let along = (along - normal * normal.dot(&along)).try_normalize(0.0)?;
    let surface = Surface::Analytic(A::Plane {
        origin: corners[0].into(),
        normal: normal.into(),
    });
    Some(Face {
        surface,
        outward: true,
        axes: [along, normal.cross(&along), normal],
        loops,
        is_facet: true,
        range: [[0.0; 2]; 2],
        spline: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Closed edges from each corner to the next.
    fn polygon(corners: &[Vector3<f64>]) -> (Vec<Use>, Placed) {
        let count = corners.len();
        let edge = |k: usize| Edge {
            vertices: [k as u32, ((k + 1) % count) as u32],
            ends: [corners[k], corners[(k + 1) % count]],
            curve: Curve::Line,
        };
        let placed = Placed {
            edges: (0..count).map(|k| Some(edge(k))).collect(),
            vertices: corners.to_vec(),
            failed: Vec::new(),
        };
        ((0..count as u32).map(|k| (k, true)).collect(), placed)
    }

    /// Triangles that cover the polygon once: none is turned over, and together they are as large as it is. Their new
    /// sides are passed both ways.
    #[test]
    fn polygons_with_any_corners_are_cut() {
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut hollow = 0;
        for number in 0..400 {
            let count = 4 + number % 6;
            let frame = nalgebra::Rotation3::from_euler_angles(6.0 * random(), 3.0 * random(), 6.0 * random());
            // Seen from the middle, each lies behind the one before it; some turn inwards, and none is in the plane.
            let corners: Vec<Vector3<f64>> = (0..count)
                .map(|k| {
                    let angle = (k as f64 + 0.6 * random()) * std::f64::consts::TAU / count as f64;
                    let away = 0.2 + random();
                    frame * Vector3::new(away * angle.cos(), away * angle.sin(), 0.02 * random())
                })
                .collect();
            let normal = frame * Vector3::z();
            let turn = |[a, b, c]: [&Vector3<f64>; 3]| (b - a).cross(&(c - b)).dot(&normal);
            let is_hollow = |k: usize| turn([0, 1, 2].map(|step| &corners[(k + step) % count])) < 0.0;
            hollow += usize::from((0..count).any(is_hollow));
            let (all, mut placed) = polygon(&corners);
            let parts = cut(&all, normal, &mut placed).expect("triangles");

            assert_eq!((parts.len(), placed.edges.len()), (count - 2, 2 * count - 3));
            let mut passed: BTreeMap<u32, Vec<bool>> = BTreeMap::new();
            let mut area = 0.0;
            for part in &parts {
                let own: Vec<Vector3<f64>> = part.iter().filter_map(|used| start(used, &placed)).collect();
                let ends = part.iter().map(|(edge, forward)| {
                    let edge = placed.edges[*edge as usize].as_ref().expect("an edge");
                    edge.ends[usize::from(*forward)]
                });
                assert!(ends.eq((0..3).map(|k| own[(k + 1) % 3])), "sides follow each other");
                let twice = doubled_area(&own).dot(&normal);
                assert!(own.len() == 3 && twice > 0.0, "{number}: {twice}");
                area += twice;
                for (edge, forward) in part {
                    passed.entry(*edge).or_default().push(*forward);
                }
            }
            let whole = doubled_area(&corners).dot(&normal);
            assert!((area - whole).abs() <= 1e-12 * whole, "{number}: {area} of {whole}");
            for (edge, mut ways) in passed {
                ways.sort_unstable();
                let is_new = edge as usize >= count;
                assert_eq!(ways, if is_new { vec![false, true] } else { vec![true] });
            }
        }
        assert!((100..400).contains(&hollow), "{hollow}");
    }
}
