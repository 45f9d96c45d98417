//! Dexels in any frame see the same cuts, and those along three axes one part.

use nalgebra::Vector3;
use sweepsim::{Cut, Method, Options, simulate_tri, sweep};
use sweepsim_dexel::{Dexels, Frame, Grid, Stock, TriDexels};
use sweepsim_motion::{Law, Move, Path, Pose, TipArc, Tool, Turning};
use sweepsim_props::*;

const TOLERANCE: f64 = 1e-6;

/// The pose in the coordinates of a frame.
fn seen(pose: &Pose, frame: &Frame) -> Pose {
    let turn = |v: Vector3<f64>| frame.turn_from_world(v.into());
    let tip = frame.from_world(pose.tip());
    Pose::new(tip, turn(Vector3::from(pose.axis()))).expect("a pose")
}

/// Ends of the two agree wherever both have as many; lines near a silhouette may differ. Says how many lines were
/// compared, and differed.
fn compare(a: &Dexels, b: &Dexels) -> (usize, usize) {
    let (mut lines, mut differ) = (0, 0);
    for index in 0..a.grid().len() {
        let (p, q) = (a.at(index).to_vec(), b.at(index).to_vec());
        lines += usize::from(!p.is_empty());
        let close = p.len() == q.len()
            && p.iter().zip(&q).all(|(p, q)| {
                [(p.lower, q.lower), (p.upper, q.upper)].iter().all(|(p, q)| {
                    // Both are displaced, and a steep wall multiplies that.
                    (p.z - q.z).abs() < 2.0 * TOLERANCE * (1.0 + 0.02 / f64::from(p.normal[2].abs()).max(1e-9))
                })
            });
        differ += usize::from(!close);
    }
    (lines, differ)
}

fn vector() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-1.0..1.0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_frame_is_the_world_moved_the_other_way(
        (o, z, x) in (vector(), vector(), vector()),
        tips in prop::array::uniform3(vector()),
        axes in prop::array::uniform3(vector()),
        law in prop_oneof![Just(Law::Slerp), Just(Law::ConstantSpeed)],
        tool in 0..2usize,
    ) {
        let frame = Frame::new(o, z, x).map_err(|error| TestCaseError::reject(error.to_string()))?;
        let poses: Vec<Pose> = tips
            .iter()
            .zip(&axes)
            .filter_map(|(tip, a)| Pose::new(tip.map(|c| 4.0 * c), [a[0], a[1], a[2] + 1.2]).ok())
            .collect();
        let tool = [Tool::ball(1.5, 6.0), Tool::bull(1.5, 0.4, 6.0)][tool].clone().unwrap();
        let moved: Vec<Pose> = poses.iter().map(|pose| seen(pose, &frame)).collect();
        let along = |poses| Path::with_law(poses, law).map_err(|error| TestCaseError::reject(error.to_string()));
        let (path, moved) = (along(poses)?, along(moved)?);
        let grid = Grid::new([-9.03, -8.91], [9.07, 9.05], [24, 24]).unwrap();
        for method in [Method::General, Method::Lines] {
            let options = Options::new(TOLERANCE).method(method);
            let framed = sweep(&tool, &path, &grid.in_frame(frame), &options, &()).unwrap();
            let world = sweep(&tool, &moved, &grid, &options, &()).unwrap();
            prop_assert!(framed.statistics.unresolved.is_empty() && world.statistics.unresolved.is_empty());
            prop_assert_eq!(framed.volume.grid().frame(), &frame);
            let (lines, differ) = compare(&framed.volume, &world.volume);
            prop_assert!(lines > 5 && differ == 0, "{method}: {differ} of {lines}");
        }
    }
}

/// How deep a point is in what a ball end of radius 2 sweeps along a quarter of a circle of radius 6 about the world's
/// x (the tip's), its axis along x: a ball at the tip's side and a rod.
fn quarter_depth(p: [f64; 3]) -> f64 {
    // The tool is symmetric about x-lines through the circle: distance from the arc in y, z, and where along x.
    let angle = p[2].atan2(p[1]).clamp(0.0, std::f64::consts::FRAC_PI_2);
    let off = (p[1] - 6.0 * angle.cos()).hypot(p[2] - 6.0 * angle.sin());
    let ball = 2.0 - off.hypot(p[0] - 2.0);
    let rod = (2.0 - off).min(p[0] - 2.0).min(9.0 - p[0]);
    ball.max(rod)
}

