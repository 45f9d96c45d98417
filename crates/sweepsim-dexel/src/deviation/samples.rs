//! Points of a surface at which its distance from another one is taken.

use super::DistanceRange;
use crate::grid::Frame;
use crate::intervals::End;
use crate::mesh::TriangleSoup;
use crate::tri::TriDexels;
use crate::vector::{length, normal_of, sub};
use rayon::prelude::*;
use smallvec::{SmallVec, smallvec};
use std::collections::HashMap;

/// The maximum number of samples on triangles.
const SAMPLES: f64 = 2e6;
/// The most pieces of a side of a triangle.
const PIECES: f64 = 2048.0;

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

fn weighted(corners: &[[f64; 3]; 3], weights: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| (0..3).map(|c| weights[c] * corners[c][k]).sum())
}

/// On triangles: at all corners, and at the middles of equal pieces of at most `spacing`.
pub(super) fn on_triangles(
    soup: &TriangleSoup,
    spacing: f64,
    of: impl Fn(&SurfaceSample) -> Option<SampleDeviation> + Sync,
) -> Vec<SampleDeviation> {
    let area = |t: &[[f64; 3]; 3]| 0.5 * length(normal_of(*t));
    let total: f64 = soup.triangles.iter().map(area).sum();
    // A piece of side s has at least half of s² / 2 as its share of a triangle that is not very thin.
    let spacing = spacing.max((2.0 * total / SAMPLES).sqrt());
    let solid = soup.triangles.iter().filter(|corners| area(corners) > 0.0);
    let solid: Vec<(usize, &[[f64; 3]; 3])> = solid.enumerate().collect();
    let bits = |p: [f64; 3]| p.map(|c| (c + 0.0).to_bits());
    // Only looked up, so its order does not matter.
    let mut first = HashMap::with_capacity(solid.len());
    for (number, corners) in &solid {
        for p in *corners {
            first.entry(bits(*p)).or_insert(*number);
        }
    }
    let of_triangle = |(number, corners): &(usize, &[[f64; 3]; 3])| {
        let size = area(corners);
        let normal = normal_of(**corners).map(|c| 0.5 * c / size);
        let longest = (0..3)
            .map(|k| length(sub(corners[(k + 1) % 3], corners[k])))
            .fold(0.0, f64::max);
        // Of a thin triangle only as many as its area asks for.
        let share = (2.0 * size).sqrt() / spacing;
        let count = (longest / spacing).min(4.0 * share.max(1.0)).ceil().clamp(1.0, PIECES) as usize;
        let n = count as f64;
        let sample = |weights: [f64; 3], area: f64| SurfaceSample {
            places: smallvec![weighted(corners, weights)],
            normal,
            area,
        };
        let mut found = Vec::with_capacity(count * count + 3);
        for (corner, place) in corners.iter().enumerate() {
            // Of the triangles around it only the first.
            if first.get(&bits(*place)) == Some(number) {
                let mut weights = [0.0; 3];
                weights[corner] = 1.0;
                found.extend(of(&sample(weights, 0.0)));
            }
        }
        for i in 0..count {
            for j in 0..count - i {
                // The piece that lies like the triangle, and the one that is turned.
                for (turned, off) in [(false, 1.0 / 3.0), (true, 2.0 / 3.0)] {
                    if turned && i + j + 1 >= count {
                        continue;
                    }
                    let [u, v] = [i, j].map(|c| (c as f64 + off) / n);
                    found.extend(of(&sample([1.0 - u - v, u, v], size / (n * n))));
                }
            }
        }
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
