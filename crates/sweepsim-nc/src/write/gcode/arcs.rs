//! Arcs in planes of the axes, and chords of the others.

use std::f64::consts::TAU;

use nalgebra::{Rotation3, Unit, Vector3};
use sweepsim_motion::{Pose, TipArc};

use super::steps::PlaneArc;

/// The most chords of an arc.
const MOST_CHORDS: f64 = 1e6;

/// The arc of the tip from `tip`, where ways of the tip are those of the axes by `along`; `None` if it lies in no plane of the axes.
pub(super) fn in_plane(arc: &TipArc, tip: [f64; 3], along: &dyn Fn([f64; 3]) -> [f64; 3]) -> Option<PlaneArc> {
    let normal = Vector3::from(arc.normal());
    let out = Vector3::from(arc.centre()) - Vector3::from(tip);
    let inward = out - normal * normal.dot(&out);
    let across = normal.cross(&inward);
    let [n, i, a] = [normal, inward, across].map(|way| Vector3::from(along(way.into())));
    let radius = inward.norm();
    // Axes at right angles, with the arc's plane across one of them.
    let round = (i.norm() - radius).abs() < 1e-9 && (a.norm() - radius).abs() < 1e-9 && i.dot(&a).abs() < 1e-9 * radius;
    let w = (0..3).find(|&w| (n[w].abs() - 1.0).abs() < 1e-12)?;
    let flat = i[w].abs() < 1e-9 && a[w].abs() < 1e-9;
    if !(round && flat) {
        return None;
    }
    // The axes may be left-handed.
    let sweep = arc.angle() * i.cross(&a)[w].signum();
    let turns = sweep.abs() / TAU;
    let whole = is_whole(sweep);
    Some(PlaneArc {
        w,
        offset: i.into(),
        sweep,
        turns: if whole { turns.round() } else { turns.ceil() }.max(1.0),
    })
}

/// Whether a sweep consists of full turns.
pub(super) fn is_whole(sweep: f64) -> bool {
    let turns = sweep.abs() / TAU;
    turns > 0.5 && (turns - turns.round()).abs() < 1e-9
}

/// Poses along an arc between two poses, the last one included: within `tolerance` of it, the axis turning evenly.
pub(super) fn chords(arc: &TipArc, from: &Pose, to: &Pose, tolerance: f64) -> Vec<Pose> {
    let normal = Unit::new_normalize(Vector3::from(arc.normal()));
    let centre = Vector3::from(arc.centre());
    let split = |pose: &Pose| {
        let out = Vector3::from(pose.tip()) - centre;
        let height = normal.dot(&out);
        (out - normal.scale(height), height)
    };
    let ((start, low), (end, high)) = (split(from), split(to));
    let radius = start.norm().max(end.norm());
    // A chord over 2h leaves r (1 − cos h) = 2 r sin²(h/2).
    let half = 2.0 * (tolerance / (2.0 * radius)).sqrt().min(0.7).asin();
    let count = (arc.angle().abs() / (2.0 * half)).ceil().clamp(1.0, MOST_CHORDS);
    let growth = end.norm() / start.norm() - 1.0;
    let (a, b) = (Vector3::from(from.axis()), Vector3::from(to.axis()));
    let between = a.cross(&b);
    let turn = between.norm().atan2(a.dot(&b));
    let mut poses: Vec<Pose> = (1..count as usize)
        .filter_map(|chord| {
            let s = chord as f64 / count;
            let out = Rotation3::from_axis_angle(&normal, s * arc.angle()) * start * (1.0 + s * growth);
            let tip = centre + out + normal.scale(low + s * (high - low));
            let axis = match Unit::try_new(between, 1e-12) {
                Some(between) => Rotation3::from_axis_angle(&between, s * turn) * a,
                None => a,
            };
            Pose::new(tip.into(), axis.into()).ok()
        })
        .collect();
    poses.push(*to);
    poses
}
