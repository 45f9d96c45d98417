//! Programs in Klartext, against poses worked out by hand.

use std::path::PathBuf;

use sweepsim_motion::TipCourse;
use sweepsim_nc::{EventKind, Program, ReadOptions, StockDescription, heidenhain};

use crate::found::{near, tips};

fn exact(text: &str) -> Program {
    let mut options = ReadOptions::default();
    options.exact_arcs = true;
    heidenhain::read(text, &options).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn error(text: &str) -> String {
    let mut strict = ReadOptions::default();
    strict.strict = true;
    heidenhain::read(text, &strict).unwrap_err().to_string()
}

#[track_caller]
fn ends_at(text: &str, tip: [f64; 3]) {
    near(*tips(&exact(text)).last().unwrap(), tip);
}

#[test]
fn heads_stock_tools_and_lines() {
    let text = "0 BEGIN PGM PLATE MM\n1 BLK FORM 0.1 Z X-50 Y-40 Z-20\n2 BLK FORM 0.2 IX+100 IY+80 IZ+20\n3 TOOL CALL 5 Z S3000 F500\n\
                4 L X+0 Y+0 Z+10 R0 FMAX M3\n5 L Z-2 F200\n6 L IX+30 Y-5 ; on\n7 L Z +50 F MAX M5\n8 TOOL CALL \"DRILL 8\" Z\n9 L X+1 Y+1 FMAX\n10 END PGM PLATE MM\n11 L X9";
    let program = exact(text);
    assert_eq!(program.title.as_deref(), Some("PLATE"));
    let stock = StockDescription::Block {
        min: [-50.0, -40.0, -20.0],
        max: [50.0, 40.0, 0.0],
    };
    assert_eq!(program.stock, Some(stock));
    let expected = [
        [0.0, 0.0, 10.0],
        [0.0, 0.0, -2.0],
        [30.0, -5.0, -2.0],
        [30.0, -5.0, 50.0],
        [1.0, 1.0, 50.0],
    ];
    assert_eq!(tips(&program), expected);
    let rapid: Vec<bool> = program.poses.iter().map(|pose| pose.rapid).collect();
    assert_eq!(rapid, [true, false, false, true, true]);
    let lines: Vec<_> = program
        .poses
        .iter()
        .map(|pose| (pose.line, pose.tool, pose.feed))
        .collect();
    assert_eq!(lines[2], (7, Some(5), Some(200.0)));
    assert_eq!((lines[4].1, program.poses[4].joined), (Some(1), false));
    assert!(
        program
            .events
            .iter()
            .any(|event| event.kind == EventKind::ToolChange(5))
    );
    ends_at(
        "BEGIN PGM A INCH\nL X+1 Y+0 Z+2 FMAX\nEND PGM A INCH",
        [25.4, 0.0, 50.8],
    );
}

#[test]
fn arcs_and_polar_coordinates() {
    let start = "L X+10 Y+0 Z+0 FMAX\nCC X+0 Y+0\n";
    for (arc, end, angle) in [
        ("C X+0 Y+10 DR+ F100", [0.0, 10.0, 0.0], 90.0),
        ("C X+0 Y+10 DR-", [0.0, 10.0, 0.0], -270.0),
        ("C X+10 Y+0 DR+", [10.0, 0.0, 0.0], 360.0),
        ("CR X+0 Y+10 R+10 DR+", [0.0, 10.0, 0.0], 90.0),
        ("CP PA+90 DR+", [0.0, 10.0, 0.0], 90.0),
        ("CP IPA+1080 IZ-6 DR+", [10.0, 0.0, -6.0], 1080.0),
        ("CP IPA-450 IZ-5 DR-", [0.0, -10.0, -5.0], -450.0),
    ] {
        let program = exact(&format!("{start}{arc}\n"));
        let last = program.poses.last().unwrap();
        near(last.pose.tip(), end);
        let TipCourse::Arc(found) = last.way().course else {
            panic!("{arc}")
        };
        assert!(
            (found.angle().to_degrees() - angle).abs() < 1e-9,
            "{arc}: {}",
            found.angle().to_degrees()
        );
        near(found.centre(), [0.0; 3]);
    }
    // The larger arc on a radius, about (10, 10).
    let program = exact(&format!("{start}CR X+0 Y+10 R-10 DR-"));
    let TipCourse::Arc(found) = program.poses.last().unwrap().way().course else {
        panic!()
    };
    assert!((found.angle().to_degrees() + 270.0).abs() < 1e-9 || (found.angle().to_degrees() - 270.0).abs() < 1e-9);
    ends_at(
        &format!("{start}LP PR+20 PA+30"),
        [20.0 * 30_f64.to_radians().cos(), 10.0, 0.0],
    );
    ends_at(&format!("{start}LP IPA+90\nLP IPR+5"), [0.0, 15.0, 0.0]);
    // Tangential: after a line along X, a quarter to the left about (20, 10).
    let program = exact("L X+0 Y+0 Z+0 FMAX\nL X+20 F100\nCT X+30 Y+10\nCT X+20 Y+20");
    for pose in &program.poses[2..] {
        let TipCourse::Arc(found) = pose.way().course else {
            panic!()
        };
        near(found.centre(), [20.0, 10.0, 0.0]);
        assert!((found.angle().to_degrees() - 90.0).abs() < 1e-9);
    }
    // CC alone is where the tool is; with one coordinate, the other stays.
    ends_at("L X+5 Y+5 Z+0 FMAX\nCC\nLP PR+2 PA+0", [7.0, 5.0, 0.0]);
    ends_at("L X+5 Y+5 Z+0 FMAX\nCC X+1 Y+2\nCC X+3\nLP PR+2 PA+90", [3.0, 4.0, 0.0]);
}

#[test]
fn rounded_corners_and_chamfers() {
    let program = exact("L X+0 Y+0 Z+0 FMAX\nL X+20 F100\nRND R5\nL Y+20\nCHF 2\nL X+0");
    let expected = [
        [0.0, 0.0, 0.0],
        [15.0, 0.0, 0.0],
        [20.0, 5.0, 0.0],
        [20.0, 18.0, 0.0],
        [18.0, 20.0, 0.0],
        [0.0, 20.0, 0.0],
    ];
    for (found, expected) in tips(&program).iter().zip(expected) {
        near(*found, expected);
    }
    assert_eq!(program.poses.len(), expected.len());
    let TipCourse::Arc(arc) = program.poses[2].way().course else {
        panic!()
    };
    near(arc.centre(), [15.0, 5.0, 0.0]);
    assert!((arc.angle().to_degrees() - 90.0).abs() < 1e-9);
    // To the right, at 60°: the arc touches both lines.
    let program = exact("L X+0 Y+0 Z+0 FMAX\nL X+30 F100\nRND R3\nL IX-10 IY-17.320508075688775");
    let TipCourse::Arc(arc) = program.poses[2].way().course else {
        panic!()
    };
    near(arc.centre(), [30.0 - 3.0 / 30_f64.to_radians().tan(), -3.0, 0.0]);
    assert!((arc.angle().to_degrees() + 120.0).abs() < 1e-9);
    assert!(
        error("L X+0 Y+0 Z+0 FMAX\nL X+4 F100\nRND R5\nL Y+20").contains("the radius of RND is 5, but must be smaller")
    );
}

#[test]
fn labels_parameters_and_jumps() {
    // A step, repeated twice more; and a subprogram.
    ends_at(
        "L X+0 Y+0 Z+0 FMAX\nLBL 1\nL IX+2 F100\nCALL LBL 1 REP 2",
        [6.0, 0.0, 0.0],
    );
    ends_at(
        "L X+0 Y+0 Z+0 FMAX\nCALL LBL \"UP\"\nL IX+1\nCALL LBL \"UP\"\nM30\nLBL \"UP\"\nL IZ+3 F100\nLBL 0",
        [1.0, 0.0, 6.0],
    );
    ends_at(
        "FN 0: Q1 = +3\nQ2 = Q1 * (2 + 1)\nL X+Q1 Y-Q2 Z+0 FMAX",
        [3.0, -9.0, 0.0],
    );
    ends_at(
        "Q1 = 0\nL X+0 Y+0 Z+0 FMAX\nLBL 5\nL IX+1 F9\nFN 1: Q1 = +Q1 + +1\nFN 12: IF +Q1 LT +7 GOTO LBL 5",
        [7.0, 0.0, 0.0],
    );
    ends_at(
        "L X+0 Y+0 Z+0 FMAX\nFN 9: IF +1 EQU +1 GOTO LBL 9\nL X+50\nLBL 9\nL Y+1",
        [0.0, 1.0, 0.0],
    );
    // Calls within repeats, and moves keep the calls that led to them.
    let program = exact("L X+0 Y+0 Z+0 FMAX\nLBL 1\nCALL LBL 2\nCALL LBL 1 REP 1\nM2\nLBL 2\nL IX+1 F9\nLBL 0");
    assert_eq!(tips(&program).last(), Some(&[2.0, 0.0, 0.0]));
    let last = program.poses.last().unwrap();
    assert_eq!(
        (
            last.line,
            program.calls_of(last.call).map(|call| call.line).collect::<Vec<_>>()
        ),
        (7, vec![3, 4])
    );
    let library = |name: &str| {
        (name == "HOLE").then(|| {
            (
                PathBuf::from("HOLE.H"),
                "BEGIN PGM HOLE MM\nL IZ-4 F50\nEND PGM HOLE MM".to_owned(),
            )
        })
    };
    let program = heidenhain::read_with(
        "L X+0 Y+0 Z+0 FMAX\nCALL PGM HOLE\nL IX+1",
        &ReadOptions::default(),
        &library,
    )
    .unwrap();
    assert_eq!(tips(&program), [[0.0; 3], [0.0, 0.0, -4.0], [1.0, 0.0, -4.0]]);
    assert_eq!(program.files[program.poses[1].file], PathBuf::from("HOLE.H"));
}

#[test]
fn frames() {
    ends_at(
        "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+10\nCYCL DEF 7.2 Y+5\nL X+1 Y+1 Z+1 FMAX",
        [11.0, 6.0, 1.0],
    );
    ends_at(
        "CYCL DEF 7.0\nCYCL DEF 7.1 X+10\nCYCL DEF 7.0\nCYCL DEF 7.1 IX+5\nL X+1 Y+1 Z+1 FMAX",
        [16.0, 1.0, 1.0],
    );
    ends_at(
        "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+90\nL X+1 Y+0 Z+0 FMAX",
        [0.0, 1.0, 0.0],
    );
    ends_at(
        "CYCL DEF 8.0 MIRRORING\nCYCL DEF 8.1 X\nL X+1 Y+2 Z+0 FMAX",
        [-1.0, 2.0, 0.0],
    );
    ends_at(
        "CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 0.5\nL X+1 Y+2 Z+3 FMAX",
        [0.5, 1.0, 1.5],
    );
    ends_at(
        "CYCL DEF 247 DATUM SETTING ~\nQ339=+4 ;DATUM NUMBER\nL X+1 Y+2 Z+3 FMAX",
        [1.0, 2.0, 3.0],
    );
    assert!(
        error("CYCL DEF 247 Q339=+4\nL X+1 Y+2 Z+3 FMAX\nCYCL DEF 247 Q339=+5\nL X+2 FMAX")
            .contains("a move in preset 5, which")
    );
    // A plane at a shifted datum: Rz(90) Rx(90) x = y, its z is x.
    let program =
        exact("CYCL DEF 7.0\nCYCL DEF 7.1 X+10\nPLANE SPATIAL SPA+90 SPB+0 SPC+90 TURN FMAX\nL X+1 Y+2 Z+3 FMAX");
    let pose = program.poses.last().unwrap().pose;
    near(pose.tip(), [13.0, 1.0, 2.0]);
    near(pose.axis(), [1.0, 0.0, 0.0]);
    // By Euler angles, and by vectors: the same plane.
    for plane in [
        "EULER EULPR+90 EULNU+90 EULROT+0",
        "VECTOR BX+0 BY+1 BZ+0 NX+1 NY+0 NZ+0",
    ] {
        let program = exact(&format!("PLANE {plane} TURN\nL X+1 Y+2 Z+3 FMAX"));
        let pose = program.poses.last().unwrap().pose;
        near(pose.tip(), [3.0, 1.0, 2.0]);
        near(pose.axis(), [1.0, 0.0, 0.0]);
    }
    let program =
        exact("PLANE SPATIAL SPA+0 SPB+30 SPC+0 TURN\nL X+1 Y+2 Z+3 FMAX\nPLANE RESET TURN\nL X+4 Y+5 Z+6 FMAX");
    let last = program.poses.last().unwrap().pose;
    assert_eq!((last.tip(), last.axis()), ([4.0, 5.0, 6.0], [0.0, 0.0, 1.0]));
}

#[test]
fn tip_control() {
    let half = 0.5_f64.sqrt();
    let program = exact("M128\nL X+0 Y+0 Z+5 B+0 C+0 FMAX\nL X+9 B+45 C+90 F500");
    near(program.poses[1].pose.axis(), [0.0, half, half]);
    // The manual's vector is not quite a unit vector: it is normalised.
    let program = exact(
        "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS\nLN X+1 Y+2 Z+3 NX+0 NY+0 NZ+1 TX+0.0 TY-0.6464 TZ+0.6464 F1000 M3",
    );
    near(program.poses[0].pose.axis(), [0.0, -half, half]);
    assert!(error("L X+0 Y+0 Z+0 FMAX\nLN X+1 TX+1 TY+0 TZ+0").contains("without tip control"));
    // M126: the shortest way.
    let mut options = ReadOptions::default();
    options.machine = sweepsim_nc::Machine::named("trunnion-ac").unwrap();
    let program = heidenhain::read("M128\nM126\nL X+0 Y+0 Z+0 A+10 C+350 FMAX\nL X+1 C+10 F100", &options).unwrap();
    assert!(
        (program.positions.last().unwrap().abc[2] - 370.0).abs() < 1e-12
            || (program.positions.last().unwrap().abc[2] - 10.0).abs() < 1e-12
    );
    // Without it, on a machine whose pivots are known: a turn about X at the part's zero takes the tip along.
    let program = heidenhain::read("L X+0 Y+0 Z+10 FMAX\nL A+90 F100", &options).unwrap();
    let last = program.poses.last().unwrap().pose;
    near(last.tip(), [0.0, -10.0, 0.0]);
    near(last.axis(), [0.0, -1.0, 0.0]);
}

#[test]
fn drilling() {
    let cycle = "CYCL DEF 200 DRILLING ~\nQ200=+2 ;SET-UP CLEARANCE ~\nQ201=-10 ;DEPTH ~\nQ206=+150 ;FEED ~\nQ202=+6 ;PLUNGING DEPTH ~\nQ210=+0 ~\nQ203=+1 ;SURFACE ~\nQ204=+20 ;2ND SET-UP ~\nQ211=+0.5 ;DWELL";
    let program = exact(&format!(
        "TOOL CALL 1 Z S1\nL X+0 Y+0 Z+50 FMAX F99\n{cycle}\nL X+5 FMAX M99\nL X+9 FMAX\nCYCL CALL"
    ));
    let first: Vec<f64> = program
        .poses
        .iter()
        .filter(|pose| pose.pose.tip()[0] == 5.0)
        .map(|pose| pose.pose.tip()[2])
        .collect();
    assert_eq!(first, [50.0, 3.0, -5.0, 3.0, -4.0, -9.0, 3.0, 21.0]);
    let feeds: Vec<_> = program
        .poses
        .iter()
        .filter(|pose| !pose.rapid)
        .map(|pose| (pose.pose.tip()[2], pose.feed))
        .collect();
    assert_eq!(
        feeds,
        [
            (-5.0, Some(150.0)),
            (-9.0, Some(150.0)),
            (-5.0, Some(150.0)),
            (-9.0, Some(150.0))
        ]
    );
    assert_eq!(
        program
            .events
            .iter()
            .filter(|event| event.kind == EventKind::Dwell { seconds: 0.5 })
            .count(),
        2
    );
    assert_eq!(tips(&program).last(), Some(&[9.0, 0.0, 21.0]));
    // The same without `~`, as older controls write it.
    let older = cycle.replace(" ~\n", "\n");
    let again = exact(&format!(
        "TOOL CALL 1 Z S1\nL X+0 Y+0 Z+50 FMAX F99\n{older}\nL X+5 FMAX M99\nL X+9 FMAX\nCYCL CALL"
    ));
    assert_eq!(tips(&again), tips(&program));
}

#[test]
fn bad_programs_say_where_and_what() {
    for (text, message) in [
        (
            "L X+0 Y+0 Z+0 FMAX\nL X+5 RL F100",
            "2:1: cutter compensation without a tool: expected TOOL CALL before it",
        ),
        (
            "L X+0 Y+0 Z+0 FMAX\nL X+Q5 F100",
            "2:3: Q5 has no value here: expected Q5 = a number before it",
        ),
        ("L X+0 Y+0\nL X+5 X+6", "2:7: a second X in one block: expected one"),
        (
            "L X+0 Y+0 Z+0 FMAX\nC X+5 Y+5 DR+",
            "2:1: an arc without a centre: expected CC before it",
        ),
        (
            "L X+0 Y+0 Z+0 FMAX\nCC X+5 Y+0\nC X+10 Y+0",
            "3:1: an arc without its sense: expected DR+ or DR-",
        ),
        (
            "L X+0 Y+0 Z+0 FMAX\nCYCL DEF 21 PILOT DRILLING\nCYCL CALL",
            "3:1: cycle 21 is not supported yet: its moves are not known; expected them written out",
        ),
        (
            "L X+0 Y+0 Z+0 FMAX\nCYCL CALL",
            "2:1: a cycle is called, but none is defined: expected CYCL DEF before it",
        ),
        (
            "L X+0 Y+0 Z+0 FMAX\nCALL LBL 7",
            "2:10: there is no LBL 7 in this program",
        ),
        (
            "L X+0 Y+0 Z+0 FMAX\nPLANE AXIAL B+5",
            "2:7: PLANE AXIAL is not supported yet: expected PLANE SPATIAL, EULER, VECTOR, RELATIV or RESET",
        ),
        (
            "L X+0 Y+0 Z+0 FMAX\nM138 A",
            "2:1: M138 is not supported yet: the path of the tool would be unknown",
        ),
        (
            "L X+0 Y+0 Z+0 FMAX\nAPPR LT X+1",
            "2:1: APPR before a block of this kind is not supported yet: expected L, LP, C, CP or CR after it",
        ),
        (
            "L X+0 Y+0 Z+0 FMAX\nFL X+1",
            "2:1: the free contour is not determined by its blocks up to line 2: expected more of what the drawing says, such as X, Y, AN, LEN, R or CCX and CCY",
        ),
        (
            "L X+0 Y+0 Z+0 FMAX\nL X+1.5.2",
            "2:3: this is \"+1.5.2\", but must be a number or a Q parameter",
        ),
        (
            "BEGIN PGM A MM\nEND PGM A MM",
            "2:1: this program has no move: expected at least one with X, Y and Z known",
        ),
    ] {
        assert_eq!(error(text), message, "{text}");
    }
    assert!(error("L X+0 Y+0 Z+0 FMAX\nLBL 1\nFN 9: IF +1 EQU +1 GOTO LBL 1").contains("the number of blocks"));
    assert!(error("L X+0 Y+0 Z+0 FMAX\nLBL 1\nCALL LBL 1\nLBL 0").contains("nested too deeply"));
}
