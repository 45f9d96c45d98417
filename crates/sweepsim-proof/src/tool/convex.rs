//! A convex solid of revolution, by its support function.

use nalgebra::Vector3;

/// So many corners are looked at one by one.
const FEW: usize = 8;

/// The hull of points and arcs in the half-plane `(ρ, ζ)`, turned about the axis `ρ = 0`.
///
/// All that a proof needs of it is the [support function](Self::support): how far it reaches in a direction.
#[derive(Clone, Debug, Default)]
pub struct Convex {
    /// Points `(ρ, ζ)`, `ρ ≥ 0`: those of their own hull, counter-clockwise from the lowest on the axis.
    pub(super) corners: Vec<[f64; 2]>,
    pub(super) arcs: Vec<ConvexArc>,
    /// Whether every point is one of the tool, so that a point of it is a witness.
    pub(super) exact: bool,
    /// Whether it holds part of a tool whose shape is not known well.
    pub(super) loose: bool,
    /// Whether it is inside of what the others cover.
    pub(super) core: bool,
    /// It is the hull of so many curves of the outline, or of one of so many parts of one.
    pub(super) cut: [usize; 2],
    /// Its part of the outline, from the tip to the top; none of a core.
    pub(super) pieces: Vec<Piece>,
}

/// A part of an outline.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Piece {
    Line([[f64; 2]; 2]),
    /// A convex arc of at most 90°.
    Arc {
        centre: [f64; 2],
        radius: f64,
        /// Of its ends, as seen from the centre.
        angles: [f64; 2],
    },
    /// Something in the hull of these, turned about the axis.
    Points(Vec<[f64; 2]>),
}

/// An arc with the material on the side of its centre, of at most 90°.
#[derive(Clone, Copy, Debug)]
pub(super) struct ConvexArc {
    pub centre: [f64; 2],
    pub radius: f64,
    /// Unit normals at its ends, counter-clockwise.
    pub normals: [[f64; 2]; 2],
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

impl Convex {
    /// Whether every point of it belongs to the tool that it is a part of. If not, it only bounds that part.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.exact
    }

    /// Whether it only says what a tool [holds](crate::cover_and_cores), and is inside of what covers it.
    #[must_use]
    pub fn is_core(&self) -> bool {
        self.core
    }

    /// Whether it may be much larger than the tool.
    #[must_use]
    pub fn is_loose(&self) -> bool {
        self.loose
    }

    /// The corners of the hull, `(ρ, ζ)`.
    #[must_use]
    pub fn corners(&self) -> &[[f64; 2]] {
        &self.corners
    }

    /// Its arcs, none longer than 90°: centre, radius, and the unit normals at both ends, counter-clockwise.
    pub fn arcs(&self) -> impl Iterator<Item = ([f64; 2], f64, [[f64; 2]; 2])> {
        self.arcs.iter().map(|arc| (arc.centre, arc.radius, arc.normals))
    }

    /// Its part of the tool's outline. All of them together are the surface of what is covered, or hold it.
    pub(crate) fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Of how many curves of its tool's outline it is the hull, and 1; or 1, and of one of how many parts of a curve.
    #[must_use]
    pub fn cut(&self) -> [usize; 2] {
        self.cut
    }

    /// The largest value of `⟨direction, x⟩` over the solid whose axis is a unit vector and whose tip is the origin.
    #[must_use]
    pub fn support(&self, direction: &Vector3<f64>, axis: &Vector3<f64>) -> f64 {
        let (own, _) = self.split(direction, axis);
        self.meridian_support(own).0
    }

    /// The point of the solid that reaches farthest in a direction, from the tip.
    #[must_use]
    pub fn farthest(&self, direction: &Vector3<f64>, axis: &Vector3<f64>) -> Vector3<f64> {
        let (own, across) = self.split(direction, axis);
        let [rho, zeta] = self.meridian_support(own).1;
        let radial = if own[0] > 0.0 {
            across / own[0]
        } else {
            Vector3::zeros()
        };
        axis * zeta + radial * rho
    }

    /// A direction as parts across and along the axis, and the vector across.
    fn split(&self, direction: &Vector3<f64>, axis: &Vector3<f64>) -> ([f64; 2], Vector3<f64>) {
        let along = direction.dot(axis);
        // Twice orthogonalised: exact to rounding of the direction itself.
        let across = direction - axis * along;
        let across = across - axis * across.dot(axis);
        ([across.norm(), along], across)
    }

