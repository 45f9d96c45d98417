//! Closes small holes of a solid's triangles.
//!
//! Where corners of a face are nearly in line, the library's triangulation leaves a thin triangle out, and the solid
//! is open by three or four edges. Each loop of open edges is closed by triangles between its own corners, so that the
//! mesh closes to the bit; that what it then encloses is right is checked against the volume of the surfaces.

use std::collections::BTreeMap;

type Point = [f64; 3];
type Key = [u64; 3];

/// The most corners of a hole, and the most holes of a solid.
const MOST_CORNERS: usize = 32;
const MOST_HOLES: usize = 1000;

/// Triangles that close the holes, each with the place of a triangle beside it; `None` if they are no simple loops.
pub(super) fn holes(triangles: &[[Point; 3]]) -> Option<Vec<([Point; 3], usize)>> {
    let key = |p: Point| p.map(|c| (c + 0.0).to_bits());
    // How often each edge is there in either direction, and the last triangle that has it.
    let mut edges: BTreeMap<(Key, Key), (i32, usize)> = BTreeMap::new();
    let mut places: BTreeMap<Key, Point> = BTreeMap::new();
    for (number, corners) in triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (key(corners[k]), key(corners[(k + 1) % 3]));
            let (edge, sign) = if a < b { ((a, b), 1) } else { ((b, a), -1) };
            if a != b {
                let entry = edges.entry(edge).or_default();
                *entry = (entry.0 + sign, number);
            }
        }
    }
    edges.retain(|_, (count, _)| *count != 0);
    if edges.len() > MOST_HOLES * MOST_CORNERS {
        return None;
    }
    // What is missing runs against what is there.
    let mut next: BTreeMap<Key, Vec<(Key, usize)>> = BTreeMap::new();
    for ((a, b), (count, number)) in edges {
        let (from, to) = if count > 0 { (b, a) } else { (a, b) };
        for _ in 0..count.unsigned_abs() {
            next.entry(from).or_default().push((to, number));
        }
        for corner in triangles[number] {
            places.insert(key(corner), corner);
        }
    }
    let mut filled = Vec::new();
    while let Some((start, _)) = next.first_key_value().map(|(start, to)| (*start, to.len())) {
        // Walks until a corner comes again: what lies between is a loop.
        let mut walk = vec![(start, 0)];
        let loop_ = loop {
            let here = walk.last()?.0;
            let ways = next.get_mut(&here)?;
            let (to, number) = ways.pop()?;
            if ways.is_empty() {
                next.remove(&here);
            }
            if let Some(first) = walk.iter().position(|(corner, _)| *corner == to) {
                let loop_: Vec<Point> = walk[first..].iter().map(|(corner, _)| places[corner]).collect();
                // What was walked before the loop is still open.
                for pair in walk[..=first].windows(2) {
                    next.entry(pair[0].0).or_default().push((pair[1].0, pair[1].1));
                }
                break (loop_, number);
            }
            walk.push((to, number));
            if walk.len() > MOST_CORNERS {
                return None;
            }
        };
        filled.extend(ears(loop_.0)?.into_iter().map(|triangle| (triangle, loop_.1)));
    }
    Some(filled)
}

/// A flat polygon as triangles: the largest ear that holds no other corner is cut off, again and again. `None` if the
/// polygon crosses itself.
fn ears(mut corners: Vec<Point>) -> Option<Vec<[Point; 3]>> {
    let normal = corners.windows(2).skip(1).fold([0.0; 3], |sum, pair| {
        let cross = cross(minus(pair[0], corners[0]), minus(pair[1], corners[0]));
        [0, 1, 2].map(|k| sum[k] + cross[k])
    });
    let area = |a: Point, b: Point, c: Point| dot(cross(minus(b, a), minus(c, a)), normal);
    let mut found = Vec::new();
    while corners.len() > 3 {
        let count = corners.len();
        let ear = |k: usize| [corners[(k + count - 1) % count], corners[k], corners[(k + 1) % count]];
        let free = |k: &usize| {
            let [a, b, c] = ear(*k);
            let inside = |p: &Point| area(a, b, *p) > 0.0 && area(b, c, *p) > 0.0 && area(c, a, *p) > 0.0;
            area(a, b, c) >= 0.0 && !corners.iter().any(inside)
        };
        let size = |k: usize| {
            let [a, b, c] = ear(k);
            area(a, b, c)
        };
        let best = (0..count).filter(free).max_by(|k, l| size(*k).total_cmp(&size(*l)))?;
        found.push(ear(best));
        corners.remove(best);
    }
    let [a, b, c] = corners[..] else { return None };
    found.push([a, b, c]);
    Some(found)
}

fn minus(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|k: usize| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_dexel::TriangleSoup;

    /// A cube whose sides have `n` squares along each edge.
    fn cube(n: usize) -> Vec<[Point; 3]> {
        let at = |k: usize| k as f64 / n as f64;
        let mut triangles = Vec::new();
        for axis in 0..3 {
            for side in [0.0, 1.0] {
                let point = |u: usize, v: usize| {
                    let mut p = [0.0; 3];
                    (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (side, at(u), at(v));
                    p
                };
                for (u, v) in (0..n * n).map(|k| (k % n, k / n)) {
                    let [a, b, c, d] = [point(u, v), point(u + 1, v), point(u + 1, v + 1), point(u, v + 1)];
                    let square = [[a, b, c], [a, c, d]];
                    triangles.extend(square.map(|[a, b, c]| if side == 1.0 { [a, b, c] } else { [a, c, b] }));
                }
            }
        }
        triangles
    }

    /// Whatever one, two or three triangles are missing, the cube closes, and encloses what it did.
    #[test]
    fn a_cube_with_missing_triangles_closes() {
        let whole = cube(3);
        let mut cases = 0;
        for first in 0..whole.len() {
            for second in [first, first + 1, first + 6, first + 7] {
                let kept = whole
                    .iter()
                    .enumerate()
                    .filter(|(k, _)| *k != first && *k != second && *k != first + 40);
                let mut kept: Vec<[Point; 3]> = kept.map(|(_, triangle)| *triangle).collect();
                let added = holes(&kept).unwrap();
                kept.extend(added.iter().map(|(triangle, _)| *triangle));
                let soup = TriangleSoup { triangles: kept };
                soup.check_closed().unwrap();
                // Across an edge of the cube a corner is cut off: half a square's triangles at most.
                assert!(
                    (soup.volume() - 1.0).abs() < 0.03,
                    "{first} {second}: {}",
                    soup.volume()
                );
                cases += 1;
            }
        }
        assert_eq!(cases, 4 * 108);
        assert!(holes(&whole).unwrap().is_empty());
    }

    #[test]
    fn a_polygon_that_turns_in_is_cut_into_ears() {
        let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 1.0], [0.0, 4.0]].map(|[x, y]| [x, y, 7.0]);
        let found = ears(corners.to_vec()).unwrap();
        let sizes = found
            .iter()
            .map(|[a, b, c]| 0.5 * cross(minus(*b, *a), minus(*c, *a))[2]);
        assert!(sizes.clone().all(|size| size >= 0.0));
        assert!((sizes.sum::<f64>() - 10.0).abs() < 1e-12);
    }
}
