//! Patches of a boundary, and their normals.

use super::{PatchError, recognised};
use nalgebra::{Matrix3, Vector3};
use sweepsim_spline::Bernstein;

/// A field of surface normals `N` and their moments `M = F × N`, as Bernstein forms with one common positive factor.
#[derive(Clone, Debug)]
pub struct NormalField {
    /// `N`, pointing out of the tool.
    pub normal: [Bernstein; 3],
    /// `M = F × N`.
    pub moment: [Bernstein; 3],
}

/// A smooth piece of a tool's boundary: `F = position / weight` on `[0, 1]²`, with `F_u × F_v` pointing out of the tool.
#[derive(Clone, Debug)]
pub struct Patch {
    /// Numerator of `F(u, v)`.
    pub position: [Bernstein; 3],
    /// Denominator of `F(u, v)`: positive coefficients.
    pub weight: Bernstein,
    /// Its normals.
    pub field: NormalField,
    /// The same as products of functions of `u` and of `v`, where it is a piece of a surface of revolution.
    pub revolved: Option<Revolved>,
}

/// A piece of a surface of revolution about the third axis of a frame of its own, as products of quadratic Bernstein forms.
///
/// In that frame, with circle `c, s, w` in `u` and meridian `ρ, ζ, ω, n_ρ, n_ζ, m` in `v`:
/// `F = (c ρ, s ρ, w ζ) / (w ω)`, `N = (c n_ρ, s n_ρ, w n_ζ)`, `F × N = (−s m, c m, 0)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Revolved {
    /// Coefficients in `u`: cosine, sine and weight.
    pub circle: [[f64; 3]; 3],
    /// Coefficients in `v`: radius, height and weight, then of the normal its radius and height, then the moment.
    pub meridian: [[f64; 3]; 6],
    /// How the frame is turned and where its origin is in the tool; `None` when it is the tool's.
    pub frame: Option<(Matrix3<f64>, Vector3<f64>)>,
}

/// Highest degree of a patch: that of the moments, four times as high, must still be evaluated well.
const MOST: usize = 7;

fn cross(a: &[Bernstein; 3], b: &[Bernstein; 3]) -> [Bernstein; 3] {
    [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        a[i].mul(&b[j]).sub(&a[j].mul(&b[i]))
    })
}

fn scaled(forms: &[Bernstein; 3], factor: f64) -> [Bernstein; 3] {
    [0, 1, 2].map(|k| forms[k].scale(factor).assumed_exact())
}

/// The normals `F_u × F_v` of any patch, times a power of its weight, and their moments.
pub(super) fn normals(position: &[Bernstein; 3], weight: &Bernstein) -> NormalField {
    let first = weight.coefficients()[0];
    let polynomial = weight.coefficients().iter().all(|w| *w == first);
    let (pu, pv) = (
        [0, 1, 2].map(|k| position[k].derivative(0)),
        [0, 1, 2].map(|k| position[k].derivative(1)),
    );
    let both = cross(&pu, &pv);
    let (normal, moment) = if polynomial {
        // F = P / w with a constant weight: the moment of F is that of P over it.
        let moment = cross(position, &both).map(|form| form.scale(1.0 / first));
        (both, moment)
    } else {
        let (wu, wv) = (weight.derivative(0), weight.derivative(1));
        let (with_u, with_v) = (cross(position, &pu), cross(position, &pv));
        let hat = [0, 1, 2].map(|k| {
            let sum = weight.mul(&both[k]).add(&wv.mul(&with_u[k]));
            sum.sub(&wu.mul(&with_v[k]))
        });
        let moment = cross(position, &hat);
        (hat.map(|form| weight.mul(&form)), moment)
    };
    NormalField { normal, moment }
}

