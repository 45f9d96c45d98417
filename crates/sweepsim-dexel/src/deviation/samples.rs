//! Points of a surface at which its distance from another one is taken.

use super::DistanceRange;
use crate::grid::Frame;
use crate::intervals::End;
use crate::mesh::{FaceSurfaces, TriangleSoup};
use crate::tri::TriDexels;
use crate::vector::{along, dot, length, normal_of, sub};
use rayon::prelude::*;
use smallvec::{SmallVec, smallvec};
use std::collections::HashMap;

/// The maximum number of samples on triangles.
const SAMPLES: f64 = 2e6;

/// A point of a surface, or a stretch on which one point is.
pub(super) struct SurfaceSample {
    /// The point, or points from the end of the stretch inside the solid to the other.
    pub places: SmallVec<[[f64; 3]; 5]>,
    /// The unit normal; of a stretch its direction.
    pub normal: [f64; 3],
    /// The area that the sample stands for; 0 for one that is only there for the largest distance.
    pub area: f64,
}

/// The distance of a sample.
pub(super) struct SampleDeviation {
    pub place: [f64; 3],
    pub range: DistanceRange,
    pub area: f64,
}

impl SurfaceSample {
    /// The distance of the point, wherever on its stretch that is.
    pub fn deviation(&self, of: impl Fn([f64; 3]) -> Option<DistanceRange>) -> Option<SampleDeviation> {
        let found = self.places.iter().filter_map(|p| of(*p));
        Some(SampleDeviation {
            place: *self.places.get(self.places.len() / 2)?,
            range: found.reduce(DistanceRange::hull)?,
            area: self.area,
        })
    }

    /// How long the stretch is.
    pub fn stretch(&self) -> f64 {
        match (self.places.first(), self.places.last()) {
            (Some(a), Some(b)) => length(sub(*b, *a)),
            _ => 0.0,
        }
    }
}

/// The number of the longest side of a triangle, from the corner of that number, and its length.
fn longest(corners: &[[f64; 3]; 3]) -> (usize, f64) {
    let sides = [0, 1, 2].map(|k| length(sub(corners[(k + 1) % 3], corners[k])));
    let k = (0..3).fold(0, |best, k| if sides[k] > sides[best] { k } else { best });
    (k, sides[k])
}

/// A piece is thin if it is no higher than this part of the spacing.
const THIN: f64 = 0.25;

/// Pieces of a triangle: a place in the middle of each, and its area. No point of a piece is farther than `spacing`
/// from that place.
fn pieces(corners: [[f64; 3]; 3], spacing: f64) -> Vec<([f64; 3], f64)> {
    let mut found = Vec::new();
    let mut open = vec![(corners, 0.5 * length(normal_of(corners)))];
    while let Some((piece, area)) = open.pop() {
        let (k, long) = longest(&piece);
        let [a, b, c] = [piece[k], piece[(k + 1) % 3], piece[(k + 2) % 3]];
        if long <= 1.5 * spacing {
            // No point is farther from the centroid than two thirds of the longest side.
            found.push(([0, 1, 2].map(|k| (a[k] + b[k] + c[k]) / 3.0), area));
        } else if 2.0 * area <= THIN * spacing * long {
            slices([a, b, c], area, spacing, &mut found);
        } else {
            // Halved across the longest side.
            let middle = [0, 1, 2].map(|k| 0.5 * (a[k] + b[k]));
            open.extend([([a, middle, c], 0.5 * area), ([middle, b, c], 0.5 * area)]);
        }
    }
    found
}

/// Of a thin triangle whose longest side is from `a` to `b`: slices across it. Halves would be three times as many each
/// time that the longest side is halved.
fn slices([a, b, c]: [[f64; 3]; 3], area: f64, spacing: f64, found: &mut Vec<([f64; 3], f64)>) {
    let side = sub(b, a);
    // Where the third corner is above that side, and what part of the area is before a place of it.
    let top = (dot(sub(c, a), side) / dot(side, side)).clamp(1e-9, 1.0 - 1e-9);
    let before = |x: f64| {
        if x < top {
            x * x / top
        } else {
            1.0 - (1.0 - x) * (1.0 - x) / (1.0 - top)
        }
    };
    let count = (length(side) / spacing).ceil();
    found.extend((0..count as usize).map(|number| {
        let [from, middle, to] = [0.0, 0.5, 1.0].map(|part| (number as f64 + part) / count);
        let lower = along(a, middle, side);
        let upper = if middle < top {
            along(a, middle / top, sub(c, a))
        } else {
            along(b, (1.0 - middle) / (1.0 - top), sub(c, b))
        };
        (along(lower, 0.5, sub(upper, lower)), area * (before(to) - before(from)))
    }));
}

