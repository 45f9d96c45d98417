//! Which arcs are worth keeping: see [`ReadOptions::level_arcs`](crate::ReadOptions::level_arcs).

use sweepsim_motion::TipArc;

/// The largest radius of an arc that is kept, in millimetres: coordinates as large as that of its centre have fewer decimals.
const LARGEST: f64 = 1e4;
/// The largest difference of the distances of its ends from its centre.
const SPIRAL: f64 = 1e-9;

/// Whether an arc between two tips turns about z, with both of them equally far from its centre.
pub(crate) fn is_level(arc: &TipArc, from: [f64; 3], to: [f64; 3]) -> bool {
    let [x, y, z] = arc.normal();
    let [cx, cy, _] = arc.centre();
    let [a, b] = [from, to].map(|[x, y, _]| (x - cx).hypot(y - cy));
    [x, y] == [0.0; 2] && z.abs() == 1.0 && (a - b).abs() <= SPIRAL && a.max(b) <= LARGEST
}
