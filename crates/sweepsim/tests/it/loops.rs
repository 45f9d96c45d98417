//! Sections as closed loops: their area is that of the volume in the plane.

use sweepsim::prelude::*;
use sweepsim::systems::Plane;
use sweepsim::{Ray, probe, section};

/// Twice the area that closed polylines enclose, seen in the plane's frame.
fn area(loops: &[Vec<[f64; 3]>], plane: &Plane) -> f64 {
    let [across, up] = plane.frame();
    let flat = |p: &[f64; 3]| [across, up].map(|axis| (0..3).map(|k| axis[k] * p[k]).sum::<f64>());
    let of = |line: &Vec<[f64; 3]>| -> f64 {
        let doubled = line.windows(2).map(|pair| {
            let ([a, b], [c, d]) = (flat(&pair[0]), flat(&pair[1]));
            a * d - b * c
        });
        0.5 * doubled.sum::<f64>()
    };
    loops.iter().map(of).sum()
}

/// The area of the volume in the plane `x = at`, by intervals on many lines.
fn probed(cuts: &[(Tool, Path)], at: f64, [from, to]: [f64; 2]) -> f64 {
    let count = 4000;
    let width = (to - from) / f64::from(count);
    let ray = |k: i32| Ray::new([at, from + (f64::from(k) + 0.5) * width, 0.0], [0.0, 0.0, 1.0]).unwrap();
    let rays: Vec<Ray> = (0..count).map(ray).collect();
    let mut spans: Vec<Vec<[f64; 2]>> = vec![Vec::new(); rays.len()];
    for (tool, path) in cuts {
        let found = probe(tool, path, &rays, &Options::new(1e-6), &()).unwrap();
        for (all, intervals) in spans.iter_mut().zip(found) {
            all.extend(intervals.unwrap().iter().map(|i| [i.lower.z, i.upper.z]));
        }
    }
    let mut sum = 0.0;
    for mut line in spans {
        line.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut top = f64::NEG_INFINITY;
        for [lower, upper] in line {
            sum += (upper - lower.max(top)).max(0.0);
            top = top.max(upper);
        }
    }
    sum * width
}

fn path(poses: &[([f64; 3], [f64; 3])]) -> Path {
    Path::new(
        poses
            .iter()
            .map(|(tip, axis)| Pose::new(*tip, *axis).unwrap())
            .collect(),
    )
    .unwrap()
}

/// Cuts, the height of the plane, and the number of loops.
type SectionCase = (Vec<(Tool, Path)>, f64, usize);

#[test]
fn loops_enclose_what_lines_find() {
    let up = [0.0, 0.0, 1.0];
    let leaning = path(&[
        ([-20.0, -8.0, 4.0], [0.5, 0.1, 1.0]),
        ([0.0, 6.0, 0.0], [0.0, -0.4, 1.0]),
        ([20.0, -4.0, 3.0], [-0.4, 0.0, 1.0]),
    ]);
    let cases: Vec<SectionCase> = vec![
        (vec![(Tool::bull(5.0, 1.5, 30.0).unwrap(), leaning.clone())], -3.3, 1),
        (vec![(Tool::ball(3.0, 25.0).unwrap(), leaning.clone())], 0.7, 1),
        // Two grooves apart, and two that overlap.
        (
            vec![
                (
                    Tool::flat(2.0, 10.0).unwrap(),
                    path(&[([-9.0, -6.0, 0.1], up), ([9.0, -5.0, 0.4], up)]),
                ),
                (
                    Tool::ball(2.0, 12.0).unwrap(),
                    path(&[([-9.0, 5.0, 0.0], up), ([9.0, 6.0, 0.3], up)]),
                ),
            ],
            0.3,
            2,
        ),
        (
            vec![
                (
                    Tool::flat(3.0, 10.0).unwrap(),
                    path(&[([-9.0, -1.0, 0.1], up), ([9.0, -1.5, 0.4], up)]),
                ),
                (
                    Tool::ball(3.0, 12.0).unwrap(),
                    path(&[([-9.0, 2.0, -1.0], up), ([9.0, 1.0, -0.7], up)]),
                ),
            ],
            0.3,
            1,
        ),
    ];
    for (number, (cuts, at, count)) in cases.into_iter().enumerate() {
        let plane = Plane::x(at).unwrap();
        let borrowed: Vec<Cut> = cuts.iter().map(|(tool, path)| Cut::new(tool, path)).collect();
        let found = section(&borrowed, &plane, 1e-3, &Options::new(1e-6), &()).unwrap();
        let loops = found.loops();
        assert_eq!(
            (loops.closed.len(), loops.open.len()),
            (count, 0),
            "case {number}, of {} runs",
            found.outline().len()
        );
        assert!(loops.closed.iter().all(|line| line.first() == line.last()));
        let (own, expected) = (area(&loops.closed, &plane), probed(&cuts, at, [-30.0, 30.0]));
        // Outer loops run counter-clockwise: the area is positive. Steps of the lines are 0.015 wide, and walls are
        // steep.
        assert!(
            (own - expected).abs() < 2e-3 * expected,
            "case {number}: {own} for {expected}"
        );
    }
}

#[test]
fn holes_run_clockwise() {
    // Around a square: the tool leaves an island.
    let up = [0.0, 0.0, 1.0];
    let around = path(&[
        ([-10.0, -10.0, 0.0], up),
        ([10.0, -10.0, 0.0], up),
        ([10.0, 10.0, 0.0], up),
        ([-10.0, 10.0, 0.0], up),
        ([-10.0, -10.0, 0.0], up),
    ]);
    let tool = Tool::flat(3.0, 10.0).unwrap();
    let plane = Plane::z(5.0).unwrap();
    let found = section(&[Cut::new(&tool, &around)], &plane, 1e-3, &Options::new(1e-6), &()).unwrap();
    let loops = found.loops();
    assert_eq!((loops.closed.len(), loops.open.len()), (2, 0));
    // Arcs are as close to their chords as was asked for.
    let on_arc = |p: &[f64; 3]| (p[0] - 10.0).hypot(p[1] - 10.0);
    for pair in found
        .outline()
        .iter()
        .flat_map(|line| line.windows(2))
        .filter(|pair| pair.iter().all(|p| p[0] > 10.01 && p[1] > 10.01))
    {
        let middle = [0, 1, 2].map(|k| 0.5 * (pair[0][k] + pair[1][k]));
        assert!((on_arc(&middle) - 3.0).abs() < 1e-3, "{pair:?}");
    }
    let mut areas: Vec<f64> = loops
        .closed
        .iter()
        .map(|line| area(std::slice::from_ref(line), &plane))
        .collect();
    areas.sort_by(f64::total_cmp);
    let outer = 26.0 * 26.0 - (4.0 - std::f64::consts::PI) * 9.0;
    assert!((areas[0] + 14.0 * 14.0).abs() < 0.05, "{areas:?}");
    assert!((areas[1] - outer).abs() < 0.05, "{areas:?} for {outer}");
}
