//! Words of Siemens programs that once were read as something else, against poses worked out by hand.

use std::path::PathBuf;

use sweepsim_nc::{EventKind, FeedMode, NcError, Program, ReadOptions, Spindle, siemens};

use crate::found;

fn attempt(text: &str) -> Result<Program, NcError> {
    let called = |name: &str| (name == "HOLE").then(|| (PathBuf::from("HOLE.SPF"), "G91 Z-1\nZ1\nG90\nM17".to_owned()));
    siemens::read_with(text, &ReadOptions::default(), &called)
}

fn read(text: &str) -> Program {
    attempt(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn error(text: &str) -> String {
    attempt(text).unwrap_err().to_string()
}

fn tips(text: &str) -> Vec<[f64; 3]> {
    found::tips(&read(text))
}

#[track_caller]
fn ends_at(text: &str, tip: [f64; 3]) {
    found::near(*tips(text).last().unwrap(), tip);
}

#[test]
fn comparisons_come_last_and_bits_before_logic() {
    let jumps = |condition: &str| format!("X0 Y0 Z0\nR1=6\nIF {condition} GOTOF END\nX9\nEND: Y1");
    ends_at(&jumps("R1 B_AND 2 == 2"), [0.0, 1.0, 0.0]);
    ends_at(&jumps("R1 B_OR 1 == 7"), [0.0, 1.0, 0.0]);
    // R1 == (6 AND 1) is R1 == 1.
    ends_at(&jumps("R1 == 6 AND 1"), [9.0, 1.0, 0.0]);
    ends_at(&jumps("(R1 == 6) AND 1"), [0.0, 1.0, 0.0]);
    ends_at(&jumps("B_NOT R1 == -7"), [0.0, 1.0, 0.0]);
    // Numbers that are the same but for rounding.
    ends_at(&jumps("0.1+0.1+0.1 == 0.3"), [0.0, 1.0, 0.0]);
    ends_at(&jumps("0.1+0.1+0.1 > 0.3"), [9.0, 1.0, 0.0]);
    ends_at(
        "R1=0 X0 Y0 Z0\nWHILE R1<>0.3\nR1=R1+0.1\nENDWHILE\nX=R1*10",
        [3.0, 0.0, 0.0],
    );
    ends_at("X='HFF' Y='B101' Z='D9'", [255.0, 5.0, 9.0]);
    for text in ["R1='HXY'", "R1='", "R1='5", "R1='é'", "R1=''"] {
        assert!(error(text).contains("'HFF' or 'B101'"), "{text}");
    }
}

#[test]
fn variables_hold_what_their_type_says() {
    ends_at("DEF INT ONE=2.7, TWO\nTWO=3.4\nX=ONE Y=TWO Z0", [3.0, 3.0, 0.0]);
    ends_at("DEF INT ONE\nONE=-2.5\nX=ONE Y0 Z0", [-2.0, 0.0, 0.0]);
    ends_at("DEF INT LIST[3]\nLIST[1]=7/2\nX=LIST[1] Y0 Z0", [4.0, 0.0, 0.0]);
    ends_at("DEF BOOL YES=5\nX=YES Y0 Z0", [1.0, 0.0, 0.0]);
    let called = "%_N_MAIN_MPF\nSUB(2.6)\nM30\n%_N_SUB_SPF\nPROC SUB(INT ONE)\nX=ONE Y0 Z0\nONE=ONE/2\nX=ONE\nM17\n";
    assert_eq!(tips(called), [[3.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
}

#[test]
fn words_without_blanks() {
    ends_at("N10G0X1Y-2Z.5\nG91X10.5Y20", [11.5, 18.0, 0.5]);
    ends_at("X1Y2Z3\nG1X=4 Y5F100", [4.0, 5.0, 3.0]);
}

#[test]
fn subprograms_give_back_variables_and_modes() {
    let text = "%_N_MAIN_MPF\nDEF REAL A=1, L[2]\nG0 X0 Y0 Z0\nSUB(A, 4, L[1])\nX=A Y=L[1]\nM30\n\
        %_N_SUB_SPF\nPROC SUB(VAR REAL TO, REAL BY, VAR REAL NEXT)\nTO=TO+BY\nNEXT=BY*2\nBY=0\nM17\n";
    ends_at(text, [5.0, 8.0, 0.0]);
    let text = |attribute: &str| {
        format!(
            "%_N_MAIN_MPF\nG0 X0 Y0 Z0\nSUB\nX2\nM30\n%_N_SUB_SPF\nPROC SUB {attribute}\nTRANS X10\nG91 G1 X1 F100\nM17\n"
        )
    };
    // Without SAVE all stays as it is: in G91, and behind the shift.
    let x = |attribute: &str| tips(&text(attribute)).iter().map(|tip| tip[0]).collect::<Vec<f64>>();
    assert_eq!(x(""), [0.0, 11.0, 13.0]);
    assert_eq!(x("SAVE DISPLOF"), [0.0, 11.0, 2.0]);
}

#[test]
fn modal_calls_go_on_in_subprograms() {
    let text = "%_N_MAIN_MPF\nG0 X0 Y0 Z9 F100\nMCALL CYCLE81(10,0,2,-5)\nPLACES\nMCALL\nX9\nM30\n\
        %_N_PLACES_SPF\nX10 Y0\nX20\nM17\n";
    let deepest: Vec<f64> = tips(text).iter().filter(|tip| tip[2] < 0.0).map(|tip| tip[0]).collect();
    assert_eq!(deepest, [10.0, 20.0]);
    // Whether one outlives its own subprogram is not known.
    let text = "%_N_MAIN_MPF\nG0 X0 Y0 Z9 F100\nSUB\nX9\nM30\n%_N_SUB_SPF\nMCALL CYCLE81(10,0,2,-5)\nX1\nM17\n";
    assert_eq!(tips(text).iter().filter(|tip| tip[2] < 0.0).count(), 1);
    assert!(
        read(text)
            .assumptions
            .iter()
            .any(|a| a.what.contains("modal call goes on"))
    );
    // What is called is not called by its own moves, with a number or a name.
    for name in ["L70", "HOLES"] {
        let text = format!(
            "%_N_MAIN_MPF\nG0 X0 Y0 Z9\nMCALL {name}\nX10\nX20\nMCALL\nX30\nM30\n%_N_{name}_SPF\nZ8\nZ9\nM17\n"
        );
        let x: Vec<f64> = tips(&text)
            .iter()
            .filter(|tip| tip[2] == 8.0)
            .map(|tip| tip[0])
            .collect();
        assert_eq!(x, [10.0, 20.0], "{name}");
    }
}

#[test]
fn calls_by_texts() {
    for call in [
        "CALL \"HOLE\"",
        "EXTCALL \"HOLE.SPF\"",
        "EXTCALL(\"/_N_WKS_DIR/_N_HOLE_SPF\")",
    ] {
        assert_eq!(tips(&format!("X1 Y2 Z3\n{call}\nX0"))[1], [1.0, 2.0, 2.0], "{call}");
    }
}

#[test]
fn repeated_sections() {
    // To ENDLABEL, though more follows before the repeat.
    ends_at(
        "X0 Y0 Z0\nA: G91 X1\nENDLABEL: Z1\nY5\nREPEAT A P=2\nM30",
        [3.0, 5.0, 3.0],
    );
    // A label further down.
    ends_at(
        "X0 Y0 Z0\nREPEAT A P=2\nGOTOF END\nA: G91 X1\nENDLABEL: Z1\nEND: Y7",
        [2.0, 7.0, 2.0],
    );
    ends_at(
        "X0 Y0 Z0\nREPEATB A P=3\nGOTOF END\nA: G91 X1\nEND: Y7",
        [3.0, 7.0, 0.0],
    );
    ends_at(
        "X0 Y0 Z0\nREPEAT A B\nGOTOF END\nA: G91 X1\nB: Z1\nEND: Y7",
        [1.0, 7.0, 1.0],
    );
    // As before: up to the repeat.
    ends_at("X0 Y0 Z0\nA: G91 X1\nREPEAT A P=2\nENDLABEL: Z1", [3.0, 0.0, 1.0]);
    assert!(error("REPEAT A\nA: X1\nM30").contains("ENDLABEL"));
}

#[test]
fn cases_and_main_blocks() {
    let text = |value: u32| {
        format!(
            ":10 X0 Y0 Z0\nR1={value}\nCASE R1 OF 1 GOTOF A 2 GOTOF B DEFAULT GOTOF C\nA: X1\nM30\nB: X2\nM30\nC: X3\nM30"
        )
    };
    for (value, x) in [(1, 1.0), (2, 2.0), (7, 3.0)] {
        ends_at(&text(value), [x, 0.0, 0.0]);
    }
    ends_at("X0 Y0 Z0\nCASE (2*3) OF 5 GOTOF A\nX5\nA: Y1", [5.0, 1.0, 0.0]);
    assert!(error("CASE R1 IS 5").contains("expected OF"));
}

#[test]
fn names_of_axes_are_no_variables() {
    for text in ["G0 X0 Y0 Z0\nX1=10", "G0 X0 Y0 Z0\nC1=90", "G0 X0 Y0 Z0\nQ2=5 X1"] {
        assert!(error(text).contains("may be an axis"), "{text}");
    }
    ends_at("DEF REAL C1\nC1=9\nX=C1 Y0 Z0", [9.0, 0.0, 0.0]);
    for text in ["ROTS X30 Y20", "AROTS X30", "AX[R1]=5", "G[8]=2", "IP[X]=3"] {
        assert!(error(&format!("X0 Y0 Z0\n{text}")).contains("not supported"), "{text}");
    }
}

#[test]
fn tools_change_by_t_where_there_is_no_m6() {
    let changes = |text: &str| -> Vec<(u32, usize)> {
        let events = read(text).events;
        let change = |kind: &EventKind| match kind {
            EventKind::ToolChange(tool) => Some(*tool),
            _ => None,
        };
        events
            .iter()
            .filter_map(|event| Some((change(&event.kind)?, event.line)))
            .collect()
    };
    let text = "T1 D1\nX0 Y0 Z0\nG1 X5 F100\nT2 D1\nX0\nM30";
    assert_eq!(changes(text), [(1, 1), (2, 4)]);
    assert!(read(text).assumptions.iter().any(|a| a.what.contains("when T changes")));
    // With M6 somewhere, T selects.
    assert_eq!(
        changes("T1\nX0 Y0 Z0\nG1 X5 F100\nT2\nX0\nM06\nX1\nM30"),
        [(1, 1), (2, 6)]
    );
    assert_eq!(changes("N1 T1M6\nX0 Y0 Z0\nG1 X5 F100\nT2\nX0 ; M6\nM30"), [(1, 1)]);
}

#[test]
fn feeds_of_blocks_and_stops_after_moves() {
    let program = read("X0 Y0 Z0\nG1 X1 F100\nX2 FB=50\nX3 M0\nX4 FB=20 F200\nX5");
    let feeds: Vec<Option<f64>> = program.poses.iter().skip(1).map(|pose| pose.feed).collect();
    assert_eq!(feeds, [100.0, 50.0, 100.0, 20.0, 200.0].map(Some));
    let tooth = read("X0 Y0 Z0\nG1 X1 F100\nG95 FZ=0.1 X2");
    let last = tooth.poses.last().unwrap();
    assert_eq!((last.feed, last.feed_mode), (Some(0.1), FeedMode::PerRevolution));
    assert!(tooth.assumptions.iter().any(|a| a.what.contains("number of teeth")));
    let stop = program
        .events
        .iter()
        .find(|event| event.kind == EventKind::Stop)
        .unwrap();
    // Behind the move to X3.
    assert_eq!(stop.pose, 4);
}

#[test]
fn incremental_moves_after_another_frame() {
    // As controls are delivered, the offset is part of the move.
    ends_at("X0 Y0 Z0\nTRANS X10\nG91 X5\nX5", [20.0, 0.0, 0.0]);
    ends_at("X0 Y0 Z0\nTRANS X10\nX=IC(5) Y1\nX=IC(1)", [16.0, 1.0, 0.0]);
    ends_at("X0 Y0 Z0\nTRANS X10\nX1\nG91 X5", [16.0, 0.0, 0.0]);
    // Of two in a row, both.
    ends_at("X0 Y0 Z0\nTRANS X10\nATRANS X10\nG91 X5", [25.0, 0.0, 0.0]);
    let program = read("X0 Y0 Z0\nTRANS X10\nG91 X5");
    assert!(
        program
            .assumptions
            .iter()
            .any(|a| a.what.contains("incremental moves after another frame"))
    );
    assert!(read("X0 Y0 Z0\nTRANS X10\nG91 Z5").assumptions.is_empty());
    // Where it is turned too, that is not known.
    ends_at("X10 Y0 Z0\nROT RPL=90\nG91 X5", [10.0, 5.0, 0.0]);
    assert!(error("X0 Y0 Z0\nSCALE X2\nAROT Z45\nX1").contains("scale that is not the same"));
    ends_at("X0 Y0 Z0\nSCALE X2 Y2 Z2\nAROT Z90\nX1", [0.0, 2.0, 0.0]);
}

#[test]
fn kinds_of_newer_cycles_that_are_not_known() {
    let start = "T1 D1\n$TC_DP6[1,1]=2\nG0 X0 Y0 Z20 F100\n";
    let deepest = |text: &str| {
        let program = read(&format!("{start}{text}"));
        let lowest = program
            .poses
            .iter()
            .map(|pose| pose.pose.tip()[2])
            .fold(f64::INFINITY, f64::min);
        let missing = program
            .assumptions
            .iter()
            .any(|assumption| assumption.what.contains("the moves of CYCLE"));
        (
            lowest,
            missing
                || program
                    .assumptions
                    .iter()
                    .any(|a| a.what.contains("the moves of POCKET")),
        )
    };
    // The depth is a diameter, or that of the shank.
    assert_eq!(deepest("CYCLE81(10,0,2,6,,0,10,1,12)"), (20.0, true));
    assert_eq!(deepest("CYCLE82(10,0,2,-6,,0,10,1,12)"), (20.0, true));
    assert_eq!(deepest("CYCLE82(10,0,2,-6,,0,0,1,12)"), (-6.0, false));
    // Relative, by itself or by AMODE.
    assert_eq!(deepest("CYCLE82(10,3,2,,6,0,0,1,11)"), (-3.0, false));
    assert_eq!(deepest("CYCLE82(10,3,2,6,,0,0,1,11)"), (-3.0, false));
    let pocket = |vari: u32, gmode: u32, amode: u32| {
        deepest(&format!(
            "POCKET3(10,3,2,6,30,20,5,0,0,0,3,0,0,100,100,0,{vari},2,0,0,0,0,0,0,0,0,{gmode},0,{amode})"
        ))
    };
    assert_eq!(pocket(1, 0, 1), (-3.0, false));
    assert_eq!(pocket(5, 0, 1), (20.0, true));
    assert_eq!(pocket(1, 2000, 1), (20.0, true));
}

#[test]
fn dwells_feeds_and_stops_of_cycles() {
    let events = |text: &str| -> Vec<EventKind> {
        let text = format!("G0 X0 Y0 Z20 F100 S120 M3\n{text}");
        read(&text)
            .events
            .iter()
            .skip(1)
            .map(|event| event.kind.clone())
            .collect()
    };
    // Turns of the spindle are negative.
    assert_eq!(events("CYCLE82(10,0,2,-6,,-3)"), [EventKind::Dwell { seconds: 1.5 }]);
    assert_eq!(events("CYCLE82(10,0,2,-6,,3)"), [EventKind::Dwell { seconds: 3.0 }]);
    assert!(events("CYCLE87(10,0,2,-6,,3)").contains(&EventKind::Stop));
    let feed = |text: &str| {
        read(&format!("G0 X0 Y0 Z20 F100 S120 M3\n{text}"))
            .poses
            .iter()
            .find_map(|pose| pose.feed)
    };
    assert_eq!(feed("CYCLE84(10,0,2,-6,,0,5,,1.5,0,200)"), Some(300.0));
    assert_eq!(feed("CYCLE84(10,0,2,-6,,0,5,,1.5,0)"), Some(180.0));
    assert_eq!(feed("G95 F0.2\nCYCLE84(10,0,2,-6,,0,5,,1.5,0)"), Some(1.5));
}

#[test]
fn numbered_spindles_and_feeds_in_inches() {
    let spindle = |text: &str| {
        read(&format!("{text}\nX0 Y0 Z0"))
            .events
            .first()
            .map(|event| event.kind.clone())
    };
    let turns = Some(EventKind::Spindle(Spindle::Clockwise { rpm: Some(900.0) }));
    assert_eq!(spindle("S1=900 M1=3"), turns);
    assert_eq!(spindle("SETMS(2)\nS2=900 M2=3"), turns);
    assert_eq!(spindle("S2=900 M2=3"), None);
    let assumes = |text: &str| {
        read(text)
            .assumptions
            .iter()
            .any(|a| a.what.contains("feeds after G70"))
    };
    assert!(assumes("G70 X0 Y0 Z0\nG1 X1 F10"));
    assert!(!assumes("G700 X0 Y0 Z0\nG1 X1 F10") && !assumes("X0 Y0 Z0\nG1 X1 F10"));
}

#[test]
fn another_tool_has_its_first_edge() {
    let start = "$TC_DP6[1,1]=1\n$TC_DP6[1,2]=2\n$TC_DP6[2,1]=3\n$TC_DP6[2,2]=4\nT1 M6\nD2\n";
    let beside = |tool: &str| {
        let text = format!("{start}{tool}\nG0 X0 Y0 Z0\nG1 G41 X10 Y0 F100\nX20\nG40 X30 Y0");
        tips(&text)[1][1]
    };
    let found = ["G0", "T2 M6", "T2 M6 D2", "T2 M6\nD2"].map(beside);
    assert_eq!(found, [2.0, 3.0, 4.0, 4.0]);
    // So it has its length, whatever was before it.
    let text = "T1 M6\nX0 Y0 Z0\nG0 Z5 D0\nT2 M6\nX0 Y0 Z5\nG1 Z-1 F100";
    ends_at(text, [0.0, 0.0, -1.0]);
    let left_out = |text: &str| {
        read(text)
            .assumptions
            .iter()
            .any(|a| a.what.contains("feed moves without"))
    };
    assert!(left_out("X0 Y0 Z0\nG1 X5 F100 D0") && !left_out("X0 Y0 Z0\nG0 X5 D0"));
    assert!(
        read("DIAMON\nX0 Y0 Z0")
            .assumptions
            .iter()
            .any(|a| a.what.contains("diameter"))
    );
}

#[test]
fn finishing_takes_the_floor_that_was_left() {
    let start = "T1 D1\n$TC_DP6[1,1]=2\nG0 X0 Y0 Z20 F100\n";
    // Rings at the bottom, or the last one alone.
    let moves = |floor: f64, vari: u32| {
        let text = format!("{start}POCKET3(10,0,2,-6,30,20,5,0,0,0,3,0.2,{floor},100,100,0,{vari})");
        tips(&text).iter().filter(|tip| tip[2] == -6.0).count()
    };
    assert!(moves(0.5, 2) > moves(0.0, 2) + 4);
    assert_eq!(moves(0.5, 4), moves(0.0, 4));
}
