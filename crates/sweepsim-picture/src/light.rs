//! Light and shadow, from depth maps seen from each light.

use crate::camera::Camera;
use crate::scene::Scene;
use crate::vector::{Vector, add, along, cross, dot, scale, unit};
use rayon::prelude::*;
use std::collections::HashMap;

/// Directions sampled of the sky and the ground.
const SKY: usize = 96;
/// The fewest of them, for meshes that take long to draw.
const FEWEST: usize = 32;
/// About how many triangles are drawn for them in total.
const WORK: usize = 60_000_000;
/// Texels across their maps.
const SKY_MAP: usize = 400;
/// Depth maps of the lamp, and texels across.
const LAMP: usize = 16;
const LAMP_MAP: usize = 1024;
/// Radius of the lamp at distance 1.
const LAMP_SIZE: f32 = 0.16;
/// Points across the net on the ground, and its reach.
const NET: usize = 320;
pub(crate) const NET_REACH: f32 = 2.4;
/// The golden angle.
const GOLDEN: f32 = 2.399_963_2;

/// Distances from a distant light to the nearest surface.
struct DepthMap {
    direction: Vector,
    across: [Vector; 2],
    texels: usize,
    depth: Vec<f32>,
}

impl DepthMap {
    /// `direction` points towards the light.
    fn new(scene: &Scene, direction: Vector, texels: usize) -> Self {
        let other = if direction[2].abs() < 0.9 {
            [0.0, 0.0, 1.0]
        } else {
            [1.0, 0.0, 0.0]
        };
        let right = unit(cross(other, direction));
        let mut map = Self {
            direction,
            across: [right, cross(direction, right)],
            texels,
            depth: vec![f32::INFINITY; texels * texels],
        };
        let points: Vec<Vector> = scene.positions.iter().map(|p| map.place(*p)).collect();
        for t in &scene.triangles {
            // Light that enters through a section reaches the back of the face behind it.
            map.draw(t.map(|v| points[v as usize]), !scene.sections.is_empty());
        }
        map
    }

    /// Column and row (texel centres are whole numbers), and depth, which grows away from the light.
    fn place(&self, p: Vector) -> Vector {
        let half = 0.5 * self.texels as f32;
        [
            half + dot(p, self.across[0]) * half * 0.99 - 0.5,
            half + dot(p, self.across[1]) * half * 0.99 - 0.5,
            -dot(p, self.direction),
        ]
    }

    fn draw(&mut self, [a, mut b, mut c]: [Vector; 3], backs: bool) {
        let mut area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area < 0.0 && backs {
            (area, b, c) = (-area, c, b);
        }
        // A back face: a front face is nearer to the light.
        if area.is_nan() || area <= 0.0 {
            return;
        }
        let last = self.texels as f32 - 1.0;
        let low = [0, 1].map(|k| a[k].min(b[k]).min(c[k]).ceil().max(0.0));
        let high = [0, 1].map(|k| a[k].max(b[k]).max(c[k]).floor().min(last));
        if low[0] > high[0] || low[1] > high[1] {
            return;
        }
        let from = low.map(|c| c as usize);
        let to = high.map(|c| c as usize);
        if from == to {
            // Several such triangles may share a texel: the furthest corner casts no shadow on its neighbours.
            let inside =
                |p: Vector, q: Vector| (q[0] - p[0]) * (low[1] - p[1]) - (q[1] - p[1]) * (low[0] - p[0]) >= 0.0;
            if inside(a, b) && inside(b, c) && inside(c, a) {
                let texel = &mut self.depth[from[1] * self.texels + from[0]];
                *texel = texel.min(a[2].max(b[2]).max(c[2]));
            }
            return;
        }
        let scale = 1.0 / area;
        // Weights of b and c grow like this with column and row.
        let (bx, by) = ((c[1] - a[1]) * scale, -(c[0] - a[0]) * scale);
        let (cx, cy) = (-(b[1] - a[1]) * scale, (b[0] - a[0]) * scale);
        for row in from[1]..=to[1] {
            for column in from[0]..=to[0] {
                let (x, y) = (column as f32 - a[0], row as f32 - a[1]);
                let (wb, wc) = (bx * x + by * y, cx * x + cy * y);
                if wb >= -1e-4 && wc >= -1e-4 && wb + wc <= 1.0001 {
                    let z = a[2] + wb * (b[2] - a[2]) + wc * (c[2] - a[2]);
                    let texel = &mut self.depth[row * self.texels + column];
                    *texel = texel.min(z);
                }
            }
        }
    }

    /// The share of light that reaches a point, interpolated between four texels.
    fn light(&self, p: Vector, bias: f32) -> f32 {
        let [x, y, z] = self.place(p);
        let last = self.texels as f32 - 2.0;
        if !(x >= 0.0 && y >= 0.0 && x <= last && y <= last) {
            return 1.0;
        }
        let (column, row) = (x as usize, y as usize);
        let (s, t) = (x - column as f32, y - row as f32);
        let first = row * self.texels + column;
        let z = z - bias;
        let seen = |index: usize| f32::from(u8::from(z <= self.depth[index]));
        let lower = seen(first) * (1.0 - s) + seen(first + 1) * s;
        let upper = seen(first + self.texels) * (1.0 - s) + seen(first + self.texels + 1) * s;
        lower * (1.0 - t) + upper * t
    }
}

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
    maps: Vec<DepthMap>,
    /// Sky and ground at each vertex.
    pub around: Vec<Around>,
    /// Sky and lamp at the points of the net on the ground.
    net: Vec<[f32; 2]>,
}

