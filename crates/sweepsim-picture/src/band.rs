//! A band of rows: which triangle each sample sees, and the colours of its pixels.

use crate::base::columns;
use crate::base::vector::{Vector, add, along, dot, mix, scale, smooth_step, unit};
use crate::camera::Camera;
use crate::frame::{BAND, ImagePoint, RIM, SAMPLES, STEP, area};
use crate::light::{Around, Lights};
use crate::scene::Scene;
use crate::shade::{self, Matter, Spot};

/// Marks a sample that sees no triangle.
const EMPTY: u32 = u32::MAX;
/// Marks a sample that sees a section.
const CUT_OPEN: u32 = u32::MAX - 1;

/// The samples of a band of rows.
pub(crate) struct Band {
    size: [usize; 2],
    /// The first row of pixels.
    top: usize,
    /// Samples across, including the rim.
    width: usize,
    triangles: Vec<u32>,
    near: Vec<f32>,
    normals: Vec<Vector>,
    around: Vec<Around>,
    values: Vec<f32>,
    /// The number of times that a line of sight leaves the part, less the number of times that it enters; empty without sections.
    depth: Vec<i32>,
    /// Whether a sample sees the inside of the part through a section.
    inside: Vec<bool>,
}

impl Band {
    pub(crate) fn new(
        scene: &Scene,
        camera: &Camera,
        lights: &Lights,
        points: &[ImagePoint],
        size: [usize; 2],
        top: usize,
        list: &[u32],
    ) -> Self {
        let width = (size[0] + 2 * RIM) * SAMPLES;
        let height = (BAND + 2 * RIM) * SAMPLES;
        let count = width * height;
        let mut band = Self {
            size,
            top,
            width,
            triangles: vec![EMPTY; count],
            near: vec![0.0; count],
            normals: Vec::new(),
            around: Vec::new(),
            values: Vec::new(),
            depth: vec![0; if scene.sections.is_empty() { 0 } else { count }],
            inside: Vec::new(),
        };
        if list.is_empty() {
            return band;
        }
        for number in list {
            let corners = scene.triangles[*number as usize].map(|v| points[v as usize]);
            band.draw(*number, corners, *number >= scene.tool);
        }
        band.normals = vec![[0.0; 3]; count];
        band.around = vec![Around::default(); count];
        band.values = vec![0.0; count];
        band.inside = vec![false; count];
        for index in 0..count {
            if band.depth.get(index).is_some_and(|depth| *depth > 0) && band.cut_open(scene, camera, index) {
                continue;
            }
            if band.triangles[index] != EMPTY {
                band.look_up(scene, lights, points, index);
            }
        }
        band
    }

    /// Steps from the image's first sample to the band's.
    fn origin(&self) -> [i64; 2] {
        let rim = (RIM * SAMPLES) as i64;
        [-rim, (self.top * SAMPLES) as i64 - rim].map(|n| n * STEP as i64)
    }

    /// Sections do not cut a tool.
    fn draw(&mut self, number: u32, mut points: [ImagePoint; 3], is_tool: bool) {
        let (step, origin) = (STEP as i64, self.origin());
        let [a, b, c] = points.map(|p| [p.x, p.y]);
        let back = area(a, b, c) < 0;
        if back {
            points.swap(1, 2);
        }
        let [a, b, c] = points.map(|p| [p.x - origin[0], p.y - origin[1]]);
        let height = self.near.len() / self.width;
        let range = |k: usize, count: usize| {
            let low = a[k].min(b[k]).min(c[k]);
            let high = a[k].max(b[k]).max(c[k]);
            let from = (low + step - 1).div_euclid(step).max(0);
            (from, high.div_euclid(step).min(count as i64 - 1))
        };
        let ((left, right), (top, bottom)) = (range(0, self.width), range(1, height));
        let whole = area(a, b, c);
        if left > right || top > bottom || whole <= 0 {
            return;
        }
        let scale = 1.0 / whole as f32;
        for row in top..=bottom {
            let first = [left * step, row * step];
            // Going right by one sample, `area(p, q, at)` grows by (q.y − p.y) steps.
            let mut weights = [area(b, c, first), area(c, a, first), area(a, b, first)];
            let grow = [c[1] - b[1], a[1] - c[1], b[1] - a[1]].map(|d| d * step);
            // A sample on an edge belongs to one of its two triangles only: the one to the right, or below.
            let own = [[b, c], [c, a], [a, b]].map(|[p, q]| q[1] > p[1] || (q[1] == p[1] && q[0] < p[0]));
            let [from, to] = columns::inside(right + 1 - left, weights, grow);
            for k in 0..3 {
                weights[k] += from * grow[k];
            }
            let start = row as usize * self.width;
            for column in left + from..left + to {
                let near = scale * (0..3).map(|k| weights[k] as f32 * points[k].near).sum::<f32>();
                let index = start + column as usize;
                if !back && near > self.near[index] {
                    self.near[index] = near;
                    self.triangles[index] = number;
                }
                if !is_tool
                    && (0..3).all(|k| weights[k] > 0 || own[k])
                    && let Some(depth) = self.depth.get_mut(index)
                {
                    *depth += if back { 1 } else { -1 };
                }
                for k in 0..3 {
                    weights[k] += grow[k];
                }
            }
        }
    }

