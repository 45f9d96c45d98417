//! The convex hull of a ball end at two places: a tetrahedron, each of whose points is the centre of a ball. Exact
//! between poses that do not turn.

use super::cutter::{AxisLine, Cutter, Place, ball};
use nalgebra::Vector3;

/// The corners' pairs and triples.
const EDGES: [[usize; 2]; 6] = [[0, 1], [2, 3], [0, 2], [1, 3], [0, 3], [1, 2]];
const FACES: [[usize; 3]; 4] = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];

/// The hull of two placed ball ends. The tops are rounded, too; they are above the stock in all that is studied here.
pub struct Hull {
    corners: [Vector3<f64>; 4],
    edges: Vec<(Place, f64)>,
    /// Corners, unit normal.
    faces: Vec<([Vector3<f64>; 3], Vector3<f64>)>,
    radius: f64,
}

impl Hull {
    pub fn new(cutter: &Cutter, from: &Place, to: &Place) -> Self {
        let (low, high) = (cutter.radius, cutter.length);
        let corners = [from.point(low), from.point(high), to.point(low), to.point(high)];
        let edges = EDGES.map(|[a, b]| {
            let along = corners[b] - corners[a];
            let place = Place {
                tip: corners[a],
                axis: along.try_normalize(1e-12)?,
                turn: from.turn,
            };
            Some((place, along.norm()))
        });
        let faces = FACES.map(|face| {
            let [a, b, c] = face.map(|k| corners[k]);
            let (u, v) = (b - a, c - a);
            // A sliver has the cylinders about its edges.
            let normal = u.cross(&v).try_normalize(1e-12 * (1.0 + u.norm() * v.norm()))?;
            Some(([a, b, c], normal))
        });
        Self {
            corners,
            edges: edges.into_iter().flatten().collect(),
            faces: faces.into_iter().flatten().collect(),
            radius: cutter.radius,
        }
    }

    /// The rectangle over it.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|k| {
            let places = self.corners.iter().map(|corner| corner[k]);
            let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
                (low.min(at), high.max(at))
            });
            [low - self.radius, high + self.radius]
        })
    }

    /// The interval in which the vertical line through `(x, y)` lies inside it.
    pub fn cut(&self, line: [f64; 2]) -> Option<[f64; 2]> {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        let mut add = |low: f64, high: f64| range = [range[0].min(low), range[1].max(high)];
        for corner in &self.corners {
            if let Some([low, high]) = ball(*corner, self.radius, line) {
                add(low, high);
            }
        }
        for (place, length) in &self.edges {
            if let Some([low, high]) = AxisLine::new(place, line).cylinder(self.radius, [0.0, *length]) {
                add(low, high);
            }
        }
        for (corners, normal) in &self.faces {
            for side in [self.radius, -self.radius] {
                let at = corners.map(|corner| corner + normal * side);
                if let Some(z) = height(&at, line) {
                    add(z, z);
                }
            }
        }
        (range[0] < range[1]).then_some(range)
    }

    /// The signed distance of a point outside the tetrahedron.
    pub fn distance(&self, p: &Vector3<f64>) -> f64 {
        let mut least = f64::INFINITY;
        for (place, length) in &self.edges {
            let from = p - place.tip;
            let along = from.dot(&place.axis).clamp(0.0, *length);
            least = least.min((from - place.axis * along).norm());
        }
        for (corners, normal) in &self.faces {
            let away = (p - corners[0]).dot(normal);
            let foot = p - normal * away;
            let sides = [0, 1, 2].map(|k| {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                (b - a).cross(&(foot - a)).dot(normal)
            });
            if sides.iter().all(|side| *side >= 0.0) {
                least = least.min(away.abs());
            }
        }
        least - self.radius
    }
}

/// The height of a triangle over a point, if it is over it.
fn height(corners: &[Vector3<f64>; 3], [x, y]: [f64; 2]) -> Option<f64> {
    let area = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let [a, b, c] = corners.map(|corner| [corner.x, corner.y]);
    let whole = area(a, b, c);
    let shares = [area([x, y], b, c), area(a, [x, y], c), area(a, b, [x, y])].map(|part| part / whole);
    let inside = shares.iter().all(|share| *share >= 0.0);
    inside.then(|| (0..3).map(|k| shares[k] * corners[k].z).sum())
}
