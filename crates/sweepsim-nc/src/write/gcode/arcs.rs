//! Arcs in planes of the axes.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use sweepsim_motion::TipArc;

use super::steps::PlaneArc;

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
