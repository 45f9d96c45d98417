//! Moves against their laws: dense sampling within the stated deviation; rates against differences; errors.

use nalgebra::{Matrix3, Rotation3, Vector3};
use sweepsim_motion::{
    ArcError, Law, MotionError, Move, Path, PathError, Pose, RotaryTable, Segment, SegmentEnd, SplineMotion,
    TableTurns, TipArc, TipCourse, Turning,
};
use sweepsim_props::*;
use sweepsim_spline::{BSpline, KnotVector, RationalSpline};

pub const REACH: f64 = 40.0;

pub fn tip() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-20.0..20.0)
}

pub fn axis() -> impl Strategy<Value = [f64; 3]> {
    (-1.2..1.2, -3.0..3.0)
        .prop_map(|(tilt, round): (f64, f64)| [tilt.sin() * round.cos(), tilt.sin() * round.sin(), tilt.cos()])
}

/// The law of a move in sines and cosines: the axis and the tip at a time.
fn law(from: &Pose, to: &Pose, way: &Move, time: f64) -> (Vector3<f64>, Vector3<f64>) {
    let tip = match way.course {
        TipCourse::Straight => Vector3::from(from.tip()) + (Vector3::from(to.tip()) - Vector3::from(from.tip())) * time,
        TipCourse::Arc(arc) => {
            let turned = |part: f64| {
                Vector3::from(arc.centre())
                    + Rotation3::from_axis_angle(
                        &nalgebra::Unit::new_unchecked(Vector3::from(arc.normal())),
                        arc.angle() * part,
                    ) * (Vector3::from(from.tip()) - Vector3::from(arc.centre()))
            };
            turned(time) + (Vector3::from(to.tip()) - turned(1.0)) * time
        }
        TipCourse::Carried(turns) => {
            // Where the table has turned back, the tool goes straight.
            let about = |arc: &TipArc, part: f64, point: Vector3<f64>| {
                let turn = Rotation3::from_scaled_axis(Vector3::from(arc.normal()) * (arc.angle() * part));
                Vector3::from(arc.centre()) + turn * (point - Vector3::from(arc.centre()))
            };
            let back = turns
                .turns()
                .fold(Vector3::from(to.tip()), |point, arc| about(arc, -1.0, point));
            let seen = Vector3::from(from.tip()).lerp(&back, time);
            turns.turns().rev().fold(seen, |point, arc| about(arc, time, point))
        }
    };
    let axis = if let Turning::Rotary { table, from, to } = way.turning {
        Vector3::from(table.axis([0, 1].map(|k| from[k] + (to[k] - from[k]) * time)))
    } else {
        let (o0, o1) = (Vector3::from(from.axis()), Vector3::from(to.axis()));
        let cross = o0.cross(&o1);
        let angle = cross.norm().atan2(o0.dot(&o1));
        if angle < 1e-12 {
            o0
        } else {
            o0 * (angle * time).cos() + cross.normalize().cross(&o0) * (angle * time).sin()
        }
    };
    (axis, tip)
}

/// The largest deviation of a point within reach, over a dense sampling: that of the tip, and of the axis times the reach.
fn deviation(path: &Path, limit: f64) -> f64 {
    let parts = path.segments(0, REACH, limit);
    let (from, to) = (&path.poses()[0], &path.poses()[1]);
    let mut worst: f64 = 0.0;
    for (n, part) in parts.iter().enumerate() {
        for step in 0..=40 {
            let t = f64::from(step) / 40.0;
            let time = (n as f64 + part.time(t)) / parts.len() as f64;
            let (turn, tip) = part.at(t);
            assert!((turn.tr_mul(&turn) - Matrix3::identity()).norm() < 1e-13);
            let (axis, expected) = law(from, to, &path.way(0), time);
            worst = worst.max((Vector3::from(tip) - expected).norm() + (turn.column(2) - axis).norm() * REACH);
        }
    }
    worst
}

