//! Paths of more moves than are prepared at a time.

use std::ops::ControlFlow;
use sweepsim::dexel::Source;
use sweepsim::prelude::*;
use sweepsim::verify::{FindingKind, MoveState, Scene, ToolPath, VerifyOptions, verify};
use sweepsim_motion::Assembly;

/// Grooves side by side, each of so many moves.
const MOVES: usize = 2_000;
const GROOVES: usize = 35;

/// The bottom of a groove.
fn bottom(groove: usize) -> f64 {
    4.0 - 0.01 * groove as f64
}

/// Each groove is a little deeper than the last; every third move of the tool is a rest.
fn poses() -> Vec<Pose> {
    let mut poses = Vec::new();
    for groove in 0..GROOVES {
        for n in 0..=MOVES {
            let x = 20.0 * n as f64 / MOVES as f64 - 10.0;
            let x = if groove % 2 == 0 { x } else { -x };
            let tip = [x, 0.5 * groove as f64, bottom(groove)];
            poses.push(Pose::new(tip, [0.0, 0.0, 1.0]).unwrap());
            if n % 3 == 2 {
                poses.push(poses[poses.len() - 1]);
            }
        }
    }
    assert!(poses.len() > (1 << 16) + MOVES);
    poses
}

/// The groove of each pose.
fn grooves(poses: &[Pose]) -> Vec<usize> {
    poses
        .iter()
        .map(|pose| (2.0 * pose.tip()[1]).round() as usize)
        .collect()
}

/// Lines in the middle of the grooves, and a block. No line is as far from a pose as the tool's wall is.
fn stock() -> Dexels {
    let grid = Grid::new([-9.497, -0.25], [9.503, 0.5 * GROOVES as f64 - 0.25], [19, GROOVES]).unwrap();
    let block = Stock::Block {
        min: [-10.0, -1.0, 0.0],
        max: [10.0, 20.0, 5.0],
    };
    block.dexels(&grid).unwrap()
}

#[test]
fn long_paths() {
    let poses = poses();
    let place = grooves(&poses);
    let (tool, path) = (Tool::flat(0.2, 20.0).unwrap(), Path::new(poses).unwrap());
    let stock = stock();
    let options = Options::new(1e-6);
    let whole = simulate(stock.clone(), &[Cut::new(&tool, &path)], &options, &()).unwrap();
    assert_eq!(whole.statistics.moves, path.moves());
    assert!(whole.statistics.unresolved.is_empty());
    for groove in 0..GROOVES {
        for i in 0..19 {
            let dexel: Vec<_> = whole.remaining.intervals(i, groove).into_iter().collect();
            assert_eq!(dexel.len(), 1);
            let top = dexel[0].upper;
            assert!((top.z - bottom(groove)).abs() < 1e-6, "{} at {i}, {groove}", top.z);
            let Source::Cut { path: 0, segment, .. } = top.source else {
                panic!("{:?}", top.source)
            };
            assert_eq!(place[segment as usize + 1], groove);
        }
    }
    // The same, the second half first.
    let half = path.poses().len() / 2;
    let [first, second] =
        [&path.poses()[..=half], &path.poses()[half..]].map(|poses| Path::new(poses.to_vec()).unwrap());
    let cuts = [Cut::new(&tool, &second), Cut::new(&tool, &first)];
    let divided = simulate(stock, &cuts, &options, &()).unwrap();
    assert!((divided.remaining.volume() - whole.remaining.volume()).abs() < 1e-4);
}

/// The last groove, far behind the first moves that are prepared together, is cut by rapids.
#[test]
fn long_programs_are_verified() {
    let poses = poses();
    let place = grooves(&poses);
    let (cutter, path) = (Assembly::new(Tool::flat(0.2, 20.0).unwrap()), Path::new(poses).unwrap());
    let last = |number: &usize| place[*number] == GROOVES - 1;
    let state = |number: usize| {
        if last(&number) {
            MoveState::RAPID
        } else {
            MoveState::FEED
        }
    };
    let states: Vec<MoveState> = (0..path.moves()).map(state).collect();
    let program = [ToolPath::new(&cutter, &path).with_states(&states)];
    let options = VerifyOptions::default();
    let go_on = &mut |_: &_| ControlFlow::Continue(());
    let found = verify(Scene::new(stock()), &program, &options, go_on, &()).unwrap();
    assert!(found.unresolved.is_empty() && found.undecided.is_empty());
    assert!(
        found
            .findings
            .iter()
            .all(|finding| finding.kind == FindingKind::Rapid && last(&finding.number))
    );
    // Each line of the groove is met by one move: those that rest meet none.
    let depth = 5.0 - bottom(GROOVES - 1);
    assert_eq!(found.findings.len(), 19);
    assert!(
        found
            .findings
            .iter()
            .all(|finding| (finding.depth - depth).abs() < 1e-5)
    );
    let simulated = simulate(stock(), &[Cut::new(cutter.cutter(), &path)], &Options::default(), &()).unwrap();
    assert!((found.remaining.volume() - simulated.remaining.volume()).abs() < 1e-4);
}
