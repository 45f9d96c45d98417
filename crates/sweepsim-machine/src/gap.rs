//! How far two convex solids are apart.
//!
//! The closest point of their difference to 0 is found as by E. G. Gilbert, D. W. Johnson, S. S. Keerthi (1988). Each
//! step gives a direction; the lower bound is what the supports of both solids along it show, however it was found.

use crate::joint::{Rigid, Travel};
use crate::shape::Convex;
use nalgebra::Vector3;
use smallvec::SmallVec;

/// What rounding can add to a bound, as a share of the coordinates.
const ROUNDING: f64 = 1e-13;
/// A distance between both bounds that is this share of it is small enough.
const CLOSE: f64 = 1e-4;

/// Bounds of the distance of two solids.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gap {
    /// They are at least this far apart along `direction`; negative if nothing is shown.
    pub low: f64,
    /// Two of their points are this near to each other; 0 if they overlap.
    pub high: f64,
    /// A unit vector from `a` to `b`.
    pub direction: Vector3<f64>,
}

/// The pair of solids, `b` being moved by `frame`.
pub(crate) struct Pair<'a> {
    pub a: &'a Convex,
    pub b: &'a Convex,
    pub frame: &'a Rigid,
}

impl Pair<'_> {
    /// The point of `b - a` that is the least far along `u`.
    fn nearest(&self, u: &Vector3<f64>) -> Vector3<f64> {
        let of_b = self.frame.of(&self.b.support(&-(self.frame.turn.tr_mul(u))));
        of_b - self.a.support(u)
    }

    /// How far apart both are along the unit vector `u`, with all rounding on the safe side; negative if they overlap
    /// along it.
    pub fn along(&self, u: &Vector3<f64>) -> f64 {
        let of_a = self.a.support(u);
        let of_b = self.frame.of(&self.b.support(&-(self.frame.turn.tr_mul(u))));
        let size = of_a.amax() + of_b.amax() + self.frame.shift.amax();
        (of_b - of_a).dot(u) - ROUNDING * 8.0 * size
    }

    /// Bounds of the distance. Stops as soon as a direction shows more than what `enough` asks for along it.
    pub fn gap(&self, start: &Vector3<f64>, enough: impl Fn(&Vector3<f64>) -> f64) -> Gap {
        let mut best = Gap {
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
            direction: Vector3::z(),
        };
        let mut simplex = SmallVec::<[Vector3<f64>; 4]>::new();
        let mut v = *start;
        for _ in 0..64 {
            let length = v.norm();
            if !(length > 0.0) {
                best.high = 0.0;
                break;
            }
            let u = v / length;
            let low = self.along(&u);
            if low > best.low {
                (best.low, best.direction) = (low, u);
            }
            if low > enough(&u) || best.low >= (1.0 - CLOSE) * best.high {
                break;
            }
            let point = self.nearest(&u);
            if simplex.contains(&point) {
                break;
            }
            simplex.push(point);
            v = closest(&mut simplex);
            best.high = best.high.min(v.norm());
            let size = simplex.iter().map(Vector3::amax).fold(0.0, f64::max);
            if simplex.len() == 4 || best.high <= ROUNDING * size {
                best.high = 0.0;
                break;
            }
        }
        best
    }

    /// How far apart both are along the axes of coordinates, less what they travel along these.
    pub fn apart_along_axes(&self, travel: &Travel) -> f64 {
        let sides = (0..3).flat_map(|k| [1.0, -1.0].map(|sign| Vector3::ith(k, sign)));
        let apart = sides.map(|u: Vector3<f64>| self.along(&u) - travel.along(&u));
        apart.fold(f64::NEG_INFINITY, f64::max)
    }

    /// The least shift that separates two solids that overlap is at most this long: the least overlap along some
    /// directions, and near the best of them.
    pub fn depth(&self, start: Vector3<f64>) -> f64 {
        let overlap = |u: &Vector3<f64>| -self.along(u);
        let grid = (0..27)
            .filter(|k| *k != 13)
            .map(|k| Vector3::new(f64::from(k / 9 - 1), f64::from(k / 3 % 3 - 1), f64::from(k % 3 - 1)).normalize());
        let turned = grid.clone().map(|u| self.frame.turn * u);
        let starts = grid.clone().chain(turned).chain([start]);
        let mut starts: Vec<(f64, Vector3<f64>)> = starts.map(|u| (overlap(&u), u)).collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let refined = starts.into_iter().take(4).map(|mut best| {
            let mut step = 0.3;
            while step > 1e-3 {
                let around = grid.clone().map(|d| (best.1 + step * d).normalize());
                match around.map(|u| (overlap(&u), u)).find(|next| next.0 < best.0) {
                    Some(next) => best = next,
                    None => step *= 0.5,
                }
            }
            best.0
        });
        refined.fold(f64::INFINITY, f64::min).max(0.0)
    }
}

