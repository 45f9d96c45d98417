//! What each move removes, and how the cutter engages: slots by hand, and any moves on voxels.

use super::Random;
use super::by_force::pose;
use std::ops::ControlFlow;
use sweepsim::nalgebra::Vector3;
use sweepsim::prelude::*;
use sweepsim::verify::{MoveRemoval, Scene, ToolPath, VerifyOptions, verify};
use sweepsim_motion::{Assembly, Move, TipArc, TipCourse, Turning};

const RADIUS: f64 = 3.0;

fn moves(path: &Path, cells: [usize; 2]) -> (Vec<MoveRemoval>, f64) {
    let grid = Grid::new([-15.0, -15.0], [15.0, 15.0], cells).unwrap();
    let (min, max) = ([-15.0, -15.0, -10.0], [15.0, 15.0, 0.0]);
    let stock = Stock::Block { min, max }.dexels(&grid).unwrap();
    let assembly = Assembly::new(Tool::flat(RADIUS, 30.0).unwrap());
    let program = [ToolPath::new(&assembly, path)];
    let options = VerifyOptions::default().each_move(true);
    let go_on = &mut |_: &_| ControlFlow::Continue(());
    let done = verify(Scene::new(stock), &program, &options, go_on, &()).unwrap();
    (done.moves, done.paths[0].volume)
}

/// Lines are 0.1 mm apart, the outermost 0.05 mm inside.
fn close(found: f64, expected: f64) -> bool {
    found <= expected + 1e-6 && found > expected - 0.11
}

#[test]
fn slots_ramps_and_holes_by_hand() {
    let up = [0.0, 0.0, 1.0];
    let at = |x: f64, y: f64, z: f64| pose([x, y, z], up);
    let path = Path::new(vec![
        at(-25.0, 0.0, -2.0),
        // A slot 2 deep, all its width;
        at(25.0, 0.0, -2.0),
        // nothing, outside;
        at(25.0, 1.5, -2.0),
        // 1.5 wide beside it;
        at(-25.0, 1.5, -2.0),
        at(-25.0, 0.75, -2.5),
        // 0.5 deeper over both, but for what is beyond a single width;
        at(25.0, 0.75, -2.5),
        at(25.0, -10.0, 5.0),
        at(0.0, -10.0, 5.0),
        // a hole 4 deep,
        at(0.0, -10.0, -4.0),
        // and the same again.
        at(0.0, -10.0, -4.0),
        at(0.0, -10.0, 5.0),
    ])
    .unwrap();
    let (moves, total) = moves(&path, [300, 300]);
    let of = |n: usize| moves.iter().find(|m| m.number == n).unwrap();
    for (n, depth, width, volume) in [
        (0, 2.0, 6.0, 30.0 * 6.0 * 2.0),
        (2, 2.0, 1.5, 30.0 * 1.5 * 2.0),
        (4, 0.5, 6.0, 30.0 * 6.0 * 0.5),
        (7, 4.0, 6.0, 9.0 * std::f64::consts::PI * 4.0),
    ] {
        let found = of(n);
        assert!((found.depth - depth).abs() < 1e-6, "{found:?} {depth}");
        assert!(close(found.width, width), "{found:?} {width}");
        assert!((found.volume - volume).abs() < 0.02 * volume, "{found:?} {volume}");
    }
    for n in [1, 3, 5, 6, 8, 9] {
        let found = of(n);
        assert_eq!((found.volume, found.depth, found.width), (0.0, 0.0, 0.0), "{found:?}");
    }
    let sum: f64 = moves.iter().map(|m| m.volume).sum();
    assert!((sum - total).abs() < 1e-9 * total, "{sum} {total}");
}

/// A ramp below a ramp is as deep as their distance, whatever both descend.
#[test]
fn ramps_are_as_deep_as_their_layer() {
    let at = |x: f64, z: f64| pose([x, 0.0, z], [0.0, 0.0, 1.0]);
    let back = [at(30.0, 10.0), at(-30.0, 10.0)];
    let path = [
        &[at(-30.0, 3.0), at(30.0, -3.0)][..],
        &back,
        &[at(-30.0, 2.0), at(30.0, -4.0)],
    ]
    .concat();
    let path = Path::new(path).unwrap();
    let (moves, _) = moves(&path, [60, 60]);
    let last = moves.last().unwrap();
    // The flat bottom is a radius ahead of the axis: that adds radius times slope.
    assert!(
        last.depth >= 1.0 - 1e-6 && last.depth <= 1.0 + RADIUS * 0.1 + 1e-6,
        "{last:?}"
    );
}

