//! Other courses that moves of a path may take.

use super::{PackedPoses, Path, PathError};
use crate::packed::PackedRows;
use crate::pose::Pose;
use nalgebra::Matrix3;
use std::ops::{Range, RangeInclusive};

/// Another course that a move may take: a rapid on a machine that may let each axis arrive in its own time.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct OtherCourse {
    /// The move of the path; of several moves that it is in place of, the last one.
    pub number: usize,
    /// The first of these moves.
    pub first: usize,
    /// The course, from the start of the first move to the end of the last.
    pub path: Path,
    /// When each move of the course ends, as a fraction of the whole, from 0 to 1.
    pub times: Vec<f64>,
}

/// The other courses of some moves of a path, in the order of these, in some ten bytes a corner.
///
/// ```
/// use sweepsim_motion::{OtherCourses, Pose};
/// let at = |x: f64, y: f64| Pose::new([x, y, 0.0], [0.0, 0.0, 1.0]);
/// let mut courses = OtherCourses::default();
/// // The third move goes by (10, 10) to (50, 10), and is there after a fifth of the time.
/// courses.push(2, [(0.0, at(0.0, 0.0)?), (0.2, at(10.0, 10.0)?), (1.0, at(50.0, 10.0)?)])?;
/// let course = courses.of(0..5).next().ok_or("none")?;
/// assert_eq!((course.number, course.path.moves(), course.times), (2, 2, vec![0.2, 1.0]));
/// assert_eq!(courses.of(3..5).count(), 0);
/// // One for three moves: that of the last one.
/// courses.push_for(4..=6, [(0.0, at(50.0, 10.0)?), (1.0, at(0.0, 0.0)?)])?;
/// let course = courses.of(6..7).next().ok_or("none")?;
/// assert_eq!((course.first, course.number), (4, 6));
/// assert_eq!([1, 2, 3, 4, 5, 6, 7].map(|number| courses.has(number)), [false, true, false, true, true, true, false]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OtherCourses {
    /// The moves, in ascending order, and the number of poses up to the end of each one's course.
    moves: Vec<(u32, u32)>,
    /// The first moves of those courses that are in place of several, by the last ones, in ascending order.
    several: Vec<(u32, u32)>,
    poses: PackedPoses,
    /// Of each pose.
    times: PackedRows<1>,
}

impl OtherCourses {
    /// Adds the course of a move: its poses, each with the time at which it is reached, as a fraction of the whole. All
    /// its moves are straight.
    ///
    /// # Errors
    /// Those of [`Path::new`]. Then nothing is added.
    ///
    /// # Panics
    /// If the last course is that of a later move, or there are more than 2³² poses.
    pub fn push(&mut self, number: usize, course: impl IntoIterator<Item = (f64, Pose)>) -> Result<(), PathError> {
        let (times, poses): (Vec<f64>, Vec<Pose>) = course.into_iter().unzip();
        let path = Path::new(poses)?;
        let number = u32::try_from(number).expect("fewer than 2^32 moves");
        assert!(
            self.moves.last().is_none_or(|(last, _)| *last <= number),
            "courses are in order"
        );
        path.poses().iter().for_each(|pose| self.poses.push(pose));
        self.times.extend(times.into_iter().map(|time| [time]));
        self.moves
            .push((number, u32::try_from(self.poses.len()).expect("fewer than 2^32 poses")));
        Ok(())
    }

    /// The same of a course in place of several moves, as of the chords of one block.
    ///
    /// # Errors
    /// As [`push`](Self::push).
    ///
    /// # Panics
    /// As [`push`](Self::push).
    pub fn push_for(
        &mut self,
        moves: RangeInclusive<usize>,
        course: impl IntoIterator<Item = (f64, Pose)>,
    ) -> Result<(), PathError> {
        let (first, last) = moves.into_inner();
        self.push(last, course)?;
        if first < last {
            self.several.push((last as u32, first as u32));
        }
        Ok(())
    }

    /// Whether there is another course in place of a move, or of several of which it is one.
    #[must_use]
    pub fn has(&self, number: usize) -> bool {
        let from = |all: &[(u32, u32)]| all.partition_point(|(last, _)| (*last as usize) < number);
        let own = self.moves.get(from(&self.moves));
        let block = self.several.get(from(&self.several));
        own.is_some_and(|(last, _)| *last as usize == number)
            || block.is_some_and(|(_, first)| *first as usize <= number)
    }

    /// The number of courses.
    #[must_use]
    pub fn len(&self) -> usize {
        self.moves.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.moves.is_empty()
    }

    /// The courses of some moves, in order.
    pub fn of(&self, moves: Range<usize>) -> impl Iterator<Item = OtherCourse> + '_ {
        let before = |end: usize| self.moves.partition_point(|(number, _)| (*number as usize) < end);
        let from = before(moves.start);
        (from..before(moves.end).max(from)).map(|index| self.course(index))
    }

    fn course(&self, index: usize) -> OtherCourse {
        let (number, end) = self.moves[index];
        let begin = index.checked_sub(1).map_or(0, |before| self.moves[before].1);
        let (begin, end) = (begin as usize, end as usize);
        let poses = self.poses.range(begin..end).collect();
        let several = self.several.binary_search_by_key(&number, |(last, _)| *last);
        OtherCourse {
            number: number as usize,
            first: several.map_or(number, |found| self.several[found].1) as usize,
            path: Path::new(poses).expect("checked when it was added"),
            times: self.times.range(begin + 1..end).map(|[time]| time).collect(),
        }
    }

    /// The same, turned by a rotation and then moved.
    ///
    /// # Errors
    /// Those of [`Path::moved`].
    pub fn moved(&self, turn: &Matrix3<f64>, by: [f64; 3]) -> Result<Self, PathError> {
        let mut all = Self::default();
        for course in self.of(0..usize::MAX) {
            let path = course.path.moved(turn, by)?;
            let times = std::iter::once(0.0).chain(course.times);
            all.push_for(course.first..=course.number, times.zip(path.poses().iter().copied()))?;
        }
        Ok(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    proptest! {
        /// What is taken out is what was put in, to the last bit, however the moves are asked for.
        #[test]
        fn courses_are_kept(
            corners in collection::vec((0_usize..4, collection::vec(prop::array::uniform3(-1e3..1e3_f64), 1..5)), 0..100),
            cut in 0..200_usize,
        ) {
            let (mut kept, mut all, mut number) = (OtherCourses::default(), Vec::new(), 0);
            for (ahead, tips) in corners {
                number += ahead;
                let last = tips.len().max(2) - 1;
                let course: Vec<(f64, Pose)> = tips
                    .iter()
                    .enumerate()
                    .map(|(k, tip)| (k as f64 / last as f64, Pose::new(*tip, [0.0, 0.6, 0.8]).unwrap()))
                    .collect();
                kept.push(number, course.clone()).unwrap();
                all.push((number, course));
            }
            prop_assert_eq!(kept.len(), all.len());
            let taken: Vec<OtherCourse> = kept.of(0..cut).chain(kept.of(cut..usize::MAX)).collect();
            prop_assert_eq!(taken.len(), all.len());
            for (taken, (number, course)) in taken.iter().zip(&all) {
                prop_assert_eq!(taken.number, *number);
                let poses: Vec<Pose> = course.iter().map(|(_, pose)| *pose).collect();
                prop_assert_eq!(taken.path.poses(), &poses[..]);
                let times: Vec<f64> = course[1..].iter().map(|(time, _)| *time).collect();
                prop_assert_eq!(&taken.times, &times);
            }
        }
    }
}
