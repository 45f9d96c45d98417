//! Light and shadow, from depth maps seen from each light.

use crate::base::steps::Steps;
use crate::base::vector::{Vector, add, along, cross, dot, scale, unit};
use crate::camera::Camera;
use crate::depth_maps::DepthMaps;
use crate::scene::Scene;
use rayon::prelude::*;
use std::collections::HashMap;

/// Directions sampled of the sky and the ground.
const SKY: usize = 64;
/// The fewest of them, for meshes that take long to draw.
const FEWEST: usize = 32;
/// About how many triangles are drawn for them in total.
const WORK: usize = 30_000_000;
/// Texels across their maps, in pictures that are not [small](fine).
const SKY_MAP: usize = 400;
/// Depth maps of the lamp, and texels across.
const LAMP: usize = 16;
const LAMP_MAP: usize = 1024;
/// Radius of the lamp at distance 1.
const LAMP_SIZE: f32 = 0.16;
/// Points across the net on the ground, and its reach.
const NET: usize = 320;
/// Pictures with fewer pixels along their longer side have coarser maps and nets, down to a quarter.
const SMALL: usize = 640;
pub(crate) const NET_REACH: f32 = 2.4;
/// The golden angle.
const GOLDEN: f32 = 2.399_963_2;

/// How much of the sky and of the ground a point sees, weighted by the cosine: 1 is all.
#[derive(Clone, Copy, Default)]
pub(crate) struct Around {
    pub sky: f32,
    pub ground: f32,
}

/// The lights of a scene.
pub(crate) struct Lights {
    /// The direction of the lamp.
    pub lamp: Vector,
    /// Its shadows; none without triangles.
    shadows: Option<DepthMaps>,
    /// Sky and ground at each vertex.
    pub around: Vec<Around>,
    /// Sky and lamp at the points of the net on the ground.
    net: Vec<[f32; 2]>,
    /// Points across the net.
    across: usize,
    /// How often it is blurred: over about the same distance in any picture.
    blurs: usize,
}

impl Lights {
    /// The number of steps that they take.
    pub fn steps(scene: &Scene) -> usize {
        if scene.triangles.is_empty() {
            return 0;
        }
        LAMP + sky_maps(scene) + 2
    }

    /// The lights for a picture of this size. Returns `None` if the steps end before all are known.
    pub fn new(scene: &Scene, camera: &Camera, size: [usize; 2], steps: &Steps<'_>) -> Option<Self> {
        // Above the viewer's left shoulder.
        let lamp = unit(add(
            add(scale(camera.right, -0.75), scale(camera.forward, -0.12)),
            [0.0, 0.0, 0.95],
        ));
        let mut lights = Self {
            lamp,
            shadows: None,
            around: Vec::new(),
            net: Vec::new(),
            across: fine(NET, size),
            blurs: fine(3, size),
        };
        if scene.triangles.is_empty() {
            return Some(lights);
        }
        lights.shadows = Some(DepthMaps::new(
            scene,
            &over_the_lamp(lamp),
            fine(LAMP_MAP, size),
            steps,
        )?);
        let count = sky_maps(scene);
        let sky = DepthMaps::new(scene, &over_the_sphere(count), fine(SKY_MAP, size), steps)?;
        lights.around = steps.step(|| around_vertices(scene, &sky, count))?;
        lights.net = steps.step(|| lights.on_the_ground(scene, &sky, count))?;
        Some(lights)
    }

    /// Sky and lamp at the points of the net.
    fn on_the_ground(&self, scene: &Scene, sky: &DepthMaps, count: usize) -> Vec<[f32; 2]> {
        let above = |direction: Vector| direction[2];
        let all: f32 = over_the_sphere(count).into_iter().map(|d| above(d).max(0.0)).sum();
        let across = self.across;
        let place = |k: usize| (2.0 * k as f32 / (across as f32 - 1.0) - 1.0) * NET_REACH;
        let net = (0..across * across).into_par_iter().map(|index| {
            let p = [place(index % across), place(index / across), scene.ground];
            let [seen, _] = sky.reaching(p, sky.texel(), above);
            [seen / all.max(f32::MIN_POSITIVE), self.lamp_at(p, [0.0, 0.0, 1.0])]
        });
        (0..self.blurs).fold(net.collect(), |net: Vec<[f32; 2]>, _| blurred(&net, across))
    }

    /// The share of the lamp that a point of a surface sees.
    pub fn lamp_at(&self, p: Vector, normal: Vector) -> f32 {
        let Some(shadows) = &self.shadows else {
            return 1.0;
        };
        let texel = shadows.texel();
        let grazing = 1.0 - dot(normal, self.lamp).clamp(0.0, 1.0);
        let p = along(p, texel * (1.5 + 2.5 * grazing), normal);
        shadows.mean_share(p, 1.5 * texel)
    }

    /// Sky and lamp at a point of the ground: 1 is all.
    pub fn ground(&self, x: f32, y: f32) -> [f32; 2] {
        let place = |c: f32| (c / NET_REACH + 1.0) * 0.5 * (self.across as f32 - 1.0);
        let (x, y) = (place(x), place(y));
        let last = self.across as f32 - 2.0;
        if self.net.is_empty() || !(x >= 0.0 && y >= 0.0 && x <= last && y <= last) {
            return [1.0; 2];
        }
        let (column, row) = (x as usize, y as usize);
        let (s, t) = (x - column as f32, y - row as f32);
        let at = |dx: usize, dy: usize| self.net[(row + dy) * self.across + column + dx];
        [0, 1].map(|k| {
            let lower = at(0, 0)[k] * (1.0 - s) + at(1, 0)[k] * s;
            let upper = at(0, 1)[k] * (1.0 - s) + at(1, 1)[k] * s;
            lower * (1.0 - t) + upper * t
        })
    }
}

