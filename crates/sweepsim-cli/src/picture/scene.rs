//! A mesh made ready.

use super::vector::{Vector, cross, sub, unit};
use sweepsim_dexel::Mesh;

/// Triangles in the unit ball.
#[derive(Default)]
pub(super) struct Scene {
    pub positions: Vec<Vector>,
    pub normals: Vec<Vector>,
    /// 1 where a tool cut, 0 elsewhere.
    pub cut: Vec<f32>,
    pub triangles: Vec<[u32; 3]>,
    /// Height of the plane that the part lies on.
    pub ground: f32,
}

impl Scene {
    /// Keeps what can be drawn.
    pub fn new(mesh: &Mesh) -> Self {
        let good = |t: &[u32; 3]| {
            t.iter().all(|v| {
                mesh.vertices
                    .get(*v as usize)
                    .is_some_and(|p| p.iter().all(|c| c.is_finite() && c.abs() < 1e150))
            })
        };
        let kept: Vec<[u32; 3]> = mesh.triangles.iter().filter(|t| good(t)).copied().collect();
        // Vertices without a triangle are no part of the picture.
        let mut numbers = vec![u32::MAX; mesh.vertices.len()];
        let mut used = Vec::new();
        let triangles: Vec<[u32; 3]> = kept
            .iter()
            .map(|t| {
                t.map(|v| {
                    let number = &mut numbers[v as usize];
                    if *number == u32::MAX {
                        *number = used.len() as u32;
                        used.push(v as usize);
                    }
                    *number
                })
            })
            .collect();
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for v in &used {
            for k in 0..3 {
                low[k] = low[k].min(mesh.vertices[*v][k]);
                high[k] = high[k].max(mesh.vertices[*v][k]);
            }
        }
        if triangles.is_empty() {
            return Self::default();
        }
        let centre = [0, 1, 2].map(|k| 0.5 * (low[k] + high[k]));
        let radius = 0.5 * (0..3).map(|k| (high[k] - low[k]).powi(2)).sum::<f64>().sqrt();
        let radius = if radius > 0.0 { radius } else { 1.0 };
        let positions: Vec<Vector> = used
            .iter()
            .map(|v| [0, 1, 2].map(|k| ((mesh.vertices[*v][k] - centre[k]) / radius) as f32))
            .collect();
        let mut flat = vec![[0.0, 0.0, 1.0]; used.len()];
        if mesh.normals.len() != mesh.vertices.len() {
            for t in &triangles {
                let [a, b, c] = t.map(|v| positions[v as usize]);
                for v in t {
                    flat[*v as usize] = unit(cross(sub(b, a), sub(c, a)));
                }
            }
        }
        Self {
            normals: used
                .iter()
                .zip(flat)
                .map(|(v, flat)| mesh.normals.get(*v).map_or(flat, |n| unit(*n)))
                .collect(),
            cut: used
                .iter()
                .map(|v| f32::from(u8::from(mesh.cut.get(*v).copied().unwrap_or(false))))
                .collect(),
            ground: ((low[2] - centre[2]) / radius) as f32,
            positions,
            triangles,
        }
    }
}
