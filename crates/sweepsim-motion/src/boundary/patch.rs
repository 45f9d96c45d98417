//! Patches of a boundary.

use super::normals::{Sides, check_form, check_normals, check_place, constant, normals, scaled};
use super::{NormalField, PatchError, Revolved, plane, recognised};
use nalgebra::Vector3;
use sweepsim_spline::Bernstein;

/// A smooth piece of a tool's boundary: `F = position / weight` on `[0, 1]²`, with `F_u × F_v` pointing out of the
/// tool.
///
/// Invariants: finite forms in two variables, of degree at most 7; positive weights; no fold in the interior; normals
/// perpendicular to the surface that point out.
#[derive(Clone, Debug)]
pub struct Patch {
    pub(super) position: [Bernstein; 3],
    pub(super) weight: Bernstein,
    pub(super) field: NormalField,
    pub(super) revolved: Option<Revolved>,
    /// What is known of normals that were computed here, and the sides that have shrunk to a point.
    pub(super) normals: Option<(Normals, Sides)>,
}

/// Normals that follow from the position.
#[derive(Clone, Copy, Debug)]
pub(super) enum Normals {
    /// This factor of products of derivatives, divided by the distances from the shrunk sides.
    Product(f64),
    /// This vector times the weight, unless that is constant.
    Plane([f64; 3]),
}

impl Patch {
    /// The patch `position / weight`, whose normal `F_u × F_v` points out of the tool.
    ///
    /// Its normals and moments are computed as Bernstein forms: with `P` the position and `w` the weight,
    /// `N = w (P_u × P_v) + w_v (P × P_u) − w_u (P × P_v)`, up to the factor `w³` (after the quotient rule), and
    /// without the factor by which they vanish on a side that has shrunk to a point. Those of a piece of a surface of
    /// revolution about the third axis, and of a piece of a plane, which are recognised up to rounding, have a lower
    /// degree.
    ///
    /// # Errors
    /// [`PatchError`]: not two variables, a degree above 7, weights that are not positive, no normal in the interior
    /// (it may vanish along the sides, at poles).
    pub fn new(position: [Bernstein; 3], weight: Bernstein) -> Result<Self, PatchError> {
        check_place(&position, &weight, 2)?;
        let found = recognised::field(&position, &weight);
        let (NormalField { normal, moment }, sides) = match found {
            Some(field) => (field, None),
            None => {
                let (field, sides) = normals(&position, &weight);
                (field, Some(sides))
            }
        };
        let largest = normal.iter().map(Bernstein::magnitude).fold(0.0, f64::max);
        if largest == 0.0 || !largest.is_finite() {
            return Err(PatchError::NoNormal { u: 0.5, v: 0.5 });
        }
        let mut field = NormalField {
            normal: scaled(&normal, 1.0 / largest),
            moment: scaled(&moment, 1.0 / largest),
        };
        check_normals(&field.normal)?;
        let flat = sides.and_then(|_| plane::field(&position, &weight, &field.normal));
        let normals = if let Some((vector, flat)) = flat {
            field = flat;
            Normals::Plane(vector)
        } else {
            // Of polynomial patches, whose weight is constant, `normals` leaves out two of its powers.
            let powers = constant(&weight).map_or(1.0, |weight| weight * weight);
            Normals::Product(1.0 / (largest * powers))
        };
        Ok(Self {
            position: scaled(&position, 1.0),
            normals: sides.map(|sides| (normals, sides)),
            weight: weight.assumed_exact(),
            field,
            revolved: None,
        })
    }

