//! All points near a triangle surface.

use super::TriangleSoup;
use crate::dexels::{Dexels, Operation};
use crate::grid::Grid;
use crate::intervals::Interval;
use crate::vector::{cross, dot, normal_of, sub};
use rayon::prelude::*;

/// The part of a line `p + z e` with `⟨n, p + z e⟩ ≤ limit`, within `range`.
fn half_space(range: Option<[f64; 2]>, n: [f64; 3], p: [f64; 3], limit: f64) -> Option<[f64; 2]> {
    let [low, high] = range?;
    let (rest, slope) = (limit - dot(n, p), n[2]);
    let range = if slope == 0.0 {
        if rest < 0.0 {
            return None;
        }
        [low, high]
    } else if slope > 0.0 {
        [low, high.min(rest / slope)]
    } else {
        [low.max(rest / slope), high]
    };
    (range[0] <= range[1]).then_some(range)
}

/// The solutions of `a z² + 2 b z + c ≤ 0`, with `a ≥ 0`.
fn parabola(a: f64, b: f64, c: f64) -> Option<[f64; 2]> {
    if a == 0.0 {
        // The line runs along the cylinder.
        return (c <= 0.0).then_some([f64::NEG_INFINITY, f64::INFINITY]);
    }
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return None;
    }
    // The root without cancellation first.
    let sum = -(b + discriminant.sqrt().copysign(b));
    let (far, near) = (sum / a, if sum == 0.0 { 0.0 } else { c / sum });
    Some([far.min(near), far.max(near)])
}

/// Where the vertical line through `(x, y)` is within `d` of a triangle. That set is convex, so it is one interval: the
/// hull of those within `d` of its corners, its edges and its face.
fn near_triangle(corners: &[[f64; 3]; 3], x: f64, y: f64, d: f64) -> Option<[f64; 2]> {
    // Seen from a corner, so that little cancels.
    let origin = corners[0];
    let [a, b, c] = corners.map(|p| sub(p, origin));
    let p = [x - origin[0], y - origin[1], 0.0];
    let whole = Some([f64::NEG_INFINITY, f64::INFINITY]);
    let mut hull: Option<[f64; 2]> = None;
    let mut add = |part: Option<[f64; 2]>| {
        if let Some([low, high]) = part.filter(|part| part[0].is_finite() && part[1].is_finite()) {
            hull = Some(hull.map_or([low, high], |[l, h]| [l.min(low), h.max(high)]));
        }
    };
    let corners = [a, b, c];
    let n = normal_of(corners);
    let length = dot(n, n).sqrt();
    for k in 0..3 {
        let (from, to) = (corners[k], corners[(k + 1) % 3]);
        let q = sub(p, from);
        add(parabola(1.0, q[2], dot(q, q) - d * d));
        // The cylinder about the edge: |q + z e|² less the square of its part along the edge.
        let edge = sub(to, from);
        let size = dot(edge, edge).sqrt();
        if size == 0.0 {
            continue;
        }
        let u = edge.map(|c| c / size);
        let (along, slope) = (dot(q, u), u[2]);
        let round = parabola(
            u[0] * u[0] + u[1] * u[1],
            q[2] - along * slope,
            dot(q, q) - along * along - d * d,
        );
        let range = half_space(round, u, q, size);
        add(half_space(range, u.map(|c| -c), q, 0.0));
    }
    if length > 0.0 {
        let n = n.map(|c| c / length);
        let mut range = half_space(whole, n, p, d);
        range = half_space(range, n.map(|c| -c), p, d);
        for k in 0..3 {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            // Outwards, in the triangle's plane.
            range = half_space(range, cross(sub(to, from), n), sub(p, from), 0.0);
        }
        add(range);
    }
    hull.map(|[low, high]| [low + origin[2], high + origin[2]])
        .filter(|[low, high]| low < high)
}

/// The range of `y` of the part of a triangle whose `x` is in a range; reversed if there is none.
fn within_slab(corners: &[[f64; 3]; 3], slab: [f64; 2]) -> [f64; 2] {
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    let mut add = |y: f64| range = [range[0].min(y), range[1].max(y)];
    for k in 0..3 {
        let (p, q) = (corners[k], corners[(k + 1) % 3]);
        if slab[0] <= p[0] && p[0] <= slab[1] {
            add(p[1]);
        }
        for x in slab {
            if (p[0] < x) != (q[0] < x) {
                // Between the ends, whatever the rounding.
                let s = ((x - p[0]) / (q[0] - p[0])).clamp(0.0, 1.0);
                add(p[1] + s * (q[1] - p[1]));
            }
        }
    }
    range
}

