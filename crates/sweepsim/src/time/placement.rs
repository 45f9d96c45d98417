//! A frame fixed to the tool, placed and moving: the motion at one time, in the frame of a patch.

use crate::algebra::quad::{Quad, quad};
use nalgebra::{Matrix3, Vector3};

/// A rotation and a shift: one frame in another.
pub(crate) type LocalFrame = (Matrix3<f64>, Vector3<f64>);

/// A pose and a velocity, in a frame fixed to the tool.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Twisted {
    /// The angular velocity, times a positive factor.
    pub spin: Quad,
    /// The velocity of the frame's origin, times the same factor.
    pub travel: Quad,
}

impl Twisted {
    /// From `spin` and `travel` in the tool's frame.
    pub fn new(spin: &Vector3<f64>, travel: &Vector3<f64>, frame: Option<&LocalFrame>) -> Self {
        let (spin, travel) = match frame {
            None => (*spin, *travel),
            Some((own, shift)) => (own.tr_mul(spin), own.tr_mul(&(travel + spin.cross(shift)))),
        };
        Self {
            spin: quad(&spin),
            travel: quad(&travel),
        }
    }
}

/// A placement of a frame: the columns of its turn, and its origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placing {
    pub turn: [Quad; 3],
    pub origin: Quad,
}

impl Placing {
    /// For a tool turned by `turn` with its tip at `tip`.
    pub fn new(turn: &Matrix3<f64>, tip: &Vector3<f64>, frame: Option<&LocalFrame>) -> Self {
        let (turn, origin) = match frame {
            None => (*turn, *tip),
            Some((own, shift)) => (turn * own, tip + turn * shift),
        };
        Self {
            turn: [0, 1, 2].map(|k| quad(&turn.column(k).into_owned())),
            origin: quad(&origin),
        }
    }

    /// A direction of the frame, in space.
    #[inline]
    pub fn turned(&self, v: &Vector3<f64>) -> Quad {
        let [a, b, c] = &self.turn;
        std::array::from_fn(|k| v.x * a[k] + v.y * b[k] + v.z * c[k])
    }
}

impl Twisted {
    /// `⟨spin, M⟩ + ⟨travel, N⟩` for `N` and `M` in a row.
    #[inline]
    pub fn dot(&self, field: &[f64]) -> f64 {
        let ([s, t], [n, m]) = ([&self.spin, &self.travel], [&field[..3], &field[3..6]]);
        t[0] * n[0] + t[1] * n[1] + t[2] * n[2] + s[0] * m[0] + s[1] * m[1] + s[2] * m[2]
    }
}
