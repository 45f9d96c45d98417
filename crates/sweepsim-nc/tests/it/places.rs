//! Where programs go by the machine's own coordinates: homes, machine coordinates and changes of tools.

use sweepsim_nc::{Machine, Program, ReadOptions, gcode, heidenhain, siemens};

const MACHINE: &str = r#"Machine(
    name: "mill", part_zero: (0, 0, -400), tool_lengths: {1: 100, 2: 80},
    linear: [
        (letter: 'X', home: 0), (letter: 'Y', home: 10),
        (letter: 'Z', limits: (-500, 0), home: 0, second_home: -50),
    ],
    table: [(letter: 'C', axis: (0, 0, 1), home: 5)],
    tool_change: [{'Z': 0}, {'X': -200, 'Y': 50}],
)"#;

fn options(machine: &str) -> ReadOptions {
    let mut options = ReadOptions::default();
    options.machine = Machine::read(machine).unwrap();
    options
}

fn read(machine: &str, text: &str) -> Program {
    gcode::read(text, &options(machine)).unwrap()
}

fn row(line: usize, joined: bool, tool: u32, at: [f64; 4], fixed: &str) -> (usize, bool, u32, [f64; 4], String) {
    (line, joined, tool, at, fixed.to_owned())
}

/// Lines whose feed moves there are, and lines whose places are left out.
fn feeds_and_gaps(program: &Program) -> [Vec<usize>; 2] {
    let feeds = program.poses.iter().filter(|pose| !pose.rapid);
    let gaps = program
        .notes
        .iter()
        .filter(|note| note.message.contains("are left out"));
    [
        feeds.map(|pose| pose.line).collect(),
        gaps.map(|note| note.line).collect(),
    ]
}

/// Each pose: its line, whether it goes on, tool, X, Y, Z, C, and the axes that the machine's coordinates give.
fn course(program: &Program) -> Vec<(usize, bool, u32, [f64; 4], String)> {
    let poses = program.poses.in_order().zip(program.positions.in_order());
    let row = |(pose, at): (sweepsim_nc::ProgramPose, sweepsim_nc::Position)| {
        let [x, y, z] = at.xyz;
        let rounded = [x, y, z, at.abc[2]].map(|c| (c * 1e6).round() / 1e6);
        let fixed = ['X', 'Y', 'Z'].into_iter().zip(pose.fixed);
        let fixed = fixed.filter(|(_, fixed)| *fixed).map(|(letter, _)| letter).collect();
        (pose.line, pose.joined, pose.tool.unwrap_or(0), rounded, fixed)
    };
    poses.map(row).collect()
}

#[test]
fn the_course_goes_on_over_places_of_the_machine() {
    let text = "G21 G90\nT1 M6\nG0 X10 Y20\nG43 Z5 H1\nG1 Z-1 F100\nG91 G28 Z0\nG90\nT2 M6\nG0 X0 Y0 C90\nG53 G0 Z-100\nG30 Z200\nG28\nM30\n";
    // The nose at Z 0 has the tip of tool 1 at 300, that of tool 2 at 320.
    let expected = [
        row(3, false, 1, [-200.0, 50.0, 300.0, 5.0], "XYZ"),
        row(3, true, 1, [10.0, 20.0, 300.0, 5.0], "Z"),
        row(4, true, 1, [10.0, 20.0, 5.0, 5.0], ""),
        row(5, true, 1, [10.0, 20.0, -1.0, 5.0], ""),
        row(6, true, 1, [10.0, 20.0, 300.0, 5.0], "Z"),
        row(8, true, 1, [-200.0, 50.0, 300.0, 5.0], "XYZ"),
        row(9, false, 2, [-200.0, 50.0, 320.0, 5.0], "XYZ"),
        row(9, true, 2, [0.0, 0.0, 320.0, 90.0], "Z"),
        row(10, true, 2, [0.0, 0.0, 220.0, 90.0], "Z"),
        row(11, true, 2, [0.0, 0.0, 200.0, 90.0], ""),
        row(11, true, 2, [0.0, 0.0, 270.0, 90.0], "Z"),
        row(12, true, 2, [0.0, 10.0, 320.0, 5.0], "XYZ"),
    ];
    let program = read(MACHINE, text);
    // But for the chords of turns.
    let rows: Vec<_> = course(&program)
        .into_iter()
        .filter(|row| [5.0, 90.0].contains(&row.3[3]))
        .collect();
    assert_eq!(rows, expected);
    // All of these are rapids, but for the one feed move.
    let feeds: Vec<usize> = program
        .poses
        .iter()
        .filter(|pose| !pose.rapid)
        .map(|pose| pose.line)
        .collect();
    assert_eq!(feeds, [5]);
    assert!(
        !program
            .notes
            .iter()
            .any(|note| note.message.contains("the path breaks"))
    );
}

