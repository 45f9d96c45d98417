//! Cycles against their expansion by hand.

use sweepsim_nc::{Controller, EventKind, Program, ReadOptions, gcode};

use super::{assert_near, options, program, program_with, tips};

/// The tips and rapids of a program.
fn moves(program: &Program) -> Vec<([f64; 3], bool)> {
    program.poses.iter().map(|pose| (pose.pose.tip(), pose.rapid)).collect()
}

/// Two programs make the same moves.
#[track_caller]
fn same(cycle: &str, by_hand: &str) {
    let (found, expected) = (program(cycle), program(by_hand));
    assert_near(&tips(&found), &tips(&expected));
    let rapids = |program: &Program| -> Vec<bool> { moves(program).iter().map(|(_, rapid)| *rapid).collect() };
    assert_eq!(rapids(&found), rapids(&expected), "{cycle}");
}

const START: &str = "G90 G17 F100\nG0 X0 Y0 Z10\n";

#[test]
fn drilling() {
    same(
        &format!("{START}G98 G81 X5 Y6 Z-3 R2\nX7\nG80\nG0 X0"),
        &format!("{START}G0 X5 Y6\nZ2\nG1 Z-3\nG0 Z10\nX7\nZ2\nG1 Z-3\nG0 Z10\nX0"),
    );
    same(
        &format!("{START}G99 G82 X5 Y6 Z-3 R2 P0.5\nX7\nG80\nG0 X0"),
        &format!("{START}G0 X5 Y6\nZ2\nG1 Z-3\nG0 Z2\nX7\nG1 Z-3\nG0 Z2\nX0"),
    );
    // Pecks: 2, 0, -2, -3.
    same(
        &format!("{START}G99 G83 X5 Y6 Z-3 R2 Q2"),
        &format!("{START}G0 X5 Y6\nZ2\nG1 Z0\nG0 Z2\nZ0.254\nG1 Z-2\nG0 Z2\nZ-1.746\nG1 Z-3\nG0 Z2"),
    );
    same(
        &format!("{START}G98 G73 X5 Y6 Z-3 R2 Q2"),
        &format!("{START}G0 X5 Y6\nZ2\nG1 Z0\nG0 Z0.254\nG1 Z-2\nG0 Z-1.746\nG1 Z-3\nG0 Z10"),
    );
    same(
        &format!("{START}G99 G85 X5 Y6 Z-3 R2"),
        &format!("{START}G0 X5 Y6\nZ2\nG1 Z-3\nZ2"),
    );
    same(
        &format!("{START}G98 G84 X5 Y6 Z-3 R2"),
        &format!("{START}G0 X5 Y6\nZ2\nG1 Z-3\nZ2\nG0 Z10"),
    );
    same(
        &format!("{START}G98 G76 X5 Y6 Z-3 R2 I0.5 J0"),
        &format!("{START}G0 X5 Y6\nZ2\nG1 Z-3\nX5.5\nG0 Z10\nX5"),
    );
}

#[test]
fn repeats_steps_and_planes() {
    same(
        &format!("{START}G91 G99 G81 X5 Y6 Z-3 R-8 L3"),
        &format!("{START}G0 X5 Y6\nZ2\nG1 Z-1\nG0 Z2\nX10 Y12\nG1 Z-1\nG0 Z2\nX15 Y18\nG1 Z-1\nG0 Z2"),
    );
    same(
        &format!("{START}G98 G81 X5 Y6 Z-3 R2 L0\nX9 Y9"),
        &format!("{START}G0 X9 Y9\nZ2\nG1 Z-3\nG0 Z10"),
    );
    same(
        "G18 F100\nG0 X0 Y10 Z0\nG99 G81 X5 Z6 Y-3 R2",
        "G0 X0 Y10 Z0\nX5 Z6\nY2\nG1 Y-3 F100\nG0 Y2",
    );
    same(
        "G19 F100\nG0 X10 Y0 Z0\nG99 G81 Y5 Z6 X-3 R2",
        "G0 X10 Y0 Z0\nY5 Z6\nX2\nG1 X-3 F100\nG0 X2",
    );
    // From below the plane R, first up.
    same(
        "F100\nG0 X0 Y0 Z1\nG98 G81 X5 Z-3 R2",
        "F100\nG0 X0 Y0 Z1\nZ2\nX5\nG1 Z-3\nG0 Z2",
    );
    // In inches.
    same(
        "G20 F100\nG0 X0 Y0 Z1\nG99 G81 X5 Z-3 R0.5",
        "G20 F100\nG0 X0 Y0 Z1\nX5\nZ0.5\nG1 Z-3\nG0 Z0.5",
    );
    // Nothing is known of the height before: the cycle begins in its plane.
    assert_eq!(
        tips(&program("G81 X5 Y5 Z-3 R2 F100"))[..2],
        [[5.0, 5.0, 2.0], [5.0, 5.0, -3.0]]
    );
}

/// The bottoms of the holes that a control drills.
fn bottoms(text: &str, control: Controller) -> Vec<f64> {
    let found = program_with(text, &options(control));
    let bottoms = found.poses.iter().filter(|pose| !pose.rapid);
    bottoms.map(|pose| pose.pose.tip()[2]).collect()
}

