//! What must hold of every curve and surface.

use std::time::Instant;
use sweepsim_solve::{CurveEnd, Curves, Enclosure, Surface, SurfaceSolver, System};

/// Tangents have unit length, vertices follow them, arcs end where they say.
pub fn audit_curves(curves: &Curves, region: &[Enclosure], name: &str) {
    for curve in &curves.curves {
        assert!(curve.points.len() >= 2, "{name}");
        for pair in curve.points.windows(2) {
            let along: f64 = (0..region.len())
                .map(|j| (pair[1].point[j] - pair[0].point[j]) * pair[0].tangent[j])
                .sum();
            let length: f64 = (0..region.len())
                .map(|j| (pair[1].point[j] - pair[0].point[j]).powi(2))
                .sum::<f64>()
                .sqrt();
            // Short segments next to singular points turn quickly and have little precision.
            assert!(along > 0.0 || length < 1e-6, "{name}: {pair:?}");
            let unit: f64 = pair[0].tangent.iter().map(|t| t * t).sum();
            assert!((unit - 1.0).abs() < 1e-9, "{name}: {pair:?}");
        }
        let Some(ends) = curve.ends else { continue };
        for (end, point) in [
            (ends[0], &curve.points[0]),
            (ends[1], &curve.points[curve.points.len() - 1]),
        ] {
            let on_boundary = region.iter().zip(&point.point).any(|(r, x)| {
                let slack = (1e-12 + 3.0 * curves.skin) * (r.hi() - r.lo());
                (x - r.lo()).abs() <= slack || (x - r.hi()).abs() <= slack
            });
            assert!(on_boundary || end != CurveEnd::Boundary, "{name}: {point:?}");
        }
    }
}

/// Every directed edge once; its reverse at most once; only boundary edges without; no vertex unused, none pinched.
pub fn audit_surface(surface: &Surface, name: &str) {
    let mut sides = Vec::new();
    let mut used = vec![false; surface.vertices.len()];
    for t in &surface.triangles {
        sides.extend([(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]);
        t.iter().for_each(|v| used[*v as usize] = true);
    }
    let count = sides.len();
    sides.sort_unstable();
    sides.dedup();
    assert_eq!(sides.len(), count, "{name}: an edge twice in one direction");
    assert!(used.iter().all(|u| *u), "{name}: an unused vertex");
    // Around each vertex the triangles form one fan.
    let mut next: std::collections::BTreeMap<u32, Vec<(u32, u32)>> = std::collections::BTreeMap::new();
    for t in &surface.triangles {
        for k in 0..3 {
            next.entry(t[k]).or_default().push((t[(k + 1) % 3], t[(k + 2) % 3]));
        }
    }
    for (vertex, fan) in next {
        let starts = fan.iter().filter(|(a, _)| fan.iter().all(|(_, b)| a != b)).count();
        assert!(starts <= 1, "{name}: vertex {vertex} is pinched");
        let mut at = fan
            .iter()
            .find(|(a, _)| fan.iter().all(|(_, b)| a != b))
            .unwrap_or(&fan[0])
            .0;
        let mut steps = 0;
        while let Some((_, b)) = fan.iter().find(|(a, _)| *a == at) {
            at = *b;
            steps += 1;
            if steps > fan.len() {
                break;
            }
        }
        assert!(steps >= fan.len(), "{name}: vertex {vertex} has several fans");
    }
}

/// The surface, audited, with a line about it.
pub fn solve_surface(system: &System, tolerance: f64, name: &str) -> Surface {
    let start = Instant::now();
    let surface = SurfaceSolver::new(tolerance).solve(system, &()).unwrap();
    println!(
        "{name:16} χ {:3}, {} components, {:6} triangles, {:5} boundary edges, {:3} open, {:7} boxes, {:8.2} ms",
        surface.euler_characteristic(),
        surface.components(),
        surface.triangles.len(),
        surface.boundary().len(),
        surface.unresolved.len(),
        surface.statistics.boxes,
        start.elapsed().as_secs_f64() * 1e3
    );
    for open in &surface.unresolved {
        println!("{:16} open: {:?} ({} boxes)", "", open.bounds, open.boxes);
    }
    audit_surface(&surface, name);
    surface
}
