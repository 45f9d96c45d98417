//! Patches of the points at a distance from a solid.

use nalgebra::Vector3;
use smallvec::SmallVec;

type Vectors = SmallVec<[Vector3<f64>; 3]>;
/// What is known of the points of a patch.
#[derive(Clone, Copy)]
pub(super) struct Around<'a> {
    /// Whether one needs no other reason.
    pub is_free: &'a dyn Fn(&Vector3<f64>) -> bool,
    /// How far apart the places are from which a cutter holds two of them.
    pub apart: &'a dyn Fn([&Vector3<f64>; 2]) -> f64,
}
/// A few points.
pub(super) type Points = SmallVec<[Vector3<f64>; 12]>;

/// The points from a corner, an edge or a triangle along directions between some normals.
#[derive(Clone, Debug)]
pub(super) struct Patch {
    pub corners: Vectors,
    pub normals: Vectors,
}

/// What is at a triangle, an edge or a corner: none where it turns inwards.
pub(super) type Patches = SmallVec<[Patch; 1]>;

/// Between which of its corners or normals a patch is halved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Halved {
    /// At this part of the way from the first to the second.
    Corners([usize; 2], f32),
    Normals([usize; 2]),
}

/// Normals farther apart are divided before corners are: on one side, a patch may be beyond the stock, on the other be
/// removed.
const WIDE: f64 = 0.3;
/// No patch is made so many times longer than it is wide, on purpose.
const THIN: f64 = 4096.0;
/// Corners that a cutter holds from places that are less apart, in parts of the longest side, are held together.
const APART: f64 = 0.02;
/// Steps of the search for where a way is no longer free: so many digits, and the part is a short number.
const PARTINGS: usize = 16;
/// Normals whose sum is shorter are opposite but for their rounding: for a checker, too.
const OPPOSITE: f64 = 1e-11;
/// Three normals in one plane, or nearly so, have a smaller determinant.
const SOLID: f64 = 1e-2;
/// Normals that differ less are the same, for what a patch is: every test of it has a larger margin. A checker takes
/// twice as much.
pub(super) const SAME: f64 = 5e-10;

impl Patch {
    /// Those of a corner, with the normals around it.
    pub fn at_corner(place: &Vector3<f64>, normals: impl Iterator<Item = Vector3<f64>>) -> Patches {
        let mut own = Vectors::new();
        // Whether some are nearly the same, which a checker may see otherwise.
        let mut is_close = false;
        for normal in normals {
            let apart = |other: &Vector3<f64>| (other - normal).norm();
            let nearest = own.iter().map(apart).fold(f64::INFINITY, f64::min);
            if nearest > 2.0 * SAME {
                own.push(normal);
            } else {
                is_close |= nearest > SAME;
            }
        }
        let patch = |normals: Vectors| Self {
            corners: [*place].into_iter().collect(),
            normals,
        };
        if own.len() < 3 {
            // Of the edges.
            return is_close.then(|| patch(own)).into_iter().collect();
        }
        let whole = patch(own);
        let three = |own: [Vector3<f64>; 3]| patch(own.into_iter().collect());
        let is_solid = |own: &Vectors| own.len() == 3 && own[0].dot(&own[1].cross(&own[2])).abs() > SOLID;
        if whole.points(0.0).is_none() && !is_solid(&whole.normals) {
            // They look all around: between the axes is every direction.
            let axis = |octant: usize, k: usize| Vector3::ith(k, if octant >> k & 1 == 0 { 1.0 } else { -1.0 });
            return (0..8).map(|octant| three([0, 1, 2].map(|k| axis(octant, k)))).collect();
        }
        if whole.normals.len() == 3 || whole.spread() <= WIDE {
            return SmallVec::from([whole]);
        }
        // A vector in their cone, less enough of the first of them, is between two others (Carathéodory).
        let own = &whole.normals;
        let pairs = (1..own.len()).flat_map(|i| (1..i).map(move |j| (i, j)));
        pairs.map(|(i, j)| three([own[0], own[i], own[j]])).collect()
    }

    /// The largest sine of half the angle between two normals, twice.
    fn spread(&self) -> f64 {
        let pairs = self.normals.iter().enumerate();
        pairs
            .flat_map(|(k, a)| self.normals[..k].iter().map(move |b| (a - b).norm()))
            .fold(0.0, f64::max)
    }

