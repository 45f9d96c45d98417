//! The shapes of tools, for show.

use sweepsim::motion::{ProfileSegment, Tool, Turn};
use sweepsim_dexel::Mesh;

/// The largest angle of an arc of an outline that becomes a line, in radians.
const STEP: f64 = 0.12;
/// Sides of a solid of revolution.
const SIDES: usize = 72;
/// Parts of a patch in each direction.
const PARTS: usize = 16;

/// The outline of a solid of revolution made of lines and arcs: `(ρ, ζ)` from the tip to the top.
pub(crate) fn outline(tool: &Tool) -> Option<Vec<[f64; 2]>> {
    with_arcs(tool, false)
}

/// The same of a solid that has all of the tool inside: tangents in the place of arcs that bulge outwards.
pub(crate) fn covered(tool: &Tool) -> Option<Vec<[f64; 2]>> {
    with_arcs(tool, true)
}

fn with_arcs(tool: &Tool, is_cover: bool) -> Option<Vec<[f64; 2]>> {
    let profile = tool.profile()?;
    let mut points = vec![profile.start()];
    for segment in profile.segments() {
        match segment {
            ProfileSegment::Line { to } => points.push(*to),
            ProfileSegment::Arc { to, centre, turn } => {
                let from = points[points.len() - 1];
                let radius = (from[0] - centre[0]).hypot(from[1] - centre[1]);
                let angle = |p: [f64; 2]| (p[1] - centre[1]).atan2(p[0] - centre[0]);
                let (a, b) = (angle(from), angle(*to));
                let way = match turn {
                    Turn::Ccw => (b - a).rem_euclid(std::f64::consts::TAU),
                    Turn::Cw => -(a - b).rem_euclid(std::f64::consts::TAU),
                };
                let parts = (way.abs() / STEP).ceil().max(1.0);
                // From the tip to the top, arcs to the left bulge outwards: tangents meet in the middle of chords.
                let (first, radius) = match (is_cover, turn) {
                    (true, Turn::Ccw) => (0.5, radius / (0.5 * way / parts).cos()),
                    _ => (1.0, radius),
                };
                let steps = (0..parts as usize).map(|k| first + k as f64);
                for step in steps.take_while(|step| *step < parts) {
                    let (s, c) = (a + way * step / parts).sin_cos();
                    points.push([(centre[0] + radius * c).max(0.0), centre[1] + radius * s]);
                }
                points.push(*to);
            }
            // Splines are shown by their patches.
            _ => return None,
        }
    }
    Some(points)
}

/// The patches of a tool as triangles.
pub(crate) fn patches(tool: &Tool) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for patch in tool.patches() {
        let first = vertices.len() as u32;
        for u in 0..=PARTS {
            for v in 0..=PARTS {
                vertices.push(patch.point(u as f64 / PARTS as f64, v as f64 / PARTS as f64));
            }
        }
        let row = PARTS as u32 + 1;
        for u in 0..PARTS as u32 {
            for v in 0..PARTS as u32 {
                let at = first + u * row + v;
                triangles.push([at, at + row, at + row + 1]);
                triangles.push([at, at + row + 1, at + 1]);
            }
        }
    }
    (vertices, triangles)
}

/// A tool as a mesh in its own frame, with normals: closed, if the tool is.
pub(crate) fn mesh(tool: &Tool, crisp: f64) -> Mesh {
    let (vertices, triangles) = match outline(tool) {
        Some(points) => revolved(&points),
        None => patches(tool),
    };
    let (vertices, triangles) = welded(&vertices, &triangles);
    let mesh = Mesh {
        cut: vec![false; vertices.len()],
        vertices,
        triangles,
        ..Mesh::default()
    };
    // A mesh of many tiny triangles is drawn as it is.
    mesh.crisp(crisp).unwrap_or(mesh)
}

/// The surface of an outline about the axis.
fn revolved(outline: &[[f64; 2]]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let sides = SIDES as u32;
    let mut vertices = Vec::new();
    for [radius, height] in outline {
        for k in 0..SIDES {
            let (s, c) = (k as f64 / SIDES as f64 * std::f64::consts::TAU).sin_cos();
            vertices.push([radius * c, radius * s, *height]);
        }
    }
    let mut triangles = Vec::new();
    for ring in 0..outline.len().saturating_sub(1) as u32 {
        for k in 0..sides {
            let (a, b) = (ring * sides + k, ring * sides + (k + 1) % sides);
            triangles.push([a, b, b + sides]);
            triangles.push([a, b + sides, a + sides]);
        }
    }
    (vertices, triangles)
}

/// The same triangles with one vertex for all that are in the same place, up to a nanometre, and without those that
/// vanish.
fn welded(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut known = std::collections::BTreeMap::new();
    let mut kept = Vec::new();
    let numbers: Vec<u32> = vertices
        .iter()
        .map(|p| {
            *known.entry(p.map(|c| (c * 1e6).round() as i64)).or_insert_with(|| {
                kept.push(*p);
                kept.len() as u32 - 1
            })
        })
        .collect();
    let triangles = triangles
        .iter()
        .map(|t| t.map(|v| numbers[v as usize]))
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect();
    (kept, triangles)
}