#[test]
fn axes_go_to_places_themselves_whatever_the_coordinates_are() {
    // A tilted plane, and tip control: the tip stays where the plane or the part is, the nose goes to the machine's place.
    for (before, after) in [
        ("G68.2 X0 Y0 Z0 I90 J0 K0\nG0 X10 Y20 Z30", "G69"),
        ("M428\nG0 X10 Y20 Z30 C90", "M429"),
    ] {
        let program = read(
            MACHINE,
            &format!("T1 M6\n{before}\nG53 G0 Z-20\nG1 X11 F100\n{after}\nM30\n"),
        );
        let rows = course(&program);
        let at = rows
            .iter()
            .position(|row| row.4.contains('Z') && row.0 == 4)
            .expect("the place");
        assert!((rows[at].3[2] - 280.0).abs() < 1e-9, "{rows:?}");
        assert_eq!((rows[at].3[0], rows[at].3[1]), (rows[at - 1].3[0], rows[at - 1].3[1]));
        assert!(rows.iter().skip(1).all(|row| row.1), "nothing breaks: {rows:?}");
    }
}

#[test]
fn what_the_machine_does_not_say_is_said() {
    let without = MACHINE.replace("    tool_change: [{'Z': 0}, {'X': -200, 'Y': 50}],\n", "");
    let program = read(
        &without,
        "T1 M6\nG0 X10 Y20 Z5\nG1 Z-1 F100\nT2 M6\nG0 X0\nT1 M6\nG0 X1\nM30\n",
    );
    let unknown: Vec<_> = program
        .notes
        .iter()
        .filter(|note| note.message.contains("where tools are changed is not known"))
        .collect();
    assert_eq!((unknown.len(), unknown[0].line), (1, 4), "{:?}", program.notes);
    // No home of X: the way there is left out.
    let without = MACHINE.replace("(letter: 'X', home: 0), ", "");
    let program = read(&without, "T1 M6\nG0 X10 Y20 Z5\nG28 X0\nG0 X0 Y0 Z5\nM30\n");
    assert!(
        program
            .notes
            .iter()
            .any(|note| note.line == 3 && note.message.contains("home are left out"))
    );
    // G92 at the start says where the part is; the machine's place of it is not known.
    let program = read(MACHINE, "T1\nG92 X0 Y0 Z0\nG1 X10 F100\nM30\n");
    assert_eq!(course(&program)[0].3[..3], [0.0, 0.0, 0.0]);
}

#[test]
fn places_are_of_axes_and_within_limits() {
    for (from, to, what) in [
        ("home: 5)", "home: 5, limits: (10, 20))", "the home of C"),
        ("second_home: -50", "second_home: -501", "the second_home of Z"),
        ("{'Z': 0}", "{'Z': 1}", "Z in tool_change"),
        ("{'Z': 0}", "{'B': 1}", "an axis in tool_change"),
    ] {
        assert!(MACHINE.contains(from));
        let error = Machine::read(&MACHINE.replace(from, to)).unwrap_err().to_string();
        assert!(error.contains(what), "{error}");
    }
}