    /// The largest `⟨direction, (ρ, ζ)⟩` for a direction with a first part of at least 0, and where it is.
    pub(super) fn meridian_support(&self, direction: [f64; 2]) -> (f64, [f64; 2]) {
        let mut best = (f64::NEG_INFINITY, [0.0; 2]);
        for corner in self.corners_towards(direction) {
            let value = dot(direction, *corner);
            if value > best.0 {
                best = (value, *corner);
            }
        }
        for arc in &self.arcs {
            let [from, to] = arc.normals;
            if cross(from, direction) >= 0.0 && cross(direction, to) >= 0.0 {
                let length = dot(direction, direction).sqrt();
                let value = dot(direction, arc.centre) + arc.radius * length;
                if value > best.0 && length > 0.0 {
                    let at = [0, 1].map(|k| arc.centre[k] + arc.radius * direction[k] / length);
                    best = (value, at);
                }
            }
        }
        best
    }

    /// The corners of which one reaches farthest in a direction with a first part of at least 0.
    fn corners_towards(&self, direction: [f64; 2]) -> &[[f64; 2]] {
        if self.corners.len() <= FEW {
            return &self.corners;
        }
        // From the lowest on the axis to the highest, they rise in that direction and fall again.
        let (mut low, mut high) = (0, self.corners.len() - 1);
        while low < high {
            let middle = usize::midpoint(low, high);
            let [a, b] = [self.corners[middle], self.corners[middle + 1]];
            if dot(direction, [b[0] - a[0], b[1] - a[1]]) > 0.0 {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        // But for rounding.
        &self.corners[low.saturating_sub(1)..self.corners.len().min(low + 2)]
    }

    /// Whether a point at `(ρ, ζ)` belongs to the solid.
    ///
    /// A point outside of a convex set is beyond it in the direction from the nearest of its points: across an edge, or
    /// away from a corner or the centre of an arc.
    #[must_use]
    pub fn contains(&self, point: [f64; 2]) -> bool {
        let from = |other: [f64; 2]| [point[0] - other[0], point[1] - other[1]];
        let around = self.corners.iter().skip(1).chain(self.corners.first());
        // The corners are in order: the outside is on the right.
        let edges = self.corners.iter().zip(around).map(|(a, b)| [b[1] - a[1], a[0] - b[0]]);
        let corners = self.corners.iter().map(|corner| from(*corner));
        let arcs = self.arcs.iter().map(|arc| from(arc.centre));
        let mut directions = edges.chain(corners).chain(arcs).filter(|direction| direction[0] >= 0.0);
        directions.all(|direction| dot(direction, point) <= self.meridian_support(direction).0)
    }

    /// The direction of a point from the nearest of the solid, in the half-plane; for one inside, there is none.
    #[must_use]
    pub fn away(&self, point: [f64; 2]) -> Option<[f64; 2]> {
        let from = |other: [f64; 2]| [point[0] - other[0], point[1] - other[1]];
        let next = self.corners.iter().cycle().skip(1);
        let of_side = |(a, b): (&[f64; 2], &[f64; 2])| {
            let way = [b[0] - a[0], b[1] - a[1]];
            let part = dot(from(*a), way) / dot(way, way).max(f64::MIN_POSITIVE);
            let part = part.clamp(0.0, 1.0);
            let off = from([a[0] + part * way[0], a[1] + part * way[1]]);
            // The outside is on the right.
            let is_out = cross(way, from(*a)) < 0.0;
            (off, is_out)
        };
        let sides = self.corners.iter().zip(next).map(of_side);
        let of_arc = |arc: &ConvexArc| {
            let off = from(arc.centre);
            let (length, [first, last]) = (dot(off, off).sqrt(), arc.normals);
            let is_beside = cross(first, off) >= 0.0 && cross(off, last) >= 0.0;
            (is_beside && length > arc.radius).then(|| off.map(|c| c * (1.0 - arc.radius / length)))
        };
        let arcs = self.arcs.iter().filter_map(of_arc);
        let all = sides.filter(|(_, is_out)| *is_out).map(|(off, _)| off).chain(arcs);
        let off = all.min_by(|a, b| dot(*a, *a).total_cmp(&dot(*b, *b)))?;
        let length = dot(off, off).sqrt();
        (length > 0.0).then(|| off.map(|c| c / length))
    }

    /// The largest distance of a point from the tip.
    #[must_use]
    pub fn reach(&self) -> f64 {
        let corners = self.corners.iter().map(|[rho, zeta]| rho.hypot(*zeta));
        let arcs = self
            .arcs
            .iter()
            .map(|arc| arc.centre[0].hypot(arc.centre[1]) + arc.radius);
        corners.chain(arcs).fold(0.0, f64::max)
    }

    /// The largest radius.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.meridian_support([1.0, 0.0]).0
    }

    /// The lowest and the highest `ζ`.
    #[must_use]
    pub fn heights(&self) -> [f64; 2] {
        [
            -self.meridian_support([0.0, -1.0]).0,
            self.meridian_support([0.0, 1.0]).0,
        ]
    }
}

#[cfg(test)]
mod tests {
    use crate::tool::{Level, cover, cover_and_cores};
    use sweepsim_motion::Tool;

