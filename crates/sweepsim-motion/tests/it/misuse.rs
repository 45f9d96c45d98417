//! Misuse of the public constructors: numbers that are not finite, wrong sizes, absurd measures. Errors, never a panic.

use nalgebra::Matrix3;
use std::f64::consts::PI;
use sweepsim_motion::{
    Apt, ArcError, Barrel, Dovetail, Law, Lens, Lollipop, Move, Oval, Path, Pose, Profile, ProfileError,
    ProfileSegment, RotaryTable, SplineMotion, Taper, TipArc, Tool, Turn, Turning,
};
use sweepsim_props::collection::vec;
use sweepsim_props::*;
use sweepsim_spline::{BSpline, Bernstein, KnotVector, RationalSpline};

/// Numbers as users get them wrong.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => -20.0..20.0,
        4 => 0.0..20.0,
        1 => Just(0.0),
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(f64::NEG_INFINITY),
        1 => Just(1e308),
        1 => Just(5e-324)
    ]
}

fn three() -> impl Strategy<Value = [f64; 3]> {
    [number(), number(), number()]
}

/// A tool that was accepted has finite patches with positive weights, and a reach.
fn sound(tool: &Tool) -> bool {
    let finite = |form: &Bernstein| form.coefficients().iter().all(|c| c.is_finite());
    let patches = tool.patches().iter().all(|patch| {
        let fields = patch.field().normal().iter().chain(patch.field().moment());
        patch.position().iter().chain(fields).all(finite) && patch.weight().coefficients().iter().all(|w| *w > 0.0)
    });
    patches && tool.reach().is_finite() && tool.reach() > 0.0
}

fn segment() -> impl Strategy<Value = ProfileSegment> {
    let two = || [number(), number()];
    prop_oneof![
        two().prop_map(|to| ProfileSegment::Line { to }),
        (two(), two(), any::<bool>()).prop_map(|(to, centre, ccw)| ProfileSegment::Arc {
            to,
            centre,
            turn: if ccw { Turn::Ccw } else { Turn::Cw }
        }),
        (
            0..9_usize,
            prop::option::of(vec(number(), 0..12)),
            vec(two(), 0..7),
            prop::option::of(vec(number(), 0..7))
        )
            .prop_map(|(degree, knots, points, weights)| ProfileSegment::Spline {
                degree,
                knots,
                points,
                weights
            })
    ]
}

