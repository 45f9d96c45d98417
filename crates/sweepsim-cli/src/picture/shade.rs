//! From what is seen to colours.

use super::camera::{Camera, Light};
use super::raster::{NONE, Projected, Visible, shares};
use super::vector::{V, add, cross, dot, mix, scale, smoothstep, sub, times, unit};
use sweepsim_dexel::Mesh;

/// What a tool has cut: warm metal. All colours are linear.
const CUT: V = [0.66, 0.335, 0.12];
/// What is left of the stock's own surface: cool and darker.
const STOCK: V = [0.20, 0.255, 0.33];
const KEY: V = [1.75, 1.66, 1.54];
const FILL: V = [0.22, 0.27, 0.36];
const SKY: V = [0.46, 0.52, 0.62];
const GROUND: V = [0.20, 0.18, 0.17];
/// The background at its top and at its bottom.
const ABOVE: V = [0.80, 0.84, 0.89];
const BELOW: V = [0.94, 0.95, 0.96];

/// A mesh in units of its size about its middle, in the numbers that pictures are made of.
pub(super) struct Surface {
    pub places: Vec<V>,
    normals: Vec<V>,
    cut: Vec<f32>,
    pub triangles: Vec<[u32; 3]>,
    /// Half the sides of the box around it: the longest is 1.
    pub half: V,
}

/// A point of a surface.
pub(super) struct Point {
    pub place: V,
    pub normal: V,
    /// Normal of the triangle.
    pub flat: V,
    pub cut: f32,
}

impl Surface {
    pub fn new(mesh: &Mesh) -> Self {
        let count = mesh.vertices.len();
        let good = |triangle: &&[u32; 3]| {
            triangle
                .iter()
                .all(|k| (*k as usize) < count && mesh.vertices[*k as usize].iter().all(|c| c.is_finite()))
        };
        let triangles: Vec<[u32; 3]> = mesh.triangles.iter().filter(good).copied().collect();
        let (mut lo, mut hi) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for k in triangles.iter().flatten() {
            let place = mesh.vertices[*k as usize];
            for a in 0..3 {
                lo[a] = lo[a].min(place[a]);
                hi[a] = hi[a].max(place[a]);
            }
        }
        if triangles.is_empty() {
            (lo, hi) = ([-1.0; 3], [1.0; 3]);
        }
        let middle = [0, 1, 2].map(|a| 0.5 * lo[a] + 0.5 * hi[a]);
        let size = (0..3).map(|a| 0.5 * (hi[a] - lo[a])).fold(f64::MIN_POSITIVE, f64::max);
        let place = |p: &[f64; 3]| [0, 1, 2].map(|a| ((p[a] - middle[a]) / size) as f32);
        Self {
            places: mesh.vertices.iter().map(place).collect(),
            normals: (0..count)
                .map(|k| mesh.normals.get(k).copied().unwrap_or_default())
                .collect(),
            cut: (0..count)
                .map(|k| f32::from(mesh.cut.get(k).copied().unwrap_or(true)))
                .collect(),
            triangles,
            half: [0, 1, 2].map(|a| (0.5 * (hi[a] - lo[a]) / size) as f32),
        }
    }

    /// The places that triangles use, some of them several times.
    pub fn seen(&self) -> impl Iterator<Item = V> {
        self.triangles.iter().flatten().map(|k| self.places[*k as usize])
    }

    /// The point of a triangle that a camera sees at a place of the picture.
    pub fn point(&self, triangle: u32, projected: &[Projected], x: f32, y: f32) -> Point {
        let corners = self.triangles[triangle as usize].map(|k| k as usize);
        let seen = corners.map(|k| projected[k]);
        let flat = shares(seen, x, y);
        // What is linear over the picture is not so over the triangle.
        let part = [0, 1, 2].map(|k| flat[k] * seen[k].near);
        let sum: f32 = part.iter().sum();
        let mean = |values: &[V]| {
            let [a, b, c] = corners.map(|k| values[k]);
            scale(
                add(add(scale(a, part[0]), scale(b, part[1])), scale(c, part[2])),
                1.0 / sum,
            )
        };
        let [a, b, c] = corners.map(|k| self.places[k]);
        Point {
            place: mean(&self.places),
            normal: unit(mean(&self.normals)),
            flat: unit(cross(sub(b, a), sub(c, a))),
            cut: (0..3).map(|k| self.cut[corners[k]] * part[k]).sum::<f32>() / sum,
        }
    }
}

