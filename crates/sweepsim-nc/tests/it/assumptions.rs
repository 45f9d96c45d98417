//! What programs leave to the control or to the operator: taken as said, and refused by strict readers.

use sweepsim_nc::{Assumption, Controller, Program, ReadOptions, gcode, heidenhain, siemens};

use crate::found::tips;

fn read_with(text: &str, change: impl FnOnce(&mut ReadOptions)) -> Program {
    let mut options = ReadOptions::default();
    change(&mut options);
    gcode::read(text, &options).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn read(text: &str) -> Program {
    read_with(text, |_| {})
}

fn strict(text: &str) -> String {
    let mut options = ReadOptions::default();
    options.strict = true;
    gcode::read(text, &options).expect_err(text).to_string()
}

/// The one assumption of a program, which is a note of the same words too.
#[track_caller]
fn only(program: &Program) -> &Assumption {
    let [assumption] = &program.assumptions[..] else {
        panic!("{:?}", program.assumptions)
    };
    let said = assumption.to_string();
    assert!(
        program
            .notes
            .iter()
            .any(|note| note.message == said && note.line == assumption.line),
        "{said}"
    );
    assumption
}

#[test]
fn parking_in_another_offset() {
    let text = "G54 G0 X0 Y0 Z5\nG1 Z-1 F100\nX20\nG0 Z5\nG91 G28 Z0\nG90 G58 X12 Y20\nM30";
    let program = read(text);
    assert_eq!(
        tips(&program),
        [[0.0, 0.0, 5.0], [0.0, 0.0, -1.0], [20.0, 0.0, -1.0], [20.0, 0.0, 5.0]]
    );
    let parking = only(&program);
    assert_eq!(
        (parking.what.as_str(), parking.line, parking.changes_verdict),
        ("the place of G58", 6, false)
    );
    assert!(parking.settle.contains("--offset G58=X,Y,Z"));
    assert!(strict(text).contains("6:1: a move in G58, which the program does not set, after a move in G54"));
}

#[test]
fn a_set_up_of_its_own_is_left_out() {
    let cuts = "G54 G0 X0 Y0 Z5\nG1 Z-1 F100\nX20\nG0 Z5\nG55 G0 X0 Y0 Z5\nG1 Z-1\nX20\nG0 Z5\nG54 G0 X1 Y2 Z5\nG1 Z0";
    let program = read(cuts);
    let all = tips(&program);
    assert_eq!(
        all[..4],
        [[0.0, 0.0, 5.0], [0.0, 0.0, -1.0], [20.0, 0.0, -1.0], [20.0, 0.0, 5.0]]
    );
    assert_eq!(all[4..], [[1.0, 2.0, 5.0], [1.0, 2.0, 0.0]]);
    assert!(
        !program.poses[4].joined,
        "the tool came from where only the machine knows"
    );
    let second = only(&program);
    assert_eq!((second.line, second.changes_verdict), (5, true));
    assert!(second.taken.contains("2 feed moves"), "{}", second.taken);
    // Once it is said where it is, it is cut there.
    let placed = read_with(cuts, |options| {
        options.offsets.insert("G55".into(), [100.0, 10.0, 1.0]);
    });
    assert!(placed.assumptions.is_empty() && placed.poses.iter().skip(1).all(|pose| pose.joined));
    assert_eq!(tips(&placed)[6], [120.0, 10.0, 0.0]);
}

/// Only where the program sets its work offset are poses in machine coordinates.
#[test]
fn what_is_said_of_work_offsets() {
    let said = |program: &Program| -> Vec<String> {
        let notes = program.notes.iter().filter(|note| note.message.contains("work offset"));
        // Without how often it is so.
        notes
            .map(|note| note.message.split(" (").next().unwrap_or_default().to_owned())
            .collect()
    };
    let moves = "G0 X0 Y0 Z5\nG1 Z-1 F100\n";
    let set = read(&format!("G10 L2 P1 X10\n{moves}"));
    assert_eq!(
        said(&set),
        ["work offsets set by the program are applied: poses are in machine coordinates"]
    );
    let local = read(&format!("G54 G52 X10\n{moves}"));
    assert_eq!(said(&local), ["work offsets set by the program are applied"]);
    let given = read_with(&format!("G54 {moves}G55 {moves}"), |options| {
        options.offsets.insert("G55".into(), [100.0, 10.0, 1.0]);
    });
    assert_eq!(said(&given), ["the place that is given for the work offset is applied"]);
    assert_eq!(tips(&given)[2], [100.0, 10.0, 6.0]);
}

#[test]
fn an_axis_that_has_not_moved_elsewhere_is_where_it_was() {
    // Only X moves in G58: Y and Z are those of G54 still. X has to be given again.
    let text = "G54 G0 X1 Y2 Z5\nG58 X50\nG54 X3\nG1 Z-1 F100\n";
    assert_eq!(tips(&read(text)), [[1.0, 2.0, 5.0], [3.0, 2.0, 5.0], [3.0, 2.0, -1.0]]);
    // Without X, the move is left out, and said to be.
    let lost = read("G54 G0 X1 Y2 Z5\nG58 X50\nG54 G1 Z-1 F100\nX3\nZ-2\n");
    assert_eq!(tips(&lost), [[1.0, 2.0, 5.0], [3.0, 2.0, -1.0], [3.0, 2.0, -2.0]]);
    assert!(lost.assumptions[0].what.starts_with("X after") && lost.assumptions[0].changes_verdict);
}

#[test]
fn machine_coordinates_where_the_program_sets_its_offset() {
    let set = "G10 L2 P1 X10 Y10 Z10\nG54 G0 X0 Y0 Z0\n";
    let last = |text: &str| *tips(&read(&format!("{set}{text}"))).last().unwrap();
    assert_eq!(last("G53 G0 Z0\nG1 X5 F100\n"), [15.0, 10.0, 0.0]);
    assert_eq!(last("G53 G0 X1 Y2 Z3\n"), [1.0, 2.0, 3.0]);
    // Home is taken as the zero of the machine.
    let home = read(&format!("{set}G91 G28 Z0\nG90 G1 X5 F100\n"));
    assert_eq!(*tips(&home).last().unwrap(), [15.0, 10.0, 0.0]);
    assert!(only(&home).what.contains("G28") && only(&home).line == 3);
    // Where nothing sets the offset, the height after G53 is not known: nothing is cut at Z 0 by guess.
    let unknown = read("G54 G0 X0 Y0 Z5\nG1 Z-1 F100\nG53 G0 Z0\nG1 X5\nX6 Z2\n");
    assert_eq!(tips(&unknown), [[0.0, 0.0, 5.0], [0.0, 0.0, -1.0], [6.0, 0.0, 2.0]]);
    assert!(only(&unknown).what.starts_with("Z after") && only(&unknown).line == 4);
}

#[test]
fn offsets_of_siemens_and_heidenhain() {
    let options = ReadOptions::default();
    let program = siemens::read(
        "G54 G0 X0 Y0 Z5\nG1 Z-1 F100\nG57 G0 X100 Y100\nG54 G0 X1 Y1\nG1 Z-2\n",
        &options,
    )
    .unwrap();
    assert_eq!(
        tips(&program),
        [[0.0, 0.0, 5.0], [0.0, 0.0, -1.0], [1.0, 1.0, -1.0], [1.0, 1.0, -2.0]]
    );
    assert_eq!(
        (only(&program).what.as_str(), only(&program).line),
        ("the place of G57", 3)
    );
    let text =
        "CYCL DEF 247 Q339=+1\nL X+0 Y+0 Z+5 FMAX\nL Z-1 F100\nCYCL DEF 247 Q339=+2\nL X+9 Y+9 Z+9 FMAX\nL Z-1 F100\n";
    let program = heidenhain::read(text, &options).unwrap();
    assert_eq!(tips(&program), [[0.0, 0.0, 5.0], [0.0, 0.0, -1.0]]);
    assert!(only(&program).what == "the place of preset 2" && only(&program).changes_verdict);
    let mut given = ReadOptions::default();
    given.offsets.insert("preset2".into(), [100.0, 0.0, 0.0]);
    given.offsets.insert("G57".into(), [100.0, 0.0, 0.0]);
    assert_eq!(
        *tips(&heidenhain::read(text, &given).unwrap()).last().unwrap(),
        [109.0, 9.0, -1.0]
    );
    let moved = siemens::read("G54 G0 X0 Y0 Z5\nG57 G1 X1 F100\n", &given).unwrap();
    assert_eq!(*tips(&moved).last().unwrap(), [101.0, 0.0, 5.0]);
}

/// Around the outside of a square of 20 mm.
const AROUND: &str = "G0 X-20 Y0 Z0\nG41 D3 G1 X0 Y0 F100\nY20\nX20\nY0\nX0\nG40 X-20\nM30\n";

#[test]
fn a_register_is_the_size_of_the_tool() {
    let text = format!("G21\n(T3 D=6. CR=0. - flat end mill)\nT3 M6\n{AROUND}");
    let program = read(&text);
    // The left side of the square, 3 mm beside it.
    assert!(tips(&program).iter().any(|tip| (tip[0] + 3.0).abs() < 1e-9));
    let assumed = only(&program);
    assert_eq!(
        (assumed.what.as_str(), assumed.line, assumed.changes_verdict),
        ("D3", 5, true)
    );
    assert!(assumed.taken.contains("tool 3, 6 across") && assumed.settle.contains("--diameters D3="));
    assert!(strict(&text).contains("the diameter D3"));
    // Said, it is no assumption; in the program's unit if asked for.
    let said = read_with(&text, |options| {
        options.diameters.insert(3, 8.0);
    });
    assert!(said.assumptions.is_empty() && tips(&said).iter().any(|tip| (tip[0] + 4.0).abs() < 1e-9));
    // Of a tool whose size nobody says, it is 0: the tool's axis goes along the square.
    let unknown = read(&format!("T3 M6\n{AROUND}"));
    assert!(tips(&unknown).contains(&[0.0, 20.0, 0.0]) && only(&unknown).changes_verdict);
    assert!(
        only(&unknown)
            .taken
            .starts_with("0, since the size of tool 3 is not known")
    );
    assert!(strict(&format!("T3 M6\n{AROUND}")).contains("the diameter D3"));
    // As wear, it is 0 whatever the tool is.
    let wear = read_with(&text, |options| options.wear_registers = true);
    assert!(tips(&wear).contains(&[0.0, 20.0, 0.0]) && only(&wear).taken.starts_with("0, the tool's wear"));
    // A job or a library may know the tool.
    let known = read_with(&format!("T3 M6\n{AROUND}"), |options| {
        options.cutters.insert(3, 10.0);
    });
    assert!(only(&known).taken.contains("10 across"));
}

#[test]
fn both_readings_of_a_register_are_compared() {
    // Down a neck, around the belly of a bottle and up again: 6 mm does not fit between both sides of a neck of 4 mm.
    let inside = |neck: f64| {
        let text = format!(
            "(T3 D=6. CR=0. - flat end mill)\nT3 M6\nG0 X0 Y60 Z0\nG41 D3 G1 X-{neck} Y40 F100\nY20\nX-20\nY0\nX20\nY20\nX{neck}\nY40\n\
             G40 X0 Y60\nM30\n"
        );
        let program = read(&text);
        assert!(only(&program).taken.starts_with("the size of tool 3"));
        let notes = program.notes.iter().map(ToString::to_string);
        notes
            .filter(|note| note.contains("say by --diameters"))
            .collect::<Vec<_>>()
    };
    let [warning] = &inside(2.0)[..] else {
        panic!("{:?}", inside(2.0))
    };
    assert!(
        warning.contains("a register (D3) has a place") && warning.starts_with("line "),
        "{warning}"
    );
    assert!(inside(5.0).is_empty());
}

#[test]
fn a_contour_too_narrow_for_the_tool_is_its_own_path() {
    // A slot's end of 2 mm radius, by a tool of 6 mm: the register cannot be its size.
    let text = "(T3 D=6. CR=0. - flat end mill)\nT3 M6\nG0 X-20 Y-10 Z0\nG41 D3 G1 X-20 Y0 F100\nX0\nG2 X0 Y-4 J-2\nG3 X0 Y-8 J-2\nG1 X-20\nG40 Y-10\nM30\n";
    let program = read(text);
    assert!(tips(&program).contains(&[0.0, -4.0, 0.0]));
    assert!(
        only(&program).taken.starts_with("0, the tool's wear"),
        "{}",
        only(&program)
    );
}

#[test]
fn registers_that_programs_set() {
    let diameter = |text: &str, controller| {
        let program = read_with(&format!("T3 M6\n{text}\n{AROUND}"), |options| {
            options.controller = Some(controller)
        });
        assert!(program.assumptions.is_empty());
        tips(&program)
            .iter()
            .map(|tip| -tip[0])
            .filter(|x| *x > 0.0 && *x < 19.0)
            .fold(0.0, f64::max)
    };
    assert_eq!(diameter("G10 L12 P3 R4", Controller::Fanuc), 4.0);
    // Wear is on top; set twice, it is the second, and in G91 it adds.
    assert_eq!(
        diameter("G10 L12 P3 R4\nG10 L13 P3 R0.5\nG10 L13 P3 R0.25", Controller::Fanuc),
        4.25
    );
    assert_eq!(
        diameter(
            "G10 L12 P3 R4\nG91 G10 L12 P3 R1\nG10 L13 P3 R0.5\nG90",
            Controller::Fanuc
        ),
        5.5
    );
}

#[test]
fn probing_is_skipped() {
    let text = "G54 G0 X0 Y0 Z5\nG65 P9810 Z2 F2000\nG65 P9811 X5\nG31 Z-3 F100\nG0 X1 Y1 Z5\nG1 Z0\n";
    let program = read(text);
    assert_eq!(tips(&program), [[0.0, 0.0, 5.0], [1.0, 1.0, 5.0], [1.0, 1.0, 0.0]]);
    let what: Vec<&str> = program.assumptions.iter().map(|one| one.what.as_str()).collect();
    assert_eq!(
        what,
        [
            "O9810, a program of the machine",
            "O9811, a program of the machine",
            "what a probe finds"
        ]
    );
    assert!(program.assumptions.iter().all(|one| !one.changes_verdict));
    assert!(strict(text).contains("the subprogram O9810 is missing"));
    assert!(strict("G0 X0 Y0 Z5\nG31 Z-3 F100\n").contains("probing is"));
    // A program of the user is not the machine's: what it cuts is missing.
    let missing = read("G0 X0 Y0 Z5\nG65 P1234\nG0 X1 Y1 Z5\n");
    assert!(only(&missing).what.contains("O1234") && only(&missing).changes_verdict);
    assert!(strict("G0 X0 Y0 Z5\nG65 P1234\n").contains("the subprogram O1234 is missing"));
}

#[test]
fn branches_on_what_the_operator_sets() {
    let text = "G0 X0 Y0 Z5\nIF [#501 EQ 1] GOTO 10\nG1 X1 F100\nIF [#5221 EQ 0] GOTO 20\nN10 G1 X2\nN20 G1 X3\nM30\n";
    let program = read_with(text, |options| options.controller = Some(Controller::Fanuc));
    assert_eq!(tips(&program), [[0.0, 0.0, 5.0], [1.0, 0.0, 5.0], [3.0, 0.0, 5.0]]);
    let said: Vec<(usize, &str)> = program
        .assumptions
        .iter()
        .map(|one| (one.line, one.taken.as_str()))
        .collect();
    assert_eq!(
        said,
        [
            (2, "empty, by which IF goes on; with another value it may jump"),
            (4, "0, by which IF jumps; with another value it may go on")
        ]
    );
    assert!(program.assumptions.iter().all(|one| one.changes_verdict));
}

#[test]
fn a_thousand_problems_are_one_line_each() {
    let blocks: String = (0..1000)
        .map(|k| format!("G58 X{k} Y1\nM777\nG54 G0 X{k} Y0 Z5\nG1 Z-1 F100\n"))
        .collect();
    let program = read(&format!("G54 G0 X0 Y0 Z5\n{blocks}"));
    assert!(only(&program).line == 2);
    assert!(program.notes.len() <= 3, "{:?}", program.notes);
    assert!(program.notes.iter().any(|note| note.message.contains("1000 times")));
    assert_eq!((program.blocks, program.blocks - program.understood), (4001, 2000));
}

#[test]
fn the_part_is_where_something_is_cut() {
    // The program begins by parking: its rapids there are left out, not its cuts.
    let text = "T1 M6\nG59 G0 X0 Y0 Z5\nX12\nM3 S100\nG54 G0 X1 Y1 Z5\nG1 Z-1 F100\nG59 G0 X0\n";
    let program = read(text);
    assert_eq!(tips(&program), [[1.0, 1.0, 5.0], [1.0, 1.0, -1.0]]);
    let parking = only(&program);
    assert_eq!(
        (parking.what.as_str(), parking.line, parking.changes_verdict),
        ("the place of G59", 2, false)
    );
    assert!(program.events.iter().all(|event| event.pose == 0));
    assert!(strict(text).contains("a move in G54"));
}
