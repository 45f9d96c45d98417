//! Bodies beside the stock as it is at each time.

use super::Request;
use super::places::{met, state, written};
use sweepsim_job::dexel::Stock;
use sweepsim_job::motion::Tool;
use sweepsim_job::{Outcome, ProgramOptions, StatementState};

/// A spindle that is wider than the cutter, whose tip is 30 mm below its nose, over a block of 100 × 100 × 60.
fn run(program: &str) -> Outcome {
    let machine = r#"Machine(name: "mill", part_zero: (0, 0, -400), tool_length: 30, rapid: Straight, bodies: [
        (name: "table", on: "X", shape: Block(min: (-300, -200, -560), max: (300, 200, -460))),
        (name: "spindle", on: "Z", shape: Cylinder(from: (0, 0, 0), to: (0, 0, 150), radius: 60)),
    ], linear: [(letter: 'X', carries: Part), (letter: 'Y', carries: Part), (letter: 'Z', home: 0)])"#;
    let mut options = ProgramOptions::default();
    options.dialect.machine = Some(written(machine));
    Request::from_program("levels.nc", program)
        .program(options)
        .tool(1, Tool::flat(40.0, 25.0).unwrap())
        .stock(Stock::Block {
            min: [-50.0, -50.0, -60.0],
            max: [50.0, 50.0, 0.0],
        })
        .cells([10, 10])
        .plan()
        .unwrap()
        .run(&())
        .unwrap()
}

/// Passes at these places of Y, down by 12 mm each time: the third time the nose is 6 mm below the top of the block.
fn levels(rows: &[i32]) -> String {
    let mut program = "G21 G90\nT1 M6\nS900 M3\n".to_owned();
    for z in [-12, -24, -36] {
        for y in rows {
            program += &format!("G0 Z50\nG0 X-100 Y{y}\nG0 Z{z}\nG1 X100 F900\n");
        }
    }
    program + "G0 Z50\nM30\n"
}

#[test]
fn what_is_gone_is_not_met() {
    // All of the top is milled away before the nose gets there.
    let outcome = run(&levels(&[-30, 0, 30]));
    assert_eq!((state(&outcome), met(&outcome)), (StatementState::Proven, vec![]));
    // A slot has walls.
    let outcome = run(&levels(&[0]));
    assert_eq!(met(&outcome), [(15, "spindle-stock".to_owned())]);
    assert_eq!(state(&outcome), StatementState::Refuted);
    let finding = outcome
        .findings()
        .iter()
        .find(|finding| finding.kind == "machine")
        .expect("it");
    assert!(finding.depth >= 6.0 && finding.depth < 60.0, "{finding:?}");
    // The spindle reaches the block 60 mm before its middle; a corner of the block is 50 mm beside the slot's middle.
    let time = finding.time.expect("a time");
    let first = 100.0 - 50.0 - (60.0_f64.powi(2) - 40.0_f64.powi(2)).sqrt();
    assert!(time > first / 200.0 - 0.01 && time < 0.25, "{time}");
}
