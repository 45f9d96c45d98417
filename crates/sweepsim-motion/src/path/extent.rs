//! How long the moves of a path are, and how far it goes.

use super::{Path, Poses, TipCourse, Ways};
use nalgebra::Vector3;
use std::borrow::Cow;

/// So many moves are unpacked at a time.
const STRETCH: usize = 1 << 12;

impl Path {
    /// The length of the tip's way in move `index`: exact for lines, arcs and helices, and to about 1e-6 of itself
    /// along [motions](Path::along) and where a rotary table carries the part.
    ///
    /// # Panics
    /// If there is no such move.
    ///
    /// ```
    /// use sweepsim_motion::{Path, Pose};
    /// let path = Path::new(vec![Pose::new([0.0; 3], [0.0, 0.0, 1.0])?, Pose::new([3.0, 4.0, 0.0], [0.0, 0.1, 1.0])?])?;
    /// assert_eq!(path.tip_length(0), 5.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn tip_length(&self, index: usize) -> f64 {
        let (from, to) = self.ends(index);
        match &self.ways {
            Ways::Motion(motion) => {
                let segment = motion.segment(index);
                length_by_chords(64, |t| segment.at(t).1.into())
            }
            Ways::Placed(placed) => placed.own.tip_length(index),
            Ways::Slerp => TipCourse::Straight.length([from.tip(), to.tip()]),
            Ways::Each(_) | Ways::Packed { .. } => self.way(index).course.length([from.tip(), to.tip()]),
        }
    }

    /// The [lengths](Self::tip_length) of all moves, one after the other.
    pub fn tip_lengths(&self) -> impl Iterator<Item = f64> + '_ {
        let of_part = |(_, part): (usize, Cow<'_, Self>)| -> Vec<f64> {
            (0..part.moves()).map(|number| part.tip_length(number)).collect()
        };
        self.stretches(STRETCH).flat_map(of_part)
    }

    /// A bound on the absolute value of all coordinates of the tip.
    #[must_use]
    pub fn size(&self) -> f64 {
        let ends = self.largest();
        match &self.ways {
            Ways::Slerp => ends,
            Ways::Motion(motion) => motion.size().max(ends),
            Ways::Placed(placed) => placed.size().max(ends),
            Ways::Packed { size, .. } => *size,
            Ways::Each(_) => self.size_of_arcs(),
        }
    }

    /// A bound on the absolute value of all coordinates of the poses.
    fn largest(&self) -> f64 {
        match &self.poses {
            Poses::Plain(poses) => poses
                .iter()
                .flat_map(|pose| pose.tip())
                .map(f64::abs)
                .fold(0.0, f64::max),
            Poses::Packed(poses) => poses.largest(),
        }
    }

    /// The same of the whole way between them.
    pub(super) fn size_of_arcs(&self) -> f64 {
        let ends = self.largest();
        let poses = self.poses_in_order(0).zip(self.poses_in_order(1));
        let moves = self.ways_in_order().zip(poses);
        moves.fold(ends, |size, (way, (from, to))| {
            let (from, to) = (from.tip_vector(), to.tip_vector());
            size.max(match way.course {
                TipCourse::Straight => 0.0,
                // A circle, the rise, and what the rise is measured from.
                TipCourse::Arc(arc) => from.norm() + 2.0 * arc.radius_vector(from).norm() + 2.0 * ends,
                TipCourse::Carried(turns) => from.norm() + turns.travel(from, to),
            })
        })
    }
}

/// The length of a curve, from twice so many chords and from so many: their error is of second order (Richardson 1911).
pub(super) fn length_by_chords(count: usize, at: impl Fn(f64) -> Vector3<f64>) -> f64 {
    let chords = |count: usize| -> f64 {
        let at = |k: usize| at(k as f64 / count as f64);
        (0..count).map(|k| (at(k + 1) - at(k)).norm()).sum()
    };
    (4.0 * chords(2 * count) - chords(count)) / 3.0
}
