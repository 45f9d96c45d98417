//! A band of rows: which triangle each sample sees, and the colours of its pixels.

use crate::base::columns;
use crate::base::vector::{Vector, add, along, dot, mix, scale, smooth_step, unit};
use crate::camera::Camera;
use crate::frame::{BAND, ImagePoint, RIM, SAMPLES, STEP, area};
use crate::light::{Around, Lights};
use crate::scene::Scene;
use crate::shade::{self, Matter, PixelPatch};

/// Marks a sample that sees no triangle.
const EMPTY: u32 = u32::MAX;
/// Marks a sample that sees a section.
const CUT_OPEN: u32 = u32::MAX - 1;

/// A surface at a vertex, or at a sample.
#[derive(Clone, Copy, Default)]
pub(crate) struct Surface {
    pub normal: Vector,
    pub around: Around,
    pub value: f32,
}

/// The samples of a band of rows.
#[derive(Default)]
pub(crate) struct Band {
    size: [usize; 2],
    /// The first row of pixels.
    top: usize,
    /// Samples across, including the rim.
    width: usize,
    triangles: Vec<u32>,
    near: Vec<f32>,
    surface: Vec<Surface>,
    /// The number of times that a line of sight leaves the part, less the number of times that it enters; empty without
    /// sections.
    depth: Vec<i32>,
    /// Whether there is anything to see.
    is_empty: bool,
}

/// Samples of a pixel on the same piece of surface: sums over them.
struct Piece {
    /// The depth of the first.
    first: f32,
    /// Column and row.
    at: [f32; 2],
    near: f32,
    normal: Vector,
    around: Around,
    value: f32,
    line: f32,
    count: f32,
    matter: Matter,
}

impl Piece {
    /// Of no samples yet.
    fn of(first: f32, matter: Matter) -> Self {
        Self {
            first,
            at: [0.0; 2],
            near: 0.0,
            normal: [0.0; 3],
            around: Around::default(),
            value: 0.0,
            line: 0.0,
            count: 0.0,
            matter,
        }
    }
}

impl Band {
    /// Looks at the triangles of a list, from the row `top` on. The memory of another band serves again.
    pub(crate) fn look(
        &mut self,
        scene: &Scene,
        camera: &Camera,
        points: &[ImagePoint],
        size: [usize; 2],
        top: usize,
        list: &[u32],
    ) {
        (self.size, self.top, self.is_empty) = (size, top, list.is_empty());
        if list.is_empty() {
            return;
        }
        self.width = (size[0] + 2 * RIM) * SAMPLES;
        let height = (BAND + 2 * RIM) * SAMPLES;
        let count = self.width * height;
        let is_cut = !scene.sections.is_empty();
        refill(&mut self.triangles, count, EMPTY);
        refill(&mut self.near, count, 0.0);
        refill(&mut self.depth, if is_cut { count } else { 0 }, 0);
        // Only looked at where a sample sees something.
        self.surface.resize(count, Surface::default());
        for number in list {
            let corners = scene.triangles[*number as usize].map(|v| &points[v as usize]);
            self.draw(*number, corners, *number >= scene.tool);
        }
        for row in 0..height {
            for column in 0..self.width {
                let at = [column, row];
                let index = self.index(at);
                if is_cut && self.depth[index] > 0 && self.cut_open(scene, camera, at) {
                    continue;
                }
                if self.triangles[index] != EMPTY {
                    self.surface[index] = self.look_up(scene, points, at);
                }
            }
        }
    }

    fn index(&self, [column, row]: [usize; 2]) -> usize {
        row * self.width + column
    }

    /// Steps from the image's first sample to the band's.
    fn origin(&self) -> [i64; 2] {
        let rim = (RIM * SAMPLES) as i64;
        [-rim, (self.top * SAMPLES) as i64 - rim].map(|n| n * STEP as i64)
    }

