//! The meaning of programs, word by word.

use sweepsim_nc::gcode::read;
use sweepsim_nc::{Machine, Program, ReadOptions, RotaryTable};

fn program(text: &str) -> Program {
    read(text, &ReadOptions::default()).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

/// Whatever the program leaves to the control is an error.
fn strict() -> ReadOptions {
    let mut options = ReadOptions::default();
    options.strict = true;
    options
}

fn error(text: &str) -> String {
    read(text, &strict()).expect_err(text).to_string()
}

fn tips(text: &str) -> Vec<[f64; 3]> {
    program(text).poses.iter().map(|pose| pose.pose.tip()).collect()
}

#[test]
fn modes() {
    assert_eq!(
        tips("G21 G90\nG0 X1 Y2 Z3\nG1 X4\nG91 Y1 Z-1\nX1\nG90 X0"),
        [
            [1.0, 2.0, 3.0],
            [4.0, 2.0, 3.0],
            [4.0, 3.0, 2.0],
            [5.0, 3.0, 2.0],
            [0.0, 3.0, 2.0]
        ]
    );
    assert_eq!(tips("G20 G0 X1 Y0 Z0\nG21 X1"), [[25.4, 0.0, 0.0], [1.0, 0.0, 0.0]]);
    // No pose twice, and no move of words that only look like one.
    assert_eq!(
        tips("G0 X0 Y0 Z0\nG1 X0 F10\nG4 P2\nM3 S100\nN7 X1\n(X2)\n;X3").len(),
        2
    );
    let rapid: Vec<bool> = program("g0x0y0z0\ng1x1\nx2\ng0x3")
        .poses
        .iter()
        .map(|pose| pose.rapid)
        .collect();
    assert_eq!(rapid, [true, false, false, true]);
}

#[test]
fn ends() {
    assert_eq!(tips("%\nO0001\nG0 X0 Y0 Z0\n%\nG0 X9").len(), 1);
    assert_eq!(tips("G0 X0 Y0 Z0\nM30\nG5 X9").len(), 1);
    assert_eq!(
        tips("G0 X0 Y0 Z0\nG1 X1 M2\nX9").len(),
        2,
        "the move before the end counts"
    );
}

#[test]
fn beginnings() {
    // Rapid moves before all coordinates are known lead nowhere; a cutting move takes the rest as 0.
    assert_eq!(tips("G0 Z5\nX1 Y2\nG1 Z-1"), [[1.0, 2.0, 5.0], [1.0, 2.0, -1.0]]);
    let found = program("G0 Z5\nG1 Z-1");
    assert_eq!(found.poses.len(), 2);
    assert!(found.poses[0].rapid && found.notes.iter().any(|note| note.message.contains("X is not known")));
    assert!(error("G90 G21\nM3\n").starts_with("2:1: this program has no move"));
    assert!(error("").contains("no move"));
    assert!(error("X1 Y1 Z1").contains("1:1: X without a motion code"));
}

#[test]
fn breaks() {
    let found = program("T1 M6\nG0 X0 Y0 Z5\nG1 Z0\nG53 G0 Z0\nT2 M6\nG0 X9 Y9\nZ5\nG1 Z0");
    let sections: Vec<usize> = found.sections().map(<[_]>::len).collect();
    assert_eq!(sections, [2, 2]);
    assert_eq!(found.poses[2].pose.tip(), [9.0, 9.0, 5.0]);
    let tools: Vec<Option<u32>> = found.poses.iter().map(|pose| pose.tool).collect();
    assert_eq!(tools, [Some(1), Some(1), Some(2), Some(2)]);
    // After a change without a move, cutting goes on from where the machine stands.
    let found = program("T1 M6\nG0 X0 Y0 Z5\nG1 Z0\nT2 M6\nG1 X1");
    assert_eq!(found.sections().map(<[_]>::len).collect::<Vec<_>>(), [2, 2]);
    let found = program("G0 X0 Y0 Z5\nG1 Z0\nG91 G28 Z0\nG90 G0 X1 Y1 Z5\nG1 Z0");
    assert_eq!(found.sections().map(<[_]>::len).collect::<Vec<_>>(), [2, 2]);
}

#[test]
fn work_offsets() {
    assert_eq!(
        tips("G10 L2 P1 X10\nG54 G0 X0 Y0 Z0\nG52 Y1\nX1"),
        [[10.0, 0.0, 0.0], [11.0, 0.0, 0.0]]
    );
    assert_eq!(
        tips("G0 X5 Y0 Z0\nG92 X0\nG1 X1\nG92.1\nX1"),
        [[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [1.0, 0.0, 0.0]]
    );
    assert_eq!(
        tips("G10 L2 P1\nG10 L2 P2 X10\nG0 X5 Y0 Z0\nG55 X0"),
        [[5.0, 0.0, 0.0], [10.0, 0.0, 0.0]]
    );
    assert!(error("G54 G0 X0 Y0 Z0\nG55 X1").contains("2:1: a move in G55"));
    assert!(error("G0 X0 Y0 Z0\nG28\nG92 X0").contains("not known yet"));
}

#[test]
fn arcs() {
    let quarter = program("G0 X10 Y0 Z0\nG17 G3 X0 Y10 I-10 J0");
    for pose in &quarter.poses {
        let [x, y, z] = pose.pose.tip();
        assert!((x.hypot(y).hypot(z) - 10.0).abs() < 1e-12);
    }
    assert_eq!(quarter.poses.last().unwrap().pose.tip(), [0.0, 10.0, 0.0]);
    assert!(
        quarter.poses.iter().all(|pose| pose.pose.tip()[0] >= 0.0),
        "the short way round"
    );
    // The same by radius, in incremental words, with absolute centres; and the helix down.
    let same = |text: &str| assert_eq!(tips(text).len(), quarter.poses.len(), "{text}");
    same("G0 X10 Y0 Z0\nG3 X0 Y10 R10");
    same("G0 X10 Y0 Z0\nG91 G3 X-10 Y10 R10");
    same("G0 X10 Y0 Z0\nG90.1 G3 X0 Y10 I0 J0");
    let helix = tips("G0 X10 Y0 Z0\nG2 X10 Y0 Z-4 I-10 P2");
    let middle = helix[helix.len() / 2];
    assert!(
        (middle[2] + 2.0).abs() < 0.01 && (middle[0] - 10.0).abs() < 0.01,
        "{middle:?}"
    );
    // G18 turns from Z to X: counter-clockwise from +Z leads to +X.
    let zx = tips("G0 X0 Y0 Z1\nG18 G3 X1 Z0 I0 K-1");
    assert!(zx.iter().all(|p| p[0] >= 0.0 && p[2] >= -1e-15 && p[1] == 0.0));
    let yz = tips("G0 X0 Y1 Z0\nG19 G3 Y0 Z1 J-1 K0");
    assert!(yz.iter().all(|p| p[1] >= 0.0 && p[2] >= 0.0));
    assert!(error("G0 X0 Y0 Z0\nG2 X1").contains("no centre"));
    assert!(error("G0 X0 Y0 Z0\nG2 X1 R0.1").contains("too small"));
    assert!(error("G0 X0 Y0 Z0\nG2 X1 I5").contains("two radii"));
    assert!(error("G0 X0 Y0 Z0\nG2 X1 I.5 K1").contains("K is 1 mm, but Z does not change"));
    assert!(error("G0 X0 Y0 Z0\nG1 X1 I.5").contains("outside an arc"));
}

#[test]
fn rotary_axes() {
    let axes = |text: &str| -> Vec<[f64; 3]> { program(text).poses.iter().map(|pose| pose.pose.axis()).collect() };
    assert_eq!(axes("M428\nG0 X0 Y0 Z0 A90 C90"), [[1.0, 0.0, 0.0]]);
    assert_eq!(axes("G43.4 H1\nG0 X0 Y0 Z0 B90"), [[-1.0, 0.0, 0.0]]);
    // Half a turn of the table with the tool lying: over the way that the table goes.
    let half = axes("M428\nG0 X0 Y0 Z0 A90 C0\nG1 C180");
    assert_eq!(half, [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]);
    assert_eq!(axes("M428\nG0 X0 Y0 Z0 C0\nG1 C180").len(), 1, "the axis stands still");
    assert!(error("G0 X0 Y0 Z0 A10").contains("1:1: a move with the rotary axes turned is without tip control"));
    assert!(error("M428\nG0 X0 Y0 Z0 A10 B10").contains("both A and B"));
    assert!(
        error("M428\nG0 X0 Y0 Z0 A10\nA0 B10").contains("3:1: the rotary word is B, but must be A or C, as before")
    );
    assert!(error("M428\nG0 X0 Y0 Z0\nM429\nG1 A5").contains("4:1: "));
    assert!(error("M428\nG0 X0 Y0 Z0 A5\nG1 C1e9").contains("E words"));
    assert!(error("M428\nG0 X0 Y0 Z0 A5\nG1 C100000000000").contains("turn"));
    let mut options = ReadOptions::default();
    options.machine = Machine::with_table(RotaryTable::Bc).tip_control(true);
    assert!(read("G0 X0 Y0 Z0 B5 C7", &options).is_ok());
    assert!(
        read("G0 X0 Y0 Z0 A5", &options)
            .unwrap_err()
            .to_string()
            .contains("given as B/C")
    );
}

#[test]
fn what_is_not_understood_is_said() {
    let found = program("G0 X0 Y0 Z0\nM777\nM777 X1\n/X2\n");
    let notes: Vec<String> = found.notes.iter().map(ToString::to_string).collect();
    assert_eq!(
        notes,
        [
            "line 2: M777 is not understood: ignored (2 times, first here)",
            "line 4: optional blocks (`/`) are executed"
        ]
    );
    for (text, expected) in [
        (
            "G0 X0 Y0 Z0\nG1 X1 G41 D1",
            "2:7: the diameter D1 for cutter compensation",
        ),
        (
            "G87 X0 Y0 Z-2 R5",
            "1:1: back boring with a shift by Q is not supported",
        ),
        ("G0 X0 Y0 Z0\nG68.2 P4 I45", "2:1: tilted planes by projection angles"),
        ("G0 X#1", "1:5: #1 has no value here"),
        ("M98 P1000", "1:1: the subprogram O1000 is missing"),
        ("G0 X0 Y0 Z0\nG2000 X1", "2:1: G2000"),
        ("G0 X0 Y0 Z0\nG0 U1", "2:4: the axis U"),
        ("G0 X0 Y0 Z0 X1", "1:13: a second X"),
        ("G0 G1 X0", "1:4: a second motion code"),
        ("G0 X0 (open", "1:7: this comment is not closed"),
        ("N10 DEF REAL x", "1:5: statements like `DEF`"),
    ] {
        let found = error(text);
        assert!(found.starts_with(expected), "{text}: {found}");
    }
}
