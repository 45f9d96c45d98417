//! What programs of shops have been found to say, each kind in the fewest blocks: it is read, and what is assumed is said.

use std::path::Path;

use sweepsim_nc::{Controller, Program, ReadOptions, read_text};

use crate::found::rounded_tips;

fn read_as(name: &str, text: &str) -> Program {
    read_text(text, Path::new(name), &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// What is assumed: where first, what, and whether the verdict may depend on it.
fn said(program: &Program) -> Vec<(usize, &str, bool)> {
    let assumptions = program.assumptions.iter();
    assumptions
        .map(|one| (one.line, one.what.as_str(), one.changes_verdict))
        .collect()
}

fn strict(name: &str, text: &str) -> String {
    let mut options = ReadOptions::default();
    options.strict = true;
    read_text(text, Path::new(name), &options).expect_err(text).to_string()
}

#[test]
fn moves_before_the_first_motion_code() {
    // Haas: the first move is by G53 alone, which is a rapid.
    let program = read_as(
        "a.nc",
        "G17 G40 G80 G90\nG53 Z0.\nT1 M6\nG0 X0 Y0\nG43 H1 Z5.\nG1 Z-1. F100.\n",
    );
    assert_eq!(rounded_tips(&program), [[0.0, 0.0, 5.0], [0.0, 0.0, -1.0]]);
    assert!(program.assumptions.is_empty(), "{:?}", program.assumptions);
    // TinyG and Centroid: coordinates alone are rapids.
    let program = read_as("a.nc", "G21 G90\nX0 Y0 Z5\nG1 Z-1 F100\n");
    assert!(program.poses.iter().next().unwrap().rapid);
    assert_eq!(
        said(&program),
        [(2, "the kind of moves before the first motion code", true)]
    );
    assert!(strict("a.nc", "G21 G90\nX0 Y0 Z5\nG1 Z-1 F100\n").contains("X without a motion code"));
    // After a cycle, the code before it is in effect again.
    let text = "G0 X0 Y0 Z5\nG81 X1 Y1 Z-1 R1 F100\nG80\nX5 Y5 Z9\nG1 X6\nG81 X7 Z-1 R1\nG80\nX8\n";
    let program = read_as("a.nc", text);
    let moves: Vec<(usize, bool)> = program.poses.iter().map(|pose| (pose.line, pose.rapid)).collect();
    assert!(moves.contains(&(4, true)) && moves.contains(&(8, false)), "{moves:?}");
    assert!(program.assumptions.is_empty());
}

#[test]
fn centres_in_coordinates() {
    // A quarter about (40, 40): no arc from its start has a radius.
    let text = "G0 X50 Y40 Z0\nG3 X40 Y50 I40 J40 F100\nG1 X0\n";
    let program = read_as("a.nc", text);
    assert_eq!(rounded_tips(&program).last(), Some(&[0.0, 50.0, 0.0]));
    let arc = program
        .poses
        .iter()
        .filter(|pose| pose.line == 2)
        .map(|pose| pose.pose.tip());
    for tip in arc {
        assert!(((tip[0] - 40.0).hypot(tip[1] - 40.0) - 10.0).abs() < 1e-9);
    }
    assert_eq!(said(&program), [(2, "the centres of arcs (I, J, K)", true)]);
    // Where the program says that they are relative, or one arc is odd however it is read, it is an error.
    for wrong in [
        format!("G91.1\n{text}"),
        format!("{text}G2 X5 Y5 I3 J9\n"),
        text.to_owned(),
    ] {
        assert!(strict("a.nc", &wrong).contains("the arc has two radii"), "{wrong}");
    }
    let mixed = format!("{text}G2 X5 Y5 I3 J9\n");
    assert!(read_text(&mixed, Path::new("a.nc"), &ReadOptions::default()).is_err());
}

#[test]
fn registers_of_several_tools() {
    // The contour of the one tool is its own path, the other's size is not known: both are wear.
    let text = "(T3 D=6. - flat end mill)\nT3 M6\nG0 X-20 Y-10 Z0\nG41 D3 G1 X-20 Y0 F100\nX0\nG3 X0 Y4 J2\nG1 X-20\nG40 Y20\n\
                T5 M6\nG0 X0 Y0 Z0\nG41 D5 G1 X5\nX9\nG40 X20\n";
    let program = read_as("a.nc", text);
    assert_eq!(said(&program), [(4, "D3", true), (11, "D5", true)]);
    assert!(program.assumptions[0].taken.starts_with("0, the tool's wear"));
    assert!(
        program.assumptions[1]
            .taken
            .starts_with("0, since the size of tool 5 is not known")
    );
}

#[test]
fn ways_home_in_steps() {
    // Z is lost by the first way home: the rapids after it do not need it, so that nothing that is cut depends on it.
    let program = read_as(
        "a.nc",
        "G0 X0 Y0 Z5\nG1 Z-1 F100\nG0 G91 G28 Z0\nG28 X0 Y0\nG28 Z0\nM30\n",
    );
    assert!(
        program.assumptions.iter().all(|one| !one.changes_verdict),
        "{:?}",
        program.assumptions
    );
}

#[test]
fn a_cycle_without_its_plane() {
    let program = read_as("a.nc", "G0 X0 Y0 Z1\nG82 Z-2 F100\nX5\n");
    assert_eq!(said(&program), [(2, "the plane R of G82", true)]);
    assert_eq!(rounded_tips(&program).iter().filter(|tip| tip[2] == -2.0).count(), 2);
}

#[test]
fn subprograms_that_are_missing() {
    for (name, call) in [
        ("a.nc", "G0 X0 Y0 Z5\nG1 Z1 F100\nM98 P77\nG1 X5\nG0 X1 Y1 Z1\nG1 X2\n"),
        (
            "a.mpf",
            "G0 X0 Y0 Z=R1+5\nG1 Z1 F100\nCONTOUR77\nG1 X5\nG0 X1 Y1 Z1\nG1 X2\n",
        ),
        (
            "a.h",
            "BEGIN PGM A MM\nL X+0 Y+0 Z+5 R0 FMAX\nL Z+1 F100\nCALL PGM TNC:\\PARTS\\P77.H\nL X+5\nL X+1 Y+1 Z+1 FMAX\nL X+2\n",
        ),
        (
            "a.min",
            "$A.MIN%\nG0 X0 Y0 Z5\nCALL O77\nG1 X5 F100\nG0 X1 Y1 Z1\nG1 X2\n",
        ),
    ] {
        let program = read_as(name, call);
        let missing = &program.assumptions[0];
        assert!(
            missing.changes_verdict && missing.what.contains("77"),
            "{name}: {missing}"
        );
        // What comes before the program says where the tool is again is not made.
        assert!(
            rounded_tips(&program).iter().all(|tip| tip[0] != 5.0),
            "{name}: {:?}",
            rounded_tips(&program)
        );
        assert_eq!(rounded_tips(&program).last(), Some(&[2.0, 1.0, 1.0]), "{name}");
    }
}

#[test]
fn cycles_that_are_not_known() {
    for (name, call, what) in [
        (
            "a.mpf",
            "G0 X0 Y0 Z=R1+5\nCYCLE4711(1,2,\"A\")\nG1 X2 F100\n",
            "the moves of CYCLE4711",
        ),
        (
            "a.mpf",
            "G0 X0 Y0 Z=R1+5\nE_POCKET(1,2,,3)\nG1 X2 F100\n",
            "the moves of E_POCKET",
        ),
        (
            "a.mpf",
            "G0 X0 Y0 Z=R1+5\nMCALL CYCLE4711(1)\nX1\nMCALL\nG1 X2 F100\n",
            "the moves of CYCLE4711",
        ),
        (
            "a.h",
            "BEGIN PGM A MM\nL X+0 Y+0 Z+5 R0 FMAX\nCYCL DEF 271 OCM Q1=2\nCYCL CALL\nL X+2 F100\n",
            "the moves of cycle 271",
        ),
    ] {
        let program = read_as(name, call);
        assert_eq!(rounded_tips(&program).last(), Some(&[2.0, 0.0, 5.0]), "{name}");
        let [(_, found, true)] = said(&program)[..] else {
            panic!("{:?}", program.assumptions)
        };
        assert_eq!(found, what);
        assert!(strict(name, call).contains("its moves are not known"), "{call}");
    }
}

#[test]
fn klartext_as_it_is_written() {
    let head = "0 BEGIN PGM A MM\n1 BLK FORM 0.1 Z X+0 Y+0 Z-5\n2 BLK FORM 0.2 X+QR1 Y+9 Z+0\n";
    for (text, end) in [
        // A division is no optional block, whether a number stands before it or not.
        ("8 Q1 = 10 / 4\n9 L X+Q1 Y+0 Z+0 FMAX\n", [2.5, 0.0, 0.0]),
        ("/ 8 L X+1 Y+0 Z+0 FMAX\n9 L X+2 FMAX\n", [2.0, 0.0, 0.0]),
        // A comment that goes on.
        (
            "3 ; free to use~\n under some terms~\n and others\n4 L X+1 Y+0 Z+0 FMAX\n",
            [1.0, 0.0, 0.0],
        ),
        // Blanks within words, and none.
        (
            "3 CYCL DEF 7.0 DATUM\n4 CYCL DEF 7.1 X + 10\n5 L X + 1 Y - 2 Z+0 FMAX\n",
            [11.0, -2.0, 0.0],
        ),
        (
            "3 Q1=0\n4 LBL2\n5 Q1=Q1+1\n6 L X+Q1 Y+0 Z+0 FMAX\n7 FN12: IF +Q1 LT +3 GOTO LBL 2\n",
            [3.0, 0.0, 0.0],
        ),
        (
            "3 Q1=1\n4 FN9: IF +Q1 EQU +1 GOTO LBL7\n5 L X+9 Y+0 Z+0 FMAX\n6 LBL 7\n7 L Y+0 Z+0 FMAX\n8 L X+2 FMAX\n",
            [2.0, 0.0, 0.0],
        ),
        // Where the tool is, and what the control alone knows.
        (
            "3 L X+7 Y+0 Z+0 FMAX\n4 FN18: SYSREAD Q1 = ID270 NR1 IDX1\n5 L X+Q1 Y+1 FMAX\n",
            [7.0, 1.0, 0.0],
        ),
        (
            "3 L X+7 Y+0 Z+0 FMAX\n4 FN 18: SYSREAD Q1 = ID320 NR3\n5 FN 16: F-PRINT TNC:\\A.A / TNC:\\B.TXT\n6 L X+Q1 FMAX\n",
            [0.0; 3],
        ),
        // The radius of the tool.
        (
            "3 TOOL DEF 1 L+0 R+4\n4 TOOL CALL 1 Z S9\n5 L X+Q108 Y+0 Z+0 FMAX\n",
            [4.0, 0.0, 0.0],
        ),
        ("3 Q1 = SGN -5\n4 L X+Q1 Y+0 Z+0 FMAX\n", [-1.0, 0.0, 0.0]),
    ] {
        let program = read_as("a.h", &format!("{head}{text}"));
        assert_eq!(rounded_tips(&program).last(), Some(&end), "{text}");
        // A parameter that nothing sets makes no stock.
        assert!(program.stock.is_none() && said(&program)[0] == (3, "the value of QR1", true));
    }
    // A cycle at the end of a move, before any height: the tool comes from above.
    let text = "0 BEGIN PGM A MM\n1 CYCL DEF 200 DRILLING ~\n Q200=1 ~\n Q201=-5 ~\n Q206=AUTO ~\n Q202=5 ~\n Q203=0 ~\n Q204=50\n\
                2 L X+3 Y+4 R0 FMAX M99\n3 L X+13 M99\n";
    let program = read_as("a.h", text);
    assert_eq!(
        rounded_tips(&program)[..4],
        [[3.0, 4.0, 1.0], [3.0, 4.0, -5.0], [3.0, 4.0, 1.0], [3.0, 4.0, 50.0]]
    );
    assert!(rounded_tips(&program).contains(&[13.0, 4.0, -5.0]));
    assert_eq!(said(&program), [(9, "the height from which a cycle begins", false)]);
}

#[test]
fn siemens_values_that_only_the_control_knows() {
    let program = read_as("a.mpf", "G0 X0 Y0 Z=R1+5\nX=$P_UIFR[1,X,TR]+2\nG1 Z=_DEPTH F100\n");
    assert_eq!(rounded_tips(&program).last(), Some(&[2.0, 0.0, 0.0]));
    let [(2, system, true), (3, "the value of _DEPTH", true)] = said(&program)[..] else {
        panic!("{:?}", program.assumptions)
    };
    assert!(system.starts_with("the value of $P_UIFR"));
}

#[test]
fn okuma_with_variables_labels_and_calls() {
    let text = "$PLATE.MIN%\nO1000\nG15 H1\nT1 M6\nVC1=0\nDEP=-2.\nG0 X0 Y0 Z5.\nNLOOP VC1=VC1+1\nG1 Z=DEP*VC1 F100\nX20.\n\
                G0 Z5.\nX0\nIF [VC1 LT 3] NLOOP\nCALL OSLOT PA=10 PB=VC[1]\nIF [VDIN[5] EQ 1] GOTO NEND\nIF [PQ EQ EMPTY] NA2\nX99.\n\
                NA2 X=SQRT[16]+3\nNEND M02\nOSLOT\nG0 Y=PA\nG1 Z=-PB\nX5.\nRTS\n";
    let program = read_as("plate.min", text);
    assert_eq!(program.controller, Some(Controller::Okuma));
    let depths: Vec<f64> = rounded_tips(&program)
        .iter()
        .filter(|tip| tip[0] == 20.0)
        .map(|tip| tip[2])
        .collect();
    assert_eq!(depths, [-2.0, 5.0, -4.0, 5.0, -6.0, 5.0]);
    let all = rounded_tips(&program);
    assert_eq!(
        all[all.len() - 3..],
        [[0.0, 10.0, -3.0], [5.0, 10.0, -3.0], [7.0, 10.0, -3.0]]
    );
    // Which way it went on what the machine knows.
    let [(15, "VDIN[5], which the program does not set", true)] = said(&program)[..] else {
        panic!("{:?}", program.assumptions)
    };
    assert!(
        program.assumptions[0]
            .taken
            .contains("IF goes on; with another value it may jump")
    );
}

#[test]
fn fixture_offsets_of_fadal() {
    let text = "%\nN1O77(PLATE)\nN2G0G90G40G80\nN3M6T1\nN4E1X1.Y2.S2000M3\nN5H1Z3.M8\nN6G1Z-1.F10.\nN7X5.\nN8G0Z3.\nN9E2 X0Y0\nN10Z9.\nN11E0X0Y0Z0\nM30\n";
    let program = read_as("a.nc", text);
    let cut: Vec<[f64; 3]> = rounded_tips(&program)
        .into_iter()
        .filter(|tip| tip[2] == -1.0)
        .collect();
    assert_eq!(cut, [[1.0, 2.0, -1.0], [5.0, 2.0, -1.0]]);
    let [(10, "the place of E2", false), (12, "the place of E0", false)] = said(&program)[..] else {
        panic!("{:?}", program.assumptions)
    };
    // Placed by the user.
    let mut options = ReadOptions::default();
    options.offsets.insert("E2".to_owned(), [100.0, 0.0, 0.0]);
    let program = read_text(text, Path::new("a.nc"), &options).unwrap();
    assert!(
        rounded_tips(&program).contains(&[100.0, 0.0, 3.0]),
        "{:?}",
        rounded_tips(&program)
    );
    // What is extruded, and exponents, are errors as before.
    for wrong in [
        "G1 X5 E2 F100\n",
        "G92 E0\n",
        "G0 X1E2\n",
        "G1 X0 F9\nX5 E2\n",
        "G0 X0 E1.5\n",
        "G1 E5 F9\n",
    ] {
        let text = format!("G0 X0 Y0 Z0\n{wrong}");
        let read = read_text(&text, Path::new("a.nc"), &ReadOptions::default());
        assert!(
            read.is_err_and(|error| error.to_string().contains("E words are")),
            "{wrong}"
        );
    }
}

/// The heads and ends that posts write for Mazak's EIA, Brother, Hurco and Centroid: each as it is, with nothing
/// assumed that cuts.
#[test]
fn heads_of_other_controls() {
    let cut = "G1 Z-1. F100.\nX10.\nG0 Z5.\n";
    for (name, head, end) in [
        (
            "mazak.eia",
            "%\nO1234(BRACKET)\nG0 G17 G21 G40 G49 G54 G64 G80 G90 G94 G98\nG91 G28 Z0.\nT1 T2 M6\nG90 G0 X0. Y0.\nG61.1 P2\nS2000 M3\nG43 H1 Z5.\nG5 P2\nM51\n",
            "G5 P0\nM9\nG49 G91 G28 Z0.\nG28 X0. Y0.\nM30\n%\n",
        ),
        (
            "brother.nc",
            "%\nO1000(BRACKET)\nG0 G17 G21 G40 G49 G80 G90\nG100 T1 X0. Y0. Z5. G43 H1 L2 S2000 M3\nM298 L1\n",
            "M298 L0\nM494\nG53 G0 Z0.\nM30\n%\n",
        ),
        (
            "hurco.hnc",
            "%\n(PROGRAM NAME - BRACKET)\nG21\nG0 G17 G40 G80 G90\nT1 M6\nG5.3 P35\nG0 G90 G54 X0. Y0. S2000 M3\nG43 H1 Z5. M8\n",
            "M5\nM9\nG0 G28 G91 Z0.\nM59\nM30\n",
        ),
        (
            "centroid.cnc",
            "; BRACKET\nG21 G17 G40 G80 G90\nM25\nT1 M6\nS2000 M3\nG54\nG0 X0. Y0.\nG43 H1 Z5.\n",
            "M25 G49\nM5\nG0 X0 Y0\nM30\n",
        ),
    ] {
        let program = read_as(name, &format!("{head}{cut}{end}"));
        let all = rounded_tips(&program);
        assert!(
            all.windows(2).any(|pair| pair == [[0.0, 0.0, -1.0], [10.0, 0.0, -1.0]]),
            "{name}: {all:?}"
        );
        assert_eq!(
            program.poses.iter().find(|pose| !pose.rapid).and_then(|pose| pose.tool),
            Some(1),
            "{name}"
        );
        assert!(
            program.assumptions.iter().all(|one| !one.changes_verdict),
            "{name}: {:?}",
            program.assumptions
        );
    }
}