/// Any moves, with points on the lines 0.1 mm apart, and the tool at 300 times.
#[test]
fn engagement_on_voxels() {
    let mut judged = 0;
    for seed in 0..12 {
        let random = &mut Random::new(7000 + seed);
        let any = |random: &mut Random| {
            let tip = [
                random.within(-12.0, 12.0),
                random.within(-12.0, 12.0),
                random.within(-5.0, 1.0),
            ];
            (tip, [random.within(-0.3, 0.3), random.within(-0.3, 0.3), 1.0])
        };
        let (start, axis) = any(random);
        let fixed = random.below(2) == 0;
        let arc = random.below(3) == 0;
        let (end, other) = any(random);
        let (poses, way) = if arc {
            let centre = [start[0] - 4.0, start[1], start[2]];
            let end = [start[0] - 4.0, start[1] + 4.0, start[2] - random.within(0.0, 1.0)];
            let up = [0.0, 0.0, 1.0];
            let course = TipCourse::Arc(TipArc::between(start, end, centre, up, 1).unwrap());
            (
                vec![pose(start, up), pose(end, up)],
                Move {
                    course,
                    turning: Turning::Even,
                },
            )
        } else {
            let last = if fixed { axis } else { other };
            (vec![pose(start, axis), pose(end, last)], Move::default())
        };
        let path = Path::with_moves(poses, vec![way]).unwrap();
        let cells = [25, 25];
        let (found, _) = moves(&path, cells);
        let segments = path.segments(0, 50.0, 1e-7);
        let each = 300 / segments.len();
        let places: Vec<(Vector3<f64>, Vector3<f64>)> = segments
            .iter()
            .flat_map(|segment| (0..=each).map(move |k| segment.at(k as f64 / each as f64)))
            .map(|(turn, tip)| (Vector3::from(tip), turn.column(2).into_owned()))
            .collect();
        let (mut heights, mut widths) = ([f64::MAX, f64::MIN], [f64::MAX, f64::MIN]);
        let grid = Grid::new([-15.0, -15.0], [15.0, 15.0], cells).unwrap();
        for index in 0..grid.len() {
            let (i, j) = grid.place(index);
            for k in 0..100 {
                let point = Vector3::new(grid.x(i), grid.y(j), -10.0 + 0.1 * (k as f64 + 0.5));
                let seen = |(tip, axis): &(Vector3<f64>, Vector3<f64>)| {
                    let height = (point - tip).dot(axis);
                    (height, (point - tip - axis * height).norm())
                };
                let cut = places.iter().map(seen).any(|(h, r)| h > 0.0 && h < 30.0 && r < RADIUS);
                if !cut {
                    continue;
                }
                let nearest = (0..places.len()).min_by(|a, b| seen(&places[*a]).1.total_cmp(&seen(&places[*b]).1));
                let n = nearest.unwrap();
                let height = seen(&places[n]).0;
                let [before, after] = [n.saturating_sub(1), (n + 1).min(places.len() - 1)];
                let on = |n: usize| places[n].0 + places[n].1 * height;
                let sideways = places[n].1.cross(&(on(after) - on(before))).normalize();
                let width = (point - places[n].0).dot(&sideways);
                for (range, value) in [(&mut heights, height), (&mut widths, width)] {
                    *range = [range[0].min(value), range[1].max(value)];
                }
            }
        }
        if heights[0] > heights[1] {
            assert_eq!(found[0].volume, 0.0);
            continue;
        }
        judged += 1;
        let expected = [heights[1] - heights[0], widths[1] - widths[0]];
        for (found, expected) in [found[0].depth, found[0].width].into_iter().zip(expected) {
            // Points are 0.1 apart, and so are times.
            assert!((found - expected).abs() < 0.25, "seed {seed}: {found} {expected}");
        }
    }
    assert!(judged >= 8, "{judged}");
}
