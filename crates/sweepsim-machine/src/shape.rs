//! Convex solids, and bodies made of them.

use nalgebra::{Unit, Vector3};

/// A convex solid, in the coordinates of its link.
#[derive(Clone, Debug, PartialEq)]
pub enum Convex {
    /// An upright block between two corners.
    Block {
        /// Lower corner.
        min: [f64; 3],
        /// Upper corner.
        max: [f64; 3],
    },
    /// The convex hull of points.
    Hull(Vec<[f64; 3]>),
    /// The convex hull of circles about an axis: cylinders, cones, and what is turned.
    Turned {
        /// A point of the axis.
        base: [f64; 3],
        /// The direction of the axis.
        axis: Unit<Vector3<f64>>,
        /// Radius and height along the axis of each circle.
        circles: Vec<[f64; 2]>,
    },
    /// A triangle.
    Triangle([[f64; 3]; 3]),
}

fn farthest(points: &[[f64; 3]], u: &Vector3<f64>) -> Vector3<f64> {
    let points = points.iter().map(|p| Vector3::from(*p));
    let best = points.max_by(|a, b| a.dot(u).total_cmp(&b.dot(u)));
    best.unwrap_or_default()
}

impl Convex {
    /// What is turned about an axis of any length, as cones one above the other between circles of radius and height.
    #[must_use]
    pub fn cones(base: [f64; 3], axis: Vector3<f64>, outline: &[[f64; 2]]) -> Vec<Self> {
        let axis = Unit::new_normalize(axis);
        let cone = |pair: &[[f64; 2]]| Self::Turned {
            base,
            axis,
            circles: pair.to_vec(),
        };
        outline.windows(2).map(cone).collect()
    }

    /// Whether it is not empty.
    fn has_points(&self) -> bool {
        match self {
            Self::Block { .. } | Self::Triangle(_) => true,
            Self::Hull(points) => !points.is_empty(),
            Self::Turned { circles, .. } => !circles.is_empty(),
        }
    }

    /// The point that is farthest along `u`.
    pub(crate) fn support(&self, u: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Block { min, max } => Vector3::from_fn(|k, _| if u[k] < 0.0 { min[k] } else { max[k] }),
            Self::Hull(points) => farthest(points, u),
            Self::Triangle(corners) => farthest(corners, u),
            Self::Turned { base, axis, circles } => {
                let axis = axis.into_inner();
                let up = u.dot(&axis);
                let out = u - axis * up;
                let across = out.norm();
                let best = circles
                    .iter()
                    .max_by(|a, b| (a[0] * across + a[1] * up).total_cmp(&(b[0] * across + b[1] * up)));
                let [radius, height] = best.copied().unwrap_or_default();
                let out = if across > 0.0 { out / across } else { Vector3::zeros() };
                Vector3::from(*base) + axis * height + out * radius
            }
        }
    }

    /// Lower and upper corner of the box around it.
    pub(crate) fn extent(&self) -> [Vector3<f64>; 2] {
        let side = |k: usize, sign: f64| {
            let mut u = Vector3::zeros();
            u[k] = sign;
            self.support(&u)[k]
        };
        [-1.0, 1.0].map(|sign| Vector3::from_fn(|k, _| side(k, sign)))
    }
}

/// A body of a machine: convex solids on one link.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// The link that it is on.
    pub link: usize,
    /// The moves, by number, during which it is there.
    pub moves: std::ops::Range<usize>,
    /// Triangles, whose solid is what they enclose.
    pub(crate) hollow: bool,
    pub(crate) nodes: Vec<Node>,
}

/// A solid around a part of a body, or one of its solids.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub solid: Convex,
    pub centre: Vector3<f64>,
    pub radius: f64,
    /// Where the parts are that it is divided into.
    pub parts: Option<[usize; 2]>,
}

impl Body {
    /// A body of convex solids that is always there.
    ///
    /// Triangles are taken as a surface, and the body is what they enclose. Solids without points are left out. `None`
    /// if no solid is left, or a number is not finite.
    #[must_use]
    pub fn new(name: impl Into<String>, link: usize, solids: Vec<Convex>) -> Option<Self> {
        let hollow = solids.iter().any(|solid| matches!(solid, Convex::Triangle(_)));
        let mut items: Vec<(Convex, [Vector3<f64>; 2])> = Vec::with_capacity(solids.len());
        for solid in solids.into_iter().filter(Convex::has_points) {
            let extent = solid.extent();
            if !extent.iter().all(|corner| corner.iter().all(|c| c.is_finite())) {
                return None;
            }
            items.push((solid, extent));
        }
        let mut nodes = Vec::with_capacity(2 * items.len());
        if items.is_empty() {
            return None;
        }
        grow(&mut nodes, items);
        Some(Self {
            name: name.into(),
            link,
            moves: 0..usize::MAX,
            hollow,
            nodes,
        })
    }

    /// The same, there only during some moves.
    #[must_use]
    pub fn during(self, moves: std::ops::Range<usize>) -> Self {
        Self { moves, ..self }
    }

    /// Lower and upper corner of the box around it, on its link.
    #[must_use]
    pub fn extent(&self) -> [[f64; 3]; 2] {
        self.nodes[0].solid.extent().map(Into::into)
    }

    /// Its solids.
    pub fn solids(&self) -> impl Iterator<Item = &Convex> {
        self.nodes
            .iter()
            .filter(|node| node.parts.is_none())
            .map(|node| &node.solid)
    }
}

/// Halves along the longest side of the box, down to single solids. Returns where the root is.
fn grow(nodes: &mut Vec<Node>, mut items: Vec<(Convex, [Vector3<f64>; 2])>) -> usize {
    let low = items
        .iter()
        .fold(Vector3::repeat(f64::INFINITY), |low, (_, e)| low.inf(&e[0]));
    let high = items
        .iter()
        .fold(Vector3::repeat(f64::NEG_INFINITY), |high, (_, e)| high.sup(&e[1]));
    let place = nodes.len();
    let node = |solid| Node {
        solid,
        centre: 0.5 * (low + high),
        radius: 0.5 * (high - low).norm(),
        parts: None,
    };
    if items.len() == 1 {
        nodes.extend(items.pop().map(|(solid, _)| node(solid)));
        return place;
    }
    nodes.push(node(Convex::Block {
        min: low.into(),
        max: high.into(),
    }));
    let axis = (high - low).imax();
    items.sort_by(|a, b| (a.1[0][axis] + a.1[1][axis]).total_cmp(&(b.1[0][axis] + b.1[1][axis])));
    let rest = items.split_off(items.len() / 2);
    let parts = [items, rest].map(|items| grow(nodes, items));
    nodes[place].parts = Some(parts);
    place
}