    /// Points whose hull has every point of the patch at the distance `d`; and about the middle of it.
    ///
    /// Unit vectors `u` between normals `nᵢ` are between the planes `⟨m, u⟩ = c` and `1`, if `m` is a unit vector and
    /// `c` the least `⟨m, nᵢ⟩`: and so in the hull of the `nᵢ`, scaled to both. `None` if they look in all directions.
    pub fn points(&self, d: f64) -> Option<(Points, Vector3<f64>)> {
        let mean = self.normals.iter().sum::<Vector3<f64>>().try_normalize(1e-3)?;
        let least = self.normals.iter().map(|normal| normal.dot(&mean));
        let least = least.fold(f64::INFINITY, f64::min);
        if least < 0.1 {
            return None;
        }
        let mut points = SmallVec::new();
        for corner in &self.corners {
            for normal in &self.normals {
                let high = normal * (d / normal.dot(&mean));
                points.push(corner + high);
                if self.normals.len() > 1 {
                    points.push(corner + high * least);
                }
            }
        }
        let middle = self.corners.iter().sum::<Vector3<f64>>() / self.corners.len() as f64;
        Some((points, middle + mean * d))
    }

    /// The points of the patch over a place.
    fn over(&self, place: &Vector3<f64>, d: f64) -> Points {
        let of_one = Self {
            corners: [*place].into_iter().collect(),
            normals: self.normals.clone(),
        };
        of_one.points(d).map(|(points, _)| points).unwrap_or_default()
    }

    /// The largest distance between two of its corners.
    pub fn length(&self) -> f64 {
        let pairs = self.corners.iter().enumerate();
        let pairs = pairs.flat_map(|(k, a)| self.corners[..k].iter().map(move |b| (a - b).norm()));
        pairs.fold(0.0, f64::max)
    }

    /// The middle of what the patch is of, and a direction.
    pub fn middle(&self) -> (Vector3<f64>, Vector3<f64>) {
        let middle = self.corners.iter().sum::<Vector3<f64>>() / self.corners.len() as f64;
        let mean = self.normals.iter().sum::<Vector3<f64>>();
        (middle, mean.try_normalize(1e-3).unwrap_or(self.normals[0]))
    }

    /// Two parts of it, or nothing if it is as small as it should be. Between corners of which one is free and the
    /// other is not, it is parted where that ends; else where a cutter would have to be at places that are far apart.
    pub fn halves(&self, d: f64, least: f64, around: Option<Around>) -> Option<(Halved, [Self; 2])> {
        let longest = |vectors: &Vectors| {
            let mut best = (0.0, 0, 0);
            for i in 0..vectors.len() {
                for j in 0..i {
                    let length = (vectors[i] - vectors[j]).norm();
                    if length > best.0 {
                        best = (length, i, j);
                    }
                }
            }
            best
        };
        let (length, mut i, mut j) = longest(&self.corners);
        let (angle, k, l) = longest(&self.normals);
        if length.max(d * angle) < least {
            return None;
        }
        let replaced = |vectors: &Vectors, at: usize, by: Vector3<f64>| {
            let mut vectors = vectors.clone();
            vectors[at] = by;
            vectors
        };
        // More normals than three are close to each other.
        let is_wide = angle > WIDE && d > 0.0;
        if self.normals.len() > 3 || length >= d * angle && !is_wide {
            let area = match self.corners[..] {
                [a, b, c] => (b - a).cross(&(c - a)).norm(),
                _ => length * length,
            };
            let mut part = 0.5;
            if let Some(Around { is_free, apart }) = around.filter(|_| area > length * length / THIN) {
                let is_free = |corner: &Vector3<f64>| self.over(corner, d).iter().all(is_free);
                let free: SmallVec<[bool; 3]> = self.corners.iter().map(is_free).collect();
                let is_mixed = free.contains(&true) && free.contains(&false);
                let mut own = if is_mixed { 0.0 } else { APART * length };
                for (a, b) in [(1, 0), (2, 0), (2, 1)].into_iter().filter(|(a, _)| *a < free.len()) {
                    let ends = [&self.corners[a], &self.corners[b]];
                    let between = match is_mixed {
                        true if free[a] == free[b] => 0.0,
                        true => (ends[0] - ends[1]).norm(),
                        false => apart(ends),
                    };
                    if between > own {
                        (own, i, j) = (between, a, b);
                    }
                }
                if is_mixed {
                    let [first, second] = [i.min(j), i.max(j)];
                    let way = self.corners[second] - self.corners[first];
                    part = parted(|part| is_free(&(self.corners[first] + way * part)), free[first]);
                }
            }
            let ends = [i.min(j), i.max(j)];
            let [from, to] = ends.map(|end| self.corners[end]);
            let middle = from + (to - from) * f64::from(part);
            return (length > 0.0).then(|| {
                let half = |end| Self {
                    corners: replaced(&self.corners, end, middle),
                    normals: self.normals.clone(),
                };
                (Halved::Corners(ends, part), ends.map(half))
            });
        }
        let middle = (self.normals[k] + self.normals[l]).try_normalize(OPPOSITE);
        // Those of an edge may be opposite: by way of any direction across, which no checker believes.
        let middle = middle.unwrap_or_else(|| {
            let own = self.normals[k];
            own.cross(&Vector3::ith(own.iamin(), 1.0)).normalize()
        });
        let ends = [k.min(l), k.max(l)];
        let half = |end| Self {
            corners: self.corners.clone(),
            normals: replaced(&self.normals, end, middle),
        };
        Some((Halved::Normals(ends), ends.map(half)))
    }
}

