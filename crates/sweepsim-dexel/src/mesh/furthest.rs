//! The farthest point of one surface from another.

use super::{DistanceTo, Nearest, TriangleSoup};
use crate::vector::{cross, dot, normal_of, sub};
use rayon::prelude::*;

/// The maximum number of samples.
const SAMPLES: f64 = 2e6;

/// A sample, and the nearest point of the other surface.
type Found = ([f64; 3], Nearest);

fn along(a: [f64; 3], s: f64, b: [f64; 3]) -> [f64; 3] {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// The one whose distance is larger; of equal ones the first.
fn further(a: Found, b: Found) -> Found {
    if b.1.distance.abs() > a.1.distance.abs() { b } else { a }
}

/// The best of samples at all corners of the triangles, and at most `spacing` apart on them, in a fixed order. `of`
/// gets a point and the unit normal of its triangle.
fn sampled(
    soup: &TriangleSoup,
    spacing: f64,
    of: impl Fn([f64; 3], [f64; 3]) -> Option<Found> + Sync,
) -> Option<Found> {
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
        let normal = normal.map(|c| c / size);
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
        samples.filter_map(|p| of(p, normal)).reduce(further)
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
        sampled(other, spacing, |p, _| Some((p, self.nearest(p)?)))
    }

    /// The point of a target that is farthest from this part, as [`furthest`](Self::furthest), but where the target is
    /// missing, at most as far as it is thick there, along its normal or an axis. So a web that is missing altogether
    /// is missing by its thickness, however far what remains is from it.
    ///
    /// Distances are those of the target's points from the part: positive where the part is missing.
    #[must_use]
    pub fn most_missing(&self, target: &TriangleSoup, to_target: &Self, spacing: f64) -> Option<([f64; 3], Nearest)> {
        sampled(target, spacing, |p, normal| {
            Some((p, self.missing_at(p, normal, to_target)?))
        })
    }

    /// How thick the solid is at a point of its surface: along its normal there, or along one of the axes just below
    /// the surface; infinite if that is more than `most`.
    pub(crate) fn thickness(&self, p: [f64; 3], normal: [f64; 3], size: f64, most: f64) -> f64 {
        // Hits nearer than rounding are the triangle itself and its neighbours.
        let least = 1e-9 * size;
        let within = |from, direction, reach| {
            let found = self.first_hit(from, direction, least..reach);
            found.unwrap_or(f64::INFINITY)
        };
        let below = along(p, -1e-6 * size, normal);
        let chords = (0..3).map(|k| {
            let mut axis = [0.0; 3];
            axis[k] = 1.0;
            // On an edge of the solid, one of both leaves it at once.
            let back = axis.map(|c| -c);
            let mut both = [within(below, axis, most), within(below, back, most)];
            // Of a chord that is short to one side all is looked for.
            match both.map(f64::is_finite) {
                [true, false] => both[1] = within(below, back, f64::INFINITY),
                [false, true] => both[0] = within(below, axis, f64::INFINITY),
                [true, true] | [false, false] => (),
            }
            let sum: f64 = both.iter().filter(|away| away.is_finite()).sum();
            if sum > 0.0 { sum } else { f64::INFINITY }
        });
        chords.fold(within(p, normal.map(|c| -c), most), f64::min)
    }

    /// How far a point of a target is from this part, where the target's unit normal is `normal`; outside the part, at
    /// most as far as the target is thick there.
    ///
    /// ```
    /// # use sweepsim_dexel::{DistanceTo, Grid, Stock};
    /// let block = |low: f64, high: f64| Stock::Block { min: [-9.0, -9.0, low], max: [9.0, 9.0, high] };
    /// let grid = Grid::new([-10.0, -10.0], [10.0, 10.0], [40, 40])?;
    /// let soup = |stock: Stock| stock.dexels(&grid).unwrap().surface().unwrap().soup().unwrap();
    /// // Two plates; of the target, only one is there.
    /// let target = soup(Stock::Union(vec![block(0.0, 5.0), block(10.0, 12.0)]));
    /// let part = DistanceTo::new(&soup(block(0.0, 5.0)))?;
    /// let to_target = DistanceTo::new(&target)?;
    /// let top = [1.0, 2.0, 12.0];
    /// let missing = part.missing_at(top, [0.0, 0.0, 1.0], &to_target).unwrap();
    /// assert_eq!((part.nearest(top).unwrap().distance, missing.distance), (7.0, 2.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn missing_at(&self, p: [f64; 3], normal: [f64; 3], to_target: &Self) -> Option<Nearest> {
        let mut near = self.nearest(p)?;
        let size = 1.0 + p.iter().map(|c| c.abs()).fold(0.0, f64::max);
        if near.distance > 1e-6 * size {
            let most = near.distance;
            near.distance = most.min(to_target.thickness(p, normal, size, most));
        }
        Some(near)
    }
}
