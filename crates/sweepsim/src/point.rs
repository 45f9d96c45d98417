//! Points of elements: position, normals and moments, with derivatives (index 0 the value, 1 and 2 the derivatives).

use nalgebra::Vector3;
use sweepsim_motion::Revolved;

/// A point of a patch.
#[derive(Clone, Debug)]
pub(crate) struct FacePoint {
    pub position: Vector3<f64>,
    pub slopes: [Vector3<f64>; 2],
    pub field: FieldPoint,
}

/// A point of an edge, with the normals of both faces.
#[derive(Clone, Debug)]
pub(crate) struct RimPoint {
    pub position: Vector3<f64>,
    pub slope: Vector3<f64>,
    pub fields: [FieldPoint; 2],
}

#[derive(Clone, Debug)]
pub(crate) struct FieldPoint {
    pub normal: [Vector3<f64>; 3],
    pub moment: [Vector3<f64>; 3],
}

/// Value and derivative of quadratic Bernstein forms.
fn quadratics<const N: usize>(forms: &[[f64; 3]; N], x: f64) -> [[f64; N]; 2] {
    let y = 1.0 - x;
    let (values, slopes) = ([y * y, 2.0 * x * y, x * x], [-2.0 * y, 2.0 * (y - x), 2.0 * x]);
    let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    [
        std::array::from_fn(|k| dot(&forms[k], &values)),
        std::array::from_fn(|k| dot(&forms[k], &slopes)),
    ]
}

/// The point of a surface of revolution, in its own frame.
pub(crate) fn revolved(revolution: &Revolved, u: f64, v: f64) -> FacePoint {
    let [[c, s, w], [dc, ds, dw]] = quadratics(&revolution.circle, u);
    let [[rho, zeta, omega, n_rho, n_zeta, m], slopes] = quadratics(&revolution.meridian, v);
    let [d_rho, d_zeta, d_omega, d_n_rho, d_n_zeta, d_m] = slopes;
    let inverse = 1.0 / (w * omega);
    let position = Vector3::new(c * rho, s * rho, w * zeta) * inverse;
    FacePoint {
        position,
        slopes: [
            (Vector3::new(dc * rho, ds * rho, dw * zeta) - position * (dw * omega)) * inverse,
            (Vector3::new(c * d_rho, s * d_rho, w * d_zeta) - position * (w * d_omega)) * inverse,
        ],
        field: FieldPoint {
            normal: [
                Vector3::new(c * n_rho, s * n_rho, w * n_zeta),
                Vector3::new(dc * n_rho, ds * n_rho, dw * n_zeta),
                Vector3::new(c * d_n_rho, s * d_n_rho, w * d_n_zeta),
            ],
            moment: [
                Vector3::new(-s * m, c * m, 0.0),
                Vector3::new(-ds * m, dc * m, 0.0),
                Vector3::new(-s * d_m, c * d_m, 0.0),
            ],
        },
    }
}
