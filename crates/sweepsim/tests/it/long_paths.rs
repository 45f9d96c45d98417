//! Paths of more moves than are prepared at a time.

use sweepsim::dexel::Source;
use sweepsim::prelude::*;

/// Grooves side by side, each of so many moves.
const MOVES: usize = 2_000;
const GROOVES: usize = 35;

/// The lines are in the middle of the grooves, of which each is a little deeper than the last; every third move of the tool is a rest.
#[test]
fn long_paths() {
    let bottom = |groove: usize| 4.0 - 0.01 * groove as f64;
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
    let place: Vec<usize> = poses
        .iter()
        .map(|pose| (2.0 * pose.tip()[1]).round() as usize)
        .collect();
    let (tool, path) = (Tool::flat(0.2, 20.0).unwrap(), Path::new(poses).unwrap());
    let grid = Grid::new([-9.5, -0.25], [9.5, 0.5 * GROOVES as f64 - 0.25], [19, GROOVES]).unwrap();
    let stock = Stock::Block {
        min: [-10.0, -1.0, 0.0],
        max: [10.0, 20.0, 5.0],
    };
    let stock = stock.dexels(&grid).unwrap();
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
