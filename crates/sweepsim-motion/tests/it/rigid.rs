//! Tools that turn with an arc of their tip, as one rigid body with it.

use crate::motions::{REACH, axis, tip};
use nalgebra::{Rotation3, Vector3};
use sweepsim_motion::{Move, Path, Pose, TipArc};
use sweepsim_props::*;

proptest! {
    /// A tool that turns with an arc is one rigid body with it: the centre stays at one point of the tool but for the rise, and orientation and tip have the same weights, to the bit.
    #[test]
    fn tools_that_turn_with_an_arc_are_rigid(
        axis in axis(), side in axis(), normal in axis(), start in tip(), centre in tip(), angle in prop_oneof![-3.1..-0.01, 0.01..3.1_f64, 1e-4..0.1], rise in prop_oneof![Just(0.0), -5.0..5.0_f64],
    ) {
        let normal = Vector3::from(normal).normalize();
        let turn = Rotation3::from_scaled_axis(normal * angle);
        let first = Pose::with_side(start, axis, side);
        prop_assume!(first.is_ok());
        let first = first.unwrap();
        let turned = |v: [f64; 3]| <[f64; 3]>::from(turn * Vector3::from(v));
        let end = Vector3::from(centre) + turn * (Vector3::from(start) - Vector3::from(centre)) + normal * rise;
        let last = Pose::with_side(end.into(), turned(first.axis()), turned(first.side().unwrap())).unwrap();
        let arc = TipArc::new(centre, normal.into(), angle).unwrap();
        let path = Path::with_moves(vec![first, last], vec![Move::arc(arc)]).unwrap();
        let segments = path.segments(0, REACH, 1e-6);
        let mut seen = Vec::new();
        for (n, segment) in segments.iter().enumerate() {
            prop_assert!(segment.points().1 == segment.weights());
            for t in [0.0, 0.3, 0.8, 1.0] {
                let (turn, tip) = segment.at(t);
                let risen = normal * rise * ((n as f64 + segment.time(t)) / segments.len() as f64);
                seen.push(turn.tr_mul(&(Vector3::from(centre) + risen - Vector3::from(tip))));
            }
        }
        for other in &seen {
            prop_assert!((other - seen[0]).norm() < 1e-6 + 1e-12, "{other} {}", seen[0]);
            prop_assert!(rise != 0.0 || (other - seen[0]).norm() < 1e-12, "{other} {}", seen[0]);
        }
    }
}