impl Lights {
    pub fn new(scene: &Scene, camera: &Camera) -> Self {
        // Above the viewer's left shoulder.
        let lamp = unit(add(
            add(scale(camera.right, -0.75), scale(camera.forward, -0.12)),
            [0.0, 0.0, 0.95],
        ));
        let mut lights = Self {
            lamp,
            maps: Vec::new(),
            around: Vec::new(),
            net: Vec::new(),
        };
        if scene.triangles.is_empty() {
            return lights;
        }
        let side = unit(cross(lamp, [0.0, 0.0, 1.0]));
        let other = cross(side, lamp);
        lights.maps = (0..LAMP)
            .into_par_iter()
            .map(|k| {
                let r = LAMP_SIZE * ((k as f32 + 0.5) / LAMP as f32).sqrt();
                let (sin, cos) = (k as f32 * GOLDEN).sin_cos();
                let direction = unit(along(along(lamp, r * cos, side), r * sin, other));
                DepthMap::new(scene, direction, LAMP_MAP)
            })
            .collect();
        let count = (WORK / scene.triangles.len()).clamp(FEWEST, SKY);
        let sky: Vec<DepthMap> = (0..count)
            .into_par_iter()
            .map(|k| {
                let z = 1.0 - (2 * k + 1) as f32 / count as f32;
                let r = (1.0 - z * z).sqrt();
                let (sin, cos) = (k as f32 * GOLDEN).sin_cos();
                DepthMap::new(scene, [r * cos, r * sin, z], SKY_MAP)
            })
            .collect();
        let texel = 2.0 / SKY_MAP as f32;
        let (groups, firsts) = same_places(scene);
        let mut surroundings: Vec<Around> = firsts
            .par_iter()
            .map(|v| around(&sky, scene.positions[*v], scene.normals[*v], texel))
            .collect();
        for _ in 0..3 {
            surroundings = smoothed(scene, &groups, &surroundings);
        }
        lights.around = groups.iter().map(|group| surroundings[*group as usize]).collect();
        lights.net = (0..NET * NET)
            .into_par_iter()
            .map(|index| {
                let x = net_place(index % NET);
                let y = net_place(index / NET);
                let p = [x, y, scene.ground];
                let above = &sky[..count / 2];
                let [seen, all] = above.iter().fold([0.0_f32; 2], |[seen, all], map| {
                    let z = map.direction[2];
                    [seen + z * map.light(p, texel), all + z]
                });
                [seen / all.max(f32::MIN_POSITIVE), lights.lamp_at(p, [0.0, 0.0, 1.0])]
            })
            .collect();
        for _ in 0..3 {
            lights.net = blurred(&lights.net);
        }
        lights
    }

    /// The share of the lamp that a point of a surface sees.
    pub fn lamp_at(&self, p: Vector, normal: Vector) -> f32 {
        let texel = 2.0 / LAMP_MAP as f32;
        let grazing = 1.0 - dot(normal, self.lamp).clamp(0.0, 1.0);
        let p = along(p, texel * (1.5 + 2.5 * grazing), normal);
        let sum: f32 = self.maps.iter().map(|map| map.light(p, 1.5 * texel)).sum();
        sum / self.maps.len().max(1) as f32
    }

    /// Sky and lamp at a point of the ground: 1 is all.
    pub fn ground(&self, x: f32, y: f32) -> [f32; 2] {
        let place = |c: f32| (c / NET_REACH + 1.0) * 0.5 * (NET as f32 - 1.0);
        let (x, y) = (place(x), place(y));
        let last = NET as f32 - 2.0;
        if self.net.is_empty() || !(x >= 0.0 && y >= 0.0 && x <= last && y <= last) {
            return [1.0; 2];
        }
        let (column, row) = (x as usize, y as usize);
        let (s, t) = (x - column as f32, y - row as f32);
        let at = |dx: usize, dy: usize| self.net[(row + dy) * NET + column + dx];
        [0, 1].map(|k| {
            let lower = at(0, 0)[k] * (1.0 - s) + at(1, 0)[k] * s;
            let upper = at(0, 1)[k] * (1.0 - s) + at(1, 1)[k] * s;
            lower * (1.0 - t) + upper * t
        })
    }
}

fn net_place(k: usize) -> f32 {
    (2.0 * k as f32 / (NET as f32 - 1.0) - 1.0) * NET_REACH
}

/// The mean over each point and its neighbours.
fn blurred(net: &[[f32; 2]]) -> Vec<[f32; 2]> {
    let around = |k: usize| k.saturating_sub(1)..=(k + 1).min(NET - 1);
    (0..NET * NET)
        .into_par_iter()
        .map(|index| {
            let (mut sum, mut count) = ([0.0; 2], 0.0);
            for row in around(index / NET) {
                for column in around(index % NET) {
                    let value = net[row * NET + column];
                    sum = [sum[0] + value[0], sum[1] + value[1]];
                    count += 1.0;
                }
            }
            sum.map(|c: f32| c / count)
        })
        .collect()
}

fn around(maps: &[DepthMap], p: Vector, n: Vector, texel: f32) -> Around {
    let start = along(p, 2.0 * texel, n);
    let mut around = Around::default();
    for map in maps {
        let cosine = dot(n, map.direction);
        if cosine > 0.0 {
            let light = cosine * map.light(start, 1.2 * texel);
            if map.direction[2] > 0.0 {
                around.sky += light;
            } else {
                around.ground += light;
            }
        }
    }
    // The mean of the cosine over a sphere, with 0 behind, is 1/4.
    let all = 4.0 / maps.len().max(1) as f32;
    Around {
        sky: (all * around.sky).min(1.0),
        ground: (all * around.ground).min(1.0),
    }
}

/// Groups vertices at the same point with nearly the same normal: the group of each vertex, and the first vertex of each group.
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
