//! Where triangles do not enclose a solid: they cross each other, or lie on each other.

use super::TriangleSoup;
use super::tree::{self, TreeNode};
use crate::vector::{cross, dot, length, normal_of, sub};
use rayon::prelude::*;

type Corners = [[f64; 3]; 3];

/// Why triangles do not enclose a solid at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum MeshFault {
    /// Two triangles cross each other, at about this place.
    Crossing([f64; 3]),
    /// Two triangles have the same corners; the middle of these.
    Doubled([f64; 3]),
}

/// Crossings of less than this part of a triangle's size are roundings of corners that meet.
const TOUCHING: f64 = 1e-9;

impl TriangleSoup {
    /// The places where triangles cross or cover each other, at most so many.
    ///
    /// ```
    /// use sweepsim_dexel::TriangleSoup;
    /// let mut blocks = TriangleSoup::block([0.0; 3], [2.0, 3.0, 4.0]);
    /// assert!(blocks.faults(10).is_empty());
    /// blocks.triangles.extend(TriangleSoup::block([1.0; 3], [3.0, 2.0, 2.0]).triangles);
    /// assert!(!blocks.faults(10).is_empty());
    /// ```
    #[must_use]
    pub fn faults(&self, most: usize) -> Vec<MeshFault> {
        let mut all: Vec<MeshFault> = pairs(&self.triangles).into_iter().map(|(_, fault)| fault).collect();
        all.truncate(most);
        all
    }
}

/// The pairs of triangles that cross or cover each other, with the place; in order.
pub(crate) fn pairs(triangles: &[Corners]) -> Vec<([u32; 2], MeshFault)> {
    let (order, nodes) = tree::over(triangles.iter().copied());
    let of_one = |number: u32| {
        let mut found = Vec::new();
        // Without area, a triangle has no side.
        if normal_of(triangles[number as usize]) != [0.0; 3] {
            faults_of(triangles, (&order, &nodes), number, &mut found);
        }
        found
    };
    let all = (0..triangles.len() as u32).into_par_iter();
    all.flat_map_iter(of_one).collect()
}

/// The faults of a triangle with later ones.
fn faults_of(
    triangles: &[Corners],
    (order, nodes): (&[u32], &[TreeNode]),
    number: u32,
    found: &mut Vec<([u32; 2], MeshFault)>,
) {
    let own = &triangles[number as usize];
    let (low, high) = bounds(own);
    let meets = |other: &Corners| {
        let (from, to) = bounds(other);
        (0..3).all(|k| from[k] <= high[k] && to[k] >= low[k])
    };
    let mut open = vec![0];
    while let Some(node) = open.pop() {
        let TreeNode {
            low: from,
            high: to,
            first,
            count,
        } = &nodes[node];
        if (0..3).any(|k| from[k] > high[k] || to[k] < low[k]) {
            continue;
        }
        let first = *first as usize;
        if *count == 0 {
            open.extend([first, node + 1]);
        }
        for other in &order[first..first + *count as usize] {
            // A long triangle is in several leaves.
            let pair = [number, *other];
            if *other > number
                && meets(&triangles[*other as usize])
                && let Some(fault) = fault(own, &triangles[*other as usize])
                && found.iter().all(|(known, _)| *known != pair)
            {
                found.push((pair, fault));
            }
        }
    }
}

fn bounds([a, b, c]: &Corners) -> ([f64; 3], [f64; 3]) {
    let end = |of: fn(f64, f64) -> f64| [0, 1, 2].map(|k| of(a[k], of(b[k], c[k])));
    (end(f64::min), end(f64::max))
}

fn fault(one: &Corners, other: &Corners) -> Option<MeshFault> {
    if normal_of(*other) == [0.0; 3] {
        return None;
    }
    let shared = one.iter().filter(|corner| other.contains(corner)).count();
    if shared == 3 {
        let middle = [0, 1, 2].map(|k| one.iter().map(|corner| corner[k]).sum::<f64>() / 3.0);
        return Some(MeshFault::Doubled(middle));
    }
    // Triangles with a common edge lie on each other or meet only there; the former encloses nothing and does no harm.
    if shared == 2 {
        return None;
    }
    let edges = |t: &Corners| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
    let through = |edge: ([f64; 3], [f64; 3]), t: &Corners| {
        // An edge that begins at a common corner meets the triangle there.
        let common = t.contains(&edge.0) || t.contains(&edge.1);
        if common { None } else { crossing(edge, t) }
    };
    let own = edges(one).into_iter().find_map(|edge| through(edge, other));
    let place = own.or_else(|| edges(other).into_iter().find_map(|edge| through(edge, one)));
    place.map(MeshFault::Crossing)
}

/// Where an edge passes through a triangle, away from its sides.
fn crossing((p, q): ([f64; 3], [f64; 3]), [a, b, c]: &Corners) -> Option<[f64; 3]> {
    let way = sub(q, p);
    let size = length(sub(*b, *a)).max(length(sub(*c, *a))).max(length(way));
    let normal = normal_of([*a, *b, *c]);
    let area = length(normal);
    let normal = (area > 0.0).then(|| normal.map(|c| c / area))?;
    let (u, v) = (dot(normal, sub(p, *a)), dot(normal, sub(q, *a)));
    let least = TOUCHING * size;
    if !(u > least && v < -least || u < -least && v > least) {
        return None;
    }
    let at = [0, 1, 2].map(|k| p[k] + way[k] * (u / (u - v)));
    let inside = [(a, b), (b, c), (c, a)].iter().all(|(from, to)| {
        let inwards = cross(normal, sub(**to, **from));
        dot(inwards, sub(at, **from)) > least * length(inwards)
    });
    inside.then_some(at)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(blocks: &[[[f64; 3]; 2]]) -> Vec<MeshFault> {
        let soups = blocks.iter().map(|[low, high]| TriangleSoup::block(*low, *high));
        let triangles = soups.flat_map(|soup| soup.triangles).collect();
        TriangleSoup { triangles }.faults(100)
    }

    #[test]
    fn blocks_that_stand_apart_or_touch_are_solids() {
        let one = [[0.0; 3], [2.0, 3.0, 4.0]];
        assert_eq!(of(&[one]), []);
        assert_eq!(of(&[one, [[2.5, 0.0, 0.0], [3.0, 1.0, 1.0]]]), []);
        assert_eq!(of(&[one, [[2.0, 0.5, 0.5], [3.0, 1.0, 1.0]]]), []);
    }

    #[test]
    fn crossings_and_doubled_faces_are_found() {
        let one = [[0.0; 3], [2.0, 3.0, 4.0]];
        let crossing = of(&[one, [[1.0, 1.0, 1.0], [3.0, 2.0, 2.0]]]);
        assert!(!crossing.is_empty());
        for fault in crossing {
            let MeshFault::Crossing([x, y, z]) = fault else {
                panic!("{fault:?}")
            };
            assert!((x - 2.0).abs() < 1e-12 && (1.0..=2.0).contains(&y) && (1.0..=2.0).contains(&z));
        }
        assert!(
            of(&[one, one])
                .iter()
                .any(|fault| matches!(fault, MeshFault::Doubled(_)))
        );
    }
}
