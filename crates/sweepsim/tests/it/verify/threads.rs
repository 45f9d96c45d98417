//! The result does not depend on the number of threads.

use super::by_force::Case;
use super::{Random, clean};
use std::ops::ControlFlow;
use sweepsim::prelude::*;
use sweepsim::verify::{FindingKind, MoveState, Scene, ToolPath, Verification, VerifyOptions, verify};
use sweepsim_motion::{Assembly, BodyKind};

fn verified(case: &Case, threads: usize) -> Verification {
    let [min, max] = case.stock;
    let stock = Stock::Block { min, max }.dexels(&case.grid()).unwrap();
    let assembly = Assembly::new(case.cutter.tool()).with(BodyKind::Holder, case.holder.tool());
    let path = case.path();
    let program = [ToolPath::new(&assembly, &path).with_states(&case.states)];
    let options = VerifyOptions::default().each_move(threads % 2 == 1);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let go_on = &mut |_: &_| ControlFlow::Continue(());
    pool.install(|| verify(Scene::new(stock), &program, &options, go_on, &()).unwrap())
}

/// A long raster, deep in the block and partly by rapids, with a holder that drags through what is left: most of its
/// moves do harm.
fn harmful(seed: u64) -> Case {
    let random = &mut Random::new(seed);
    let mut case = clean(random);
    let (mut poses, mut states) = (Vec::new(), Vec::new());
    for (n, pose) in case.poses.iter().enumerate() {
        for part in 0..6 {
            let [x, y, z] = pose.tip();
            let tip = [
                x * (1.0 - f64::from(part) / 6.0),
                y,
                z.min(0.0) - random.within(0.0, 3.0),
            ];
            poses.push(Pose::new(tip, pose.axis()).unwrap());
            let rapid = n % 5 == 4;
            states.push(if rapid { MoveState::RAPID } else { MoveState::FEED });
        }
    }
    states.pop();
    (case.poses, case.states) = (poses, states);
    case.holder.z[0] = random.within(1.0, 3.0);
    case
}

#[test]
fn findings_and_dexels_are_the_same_on_any_number_of_threads() {
    for seed in 0..3 {
        let case = harmful(700 + seed);
        let one = verified(&case, 1);
        let count = |kind| one.findings.iter().filter(|finding| finding.kind == kind).count();
        let (bodies, rapids) = (count(FindingKind::Collision), count(FindingKind::Rapid));
        assert!(
            bodies > case.states.len() / 2 && rapids > 0,
            "seed {seed}: {bodies}, {rapids}"
        );
        for threads in [2, 5] {
            let more = verified(&case, threads);
            assert_eq!(more.findings, one.findings, "seed {seed}, {threads} threads");
            assert!(more.remaining == one.remaining, "seed {seed}, {threads} threads");
            assert_eq!(more.paths, one.paths);
            assert_eq!(
                (more.unresolved, more.undecided),
                (one.unresolved.clone(), one.undecided.clone())
            );
        }
    }
}