    /// Interpolates between the corners of the triangle at a sample, with perspective correction.
    fn look_up(&mut self, scene: &Scene, lights: &Lights, points: &[ImagePoint], index: usize) {
        let corners = scene.triangles[self.triangles[index] as usize].map(|v| v as usize);
        let p = corners.map(|v| points[v]);
        let origin = self.origin();
        let step = STEP as i64;
        let at = [
            origin[0] + (index % self.width) as i64 * step,
            origin[1] + (index / self.width) as i64 * step,
        ];
        let [a, b, c] = p.map(|p| [p.x, p.y]);
        let weights = [area(b, c, at), area(c, a, at), area(a, b, at)];
        let weights = [0, 1, 2].map(|k| weights[k] as f32 * p[k].weight);
        let sum: f32 = weights.iter().sum();
        let mut normal = [0.0; 3];
        let mut around = Around::default();
        let mut value = 0.0;
        for k in 0..3 {
            let w = weights[k] / sum;
            normal = along(normal, w, scene.normals[corners[k]]);
            around.sky += w * lights.around[corners[k]].sky;
            around.ground += w * lights.around[corners[k]].ground;
            value += w * scene.values[corners[k]];
        }
        self.normals[index] = unit(normal);
        self.around[index] = around;
        self.values[index] = value;
    }

    /// If a line of sight leaves the closed part once more than it enters, it must have entered through a section. The space that the
    /// sections leave is convex, so it entered through the last section that it meets, and nothing is in front of that.
    fn cut_open(&mut self, scene: &Scene, camera: &Camera, index: usize) -> bool {
        let [x, y] = self.place(index);
        let [from, ray] = camera.sight(x, y);
        let entered = scene.sections.iter().filter_map(|(normal, at)| {
            let towards = -dot(*normal, ray);
            (towards > 0.0).then(|| ((dot(*normal, from) - at) / towards, *normal))
        });
        let last = entered.fold(None, |last: Option<(f32, Vector)>, next| match last {
            Some(last) if last.0 >= next.0 => Some(last),
            _ => Some(next),
        });
        let Some((distance, normal)) = last.filter(|(distance, _)| *distance > 0.0) else {
            return false;
        };
        let seen = self.triangles[index];
        if seen != EMPTY && seen >= scene.tool && self.near[index] > camera.near(distance) {
            return false;
        }
        self.triangles[index] = CUT_OPEN;
        self.near[index] = camera.near(distance);
        self.normals[index] = normal;
        self.inside[index] = true;
        self.around[index] = Around {
            sky: 0.5 + 0.5 * normal[2],
            ground: 0.5 - 0.5 * normal[2],
        };
        true
    }

    /// The position of a sample in the image, from −1 to 1 to the right and up.
    fn place(&self, index: usize) -> [f32; 2] {
        let rim = (RIM * SAMPLES) as f32;
        let across = [
            (index % self.width) as f32 - rim,
            (self.top * SAMPLES) as f32 + (index / self.width) as f32 - rim,
        ];
        let [x, y] = [0, 1].map(|k| (across[k] + 0.5) / (self.size[k] * SAMPLES) as f32 * 2.0 - 1.0);
        [x, -y]
    }

    /// Colours the pixels of the band's rows.
    pub(crate) fn paint(&self, scene: &Scene, camera: &Camera, lights: &Lights, rows: &mut [u8]) {
        let place = |pixel: f32, k: usize| 2.0 * pixel / self.size[k] as f32 - 1.0;
        for (row, pixels) in rows.chunks_mut(3 * self.size[0]).enumerate() {
            let mut spots = Vec::new();
            for (column, pixel) in pixels.chunks_mut(3).enumerate() {
                let (x, y) = (column as f32 + 0.5, (self.top + row) as f32 + 0.5);
                let behind = || shade::background(camera, lights, scene.ground, place(x, 0), -place(y, 1));
                let colour = if self.normals.is_empty() {
                    behind()
                } else {
                    self.pixel(scene, camera, lights, [column, row], &mut spots, behind)
                };
                for k in 0..3 {
                    // A fixed dither pattern keeps visible steps out of the background.
                    pixel[k] = shade::srgb(colour[k], pattern(column, self.top + row));
                }
            }
        }
    }

