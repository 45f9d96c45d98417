//! The camera: its position, and the projection onto the image.

use crate::base::vector::{Vector, add, along, cross, dot, scale, sub, unit};
use crate::scene::Scene;
use crate::view::View;

/// A camera that sees the whole scene.
///
/// Depth is a number that varies linearly across the image of a plane and grows towards the viewer: 1 / distance in
/// perspective, [`FAR`] minus the distance in parallel projection.
pub(crate) struct Camera {
    eye: Vector,
    pub right: Vector,
    pub up: Vector,
    pub forward: Vector,
    /// Half the image's width and height in the scene: at distance 1 in perspective, at any distance in parallel
    /// projection.
    half: [f32; 2],
    orthographic: bool,
    /// The share of the image's width left free at the right.
    aside: f32,
}

/// Further than anything in the unit ball, seen from an orthographic camera.
const FAR: f32 = 4.0;

impl Camera {
    pub fn new(view: &View, scene: &Scene) -> Self {
        let kept = |value: f64, from: f64, to: f64| if value.is_finite() { value.clamp(from, to) } else { from };
        let azimuth = kept(view.azimuth, -1e6, 1e6).to_radians();
        let elevation = kept(view.elevation, -90.0, 90.0).to_radians();
        let longer = (0.5 * kept(view.field_of_view, 5.0, 90.0).to_radians()).tan();
        let aside = kept(view.legend, 0.0, 0.5);
        let size = [(1.0 - aside) * view.size[0] as f64, view.size[1] as f64];
        let shape = size.map(|n| n / size[0].max(size[1]));
        let (half, aside) = (shape.map(|n| (longer * n) as f32), aside as f32);
        let towards = [
            elevation.cos() * azimuth.cos(),
            elevation.cos() * azimuth.sin(),
            elevation.sin(),
        ]
        .map(|c| c as f32);
        let forward = scale(unit(towards), -1.0);
        // Horizontal even when looking straight down.
        let right = [-azimuth.sin() as f32, azimuth.cos() as f32, 0.0];
        let up = cross(right, forward);
        // In camera axes every point must satisfy x − px ≤ h (z − pz) and its three mirror images: stand at the nearest
        // position where all of them hold.
        let free = (1.0 - 2.0 * kept(view.margin, 0.0, 0.4)) as f32;
        if view.orthographic {
            let level = Self::level(scene, [right, up, forward], shape.map(|n| n as f32), free);
            return Self { aside, ..level };
        }
        let mut most = [[f32::NEG_INFINITY; 2]; 2];
        let mut nearest = f32::INFINITY;
        for p in &scene.corners {
            let z = dot(*p, forward);
            nearest = nearest.min(z);
            for (k, axis) in [right, up].iter().enumerate() {
                let x = dot(*p, *axis);
                most[k][0] = most[k][0].max(x - free * half[k] * z);
                most[k][1] = most[k][1].max(-x - free * half[k] * z);
            }
        }
        if scene.corners.is_empty() {
            (most, nearest) = ([[1.0; 2]; 2], -1.0);
        }
        let back = |k: usize| -(most[k][0] + most[k][1]) / (2.0 * free * half[k]);
        let depth = back(0).min(back(1)).min(nearest - 0.1);
        let off = [0, 1].map(|k: usize| 0.5 * (most[k][0] - most[k][1]));
        let eye = add(scale(forward, depth), add(scale(right, off[0]), scale(up, off[1])));
        Self {
            eye,
            right,
            up,
            forward,
            half,
            orthographic: false,
            aside,
        }
    }

    /// An orthographic camera: the scene's bounding box along its axes fills the free part of the image.
    fn level(scene: &Scene, axes: [Vector; 3], shape: [f32; 2], free: f32) -> Self {
        let mut range = [[f32::INFINITY, f32::NEG_INFINITY]; 3];
        for p in &scene.corners {
            for (range, axis) in range.iter_mut().zip(axes) {
                let x = dot(*p, axis);
                *range = [range[0].min(x), range[1].max(x)];
            }
        }
        if scene.corners.is_empty() {
            range = [[-1.0, 1.0]; 3];
        }
        let [right, up, forward] = axes;
        let middle = [0, 1].map(|k: usize| 0.5 * (range[k][0] + range[k][1]));
        let needed = [0, 1].map(|k: usize| 0.5 * (range[k][1] - range[k][0]) / (free * shape[k]));
        let size = needed[0].max(needed[1]).max(1e-6);
        let eye = add(scale(right, middle[0]), scale(up, middle[1]));
        Self {
            eye: along(eye, range[2][0] - 0.5, forward),
            right,
            up,
            forward,
            half: shape.map(|n| size * n),
            orthographic: true,
            aside: 0.0,
        }
    }

    /// A point's position in the image, from −1 to 1 to the right and up; its depth; and its weight in
    /// perspective-correct interpolation.
    pub fn project(&self, p: Vector) -> [f32; 4] {
        let d = sub(p, self.eye);
        let z = dot(d, self.forward);
        let (x, y) = (dot(d, self.right) / self.half[0], dot(d, self.up) / self.half[1]);
        let [x, y, near, weight] = if self.orthographic {
            [x, y, FAR - z, 1.0]
        } else {
            [x / z, y / z, 1.0 / z, 1.0 / z]
        };
        [x * (1.0 - self.aside) - self.aside, y, near, weight]
    }

    /// The origin of the line of sight through a point of the image, and its direction, of length 1 along the camera's
    /// axis.
    pub fn sight(&self, x: f32, y: f32) -> [Vector; 2] {
        let x = (x + self.aside) / (1.0 - self.aside);
        let aside = add(scale(self.right, x * self.half[0]), scale(self.up, y * self.half[1]));
        if self.orthographic {
            [add(self.eye, aside), self.forward]
        } else {
            [self.eye, add(self.forward, aside)]
        }
    }

    /// The distance along the axis at a depth.
    pub fn distance(&self, near: f32) -> f32 {
        if self.orthographic { FAR - near } else { 1.0 / near }
    }

    /// The depth at a distance along the axis.
    pub fn near(&self, distance: f32) -> f32 {
        if self.orthographic {
            FAR - distance
        } else {
            1.0 / distance
        }
    }

    /// A difference of depths as a difference of distances, to first order.
    pub fn difference(&self, near: f32, difference: f32) -> f32 {
        if self.orthographic {
            difference
        } else {
            difference / (near * near)
        }
    }

    /// Where the viewer stands; in parallel projection the middle of the image.
    pub fn eye(&self) -> Vector {
        self.eye
    }

    /// Pixels of a unit of the scene across the line of sight, at a distance along the axis, in an image `width` pixels
    /// wide.
    pub fn pixels(&self, distance: f32, width: f32) -> f32 {
        let half = if self.orthographic {
            self.half[0]
        } else {
            self.half[0] * distance
        };
        0.5 * width * (1.0 - self.aside) / half
    }

    /// The direction from a point to the viewer.
    pub fn towards(&self, p: Vector) -> Vector {
        if self.orthographic {
            scale(self.forward, -1.0)
        } else {
            unit(sub(self.eye, p))
        }
    }
}