impl TriangleSoup {
    /// All points within `distance` of the surface, on the lines of a grid: exact up to rounding.
    ///
    /// Together with the solid that the triangles enclose it is the solid grown by that distance along its normals; the
    /// solid without it is the solid shrunk by it.
    ///
    /// ```
    /// use sweepsim_dexel::{Grid, TriangleSoup};
    /// let flat = TriangleSoup { triangles: vec![[[0.0; 3], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0]]] };
    /// let grid = Grid::new([1.0, 1.0], [3.0, 3.0], [2, 2])?;
    /// let near = flat.thickened(&grid, 0.5);
    /// assert_eq!(near.intervals(0, 0).heights().next(), Some([-0.5, 0.5]));
    /// # Ok::<(), sweepsim_dexel::GridError>(())
    /// ```
    #[must_use]
    pub fn thickened(&self, grid: &Grid, distance: f64) -> Dexels {
        let mut dexels = Dexels::empty(*grid);
        if !(distance > 0.0 && distance.is_finite()) {
            return dexels;
        }
        let soup = self.seen_from(grid.frame());
        let spacing = grid.spacing();
        // The numbers of the lines within a range of coordinates.
        let numbers = |k: usize, [low, high]: [f64; 2]| {
            let at = |x: f64| (x - grid.min()[k]) / spacing[k] - 0.5;
            let (low, high, last) = (at(low), at(high), grid.cells()[k] as f64 - 1.0);
            if high >= 0.0 && low <= last {
                low.floor().max(0.0) as usize..high.ceil().min(last) as usize + 1
            } else {
                0..0
            }
        };
        let columns = |corners: &[[f64; 3]; 3]| {
            let x = corners.map(|p| p[0]);
            let (low, high) = (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
            numbers(0, [low - distance, high + distance])
        };
        let rows = |corners: &[[f64; 3]; 3], x: f64| {
            let [low, high] = within_slab(corners, [x - distance, x + distance]);
            numbers(1, [low - distance, high + distance])
        };
        // A block of triangles at a time, so that memory does not grow with all of them.
        for block in soup.triangles.chunks(4096) {
            let found: Vec<(u32, Interval)> = block
                .par_iter()
                .flat_map_iter(|corners| {
                    columns(corners)
                        .flat_map(move |i| rows(corners, grid.x(i)).map(move |j| (i, j)))
                        .filter_map(move |(i, j)| {
                            let [low, high] = near_triangle(corners, grid.x(i), grid.y(j), distance)?;
                            Some((grid.number(i, j) as u32, Interval::between(low, high)))
                        })
                })
                .collect();
            dexels
                .update(Operation::Union, &found)
                .expect("intervals of positive length on lines of the grid");
        }
        dexels
    }
}

#[cfg(test)]
mod tests {
    use super::super::distance::DistanceTo;
    use super::*;
    use sweepsim_props::*;

    proptest! {
        /// Against the distance of points along the line.
        #[test]
        fn ends_are_at_the_distance(corners in prop::array::uniform3(prop::array::uniform3(-3.0_f64..3.0)),
            x in -4.0_f64..4.0, y in -4.0_f64..4.0, d in 0.01_f64..2.0) {
            let soup = TriangleSoup { triangles: vec![corners] };
            let to = DistanceTo::new(&soup).unwrap();
            let far = |z: f64| to.nearest([x, y, z]).map_or(f64::INFINITY, |near| near.distance.abs());
            match near_triangle(&corners, x, y, d) {
                Some([low, high]) => {
                    prop_assert!((far(low) - d).abs() < 1e-9 && (far(high) - d).abs() < 1e-9, "{} {}", far(low), far(high));
                    prop_assert!(far(0.5 * (low + high)) <= d + 1e-9);
                }
                None => {
                    for k in 0..200 {
                        prop_assert!(far(-7.0 + 0.07 * f64::from(k)) >= d - 1e-9);
                    }
                }
            }
        }
    }
}
