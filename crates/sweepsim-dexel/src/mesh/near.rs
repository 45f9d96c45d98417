//! A certificate that one surface is near another.

use super::{DistanceTo, TriangleSoup};
use crate::vector::{dot, length, sub};
use rayon::prelude::*;
use smallvec::SmallVec;

/// The most parts that one triangle is divided into.
const PARTS: usize = 1 << 16;
/// How many times larger than the triangle nearest to it a part may be to be cut along its edges.
const LARGER: f64 = 4.0;

/// Whether every point of a surface is certainly no further than `most` from another one.
pub(super) fn is_certainly_within(surface: &TriangleSoup, other: &DistanceTo, most: f64) -> bool {
    surface
        .triangles
        .par_iter()
        .all(|triangle| is_near(*triangle, other, most))
}

/// Whether a triangle is near another surface, by parts. A part is, if all its corners are near the same triangle: what
/// is near a convex set is convex. It is, too, if it is so small that all of it is near the point nearest to its
/// middle. Others are cut along the edges of the triangle nearest to their middle, or in halves while they are much
/// larger than that.
fn is_near(triangle: [[f64; 3]; 3], other: &DistanceTo, most: f64) -> bool {
    let mut open = vec![ConvexPolygon::from_slice(&triangle)];
    let mut parts = 0;
    while let Some(part) = open.pop() {
        parts += 1;
        let count = part.len() as f64;
        let middle = [0, 1, 2].map(|k| part.iter().map(|p| p[k]).sum::<f64>() / count);
        let radius = reach(&part, middle);
        let Some(near) = other.nearest_triangle(middle) else {
            return false;
        };
        // Not a number is not near.
        if !(near.distance <= most) || parts > PARTS {
            return false;
        }
        let all_near = |part: &ConvexPolygon| part.iter().all(|p| near.distance_of(*p) <= most);
        if near.distance + radius <= most || all_near(&part) {
            continue;
        }
        if radius <= LARGER * reach(&near.corners, near.corners[0]) {
            let mut inside = part.clone();
            let mut beyond = Vec::new();
            for (corner, normal) in near.corners.iter().zip(near.inwards) {
                let (kept, cut_off) = cut(&inside, *corner, normal);
                beyond.extend(cut_off);
                inside = kept.unwrap_or_default();
            }
            // Something has been settled, so that this ends.
            if !inside.is_empty() && !beyond.is_empty() && all_near(&inside) {
                open.extend(beyond);
                continue;
            }
        }
        let Some((one, other)) = halves(&part) else {
            return false;
        };
        open.extend([one, other]);
    }
    true
}

/// A convex polygon.
type ConvexPolygon = SmallVec<[[f64; 3]; 8]>;

/// How far its corners are from a point.
fn reach(corners: &[[f64; 3]], from: [f64; 3]) -> f64 {
    corners.iter().map(|p| length(sub(*p, from))).fold(0.0, f64::max)
}

/// The pieces of a polygon on the side of a plane that its normal points to, and on the other. What is on the plane but
/// for rounding is on it, and a polygon that is altogether is on the first side.
fn cut(part: &ConvexPolygon, place: [f64; 3], normal: [f64; 3]) -> (Option<ConvexPolygon>, Option<ConvexPolygon>) {
    let size = part
        .iter()
        .chain([&place])
        .flatten()
        .fold(0.0, |size: f64, c| size.max(c.abs()));
    let rounding = 1e-14 * size * length(normal);
    let sides = part.iter().map(|p| dot(normal, sub(*p, place)));
    let sides: SmallVec<[f64; 8]> = sides
        .map(|side| if side.abs() <= rounding { 0.0 } else { side })
        .collect();
    if sides.iter().all(|side| *side >= 0.0) {
        return (Some(part.clone()), None);
    }
    if sides.iter().all(|side| *side <= 0.0) {
        return (None, Some(part.clone()));
    }
    let (mut inside, mut outside) = (ConvexPolygon::new(), ConvexPolygon::new());
    for (k, p) in part.iter().enumerate() {
        let next = (k + 1) % part.len();
        let (here, there) = (sides[k], sides[next]);
        if here >= 0.0 {
            inside.push(*p);
        }
        if here <= 0.0 {
            outside.push(*p);
        }
        if here * there < 0.0 {
            let s = here / (here - there);
            let between = [0, 1, 2].map(|c| p[c] + s * (part[next][c] - p[c]));
            inside.push(between);
            outside.push(between);
        }
    }
    (Some(inside), Some(outside))
}

/// The halves of a polygon, across its longest diagonal or side; `None` if it is a point.
fn halves(part: &ConvexPolygon) -> Option<(ConvexPolygon, ConvexPolygon)> {
    let pairs = (0..part.len()).flat_map(|a| (a + 1..part.len()).map(move |b| (a, b)));
    let apart = |&(a, b): &(usize, usize)| length(sub(part[b], part[a]));
    let (a, b) = pairs.max_by(|one, other| apart(one).total_cmp(&apart(other)))?;
    let along = sub(part[b], part[a]);
    let half = [0, 1, 2].map(|k| part[a][k] + 0.5 * along[k]);
    let (one, other) = cut(part, half, along);
    one.zip(other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_certificate_sees_what_lies_between_corners() {
        let flat = |height: f64| TriangleSoup {
            triangles: vec![
                [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [2.0, 2.0, height]],
                [[4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [2.0, 2.0, height]],
                [[4.0, 4.0, 0.0], [0.0, 4.0, 0.0], [2.0, 2.0, height]],
                [[0.0, 4.0, 0.0], [0.0, 0.0, 0.0], [2.0, 2.0, height]],
            ],
        };
        let plane = TriangleSoup {
            triangles: vec![
                [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0]],
                [[4.0, 4.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 0.0]],
            ],
        };
        // All four corners of the plane lie on the pyramid.
        for (height, near) in [(0.09, true), (0.11, false), (3.0, false)] {
            let pyramid = flat(height);
            let (to_plane, to_pyramid) = (DistanceTo::new(&plane).unwrap(), DistanceTo::new(&pyramid).unwrap());
            assert_eq!(is_certainly_within(&pyramid, &to_plane, 0.1), near);
            assert_eq!(is_certainly_within(&plane, &to_pyramid, 0.1), near);
        }
    }
}
