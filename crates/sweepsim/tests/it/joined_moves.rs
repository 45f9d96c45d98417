//! Consecutive moves in one direction, which `simulate` joins to one: the same dexels as from each move by itself, and
//! sources that say which of them it was.

use super::translations::{TOLERANCE, UP, path, same, tools};
use sweepsim::{Cut, Method, Options, Simulation, simulate};
use sweepsim_dexel::{Dexels, Grid, Interval, Source, Stock};
use sweepsim_motion::{Path, Tool};
use sweepsim_props::*;

fn stock() -> Dexels {
    let grid = Grid::new([-12.3, -12.1], [12.2, 12.4], [31, 29]).expect("a grid");
    let block = Stock::Block {
        min: [-12.0, -12.0, -9.0],
        max: [12.0, 12.0, 3.0],
    };
    block.dexels(&grid).expect("stock")
}

fn cut(tool: &Tool, path: &Path, method: Method) -> Simulation {
    let options = Options::new(TOLERANCE).method(method);
    simulate(stock(), &[Cut::new(tool, path)], &options, &()).expect("a simulation")
}

/// The corners, with points of the straight ways between them: as many as `pieces` says, where it says so; those at
/// rest twice.
fn divided(corners: &[[f64; 3]], pieces: &[usize], rests: bool) -> Vec<[f64; 3]> {
    let mut tips = vec![corners[0]];
    for (n, pair) in corners.windows(2).enumerate() {
        let count = pieces[n % pieces.len()];
        for k in 1..=count {
            let s = k as f64 / count as f64;
            tips.push([0, 1, 2].map(|i| pair[0][i] + s * (pair[1][i] - pair[0][i])));
            if rests && k % 3 == 1 {
                tips.push(tips[tips.len() - 1]);
            }
        }
    }
    tips
}

fn corner() -> impl Strategy<Value = [f64; 3]> {
    let level = prop_oneof![Just(0.0), Just(-2.0), -6.0..5.0_f64];
    let coarse = || prop_oneof![-9.0..9.0_f64, (-9..9_i32).prop_map(f64::from)];
    (coarse(), coarse(), level).prop_map(|(x, y, z)| [x, y, z])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(debug_assertions) { 60 } else { 600 }))]

    #[test]
    fn moves_in_one_direction_cut_as_one(
        kind in 0..13_usize, lean in prop_oneof![Just([0.0; 2]), [-0.4..0.4, -0.4..0.4]], corners in collection::vec(corner(), 2..5),
        pieces in collection::vec(1..40_usize, 3), rests in any::<bool>(),
    ) {
        let (name, tool, _) = tools().swap_remove(kind);
        let axis = [lean[0], lean[1], 1.0];
        let tips = divided(&corners, &pieces, rests);
        let found = cut(&tool, &path(&tips, axis), Method::Mixed);
        prop_assert!(found.statistics.unresolved.is_empty(), "{}: {:?}", name, found.statistics);
        for (tips, method) in [(&tips, Method::General), (&corners, Method::Mixed)] {
            let other = cut(&tool, &path(tips, axis), method);
            for line in 0..found.remaining.grid().len() {
                // Intervals shorter than the tolerance may be missing or extra.
                let long = |interval: &Interval| interval.upper.z - interval.lower.z > 2.0 * TOLERANCE;
                let [a, b] = [&found, &other].map(|cut| cut.remaining.at(line).into_iter().filter(long).collect::<Vec<_>>());
                prop_assert!(same(&a, &b, 2.0 * TOLERANCE), "{} at {}: {:?} {:?}", name, line, a, b);
            }
        }
    }

    /// A ball end touches what it leaves when it is said to.
    #[test]
    fn sources_are_those_of_the_moves(
        corners in collection::vec(corner(), 2..5), pieces in collection::vec(1..40_usize, 3), rests in any::<bool>(),
    ) {
        let radius = 2.5;
        let tips = divided(&corners, &pieces, rests);
        let found = cut(&Tool::ball(radius, 30.0).unwrap(), &path(&tips, UP), Method::Mixed);
        let grid = *found.remaining.grid();
        let mut counted = 0;
        for line in 0..grid.len() {
            let (i, j) = grid.place(line);
            let [x, y] = [grid.x(i), grid.y(j)];
            for end in found.remaining.at(line).into_iter().flat_map(|interval| [interval.lower, interval.upper]) {
                let Source::Cut { segment, t, .. } = end.source else { continue };
                let [from, to] = [tips[segment as usize], tips[segment as usize + 1]];
                let tip = [0, 1, 2].map(|k| from[k] + f64::from(t) * (to[k] - from[k]));
                // Up to its centre, the ball; beyond, its wall.
                let up = (end.z - tip[2] - radius).min(0.0);
                let distance = (x - tip[0]).hypot(y - tip[1]).hypot(up);
                prop_assert!((distance - radius).abs() < 2e-3, "{} at {:?}: move {}, {}", distance, [x, y, end.z], segment, t);
                counted += 1;
            }
        }
        prop_assert!(counted > 0 || corners.iter().all(|tip| tip[2] > 2.0));
    }
}