impl Patch {
    /// The patch `position / weight`, whose normal `F_u × F_v` points out of the tool.
    ///
    /// Its normals and moments are made as Bernstein forms: with `P` the position and `w` the weight,
    /// `N = w (P_u × P_v) + w_v (P × P_u) − w_u (P × P_v)`, up to the factor `w³` (after the quotient rule). Those of a piece of a surface
    /// of revolution about the third axis, which is recognised where it is one but for rounding, have a lower degree.
    ///
    /// # Errors
    /// [`PatchError`]: not two variables, a degree above 7, weights that are not positive, no normal in the inside (along the sides it
    /// may vanish: poles).
    pub fn new(position: [Bernstein; 3], weight: Bernstein) -> Result<Self, PatchError> {
        for (form, what) in position.iter().zip(["x", "y", "z"]).chain([(&weight, "the weight")]) {
            if form.variables() != 2 {
                return Err(PatchError::Variables {
                    what,
                    found: form.variables(),
                });
            }
            if let Some(&degree) = form.degrees().iter().find(|degree| **degree > MOST) {
                return Err(PatchError::Degree { degree, most: MOST });
            }
            if !form.coefficients().iter().all(|c| c.is_finite()) {
                return Err(PatchError::NotFinite { what });
            }
        }
        if let Some((index, &value)) = weight.coefficients().iter().enumerate().find(|(_, w)| **w <= 0.0) {
            return Err(PatchError::Weight { index, value });
        }
        let found = recognised::field(&position, &weight);
        let NormalField { normal, moment } = found.unwrap_or_else(|| normals(&position, &weight));
        let largest = normal.iter().map(Bernstein::magnitude).fold(0.0, f64::max);
        if largest == 0.0 || !largest.is_finite() {
            return Err(PatchError::NoNormal { u: 0.5, v: 0.5 });
        }
        let field = NormalField {
            normal: scaled(&normal, 1.0 / largest),
            moment: scaled(&moment, 1.0 / largest),
        };
        check_normals(&field.normal)?;
        Ok(Self {
            position: scaled(&position, 1.0),
            weight: weight.assumed_exact(),
            field,
            revolved: None,
        })
    }

    /// The place at `(u, v)`.
    #[must_use]
    pub fn place(&self, u: f64, v: f64) -> Vector3<f64> {
        let weight = self.weight.evaluate(&[u, v]);
        Vector3::from([0, 1, 2].map(|k| self.position[k].evaluate(&[u, v]) / weight))
    }
}

/// Boxes of the inside are cut until the normals of each lie in a half space; boxes at the sides may stay undecided.
fn check_normals(normal: &[Bernstein; 3]) -> Result<(), PatchError> {
    const DEPTH: usize = 14;
    let mut stack = vec![(normal.clone(), [[0.0, 1.0]; 2], 0)];
    while let Some((forms, sides, depth)) = stack.pop() {
        let count = forms[0].coefficients().len();
        let vector = |i: usize| Vector3::from([0, 1, 2].map(|k| forms[k].coefficients()[i]));
        let mean: Vector3<f64> = (0..count).map(vector).sum();
        if (0..count).all(|i| vector(i).dot(&mean) > 0.0) {
            continue;
        }
        if depth == DEPTH {
            let at_a_side = sides.iter().any(|side| side[0] == 0.0 || side[1] == 1.0);
            if at_a_side {
                continue;
            }
            let [u, v] = sides.map(|side| 0.5 * (side[0] + side[1]));
            return Err(PatchError::NoNormal { u, v });
        }
        let axis = depth % 2;
        let halves = [0, 1, 2].map(|k| forms[k].split(axis, 0.5));
        let [a, b, c] = halves;
        let middle = 0.5 * (sides[axis][0] + sides[axis][1]);
        let (mut low, mut high) = (sides, sides);
        low[axis][1] = middle;
        high[axis][0] = middle;
        stack.push(([a.0, b.0, c.0], low, depth + 1));
        stack.push(([a.1, b.1, c.1], high, depth + 1));
    }
    Ok(())
}