/// On triangles: at all corners, and so that no point is farther than `spacing` from the next sample, or than is
/// possible with two million. Where the surfaces of faces are known, samples are on these.
pub(super) fn on_triangles(
    soup: &TriangleSoup,
    faces: Option<&FaceSurfaces>,
    spacing: f64,
    of: impl Fn(&SurfaceSample) -> Option<SampleDeviation> + Sync,
) -> Vec<SampleDeviation> {
    // NaN asks for the finest that is possible.
    let spacing = spacing.max(0.0);
    let area = |t: &[[f64; 3]; 3]| 0.5 * length(normal_of(*t));
    let is_solid = |(_, corners): &(usize, &[[f64; 3]; 3])| area(corners) > 0.0 && area(corners).is_finite();
    let solid: Vec<(usize, &[[f64; 3]; 3])> = soup.triangles.iter().enumerate().filter(is_solid).collect();
    // Pieces have at least about an eighth of the square of their size as their area, or are those of thin triangles.
    let total: f64 = solid.iter().map(|(_, corners)| area(corners)).sum();
    let long = solid.iter().map(|(_, corners)| longest(corners).1);
    let thin: f64 = long.filter(|long| *long > spacing).sum();
    let spacing = spacing.max((4.0 * total / SAMPLES).sqrt()).max(4.0 * thin / SAMPLES);
    let bits = |p: [f64; 3]| p.map(|c| (c + 0.0).to_bits());
    // Only looked up, so its order does not matter.
    let mut first = HashMap::with_capacity(solid.len());
    for (number, corners) in &solid {
        for p in *corners {
            first.entry(bits(*p)).or_insert(*number);
        }
    }
    let of_triangle = |(number, corners): &(usize, &[[f64; 3]; 3])| {
        let normal = normal_of(**corners).map(|c| 0.5 * c / area(corners));
        let surface = faces.and_then(|faces| faces.of_triangle(*number));
        let sample = |place: [f64; 3], area: f64| {
            let place = surface.map_or(place, |surface| surface.nearest(place));
            of(&SurfaceSample {
                places: smallvec![place],
                normal,
                area,
            })
        };
        // Of the triangles around a corner only the first.
        let own = corners.iter().filter(|place| first.get(&bits(**place)) == Some(number));
        let mut found: Vec<SampleDeviation> = own.filter_map(|place| sample(*place, 0.0)).collect();
        let pieces = pieces(**corners, spacing).into_iter();
        found.extend(pieces.filter_map(|(place, area)| sample(place, area)));
        found
    };
    solid.par_iter().flat_map_iter(of_triangle).collect()
}

/// The world's place and normal of an end.
pub(super) fn end_in_world(frame: &Frame, [x, y]: [f64; 2], end: &End) -> ([f64; 3], [f64; 3]) {
    let place = frame.to_world([x, y, end.z]);
    (place, frame.turn_to_world(end.normal.map(f64::from)))
}

/// At all ends of dexels along three axes. An end stands for the area of its cell times the cosine of its slope: the
/// squares of the three cosines of a face add up to one.
pub(super) fn at_tri_ends(
    solid: &TriDexels,
    of: impl Fn(&SurfaceSample) -> Option<SampleDeviation> + Sync,
) -> Vec<SampleDeviation> {
    let mut all = Vec::new();
    for set in solid.sets() {
        let grid = set.grid();
        let [dx, dy] = grid.spacing();
        let lines: Vec<usize> = set.iter().map(|(line, _)| line).collect();
        let of_line = |line: &usize| {
            let (i, j) = grid.place(*line);
            let mut found = Vec::new();
            for end in set
                .at(*line)
                .iter()
                .flat_map(|interval| [interval.lower, interval.upper])
            {
                let (place, normal) = end_in_world(grid.frame(), [grid.x(i), grid.y(j)], &end);
                found.extend(of(&SurfaceSample {
                    places: smallvec![place],
                    normal,
                    area: dx * dy * f64::from(end.normal[2].abs()),
                }));
            }
            found
        };
        let found: Vec<SampleDeviation> = lines.par_iter().flat_map_iter(of_line).collect();
        all.extend(found);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_point_of_a_triangle_is_far_from_a_sample() {
        // A large one, and a needle.
        for corners in [
            [[0.0; 3], [7.0, 1.0, 0.0], [2.0, 5.0, 3.0]],
            [[0.0; 3], [50.0, 0.0, 0.0], [50.0, 0.001, 0.0]],
            [[0.0; 3], [0.0, 0.1, 0.0], [-30.0, 0.0, 20.0]],
            [[0.0; 3], [9.0, 0.0, 0.0], [3.0, 0.06, 0.0]],
            [[0.0; 3], [20.0, 0.0, 0.0], [-9.0, 1.0, 0.0]],
        ] {
            let soup = TriangleSoup {
                triangles: vec![corners],
            };
            let found = on_triangles(&soup, None, 0.5, |sample| {
                sample.deviation(|_| Some(DistanceRange::exactly(0.0)))
            });
            let total: f64 = found.iter().map(|sample| sample.area).sum();
            assert!((total - 0.5 * length(normal_of(corners))).abs() < 1e-9 * total);
            // About as many as cells of that size would be.
            assert!((found.len() as f64) < 16.0 * total / 0.25 + 2.0 * longest(&corners).1 / 0.5 + 3.0);
            for k in 0..=40 {
                for l in 0..=40 - k {
                    let [u, v] = [k, l].map(|c| f64::from(c) / 40.0);
                    let p = [0, 1, 2].map(|c| corners[0][c] * (1.0 - u - v) + corners[1][c] * u + corners[2][c] * v);
                    let away = found.iter().map(|sample| length(sub(sample.place, p)));
                    assert!(away.fold(f64::INFINITY, f64::min) <= 0.5);
                }
            }
        }
    }
}
