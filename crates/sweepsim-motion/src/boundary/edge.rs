//! Sharp edges of a boundary.

use super::NormalField;
use nalgebra::Vector3;
use sweepsim_spline::Bernstein;

/// Stretches whose normals enclose no larger angle (its sine) join smoothly.
pub(super) const SMOOTH: f64 = 1e-9;
/// How a boundary is folded at a place of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fold {
    /// Not at all: the normals of both faces are the same there.
    Smooth,
    /// Material within less than half a turn.
    Convex,
    /// Material within more than half a turn.
    Concave,
}

/// A sharp edge `C(r) = position / weight` on `[0, 1]` between the faces A and B; `C_r ×` (direction from A to B) points out.
#[derive(Clone, Debug)]
pub struct Edge {
    /// Numerator of `C(r)`.
    pub position: [Bernstein; 3],
    /// Denominator of `C(r)`: positive coefficients.
    pub weight: Bernstein,
    /// Normals of face A along the edge.
    pub before: NormalField,
    /// Normals of face B along the edge.
    pub after: NormalField,
}

impl Edge {
    /// How the boundary is folded at `r` in `[0, 1]`: an edge may change from the one to the other on its way.
    #[must_use]
    pub fn fold(&self, r: f64) -> Fold {
        let vector = |forms: &[Bernstein; 3]| Vector3::from([0, 1, 2].map(|k| forms[k].evaluate(&[r])));
        let [a, b] = [&self.before, &self.after].map(|field| vector(&field.normal));
        let slopes = [0, 1, 2].map(|k| self.position[k].derivative(0));
        let place = vector(&self.position) / self.weight.evaluate(&[r]);
        let along = vector(&slopes) - place * self.weight.derivative(0).evaluate(&[r]);
        let turn = a.cross(&b);
        if turn.norm() <= SMOOTH * a.norm() * b.norm() {
            Fold::Smooth
        } else if turn.dot(&along) < 0.0 {
            // From A to B the normal leans the way that leads from A to B.
            Fold::Convex
        } else {
            Fold::Concave
        }
    }
}
