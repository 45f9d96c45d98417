//! Paths in another frame: every point of the tool is where the turn and the shift put it.

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use sweepsim_motion::{Law, Move, Path, PathError, Pose, RotaryTable, TipArc};
use sweepsim_props::*;

const REACH: f64 = 40.0;

fn vector(size: f64) -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-size..size).prop_map(Vector3::from)
}

fn rotation() -> impl Strategy<Value = Matrix3<f64>> {
    (vector(1.0), -3.0..3.0).prop_filter_map("an axis", |(axis, angle)| {
        let axis = Unit::try_new(axis, 1e-3)?;
        Some(Rotation3::from_axis_angle(&axis, angle).into_inner())
    })
}

/// One of the 24 turns of a cube: its rows are signed unit vectors.
fn quarter_turn() -> impl Strategy<Value = Matrix3<f64>> {
    (0usize..3, 0usize..2, 0u8..4).prop_map(|(first, other, signs)| {
        let second = (first + 1 + other) % 3;
        let unit = |axis: usize, negative: bool| {
            let mut unit = Vector3::zeros();
            unit[axis] = if negative { -1.0 } else { 1.0 };
            unit
        };
        let (x, y) = (unit(first, signs & 1 == 1), unit(second, signs & 2 == 2));
        Matrix3::from_columns(&[x, y, x.cross(&y)])
    })
}

fn path() -> impl Strategy<Value = Path> {
    let axis = (-1.2..1.2, -3.0..3.0)
        .prop_map(|(tilt, round): (f64, f64)| [tilt.sin() * round.cos(), tilt.sin() * round.sin(), tilt.cos()]);
    let pose = (prop::array::uniform3(-20.0..20.0), axis);
    (collection::vec(pose, 2..4), 0u8..5).prop_map(|(poses, law)| {
        let poses: Vec<Pose> = poses
            .iter()
            .map(|(tip, axis)| Pose::new(*tip, *axis).unwrap())
            .collect();
        match law {
            0 => Path::new(poses).unwrap(),
            1 => Path::with_law(poses, Law::ConstantSpeed).unwrap(),
            2 => Path::with_law(poses, Law::Rotary(RotaryTable::Ac)).unwrap(),
            3 => Path::with_law(poses, Law::Rotary(RotaryTable::Bc)).unwrap(),
            _ => {
                let arcs = (1..poses.len())
                    .map(|k| Move::arc(TipArc::new([1.0, 2.0, 3.0], [0.3, -0.2, 1.0], k as f64).unwrap()));
                let arcs = arcs.collect();
                Path::with_moves(poses, arcs).unwrap()
            }
        }
    })
}

proptest! {
    #[test]
    fn each_point_of_the_tool_is_carried_over(path in path(), turn in rotation(), shift in vector(90.0), again in rotation()) {
        let moved = path.moved(&turn, shift).unwrap();
        // Coordinates of up to 200, a few dozen roundings each.
        let tolerance = 1e-12;
        let near = |a: Vector3<f64>, b: Vector3<f64>| (a - b).norm() < tolerance;
        prop_assert_eq!(moved.moves(), path.moves());
        let mut largest = 0.0_f64;
        for number in 0..path.moves() {
            prop_assert_eq!(moved.tip_length(number), path.tip_length(number));
            prop_assert_eq!(moved.rests(number, number + 1), path.rests(number, number + 1));
            for symmetric in [false, true] {
                let segments = |path: &Path| if symmetric {
                    path.segments_of_symmetric(number, REACH, 1e-3)
                } else {
                    path.segments(number, REACH, 1e-3)
                };
                let (own, there) = (segments(&path), segments(&moved));
                prop_assert_eq!(own.len(), there.len());
                for (own, there) in own.iter().zip(&there) {
                    for t in [0.0, 0.3, 1.0] {
                        let ((a, b), (c, d)) = (own.at(t), there.at(t));
                        largest = largest.max(Vector3::from(d).amax());
                        prop_assert!(near(turn * Vector3::from(b) + shift, Vector3::from(d)));
                        prop_assert!((turn * a - c).norm() < tolerance);
                    }
                }
                // The poses are where the segments begin and end.
                let ends = [there[0].tips()[0], there[there.len() - 1].tips()[1]];
                for (pose, end) in moved.poses()[number..].iter().zip(ends) {
                    prop_assert!(near(Vector3::from(pose.tip()), Vector3::from(end)));
                }
            }
        }
        prop_assert!(largest <= moved.size());
        // Moved twice, it is moved by the product.
        let twice = moved.moved(&again, [1.0, 2.0, 3.0]).unwrap();
        let once = path.moved(&(again * turn), again * shift + Vector3::new(1.0, 2.0, 3.0)).unwrap();
        for (a, b) in twice.poses().iter().zip(once.poses()) {
            prop_assert!(near(Vector3::from(a.tip()), Vector3::from(b.tip())));
            prop_assert!(near(Vector3::from(a.axis()), Vector3::from(b.axis())));
        }
    }

    #[test]
    fn quarter_turns_are_exact(path in path(), turn in quarter_turn()) {
        let moved = path.moved(&turn, [0.0; 3]).unwrap();
        for (own, there) in path.poses().iter().zip(moved.poses()) {
            prop_assert_eq!(turn * Vector3::from(own.tip()), Vector3::from(there.tip()));
        }
        let back = moved.moved(&turn.transpose(), [0.0; 3]).unwrap();
        for number in 0..path.moves() {
            let (own, again) = (path.segments(number, REACH, 1e-3), back.segments(number, REACH, 1e-3));
            for (own, again) in own.iter().zip(&again) {
                prop_assert_eq!(own.at(0.5), again.at(0.5));
            }
        }
    }
}

#[test]
fn what_is_no_rotation_is_refused() {
    let pose = Pose::new([1.0; 3], [0.0, 0.0, 1.0]).unwrap();
    let path = Path::new(vec![pose, pose]).unwrap();
    let mirror = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -1.0));
    for (turn, shift) in [
        (mirror, [0.0; 3]),
        (Matrix3::identity() * 2.0, [0.0; 3]),
        (Matrix3::identity() * f64::NAN, [0.0; 3]),
        (Matrix3::identity(), [0.0, f64::INFINITY, 0.0]),
    ] {
        assert_eq!(path.moved(&turn, shift), Err(PathError::NoRotation));
    }
    assert_eq!(path.moved(&Matrix3::identity(), [0.0; 3]), Ok(path));
}