fn move_of(kind: usize, from: [f64; 3], to: [f64; 3], angles: [[f64; 2]; 2], axes: [[f64; 3]; 2]) -> Option<Path> {
    let plain = || Some(vec![Pose::new(from, axes[0]).ok()?, Pose::new(to, axes[1]).ok()?]);
    let arc = || TipArc::new([1.0, 2.0, 0.5], [0.1, 0.2, 1.0], angles[0][1].to_radians() + 0.1).expect("an arc");
    let table = if kind.is_multiple_of(2) {
        RotaryTable::Ac
    } else {
        RotaryTable::Bc
    };
    let rotary = |course| {
        let poses = vec![
            Pose::new(from, table.axis(angles[0])).ok()?,
            Pose::new(to, table.axis(angles[1])).ok()?,
        ];
        let turning = Turning::Rotary {
            table,
            from: angles[0],
            to: angles[1],
        };
        Path::with_moves(poses, vec![Move { course, turning }]).ok()
    };
    match kind {
        0 => Path::with_law(plain()?, Law::ConstantSpeed).ok(),
        1 => Path::with_moves(plain()?, vec![Move::arc(arc())]).ok(),
        2 | 3 => rotary(TipCourse::Straight),
        4 | 5 => rotary(TipCourse::Arc(arc())),
        6 => {
            let (course, turning) = (TipCourse::Carried(TableTurns::new(arc())), Turning::Even);
            Path::with_moves(plain()?, vec![Move { course, turning }]).ok()
        }
        7 => rotary(TipCourse::Carried(TableTurns::new(arc()))),
        _ => {
            let other = TipArc::new([-3.0, 0.0, 2.0], [1.0, -0.3, 0.2], angles[1][0].to_radians()).ok()?;
            rotary(TipCourse::Carried(TableTurns::new(arc()).on(other)))
        }
    }
}

/// Rates against differences, and the twist against both.
fn twist_is_the_rate_of(part: &Segment, t: f64) -> Result<(), TestCaseError> {
    let h = 1e-5;
    let ((a, p), (c, q)) = (part.at(t - h), part.at(t + h));
    let over = |rate: (Vec<Vector3<f64>>, Vec<f64>)| bernstein(&rate.0, t) / bernstein(&rate.1, t);
    prop_assert!((over(part.tip_rate()) - (Vector3::from(q) - Vector3::from(p)) / (2.0 * h)).norm() < 1e-4);
    let (rate, weights) = part.turn_rate();
    let slope = bernstein(&rate, t) / bernstein(&weights, t);
    prop_assert!((slope - (c - a) / (2.0 * h)).norm() < 1e-4);
    // The twist is the body velocity, times one positive factor.
    let (turn, _) = part.at(t);
    let own = turn.tr_mul(&slope);
    let spin = Vector3::new(own[(2, 1)], own[(0, 2)], own[(1, 0)]);
    let travel = turn.tr_mul(&over(part.tip_rate()));
    let (spins, travels) = part.twist();
    let (found_spin, found_travel) = (bernstein(&spins, t), bernstein(&travels, t));
    let factor = (found_spin.norm() + found_travel.norm()) / (spin.norm() + travel.norm());
    prop_assert!((found_spin - spin * factor).norm() < 1e-10 * factor);
    prop_assert!((found_travel - travel * factor).norm() < 1e-10 * factor * (1.0 + travel.norm()));
    Ok(())
}

