//! Sections by planes agree with the intervals of lines in them.

use sweepsim::systems::Plane;
use sweepsim::{Cut, Options, Ray, probe, section};
use sweepsim_motion::{Path, Pose, Tool};
use sweepsim_props::*;

fn tools() -> [Tool; 3] {
    [
        Tool::ball(5.0, 30.0).unwrap(),
        Tool::flat(5.0, 30.0).unwrap(),
        Tool::bull(5.0, 1.0, 30.0).unwrap(),
    ]
}

fn vector(reach: f64) -> impl Strategy<Value = [f64; 3]> {
    [-reach..reach, -reach..reach, -reach..reach]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]
    /// Where a line of the plane enters or leaves the volume, there is a curve of the section; where an outer curve
    /// crosses a line, the volume begins or ends.
    #[test]
    fn outlines_cross_lines_where_intervals_end(
        tool in 0..3usize,
        tips in collection::vec(vector(12.0), 2..4),
        leans in collection::vec(vector(0.6), 4),
        x in -6.0..6.0f64,
        shift in 0.0..1.0f64,
    ) {
        let poses = tips.iter().zip(&leans).map(|(tip, lean)| Pose::new(*tip, [lean[0], lean[1], 1.0]).unwrap()).collect();
        let path = Path::new(poses).unwrap();
        let tool = &tools()[tool];
        let chord = 1e-3;
        let options = Options::new(1e-6);
        let section = section(&[Cut::new(tool, &path)], &Plane::x(x).unwrap(), chord, &options, &()).unwrap();
        prop_assert!(section.open.is_empty(), "{:?}", section.open);
        let ys: Vec<f64> = (0..9).map(|k| -12.0 + 3.0 * (f64::from(k) + shift)).collect();
        let lines: Vec<Ray> = ys.iter().map(|y| Ray::new([x, *y, 0.0], [0.0, 0.0, 1.0]).unwrap()).collect();
        let swept = probe(tool, &path, &lines, &options, &()).unwrap();
        for (y, intervals) in ys.iter().zip(&swept) {
            let intervals = intervals.as_ref().expect("established");
            let ends: Vec<f64> = intervals.iter().flat_map(|i| [i.lower.z, i.upper.z]).collect();
            // An end, and how steep its surface is within the plane: how far a chord may move it.
            let slack = |normal: [f64; 3]| 2.0 * chord * (1.0 + (normal[1] / normal[2]).abs());
            let mut crossings: Vec<(f64, f64, bool)> = Vec::new();
            for curve in &section.curves {
                for (pair, flags) in curve.points.windows(2).zip(curve.outer.windows(2)) {
                    let ([a, b], [_, y0, z0], [_, y1, z1]) = ([&pair[0], &pair[1]], pair[0].position, pair[1].position);
                    if (y0 < *y) != (y1 < *y) {
                        let z = z0 + (y - y0) / (y1 - y0) * (z1 - z0);
                        crossings.push((z, slack(a.normal).max(slack(b.normal)), flags[0] && flags[1]));
                    }
                }
            }
            for end in &ends {
                prop_assert!(crossings.iter().any(|(z, slack, _)| (z - end).abs() <= *slack), "y {y}: no curve at {end}: {crossings:?}");
            }
            for (z, slack, _) in crossings.iter().filter(|(_, slack, outer)| *outer && *slack < 0.1) {
                prop_assert!(ends.iter().any(|end| (z - end).abs() <= *slack), "y {y}: outer at {z}, ends {ends:?}");
            }
        }
    }
}

#[test]
fn a_plane_of_any_direction() {
    // A ball's centre goes from the origin along (1, 1, 1); a plane across its way cuts its envelope in a circle.
    let path = Path::new(vec![
        Pose::new([0.0, 0.0, -5.0], [0.0, 0.0, 1.0]).unwrap(),
        Pose::new([20.0, 20.0, 15.0], [0.0, 0.0, 1.0]).unwrap(),
    ])
    .unwrap();
    let tool = Tool::ball(5.0, 5.0 + 1e-3).unwrap();
    let plane = Plane::new([1.0, 1.0, 1.0], 30.0).unwrap();
    let found = section(&[Cut::new(&tool, &path)], &plane, 1e-3, &Options::new(1e-6), &()).unwrap();
    let mut count = 0;
    for curve in &found.curves {
        for point in &curve.points {
            let [a, b, c] = point.position;
            // Ends of cut-off curves lie on chords.
            let off = if matches!(curve.piece, sweepsim::BoundaryPiece::Patch(_)) {
                1e-9
            } else {
                2e-3
            };
            assert!((a + b + c - 30.0).abs() < off);
            // Below the ball's equator it is a sphere.
            let centre = [20.0 * point.t, 20.0 * point.t, 20.0 * point.t];
            if matches!(curve.piece, sweepsim::BoundaryPiece::Patch(_)) && c < centre[2] - 0.1 {
                let far = (a - 10.0).hypot(b - 10.0).hypot(c - 10.0);
                assert!((far - 5.0).abs() < 1e-6, "{far}");
                count += 1;
            }
        }
    }
    assert!(count > 100);
    let svg = found.svg();
    assert!(svg.starts_with("<svg") && svg.contains("stroke-width=\"2.4\"") && svg.ends_with("</svg>\n"));
}

/// A chord error of nothing would take points without end: the curve is left open, and named.
#[test]
fn a_chord_error_that_takes_too_many_points_leaves_curves_open() {
    let pose = |x: f64| Pose::new([x, 0.3, 1.0], [0.1, 0.2, 1.0]).unwrap();
    let path = Path::new(vec![pose(-9.0), pose(9.0)]).unwrap();
    let tool = Tool::ball(5.0, 30.0).unwrap();
    let cut = [Cut::new(&tool, &path)];
    let of = |chord: f64| section(&cut, &Plane::x(0.5).unwrap(), chord, &Options::default(), &()).unwrap();
    assert_eq!(of(1e-3).open.len(), 0);
    let fine = of(1e-300);
    assert!(!fine.open.is_empty());
    assert!(fine.curves.iter().all(|curve| curve.points.len() <= 400_000));
}
