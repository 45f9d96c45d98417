//! Chords of moves that a format has no words for.

use nalgebra::{Rotation3, Unit, Vector3};
use sweepsim_motion::{Pose, TipCourse};

/// The most chords of a move.
const MOST: f64 = 1e6;

/// Poses along a move between two poses, the last one included, within `tolerance` of its course: on an arc the axis turns evenly, and what a table
/// carries turns with it.
pub(super) fn chords(course: &TipCourse, from: &Pose, to: &Pose, tolerance: f64) -> Vec<Pose> {
    let Some(arc) = course.arc() else { return vec![*to] };
    let (ends, angle) = ([from.tip(), to.tip()], arc.angle());
    let normal = Unit::new_normalize(Vector3::from(arc.normal()));
    let radii = ends.map(|end| normal.cross(&(Vector3::from(end) - Vector3::from(arc.centre()))).norm());
    // The second derivative: what a frame that turns adds to what moves in it straight.
    let way = match course {
        TipCourse::Carried(_) => {
            let back = Rotation3::from_axis_angle(&normal, -angle);
            let [a, b] = ends.map(|end| Vector3::from(end) - Vector3::from(arc.centre()));
            (back * b - a).norm()
        }
        _ => 0.0,
    };
    let bend = angle * angle * radii[0].max(radii[1]) + 2.0 * angle.abs() * way;
    let count = (bend / (8.0 * tolerance)).sqrt().ceil().clamp(1.0, MOST);
    let (a, b) = (Vector3::from(from.axis()), Vector3::from(to.axis()));
    let between = a.cross(&b);
    let (about, turn) = match (course, Unit::try_new(between, 1e-12)) {
        (TipCourse::Carried(_), _) => (Some(normal), angle),
        (_, about) => (about, between.norm().atan2(a.dot(&b))),
    };
    let pose = |chord: usize| {
        let s = chord as f64 / count;
        let axis = about.map_or(a, |about| Rotation3::from_axis_angle(&about, s * turn) * a);
        Pose::new(course.tip(ends, s), axis.into()).ok()
    };
    (1..count as usize).filter_map(pose).chain([*to]).collect()
}