/// Parts of one move join without a kink: the velocity after is a positive multiple of that before.
fn smooth(parts: &[Segment]) -> Result<(), TestCaseError> {
    for pair in parts.windows(2) {
        prop_assert!((Vector3::from(pair[0].tips()[1]) - Vector3::from(pair[1].tips()[0])).norm() < 1e-12);
        let [before, after] = [
            pair[0].velocity(SegmentEnd::Finish),
            pair[1].velocity(SegmentEnd::Start),
        ]
        .map(|both| both.map(Vector3::from));
        let size = |v: &[Vector3<f64>; 2]| v[0].norm() * REACH + v[1].norm();
        let factor = size(&after) / size(&before);
        for k in 0..2 {
            prop_assert!((after[k] - before[k] * factor).norm() <= 1e-9 * size(&after));
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_move_deviates_from_its_law_by_more_than_stated(
        kind in 0_usize..11, from in tip(), to in tip(), axes in [axis(), axis()],
        angles in prop::array::uniform2([-80.0..80.0, -400.0..400.0]), limit in 1e-6..1e-2,
    ) {
        let path = move_of(kind, from, to, angles, axes);
        prop_assume!(path.is_some());
        let worst = deviation(&path.unwrap(), limit);
        // Rounding of coordinates and angles of this size.
        prop_assert!(worst <= limit + 1e-11, "{worst:e} {limit:e}");
    }

    #[test]
    fn rates_are_derivatives(
        kind in 0_usize..11, from in tip(), to in tip(), axes in [axis(), axis()],
        angles in prop::array::uniform2([-80.0..80.0, -400.0..400.0]), t in 0.01..0.99,
    ) {
        let path = move_of(kind, from, to, angles, axes);
        prop_assume!(path.is_some());
        let parts = path.unwrap().segments(0, REACH, 1e-1);
        twist_is_the_rate_of(&parts[parts.len() / 2], t)?;
    }

    /// However a symmetric tool turns about its own axis: axis and tip are those of the law, rates are derivatives, parts join smoothly.
    #[test]
    fn a_symmetric_tool_goes_the_same_way(
        from in tip(), to in tip(), tilts in [(0.0..0.015, -3.0..3.0), (0.0..0.015, -3.0..3.0)], down in any::<bool>(), change in 0_usize..3,
        normal in (-0.01..0.01, -0.01..0.01), angle in prop_oneof![-7.0..-0.1, 0.1..7.0], limit in 1e-6..1e-2, t in 0.01..0.99,
    ) {
        let sign = if down { -1.0 } else { 1.0 };
        let [a, b] = tilts.map(|(tilt, round): (f64, f64)| [tilt.sin() * round.cos(), tilt.sin() * round.sin(), sign * tilt.cos()]);
        let arc = TipArc::new([1.0, 2.0, 0.5], [normal.0, normal.1, 1.0], angle).expect("an arc");
        // Level, or rising by whatever the end is off.
        let end = if change == 1 { to } else { (Vector3::from(arc.centre()) + Rotation3::from_axis_angle(&nalgebra::Unit::new_unchecked(Vector3::from(arc.normal())), angle) * (Vector3::from(from) - Vector3::from(arc.centre()))).into() };
        let poses = vec![Pose::new(from, a).expect("a pose"), Pose::new(end, if change == 0 { a } else { b }).expect("a pose")];
        let path = Path::with_moves(poses.clone(), vec![Move::arc(arc)]).expect("a path");
        let parts = path.segments_of_symmetric(0, REACH, limit);
        prop_assert_eq!(parts.len(), path.segments(0, REACH, limit).len());
        let mut turned = 0;
        for (n, part) in parts.iter().enumerate() {
            // What lets both be bounded together.
            prop_assert_eq!(part.weights(), &part.points().1[..]);
            turned += usize::from(part.turns().len() > 1);
            for step in 0..=10 {
                let at = f64::from(step) / 10.0;
                let (turn, tip) = part.at(at);
                prop_assert!((turn.tr_mul(&turn) - Matrix3::identity()).norm() < 1e-13);
                let (axis, expected) = law(&poses[0], &poses[1], &path.way(0), (n as f64 + part.time(at)) / parts.len() as f64);
                let off = (Vector3::from(tip) - expected).norm() + (turn.column(2) - axis).norm() * REACH;
                prop_assert!(off <= limit + 1e-11, "{off:e} {limit:e}");
            }
        }
        prop_assert_eq!(turned, parts.len());
        twist_is_the_rate_of(&parts[parts.len() / 2], t)?;
        smooth(&parts)?;
    }

    /// Parts of one move join without a kink: the velocity after is a positive multiple of that before.
    #[test]
    fn parts_join_smoothly(
        kind in 0_usize..11, from in tip(), to in tip(), axes in [axis(), axis()],
        angles in prop::array::uniform2([-80.0..80.0, -400.0..400.0]),
    ) {
        let path = move_of(kind, from, to, angles, axes);
        prop_assume!(path.is_some());
        let parts = path.unwrap().segments(0, REACH, 1e-3);
        smooth(&parts)?;
    }
}

fn bernstein<A>(list: &[A], t: f64) -> A
where
    A: Copy + std::ops::Add<Output = A> + std::ops::Mul<f64, Output = A>,
{
    let mut work = list.to_vec();
    for level in (1..work.len()).rev() {
        for i in 0..level {
            work[i] = work[i] * (1.0 - t) + work[i + 1] * t;
        }
    }
    work[0]
}

/// The number of parts falls with the cube root of the deviation for two turns out of step, with the fifth root for a straight tip.
#[test]
fn parts_grow_with_the_stated_powers() {
    let up = [0.0, 0.0, 1.0];
    let poses = vec![
        Pose::new([0.0; 3], up).unwrap(),
        Pose::new([10.0, 0.0, 0.0], [1.0, 0.0, 1.0]).unwrap(),
    ];
    let even = Path::with_law(poses, Law::ConstantSpeed).unwrap();
    let count = |path: &Path, limit: f64| path.segments(0, REACH, limit).len();
    let counts = [1e-4, 1e-9].map(|limit| count(&even, limit));
    // 10 e₅(45°/m)/m: (4.2e-4 / limit)^(1/5) = 1.3 and 13.4.
    assert_eq!(counts, [2, 14]);
    let table = RotaryTable::Ac;
    let (from, to) = ([10.0, 0.0], [40.0, 60.0]);
    let poses = [from, to]
        .map(|angles| Pose::new([0.0; 3], table.axis(angles)).unwrap())
        .to_vec();
    let rotary = Path::with_moves(poses, vec![Move::straight(Turning::Rotary { table, from, to })]).unwrap();
    let counts = [1e-3, 1e-6].map(|limit| count(&rotary, limit) as f64);
    assert!((counts[1] / counts[0] - 10.0).abs() < 1.0, "{counts:?}");
    // SLERP is one part, exact by definition, and so is a turn in place.
    let still = vec![
        Pose::new([0.0; 3], up).unwrap(),
        Pose::new([0.0; 3], [1.0, 0.0, 1.0]).unwrap(),
    ];
    assert_eq!(count(&Path::with_law(still, Law::ConstantSpeed).unwrap(), 1e-15), 1);
}

fn knots(degree: usize) -> KnotVector {
    KnotVector::new(degree, [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat()).unwrap()
}

fn straight() -> RationalSpline {
    RationalSpline::new(vec![knots(1)], 3, &[0.0, 0.0, 0.0, 5.0, 1.0, 0.0], &[1.0; 2]).unwrap()
}

/// Such a motion has no turn whose coefficients cancel, whatever the degree it is given in.
#[test]
fn equal_orientations_have_one_coefficient() {
    let q = [1.0, 0.3, -0.2, 0.5];
    let quaternions = [0, 1, 3].map(|degree| {
        let turn = BSpline::new(vec![knots(degree)], 4, q.repeat(degree + 1)).unwrap();
        SplineMotion::from_quaternions(&turn, &straight()).unwrap()
    });
    let rows = Rotation3::new(Vector3::new(0.3, 0.5, -0.2))
        .transpose()
        .matrix()
        .as_slice()
        .to_vec();
    let matrices = [0, 1, 3].map(|degree| {
        let weights = vec![2.0; degree + 1];
        let turn = RationalSpline::new(vec![knots(degree)], 9, &rows.repeat(degree + 1), &weights).unwrap();
        SplineMotion::from_matrices(&turn, &straight(), 1e-9).unwrap()
    });
    for same in [quaternions, matrices] {
        let segments = same.map(|motion| Path::along(motion).segments(0, 10.0, 1e-6));
        assert!(segments.iter().flatten().all(|segment| segment.turns().len() == 1));
        assert_eq!(segments[0], segments[1]);
        assert_eq!(segments[0], segments[2]);
    }
}

#[test]
fn matrices_that_are_no_rotations_are_refused_with_place_and_size() {
    // A chord of rotations: in the middle it is no rotation.
    let turn = |angle: f64| {
        Rotation3::from_axis_angle(&Vector3::z_axis(), angle)
            .transpose()
            .matrix()
            .as_slice()
            .to_vec()
    };
    let chord = RationalSpline::new(vec![knots(1)], 9, &[turn(0.0), turn(0.1)].concat(), &[1.0; 2]).unwrap();
    match SplineMotion::from_matrices(&chord, &straight(), 1e-9) {
        // 1 − cos²(0.05) in two directions at the middle, and nothing at the ends.
        Err(MotionError::NoRotation { at, deviation, .. }) => {
            assert!(
                (0.0..1.0).contains(&at) && deviation > 1e-9 && deviation < 0.01,
                "{at} {deviation}"
            );
        }
        other => panic!("{other:?}"),
    }
    let mirror = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0];
    let mirror = RationalSpline::new(vec![knots(1)], 9, &[mirror, mirror].concat(), &[1.0; 2]).unwrap();
    assert_eq!(
        SplineMotion::from_matrices(&mirror, &straight(), 1e-9),
        Err(MotionError::Mirrored)
    );
    assert_eq!(
        SplineMotion::from_matrices(&chord, &straight(), 1.0),
        Err(MotionError::Tolerance(1.0))
    );
    let vanishing = BSpline::new(vec![knots(1)], 4, vec![1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0]).unwrap();
    assert!(matches!(
        SplineMotion::from_quaternions(&vanishing, &straight()),
        Err(MotionError::NoOrientation { at }) if (at - 0.5).abs() < 0.01
    ));
    let short = KnotVector::new(1, vec![0.0, 0.0, 0.5, 0.5]).unwrap();
    let short = BSpline::new(vec![short], 4, vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]).unwrap();
    assert!(matches!(
        SplineMotion::from_quaternions(&short, &straight()),
        Err(MotionError::Domains { .. })
    ));
}

#[test]
fn bad_moves_and_arcs_say_what_is_wrong() {
    let up = [0.0, 0.0, 1.0];
    let at = |x: f64| Pose::new([x, 0.0, 0.0], up).unwrap();
    let error = |poses, moves| Path::with_moves(poses, moves).unwrap_err();
    assert_eq!(
        error(vec![at(0.0), at(1.0)], vec![]),
        PathError::Count { moves: 0, poses: 2 }
    );
    let turning = Turning::Rotary {
        table: RotaryTable::Ac,
        from: [0.0, 0.0],
        to: [5.0, 0.0],
    };
    assert_eq!(
        error(vec![at(0.0), at(1.0)], vec![Move::straight(turning)]),
        PathError::Rotary { index: 0 }
    );
    assert_eq!(TipArc::new([0.0; 3], [0.0; 3], 1.0), Err(ArcError::Normal([0.0; 3])));
    assert_eq!(TipArc::new([0.0; 3], up, 0.0), Err(ArcError::Angle(0.0)));
    let between = |a, b| TipArc::between(a, b, [0.0; 3], up, 1);
    assert!(matches!(
        between([1.0, 0.0, 0.0], [0.0, 2.0, 0.0]),
        Err(ArcError::TwoRadii { .. })
    ));
    assert!(matches!(
        between([0.0; 3], [0.0, 2.0, 0.0]),
        Err(ArcError::NoRadius { .. })
    ));
    assert_eq!(between([f64::NAN, 0.0, 0.0], [0.0, 2.0, 0.0]), Err(ArcError::NotFinite));
    let full = between([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]).unwrap();
    assert!((full.angle() - std::f64::consts::TAU).abs() < 1e-15);
}