#[test]
fn siemens_programs_go_to_places_of_the_machine() {
    let text = "T1 M6\nG54 G0 X10 Y20 Z5 D1\nSUPA G0 Z-20 D0\nSUPA X-100 Y=IC(5)\nD1\nG153 G1 Z-150 F500\nG0 X10 Y20 Z5\nG74 X1=0 Z1=0\n\
        G75 Z1=0\nG53 G0 X0 C90\nG75 FP=2 Z1=0\nSUPA G2 X5 Y5 CR=9\nM30\n";
    let program = siemens::read(text, &options(MACHINE)).unwrap();
    let rows: Vec<_> = course(&program)
        .into_iter()
        .filter(|row| [5.0, 90.0].contains(&row.3[3]))
        .collect();
    let expected = [
        row(2, false, 1, [-200.0, 50.0, 300.0, 5.0], "XYZ"),
        row(2, true, 1, [10.0, 20.0, 5.0, 5.0], ""),
        // Without its length, of the nose: 400 - 100 mm above the part's zero.
        row(3, true, 1, [10.0, 20.0, 280.0, 5.0], "Z"),
        row(4, true, 1, [-100.0, 25.0, 280.0, 5.0], "XYZ"),
        // With its length, of the tip.
        row(6, true, 1, [-100.0, 25.0, 250.0, 5.0], "XYZ"),
        row(7, true, 1, [10.0, 20.0, 5.0, 5.0], ""),
        row(8, true, 1, [0.0, 20.0, 300.0, 5.0], "XZ"),
        row(9, true, 1, [0.0, 20.0, 250.0, 5.0], "XZ"),
        row(10, true, 1, [0.0, 20.0, 250.0, 90.0], "XZ"),
    ];
    assert_eq!(rows, expected);
    assert_eq!(feeds_and_gaps(&program), [vec![6], vec![11, 12]]);
    // A machine that does not say its places: they are left out, as without a machine.
    let bare = "Machine(name: \"mill\", table: [(letter: 'C', axis: (0, 0, 1))])";
    for options in [options(bare), ReadOptions::default()] {
        let program = siemens::read(&text.replace(" C90", ""), &options).unwrap();
        assert_eq!(feeds_and_gaps(&program)[1], [3, 8], "{:?}", program.notes);
    }
    // Under tip control a tool that leans has its length along itself: which place that is, is not looked at.
    let tilting = MACHINE.replace("home: 5)]", "home: 5), (letter: 'B', axis: (0, 1, 0), home: 0)]");
    let leaning = |length: &str| {
        let text = format!("T1 M6\nG54 G0 X0 Y0 Z50 D1\nTRAORI\nG1 X9 B30 F500\nSUPA G0 Z-20{length}\nM30\n");
        feeds_and_gaps(&siemens::read(&text, &options(&tilting)).unwrap())[1].clone()
    };
    assert_eq!([leaning(""), leaning(" D0")], [vec![5], vec![]]);
}

#[test]
fn klartext_goes_to_places_of_the_machine() {
    let text = "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nL X+10 Y+20 Z+5 R0 FMAX\nL Z-20 R0 FMAX M91\nL X-100 IY+5 R0 F500 M91\nL C+90 FMAX M91\n\
        L X+10 Y+20 Z+5 R0 FMAX\nL Z+0 R0 FMAX M92\nEND PGM A MM\n";
    let program = heidenhain::read(text, &options(MACHINE)).unwrap();
    let rows: Vec<_> = course(&program)
        .into_iter()
        .filter(|row| [5.0, 90.0].contains(&row.3[3]))
        .collect();
    let expected = [
        row(3, false, 1, [-200.0, 50.0, 300.0, 5.0], "XYZ"),
        row(3, true, 1, [10.0, 20.0, 5.0, 5.0], ""),
        row(4, true, 1, [10.0, 20.0, 280.0, 5.0], "Z"),
        row(5, true, 1, [-100.0, 25.0, 280.0, 5.0], "XYZ"),
        row(6, true, 1, [-100.0, 25.0, 280.0, 90.0], "XYZ"),
        row(7, true, 1, [10.0, 20.0, 5.0, 90.0], ""),
    ];
    assert_eq!(rows, expected);
    assert_eq!(feeds_and_gaps(&program), [vec![5], vec![8]]);
    let text = text.replace("L C+90 FMAX M91\n", "");
    let program = heidenhain::read(&text, &ReadOptions::default()).unwrap();
    assert_eq!(feeds_and_gaps(&program)[1], [4], "{:?}", program.notes);
}
