//! Preimages on faces that two boxes share, or within rounding of one.
//!
//! Each box comes to such a preimage from its own side, and rounding may put it beyond the face for both of them, or for neither. So both may claim it, as long as it is beyond by no more than rounding;
//! and a claim that is as close to an earlier one as rounding allows, of the same target and orientation, is the same preimage: between two of one orientation is one of the other.

use super::linear::Linear;
use crate::Enclosure;
use nalgebra::SVector;

/// Preimages this close to a face, in half sides, or closer than this many times their rounding are remembered.
const NEAR: f64 = 1e-6;
const ROUNDINGS: f64 = 16.0;
/// Of a coordinate that is computed from its place in a box.
const COORDINATE: f64 = 8.0 * f64::EPSILON;

/// The domain of a search, and the part of it that is searched now.
#[derive(Clone, Copy)]
pub(super) struct Searched<'a, const N: usize> {
    pub domain: &'a [Enclosure; N],
    pub part: &'a [Enclosure; N],
}

/// Where a point is, for a box.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum BoxPlace {
    Inside,
    /// Near a face that another box shares, perhaps beyond it.
    AtFace,
    Outside,
}

impl BoxPlace {
    /// Of a point in the coordinates of a box. Only its lower faces, and upper faces on the domain's boundary, belong to it, but it may claim a little more where another box of the part begins.
    pub fn of<const N: usize>(
        s: &SVector<f64, N>,
        linear: &Linear<N>,
        bounds: &[Enclosure; N],
        searched: &Searched<N>,
    ) -> Self {
        let x = linear.point(s);
        let mut place = Self::Inside;
        for i in 0..N {
            let (side, whole, part) = (&bounds[i], &searched.domain[i], &searched.part[i]);
            let rounding = linear.variable_rounding[i] + COORDINATE * side.magnitude() / linear.half[i];
            let shared = [side.lo() > part.lo(), side.hi() < part.hi()];
            let owned = [
                x[i] >= side.lo(),
                x[i] < side.hi() || (x[i] <= side.hi() && side.hi() == whole.hi()),
            ];
            // How far it is from either face, to the inside.
            for (face, depth) in [1.0 + s[i], 1.0 - s[i]].into_iter().enumerate() {
                let claimed = owned[face] || (shared[face] && depth >= -2.0 * rounding);
                if !claimed {
                    return Self::Outside;
                }
                if shared[face] && depth < NEAR.max(ROUNDINGS * rounding) {
                    place = Self::AtFace;
                }
            }
        }
        place
    }
}

/// A preimage near a face.
#[derive(Debug)]
struct OnFace {
    target: usize,
    orientation: i8,
    x: Vec<f64>,
    rounding: Vec<f64>,
}

/// Those that a search has found.
#[derive(Debug, Default)]
pub(super) struct Faces {
    found: Vec<OnFace>,
}

impl Faces {
    pub fn clear(&mut self) {
        self.found.clear();
    }

    /// The number of those found, as a mark for [forgetting](Self::forget) later ones.
    pub fn mark(&self) -> usize {
        self.found.len()
    }

    pub fn forget(&mut self, mark: usize) {
        self.found.truncate(mark);
    }

    /// Whether no other box has found this preimage of a target, which is remembered if it is at a face.
    pub fn is_new<const N: usize>(&mut self, target: usize, x: &[f64; N], linear: &Linear<N>, place: BoxPlace) -> bool {
        if place == BoxPlace::Inside && self.found.is_empty() {
            return true;
        }
        let rounding: [f64; N] =
            std::array::from_fn(|i| 4.0 * linear.variable_rounding[i] * linear.half[i] + COORDINATE * x[i].abs());
        let is_same = |other: &OnFace| {
            let near = |i: usize| (other.x[i] - x[i]).abs() <= other.rounding[i] + rounding[i];
            other.target == target && other.orientation == linear.orientation && (0..N).all(near)
        };
        let is_new = !self.found.iter().any(is_same);
        if is_new && place == BoxPlace::AtFace {
            self.found.push(OnFace {
                target,
                orientation: linear.orientation,
                x: x.to_vec(),
                rounding: rounding.to_vec(),
            });
        }
        is_new
    }
}