    /// The mean colour of a pixel's samples.
    fn pixel(
        &self,
        scene: &Scene,
        camera: &Camera,
        lights: &Lights,
        at: [usize; 2],
        spots: &mut Vec<(Spot, f32, f32, usize)>,
        behind: impl Fn() -> Vector,
    ) -> Vector {
        let mut free = 0_usize;
        for sample in 0..SAMPLES * SAMPLES {
            let column = (at[0] + RIM) * SAMPLES + sample % SAMPLES;
            let row = (at[1] + RIM) * SAMPLES + sample / SAMPLES;
            let index = row * self.width + column;
            if self.triangles[index] == EMPTY {
                free += 1;
                continue;
            }
            let near = self.near[index];
            let (normal, around, value) = (self.normals[index], self.around[index], self.values[index]);
            let is_tool = self.triangles[index] >= scene.tool;
            let matter = match (self.inside[index], is_tool, scene.valued) {
                (true, ..) => Matter::Section,
                (_, true, _) => Matter::Tool,
                (_, _, true) => Matter::Value,
                (_, _, false) => Matter::Metal,
            };
            let line = self.line(camera, index);
            let [x, y] = self.place(index);
            let [from, ray] = camera.sight(x, y);
            let place = along(from, camera.distance(near), ray);
            let alike = spots.iter_mut().find(|(spot, first, _, count)| {
                (near - first).abs() < 0.01 * near
                    && dot(spot.normal, normal) > 0.9 * *count as f32
                    && spot.matter == matter
                    && spot.value.is_nan() == value.is_nan()
            });
            if let Some((spot, _, lines, count)) = alike {
                spot.at = add(spot.at, place);
                spot.normal = add(spot.normal, normal);
                spot.around.sky += around.sky;
                spot.around.ground += around.ground;
                spot.value += value;
                *lines += line;
                *count += 1;
            } else {
                let spot = Spot {
                    at: place,
                    normal,
                    around,
                    value,
                    matter,
                };
                spots.push((spot, near, line, 1));
            }
        }
        let part = 1.0 / (SAMPLES * SAMPLES) as f32;
        let mut colour = if free > 0 {
            scale(behind(), free as f32 * part)
        } else {
            [0.0; 3]
        };
        for (mut spot, _, lines, count) in spots.drain(..) {
            let mean = 1.0 / count as f32;
            spot.at = scale(spot.at, mean);
            spot.around.sky *= mean;
            spot.around.ground *= mean;
            spot.value *= mean;
            let lit = shade::shade(camera, lights, &spot);
            let lined = mix(lit, scale(lit, 0.45), lines * mean);
            colour = along(colour, count as f32 * part, lined);
        }
        colour
    }

    /// How strongly an edge is drawn at a sample: where the depth or the normal jumps.
    fn line(&self, camera: &Camera, index: usize) -> f32 {
        let centre = self.near[index];
        let mut line = 0.0_f32;
        for step in [2, 2 * self.width] {
            let (Some(before), after) = (index.checked_sub(step), index + step) else {
                continue;
            };
            if after >= self.near.len() {
                continue;
            }
            if self.triangles[before] == EMPTY || self.triangles[after] == EMPTY {
                line = line.max(0.7);
                continue;
            }
            // Depth is linear across the image of a plane.
            let bend = (self.near[before] + self.near[after] - 2.0 * centre).abs();
            let bend = camera.difference(centre, bend);
            if bend > 0.012 {
                line = line.max(0.8 * smooth_step(0.012, 0.05, bend));
            }
            let turn = 1.0 - dot(self.normals[before], self.normals[after]);
            if turn > 0.12 {
                line = line.max(0.30 * smooth_step(0.12, 0.6, turn));
            }
        }
        line
    }
}

/// Dither noise from −0.5 to 0.5.
fn pattern(column: usize, row: usize) -> f32 {
    // Jimenez's interleaved gradient noise.
    let inner = 0.067_110_56 * (column % 4096) as f32 + 0.005_837_15 * (row % 4096) as f32;
    (52.982_918 * inner.fract()).fract() - 0.5
}
