//! Parts of segments: the same motion, between two of its times.

use nalgebra::{Matrix3, Vector3};
use sweepsim_motion::{Law, Move, Path, Pose, RotaryTable, Segment, SegmentEnd, TipArc, TipCourse, Turning};
use sweepsim_props::*;

fn pose(tip: [f64; 3], axis: [f64; 3]) -> Pose {
    Pose::new(tip, axis).unwrap()
}

/// Segments of all kinds: straight, with a turn, at constant speed, by rotary axes, along an arc.
fn segments(tip: [f64; 3], tilt: f64) -> Vec<Segment> {
    let (s, c) = tilt.sin_cos();
    let from = pose([1.0, 2.0, 3.0], [0.0, 0.0, 1.0]);
    let to = pose(tip, [0.6 * s, 0.8 * s, c]);
    let table = RotaryTable::Ac;
    let angles = [[0.0, 0.0], [20.0 * tilt, 35.0]];
    let turned = angles.map(|angles| pose(if angles[1] == 0.0 { [0.0; 3] } else { tip }, table.axis(angles)));
    let rotary = Move {
        course: TipCourse::Straight,
        turning: Turning::Rotary {
            table,
            from: angles[0],
            to: angles[1],
        },
    };
    let around = [
        pose([5.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
        pose([0.0, 5.0, tilt], [s, 0.0, c]),
    ];
    let arc = Move {
        course: TipCourse::Arc(
            TipArc::between([5.0, 0.0, 0.0], [0.0, 5.0, tilt], [0.0; 3], [0.0, 0.0, 1.0], 1).unwrap(),
        ),
        turning: Turning::Even,
    };
    let mut all = Segment::between(&from, &to);
    let even = Path::with_law(vec![from, to], Law::ConstantSpeed).unwrap();
    all.extend(even.segments(0, 40.0, 1e-4));
    let rotary = Path::with_moves(turned.to_vec(), vec![rotary]).unwrap();
    all.extend(rotary.segments(0, 40.0, 1e-3));
    let arc = Path::with_moves(around.to_vec(), vec![arc]).unwrap();
    all.extend(arc.segments(0, 40.0, 1e-3));
    all.extend(arc.segments_of_symmetric(0, 40.0, 1e-3));
    all
}

/// `Ω` and `b′` at a time of a segment, by differences of a point's place in the tool.
fn place(segment: &Segment, t: f64) -> [Vector3<f64>; 3] {
    let (turn, tip): (Matrix3<f64>, [f64; 3]) = segment.at(t);
    [Vector3::x(), Vector3::y(), Vector3::new(1.0, 2.0, 30.0)].map(|q| turn * q + Vector3::from(tip))
}

proptest! {
    #[test]
    fn a_part_is_the_same_motion(tip in prop::array::uniform3(-20.0_f64..20.0), tilt in 0.05_f64..1.4,
        ends in (0.0_f64..1.0, 0.0_f64..1.0), s in 0.0_f64..1.0) {
        let window = [ends.0.min(ends.1), ends.0.max(ends.1)];
        prop_assume!(window[1] - window[0] > 1e-3);
        for segment in segments(tip, tilt) {
            let part = segment.part(window[0], window[1]);
            prop_assert_eq!(part.is_arc(), segment.is_arc());
            let t = window[0] + (window[1] - window[0]) * s;
            for (a, b) in place(&part, s).iter().zip(place(&segment, t)) {
                prop_assert!((a - b).norm() < 1e-11, "{} {}", a, b);
            }
            // The twist is that of the whole, up to a positive factor: it decides what is on the envelope.
            for (end, t) in [(SegmentEnd::Start, window[0]), (SegmentEnd::Finish, window[1])] {
                let [spin, travel] = part.velocity(end).map(Vector3::from);
                let h = 1e-6;
                let (low, high) = ((t - h).max(0.0), (t + h).min(1.0));
                let q = Vector3::new(3.0, -2.0, 7.0);
                let at = |t: f64| { let (turn, tip) = segment.at(t); turn * q + Vector3::from(tip) };
                let (turn, _) = segment.at(t);
                let seen = (at(high) - at(low)) / (high - low);
                let said = spin.cross(&(turn * q)) + travel;
                if seen.norm() > 1e-3 {
                    prop_assert!((said.normalize() - seen.normalize()).norm() < 1e-3, "{} {}", said, seen);
                }
            }
        }
    }

    #[test]
    fn times_and_parameters_are_inverse(tip in prop::array::uniform3(-20.0_f64..20.0), tilt in 0.05_f64..1.4, t in 0.0_f64..1.0) {
        for segment in segments(tip, tilt) {
            prop_assert!((segment.at_time(segment.time(t)) - t).abs() < 1e-12);
        }
    }
}