/// What of so many points or texels a picture of this size has use for.
fn fine(most: usize, size: [usize; 2]) -> usize {
    most * size[0].max(size[1]).clamp(SMALL / 4, SMALL) / SMALL
}

/// The mean over each point and its neighbours, of a net of so many points across.
fn blurred(net: &[[f32; 2]], across: usize) -> Vec<[f32; 2]> {
    let around = |k: usize| k.saturating_sub(1)..=(k + 1).min(across - 1);
    (0..across * across)
        .into_par_iter()
        .map(|index| {
            let (mut sum, mut count) = ([0.0; 2], 0.0);
            for row in around(index / across) {
                for column in around(index % across) {
                    let value = net[row * across + column];
                    sum = [sum[0] + value[0], sum[1] + value[1]];
                    count += 1.0;
                }
            }
            sum.map(|c: f32| c / count)
        })
        .collect()
}

/// The number of directions that the sky and the ground are sampled in.
fn sky_maps(scene: &Scene) -> usize {
    (WORK / scene.triangles.len().max(1)).clamp(FEWEST, SKY)
}

/// Directions spread over the lamp; so are the first half of them, and the second.
fn over_the_lamp(lamp: Vector) -> Vec<Vector> {
    let side = unit(cross(lamp, [0.0, 0.0, 1.0]));
    let other = cross(side, lamp);
    let direction = |k: usize| {
        let r = LAMP_SIZE * ((k as f32 + 0.5) / LAMP as f32).sqrt();
        let (sin, cos) = (k as f32 * GOLDEN).sin_cos();
        unit(along(along(lamp, r * cos, side), r * sin, other))
    };
    let first = (0..LAMP).step_by(2);
    first.chain((1..LAMP).step_by(2)).map(direction).collect()
}

/// Directions spread over the sphere.
fn over_the_sphere(count: usize) -> Vec<Vector> {
    let direction = |k: usize| {
        let z = 1.0 - (2 * k + 1) as f32 / count as f32;
        let r = (1.0 - z * z).sqrt();
        let (sin, cos) = (k as f32 * GOLDEN).sin_cos();
        [r * cos, r * sin, z]
    };
    (0..count).map(direction).collect()
}

/// What each vertex sees.
fn around_vertices(scene: &Scene, sky: &DepthMaps, count: usize) -> Vec<Around> {
    let (groups, firsts) = same_places(scene);
    let seen = firsts
        .par_iter()
        .map(|v| around(sky, count, scene.positions[*v], scene.normals[*v]));
    let surroundings = (0..3).fold(seen.collect(), |seen: Vec<Around>, _| smoothed(scene, &groups, &seen));
    groups.iter().map(|group| surroundings[*group as usize]).collect()
}

fn around(sky: &DepthMaps, count: usize, p: Vector, n: Vector) -> Around {
    let texel = sky.texel();
    let start = along(p, 2.0 * texel, n);
    let light = sky.reaching(start, 1.2 * texel, |direction| dot(n, direction));
    // The mean of the cosine over a sphere, with 0 behind, is 1/4.
    let [sky, ground] = light.map(|light| (4.0 / count as f32 * light).min(1.0));
    Around { sky, ground }
}

/// Groups vertices at the same point with nearly the same normal: the group of each vertex, and the first vertex of
/// each group.
fn same_places(scene: &Scene) -> (Vec<u32>, Vec<usize>) {
    // Only looked up, so its order does not matter.
    let mut known: HashMap<([u32; 3], [i8; 3]), u32> = HashMap::with_capacity(scene.positions.len());
    let mut firsts = Vec::new();
    let groups = scene
        .positions
        .iter()
        .zip(&scene.normals)
        .enumerate()
        .map(|(v, (p, n))| {
            let key = (p.map(|c| (c + 0.0).to_bits()), n.map(|c| (1.9 * c).round() as i8));
            *known.entry(key).or_insert_with(|| {
                firsts.push(v);
                firsts.len() as u32 - 1
            })
        })
        .collect();
    (groups, firsts)
}

/// The mean over the triangles around each group of vertices.
fn smoothed(scene: &Scene, groups: &[u32], values: &[Around]) -> Vec<Around> {
    let mut sums = vec![(0.0_f32, 0.0_f32, 0.0_f32); values.len()];
    for t in &scene.triangles {
        let t = t.map(|v| groups[v as usize] as usize);
        let [a, b, c] = t.map(|g| values[g]);
        let (sky, ground) = (a.sky + b.sky + c.sky, a.ground + b.ground + c.ground);
        for g in t {
            let sum = &mut sums[g];
            *sum = (sum.0 + sky, sum.1 + ground, sum.2 + 3.0);
        }
    }
    sums.iter()
        .zip(values)
        .map(|((sky, ground, count), old)| {
            if *count > 0.0 {
                Around {
                    sky: sky / count,
                    ground: ground / count,
                }
            } else {
                *old
            }
        })
        .collect()
}
