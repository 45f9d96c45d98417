//! Sharp edges of a boundary.

use super::normals::{check_form, check_normals, check_place};
use super::{NormalField, PatchError};
use nalgebra::Vector3;
use sweepsim_spline::Bernstein;

/// Stretches join smoothly if the sine of the angle between their normals is at most this.
pub(super) const SMOOTH: f64 = 1e-9;
/// How a boundary is folded at a point of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fold {
    /// Smooth: the normals of both faces agree.
    Smooth,
    /// The material fills less than half a turn.
    Convex,
    /// The material fills more than half a turn.
    Concave,
}

/// A sharp edge `C(r) = position / weight` on `[0, 1]` between the faces A and B; `C_r ×` (direction from A to B)
/// points out.
///
/// Invariants: finite forms in one variable, of degree at most 7; positive weights; normals of both faces that are
/// perpendicular to the curve.
#[derive(Clone, Debug)]
pub struct Edge {
    pub(super) position: [Bernstein; 3],
    pub(super) weight: Bernstein,
    pub(super) before: NormalField,
    pub(super) after: NormalField,
}

impl Edge {
    /// The edge `position / weight` with the normals of face A and of face B along it.
    ///
    /// # Errors
    /// [`PatchError`]: forms in other than one variable, a degree above 7, weights that are not positive, normals that
    /// vanish inside or are not perpendicular to the curve, moments that are not `C × N`. The last two are checked to
    /// within a bound on the rounding errors.
    pub fn new(
        position: [Bernstein; 3],
        weight: Bernstein,
        before: NormalField,
        after: NormalField,
    ) -> Result<Self, PatchError> {
        check_place(&position, &weight, 1)?;
        for field in [&before, &after] {
            for form in field.normal().iter().chain(field.moment()) {
                check_form(form, "the normals", 1, usize::MAX)?;
            }
            field.check(&position, &weight)?;
            check_normals(field.normal())?;
        }
        Ok(Self {
            position,
            weight,
            before,
            after,
        })
    }

    /// Numerator of `C(r)`.
    #[must_use]
    pub fn position(&self) -> &[Bernstein; 3] {
        &self.position
    }

    /// Denominator of `C(r)`: positive coefficients.
    #[must_use]
    pub fn weight(&self) -> &Bernstein {
        &self.weight
    }

    /// Normals of face A along the edge.
    #[must_use]
    pub fn before(&self) -> &NormalField {
        &self.before
    }

    /// Normals of face B along the edge.
    #[must_use]
    pub fn after(&self) -> &NormalField {
        &self.after
    }

    /// How the boundary is folded at `r` in `[0, 1]`. One edge may be convex in part and concave in part.
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
            // From A to B, the normal leans in the direction from A to B.
            Fold::Convex
        } else {
            Fold::Concave
        }
    }
}
