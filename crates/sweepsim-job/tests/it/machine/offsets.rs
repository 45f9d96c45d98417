//! A place for the part that is free, proposed where its own is not.

use super::places::{met, state, written};
use super::{judged, request};
use sweepsim_job::{Judging, Outcome, ProgramOptions, StatementState};

const BLOCK: [[f64; 3]; 2] = [[-50.0; 3], [50.0, 50.0, 0.0]];

/// Another place is to be looked for.
fn placed() -> Judging {
    let mut judging = Judging::default();
    judging.place = true;
    judging
}

/// A mill with a post on its bed at X 200 … 240, and X from -250 to 250.
fn run(offset: [f64; 3], program: &str, judging: Judging) -> Outcome {
    let [x, y, z] = offset;
    let machine = format!(
        r#"Machine(name: "mill", part_zero: ({x}, {y}, {}), tool_length: 100, rapid: Straight, bodies: [
        (name: "table", on: "base", shape: Block(min: (-300, -200, -560), max: (300, 200, -460))),
        (name: "post", on: "base", shape: Block(min: (200, -200, -460), max: (240, 200, -250))),
        (name: "spindle", on: "Z", shape: Cylinder(from: (0, 0, 0), to: (0, 0, 150), radius: 40)),
    ], linear: [(letter: 'X', limits: (-250, 250), home: 0), (letter: 'Y', limits: (-200, 200), home: 0),
        (letter: 'Z', limits: (-450, 0), home: 0)], tool_change: [{{'Z': 0}}])"#,
        z - 400.0
    );
    judged(&written(&machine), program, BLOCK, judging)
}

fn is_free(outcome: &Outcome) -> bool {
    let limits = outcome
        .findings()
        .iter()
        .filter(|finding| finding.kind == "limit")
        .count();
    state(outcome) == StatementState::Proven && limits == 0 && met(outcome).is_empty()
}

/// The box is free at some corners and in its middle, and as large as it may be on the side that is bounded.
fn check(program: &str, side: usize, is_upper: bool, bound: f64) {
    let outcome = run([0.0; 3], program, placed());
    assert!(!is_free(&outcome));
    let [low, high] = outcome.report().free_place.expect("a place");
    assert!((0..3).all(|k| low[k] < high[k]), "{low:?} {high:?}");
    let own = if is_upper { high[side] } else { low[side] };
    let reached = if is_upper { bound - own } else { own - bound };
    assert!((0.0..3.0).contains(&reached), "{low:?} {high:?}: {bound}");
    // Two opposite corners, two more, and the middle.
    for n in [0, 7, 3, 4, 8] {
        let at = [0, 1, 2].map(|k| match n {
            8 => 0.5 * (low[k] + high[k]),
            _ if n >> k & 1 == 1 => high[k],
            _ => low[k],
        });
        assert!(
            is_free(&run(at, program, Judging::default())),
            "{at:?} of {low:?} {high:?}"
        );
    }
    // Below, where it does not pass over the post.
    let mut beyond = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), low[2]];
    beyond[side] = if is_upper { bound + 0.1 } else { bound - 0.1 };
    assert!(!is_free(&run(beyond, program, Judging::default())), "{beyond:?}");
    assert!(
        outcome
            .report()
            .notes
            .iter()
            .any(|note| note.contains("proven free of collisions"))
    );
}

#[test]
fn a_free_place_is_proposed_beside_a_post() {
    // The spindle, at X 170 + 40, is in the post, which only less X leaves: it ends 10 mm before it.
    check(
        "G21 G90\nT1 M6\nS900 M3\nG0 X0 Y0 Z60\nG0 X170\nG0 Z20\nG0 Z60\nM30\n",
        0,
        true,
        -10.0,
    );
}

#[test]
fn a_free_place_is_proposed_within_limits() {
    // X 270 of 250, above the post.
    check(
        "G21 G90\nT1 M6\nS900 M3\nG0 X0 Y0 Z200\nG0 X270\nG0 X0\nG0 Z60\nM30\n",
        0,
        true,
        -20.0,
    );
    // Y from -195 to 215: no more than 5 mm the other way.
    check(
        "G21 G90\nT1 M6\nS900 M3\nG0 X0 Y0 Z200\nG0 Y215\nG0 Y-180\nM30\n",
        1,
        true,
        -15.0,
    );
}

#[test]
fn no_place_is_proposed_where_there_is_none() {
    let outcome = run(
        [0.0; 3],
        "G21 G90\nT1 M6\nS900 M3\nG0 X0 Y0 Z200\nG0 Y215\nG0 Y-195\nM30\n",
        placed(),
    );
    assert_eq!(outcome.report().free_place, None);
    assert!(
        outcome
            .report()
            .notes
            .iter()
            .any(|note| note.starts_with("no other place of the part was found"))
    );
}

#[test]
fn no_place_is_looked_for_without_a_machine() {
    let program = "G21 G90\nT1 M6\nS900 M3\nG0 X0 Y0 Z60\nG1 Z5 F300\nM30\n";
    let request = request("3-axis", program, BLOCK, placed()).program(ProgramOptions::default());
    let outcome = request.plan().unwrap().run(&()).unwrap();
    let notes = &outcome.report().notes;
    assert!(
        notes.iter().any(|note| note.contains("there is no machine")),
        "{notes:?}"
    );
}