    #[test]
    fn points_belong_to_a_bull_nose_by_its_equations() {
        let (radius, corner, length) = (3.0, 1.0, 10.0);
        let tool = Tool::bull(radius, corner, length).expect("a tool");
        let [solid] = &cover(&tool, 1e-3)[..] else {
            panic!("a bull nose is convex")
        };
        assert!(solid.is_exact());
        let mut inside = 0;
        for i in 0..80 {
            for j in 0..120 {
                let (rho, zeta) = (f64::from(i) * 0.0501, f64::from(j) * 0.1003 - 1.0);
                let off = (rho - (radius - corner)).max(0.0).hypot((corner - zeta).max(0.0));
                let own = rho <= radius && (0.0..=length).contains(&zeta) && off <= corner;
                assert_eq!(solid.contains([rho, zeta]), own, "({rho}, {zeta})");
                inside += i32::from(own);
            }
        }
        assert!((5000..6500).contains(&inside), "{inside}");
    }

    /// Solids of many corners, of few, and with arcs.
    fn solids() -> Vec<super::Convex> {
        let tools = [Tool::ball(3.0, 10.0), Tool::flat(3.0, 10.0), Tool::bull(3.0, 1.0, 10.0)];
        let all = tools.map(|tool| {
            let tool = tool.expect("a tool");
            let free = Tool::from_patches(tool.patches().to_vec(), 1e-9).expect("the same tool");
            [cover(&tool, 1e-3), cover_and_cores(&free, 1e-3)].concat()
        });
        let all = all.concat();
        assert!(all.iter().filter(|solid| solid.corners.len() > 2 * super::FEW).count() >= 4);
        all
    }

    #[test]
    fn no_corner_reaches_farther_than_those_that_are_found() {
        for solid in solids() {
            for k in 0..=720 {
                let (sine, cosine) = (std::f64::consts::PI * (f64::from(k) / 720.0 - 0.5)).sin_cos();
                let direction = [cosine.max(0.0), sine];
                let farthest = |corners: &[[f64; 2]]| {
                    corners
                        .iter()
                        .map(|corner| super::dot(direction, *corner))
                        .fold(f64::NEG_INFINITY, f64::max)
                };
                let found = farthest(solid.corners_towards(direction));
                assert!(farthest(&solid.corners) - found < 1e-12, "{direction:?}");
            }
        }
    }

    #[test]
    fn away_is_where_the_distance_grows() {
        let mut outside = 0;
        for solid in solids() {
            let level = Level::new(&solid);
            for (i, j) in (0..30).flat_map(|i| (0..60).map(move |j| (i, j))) {
                let point = [f64::from(i) * 0.2017, f64::from(j) * 0.3011 - 4.0];
                let distance = level.distance(point);
                let away = solid.away(point);
                assert!(away.is_some() || distance < 1e-9, "{point:?}");
                if let Some([out, up]) = away.filter(|_| distance > 1e-6) {
                    let farther = level.distance([point[0] + out, point[1] + up]);
                    assert!(
                        (farther - distance - 1.0).abs() < 1e-9,
                        "{point:?}: {distance} {farther}"
                    );
                    outside += 1;
                }
            }
        }
        assert!(outside > 5000, "{outside}");
    }
}
