//! Moves that go back, and a table that carries the part.

use crate::motions::REACH;
use nalgebra::Vector3;
use sweepsim_motion::{Move, Path, Pose, RotaryTable, Segment, TableTurns, TipArc, TipCourse, Turning};

#[test]
fn a_reversed_move_goes_through_the_same_placements() {
    let table = RotaryTable::Bc;
    let angles = [[20.0, -30.0], [50.0, 80.0]];
    let arc = TipArc::new([0.0; 3], [0.0, 0.3, 1.0], 2.0).unwrap();
    let other = TipArc::new([1.0, 0.0, -2.0], [1.0, 0.2, 0.0], -0.8).unwrap();
    let turns = TableTurns::new(arc);
    for course in [
        TipCourse::Arc(arc),
        TipCourse::Carried(turns),
        TipCourse::Carried(turns.on(other)),
    ] {
        let way = Move {
            course,
            turning: Turning::Rotary {
                table,
                from: angles[0],
                to: angles[1],
            },
        };
        let poses = vec![
            Pose::new([3.0, 0.0, 0.0], table.axis(angles[0])).unwrap(),
            Pose::new([-1.0, 2.5, 1.0], table.axis(angles[1])).unwrap(),
        ];
        let back: Vec<Pose> = poses.iter().rev().copied().collect();
        let there = Path::with_moves(poses, vec![way]).unwrap();
        let back = Path::with_moves(back, vec![way.reversed()]).unwrap();
        let [there, back] = [there, back].map(|path| path.segments(0, REACH, 1e-6));
        assert_eq!(there.len(), back.len());
        let placed = |segment: &Segment, t: f64| {
            let (turn, tip) = segment.at(t);
            (turn.column(2).into_owned(), Vector3::from(tip))
        };
        for (k, segment) in there.iter().enumerate() {
            let (axis, tip) = placed(segment, 0.3);
            let (other, reached) = placed(&back[back.len() - 1 - k], 0.7);
            assert!((axis - other).norm() < 1e-6);
            // The drift of a reversed arc is turned with its end: both deviate from the law, and they agree only where
            // there is no drift. Where the frame turns, there is none.
            let is_carried = matches!(course, TipCourse::Carried(_));
            assert_eq!((tip - reached).norm() < 2e-6, is_carried, "{course:?}");
        }
    }
}

/// Under a table that turns by a full turn, a tool that goes out along a radius cuts a spiral of Archimedes.
#[test]
fn a_carried_tip_goes_along_a_spiral() {
    let (a, b) = (10.0, 14.0);
    let arc = TipArc::new([1.0, 2.0, 0.0], [0.0, 0.0, 1.0], std::f64::consts::TAU).unwrap();
    let up = [0.0, 0.0, 1.0];
    let poses = [a, b].map(|r| Pose::new([1.0 + r, 2.0, 0.0], up).unwrap());
    let course = TipCourse::Carried(TableTurns::new(arc));
    let turning = Turning::Even;
    let path = Path::with_moves(poses.to_vec(), vec![Move { course, turning }]).unwrap();
    let parts = path.segments(0, REACH, 1e-6);
    for (n, part) in parts.iter().enumerate() {
        for k in 0..=10 {
            let t = f64::from(k) / 10.0;
            let time = (n as f64 + part.time(t)) / parts.len() as f64;
            let (r, angle) = (a + (b - a) * time, std::f64::consts::TAU * time);
            let tip = Vector3::from(part.at(t).1) - Vector3::new(1.0, 2.0, 0.0);
            assert!((tip - Vector3::new(r * angle.cos(), r * angle.sin(), 0.0)).norm() < 1e-6);
        }
    }
    // ∫ √(r² + r′²) dφ with r = r′ (φ + φ₀): r′/2 [u √(1 + u²) + asinh u] over u = r/r′.
    let slope = (b - a) / std::f64::consts::TAU;
    let whole = |u: f64| 0.5 * slope * (u * u.hypot(1.0) + u.asinh());
    let length = whole(b / slope) - whole(a / slope);
    assert!(
        (path.tip_length(0) / length - 1.0).abs() < 1e-6,
        "{} {length}",
        path.tip_length(0)
    );
    assert!(path.size() >= 15.0 && path.size() < 80.0, "{}", path.size());
}
