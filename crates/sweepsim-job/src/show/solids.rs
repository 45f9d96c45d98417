//! Simple solids as triangles, and the bodies of a machine.

use sweepsim_dexel::{Mesh, TriangleSoup};
use sweepsim_machine::{Body, Convex};

/// Sides of a cylinder, and of a ball from pole to pole.
pub(crate) const SIDES: usize = 64;

/// Vertices, and triangles of their numbers.
pub(crate) type Triangles = (Vec<[f64; 3]>, Vec<[u32; 3]>);

pub(crate) fn block(min: [f64; 3], max: [f64; 3]) -> Triangles {
    // Eight corners are not too many.
    let mesh = TriangleSoup::block(min, max).indexed().unwrap_or_default();
    (mesh.vertices, mesh.triangles)
}

/// A ring of triangles between two rings of vertices.
pub(crate) fn band(from: u32, to: u32, triangles: &mut Vec<[u32; 3]>) {
    let sides = SIDES as u32;
    for k in 0..sides {
        let next = (k + 1) % sides;
        triangles.push([from + k, from + next, to + next]);
        triangles.push([from + k, to + next, to + k]);
    }
}

/// What is turned about an axis between two circles of radius and height.
pub(crate) fn cone(base: [f64; 3], axis: [f64; 3], circles: [[f64; 2]; 2]) -> Triangles {
    let length = axis.iter().map(|c| c * c).sum::<f64>().sqrt();
    let z = axis.map(|c| c / length);
    let least = (0..3).min_by(|a, b| z[*a].abs().total_cmp(&z[*b].abs())).unwrap_or(0);
    let helper = [0, 1, 2].map(|k| if k == least { 1.0 } else { 0.0 });
    let cross =
        |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
    let x = cross(helper, z);
    let size = x.iter().map(|c| c * c).sum::<f64>().sqrt();
    let x = x.map(|c| c / size);
    let y = cross(z, x);
    let mut vertices: Vec<[f64; 3]> = circles.map(|[_, up]| [0, 1, 2].map(|k| base[k] + up * z[k])).into();
    for [radius, up] in circles {
        for side in 0..SIDES {
            let turn = side as f64 / SIDES as f64 * std::f64::consts::TAU;
            let (s, c) = turn.sin_cos();
            vertices.push([0, 1, 2].map(|k| base[k] + radius * (c * x[k] + s * y[k]) + up * z[k]));
        }
    }
    let (low, high) = (2, 2 + SIDES as u32);
    let mut triangles = Vec::new();
    band(low, high, &mut triangles);
    for k in 0..SIDES as u32 {
        let next = (k + 1) % SIDES as u32;
        triangles.push([0, low + next, low + k]);
        triangles.push([1, high + k, high + next]);
    }
    (vertices, triangles)
}

/// A body on its link; of very large ones, so many triangles.
pub(crate) fn body(body: &Body, most: usize) -> Triangles {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for solid in body.solids() {
        let (own, corners) = match solid {
            Convex::Block { min, max } => block(*min, *max),
            Convex::Turned { base, axis, circles } => {
                let [low, high] = [circles[0], circles[circles.len() - 1]];
                cone(*base, (**axis).into(), [low, high])
            }
            Convex::Triangle(corners) => (corners.to_vec(), vec![[0, 1, 2]]),
            Convex::Hull(_) => (Vec::new(), Vec::new()),
        };
        if triangles.len() > most {
            break;
        }
        let first = vertices.len() as u32;
        vertices.extend(own);
        triangles.extend(corners.into_iter().map(|corners: [u32; 3]| corners.map(|v| v + first)));
    }
    (vertices, triangles)
}

/// Adds triangles to a mesh, each flat, with its vertices where `place` has them.
pub(crate) fn add_flat(mesh: &mut Mesh, (vertices, triangles): &Triangles, place: impl Fn([f64; 3]) -> [f64; 3]) {
    for triangle in triangles {
        let corners = triangle.map(|v| place(vertices[v as usize]));
        let [a, b, c] = corners.map(nalgebra::Vector3::from);
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default();
        let first = mesh.vertices.len() as u32;
        mesh.vertices.extend(corners);
        let normal: [f32; 3] = normal.map(|c| c as f32).into();
        mesh.normals.extend([normal; 3]);
        mesh.cut.extend([false; 3]);
        mesh.triangles.push([first, first + 1, first + 2]);
    }
}
