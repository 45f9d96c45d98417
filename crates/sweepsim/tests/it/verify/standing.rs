//! Paths of a single pose: nothing moves, but the tool removes what it covers, and its bodies touch what is in their
//! way.

use super::by_force::{Cylinder, pose};
use std::ops::ControlFlow;
use sweepsim::prelude::*;
use sweepsim::verify::{Scene, ToolPath, Verification, VerifyOptions, verify};
use sweepsim_motion::{Assembly, BodyKind};

/// A short cutter in a block, with a holder that is in the block as well, and a clamp over it that both are in.
fn judged(path: &Path) -> Verification {
    let grid = Grid::new([-10.0, -10.0], [10.0, 10.0], [20, 20]).unwrap();
    let block = |min, max| Stock::Block { min, max }.dexels(&grid).unwrap();
    let clamp = block([1.0, -1.0, 0.0], [9.0, 1.0, 4.0]);
    let [cutter, holder] = [(3.0, [0.0, 1.0]), (5.0, [1.0, 9.0])].map(|(radius, z)| Cylinder { radius, z }.tool());
    let assembly = Assembly::new(cutter).with(BodyKind::Holder, holder);
    let scene = Scene::new(block([-10.0, -10.0, -15.0], [10.0, 10.0, 0.0])).with_fixtures(&clamp);
    let program = [ToolPath::new(&assembly, path)];
    let go_on = &mut |_: &_| ControlFlow::Continue(());
    verify(scene, &program, &VerifyOptions::default().each_move(true), go_on, &()).unwrap()
}

#[test]
fn a_single_pose_is_judged_like_a_move_that_goes_nowhere() {
    for axis in [[0.0, 0.0, 1.0], [0.2, 0.1, 1.0]] {
        let at = pose([0.0, 0.0, -2.0], axis);
        let [alone, twice] = [1, 2].map(|poses| judged(&Path::new(vec![at; poses]).unwrap()));
        let kinds = |done: &Verification| -> Vec<_> {
            let one = |one: &sweepsim::verify::Finding| (one.kind, one.body, one.number, one.depth > 1.0);
            done.findings.iter().map(one).collect()
        };
        assert_eq!(kinds(&alone), kinds(&twice));
        assert_eq!(alone.findings.len(), 2, "{:?}", alone.findings);
        assert_eq!(alone.remaining, twice.remaining);
        assert_eq!(alone.moves, twice.moves);
        let removed = alone.paths[0].volume;
        assert!(
            (removed - twice.paths[0].volume).abs() < 1e-9 && removed > 25.0,
            "{removed}"
        );
    }
}
