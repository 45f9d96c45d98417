//! Depth maps: how far light from distant sources gets.

use crate::base::columns;
use crate::base::steps::Steps;
use crate::base::vector::{Vector, cross, dot, unit};
use crate::scene::Scene;
use rayon::prelude::*;

/// Texels across a tile of a depth map.
const TILE: usize = 16;
/// Maps that are looked up together.
const LANES: usize = 8;
/// In rows of triangles over more texels than this it pays to look for those that are inside.
const NARROW: usize = 16;

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
        let maps: Option<Vec<DepthMap>> = directions
            .par_iter()
            .map(|direction| steps.step(|| DepthMap::new(scene, *direction, texels)))
            .collect();
        let maps = maps?;
        let lanes = maps.chunks(LANES).map(|maps| {
            let mut lanes = [[[0.0; LANES]; 3]; 3];
            for (lane, map) in maps.iter().enumerate() {
                for (row, axis) in map.axes.iter().enumerate() {
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

    /// The light that reaches a point: from above and from below the horizon, each the sum over its directions of the weight times the
    /// share that gets through. Directions whose weight is not positive count nothing.
    pub fn reaching(&self, p: Vector, bias: f32, weight: impl Fn(Vector) -> f32) -> [f32; 2] {
        let mut light = [0.0; 2];
        for (axes, maps) in self.lanes.iter().zip(self.maps.chunks(LANES)) {
            let [right, up, towards] = [0, 1, 2].map(|row| {
                let [a, b, c]: &[[f32; LANES]; 3] = &axes[row];
                let mut dots = [0.0; LANES];
                for lane in 0..LANES {
                    dots[lane] = p[0] * a[lane] + p[1] * b[lane] + p[2] * c[lane];
                }
                dots
            });
            for (lane, map) in maps.iter().enumerate() {
                let direction = map.axes[2];
                let weight = weight(direction);
                if weight > 0.0 {
                    let place = map.place([right[lane], up[lane], towards[lane]]);
                    light[usize::from(direction[2] <= 0.0)] += weight * map.share(place, bias);
                }
            }
        }
        light
    }
}

/// Distances from a distant light to the nearest surface.
struct DepthMap {
    /// Right, up, and towards the light.
    axes: [Vector; 3],
    texels: usize,
    depth: Vec<f32>,
    /// Tiles in a row.
    tiles: usize,
    /// The least and the greatest depth of the texels of a tile, with the next row and column.
    ranges: Vec<[f32; 2]>,
}

impl DepthMap {
    fn new(scene: &Scene, direction: Vector, texels: usize) -> Self {
        let other = if direction[2].abs() < 0.9 {
            [0.0, 0.0, 1.0]
        } else {
            [1.0, 0.0, 0.0]
        };
        let right = unit(cross(other, direction));
        let mut map = Self {
            axes: [right, cross(direction, right), direction],
            texels,
            depth: vec![f32::INFINITY; texels * texels],
            tiles: texels.div_ceil(TILE),
            ranges: Vec::new(),
        };
        let place = |p: &Vector| map.place(map.axes.map(|axis| dot(*p, axis)));
        let points: Vec<Vector> = scene.positions.iter().map(place).collect();
        for t in &scene.triangles {
            // Light that enters through a section reaches the back of the face behind it.
            map.draw(t.map(|v| points[v as usize]), !scene.sections.is_empty());
        }
        map.ranges = (0..map.tiles * map.tiles).map(|tile| map.range(tile)).collect();
        map
    }

    /// Column and row (texel centres are whole numbers), and depth, which grows away from the light, of a point given in the map's
    /// axes.
    fn place(&self, [right, up, towards]: Vector) -> Vector {
        let half = 0.5 * self.texels as f32;
        [
            half + right * half * 0.99 - 0.5,
            half + up * half * 0.99 - 0.5,
            -towards,
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
        let last = self.texels - 1;
        let range = |k: usize| {
            let (low, high) = (a[k].min(b[k]).min(c[k]), a[k].max(b[k]).max(c[k]));
            // Casts round towards 0 and saturate.
            let from = low as usize;
            let from = from + usize::from((from as f32) < low);
            (from, (high as usize).min(last), high >= 0.0)
        };
        let ((left, right, seen), (top, bottom, also)) = (range(0), range(1));
        if left > right || top > bottom || !seen || !also {
            return;
        }
        if left == right && top == bottom {
            // Several such triangles may share a texel: the furthest corner casts no shadow on its neighbours.
            let (x, y) = (left as f32, top as f32);
            let inside = |p: Vector, q: Vector| (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]) >= 0.0;
            if inside(a, b) && inside(b, c) && inside(c, a) {
                let texel = &mut self.depth[top * self.texels + left];
                *texel = texel.min(a[2].max(b[2]).max(c[2]));
            }
            return;
        }
        let scale = 1.0 / area;
        // Weights of b and c grow like this with column and row.
        let (bx, by) = ((c[1] - a[1]) * scale, -(c[0] - a[0]) * scale);
        let (cx, cy) = (-(b[1] - a[1]) * scale, (b[0] - a[0]) * scale);
        for row in top..=bottom {
            let y = row as f32 - a[1];
            let (mut from, mut to) = (left, right);
            if right - left > NARROW {
                // In exact numbers, with more than the rounding errors of what is computed below.
                let [bx, by, cx, cy] = [bx, by, cx, cy].map(f64::from);
                let widest = (left as f32 - a[0]).abs().max((right as f32 - a[0]).abs());
                let error = |slope: f64, other: f64| {
                    8.0 * f64::from(f32::EPSILON) * ((slope * f64::from(widest)).abs() + (other * f64::from(y)).abs())
                };
                let [in_b, in_c] = [(bx, by), (cx, cy)].map(|(slope, other)| {
                    let value = other * f64::from(y) - slope * f64::from(a[0]);
                    (value, slope, error(slope, other))
                });
                let both = (1.0001 - in_b.0 - in_c.0, -in_b.1 - in_c.1, in_b.2 + in_c.2 + 1e-6);
                let mut range = [left as f64, right as f64];
                for (value, slope, error) in [(in_b.0 + 1e-4, in_b.1, in_b.2), (in_c.0 + 1e-4, in_c.1, in_c.2), both] {
                    range = columns::narrowed(range, value + error, slope);
                }
                if range[0] > range[1] {
                    continue;
                }
                [from, to] = range.map(|column| column as usize);
            }
            for column in from..=to {
                let x = column as f32 - a[0];
                let (wb, wc) = (bx * x + by * y, cx * x + cy * y);
                if wb >= -1e-4 && wc >= -1e-4 && wb + wc <= 1.0001 {
                    let z = a[2] + wb * (b[2] - a[2]) + wc * (c[2] - a[2]);
                    let texel = &mut self.depth[row * self.texels + column];
                    *texel = texel.min(z);
                }
            }
        }
    }

    fn range(&self, tile: usize) -> [f32; 2] {
        let span = |first: usize| first * TILE..((first + 1) * TILE + 1).min(self.texels);
        let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
        for row in span(tile / self.tiles) {
            for depth in &self.depth[row * self.texels..][span(tile % self.tiles)] {
                low = low.min(*depth);
                high = high.max(*depth);
            }
        }
        [low, high]
    }

    /// The share of light that reaches a place, interpolated between four texels.
    fn share(&self, [x, y, z]: Vector, bias: f32) -> f32 {
        let last = self.texels as f32 - 2.0;
        if !(x >= 0.0 && y >= 0.0 && x <= last && y <= last) {
            return 1.0;
        }
        let (column, row) = (x as usize, y as usize);
        let z = z - bias;
        let [low, high] = self.ranges[row / TILE * self.tiles + column / TILE];
        if z <= low || z > high {
            return f32::from(u8::from(z <= low));
        }
        let first = row * self.texels + column;
        let seen = |index: usize| z <= self.depth[index];
        let corners = [first, first + 1, first + self.texels, first + self.texels + 1].map(seen);
        if corners[1..].iter().all(|corner| *corner == corners[0]) {
            return f32::from(u8::from(corners[0]));
        }
        let [a, b, c, d] = corners.map(|corner| f32::from(u8::from(corner)));
        let (s, t) = (x - column as f32, y - row as f32);
        let (lower, upper) = (a * (1.0 - s) + b * s, c * (1.0 - s) + d * s);
        lower * (1.0 - t) + upper * t
    }
}