    /// Sections do not cut a tool.
    fn draw(&mut self, number: u32, mut points: [&ImagePoint; 3], is_tool: bool) {
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
    fn look_up(&self, scene: &Scene, points: &[ImagePoint], at: [usize; 2]) -> Surface {
        let number = self.triangles[self.index(at)];
        let corners = scene.triangles[number as usize].map(|v| &points[v as usize]);
        let origin = self.origin();
        let at = [0, 1].map(|k| origin[k] + at[k] as i64 * STEP as i64);
        let [a, b, c] = corners.map(|p| [p.x, p.y]);
        let weights = [area(b, c, at), area(c, a, at), area(a, b, at)];
        let weights = [0, 1, 2].map(|k| weights[k] as f32 * corners[k].weight);
        let share = 1.0 / weights.iter().sum::<f32>();
        let mut surface = Surface::default();
        for (weight, corner) in weights.iter().zip(corners) {
            let (w, of) = (weight * share, &corner.surface);
            surface.normal = along(surface.normal, w, of.normal);
            surface.around.sky += w * of.around.sky;
            surface.around.ground += w * of.around.ground;
            surface.value += w * of.value;
        }
        surface.normal = unit(surface.normal);
        surface
    }

    /// If a line of sight leaves the closed part once more than it enters, it must have entered through a section. The
    /// space that the sections leave is convex, so it entered through the last section that it meets, and nothing is in
    /// front of that.
    fn cut_open(&mut self, scene: &Scene, camera: &Camera, at: [usize; 2]) -> bool {
        let index = self.index(at);
        let [x, y] = self.place(at.map(|n| n as f32));
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
        self.surface[index] = Surface {
            normal,
            around: Around {
                sky: 0.5 + 0.5 * normal[2],
                ground: 0.5 - 0.5 * normal[2],
            },
            value: 0.0,
        };
        true
    }

    /// The position of a sample in the image, from −1 to 1 to the right and up.
    fn place(&self, [column, row]: [f32; 2]) -> [f32; 2] {
        let rim = (RIM * SAMPLES) as f32;
        let across = [column - rim, (self.top * SAMPLES) as f32 + row - rim];
        let [x, y] = [0, 1].map(|k| (across[k] + 0.5) / (self.size[k] * SAMPLES) as f32 * 2.0 - 1.0);
        [x, -y]
    }

    /// Colours the pixels of the band's rows.
    pub(crate) fn paint(&self, scene: &Scene, camera: &Camera, lights: &Lights, rows: &mut [u8]) {
        let place = |pixel: f32, k: usize| 2.0 * pixel / self.size[k] as f32 - 1.0;
        for (row, pixels) in rows.chunks_mut(3 * self.size[0]).enumerate() {
            let mut pieces = Vec::new();
            for (column, pixel) in pixels.chunks_mut(3).enumerate() {
                let (x, y) = (column as f32 + 0.5, (self.top + row) as f32 + 0.5);
                let behind = || shade::background(camera, lights, scene.ground, place(x, 0), -place(y, 1));
                let colour = if self.is_empty {
                    behind()
                } else {
                    self.pixel(scene, camera, lights, [column, row], &mut pieces, behind)
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
        pieces: &mut Vec<Piece>,
        behind: impl Fn() -> Vector,
    ) -> Vector {
        let mut free = 0_usize;
        for sample in 0..SAMPLES * SAMPLES {
            let column = (at[0] + RIM) * SAMPLES + sample % SAMPLES;
            let row = (at[1] + RIM) * SAMPLES + sample / SAMPLES;
            let index = self.index([column, row]);
            if self.triangles[index] == EMPTY {
                free += 1;
                continue;
            }
            let near = self.near[index];
            let Surface { normal, around, value } = self.surface[index];
            let matter = match self.triangles[index] {
                CUT_OPEN => Matter::Section,
                number if number >= scene.tool => Matter::Tool,
                _ if scene.valued => Matter::Value,
                _ => Matter::Metal,
            };
            let alike = pieces.iter().position(|piece| {
                (near - piece.first).abs() < 0.01 * near
                    && dot(piece.normal, normal) > 0.9 * piece.count
                    && piece.matter == matter
                    && piece.value.is_nan() == value.is_nan()
            });
            let number = alike.unwrap_or_else(|| {
                pieces.push(Piece::of(near, matter));
                pieces.len() - 1
            });
            let piece = &mut pieces[number];
            piece.at = [piece.at[0] + column as f32, piece.at[1] + row as f32];
            piece.near += near;
            piece.normal = add(piece.normal, normal);
            piece.around.sky += around.sky;
            piece.around.ground += around.ground;
            piece.value += value;
            piece.line += self.line(camera, index);
            piece.count += 1.0;
        }
        let part = 1.0 / (SAMPLES * SAMPLES) as f32;
        let mut colour = if free > 0 {
            scale(behind(), free as f32 * part)
        } else {
            [0.0; 3]
        };
        for piece in pieces.drain(..) {
            let mean = 1.0 / piece.count;
            // Depth is linear across the image of a plane, so that the mean is on it.
            let [x, y] = self.place(piece.at.map(|c| c * mean));
            let [from, ray] = camera.sight(x, y);
            let patch = PixelPatch {
                at: along(from, camera.distance(piece.near * mean), ray),
                normal: piece.normal,
                around: Around {
                    sky: piece.around.sky * mean,
                    ground: piece.around.ground * mean,
                },
                value: piece.value * mean,
                matter: piece.matter,
            };
            let lit = shade::shade(camera, lights, &patch);
            let lined = mix(lit, scale(lit, 0.45), piece.line * mean);
            colour = along(colour, piece.count * part, lined);
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
            let turn = 1.0 - dot(self.surface[before].normal, self.surface[after].normal);
            if turn > 0.12 {
                line = line.max(0.30 * smooth_step(0.12, 0.6, turn));
            }
        }
        line
    }
}

/// Makes every element the same.
fn refill<T: Copy>(list: &mut Vec<T>, count: usize, value: T) {
    list.clear();
    list.resize(count, value);
}

/// Dither noise from −0.5 to 0.5.
fn pattern(column: usize, row: usize) -> f32 {
    // Jimenez's interleaved gradient noise.
    let inner = 0.067_110_56 * (column % 4096) as f32 + 0.005_837_15 * (row % 4096) as f32;
    (52.982_918 * inner.fract()).fract() - 0.5
}
