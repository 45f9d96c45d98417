//! Boxes around what a solid sweeps.

use nalgebra::Matrix3;
use sweepsim_motion::{BoundingCylinder, Segment};

/// A box around all positions of a cylinder about the tool's axis: its lowest and highest coordinate in each direction, each moved outward by `margin`.
///
/// The control values of `A q` over all `q` of the cylinder, and of the tip, hold them, since weights are positive.
pub(crate) fn swept_box(segment: &Segment, cylinder: BoundingCylinder, margin: f64) -> [[f64; 2]; 3] {
    let (points, weights) = segment.points();
    let own = offsets(segment, cylinder);
    [0, 1, 2].map(|k| {
        let tips = points.iter().zip(&weights).map(|(point, weight)| point[k] / weight);
        let tip = tips.fold([f64::INFINITY, f64::NEG_INFINITY], |r, x| [r[0].min(x), r[1].max(x)]);
        [tip[0] + own[k][0] - margin, tip[1] + own[k][1] + margin]
    })
}

/// How far a cylinder about the tool's axis reaches from the tip in each direction, at any time.
pub(super) fn offsets(segment: &Segment, cylinder: BoundingCylinder) -> [[f64; 2]; 3] {
    let turns = segment.turns().iter().zip(segment.weights());
    let turns: Vec<Matrix3<f64>> = turns.map(|(turn, weight)| turn / *weight).collect();
    [0, 1, 2].map(|k| {
        let mut own = [f64::INFINITY, f64::NEG_INFINITY];
        for turn in &turns {
            let across = cylinder.radius * turn[(k, 0)].hypot(turn[(k, 1)]);
            let along = cylinder.z.map(|z| z * turn[(k, 2)]);
            own[0] = own[0].min(along[0].min(along[1]) - across);
            own[1] = own[1].max(along[0].max(along[1]) + across);
        }
        own
    })
}
