//! Rapids whose joints are where lines are in the tool's wall: what one move only touches at its end, and the next one
//! cuts, is found.

use std::ops::ControlFlow;
use sweepsim::prelude::*;
use sweepsim::verify::{FindingKind, MoveState, Scene, ToolPath, Verification, VerifyOptions, verify};
use sweepsim_motion::Assembly;

/// A rapid along x through a block, in so many moves of this length, on lines at 0.5, 1.5, ….
fn rapid(tool: Tool, steps: usize, step: f64, [y, lean]: [f64; 2]) -> Verification {
    let grid = Grid::new([0.0, -3.0], [12.0, 3.0], [12, 6]).unwrap();
    let block = Stock::Block {
        min: [0.0, -3.0, 0.0],
        max: [12.0, 3.0, 5.0],
    };
    let pose = |n: usize| Pose::new([-3.0 + step * n as f64, y, 2.0], [lean, 0.0, 1.0]).unwrap();
    let path = Path::new((0..=steps).map(pose).collect()).unwrap();
    let cutter = Assembly::new(tool);
    let states = vec![MoveState::RAPID; steps];
    let program = [ToolPath::new(&cutter, &path).with_states(&states)];
    let go_on = &mut |_: &_| ControlFlow::Continue(());
    let stock = block.dexels(&grid).unwrap();
    verify(Scene::new(stock), &program, &VerifyOptions::default(), go_on, &()).unwrap()
}

#[test]
fn all_that_rapids_cut_is_found() {
    for (tool, y, lean) in [
        (Tool::flat(0.5, 20.0), 0.5, 0.0),
        (Tool::flat(1.5, 20.0), 0.5, 0.0),
        (Tool::flat(1.5, 20.0), 0.25, 0.0),
        (Tool::ball(1.5, 20.0), 0.5, 0.0),
        (Tool::flat(1.5, 20.0), 0.5, 0.2),
    ] {
        let tool = tool.unwrap();
        let whole = rapid(tool.clone(), 1, 18.0, [y, lean]);
        let parts = rapid(tool, 18, 1.0, [y, lean]);
        for found in [&whole, &parts] {
            assert!(found.unresolved.is_empty() && found.undecided.is_empty());
            assert!(found.findings.iter().all(|finding| finding.kind == FindingKind::Rapid));
        }
        let volume = |found: &Verification| found.findings.iter().map(|finding| finding.volume).sum::<f64>();
        let removed = 12.0 * 6.0 * 5.0 - parts.remaining.volume();
        assert!(whole.findings.len() == 1 && removed > 1.0);
        assert!(
            (volume(&whole) - removed).abs() < 1e-3,
            "{} of {removed}",
            volume(&whole)
        );
        assert!(
            (volume(&parts) - removed).abs() < 1e-3,
            "{} of {removed}",
            volume(&parts)
        );
        // In the order of time, each move once.
        assert!(parts.findings.windows(2).all(|pair| pair[0].number < pair[1].number));
    }
}
