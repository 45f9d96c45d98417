//! A motion at one time.

use nalgebra::{Matrix3, Vector3};

/// The motion at one time.
#[derive(Clone, Debug)]
pub(crate) struct Moment {
    /// `A`.
    pub turn: Matrix3<f64>,
    /// `b`.
    pub tip: Vector3<f64>,
    /// The angular velocity, in space.
    pub spin: Vector3<f64>,
    /// `b′`.
    pub velocity: Vector3<f64>,
    /// The angular velocity in the tool's frame, times a positive factor.
    pub own_spin: Vector3<f64>,
    /// Its derivative, if it is not constant.
    pub own_spin_slope: Option<Vector3<f64>>,
    /// `Aᵀ b′`, times the same factor.
    pub travel: Vector3<f64>,
    /// Its derivative.
    pub travel_slope: Vector3<f64>,
}

/// Vectors as rows of coefficients.
pub(crate) type Rows<'a> = &'a [[f64; 3]];
