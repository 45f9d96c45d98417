//! Splines in profiles: patches on the rotated curve with its normals, edges at its corners, and bad ones refused.

use nalgebra::Vector3;
use sweepsim_motion::{Profile, ProfileError, ProfileSegment, SplineFault, Tool, Turn};
use sweepsim_props::*;
use sweepsim_spline::{KnotVector, RationalSpline};

fn line(rho: f64, zeta: f64) -> ProfileSegment {
    ProfileSegment::Line { to: [rho, zeta] }
}

fn spline(degree: usize, points: &[[f64; 2]], knots: Option<Vec<f64>>, weights: Option<Vec<f64>>) -> ProfileSegment {
    let points = points.to_vec();
    ProfileSegment::Spline {
        degree,
        knots,
        points,
        weights,
    }
}

/// An outline with one spline, from a flat bottom to a shank.
fn with(segment: ProfileSegment) -> Result<Tool, ProfileError> {
    let segments = vec![line(1.0, 0.0), segment, line(2.0, 9.0), line(0.0, 9.0)];
    Profile::new([0.0, 0.0], segments).map(Tool::from_profile)
}

fn fault(segment: ProfileSegment) -> SplineFault {
    match with(segment) {
        Err(ProfileError::Spline { segment: 1, fault }) => fault,
        other => panic!("{other:?}"),
    }
}

const WAVE: [[f64; 2]; 6] = [[1.0, 0.0], [2.5, 0.5], [2.5, 2.0], [1.0, 3.0], [1.2, 4.5], [2.0, 5.0]];

proptest! {
    /// Every patch of the spline lies on it, turned; its normals are at right angles to both slopes and its moments are `F × N`.
    #[test]
    fn patches_lie_on_the_curve_and_have_its_normals(
        shifts in collection::vec(-0.2..0.2_f64, 8),
        weights in prop::option::of(collection::vec(0.4..2.0_f64, 6)),
        degree in 1..6_usize,
        [u, v] in [0.001..0.999_f64, 0.02..0.98_f64],
    ) {
        let mut points = WAVE;
        for (point, shift) in points[1..5].iter_mut().zip(shifts.chunks(2)) {
            *point = [point[0] + shift[0], point[1] + shift[1]];
        }
        let tool = with(spline(degree, &points, None, weights.clone())).expect("a profile");
        let flat: Vec<f64> = points.iter().flatten().copied().collect();
        let curve = RationalSpline::new(
            vec![KnotVector::uniform(degree, 6 - degree, 0.0, 1.0).unwrap()], 2, &flat, &weights.unwrap_or(vec![1.0; 6]),
        ).unwrap();
        // Bottom disk, four quarters of each span, four of the shank, the top.
        let spans = 6 - degree;
        prop_assert_eq!(tool.patches().len(), 1 + 4 * spans + 4 + 1);
        for (number, patch) in tool.patches()[1..=4 * spans].iter().enumerate() {
            let place = Vector3::from(patch.point(u, v));
            let rho = place.x.hypot(place.y);
            // The pace within a piece is another: the nearest point of the span, by ternary search around the nearest of many.
            let distance = |t: f64| {
                let p = curve.evaluate(&[t]);
                (p[0] - rho).hypot(p[1] - place.z)
            };
            let span = (number / 4) as f64 / spans as f64;
            let step = 1.0 / (100 * spans) as f64;
            let near = (0..=100).map(|k| span + step * f64::from(k)).min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap();
            let (mut low, mut high) = ((near - step).max(0.0), (near + step).min(1.0));
            for _ in 0..100 {
                let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
                if distance(a) < distance(b) { high = b } else { low = a }
            }
            prop_assert!(distance(0.5 * (low + high)) < 1e-10);
            let at = |forms: &[sweepsim_spline::Bernstein; 3]| Vector3::from([0, 1, 2].map(|k| forms[k].evaluate(&[u, v])));
            let (normal, moment) = (at(patch.field().normal()), at(patch.field().moment()));
            prop_assert!(normal.norm() > 1e-4);
            let size = normal.norm();
            // Rounding of forms of degree at most 13 with coefficients of at most 10, and of steps of 1e-6.
            prop_assert!((moment - place.cross(&normal)).norm() < 1e-12);
            let h = 1e-6;
            let along = |du: f64, dv: f64| (Vector3::from(patch.point(u + du, v + dv)) - Vector3::from(patch.point(u - du, v - dv))) / (2.0 * h);
            let (f_u, f_v) = (along(h, 0.0), along(0.0, h));
            let n = normal / size;
            prop_assert!(n.dot(&f_u).abs() < 1e-4 && n.dot(&f_v).abs() < 1e-7);
            prop_assert!(n.dot(&f_u.cross(&f_v)) > 0.0);
        }
    }

    /// Whatever numbers come: a tool or an error.
    #[test]
    fn bad_splines_are_errors_and_never_panics(
        degree in 0..9_usize,
        points in collection::vec([-1.0..4.0_f64, -1.0..6.0_f64], 0..12),
        knots in prop::option::of(collection::vec(prop_oneof![Just(0.0), Just(1.0), -1.0..2.0_f64, Just(f64::NAN)], 0..20)),
        weights in prop::option::of(collection::vec(prop_oneof![Just(1.0), -0.1..3.0_f64, Just(f64::INFINITY)], 0..12)),
        joined in any::<bool>(),
    ) {
        let mut points = points;
        if joined && points.len() > 1 {
            points[0] = [1.0, 0.0];
            *points.last_mut().unwrap() = [2.0, 5.0];
        }
        if let Ok(tool) = with(spline(degree, &points, knots, weights)) {
            for patch in tool.patches() {
                prop_assert!(patch.field().normal().iter().chain(patch.field().moment()).all(sweepsim_spline::Bernstein::is_finite));
                prop_assert!(Vector3::from(patch.point(0.3, 0.6)).iter().all(|c| c.is_finite()));
            }
        }
    }
}

