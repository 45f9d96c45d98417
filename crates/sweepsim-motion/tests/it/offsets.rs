//! Offsets of profiles against distances to dense points.

use sweepsim_motion::{Profile, ProfileSegment, Turn};
use sweepsim_props::*;

/// Points of a profile of lines and arcs, closely spaced.
fn dense(profile: &Profile) -> Vec<[f64; 2]> {
    let mut all = vec![profile.start()];
    let mut from = profile.start();
    for segment in profile.segments() {
        let to = match segment {
            ProfileSegment::Line { to } => {
                all.extend((1..=120).map(|n| [0, 1].map(|k| from[k] + (to[k] - from[k]) * f64::from(n) / 120.0)));
                *to
            }
            ProfileSegment::Arc { to, centre, turn } => {
                let angle = |p: [f64; 2]| (p[1] - centre[1]).atan2(p[0] - centre[0]);
                let around = (angle(*to) - angle(from)).rem_euclid(std::f64::consts::TAU);
                let by = if *turn == Turn::Ccw {
                    around
                } else {
                    around - std::f64::consts::TAU
                };
                let radius = (from[0] - centre[0]).hypot(from[1] - centre[1]);
                all.extend((1..=120).map(|n| {
                    let at = angle(from) + by * f64::from(n) / 120.0;
                    [centre[0] + radius * at.cos(), centre[1] + radius * at.sin()]
                }));
                *to
            }
            _ => unreachable!("no splines here"),
        };
        from = to;
    }
    all
}

/// The distance from dense points, and whether the polygon through them (closed by the axis) holds the point.
fn judged(outline: &[[f64; 2]], p: [f64; 2]) -> (f64, bool) {
    let mut nearest = f64::INFINITY;
    let mut inside = false;
    for pair in outline.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let way = [b[0] - a[0], b[1] - a[1]];
        let square = way[0] * way[0] + way[1] * way[1];
        for sign in [1.0, -1.0] {
            // The mirrored half, too.
            let q = [sign * p[0] - a[0], p[1] - a[1]];
            let s = ((q[0] * way[0] + q[1] * way[1]) / square).clamp(0.0, 1.0);
            nearest = nearest.min((q[0] - s * way[0]).hypot(q[1] - s * way[1]));
        }
        if (a[1] > p[1]) != (b[1] > p[1]) {
            let x = a[0] + way[0] * (p[1] - a[1]) / way[1];
            inside ^= x > p[0];
        }
    }
    (nearest, inside)
}

/// Steps upward, each a radius and a height: a holder with necks and collars.
fn stepped(steps: &[(f64, f64)], rounded: bool) -> Profile {
    let mut segments = Vec::new();
    let mut z = 0.0;
    for (n, (radius, height)) in steps.iter().enumerate() {
        if rounded && n == 0 {
            // A ball end.
            segments.push(ProfileSegment::Arc {
                to: [*radius, *radius],
                centre: [0.0, *radius],
                turn: Turn::Ccw,
            });
            z = *radius;
        } else {
            segments.push(ProfileSegment::Line { to: [*radius, z] });
        }
        z += height;
        segments.push(ProfileSegment::Line { to: [*radius, z] });
    }
    segments.push(ProfileSegment::Line { to: [0.0, z] });
    Profile::new([0.0, 0.0], segments).expect("a profile")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn offsets_hold_what_is_near_and_nothing_else(
        steps in collection::vec((1.0..9.0, 0.5..9.0), 1..5),
        rounded in any::<bool>(),
        distance in 0.05..4.0,
        probes in collection::vec((0.0..16.0, -5.0..40.0), 60),
    ) {
        // Equal radii would be no step.
        let steps: Vec<(f64, f64)> = steps.iter().enumerate().map(|(n, (r, h))| (r + 0.013 * n as f64, *h)).collect();
        let profile = stepped(&steps, rounded);
        let offset = profile.offset(distance).expect("an offset");
        let (own, far) = (dense(&profile), dense(&offset));
        // Chords of 120 parts are this accurate.
        let close = 1e-3;
        for p in far.iter().filter(|p| p[0] > 0.0) {
            let (apart, inside) = judged(&own, *p);
            prop_assert!(!inside && (apart - distance).abs() < close, "{p:?} at {apart}");
        }
        for (x, z) in probes {
            let (apart, inside) = judged(&own, [x, z]);
            let (border, held) = judged(&far, [x, z]);
            let near = inside || apart <= distance;
            // Caves that are closed are filled: held, though not near.
            let cave = held && !near;
            prop_assert!(near == held || border < close || cave && apart - distance < 9.0, "({x}, {z}): {apart} {held}");
            if near {
                prop_assert!(held || border < close, "({x}, {z}) is {apart} away, and not held");
            }
        }
    }
}

#[test]
fn offsets_in_closed_form() {
    let cylinder = stepped(&[(2.0, 5.0)], false);
    let wider = cylinder.offset(1.0).expect("an offset");
    let ends: Vec<[f64; 2]> = wider
        .segments()
        .iter()
        .map(|segment| match segment {
            ProfileSegment::Line { to } | ProfileSegment::Arc { to, .. } => *to,
            _ => unreachable!("no splines here"),
        })
        .collect();
    let wanted = [[2.0, -1.0], [3.0, 0.0], [3.0, 5.0], [2.0, 6.0], [0.0, 6.0]];
    assert_eq!(ends.len(), wanted.len(), "{ends:?}");
    for (end, wanted) in ends.iter().zip(wanted) {
        assert!((end[0] - wanted[0]).hypot(end[1] - wanted[1]) < 1e-12, "{ends:?}");
    }
    assert_eq!(cylinder.offset(0.0), Ok(cylinder.clone()));
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(cylinder.offset(bad).is_err());
    }
}

/// A short cylinder, found by random cases: its arcs end on its lines, with no cut beside the joint.
#[test]
fn offsets_of_a_short_cylinder() {
    let (radius, height, distance) = (6.012025297084563, 1.832925983651387, 2.3133259374154096);
    let wider = stepped(&[(radius, height)], false).offset(distance).expect("an offset");
    let (wall, top) = (radius + distance, height + distance);
    let wanted = [
        [radius, -distance],
        [wall, 0.0],
        [wall, height],
        [radius, top],
        [0.0, top],
    ];
    assert_eq!(wider.segments().len(), wanted.len(), "{wider:?}");
    for (segment, wanted) in wider.segments().iter().zip(wanted) {
        let (ProfileSegment::Line { to } | ProfileSegment::Arc { to, .. }) = segment else {
            unreachable!("no splines here")
        };
        assert!((0..2).all(|k| (to[k] - wanted[k]).abs() < 1e-12), "{to:?} {wanted:?}");
    }
}
