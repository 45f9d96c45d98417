//! Coordinate systems: `MSYS`, and rotations of three-dimensional vectors.

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

/// A frame: its origin and its axes, in the frame of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    origin: Vector,
    axes: [Vector; 3],
}

/// How far the axes of a frame may be from unit length and from perpendicular: they are written with 7 digits.
const ROUNDING: f64 = 1e-4;

impl Frame {
    pub fn new(origin: Vector, x: Vector, y: Vector) -> Result<Self, NcProblem> {
        let (a, b) = (norm(x), norm(y));
        if (a - 1.0).abs() > ROUNDING || (b - 1.0).abs() > ROUNDING || dot(x, y).abs() > ROUNDING {
            return Err(NcProblem::syntax(format!(
                "the axes of MSYS have lengths {a} and {b} and the scalar product {}: expected perpendicular unit vectors",
                dot(x, y)
            )));
        }
        let x = x.map(|c| c / a);
        let z = cross(x, y);
        let z = z.map(|c| c / norm(z));
        Ok(Self {
            origin,
            axes: [x, cross(z, x), z],
        })
    }

    /// A point of this frame in the frame of the file.
    fn out(&self, [x, y, z]: Vector) -> Vector {
        add(add(add(self.origin, x, self.axes[0]), y, self.axes[1]), z, self.axes[2])
    }

    fn turn_out(&self, [x, y, z]: Vector) -> Vector {
        add(add(add([0.0; 3], x, self.axes[0]), y, self.axes[1]), z, self.axes[2])
    }

    fn turn_in(&self, direction: Vector) -> Vector {
        self.axes.map(|axis| dot(axis, direction))
    }

    /// A point of this frame in another frame.
    pub fn point_in(&self, other: &Self, point: Vector) -> Vector {
        if self == other {
            return point;
        }
        other.turn_in(sub(self.out(point), other.origin))
    }

    /// A direction of this frame in another frame.
    pub fn direction_in(&self, other: &Self, direction: Vector) -> Vector {
        if self == other {
            return direction;
        }
        other.turn_in(self.turn_out(direction))
    }
}

/// `vector` turned by `angle` about the unit vector `axis`.
pub(super) fn turned(vector: Vector, axis: Vector, angle: f64) -> Vector {
    let (sin, cos) = angle.sin_cos();
    let along = dot(vector, axis);
    let across = cross(axis, vector);
    [0, 1, 2].map(|k| cos * vector[k] + sin * across[k] + (1.0 - cos) * along * axis[k])
}
