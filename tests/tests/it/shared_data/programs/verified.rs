//! What verification says of real programs on a guessed block, with a holder that is too short: each finding is judged
//! by placing cylinders at dense times, on the line of its place.

use super::super::folder;
use by_force::{Cylinder, Placement, meets, subtract};
use std::ops::ControlFlow;
use sweepsim::verify::{FindingKind, MoveState, Scene, ToolPath, VerifyOptions, verify};
use sweepsim_formats::Job;
use sweepsim_motion::{Assembly, BodyKind, Path};

#[path = "../../../../../crates/sweepsim/tests/it/verify/by_force.rs"]
#[expect(dead_code, reason = "only the cylinders are used")]
mod by_force;

const CUTTER: Cylinder = Cylinder {
    radius: 3.0,
    z: [0.0, 24.0],
};
const HOLDER: Cylinder = Cylinder {
    radius: 15.0,
    z: [24.0, 64.0],
};
/// What touches is taken larger or smaller by this, and what removes material the other way round.
const MARGIN: f64 = 0.05;
/// The most that a tip or a holder moves between two times.
const STEP: f64 = 0.1;

fn placed(path: &Path, number: usize, to: f64) -> impl Iterator<Item = Placement> {
    let segments = path.segments(number, 64.0, 1e-6);
    let turns: f64 = segments
        .iter()
        .map(|segment| (segment.end() - segment.start()).norm())
        .sum();
    let count = ((path.tip_length(number) + 64.0 * turns) * to / STEP).ceil().max(1.0) as usize;
    (0..=count).map(move |step| {
        let time = to * step as f64 / count as f64;
        let local = time * segments.len() as f64;
        let n = (local as usize).min(segments.len() - 1);
        let segment = &segments[n];
        let (turn, tip) = segment.at(segment.at_time(local - n as f64));
        Placement {
            number,
            state: MoveState::FEED,
            time,
            back: turn.transpose(),
            tip,
        }
    })
}

/// The number of findings of a program, a third of which are judged, and how many of them begin after their move has
/// begun.
fn judged(program: &str, cell: f64, block: [[f64; 3]; 2]) -> [usize; 2] {
    let [min, max] = block;
    let file = folder().join(program);
    let text = format!(
        "Job(grid: Grid(cell: {cell:?}), stock: Block(min: ({}, {}, {}), max: ({}, {}, {})), tools: {{1: Flat(radius: 3, length: 24)}}, paths: [Path(tool: 1, file: {file:?}, arcs: Exact)])",
        min[0], min[1], min[2], max[0], max[1], max[2],
    );
    let job = Job::parse(&text, &file).expect("a job");
    let [path] = &job.paths[..] else { panic!("one path") };
    let state = |rapid: bool| if rapid { MoveState::RAPID } else { MoveState::FEED };
    let states: Vec<MoveState> = path.rapid.iter().map(state).collect();
    let assembly = Assembly::new(job.tools[&1].clone()).with(BodyKind::Holder, HOLDER.tool());
    let stock = job.stock.dexels(&job.grid).expect("a stock");
    let program = [ToolPath::new(&assembly, &path.path).with_states(&states)];
    let go_on = &mut |_: &_| ControlFlow::Continue(());
    let found = verify(Scene::new(stock), &program, &VerifyOptions::default(), go_on, &()).expect("a verification");
    assert!(found.unresolved.is_empty() && found.undecided.is_empty());
    let mut later = 0;
    // As many lines as there are findings: what is left of each by as much as the cutter surely, and possibly, removes.
    for finding in found.findings.iter().step_by(3) {
        let [x, y, z] = finding.place;
        let probe = match finding.kind {
            FindingKind::Collision => HOLDER,
            FindingKind::Rapid => CUTTER,
            other => panic!("{other:?}"),
        };
        let (mut most, mut least) = (vec![[min[2], max[2]]], vec![[min[2], max[2]]]);
        let remove = |placed: &Placement, most: &mut Vec<[f64; 2]>, least: &mut Vec<[f64; 2]>| {
            if let Some(cut) = CUTTER.grown(-MARGIN).on_line(placed, x, y) {
                subtract(most, cut);
            }
            if let Some(cut) = CUTTER.grown(MARGIN).on_line(placed, x, y) {
                subtract(least, cut);
            }
        };
        for number in 0..finding.number {
            for placed in placed(&path.path, number, 1.0) {
                remove(&placed, &mut most, &mut least);
            }
        }
        let mut last = None;
        for placed in placed(&path.path, finding.number, finding.time) {
            // Not before: a step is left, in which it may begin.
            let travelled = (finding.time - placed.time) * (path.path.tip_length(finding.number) + 1e-9);
            if finding.time > 0.0 && travelled > 2.0 * STEP {
                let early = probe.grown(-MARGIN).on_line(&placed, x, y);
                assert!(!early.is_some_and(|range| meets(&least, range)), "{finding:?} is late");
            }
            if finding.kind == FindingKind::Collision {
                remove(&placed, &mut most, &mut least);
            }
            last = Some(placed);
        }
        later += usize::from(finding.time > 0.0);
        let last = last.expect("a time");
        // The body is there, and so is the material.
        let range = probe
            .grown(MARGIN)
            .on_line(&last, x, y)
            .unwrap_or_else(|| panic!("{finding:?} is elsewhere"));
        assert!(
            range[0] <= z + MARGIN && z <= range[1] + MARGIN,
            "{finding:?}: {range:?}"
        );
        assert!(meets(&most, range), "{finding:?} touches nothing: {most:?}");
    }
    [found.findings.len(), later]
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn findings_of_real_programs() {
    let wheels = [[-4.656, -12.571, -1.471], [92.155, 91.153, 0.0]];
    let [found, _] = judged("3axis/linuxcnc/wheels.ngc", 1.2, wheels);
    assert!(found >= 1);
    let boat = [[-54.781, -31.135, -13.731], [51.076, 27.157, 0.308]];
    let [found, later] = judged("5axis/linuxcnc/boat-xyzac.ngc", 1.2, boat);
    assert!(found > 100 && later >= 5, "{found} {later}");
}
