//! Depth maps: how far light from distant sources gets.

use crate::base::columns;
use crate::base::steps::Steps;
use crate::base::vector::{Vector, cross, dot, unit};
use crate::scene::Scene;
use rayon::prelude::*;
use std::borrow::Cow;
use std::collections::HashMap;

/// Texels across a tile of a depth map.
const TILE: usize = 16;
/// Maps that are looked up together.
const LANES: usize = 8;
/// Steps from a texel to the next, to which corners are rounded: whether a texel is inside a triangle is then decided
/// in whole numbers.
const STEP: i32 = 256;
/// The largest number of steps: products of differences stay below 2⁶³.
const LIMIT: i32 = 1 << 29;

/// Of more triangles than this for each texel, maps show those of a coarser surface.
const TRIANGLES: usize = 4;

/// Depth maps seen from several directions.
pub(crate) struct DepthMaps {
    maps: Vec<DepthMap>,
    /// The axes of the maps, [`LANES`] maps at a time: right, up and towards the light, each by coordinate.
    lanes: Vec<[[[f32; LANES]; 3]; 3]>,
    texels: usize,
}

impl DepthMaps {
    /// Draws maps of `texels` × `texels`. Directions point towards the light.
    ///
    /// Each is a step; returns `None` if they end before all are drawn.
    pub fn new(scene: &Scene, directions: &[Vector], texels: usize, steps: &Steps<'_>) -> Option<Self> {
        let surface = &Surface::new(scene, texels);
        let maps: Option<Vec<DepthMap>> = directions
            .par_iter()
            .map(|direction| steps.step(|| DepthMap::new(surface, *direction, texels)))
            .collect();
        let maps = maps?;
        let lanes = maps.chunks(LANES).map(|maps| {
            let mut lanes = [[[0.0; LANES]; 3]; 3];
            for (lane, map) in maps.iter().enumerate() {
                for (row, axis) in axes_of(map.direction).iter().enumerate() {
                    for k in 0..3 {
                        lanes[row][k][lane] = axis[k];
                    }
                }
            }
            lanes
        });
        let lanes = lanes.collect();
        Some(Self { maps, lanes, texels })
    }

    /// The width of a texel.
    pub fn texel(&self) -> f32 {
        2.0 / self.texels as f32
    }

    /// The light that reaches a point: from above and from below the horizon, each the sum over its directions of the
    /// weight times the share that gets through. Directions whose weight is not positive count nothing.
    pub fn reaching(&self, p: Vector, bias: f32, weight: impl Fn(Vector) -> f32) -> [f32; 2] {
        let mut light = [0.0; 2];
        for (axes, maps) in self.lanes.iter().zip(self.maps.chunks(LANES)) {
            let places = self.places(axes, p, bias);
            for (map, place) in maps.iter().zip(places) {
                let weight = weight(map.direction);
                if weight > 0.0 {
                    light[usize::from(map.direction[2] <= 0.0)] += weight * map.share(place);
                }
            }
        }
        light
    }

    /// The mean share of light that reaches a point. Where the first eight directions agree that all of it does, or
    /// nothing, the others aren't asked.
    pub fn mean_share(&self, p: Vector, bias: f32) -> f32 {
        let (mut sum, mut count) = (0.0, 0);
        for (axes, maps) in self.lanes.iter().zip(self.maps.chunks(LANES)) {
            let places = self.places(axes, p, bias);
            sum += maps
                .iter()
                .zip(places)
                .map(|(map, place)| map.share(place))
                .sum::<f32>();
            count += maps.len();
            if sum <= 0.0 || sum >= count as f32 {
                break;
            }
        }
        sum / count as f32
    }

    /// Columns, rows, and depths less the bias, of a point in [`LANES`] maps.
    fn places(&self, axes: &[[[f32; LANES]; 3]; 3], p: Vector, bias: f32) -> [Vector; LANES] {
        let [scale, middle] = across(self.texels);
        let [right, up, towards] = [0, 1, 2].map(|row| {
            let [a, b, c]: &[[f32; LANES]; 3] = &axes[row];
            let mut dots = [0.0; LANES];
            for lane in 0..LANES {
                dots[lane] = p[0] * a[lane] + p[1] * b[lane] + p[2] * c[lane];
            }
            dots
        });
        std::array::from_fn(|lane| {
            [
                middle + scale * right[lane],
                middle + scale * up[lane],
                -towards[lane] - bias,
            ]
        })
    }
}

/// What a coordinate across a map is multiplied by, and what is then added, to give the column or row; texel centres
/// are whole numbers.
fn across(texels: usize) -> [f32; 2] {
    let half = 0.5 * texels as f32;
    [0.99 * half, half - 0.5]
}

/// The triangles that maps show.
struct Surface<'a> {
    positions: Cow<'a, [Vector]>,
    triangles: Cow<'a, [[u32; 3]]>,
    /// Whether their backs are seen, too: light that enters through a section reaches the back of the face behind it.
    backs: bool,
}