/// The part of a way up to which, from the end that is free, it is free: at least half of it.
fn parted(is_free: impl Fn(f64) -> bool, from_first: bool) -> f32 {
    let at = |part: f64| if from_first { part } else { 1.0 - part };
    let (mut low, mut high) = (0.5, 1.0);
    if is_free(at(low)) {
        for _ in 0..PARTINGS {
            let middle = 0.5 * (low + high);
            if is_free(at(middle)) {
                low = middle;
            } else {
                high = middle;
            }
        }
    }
    at(low) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a direction is in the cone of three normals, but for rounding.
    fn is_between(u: &Vector3<f64>, normals: &[Vector3<f64>]) -> bool {
        let all = nalgebra::Matrix3::from_columns(normals);
        all.lu().solve(u).is_some_and(|parts| parts.min() > -1e-9)
    }

    /// Normals may lie in one plane, all around, or be opposite: with these, halving some three of them never came to
    /// an end.
    #[test]
    fn patches_of_a_corner_cover_all_between_its_normals() {
        let mut seed = 1_u64;
        let mut random = move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let (mut counts, mut around) = ([0; 3], 0);
        for case in 0..3000 {
            let count = 3 + case % 4;
            let kind = case / 4 % 3;
            let normals: Vec<Vector3<f64>> = (0..count)
                .map(|_| match kind {
                    0 => Vector3::from_fn(|_, _| random() - 0.5).normalize(),
                    // All in one plane.
                    1 => {
                        let (sine, cosine) = (std::f64::consts::TAU * random()).sin_cos();
                        Vector3::new(sine, 0.0, cosine)
                    }
                    _ => Vector3::ith((3.0 * random()) as usize, if random() < 0.5 { 1.0 } else { -1.0 }),
                })
                .collect();
            let patches = Patch::at_corner(&Vector3::zeros(), normals.iter().copied());
            around += usize::from(patches.len() == 8);
            let mut open: Vec<Patch> = patches.to_vec();
            let (mut parts, mut done) = (0, Vec::new());
            while let Some(patch) = open.pop() {
                parts += 1;
                assert!(parts < 200, "{normals:?}");
                match patch.points(0.1) {
                    None => open.extend(patch.halves(0.1, 0.0, None).expect("halves").1),
                    Some(_) => done.push(patch),
                }
            }
            for _ in 0..20 {
                let sum: Vector3<f64> = normals.iter().map(|normal| normal * random()).sum();
                // Between normals in one plane on one side, there is no room.
                let is_flat = kind == 1 && patches.len() != 8;
                let Some(u) = sum.try_normalize(1e-2).filter(|_| !done.is_empty() && !is_flat) else {
                    continue;
                };
                counts[kind] += 1;
                let covers = |patch: &Patch| match &patch.normals[..] {
                    all @ [_, _, _] => is_between(&u, all),
                    // As narrow as it is, any three of its first with others.
                    all => (1..all.len()).any(|i| (1..i).any(|j| is_between(&u, &[all[0], all[i], all[j]]))),
                };
                assert!(done.iter().any(covers), "{u:?} {normals:?}");
            }
        }
        assert!(
            counts.iter().all(|count| *count > 5000) && around > 1000,
            "{counts:?} {around}"
        );
    }
}
