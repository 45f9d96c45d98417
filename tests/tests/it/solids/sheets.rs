//! Free-form sheets as B-splines: what a ball leaves whose axis turns, read from the file by the tests themselves.

use super::{job, kinds, outputs};
use std::collections::BTreeMap;
use sweepsim_formats::parse_step;
use sweepsim_job::Output;

const RADIUS: f64 = 5.0;
const TIPS: [[f64; 3]; 2] = [[-10.0, 20.0, 12.0], [70.0, 20.0, 11.0]];
const AXES: [[f64; 3]; 2] = [[-0.3, 0.0, 1.0], [0.3, 0.3, 1.0]];

/// The centre of the ball at a time: the tip moves straight, the axis along a great circle as one rational arc, of
/// which every place is looked at here.
fn centre(t: f64, angle: f64) -> [f64; 3] {
    let unit = |v: [f64; 3]| {
        let size = v.iter().map(|c| c * c).sum::<f64>().sqrt();
        v.map(|c| c / size)
    };
    let [a, b] = AXES.map(unit);
    let whole = (0..3).map(|k| a[k] * b[k]).sum::<f64>().acos();
    let [p, q] = [(whole * (1.0 - angle)).sin(), (whole * angle).sin()].map(|s| s / whole.sin());
    [0, 1, 2].map(|k| TIPS[0][k] + t * (TIPS[1][k] - TIPS[0][k]) + RADIUS * (p * a[k] + q * b[k]))
}

/// The part of the angle that a rational quadratic arc has covered at a time.
fn part_of_angle(t: f64) -> f64 {
    let dot: f64 = (0..3).map(|k| AXES[0][k] * AXES[1][k]).sum();
    let sizes = AXES.map(|v| v.iter().map(|c| c * c).sum::<f64>().sqrt());
    let whole = (dot / (sizes[0] * sizes[1])).acos();
    // Half-angle tangents of a symmetric rational arc grow evenly.
    let tau = (whole / 4.0).tan();
    0.5 + 0.5 * ((2.0 * t - 1.0) * tau).atan() / tau.atan()
}

/// The least distance of a point from all places of the ball, less than nothing inside.
fn off(p: [f64; 3]) -> f64 {
    let far = |t: f64| {
        let c = centre(t, part_of_angle(t));
        (0..3).map(|k| (p[k] - c[k]).powi(2)).sum::<f64>().sqrt() - RADIUS
    };
    let (mut best, mut step) = (0.5, 1.0);
    for _ in 0..14 {
        let from: f64 = best;
        for k in -20..=20 {
            let t = (from + step * f64::from(k) / 40.0).clamp(-0.05, 1.05);
            if far(t) < far(best) {
                best = t;
            }
        }
        step *= 0.3;
    }
    far(best)
}

/// The records of a file by their numbers.
fn records(file: &str) -> BTreeMap<usize, &str> {
    let lines = file.lines().filter_map(|line| line.strip_prefix('#')?.split_once('='));
    lines
        .map(|(number, record)| (number.parse().unwrap(), record))
        .collect()
}

fn numbers(list: &str) -> Vec<f64> {
    list.split(',').map(|c| c.parse().unwrap()).collect()
}

/// One weighted mean after the other, as B-splines are defined (de Boor): of points with all knots, each repeated.
fn de_boor(points: &[[f64; 3]], knots: &[f64], t: f64) -> [f64; 3] {
    let at = (3..points.len()).rfind(|k| knots[*k] <= t).unwrap();
    let mut own: Vec<[f64; 3]> = points[at - 3..=at].to_vec();
    for round in 1..=3 {
        for k in (round..=3).rev() {
            let (low, high) = (knots[at - 3 + k], knots[at + 1 + k - round]);
            let w = (t - low) / (high - low);
            own[k] = [0, 1, 2].map(|c| own[k - 1][c] * (1.0 - w) + own[k][c] * w);
        }
    }
    own[3]
}

/// A groove right through, of a single sheet: no triangles, and all of the written surface is at the ball.
#[test]
fn groove_of_a_ball_whose_axis_turns() {
    let [a, b] = [0, 1].map(|k| {
        let [[x, y, z], [i, j, l]] = [TIPS[k], AXES[k]];
        format!("(({x}, {y}, {z}), ({i}, {j}, {l}))")
    });
    let path = format!("Path(tool: 1, poses: [{a}, {b}])");
    let text = job("1: Ball(radius: 5, length: 30)", &path);
    let (memory, notes) = outputs(&text, &[Output::Step]);
    let file = &memory.0["part.step"];
    let part = parse_step(file, 0.02).unwrap();
    let faces = kinds(&part);
    assert_eq!(faces, [("B-spline surface", 1), ("plane", 7)].into(), "{notes:?}");
    assert!(!notes.iter().any(|note| note.contains("triangle")), "{notes:?}");

    // Finer dexels tell the volume: lines do not meet the block's sides.
    let fine = text.replace("(80, 55)", "(640, 440)");
    let plan = sweepsim_job::Request::from_job("fine.ron", fine).task(sweepsim_job::Task::Simulate);
    let dexels = plan.plan().unwrap().run(&()).unwrap().part().volume();
    let volume = part.bodies[0].volume.unwrap();
    assert!((volume - dexels).abs() < 2e-5 * dexels, "{volume} {dexels}");

    let text = std::str::from_utf8(file).unwrap();
    let records = records(text);
    let surface = records
        .values()
        .find(|record| record.starts_with("B_SPLINE_SURFACE_WITH_KNOTS("))
        .unwrap();
    let net = surface.split_once("((").unwrap().1.split_once("))").unwrap().0;
    let point = |number: &str| {
        let record = records[&number.trim_start_matches('#').parse().unwrap()];
        let list = record
            .strip_prefix("CARTESIAN_POINT('',(")
            .unwrap()
            .strip_suffix("));")
            .unwrap();
        <[f64; 3]>::try_from(numbers(list)).unwrap()
    };
    let net: Vec<Vec<[f64; 3]>> = net
        .split("),(")
        .map(|row| row.split(',').map(point).collect())
        .collect();
    let lists: Vec<Vec<f64>> = surface
        .split_once(".UNSPECIFIED.,.F.,.F.,.F.,(")
        .unwrap()
        .1
        .trim_end_matches("),.UNSPECIFIED.);")
        .split("),(")
        .map(numbers)
        .collect();
    let knots = |k: usize| -> Vec<f64> {
        let repeated = lists[k].iter().zip(&lists[k + 2]);
        repeated
            .flat_map(|(count, knot)| std::iter::repeat_n(*knot, *count as usize))
            .collect()
    };
    let (us, vs) = (knots(0), knots(1));
    let between = |knots: &[f64], k: u32| knots[0] + (knots[knots.len() - 1] - knots[0]) * (f64::from(k) + 0.5) / 37.0;
    let (mut farthest, mut spread) = (0.0_f64, [f64::INFINITY, f64::NEG_INFINITY]);
    for i in 0..37 {
        for j in 0..37 {
            let row: Vec<[f64; 3]> = net.iter().map(|row| de_boor(row, &vs, between(&vs, j))).collect();
            let p = de_boor(&row, &us, between(&us, i));
            farthest = farthest.max(off(p).abs());
            spread = [spread[0].min(p[0]), spread[1].max(p[0])];
        }
    }
    // The tolerance is 1e-4, and a tenth of it the spline's.
    assert!(farthest < 1.1e-5, "{farthest}");
    assert!(spread[0] < 1.0 && spread[1] > 59.0, "{spread:?}");
}