/// The point of a simplex that is closest to 0. Leaves those corners that are needed for it: all four if 0 is inside.
fn closest(simplex: &mut SmallVec<[Vector3<f64>; 4]>) -> Vector3<f64> {
    let corners = simplex.clone();
    let best = match corners[..] {
        [a] => (a, smallvec::smallvec![a]),
        [a, b] => of_segment(a, b),
        [a, b, c] => of_triangle(a, b, c),
        [a, b, c, d] => match of_tetrahedron([a, b, c, d]) {
            Some(found) => found,
            None => return Vector3::zeros(),
        },
        _ => return Vector3::zeros(),
    };
    *simplex = best.1;
    best.0
}

type Found = (Vector3<f64>, SmallVec<[Vector3<f64>; 4]>);

fn nearer(a: Found, b: Found) -> Found {
    if b.0.norm_squared() < a.0.norm_squared() { b } else { a }
}

fn of_segment(a: Vector3<f64>, b: Vector3<f64>) -> Found {
    let way = b - a;
    let size = way.norm_squared();
    let s = if size > 0.0 { -a.dot(&way) / size } else { 0.0 };
    if s <= 0.0 {
        (a, smallvec::smallvec![a])
    } else if s >= 1.0 {
        (b, smallvec::smallvec![b])
    } else {
        (a + way * s, smallvec::smallvec![a, b])
    }
}

fn of_triangle(a: Vector3<f64>, b: Vector3<f64>, c: Vector3<f64>) -> Found {
    let normal = (b - a).cross(&(c - a));
    let size = normal.norm_squared();
    // Whether the foot of 0 is within the side from p to q.
    let within = |p: &Vector3<f64>, q: &Vector3<f64>| normal.dot(&(q - p).cross(&-p)) >= 0.0;
    if size > 0.0 && within(&a, &b) && within(&b, &c) && within(&c, &a) {
        return (normal * (a.dot(&normal) / size), smallvec::smallvec![a, b, c]);
    }
    nearer(nearer(of_segment(a, b), of_segment(b, c)), of_segment(c, a))
}

/// `None` if 0 is inside.
fn of_tetrahedron([a, b, c, d]: [Vector3<f64>; 4]) -> Option<Found> {
    let faces = [[a, b, c, d], [a, c, d, b], [a, d, b, c], [b, d, c, a]];
    let outside = |[p, q, r, opposite]: &[Vector3<f64>; 4]| {
        let normal = (q - p).cross(&(r - p));
        let side = normal.dot(&(opposite - p));
        // Flat ones have no inside.
        side * normal.dot(p) > 0.0 || side.abs() <= 1e-12 * normal.norm() * (opposite - p).norm()
    };
    let found = faces.iter().filter(|face| outside(face));
    found.map(|[p, q, r, _]| of_triangle(*p, *q, *r)).reduce(nearer)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(centre: [f64; 3], half: f64) -> Convex {
        Convex::Block {
            min: centre.map(|c| c - half),
            max: centre.map(|c| c + half),
        }
    }

    fn gap(a: &Convex, b: &Convex) -> Gap {
        let frame = &Rigid::IDENTITY;
        Pair { a, b, frame }.gap(&Vector3::x(), |_| f64::INFINITY)
    }

    #[test]
    fn blocks_of_known_distance() {
        let still = block([0.0; 3], 10.0);
        for (centre, distance) in [
            ([25.0, 0.0, 0.0], 10.0),
            ([25.0, 25.0, 0.0], 200.0_f64.sqrt()),
            ([25.0, 25.0, 25.0], 300.0_f64.sqrt()),
            ([14.0, 0.0, 0.0], 0.0),
            ([1.0, 2.0, 3.0], 0.0),
            ([0.0; 3], 0.0),
        ] {
            let found = gap(&still, &block(centre, 5.0));
            assert!((found.high - distance).abs() < 1e-3, "{centre:?}: {found:?}");
            assert!(
                distance == 0.0 || (found.low - distance).abs() < 1e-3,
                "{centre:?}: {found:?}"
            );
        }
    }
}
