//! Stock, target, fixtures and tools as they are shown.

use super::surface;
use crate::request::Task;
use crate::show::shape;
use crate::show::solids::{SIDES, Triangles, band, block, cone};
use sweepsim::motion::{BodyKind, Tool};
use sweepsim_dexel::{Mesh, Stock, TriDexels};
use sweepsim_formats::Job;
use sweepsim_report::{Solid, SolidKind, ToolPart, ToolShape};

/// Larger meshes are shown with fewer triangles; so many of a union are shown at all.
const LARGEST: usize = 300_000;

/// Stock, target and fixtures; and what is said of those that are shown with fewer triangles.
pub(super) fn solids(job: &Job, task: Task) -> (Vec<Solid>, Vec<String>) {
    let (mut solids, mut notes) = (Vec::new(), Vec::new());
    let mut add = |kind, setup, stock: &Stock, name: &str| {
        for (vertices, triangles) in meshes(stock) {
            let (whole, mesh) = (
                triangles.len(),
                Mesh {
                    vertices,
                    triangles,
                    ..Mesh::default()
                },
            );
            let shown = mesh.clustered(LARGEST);
            if shown.within > 0.0 {
                let farthest = shown.farthest(&mesh).unwrap_or(shown.within);
                notes.push(surface::fewer(name, whole, shown.mesh.triangles.len(), farthest));
            }
            solids.push(Solid {
                kind,
                setup,
                vertices: shown.mesh.vertices,
                triangles: shown.mesh.triangles,
            });
        }
    };
    if task != Task::Sweep {
        add(SolidKind::Stock, None, &job.stock, "the stock");
    }
    for (number, setup) in job.setups.iter().enumerate() {
        for fixture in &setup.fixtures {
            add(SolidKind::Fixture, Some(number as u16), fixture, "a fixture");
        }
    }
    if let Some(target) = &job.target {
        add(SolidKind::Target, None, &Stock::Mesh(target.mesh.clone()), "the target");
    }
    (solids, notes)
}

/// The surfaces of a solid; of intersections and differences, that of their first part.
fn meshes(stock: &Stock) -> Vec<Triangles> {
    match stock {
        Stock::Block { min, max } => vec![block(*min, *max)],
        Stock::Cylinder {
            base,
            axis,
            radius,
            height,
        } => vec![cylinder(*base, *axis, *radius, *height)],
        Stock::Ball { centre, radius } => vec![ball(*centre, *radius)],
        Stock::Mesh(soup) => {
            let mesh = soup.indexed().ok();
            mesh.into_iter().map(|mesh| (mesh.vertices, mesh.triangles)).collect()
        }
        Stock::TriDexels(sets) => {
            let solid = TriDexels::from_sets((**sets).clone()).ok();
            let mesh = solid.and_then(|solid| solid.surface().ok());
            mesh.into_iter().map(|mesh| (mesh.vertices, mesh.triangles)).collect()
        }
        Stock::Dexels(dexels) => {
            let mesh = dexels.surface().ok();
            mesh.into_iter().map(|mesh| (mesh.vertices, mesh.triangles)).collect()
        }
        Stock::Union(parts) => {
            let (mut all, mut count) = (Vec::new(), 0);
            for part in parts {
                let found = meshes(part);
                count += found.iter().map(|(_, triangles)| triangles.len()).sum::<usize>();
                if count > LARGEST {
                    return Vec::new();
                }
                all.extend(found);
            }
            all
        }
        Stock::Intersection(parts) => parts.first().map_or(Vec::new(), meshes),
        Stock::Difference(whole, _) => meshes(whole),
        // Kinds to come.
        _ => Vec::new(),
    }
}

fn cylinder(base: [f64; 3], axis: [f64; 3], radius: f64, height: f64) -> Triangles {
    cone(base, axis, [[radius, 0.0], [radius, height]])
}

fn ball(centre: [f64; 3], radius: f64) -> Triangles {
    let rings = SIDES / 2;
    let mut vertices = vec![
        [centre[0], centre[1], centre[2] - radius],
        [centre[0], centre[1], centre[2] + radius],
    ];
    for ring in 1..rings {
        let (s, c) = (ring as f64 / rings as f64 * std::f64::consts::PI).sin_cos();
        for side in 0..SIDES {
            let (sin, cos) = (side as f64 / SIDES as f64 * std::f64::consts::TAU).sin_cos();
            vertices.push([
                centre[0] + radius * s * cos,
                centre[1] + radius * s * sin,
                centre[2] - radius * c,
            ]);
        }
    }
    let mut triangles = Vec::new();
    let ring = |n: usize| (2 + n * SIDES) as u32;
    for n in 0..rings - 2 {
        band(ring(n), ring(n + 1), &mut triangles);
    }
    for k in 0..SIDES as u32 {
        let next = (k + 1) % SIDES as u32;
        triangles.push([0, ring(0) + next, ring(0) + k]);
        triangles.push([1, ring(rings - 2) + k, ring(rings - 2) + next]);
    }
    (vertices, triangles)
}

/// The tools with their bodies, in the order of their numbers.
pub(super) fn tools(job: &Job) -> Vec<ToolPart> {
    let part = |(number, tool): (&u32, &Tool)| {
        let bodies = job.bodies.get(number).into_iter().flatten();
        ToolPart {
            name: format!("T{number}"),
            cutter: vec![shape(tool)],
            bodies: bodies
                .filter(|body| matches!(body.kind, BodyKind::Shank | BodyKind::Holder))
                .map(|body| shape(&body.solid))
                .collect(),
        }
    };
    job.tools.iter().map(part).collect()
}

fn shape(tool: &Tool) -> ToolShape {
    match shape::outline(tool) {
        Some(points) => ToolShape::Profile(points),
        None => {
            let (vertices, triangles) = shape::patches(tool);
            ToolShape::Mesh { vertices, triangles }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_union_is_shown_up_to_a_number_of_triangles() {
        let balls = |count: usize| {
            let ball = Stock::Ball {
                centre: [0.0; 3],
                radius: 1.0,
            };
            meshes(&Stock::Union(vec![ball; count])).len()
        };
        assert_eq!([balls(10), balls(70), balls(1000)], [10, 70, 0]);
    }
}
