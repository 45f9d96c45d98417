//! Coordinate systems: `MSYS`, and rotations of three-dimensional vectors.

use nalgebra::{Matrix3, Vector3};

use crate::machines::WorkFrame;
use crate::text::error::NcProblem;

pub(super) type Vector = [f64; 3];

pub(super) fn sub(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] - b[k])
}

/// `a + s b`.
pub(super) fn add(a: Vector, s: f64, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] + s * b[k])
}

pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(super) fn norm(a: Vector) -> f64 {
    a[0].hypot(a[1]).hypot(a[2])
}

/// How far the axes of a frame may be from unit length and from perpendicular: they are written with 7 digits.
const ROUNDING: f64 = 1e-4;

/// The frame of an `MSYS` in the frame of the file.
pub(super) fn frame(origin: Vector, x: Vector, y: Vector) -> Result<WorkFrame, NcProblem> {
    let (a, b) = (norm(x), norm(y));
    if (a - 1.0).abs() > ROUNDING || (b - 1.0).abs() > ROUNDING || dot(x, y).abs() > ROUNDING {
        return Err(NcProblem::syntax(format!(
            "the axes of MSYS have lengths {a} and {b} and the scalar product {}: expected perpendicular unit vectors",
            dot(x, y)
        )));
    }
    let (x, y) = (Vector3::from(x) / a, Vector3::from(y));
    let z = x.cross(&y).normalize();
    Ok(WorkFrame::with_matrix(
        Matrix3::from_columns(&[x, z.cross(&x), z]),
        origin.into(),
    ))
}

/// `vector` turned by `angle` about the unit vector `axis`.
pub(super) fn turned(vector: Vector, axis: Vector, angle: f64) -> Vector {
    let (sin, cos) = angle.sin_cos();
    let along = dot(vector, axis);
    let across = cross(axis, vector);
    [0, 1, 2].map(|k| cos * vector[k] + sin * across[k] + (1.0 - cos) * along * axis[k])
}
