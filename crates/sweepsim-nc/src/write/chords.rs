//! Chords of moves that a format has no words for.

use nalgebra::{Rotation3, Unit, Vector3};
use sweepsim_motion::{Pose, TipCourse};

/// The most chords of a move.
const MOST: f64 = 1e6;

/// Poses along a move between two poses, the last one included, within `tolerance` of its course. The axis turns evenly, or with what the table carries.
pub(super) fn chords(course: &TipCourse, from: &Pose, to: &Pose, tolerance: f64) -> Vec<Pose> {
    let ends = [from.tip(), to.tip()];
    let count = (course.bend(ends) / (8.0 * tolerance)).sqrt().ceil().clamp(1.0, MOST);
    let (a, b) = (Vector3::from(from.axis()), Vector3::from(to.axis()));
    let between = a.cross(&b);
    let angle = between.norm().atan2(a.dot(&b));
    let axis = |s: f64| match (course, Unit::try_new(between, 1e-12)) {
        (TipCourse::Carried(turns), _) => {
            let [tip, above] = [[0.0; 3], from.axis()].map(|point| Vector3::from(turns.turned(point, s)));
            above - tip
        }
        (_, Some(between)) => Rotation3::from_axis_angle(&between, s * angle) * a,
        (_, None) => a,
    };
    let pose = |chord: usize| {
        let s = chord as f64 / count;
        Pose::new(course.tip(ends, s), axis(s).into()).ok()
    };
    (1..count as usize).filter_map(pose).chain([*to]).collect()
}