#[test]
fn edges_are_where_the_spline_has_corners() {
    let smooth = with(spline(3, &WAVE, None, None)).unwrap();
    // The rim of the bottom, the end of the spline, the top.
    assert_eq!(smooth.edges().len() / 4, 3);
    let corner = with(spline(
        2,
        &WAVE[..5],
        Some(vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0]),
        None,
    ));
    // ... which ends elsewhere: a double knot with a corner in it.
    assert_eq!(corner.unwrap().edges().len() / 4, 4);
}

#[test]
fn a_spline_that_is_an_arc_encloses_what_the_arc_does() {
    let w = 0.5_f64.sqrt();
    let segments = |corner| vec![line(3.0, 0.0), corner, line(5.0, 9.0), line(0.0, 9.0)];
    let arc = ProfileSegment::Arc {
        to: [5.0, 2.0],
        centre: [3.0, 2.0],
        turn: Turn::Ccw,
    };
    let same = spline(2, &[[3.0, 0.0], [5.0, 0.0], [5.0, 2.0]], None, Some(vec![1.0, w, 1.0]));
    let [arc, same] = [arc, same].map(|corner| Tool::from_profile(Profile::new([0.0, 0.0], segments(corner)).unwrap()));
    assert_eq!(
        (arc.edges().len(), arc.patches().len()),
        (same.edges().len(), same.patches().len())
    );
    for (a, b) in arc.patches().iter().zip(same.patches()) {
        for (u, v) in [(0.0, 0.0), (0.3, 0.7), (1.0, 0.5), (0.9, 1.0)] {
            assert!((Vector3::from(a.point(u, v)) - Vector3::from(b.point(u, v))).norm() < 1e-14);
        }
    }
}

#[test]
fn what_is_wrong_is_said() {
    let points = &WAVE;
    assert_eq!(
        fault(spline(8, points, None, None)),
        SplineFault::Degree { degree: 8, most: 7 }
    );
    assert_eq!(
        fault(spline(6, points, None, None)),
        SplineFault::Points { least: 7, found: 6 }
    );
    assert!(matches!(
        fault(spline(3, points, Some(vec![0.0; 9]), None)),
        SplineFault::KnotCount { expected: 10, found: 9 }
    ));
    assert!(matches!(
        fault(spline(3, points, Some(vec![0.0; 10]), None)),
        SplineFault::Knots(_)
    ));
    let even: Vec<f64> = (0..10).map(f64::from).collect();
    assert_eq!(fault(spline(3, points, Some(even), None)), SplineFault::Clamped);
    let jump = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0];
    assert_eq!(
        fault(spline(2, points, Some(jump), None)),
        SplineFault::Jump { knot: 1.0 }
    );
    let weights = vec![1.0, 1.0, 0.0, 1.0, 1.0, 1.0];
    assert_eq!(
        fault(spline(3, points, None, Some(weights))),
        SplineFault::Weight { index: 2, value: 0.0 }
    );
    assert!(matches!(
        fault(spline(3, points, None, Some(vec![1.0]))),
        SplineFault::Weights { .. }
    ));
    assert!(matches!(
        fault(spline(3, &points[1..], None, None)),
        SplineFault::Start { .. }
    ));
    // A cusp in the middle, and no direction where it begins.
    let cusp = [[1.0, 0.0], [3.0, 5.0], [1.0, 5.0], [3.0, 0.0]];
    assert!(matches!(fault(spline(3, &cusp, None, None)), SplineFault::Stops { .. }));
    let stops = [[1.0, 0.0], [1.0, 0.0], [2.0, 2.0], [2.0, 5.0]];
    assert!(matches!(
        fault(spline(3, &stops, None, None)),
        SplineFault::Stops { .. }
    ));
    let looped = [[1.0, 0.0], [9.0, 4.0], [-4.0, 4.0], [4.0, 0.0]];
    let crossing = with(spline(3, &looped, None, None)).unwrap_err();
    assert!(
        matches!(crossing, ProfileError::SelfCrossing { first: 1, .. }),
        "{crossing}"
    );
    let inwards = [[1.0, 0.0], [-2.0, 2.0], [2.0, 5.0]];
    assert!(matches!(
        with(spline(2, &inwards, None, None)),
        Err(ProfileError::AcrossAxis { segment: 1, .. })
    ));
    // Back through the bottom, and through the shank.
    let down = [[1.0, 0.0], [3.0, -4.0], [-1.0, 1.0], [2.0, 5.0]];
    assert!(with(spline(3, &down, None, None)).is_err());
    let far = [[1.0, 0.0], [9.0, 9.0], [-2.0, 8.0], [2.0, 5.0]];
    let expected = ProfileError::SelfCrossing { first: 1, second: 2 };
    assert_eq!(with(spline(3, &far, None, None)).unwrap_err(), expected);
}

#[test]
fn a_spline_may_begin_and_end_on_the_axis() {
    let dome = spline(3, &[[0.0, 0.0], [2.0, 0.0], [3.0, 4.0], [0.0, 6.0]], None, None);
    let tool = Tool::from_profile(Profile::new([0.0, 0.0], vec![dome]).unwrap());
    assert_eq!((tool.patches().len(), tool.edges().len()), (4, 0));
}
