//! Pieces of surfaces of revolution as products.

use super::meridian::form;
use super::revolution::place;
use super::{NormalField, Patch, PatchError};
use nalgebra::{Matrix3, Vector3};
use sweepsim_spline::Bernstein;

/// A piece of a surface of revolution about the third axis of its own frame, as products of quadratic Bernstein forms.
///
/// In that frame, with circle `c, s, w` in `u` and meridian `ρ, ζ, ω, n_ρ, n_ζ, m` in `v`:
/// `F = (c ρ, s ρ, w ζ) / (w ω)`, `N = (c n_ρ, s n_ρ, w n_ζ)`, `F × N = (−s m, c m, 0)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Revolved {
    pub(super) circle: [[f64; 3]; 3],
    pub(super) meridian: [[f64; 3]; 6],
    pub(super) frame: Option<(Matrix3<f64>, Vector3<f64>)>,
}

impl Revolved {
    /// The piece with these coefficients: cosine, sine and weight of the circle; radius, height and weight of the
    /// meridian, radius and height of its normal, then the moment. The frame gives the rotation of its axes and its
    /// origin in the tool; `None` for the tool's frame.
    ///
    /// # Errors
    /// [`PatchError`]: numbers that are not finite, weights that are not positive, a frame that is not a rotation,
    /// normals that are not perpendicular to the surface, moments that do not belong to them, a surface with a fold.
    pub fn new(
        circle: [[f64; 3]; 3],
        meridian: [[f64; 3]; 6],
        frame: Option<(Matrix3<f64>, [f64; 3])>,
    ) -> Result<Self, PatchError> {
        for (lists, what) in [(&circle[..], "the circle"), (&meridian[..], "the meridian")] {
            if !lists.iter().flatten().all(|c| c.is_finite()) {
                return Err(PatchError::NotFinite { what });
            }
        }
        if let Some((turn, origin)) = &frame {
            let finite = origin.iter().chain(turn.iter()).all(|c| c.is_finite());
            let off = (turn.tr_mul(turn) - Matrix3::identity()).norm();
            // Nine products and sums of numbers up to 1, of which each may be rounded a few times.
            if !finite || !(off <= 64.0 * f64::EPSILON) || turn.determinant() < 0.0 {
                return Err(PatchError::Frame);
            }
        }
        let revolved = Self {
            circle,
            meridian,
            frame: frame.map(|(turn, origin)| (turn, origin.into())),
        };
        revolved.patch()?;
        Ok(revolved)
    }

    /// The patch.
    ///
    /// # Errors
    /// Never for values built by [`new`](Self::new).
    pub fn patch(&self) -> Result<Patch, PatchError> {
        let [c, s, w] = &self.circle;
        let [rho, zeta, omega, n_rho, n_zeta, moment] = &self.meridian;
        let product = |a: &[f64; 3], b: &[f64; 3]| {
            let coefficients: Vec<f64> = b.iter().flat_map(|y| a.iter().map(move |x| x * y)).collect();
            if coefficients.iter().all(|c| c.is_finite()) {
                Ok(form(&[2, 2], coefficients))
            } else {
                Err(PatchError::NotFinite { what: "the products" })
            }
        };
        let minus = s.map(|s| -s);
        let position = [product(c, rho)?, product(s, rho)?, product(w, zeta)?];
        let weight = product(w, omega)?;
        let normal = [product(c, n_rho)?, product(s, n_rho)?, product(w, n_zeta)?];
        let moment = [
            product(&minus, moment)?,
            product(c, moment)?,
            Bernstein::constant(2, 0.0).elevated_to(&[2, 2]),
        ];
        let own = Patch::with_normals(position, weight, NormalField::new(normal, moment)?)?;
        let unplaced = own.with_revolved(Self {
            frame: None,
            ..self.clone()
        });
        Ok(match &self.frame {
            None => unplaced,
            Some((turn, origin)) => place(&unplaced, turn, origin),
        })
    }

    /// Coefficients in `u`: cosine, sine and weight.
    #[must_use]
    pub fn circle(&self) -> &[[f64; 3]; 3] {
        &self.circle
    }

    /// Coefficients in `v`: radius, height and weight, then radius and height of the normal, then the moment.
    #[must_use]
    pub fn meridian(&self) -> &[[f64; 3]; 6] {
        &self.meridian
    }

    /// The rotation and the origin of the frame in the tool; `None` if it is the tool's frame.
    #[must_use]
    pub fn frame(&self) -> Option<(Matrix3<f64>, [f64; 3])> {
        self.frame.map(|(turn, origin)| (turn, origin.into()))
    }
}