impl<'a> Surface<'a> {
    /// Those of the scene. Of many more than texels, vertices in one cube as wide as a texel become one, the first of
    /// them: no point moves by more than two texels, which the bias of shadows hides.
    fn new(scene: &'a Scene, texels: usize) -> Self {
        let mut surface = Self {
            positions: Cow::Borrowed(&scene.positions),
            triangles: Cow::Borrowed(&scene.triangles),
            backs: !scene.sections.is_empty(),
        };
        if scene.triangles.len() <= TRIANGLES * texels * texels {
            return surface;
        }
        let mut positions = Vec::new();
        // Only looked up, so its order does not matter.
        let mut known: HashMap<[i32; 3], u32> = HashMap::new();
        let number = |p: &Vector| {
            let cube = p.map(|c| (0.5 * texels as f32 * c).floor() as i32);
            *known.entry(cube).or_insert_with(|| {
                positions.push(*p);
                positions.len() as u32 - 1
            })
        };
        let numbers: Vec<u32> = scene.positions.iter().map(number).collect();
        let triangles = scene.triangles.iter().map(|t| t.map(|v| numbers[v as usize]));
        let triangles = triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect();
        (surface.positions, surface.triangles) = (Cow::Owned(positions), Cow::Owned(triangles));
        surface
    }
}

/// Distances from a distant light to the nearest surface.
struct DepthMap {
    /// Towards the light.
    direction: Vector,
    texels: usize,
    depth: Vec<f32>,
    /// Tiles in a row.
    tiles: usize,
    /// The least and the greatest depth of the texels of a tile, with the next row and column.
    ranges: Vec<[f32; 2]>,
}

/// A vertex as a map sees it.
#[derive(Clone, Copy)]
struct Corner {
    /// Steps from the first texel to the right and up.
    at: [i32; 2],
    /// Away from the light.
    depth: f32,
}

/// Right, up, and towards the light, as seen from it.
fn axes_of(direction: Vector) -> [Vector; 3] {
    let other = if direction[2].abs() < 0.9 {
        [0.0, 0.0, 1.0]
    } else {
        [1.0, 0.0, 0.0]
    };
    let right = unit(cross(other, direction));
    [right, cross(direction, right), direction]
}

/// Twice the area of a triangle, in square steps: positive if it faces the light.
fn area(a: [i32; 2], b: [i32; 2], c: [i32; 2]) -> i64 {
    let by = |p: [i32; 2], k: usize| i64::from(p[k] - a[k]);
    by(b, 0) * by(c, 1) - by(b, 1) * by(c, 0)
}

impl DepthMap {
    fn new(surface: &Surface<'_>, direction: Vector, texels: usize) -> Self {
        let axes = axes_of(direction);
        let mut map = Self {
            direction,
            texels,
            depth: vec![f32::INFINITY; texels * texels],
            tiles: texels.div_ceil(TILE),
            ranges: Vec::new(),
        };
        let [scale, middle] = across(texels);
        let seen = |p: &Vector| {
            let [right, up, towards] = axes.map(|axis| dot(*p, axis));
            // The scene is in the unit ball, so that nothing is cut off; the least and the greatest whole numbers would
            // overflow in differences.
            let steps = |across: f32| ((STEP as f32 * (middle + scale * across)) as i32).clamp(-LIMIT, LIMIT);
            Corner {
                at: [steps(right), steps(up)],
                depth: -towards,
            }
        };
        let corners: Vec<Corner> = surface.positions.iter().map(seen).collect();
        for t in surface.triangles.iter() {
            map.draw(t.map(|v| corners[v as usize]), surface.backs);
        }
        map.ranges = (0..map.tiles).flat_map(|row| map.ranges(row)).collect();
        map
    }

    fn draw(&mut self, [a, mut b, mut c]: [Corner; 3], backs: bool) {
        let mut whole = area(a.at, b.at, c.at);
        if whole < 0 && backs {
            (whole, b, c) = (-whole, c, b);
        }
        // A back face: a front face is nearer to the light.
        if whole <= 0 {
            return;
        }
        let last = self.texels as i32 - 1;
        let range = |k: usize| {
            let low = a.at[k].min(b.at[k]).min(c.at[k]);
            let high = a.at[k].max(b.at[k]).max(c.at[k]);
            (
                (low + STEP - 1).div_euclid(STEP).max(0),
                high.div_euclid(STEP).min(last),
            )
        };
        let ((left, right), (top, bottom)) = (range(0), range(1));
        if left > right || top > bottom {
            return;
        }
        let first = [left * STEP, top * STEP];
        let mut weights = [
            area(b.at, c.at, first),
            area(c.at, a.at, first),
            area(a.at, b.at, first),
        ];
        if left == right && top == bottom {
            // Several such triangles may share a texel: the furthest corner casts no shadow on its neighbours.
            if weights.iter().all(|weight| *weight >= 0) {
                let texel = &mut self.depth[top as usize * self.texels + left as usize];
                *texel = texel.min(a.depth.max(b.depth).max(c.depth));
            }
            return;
        }
        let sides = [[b.at, c.at], [c.at, a.at], [a.at, b.at]];
        // How the weights grow from a column, and from a row, to the next.
        let right_by = sides.map(|[p, q]| i64::from(STEP) * i64::from(p[1] - q[1]));
        let up_by = sides.map(|[p, q]| i64::from(STEP) * i64::from(q[0] - p[0]));
        let scale = 1.0 / whole as f64;
        let slopes = [b, c].map(|corner| scale * f64::from(corner.depth - a.depth));
        let depth = |weights: &[i64; 3]| slopes[0] * weights[1] as f64 + slopes[1] * weights[2] as f64;
        let deeper = depth(&right_by) as f32;
        let count = i64::from(right - left + 1);
        for row in top as usize..=bottom as usize {
            let [from, to] = columns::inside(count, weights, right_by).map(|column| column as usize);
            let start = f64::from(a.depth) + depth(&weights);
            let texels = &mut self.depth[row * self.texels + left as usize..][from..to];
            for (column, texel) in (from as i32..).zip(texels) {
                let depth = start as f32 + deeper * column as f32;
                *texel = if depth < *texel { depth } else { *texel };
            }
            for (weight, by) in weights.iter_mut().zip(up_by) {
                *weight += by;
            }
        }
    }

