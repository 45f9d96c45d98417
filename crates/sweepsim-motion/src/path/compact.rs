//! Poses of long paths, packed.

use crate::packed::PackedRows;
use crate::pose::Pose;
use std::fmt;
use std::ops::Range;
use std::sync::OnceLock;

/// Poses, in little memory: those of a tool that does not turn take a few bytes each.
///
/// ```
/// use sweepsim_motion::{PackedPoses, Pose};
/// let pose = |k: u32| Pose::new([0.01 * f64::from(k), 2.0, 5.0], [0.0, 0.1, 1.0]);
/// let mut poses = PackedPoses::default();
/// for k in 0..1000 {
///     poses.push(&pose(k)?);
/// }
/// assert_eq!((poses.len(), poses.get(700)), (1000, Some(pose(700)?)));
/// # Ok::<(), sweepsim_motion::PoseError>(())
/// ```
#[derive(Clone, Default)]
pub struct PackedPoses {
    /// Tip, axis and side; a side of zeros is none.
    rows: PackedRows<9>,
    largest: f64,
    /// The number of those that have a side.
    sides: usize,
    /// All of them, once somebody has asked for a slice.
    unpacked: OnceLock<Vec<Pose>>,
}

/// What is packed, whether somebody has unpacked it or not.
impl fmt::Debug for PackedPoses {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("PackedPoses").field(&self.rows).finish()
    }
}

impl PartialEq for PackedPoses {
    fn eq(&self, other: &Self) -> bool {
        self.rows == other.rows
    }
}

impl PackedPoses {
    /// Appends a pose.
    pub fn push(&mut self, pose: &Pose) {
        let ([x, y, z], [i, j, k]) = (pose.tip(), pose.axis());
        let [a, b, c] = pose.side().unwrap_or_default();
        self.largest = pose.tip().into_iter().map(f64::abs).fold(self.largest, f64::max);
        self.sides += usize::from(pose.side().is_some());
        self.unpacked = OnceLock::new();
        self.rows.push([x, y, z, i, j, k, a, b, c]);
    }

    /// The number of poses.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// A pose; `None` beyond the last.
    #[must_use]
    pub fn get(&self, index: usize) -> Option<Pose> {
        self.rows.get(index).map(of_row)
    }

    /// Some poses in order, as far as there are so many.
    pub fn range(&self, poses: Range<usize>) -> impl Iterator<Item = Pose> + '_ {
        self.rows.range(poses).map(of_row)
    }

    pub(super) fn all(&self) -> &[Pose] {
        self.unpacked.get_or_init(|| self.range(0..self.len()).collect())
    }

    /// Whether only some have a side.
    pub(super) fn are_mixed(&self) -> bool {
        self.sides > 0 && self.sides < self.len()
    }

    /// A bound on the absolute value of all coordinates.
    pub(super) fn largest(&self) -> f64 {
        self.largest
    }
}

/// Gives up the memory of the poses as they are taken.
impl IntoIterator for PackedPoses {
    type Item = Pose;
    type IntoIter = std::iter::Map<<PackedRows<9> as IntoIterator>::IntoIter, fn([f64; 9]) -> Pose>;

    fn into_iter(self) -> Self::IntoIter {
        self.rows.into_iter().map(of_row as fn([f64; 9]) -> Pose)
    }
}

fn of_row([x, y, z, i, j, k, a, b, c]: [f64; 9]) -> Pose {
    let side = [a, b, c];
    Pose::of_parts([x, y, z], [i, j, k], (side != [0.0; 3]).then_some(side))
}
