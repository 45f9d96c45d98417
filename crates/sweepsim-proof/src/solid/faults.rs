//! Where triangles do not enclose a solid: they cross each other, or lie on each other.

use nalgebra::Vector3;
use rayon::prelude::*;

type Corners = [Vector3<f64>; 3];

/// Why triangles do not enclose a solid at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Fault {
    /// Two triangles cross each other, at about this place.
    Crossing([f64; 3]),
    /// Two triangles have the same corners; the middle of these.
    Doubled([f64; 3]),
}

/// A box with the triangles in it: those of a leaf, or two halves.
struct Node {
    low: Vector3<f64>,
    high: Vector3<f64>,
    first: usize,
    last: usize,
    halves: Option<[usize; 2]>,
}

const LEAF: usize = 4;
/// Crossings of less than this part of a triangle's size are roundings of corners that meet.
const TOUCHING: f64 = 1e-9;

struct Tree<'a> {
    triangles: &'a [Corners],
    order: Vec<usize>,
    nodes: Vec<Node>,
}

/// The places where triangles cross or cover each other, at most so many.
pub(super) fn faults(triangles: &[Corners], most: usize) -> Vec<Fault> {
    let mut tree = Tree {
        triangles,
        order: (0..triangles.len()).collect(),
        nodes: Vec::new(),
    };
    if !triangles.is_empty() {
        tree.build(0, triangles.len());
    }
    let of_one = |number: usize| tree.faults_of(number);
    let mut all: Vec<Fault> = (0..triangles.len()).into_par_iter().flat_map_iter(of_one).collect();
    all.truncate(most);
    all
}

fn bounds(corners: &Corners) -> (Vector3<f64>, Vector3<f64>) {
    let [a, b, c] = corners;
    (a.inf(b).inf(c), a.sup(b).sup(c))
}

impl Tree<'_> {
    fn build(&mut self, first: usize, last: usize) -> usize {
        let (mut low, mut high) = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
        for number in &self.order[first..last] {
            let own = bounds(&self.triangles[*number]);
            (low, high) = (low.inf(&own.0), high.sup(&own.1));
        }
        let halves = (last - first > LEAF).then(|| {
            let axis = (high - low).imax();
            let middle = usize::midpoint(first, last);
            let triangles = self.triangles;
            let key = |number: &usize| triangles[*number].iter().map(|corner| corner[axis]).sum::<f64>();
            self.order[first..last].select_nth_unstable_by(middle - first, |a, b| key(a).total_cmp(&key(b)));
            [self.build(first, middle), self.build(middle, last)]
        });
        self.nodes.push(Node {
            low,
            high,
            first,
            last,
            halves,
        });
        self.nodes.len() - 1
    }

    /// The faults of a triangle with later ones.
    fn faults_of(&self, number: usize) -> Vec<Fault> {
        let own = &self.triangles[number];
        let (low, high) = bounds(own);
        let (mut open, mut found) = (vec![self.nodes.len() - 1], Vec::new());
        while let Some(node) = open.pop() {
            let node = &self.nodes[node];
            if (0..3).any(|k| node.low[k] > high[k] || node.high[k] < low[k]) {
                continue;
            }
            match node.halves {
                Some(halves) => open.extend(halves),
                None => {
                    let others = self.order[node.first..node.last]
                        .iter()
                        .filter(|other| **other > number);
                    found.extend(others.filter_map(|other| fault(own, &self.triangles[*other])));
                }
            }
        }
        found
    }
}

fn fault(one: &Corners, other: &Corners) -> Option<Fault> {
    let shared = one.iter().filter(|corner| other.contains(corner)).count();
    if shared == 3 {
        return Some(Fault::Doubled((one.iter().sum::<Vector3<f64>>() / 3.0).into()));
    }
    // Triangles with a common edge lie on each other or meet only there; the former encloses nothing and does no harm.
    if shared == 2 {
        return None;
    }
    let edges = |t: &Corners| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
    let through = |edge: (Vector3<f64>, Vector3<f64>), t: &Corners| {
        // An edge that begins at a common corner meets the triangle there.
        let common = t.contains(&edge.0) || t.contains(&edge.1);
        if common { None } else { crossing(edge, t) }
    };
    let own = edges(one).into_iter().find_map(|edge| through(edge, other));
    let place = own.or_else(|| edges(other).into_iter().find_map(|edge| through(edge, one)));
    place.map(|place| Fault::Crossing(place.into()))
}

/// Where an edge passes through a triangle, away from its sides.
fn crossing((p, q): (Vector3<f64>, Vector3<f64>), [a, b, c]: &Corners) -> Option<Vector3<f64>> {
    let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
    let size = (b - a).norm().max((c - a).norm()).max((q - p).norm());
    let (u, v) = (normal.dot(&(p - a)), normal.dot(&(q - a)));
    let least = TOUCHING * size;
    if !(u > least && v < -least || u < -least && v > least) {
        return None;
    }
    let at = p + (q - p) * (u / (u - v));
    let inside = [(a, b), (b, c), (c, a)].iter().all(|(from, to)| {
        let inwards = normal.cross(&(*to - *from));
        inwards.dot(&(at - *from)) > least * inwards.norm()
    });
    inside.then_some(at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_dexel::TriangleSoup;

    fn of(blocks: &[[[f64; 3]; 2]]) -> Vec<Fault> {
        let soups = blocks.iter().map(|[low, high]| TriangleSoup::block(*low, *high));
        let triangles: Vec<Corners> = soups
            .flat_map(|soup| soup.triangles)
            .map(|corners| corners.map(Vector3::from))
            .collect();
        faults(&triangles, 100)
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
            let Fault::Crossing([x, y, z]) = fault else {
                panic!("{fault:?}")
            };
            assert!((x - 2.0).abs() < 1e-12 && (1.0..=2.0).contains(&y) && (1.0..=2.0).contains(&z));
        }
        assert!(of(&[one, one]).iter().any(|fault| matches!(fault, Fault::Doubled(_))));
    }
}
