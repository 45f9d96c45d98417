//! Single moves of every kind that turns the axis, for tests.

use sweepsim_motion::{Move, Path, Pose, RotaryTable, SplineMotion, TableTurns, TipArc, TipCourse, Turning};
use sweepsim_spline::{BSpline, KnotVector, RationalSpline};

/// The number of kinds.
pub const KINDS: usize = 6;

type Place = [f64; 3];

/// A move of a kind from one tip and axis to another; `None` where there is none. Where a tip goes along an arc, both
/// give its chord.
pub fn path(kind: usize, [from, to]: [(Place, Place); 2]) -> Option<Path> {
    let pose = |(tip, axis): (Place, Place)| Pose::new(tip, axis).ok();
    let one = |ends: [Option<Pose>; 2], way: Move| {
        let [first, last] = ends;
        Path::with_moves(vec![first?, last?], vec![way]).ok()
    };
    let table = RotaryTable::Ac;
    let angles = [from.1, to.1].map(|axis| table.angles(axis, [0.0; 2]));
    match kind {
        0 | 1 => {
            let turning = [Turning::Slerp, Turning::Even][kind];
            one([pose(from), pose(to)], Move::straight(turning))
        }
        2 => {
            let [from_angles, to_angles] = angles;
            let turning = Turning::Rotary {
                table,
                from: from_angles,
                to: to_angles,
            };
            one([pose(from), pose(to)], Move::straight(turning))
        }
        // An arc, or a helix, about an axis beside the chord that lies across it but for the rise.
        3 => {
            let way = [0, 1, 2].map(|k| to.0[k] - from.0[k]);
            let centre = [
                0.5 * (from.0[0] + to.0[0]) - 0.8 * way[1],
                0.5 * (from.0[1] + to.0[1]) + 0.8 * way[0],
                0.0,
            ];
            let arc = TipArc::between(from.0, to.0, centre, [0.0, 0.0, 1.0], 1).ok()?;
            one([pose(from), pose(to)], Move::arc(arc))
        }
        // A tool that goes straight while a table turns the part about z.
        4 => {
            let [[tilt, round], _] = angles;
            let angle = 40.0 * (to.0[0] - from.0[0]).sin();
            let (s, c) = (-angle).to_radians().sin_cos();
            let [x, y, z] = [0, 1, 2].map(|k| from.0[k] + 0.3 * (to.0[k] - from.0[k]));
            let arc = TipArc::new([0.0; 3], [0.0, 0.0, 1.0], (-angle).to_radians()).ok()?;
            let way = Move {
                course: TipCourse::Carried(TableTurns::new(arc)),
                turning: Turning::Rotary {
                    table,
                    from: [tilt, round],
                    to: [tilt, round + angle],
                },
            };
            let turned = [c * x - s * y, s * x + c * y, z];
            let last = pose((turned, table.axis([tilt, round + angle])));
            one([pose(from), last], way)
        }
        // Quaternions and a rational tip.
        _ => {
            let knots = |degree| KnotVector::new(degree, [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat());
            let turns = [
                [1.0, 0.4 * from.1[0], 0.4 * from.1[1], 0.0],
                [1.0, 0.4 * to.1[0], 0.4 * to.1[1], 0.1 * to.1[2]],
            ];
            let turn = BSpline::new(vec![knots(1).ok()?], 4, turns.concat()).ok()?;
            let part =
                |share: f64, off: f64| [0, 1, 2].map(|k| from.0[k] + share * (to.0[k] - from.0[k]) + off * from.1[k]);
            let tips = [from.0, part(0.3, 0.1), part(0.7, -0.1), to.0];
            let tip = RationalSpline::new(vec![knots(3).ok()?], 3, &tips.concat(), &[1.0, 0.95, 1.1, 1.05]).ok()?;
            SplineMotion::from_quaternions(&turn, &tip).ok().map(Path::along)
        }
    }
}