fn pose() -> impl Strategy<Value = Option<Pose>> {
    (three(), three(), prop::option::of(three())).prop_map(|(tip, axis, side)| match side {
        Some(side) => Pose::with_side(tip, axis, side).ok(),
        None => Pose::new(tip, axis).ok(),
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn cutters(a in number(), b in number(), c in number(), d in number(), e in number()) {
        let made = [
            Tool::ball(a, b),
            Tool::flat(a, b),
            Tool::bull(a, b, c),
            Tool::lollipop(Lollipop { radius: a, neck: b, length: c }),
            Tool::dovetail(Dovetail { radius: a, angle: b, height: c, neck: d, length: e }),
            Tool::barrel(Barrel { radius: a, flank: b, height: c, corner: d, length: e }),
            Tool::barrel(Barrel { radius: a, flank: b, height: c, corner: 0.0, length: e }),
            Tool::lens(Lens { radius: a, bottom: b, corner: c, length: d }),
            Tool::lens(Lens { radius: a, bottom: b, corner: 0.0, length: d }),
            Tool::oval(Oval { radius: a, tip: b, flank: c, length: d }),
            Tool::taper(Taper { radius: a, tip: b, flank: c, angle: d, length: e }),
        ];
        for tool in made.into_iter().flatten() {
            prop_assert!(sound(&tool), "{:?}", tool.profile());
        }
        let apt = Apt { d: a, r: b, e: c, f: d, a: e, b: d, h: c };
        if let Ok((tool, _)) = Tool::apt(&apt) {
            prop_assert!(sound(&tool), "{apt:?}");
        }
    }

    #[test]
    fn profiles(start in [number(), number()], on_axis in any::<bool>(), segments in vec(segment(), 0..5), top in number()) {
        let start = if on_axis { [0.0, start[1]] } else { start };
        let mut closed = segments.clone();
        closed.push(ProfileSegment::Line { to: [0.0, top] });
        for segments in [segments, closed] {
            if let Ok(profile) = Profile::new(start, segments) {
                prop_assert!(sound(&Tool::from_profile(profile)));
            }
        }
    }

    #[test]
    fn poses_arcs_and_paths(
        poses in vec(pose(), 0..5), count in 0..5_usize, from in three(), to in three(), centre in three(), normal in three(), turns in -3..4_i32,
        angles in [number(), number(), number(), number()], deviation in number(),
    ) {
        let poses: Vec<Pose> = poses.into_iter().flatten().collect();
        for pose in &poses {
            let length = pose.axis().iter().map(|c| c * c).sum::<f64>();
            prop_assert!(pose.tip().iter().all(|c| c.is_finite()) && (length - 1.0).abs() < 1e-12);
        }
        let arc = TipArc::between(from, to, centre, normal, turns);
        let _ = TipArc::new(centre, normal, angles[0]);
        let way = match arc {
            Ok(arc) => Move::arc(arc),
            Err(_) => Move::straight(Turning::Rotary { table: RotaryTable::Ac, from: [angles[0], angles[1]], to: [angles[2], angles[3]] }),
        };
        let paths = [
            Path::new(poses.clone()),
            Path::with_law(poses.clone(), Law::ConstantSpeed),
            Path::with_law(poses.clone(), Law::Rotary(RotaryTable::Bc)),
            Path::with_moves(poses.clone(), vec![way; count]),
            Path::with_moves(poses.clone(), vec![way; poses.len().saturating_sub(1)]),
        ];
        let deviation = if deviation > 1e-3 && deviation < 1e3 { deviation } else { 0.1 };
        for path in paths.into_iter().flatten().filter(|path| path.size() < 1e3) {
            for index in 0..path.moves() {
                for part in path.segments(index, 10.0, deviation) {
                    prop_assert!(part.weights().iter().all(|w| *w > 0.0));
                    prop_assert_eq!(part.try_at(0.25), Some(part.at(0.25)));
                    prop_assert!(part.try_at(1.25).is_none() && part.try_at(f64::NAN).is_none());
                }
            }
        }
    }

    #[test]
    fn spline_motions(turn in vec(number(), 20), tip in vec(number(), 15), degrees in [1..5_usize, 1..5_usize], tolerance in number(), shift in three()) {
        let spline = |degree: usize, dimension: usize, numbers: &[f64]| {
            let knots = KnotVector::bernstein(degree, 0.0, 1.0).expect("knots");
            BSpline::new(vec![knots], dimension, numbers[..dimension * (degree + 1)].to_vec())
        };
        let tip = spline(degrees[1], 3, &tip).and_then(|tip| RationalSpline::from_polynomial(&tip));
        if let (Ok(turn), Ok(tip)) = (spline(degrees[0], 4, &turn), tip) {
            if let Ok(motion) = SplineMotion::from_quaternions(&turn, &tip) {
                let _ = motion.moved(&Matrix3::identity(), shift);
                prop_assert!(motion.moved(&(Matrix3::identity() * 2.0), [0.0; 3]).is_err());
            }
            // A quaternion is not a matrix.
            let turn = RationalSpline::from_polynomial(&turn).expect("weights of 1");
            prop_assert!(SplineMotion::from_matrices(&turn, &tip, tolerance).is_err());
        }
    }
}

/// A profile of many segments is a profile, one of too many is refused before anything is computed.
#[test]
fn arcs_of_more_turns_than_fit_are_errors() {
    let between = |turns| TipArc::between([2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0; 3], [0.0, 0.0, 1.0], turns);
    assert!((between(-3).unwrap().angle() + 5.5 * PI).abs() < 1e-12);
    for turns in [0, 20_000, -20_000, i32::MAX, i32::MIN] {
        assert!(matches!(between(turns), Err(ArcError::Angle(_))), "{turns}");
    }
}

#[test]
fn profiles_of_many_segments() {
    let most = Profile::MOST_SEGMENTS;
    // Down the side of a cone in short lines.
    let cone = |lines: usize| {
        let up = |n: usize| n as f64 / (lines - 1) as f64;
        let side = (1..lines).map(|n| ProfileSegment::Line { to: [up(n), up(n)] });
        Profile::new(
            [0.0; 2],
            side.chain([ProfileSegment::Line { to: [0.0, 1.0] }]).collect(),
        )
    };
    assert!(cone(most).is_ok());
    let too_many = |found| Err(ProfileError::TooManySegments { found, most });
    assert_eq!(cone(most + 1), too_many(most + 1));
    // Points of splines count as segments, invalid ones as well.
    let spline = ProfileSegment::Spline {
        degree: 3,
        knots: None,
        points: vec![[1.0, 0.0]; 5_000_000],
        weights: None,
    };
    assert_eq!(Profile::new([0.0; 2], vec![spline]), too_many(5_000_000));
    // Offsets have arcs about the corners of a convex outline, so that there may be more.
    let bowl = (1..most).map(|n| {
        let (sin, cos) = (n as f64 / (most - 1) as f64 * std::f64::consts::FRAC_PI_2).sin_cos();
        ProfileSegment::Line { to: [sin, 1.0 - cos] }
    });
    let bowl = Profile::new(
        [0.0; 2],
        bowl.chain([ProfileSegment::Line { to: [0.0, 1.0] }]).collect(),
    );
    assert!(bowl.unwrap().offset(0.1).unwrap().segments().len() > most);
}
