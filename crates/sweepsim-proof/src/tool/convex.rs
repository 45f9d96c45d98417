//! A convex solid of revolution, by its support function.

use nalgebra::Vector3;

/// The hull of points and arcs in the half-plane `(ρ, ζ)`, turned about the axis `ρ = 0`.
///
/// All that a proof needs of it is the [support function](Self::support): how far it reaches in a direction.
#[derive(Clone, Debug, Default)]
pub struct Convex {
    /// Points `(ρ, ζ)`, `ρ ≥ 0`.
    pub(super) corners: Vec<[f64; 2]>,
    pub(super) arcs: Vec<ConvexArc>,
    /// Whether every point is one of the tool, so that a point of it is a witness.
    pub(super) exact: bool,
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
    fn meridian_support(&self, direction: [f64; 2]) -> (f64, [f64; 2]) {
        let mut best = (f64::NEG_INFINITY, [0.0; 2]);
        for corner in &self.corners {
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

    /// Whether a point at `(ρ, ζ)` belongs to the solid, with certainty but for rounding.
    #[must_use]
    pub fn contains(&self, point: [f64; 2]) -> bool {
        // The hull is the intersection of half-planes; those of the normals at corners and of arcs towards the point
        // are enough to look at, by bisection of the direction that separates best.
        let worst = |angle: f64| {
            let direction = [angle.cos(), angle.sin()];
            dot(direction, point) - self.meridian_support(direction).0
        };
        let steps = 64;
        let at = |k: f64| -std::f64::consts::FRAC_PI_2 + std::f64::consts::PI * k / f64::from(steps);
        let mut best = (f64::NEG_INFINITY, 0.0);
        for k in 0..=steps {
            let value = worst(at(f64::from(k)));
            if value > best.0 {
                best = (value, f64::from(k));
            }
        }
        // The distance from a convex set has one maximum over directions that separate.
        let (mut low, mut high) = ((best.1 - 1.0).max(0.0), (best.1 + 1.0).min(f64::from(steps)));
        for _ in 0..40 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if worst(at(a)) < worst(at(b)) {
                low = a;
            } else {
                high = b;
            }
        }
        best.0.max(worst(at(0.5 * (low + high)))) <= 0.0
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
