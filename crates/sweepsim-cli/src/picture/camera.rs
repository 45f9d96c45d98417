//! Where one looks from.

use super::View;
use super::scene::Scene;
use super::vector::{Vector, add, along, cross, dot, scale, sub, unit};

/// A camera with the scene in its view.
pub(super) struct Camera {
    pub eye: Vector,
    pub right: Vector,
    pub up: Vector,
    pub forward: Vector,
    /// Half the picture's width and height at distance 1.
    pub half: [f32; 2],
}

impl Camera {
    pub fn new(view: &View, scene: &Scene) -> Self {
        let kept = |value: f64, from: f64, to: f64| if value.is_finite() { value.clamp(from, to) } else { from };
        let azimuth = kept(view.azimuth, -1e6, 1e6).to_radians();
        let elevation = kept(view.elevation, 5.0, 85.0).to_radians();
        let longer = (0.5 * kept(view.opening, 5.0, 90.0).to_radians()).tan();
        let largest = view.size[0].max(view.size[1]) as f64;
        let half = view.size.map(|n| (longer * n as f64 / largest) as f32);
        let towards = [
            elevation.cos() * azimuth.cos(),
            elevation.cos() * azimuth.sin(),
            elevation.sin(),
        ]
        .map(|c| c as f32);
        let forward = scale(unit(towards), -1.0);
        let right = unit(cross(forward, [0.0, 0.0, 1.0]));
        let up = cross(right, forward);
        // In the camera's directions, every point must be in the four half-spaces x − px ≤ h (z − pz), and so on:
        // the nearest place where all hold.
        let free = (1.0 - 2.0 * kept(view.margin, 0.0, 0.4)) as f32;
        let mut most = [[f32::NEG_INFINITY; 2]; 2];
        let mut nearest = f32::INFINITY;
        for p in &scene.positions {
            let z = dot(*p, forward);
            nearest = nearest.min(z);
            for (k, axis) in [right, up].iter().enumerate() {
                let x = dot(*p, *axis);
                most[k][0] = most[k][0].max(x - free * half[k] * z);
                most[k][1] = most[k][1].max(-x - free * half[k] * z);
            }
        }
        if scene.positions.is_empty() {
            (most, nearest) = ([[1.0; 2]; 2], -1.0);
        }
        let back = |k: usize| -(most[k][0] + most[k][1]) / (2.0 * free * half[k]);
        let depth = back(0).min(back(1)).min(nearest - 0.1);
        let aside = [0, 1].map(|k: usize| 0.5 * (most[k][0] - most[k][1]));
        let eye = add(scale(forward, depth), add(scale(right, aside[0]), scale(up, aside[1])));
        Self {
            eye,
            right,
            up,
            forward,
            half,
        }
    }

    /// Place in the picture, from −1 to 1 to the right and up, and distance along the axis.
    pub fn project(&self, p: Vector) -> [f32; 3] {
        let d = sub(p, self.eye);
        let z = dot(d, self.forward);
        [
            dot(d, self.right) / (z * self.half[0]),
            dot(d, self.up) / (z * self.half[1]),
            z,
        ]
    }

    /// Direction of a place in the picture, of length 1 along the axis.
    pub fn ray(&self, x: f32, y: f32) -> Vector {
        let ray = along(self.forward, x * self.half[0], self.right);
        along(ray, y * self.half[1], self.up)
    }
}