    /// The ranges of a row of tiles.
    fn ranges(&self, row: usize) -> Vec<[f32; 2]> {
        let span = |tile: usize| tile * TILE..((tile + 1) * TILE + 1).min(self.texels);
        // First of each column, whose rows lie side by side.
        let mut low = vec![f32::INFINITY; self.texels];
        let mut high = vec![f32::NEG_INFINITY; self.texels];
        for row in span(row) {
            let depths = &self.depth[row * self.texels..][..self.texels];
            for ((low, high), depth) in low.iter_mut().zip(&mut high).zip(depths) {
                *low = if depth < low { *depth } else { *low };
                *high = if depth > high { *depth } else { *high };
            }
        }
        let of = |tile: usize| {
            let least = low[span(tile)].iter().fold(f32::INFINITY, |a, b| a.min(*b));
            let most = high[span(tile)].iter().fold(f32::NEG_INFINITY, |a, b| a.max(*b));
            [least, most]
        };
        (0..self.tiles).map(of).collect()
    }

    /// The share of light that reaches a column, row and depth, interpolated between four texels.
    fn share(&self, [x, y, z]: Vector) -> f32 {
        let last = self.texels as f32 - 2.0;
        if !(x >= 0.0 && y >= 0.0 && x <= last && y <= last) {
            return 1.0;
        }
        let (column, row) = (x as i32 as usize, y as i32 as usize);
        let [low, high] = self.ranges[row / TILE * self.tiles + column / TILE];
        if z <= low {
            return 1.0;
        }
        if z > high {
            return 0.0;
        }
        let texels = &self.depth[row * self.texels + column..][..self.texels + 2];
        let seen = |index: usize| z <= texels[index];
        let (a, b, c, d) = (seen(0), seen(1), seen(self.texels), seen(self.texels + 1));
        if a == b && a == c && a == d {
            return f32::from(u8::from(a));
        }
        let [a, b, c, d] = [a, b, c, d].map(|corner| f32::from(u8::from(corner)));
        let (s, t) = (x - column as f32, y - row as f32);
        let (lower, upper) = (a * (1.0 - s) + b * s, c * (1.0 - s) + d * s);
        lower * (1.0 - t) + upper * t
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A relief of hills, of `n` × `n` squares.
    fn hills(n: u32) -> Scene {
        let place = |k: u32| 1.2 * (k as f32 / n as f32 - 0.5);
        let corner = |k: u32| (place(k % (n + 1)), place(k / (n + 1)));
        let height = |(x, y): (f32, f32)| [x, y, 0.1 * (7.0 * x).sin() * (5.0 * y).cos()];
        let square = |k: u32| {
            let a = k / n * (n + 1) + k % n;
            [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
        };
        Scene {
            positions: (0..(n + 1) * (n + 1)).map(|k| height(corner(k))).collect(),
            triangles: (0..n * n).flat_map(square).collect(),
            ..Scene::default()
        }
    }

    #[test]
    fn maps_of_many_triangles_show_a_coarser_surface_within_two_texels() {
        let (scene, texels) = (hills(200), 50);
        let coarse = Surface::new(&scene, texels);
        assert!(
            8 * coarse.triangles.len() < scene.triangles.len(),
            "{}",
            coarse.triangles.len()
        );
        let whole = Surface {
            positions: Cow::Borrowed(&scene.positions),
            triangles: Cow::Borrowed(&scene.triangles),
            backs: false,
        };
        for direction in [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [-0.48, 0.36, 0.8]] {
            let [a, b] = [&whole, &coarse].map(|surface| DepthMap::new(surface, direction, texels));
            let both: Vec<(f32, f32)> = a
                .depth
                .into_iter()
                .zip(b.depth)
                .filter(|(a, b)| a.is_finite() && b.is_finite())
                .collect();
            assert!(both.len() > texels * texels / 5);
            let most = both.iter().map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(most <= 2.0 * 2.0 / texels as f32, "{most}");
        }
        // Of few triangles, all are shown.
        assert_eq!(Surface::new(&scene, 200).triangles.len(), scene.triangles.len());
    }
}