/// All that the colour of a pixel depends on.
pub(super) struct Scene<'a> {
    pub mesh: &'a Surface,
    pub camera: &'a Camera,
    pub light: &'a Light,
    pub shadows: &'a Visible,
    pub openness: &'a [f32],
    /// How dark the floor is below and beside the part.
    pub contact: &'a Contact,
    pub size: [usize; 2],
}

impl Scene<'_> {
    /// The linear colour of a pixel, for the sample at the given place in it.
    pub fn colour(&self, visible: &Visible, projected: &[Projected], pixel: usize, sample: [f32; 2]) -> V {
        let [width, height] = self.size;
        let (x, y) = ((pixel % width) as f32 + 0.5, (pixel / width) as f32 + 0.5);
        let number = visible.triangle[pixel];
        if number == NONE {
            return self.background(x + sample[0], y + sample[1], height as f32);
        }
        let point = self.mesh.point(number, projected, x, y);
        let view = self.camera.towards(point.place);
        let normal = if dot(point.normal, point.normal) > 0.25 {
            point.normal
        } else {
            point.flat
        };
        let normal = if dot(normal, view) < 0.0 && dot(point.flat, view) < 0.0 {
            scale(normal, -1.0)
        } else {
            normal
        };
        let open = self.openness[pixel] * self.line(visible, pixel);
        let albedo = mix(STOCK, CUT, smoothstep(0.2, 0.8, point.cut));
        let sun = self.light.direction;
        let facing = dot(normal, sun).max(0.0);
        let lit = if facing > 0.0 {
            self.lit(point.place, point.flat, 1.6)
        } else {
            0.0
        };
        // A weak light from the other side, without shadow.
        let [right, up, back] = self.camera.axes();
        let second = unit(add(add(scale(right, 0.8), scale(up, 0.25)), scale(back, 0.4)));
        let ambient = mix(GROUND, SKY, 0.5 + 0.5 * normal[2]);
        let mut light = scale(KEY, 0.72 * facing * lit);
        light = add(light, scale(FILL, dot(normal, second).max(0.0) * open));
        light = add(light, scale(ambient, 0.62 * open));
        let mut colour = times(albedo, light);
        // Machined metal shines a little; more at a glancing view.
        let half = unit(add(sun, view));
        let glance = (1.0 - dot(normal, view).clamp(0.0, 1.0)).powi(5);
        let shine = dot(normal, half).max(0.0).powi(36) * facing.sqrt() * lit;
        let tint = mix([1.0; 3], albedo, 0.35);
        colour = add(colour, scale(times(KEY, tint), (0.16 + 0.5 * glance) * shine));
        colour = add(colour, scale(SKY, 0.10 * glance * open));
        filmic(colour)
    }

    /// How much of the light reaches a place, from 0 to 1; `spread` widens the soft border.
    fn lit(&self, place: V, normal: V, spread: f32) -> f32 {
        const TAPS: isize = 2;
        let [width, height] = self.shadows.size;
        let at = self.light.project(add(place, scale(normal, 0.006)));
        let tap = |dx: isize, dy: isize| {
            let (x, y) = (at.x + spread * dx as f32, at.y + spread * dy as f32);
            if x < 0.0 || y < 0.0 || x >= width as f32 || y >= height as f32 {
                return 1.0;
            }
            let near = self.shadows.near[y as usize * width + x as usize];
            // A soft comparison hides the steps of the map.
            1.0 - smoothstep(0.004, 0.010, near - at.near)
        };
        // Far from the border of a shadow the corners tell.
        let corners = tap(-TAPS, -TAPS) + tap(TAPS, -TAPS) + tap(-TAPS, TAPS) + tap(TAPS, TAPS) + tap(0, 0);
        if corners == 0.0 || corners == 5.0 {
            return corners / 5.0;
        }
        let (mut open, mut count) = (0.0, 0.0);
        for dy in -TAPS..=TAPS {
            for dx in -TAPS..=TAPS {
                open += tap(dx, dy);
                count += 1.0;
            }
        }
        open / count
    }

    /// Darkens outlines and steps: less than 1 where a neighbour is much farther away than the surface's slope explains.
    fn line(&self, visible: &Visible, pixel: usize) -> f32 {
        let [width, height] = self.size;
        let (x, y) = (pixel % width, pixel / width);
        if x == 0 || y == 0 || x + 1 == width || y + 1 == height {
            return 1.0;
        }
        let near = |pixel: usize| visible.near[pixel];
        let here = near(pixel);
        let bend = |a: usize, b: usize| (2.0 * here - near(a) - near(b)) / here;
        let most = bend(pixel - 1, pixel + 1).max(bend(pixel - width, pixel + width));
        1.0 - 0.45 * smoothstep(0.004, 0.02, most)
    }

    /// A bright room, with the part's shadow on its floor.
    fn background(&self, x: f32, y: f32, height: f32) -> V {
        let wall = mix(ABOVE, BELOW, smoothstep(0.0, 1.0, y / height));
        let floor = -self.mesh.half[2] - 0.002;
        let Some(place) = self.camera.floor(x, y, floor) else {
            return wall;
        };
        let shadow = 1.0 - self.lit(place, [0.0, 0.0, 1.0], 6.0);
        scale(wall, 1.0 - 0.30 * shadow - 0.34 * self.contact.at(place))
    }
}

