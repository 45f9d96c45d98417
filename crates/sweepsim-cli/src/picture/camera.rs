//! Where the picture is taken from, and where the light is.

use super::raster::Projected;
use super::shade::Surface;
use super::vector::{V, add, cross, dot, scale, sub, unit};

/// Height of the eye over the horizon, degrees.
const ELEVATION: f32 = 42.0;
/// How far the view is turned away from the part's long side, degrees.
const TURN: f32 = 32.0;
/// Half the opening angle over the height of the picture, degrees.
const OPENING: f32 = 13.0;
/// How much of the picture the part fills.
const FILL: f32 = 0.9;

/// A pinhole camera. The surface's places are in units of its size about its middle.
pub(super) struct Camera {
    eye: V,
    right: V,
    up: V,
    forward: V,
    /// Pixels per unit at distance 1.
    focal: f32,
    middle: [f32; 2],
}

impl Camera {
    pub fn new(mesh: &Surface, size: [usize; 2]) -> Self {
        let [width, height] = size.map(|pixels| pixels as f32);
        // The longer side lies across the picture.
        let wide = mesh.half[0] >= mesh.half[1];
        let azimuth = if wide { -90.0 + TURN } else { TURN };
        let (sin, cos) = azimuth.to_radians().sin_cos();
        let (rise, out) = ELEVATION.to_radians().sin_cos();
        let back = [cos * out, sin * out, rise];
        let forward = scale(back, -1.0);
        let right = unit(cross(forward, [0.0, 0.0, 1.0]));
        let up = cross(right, forward);
        let slope = OPENING.to_radians().tan();
        let focal = 0.5 * height / slope;
        let reach = [FILL * 0.5 * width / focal, FILL * 0.5 * height / focal];
        let mut target = [0.0; 3];
        let mut distance = 1.0_f32;
        for _ in 0..6 {
            let mut range = [[f32::INFINITY; 2], [f32::NEG_INFINITY; 2]];
            distance = 0.0;
            for place in mesh.seen() {
                let from = sub(place, target);
                let aside = [dot(from, right), dot(from, up)];
                for k in 0..2 {
                    distance = distance.max(aside[k].abs() / reach[k] - dot(from, forward));
                }
            }
            distance = distance.max(1e-3);
            for place in mesh.seen() {
                let from = sub(place, target);
                let depth = distance + dot(from, forward);
                for (k, axis) in [right, up].into_iter().enumerate() {
                    let at = dot(from, axis) / depth;
                    range[0][k] = range[0][k].min(at);
                    range[1][k] = range[1][k].max(at);
                }
            }
            for (k, axis) in [right, up].into_iter().enumerate() {
                target = add(target, scale(axis, 0.5 * (range[0][k] + range[1][k]) * distance));
            }
        }
        Self {
            eye: sub(target, scale(forward, distance)),
            right,
            up,
            forward,
            focal,
            middle: [0.5 * width, 0.5 * height],
        }
    }

    pub fn project(&self, place: V) -> Projected {
        let from = sub(place, self.eye);
        let depth = dot(from, self.forward);
        let inverse = 1.0 / depth;
        Projected {
            x: self.middle[0] + self.focal * dot(from, self.right) * inverse,
            y: self.middle[1] - self.focal * dot(from, self.up) * inverse,
            near: inverse,
        }
    }

    /// The unit direction from a place to the eye.
    pub fn towards(&self, place: V) -> V {
        unit(sub(self.eye, place))
    }

    /// Pixels that a unit covers there.
    pub fn pixels(&self, near: f32) -> f32 {
        self.focal * near
    }

    /// Where the ray through a point of the picture meets the floor at the given height.
    pub fn floor(&self, x: f32, y: f32, height: f32) -> Option<V> {
        let aside = scale(self.right, (x - self.middle[0]) / self.focal);
        let above = scale(self.up, (self.middle[1] - y) / self.focal);
        let ray = add(self.forward, add(aside, above));
        let t = (height - self.eye[2]) / ray[2];
        (ray[2] < 0.0 && t > 0.0).then(|| add(self.eye, scale(ray, t)))
    }

    /// The directions right, up and back of the picture.
    pub fn axes(&self) -> [V; 3] {
        [self.right, self.up, scale(self.forward, -1.0)]
    }
}

/// Parallel light, and its view of the part.
pub(super) struct Light {
    /// Unit direction towards it.
    pub direction: V,
    right: V,
    up: V,
    /// Pixels per unit.
    scale: f32,
    middle: f32,
}

impl Light {
    /// Over the viewer's left shoulder.
    pub fn key(mesh: &Surface, camera: &Camera, size: usize) -> Self {
        let [right, _, back] = camera.axes();
        let level = unit([back[0], back[1], 0.0]);
        let direction = unit(add(add(scale(right, -0.62), scale(level, 0.22)), [0.0, 0.0, 1.0]));
        let reach = dot(mesh.half, mesh.half).sqrt().max(1e-3);
        Self::new(direction, size, 0.49 * size as f32 / reach)
    }

    /// From straight above, with as much again round about the part.
    pub fn overhead(mesh: &Surface, size: usize) -> Self {
        let reach = mesh.half[0].max(mesh.half[1]).max(1e-3);
        Self::new([0.0, 0.0, 1.0], size, 0.25 * size as f32 / reach)
    }

    fn new(direction: V, size: usize, scale: f32) -> Self {
        let across = unit(cross([0.0, 1.0, 0.0], direction));
        Self {
            direction,
            right: across,
            up: cross(direction, across),
            scale,
            middle: 0.5 * size as f32,
        }
    }

    pub fn project(&self, place: V) -> Projected {
        Projected {
            x: self.middle + self.scale * dot(place, self.right),
            y: self.middle + self.scale * dot(place, self.up),
            // Kept positive: nothing is farther than 2 from the middle.
            near: 4.0 + dot(place, self.direction),
        }
    }
}