    /// The patch `position / weight` with user-defined normals, for surfaces whose normals have a lower degree than
    /// [`new`](Self::new) would find.
    ///
    /// They are verified: `field` must be normal to the surface and its moments must be `F × N`, both to within a bound
    /// on the rounding errors; it must vanish nowhere in the interior, and point to the same side as `F_u × F_v`.
    ///
    /// # Errors
    /// [`PatchError`]: as [`new`](Self::new), and [`Moment`](PatchError::Moment), [`NotNormal`](PatchError::NotNormal),
    /// [`Inward`](PatchError::Inward).
    pub fn with_normals(position: [Bernstein; 3], weight: Bernstein, field: NormalField) -> Result<Self, PatchError> {
        for form in field.normal.iter().chain(&field.moment) {
            check_form(form, "the normals", 2, usize::MAX)?;
        }
        let own = Self::new(position, weight)?;
        field.check(&own.position, &own.weight)?;
        check_normals(&field.normal)?;
        // Both fields are parallel and vanish nowhere inside, so one point decides. Take the clearest.
        let at =
            |field: &NormalField, u: f64, v: f64| Vector3::from([0, 1, 2].map(|k| field.normal[k].evaluate(&[u, v])));
        let places = [0.21, 0.37, 0.52, 0.68, 0.83];
        let products = places
            .into_iter()
            .flat_map(|u| places.map(|v| at(&field, u, v).dot(&at(&own.field, u, v))));
        let clearest = products.fold(
            0.0_f64,
            |best, product| if product.abs() > best.abs() { product } else { best },
        );
        if !(clearest > 0.0) {
            return Err(PatchError::Inward);
        }
        Ok(Self {
            field,
            normals: None,
            ..own
        })
    }

    pub(super) fn with_revolved(self, revolved: Revolved) -> Self {
        Self {
            revolved: Some(revolved),
            ..self
        }
    }

    /// Numerator of `F(u, v)`.
    #[must_use]
    pub fn position(&self) -> &[Bernstein; 3] {
        &self.position
    }

    /// Denominator of `F(u, v)`: positive coefficients.
    #[must_use]
    pub fn weight(&self) -> &Bernstein {
        &self.weight
    }

    /// The normals.
    #[must_use]
    pub fn field(&self) -> &NormalField {
        &self.field
    }

    /// The factor `s` of normals `N = s w⁴ (F_u × F_v)`, where `w` is the weight, divided by the distances `u`,
    /// `1 − u`, `v` and `1 − v` from [sides that have shrunk to a point](Self::shrunk_sides); `None` if they have
    /// another form.
    #[must_use]
    pub fn product(&self) -> Option<f64> {
        match self.normals {
            Some((Normals::Product(factor), _)) => Some(factor),
            _ => None,
        }
    }

    /// The vector `n` of normals `N = w n`, where `w` is the weight, or `N = n` if that is constant; `None` if they
    /// have another form. Those of patches that are flat up to rounding have this form, except slivers, parts of
    /// surfaces of revolution about the third axis, and patches whose normals a caller gave.
    #[must_use]
    pub fn plane(&self) -> Option<[f64; 3]> {
        match self.normals {
            Some((Normals::Plane(vector), _)) => Some(vector),
            _ => None,
        }
    }

    /// For each variable, whether the lower and the upper side have shrunk to a point, so that normals that are a
    /// [product](Self::product) are divided by the distance from it; none if the normals are neither a product nor
    /// those of a [plane](Self::plane).
    #[must_use]
    pub fn shrunk_sides(&self) -> [[bool; 2]; 2] {
        self.normals.map_or_else(Sides::default, |(_, sides)| sides)
    }

    /// The patch as products of functions of `u` and of `v`, if it is a piece of a surface of revolution.
    #[must_use]
    pub fn revolved(&self) -> Option<&Revolved> {
        self.revolved.as_ref()
    }

    /// The point at `(u, v)`. Outside `[0, 1]²` the surface is extrapolated.
    #[must_use]
    pub fn point(&self, u: f64, v: f64) -> [f64; 3] {
        let weight = self.weight.evaluate(&[u, v]);
        [0, 1, 2].map(|k| self.position[k].evaluate(&[u, v]) / weight)
    }

    /// The point at `(u, v)` in `[0, 1]²`.
    ///
    /// # Errors
    /// [`PatchError::Outside`].
    pub fn try_point(&self, u: f64, v: f64) -> Result<[f64; 3], PatchError> {
        match [u, v].into_iter().find(|x| !(0.0..=1.0).contains(x)) {
            Some(parameter) => Err(PatchError::Outside { parameter }),
            None => Ok(self.point(u, v)),
        }
    }
}
