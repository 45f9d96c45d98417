//! Curves as thin tubes, and open surfaces that are seen from both sides.

use nalgebra::Vector3;
use sweepsim_dexel::Mesh;

/// Sides of a tube.
const SIDES: usize = 10;

/// Triangles with a value per vertex.
#[derive(Default)]
pub struct Coloured {
    pub mesh: Mesh,
    pub values: Vec<f32>,
}

impl Coloured {
    fn push(&mut self, place: Vector3<f64>, normal: Vector3<f64>, value: f32) {
        self.mesh.vertices.push(place.into());
        self.mesh.normals.push(normal.map(|c| c as f32).into());
        self.mesh.cut.push(true);
        self.values.push(value);
    }

    /// A surface, seen from both sides.
    pub fn surface(&mut self, points: impl Iterator<Item = ([f64; 3], [f64; 3])>, triangles: &[[u32; 3]], value: f32) {
        let first = self.mesh.vertices.len() as u32;
        let points: Vec<_> = points.collect();
        let count = points.len() as u32;
        for side in [1.0, -1.0] {
            for (place, normal) in &points {
                self.push(Vector3::from(*place), Vector3::from(*normal) * side, value);
            }
        }
        for [a, b, c] in triangles.iter().map(|t| t.map(|v| first + v)) {
            self.mesh.triangles.push([a, b, c]);
            self.mesh.triangles.push([c + count, b + count, a + count]);
        }
    }

    /// A curve.
    pub fn tube(&mut self, points: &[[f64; 3]], radius: f64, value: f32) {
        let mut points: Vec<Vector3<f64>> = points.iter().copied().map(Vector3::from).collect();
        points.dedup_by(|a, b| (*a - *b).norm() < 0.1 * radius);
        if points.len() < 2 {
            return;
        }
        let first = self.mesh.vertices.len() as u32;
        let mut side: Option<Vector3<f64>> = None;
        for k in 0..points.len() {
            let along = (points[(k + 1).min(points.len() - 1)] - points[k.saturating_sub(1)]).normalize();
            // Carried along the curve, so that the tube is not twisted.
            let across = side.unwrap_or_else(|| {
                if along.z.abs() < 0.8 {
                    Vector3::z()
                } else {
                    Vector3::x()
                }
            });
            let u = (across - along * across.dot(&along)).normalize();
            let v = along.cross(&u);
            side = Some(u);
            for n in 0..SIDES {
                let (s, c) = (n as f64 / SIDES as f64 * std::f64::consts::TAU).sin_cos();
                let normal = u * c + v * s;
                self.push(points[k] + normal * radius, normal, value);
            }
        }
        let sides = SIDES as u32;
        for ring in 0..points.len() as u32 - 1 {
            for n in 0..sides {
                let (a, b) = (first + ring * sides + n, first + ring * sides + (n + 1) % sides);
                self.mesh.triangles.push([a, b, b + sides]);
                self.mesh.triangles.push([a, b + sides, a + sides]);
            }
        }
    }
}
