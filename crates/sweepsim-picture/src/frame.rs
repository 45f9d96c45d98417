//! From triangles to pixels.

use crate::band::{Band, Surface};
use crate::base::image::Image;
use crate::base::steps::Steps;
use crate::camera::Camera;
use crate::light::Lights;
use crate::scene::Scene;
use rayon::prelude::*;

/// Samples across a pixel.
pub(crate) const SAMPLES: usize = 3;
/// Rows of pixels in a band.
pub(crate) const BAND: usize = 16;
/// Pixels around a band whose samples it computes as well.
pub(crate) const RIM: usize = 1;
/// Fixed-point steps between neighbouring samples.
pub(crate) const STEP: f32 = 256.0;
/// A vertex in the image, in steps from the top left sample, with its depth, its interpolation weight, and the surface
/// there.
pub(crate) struct ImagePoint {
    pub x: i64,
    pub y: i64,
    pub near: f32,
    pub weight: f32,
    pub surface: Surface,
}

/// Twice the area of a triangle: positive if it faces the viewer (counter-clockwise with `y` up).
pub(crate) fn area(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[1] - a[1]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[1] - a[1])
}

/// The number of steps that [`render`] takes.
pub(crate) fn steps(size: [usize; 2]) -> usize {
    size[1].div_ceil(BAND)
}

/// Renders a scene; each band is a step. Returns `None` if the steps end before all are done.
pub(crate) fn render(
    scene: &Scene,
    camera: &Camera,
    lights: &Lights,
    size: [usize; 2],
    steps: &Steps<'_>,
) -> Option<Image> {
    let samples = size.map(|n| (n * SAMPLES) as f32);
    let points: Vec<ImagePoint> = scene
        .positions
        .par_iter()
        .enumerate()
        .map(|(v, p)| {
            let [x, y, near, weight] = camera.project(*p);
            let place = |c: f32, n: f32| (((0.5 + 0.5 * c) * n - 0.5) * STEP).round() as i64;
            ImagePoint {
                x: place(x, samples[0]),
                y: place(-y, samples[1]),
                near,
                weight,
                surface: Surface {
                    normal: scene.normals[v],
                    around: lights.around.get(v).copied().unwrap_or_default(),
                    value: scene.values[v],
                },
            }
        })
        .collect();
    let bands = size[1].div_ceil(BAND);
    let lists = sort_into_bands(scene, &points, bands);
    let mut image = Image::black(size);
    image
        .rgb_mut()
        .par_chunks_mut(size[0] * 3 * BAND)
        .zip(&lists)
        .enumerate()
        .try_for_each_init(Band::default, |band, (number, (rows, list))| {
            steps.step(|| {
                band.look(scene, camera, &points, size, number * BAND, list);
                band.paint(scene, camera, lights, rows);
            })
        })?;
    Some(image)
}

/// The triangles that each band sees, in their order: those that face the viewer, or all if there are sections.
fn sort_into_bands(scene: &Scene, points: &[ImagePoint], bands: usize) -> Vec<Vec<u32>> {
    let step = STEP as i64;
    let mut lists = vec![Vec::new(); bands];
    for (number, t) in scene.triangles.iter().enumerate() {
        let [a, b, c] = t.map(|v| &points[v as usize]);
        // Behind the camera, as a tool may be that comes towards the viewer.
        if a.near.min(b.near).min(c.near) <= 0.0 {
            continue;
        }
        let seen = area([a.x, a.y], [b.x, b.y], [c.x, c.y]);
        if seen == 0 || (seen < 0 && scene.sections.is_empty()) {
            continue;
        }
        let row = |y: i64| y.div_euclid(step * SAMPLES as i64);
        let rim = RIM as i64 + 1;
        let first = (row(a.y.min(b.y).min(c.y)) - rim).div_euclid(BAND as i64).max(0);
        let last = (row(a.y.max(b.y).max(c.y)) + rim)
            .div_euclid(BAND as i64)
            .min(bands as i64 - 1);
        for band in first..=last {
            lists[band as usize].push(number as u32);
        }
    }
    lists
}
