//! A register of a diameter that nobody says: as the size of the tool, and as its wear, 0.

use crate::walls::slotted;
use sweepsim_job::dexel::{Stock, TriangleSoup};
use sweepsim_job::motion::Tool;
use sweepsim_job::{Directions, Judging, Outcome, Request};

/// One pass along x with an end mill of 6 mm to the left of y = 15: its axis is at y = 18, or at 15 if D1 is 0.
const PROGRAM: &str =
    "G21 G90\nT1 M6\nS6000 M3\nG0 X-16 Y15 Z5\nG0 Z-4\nG41 D1 G1 X-10 F500\nX68\nG40 X74\nG0 Z5\nM30\n";

fn request(program: &str, target: Option<TriangleSoup>) -> Request {
    let mut judging = Judging::default();
    judging.proof = false;
    let request = Request::from_program("pass.nc", program)
        .tool(1, Tool::flat(3.0, 30.0).unwrap())
        .stock(Stock::Block {
            min: [0.0, 0.0, -10.0],
            max: [60.0, 40.0, 0.0],
        })
        .limits(0.02, 0.02)
        .directions(Directions::Z)
        .judging(judging)
        .cells([60, 40]);
    target.map_or(request.clone(), |target| request.target(target))
}

fn judged(program: &str, target: Option<TriangleSoup>) -> Outcome {
    request(program, target).plan().unwrap().run(&()).unwrap()
}

/// What is said of the register, as warnings and as notes.
fn said(outcome: &Outcome) -> [Vec<String>; 2] {
    let report = outcome.report();
    let about = |all: &[String]| {
        let own = all
            .iter()
            .filter(|one| one.starts_with("D1 (line 6) as the size of tool 1"));
        own.cloned().collect()
    };
    [about(&report.warnings), about(&report.notes)]
}

#[test]
fn a_reading_that_gouges_where_the_other_does_not_is_a_warning() {
    // The contour is that of the wall.
    let [warnings, notes] = said(&judged(PROGRAM, Some(slotted([15.0, 21.0], -4.0))));
    assert_eq!(
        warnings,
        [
            "D1 (line 6) as the size of tool 1, no move goes more than 0.02 mm below the target; as its wear, 0, the tool gouges the target by 3.000 mm \
             in line 7: say by --diameters (in a job: diameters) which it is"
        ]
    );
    assert_eq!(notes, [""; 0]);
    // The contour is that of the tool's axis.
    let [warnings, notes] = said(&judged(PROGRAM, Some(slotted([12.0, 18.0], -4.0))));
    assert_eq!(
        warnings,
        [
            "D1 (line 6) as the size of tool 1, the tool gouges the target by 3.000 mm in line 7; as its wear, 0, no move goes more than 0.02 mm below \
             the target: say by --diameters (in a job: diameters) which it is"
        ]
    );
    assert_eq!(notes, [""; 0]);
}

#[test]
fn readings_that_agree_are_a_note() {
    let [warnings, notes] = said(&judged(PROGRAM, Some(slotted([11.0, 22.0], -4.0))));
    assert_eq!(warnings, [""; 0]);
    assert_eq!(
        notes,
        [
            "D1 (line 6) as the size of tool 1, no move goes more than 0.02 mm below the target; as its wear, 0, no move goes more than 0.02 mm below the target"
        ]
    );
    let [warnings, notes] = said(&judged(PROGRAM, Some(slotted([14.0, 20.0], -4.0))));
    assert_eq!(warnings, [""; 0]);
    assert_eq!(
        notes,
        [
            "D1 (line 6) as the size of tool 1, the tool gouges the target by 1.000 mm in line 7; as its wear, 0, the tool gouges the target by 2.000 mm in line 7"
        ]
    );
}

#[test]
fn what_was_not_compared_is_said() {
    let [warnings, notes] = said(&judged(PROGRAM, None));
    assert_eq!(warnings, [""; 0]);
    assert_eq!(
        notes,
        [
            "D1 (line 6) as the size of tool 1: that the tool cuts as deep if it is the tool's wear, 0, was not compared: there is no target"
        ]
    );
    // A wall that is no solid.
    let mut open = slotted([15.0, 21.0], -4.0);
    open.triangles.pop();
    let outcome = request(PROGRAM, Some(open)).plan().and_then(|plan| plan.run(&()));
    if let Ok(outcome) = outcome {
        let [_, notes] = said(&outcome);
        assert!(
            notes[0].contains("was not compared: the target is no solid"),
            "{notes:?}"
        );
    }
}

#[test]
fn a_register_that_is_said_is_not_compared() {
    let target = || Some(slotted([15.0, 21.0], -4.0));
    let known = PROGRAM.replace("G41 D1", "G10 L12 P1 R3 (as the job says)\nG41 D1");
    let outcome = judged(&known, target());
    assert!(
        outcome
            .report()
            .warnings
            .iter()
            .all(|warning| !warning.contains("wear"))
    );
    assert_eq!(said(&outcome), [vec![], Vec::<String>::new()]);
    // Where moves are the same in both readings, nothing is to be compared.
    let none = PROGRAM.replace("G41 D1 G1", "G1");
    assert_eq!(said(&judged(&none, target())), [vec![], Vec::<String>::new()]);
}
