//! The farthest point of one surface from another.

use super::{DistanceTo, Nearest, TriangleSoup};
use crate::vector::{along, cross, dot, normal_of, sub};
use rayon::prelude::*;

/// The maximum number of samples.
const SAMPLES: f64 = 2e6;

/// A sample, and the nearest point of the other surface.
type Found = ([f64; 3], Nearest);

/// The one whose distance is larger; of equal ones the first.
fn further(a: Found, b: Found) -> Found {
    if b.1.distance.abs() > a.1.distance.abs() { b } else { a }
}

/// The best of samples at all corners of the triangles, and at most `spacing` apart on them, in a fixed order.
fn sampled(soup: &TriangleSoup, spacing: f64, of: impl Fn([f64; 3]) -> Option<Found> + Sync) -> Option<Found> {
    let area = |t: &[[f64; 3]; 3]| 0.5 * dot(normal_of(*t), normal_of(*t)).sqrt();
    let total: f64 = soup.triangles.iter().map(area).sum();
    let spacing = spacing.max((total / SAMPLES).sqrt());
    // In rows along the longest side, fewer and fewer towards the corner opposite.
    let of_triangle = |p: &[[f64; 3]; 3]| {
        let normal = normal_of(*p);
        let size = dot(normal, normal).sqrt();
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
        let sides = [0, 1, 2].map(|k| sub(p[(k + 1) % 3], p[k]));
        let longest = |a: usize, k: usize| {
            if dot(sides[k], sides[k]) > dot(sides[a], sides[a]) {
                k
            } else {
                a
            }
        };
        let k = (0..3).fold(0, longest);
        let (from, side, back) = (p[k], sides[k], sides[(k + 2) % 3]);
        let (length, twice) = (dot(side, side).sqrt(), cross(side, back));
        // Long sides of thin triangles have samples without end: bounded, too.
        let steps = |length: f64| (length / spacing).ceil().clamp(1.0, 4096.0) as usize;
        let rows = steps(dot(twice, twice).sqrt() / length);
        let inner = (0..rows).flat_map(|row| {
            let up = row as f64 / rows as f64;
            let begin = along(from, -up, back);
            let columns = steps((1.0 - up) * length);
            (0..=columns).map(move |c| along(begin, (1.0 - up) * c as f64 / columns as f64, side))
        });
        let samples = inner.chain(*p);
        samples.filter_map(&of).reduce(further)
    };
    let best: Vec<Option<Found>> = soup.triangles.par_iter().map(of_triangle).collect();
    best.into_iter().flatten().reduce(further)
}

impl DistanceTo {
    /// The point of another surface that is furthest from this one, with the nearest point here: the one-sided
    /// Hausdorff distance, estimated from samples. Samples are taken at all vertices, and at most `spacing` apart on
    /// triangles; a larger spacing is used where this would take more than two million. Distances change no faster than
    /// points do, so the true distance is larger by less than the spacing. `None` if either surface has no triangles.
    #[must_use]
    pub fn furthest(&self, other: &TriangleSoup, spacing: f64) -> Option<([f64; 3], Nearest)> {
        sampled(other, spacing, |p| Some((p, self.nearest(p)?)))
    }
}
