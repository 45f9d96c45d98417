//! How open each visible place is to its surroundings: dark in corners and pockets.

use super::camera::Camera;
use super::raster::{NONE, Projected, Visible};
use super::shade::Surface;
use super::vector::{V, dot, sub};
use rayon::prelude::*;

/// Directions in the picture, and steps along each.
const DIRECTIONS: usize = 12;
const STEPS: usize = 6;
/// How far the surroundings reach, in units of the part's size.
const REACH: f32 = 0.16;
/// Computed for one pixel in so many, each way.
const SPARSE: usize = 2;
/// Half the width of the window that smooths the result, in pixels that are computed.
const SMOOTH: isize = 2;

/// One number a pixel, from 0 (buried) to 1 (open).
pub(super) fn openness(mesh: &Surface, camera: &Camera, visible: &Visible, places: &[Projected]) -> Vec<f32> {
    let [width, height] = visible.size;
    let points: Vec<Option<(V, V)>> = (0..width * height)
        .into_par_iter()
        .map(|pixel| {
            let number = visible.triangle[pixel];
            (number != NONE).then(|| {
                let (x, y) = ((pixel % width) as f32 + 0.5, (pixel / width) as f32 + 0.5);
                let point = mesh.point(number, places, x, y);
                // The flat normal: shading normals would shade flat triangles by themselves.
                (point.place, point.flat)
            })
        })
        .collect();
    let raw: Vec<f32> = (0..width * height)
        .into_par_iter()
        .map(|pixel| {
            let computed = pixel % width % SPARSE == 0 && pixel / width % SPARSE == 0;
            let Some((place, normal)) = points[pixel].filter(|_| computed) else {
                return 1.0;
            };
            let facing = dot(normal, camera.towards(place));
            let normal = if facing < 0.0 { normal.map(|c| -c) } else { normal };
            let reach = (REACH * camera.pixels(visible.near[pixel])).clamp(4.0, 400.0);
            let (x, y) = ((pixel % width) as f32, (pixel / width) as f32);
            let mut hidden = 0.0;
            for direction in 0..DIRECTIONS {
                let (sin, cos) = (direction as f32 * std::f32::consts::TAU / DIRECTIONS as f32 + 0.2).sin_cos();
                // The highest horizon along the direction counts, less the farther away it is.
                let mut horizon = 0.0_f32;
                for step in 1..=STEPS {
                    let part = (step as f32 / STEPS as f32).powf(1.6);
                    let away = 1.0 + reach * part;
                    let (sx, sy) = ((x + cos * away).round(), (y + sin * away).round());
                    if sx < 0.0 || sy < 0.0 || sx >= width as f32 || sy >= height as f32 {
                        break;
                    }
                    if let Some((other, _)) = points[sy as usize * width + sx as usize] {
                        let between = sub(other, place);
                        let distance = dot(between, between).sqrt().max(1e-6);
                        let sine = dot(between, normal) / distance - 0.12;
                        let fade = 1.0 - (distance / (1.5 * REACH)).powi(2);
                        horizon = horizon.max(sine * fade.max(0.0));
                    }
                }
                hidden += horizon;
            }
            (1.0 - 1.35 * hidden / DIRECTIONS as f32).clamp(0.0, 1.0)
        })
        .collect();
    // Smoothed over places on the same surface.
    (0..width * height)
        .into_par_iter()
        .map(|pixel| {
            let Some((place, normal)) = points[pixel] else {
                return 1.0;
            };
            let pixels = camera.pixels(visible.near[pixel]);
            let sparse = SPARSE as isize;
            let (x, y) = ((pixel % width / SPARSE) as isize, (pixel / width / SPARSE) as isize);
            let (mut sum, mut weights) = (0.0, 0.0);
            for dy in -SMOOTH..=SMOOTH {
                for dx in -SMOOTH..=SMOOTH {
                    let (sx, sy) = (sparse * (x + dx), sparse * (y + dy));
                    if sx < 0 || sy < 0 || sx >= width as isize || sy >= height as isize {
                        continue;
                    }
                    let other = sy as usize * width + sx as usize;
                    if let Some((there, facing)) = points[other] {
                        let off = dot(sub(there, place), normal).abs() * pixels;
                        let weight = (dot(facing, normal).max(0.0).powi(4) / (1.0 + off * off)).max(1e-4);
                        sum += weight * raw[other];
                        weights += weight;
                    }
                }
            }
            if weights > 0.0 { sum / weights } else { 1.0 }
        })
        .collect()
}