/// The shadow of the whole sky on the floor: the part's outline from above, blurred.
pub(super) struct Contact {
    light: Light,
    dark: Vec<f32>,
}

impl Contact {
    const SIZE: usize = 256;
    /// Half the width of the blur, pixels; it is applied three times.
    const BLUR: isize = 5;

    pub fn new(mesh: &Surface) -> Self {
        let light = Light::overhead(mesh, Self::SIZE);
        let places: Vec<_> = mesh.places.iter().map(|place| light.project(*place)).collect();
        let outline = Visible::new(&places, &mesh.triangles, [Self::SIZE; 2]);
        let mut dark: Vec<f32> = outline.near.iter().map(|near| f32::from(*near > 0.0)).collect();
        for pass in 0..6 {
            let [along, across] = if pass % 2 == 0 {
                [1, Self::SIZE]
            } else {
                [Self::SIZE, 1]
            };
            let mut blurred = vec![0.0; dark.len()];
            for line in 0..Self::SIZE {
                for at in 0..Self::SIZE {
                    let window = (-Self::BLUR..=Self::BLUR)
                        .filter_map(|step| at.checked_add_signed(step))
                        .filter(|there| *there < Self::SIZE);
                    let sum: f32 = window.map(|there| dark[line * across + there * along]).sum();
                    blurred[line * across + at * along] = sum / (2 * Self::BLUR + 1) as f32;
                }
            }
            dark = blurred;
        }
        Self { light, dark }
    }

    fn at(&self, place: V) -> f32 {
        let at = self.light.project(place);
        let cell = |x: usize, y: usize| {
            if x < Self::SIZE && y < Self::SIZE {
                self.dark[y * Self::SIZE + x]
            } else {
                0.0
            }
        };
        let (x, y) = (at.x - 0.5, at.y - 0.5);
        if x < 0.0 || y < 0.0 {
            return 0.0;
        }
        let (i, j, s, t) = (x as usize, y as usize, x.fract(), y.fract());
        let row = |j| cell(i, j) * (1.0 - s) + cell(i + 1, j) * s;
        row(j) * (1.0 - t) + row(j + 1) * t
    }
}

/// Compresses what is brighter than white.
fn filmic(colour: V) -> V {
    colour.map(|c| {
        let c = c.max(0.0);
        (c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14)).min(1.0)
    })
}

/// A linear channel as a byte of sRGB; `grain` from 0 to 1 decides between two bytes, so that slow changes show no steps.
pub(super) fn encode(linear: f32, grain: f32) -> u8 {
    let c = linear.clamp(0.0, 1.0);
    let coded = if c <= 0.003_130_8 {
        12.92 * c
    } else {
        1.055 * c.powf(1.0 / 2.4) - 0.055
    };
    (255.0 * coded + grain).min(255.0) as u8
}

/// A fixed pattern without visible order, from 0 to 1: interleaved gradient noise (J. Jimenez, 2014).
pub(super) fn grain(x: usize, y: usize) -> f32 {
    (52.982_918 * (0.067_110_56 * x as f32 + 0.005_837_15 * y as f32).fract()).fract()
}