#[test]
fn relative_heights() {
    // R and Z that were absolute stay so after G91, but on LinuxCNC.
    let row = "G90 F100.\nG0 X0. Y0. Z5.\nG98 G81 X1. Z-10. R2.\nG91 X1. K2\n";
    assert_eq!(bottoms(row, Controller::Fanuc), [-10.0; 3]);
    assert_eq!(bottoms(&row.replace('K', "L"), Controller::Haas), [-10.0; 3]);
    let row = row.replace('K', "L");
    assert_eq!(bottoms(&row, Controller::LinuxCnc), [-10.0, -3.0, -3.0]);
    // R is relative to the height from which the cycles began, not to the plane where the last one ended.
    let column = "G90 F100.\nG0 X0. Y0. Z10.\nG91 G99 G81 X1. Z-5. R-8.\nX1.\nX1.\n";
    assert_eq!(bottoms(column, Controller::Fanuc), [-3.0; 3]);
    assert_eq!(bottoms(column, Controller::LinuxCnc), [-3.0, -11.0, -19.0]);
    // A control that nothing tells may be either.
    let options = ReadOptions::default();
    for (text, assumed) in [(column, 1), (row.as_str(), 1), (column.trim_end_matches("X1.\n"), 0)] {
        let found = program_with(text, &options);
        assert_eq!(found.assumptions.len(), assumed, "{text}");
        assert!(found.assumptions.iter().all(|one| one.what.contains("heights R and Z")));
        let mut strict = options.clone();
        strict.strict = true;
        assert_eq!(gcode::read(text, &strict).is_err(), assumed > 0, "{text}");
    }
}

/// On Fanuc, the words of a cycle stay for the next one, until the cycles end.
#[test]
fn words_of_the_cycle_before() {
    let text = "G90 F100.\nG0 X0. Y0. Z10.\nG99 G81 X1. Z-5. R2.\nG83 X2. Q4.\nG82 X3. P100\n";
    assert_eq!(bottoms(text, Controller::Fanuc), [-5.0, -2.0, -5.0, -5.0]);
    for (text, control) in [
        (text.to_owned(), Controller::Haas),
        (text.replace("G83", "G80\nG83"), Controller::Fanuc),
        (text.replace("G83", "G0 Z9.\nG83"), Controller::Fanuc),
    ] {
        let error = gcode::read(&text, &options(control)).unwrap_err().to_string();
        assert!(error.contains("G83 without Z"), "{error}");
    }
}

#[test]
fn cycles_that_begin_below_their_plane() {
    let text = "G90 F100.\nG0 X0. Y0. Z-5.\nG98 G81 X10. Z-8. R2.\nX20.\n";
    let heights = |control: Option<Controller>| -> Vec<[f64; 3]> {
        let mut options = ReadOptions::default();
        options.controller = control;
        let found = program_with(text, &options);
        assert_eq!(found.assumptions.len(), usize::from(control.is_none()));
        tips(&found)
    };
    // Across through the material, as Fanuc does it.
    let level = |x: f64, z: f64| [x, 0.0, z];
    let across = [
        (0.0, -5.0),
        (10.0, -5.0),
        (10.0, 2.0),
        (10.0, -8.0),
        (10.0, -5.0),
        (20.0, -5.0),
    ];
    assert_near(
        &heights(Some(Controller::Fanuc))[..6],
        &across.map(|(x, z)| level(x, z)),
    );
    let up = [
        (0.0, -5.0),
        (0.0, 2.0),
        (10.0, 2.0),
        (10.0, -8.0),
        (10.0, 2.0),
        (20.0, 2.0),
    ];
    for control in [None, Some(Controller::LinuxCnc)] {
        assert_near(&heights(control)[..6], &up.map(|(x, z)| level(x, z)));
    }
}

#[test]
fn what_cycles_do_besides() {
    let found = program("S100 M3 F100\nG0 X0 Y0 Z10\nG84 X5 Z-3 R2 P1");
    let kinds: Vec<String> = found
        .events
        .iter()
        .map(|event| format!("{} {:?}", event.pose, event.kind))
        .collect();
    assert_eq!(
        kinds,
        [
            "0 Spindle(Clockwise { rpm: Some(100.0) })",
            "4 Spindle(Stopped)",
            "4 Spindle(CounterClockwise { rpm: Some(100.0) })",
            "4 Dwell { seconds: 1.0 }",
            "5 Spindle(Stopped)",
            "5 Spindle(Clockwise { rpm: Some(100.0) })",
        ]
    );
    // Fanuc counts milliseconds, and repeats by K.
    let fanuc = options(Controller::Fanuc);
    let found = program_with("F100\nG0 X0 Y0 Z10.\nG91 G82 X5. Z-3. R-8. P500 K2", &fanuc);
    assert!(
        found
            .events
            .iter()
            .any(|event| event.kind == EventKind::Dwell { seconds: 0.5 })
    );
    assert_eq!(found.poses.iter().filter(|pose| !pose.rapid).count(), 2);
    // With a decimal point, they are seconds.
    let found = program_with("F100.\nG0 X0. Y0. Z10.\nG82 X5. Z-3. R8. P1.5", &fanuc);
    assert_eq!(found.events[0].kind, EventKind::Dwell { seconds: 1.5 });
    // All moves of a cycle keep its line.
    assert!(found.poses[1..].iter().all(|pose| pose.line == 3));
}
