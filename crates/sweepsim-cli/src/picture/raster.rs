//! Which triangle is seen in which pixel.

use rayon::prelude::*;

/// A vertex in the picture: pixels from the left and the top, and a nearness that is linear over the picture (one over the
/// distance for a camera), positive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Projected {
    pub x: f32,
    pub y: f32,
    pub near: f32,
}

impl Projected {
    pub fn moved(self, dx: f32, dy: f32) -> Self {
        Self {
            x: self.x + dx,
            y: self.y + dy,
            ..self
        }
    }
}

/// No triangle.
pub(super) const NONE: u32 = u32::MAX;

/// What is seen.
pub(super) struct Visible {
    pub size: [usize; 2],
    /// Nearness per pixel, 0 where there is nothing.
    pub near: Vec<f32>,
    /// Number of the triangle per pixel.
    pub triangle: Vec<u32>,
}

/// Rows that one task draws.
const BAND: usize = 32;

/// Twice the area of a triangle, signed.
fn area(a: Projected, b: Projected, x: f32, y: f32) -> f32 {
    (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)
}

/// The shares of the three corners in a point of the picture (their sum is 1).
pub(super) fn shares([a, b, c]: [Projected; 3], x: f32, y: f32) -> [f32; 3] {
    let whole = area(a, b, c.x, c.y);
    let (p, q) = (area(b, c, x, y) / whole, area(c, a, x, y) / whole);
    [p, q, 1.0 - p - q]
}

impl Visible {
    pub fn new(places: &[Projected], triangles: &[[u32; 3]], size: [usize; 2]) -> Self {
        let [width, height] = size;
        let mut near = vec![0.0; width * height];
        let mut triangle = vec![NONE; width * height];
        let bands = height.div_ceil(BAND);
        // Which triangles touch which band, in order.
        let mut lists: Vec<Vec<u32>> = vec![Vec::new(); bands];
        for (number, corners) in triangles.iter().enumerate() {
            let ys = corners.map(|k| places[k as usize].y);
            let (lo, hi) = (ys[0].min(ys[1]).min(ys[2]), ys[0].max(ys[1]).max(ys[2]));
            if hi < 0.0 || lo >= height as f32 || !(hi - lo).is_finite() {
                continue;
            }
            let first = lo.max(0.0) as usize / BAND;
            let last = (hi as usize / BAND).min(bands - 1);
            for list in &mut lists[first..=last] {
                list.push(number as u32);
            }
        }
        near.par_chunks_mut(width * BAND)
            .zip(triangle.par_chunks_mut(width * BAND))
            .zip(&lists)
            .enumerate()
            .for_each(|(band, ((near, seen), list))| {
                let top = band * BAND;
                for number in list {
                    let corners = triangles[*number as usize].map(|k| places[k as usize]);
                    draw(corners, *number, width, top, near, seen);
                }
            });
        Self { size, near, triangle }
    }
}

/// Draws a triangle into a band of rows that begins at `top`.
fn draw(corners: [Projected; 3], number: u32, width: usize, top: usize, near: &mut [f32], seen: &mut [u32]) {
    let [a, b, c] = corners;
    let whole = area(a, b, c.x, c.y);
    if whole == 0.0 || !whole.is_finite() {
        return;
    }
    let rows = near.len() / width;
    // Pixel centres are at half numbers.
    let range = |v: [f32; 3], limit: usize| {
        let lo = v[0].min(v[1]).min(v[2]);
        let hi = v[0].max(v[1]).max(v[2]);
        let first = (lo - 0.5).ceil().max(0.0) as usize;
        let last = (hi - 0.5).floor();
        first..if last < 0.0 { 0 } else { (last as usize + 1).min(limit) }
    };
    let columns = range([a.x, b.x, c.x], width);
    let lines = range([a.y, b.y, c.y].map(|y| y - top as f32), rows);
    let inverse = 1.0 / whole;
    for line in lines {
        let y = (top + line) as f32 + 0.5;
        for column in columns.clone() {
            let x = column as f32 + 0.5;
            let p = area(b, c, x, y) * inverse;
            let q = area(c, a, x, y) * inverse;
            let r = area(a, b, x, y) * inverse;
            if p < 0.0 || q < 0.0 || r < 0.0 {
                continue;
            }
            let depth = p * a.near + q * b.near + r * c.near;
            let pixel = line * width + column;
            if depth > near[pixel] {
                near[pixel] = depth;
                seen[pixel] = number;
            }
        }
    }
}