#[test]
fn arcs_in_frames_are_where_they_are() {
    let x = [1.0, 0.0, 0.0];
    let arc = TipArc::new([0.0; 3], x, std::f64::consts::FRAC_PI_2).unwrap();
    let poses = [[0.0, 6.0, 0.0], [0.0, 0.0, 6.0]].map(|tip| Pose::new(tip, x).unwrap());
    let path = Path::with_moves(
        poses.to_vec(),
        vec![Move {
            turning: Turning::Slerp,
            ..Move::arc(arc)
        }],
    )
    .unwrap();
    let tool = Tool::ball(2.0, 9.0).unwrap();
    let frames = [
        Frame::WORLD,
        Frame::cyclic(0),
        Frame::cyclic(1),
        Frame::new([1.0, -2.0, 3.0], [1.0, 2.0, 2.0], [0.0, 1.0, 0.5]).unwrap(),
    ];
    for frame in frames {
        let grid = Grid::new([-13.03, -12.97], [13.0, 13.01], [27, 25])
            .unwrap()
            .in_frame(frame);
        let swept = sweep(&tool, &path, &grid, &Options::new(TOLERANCE), &()).unwrap();
        assert!(swept.statistics.unresolved.is_empty());
        let mut inside = 0;
        for index in 0..grid.len() {
            let (i, j) = grid.place(index);
            let line = swept.volume.at(index).to_vec();
            for k in 0..400 {
                let z = -14.0 + 0.07 * f64::from(k) + 1e-3;
                let depth = quarter_depth(frame.to_world([grid.x(i), grid.y(j), z]));
                if depth.abs() < 1e-4 {
                    continue;
                }
                let found = line.iter().any(|piece| piece.lower.z < z && z < piece.upper.z);
                inside += usize::from(found);
                assert_eq!(found, depth > 0.0, "{frame:?}: dexel ({i}, {j}) at {z}, {depth} deep");
            }
        }
        assert!(inside > 2000, "{frame:?}: {inside}");
    }
}

#[test]
fn three_sets_cut_one_part() {
    let block = Stock::Block {
        min: [0.0; 3],
        max: [20.0, 16.0, 8.0],
    };
    let (min, max) = ([-0.31, -0.31, -0.31], [20.29, 16.27, 8.3]);
    let cells = [103, 83, 43];
    let stock = TriDexels::new(min, max, cells, &block).unwrap();
    let tool = Tool::ball(2.5, 12.0).unwrap();
    let poses = [
        ([-4.0, 5.0, 5.0], [0.1, 0.0, 1.0]),
        ([12.0, 9.0, 4.0], [0.0, -0.3, 1.0]),
        ([13.0, 20.0, 6.0], [0.3, 0.2, 1.0]),
    ];
    let poses = poses.map(|(tip, axis)| Pose::new(tip, axis).unwrap());
    let path = Path::new(poses.to_vec()).unwrap();
    let cut = Cut::new(&tool, &path);
    let part = simulate_tri(stock, &[cut], &Options::new(TOLERANCE), &()).unwrap();
    assert!(part.statistics.iter().all(|s| s.unresolved.is_empty()));
    // Where lines cross they agree.
    assert_eq!(part.remaining.disagreements(), 0);
    // Sets along one axis err by the rule of the midpoint; a closed surface with exact normals by the square of the
    // distance of lines.
    let volumes = part.remaining.sets().each_ref().map(Dexels::volume);
    let mesh = part.remaining.surface().unwrap().soup().unwrap().volume();
    let fine = TriDexels::new(min, max, cells.map(|n| 3 * n), &block).unwrap();
    let exact = simulate_tri(fine, &[cut], &Options::new(TOLERANCE), &()).unwrap();
    let exact = exact.remaining.surface().unwrap().soup().unwrap().volume();
    assert!((mesh - exact).abs() < 2e-3 * exact, "{mesh} {exact}");
    assert!(
        volumes.iter().all(|v| (v - exact).abs() < 0.02 * exact),
        "{volumes:?} {exact}"
    );
}
