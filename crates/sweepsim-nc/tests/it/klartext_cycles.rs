//! Cycles of Heidenhain's controls, against their moves by hand.

use sweepsim_motion::TipCourse;
use sweepsim_nc::{EventKind, Program, ReadOptions, heidenhain};

const START: &str = "TOOL DEF 1 L+0 R+3\nTOOL CALL 1 Z S9\nL X+10 Y+20 Z+50 R0 FMAX\n";

fn read(text: &str) -> Program {
    let mut options = ReadOptions::default();
    options.exact_arcs = true;
    heidenhain::read(&format!("{START}{text}"), &options).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Tip, whether it is a rapid, and feed of the moves after the first.
fn moves(program: &Program) -> Vec<([f64; 3], bool, Option<f64>)> {
    program.poses[1..]
        .iter()
        .map(|pose| (pose.pose.tip(), pose.rapid, pose.feed))
        .collect()
}

#[test]
fn boring_leaves_the_wall() {
    let program =
        read("CYCL DEF 202 Q200=2 Q201=-15 Q206=100 Q211=0.5 Q208=250 Q203=5 Q204=20 Q214=1 Q336=0\nCYCL CALL\n");
    assert_eq!(
        moves(&program),
        [
            ([10.0, 20.0, 7.0], true, None),
            ([10.0, 20.0, -10.0], false, Some(100.0)),
            ([9.8, 20.0, -10.0], false, Some(100.0)),
            ([9.8, 20.0, 7.0], false, Some(250.0)),
            ([10.0, 20.0, 7.0], true, None),
            ([10.0, 20.0, 25.0], true, None),
        ]
    );
    assert!(
        program
            .events
            .iter()
            .any(|event| event.kind == EventKind::Dwell { seconds: 0.5 })
    );
    // Without a direction it goes up along the wall.
    let program = read("CYCL DEF 202 Q200=2 Q201=-15 Q206=100 Q208=0 Q203=5 Q204=20 Q214=0\nCYCL CALL\n");
    assert_eq!(moves(&program)[2], ([10.0, 20.0, 7.0], false, Some(100.0)));
}

#[test]
fn back_boring_comes_from_below() {
    // A hole through 20 mm from z = 0 down; a counterbore of 5 mm from below, with an edge 15 mm above the tip, 3.5 mm beside the middle.
    let program = read(
        "CYCL DEF 204 Q200=2 Q249=5 Q250=20 Q251=3.5 Q252=15 Q253=750 Q254=200 Q255=1 Q203=0 Q204=50 Q214=2\nCYCL CALL\n",
    );
    let (below, up) = (-20.0 - 2.0 - 15.0, -20.0 + 5.0 - 15.0);
    assert_eq!(
        moves(&program),
        [
            ([10.0, 20.0, 2.0], true, None),
            ([10.0, 16.5, 2.0], false, Some(750.0)),
            ([10.0, 16.5, below], false, Some(750.0)),
            ([10.0, 20.0, below], false, Some(750.0)),
            ([10.0, 20.0, up], false, Some(200.0)),
            ([10.0, 20.0, below], false, Some(750.0)),
            ([10.0, 16.5, below], false, Some(750.0)),
            ([10.0, 16.5, 2.0], false, Some(750.0)),
            ([10.0, 20.0, 2.0], true, None),
            ([10.0, 20.0, 50.0], true, None),
        ]
    );
}

#[test]
fn bore_milling_is_a_helix() {
    // 16 mm wide with a tool of 6 mm: a helix of radius 5, from 2 mm above down to -10 in turns of 5 mm: 2.4 turns.
    for (word, sense) in [("", 1.0), (" Q351=-1", -1.0)] {
        let program = read(&format!(
            "CYCL DEF 208 Q200=2 Q201=-10 Q206=150 Q334=5 Q203=0 Q204=50 Q335=16 Q342=0{word}\nCYCL CALL\n"
        ));
        let found = moves(&program);
        let tips: Vec<[f64; 3]> = found.iter().map(|(tip, ..)| *tip).collect();
        let (sin, cos) = (sense * 144_f64.to_radians()).sin_cos();
        let end = [10.0 + 5.0 * cos, 20.0 + 5.0 * sin, -10.0];
        let expected = [
            [10.0, 20.0, 2.0],
            [15.0, 20.0, 2.0],
            end,
            end,
            [10.0, 20.0, -10.0],
            [10.0, 20.0, 2.0],
            [10.0, 20.0, 50.0],
        ];
        assert_eq!(tips.len(), expected.len());
        for (a, b) in tips.iter().zip(expected) {
            assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-9), "{tips:?}");
        }
        let turns: Vec<f64> = program.poses[3..5]
            .iter()
            .map(|pose| match pose.way().course {
                TipCourse::Arc(arc) => arc.angle() * arc.normal()[2] / std::f64::consts::TAU,
                _ => panic!("an arc"),
            })
            .collect();
        assert!(
            (turns[0] - sense * 2.4).abs() < 1e-12 && (turns[1] - sense).abs() < 1e-12,
            "{turns:?}"
        );
        assert_eq!(found[2].2, Some(150.0));
    }
}

#[test]
fn bad_cycles() {
    let error = |text: &str| {
        let mut options = ReadOptions::default();
        options.strict = true;
        heidenhain::read(&format!("{START}{text}"), &options)
            .unwrap_err()
            .to_string()
    };
    for (text, expected) in [
        (
            "CYCL DEF 208 Q200=2 Q201=-10 Q206=150 Q334=5 Q203=0 Q335=6",
            "4:1: the hole of cycle 208 is 6 mm wide, with an infeed of 5 mm, but must be wider than the tool, 6 mm",
        ),
        (
            "CYCL DEF 204 Q200=2 Q249=5 Q250=20 Q251=3.5 Q252=15 Q214=0",
            "4:1: cycle 204 without a direction beside the middle: expected Q214=1, 2, 3 or 4",
        ),
        (
            "CYCL DEF 202 Q200=2 Q201=-10 Q214=7",
            "4:1: Q214 of cycle 202 is 7, but must be 0, 1, 2, 3 or 4",
        ),
        (
            "TOOL CALL 9 Z\nCYCL DEF 208 Q200=2 Q201=-10 Q334=5 Q335=16",
            "5:1: the radius of the tool of cycle 208 is not known: expected it in the tool table, or TOOL DEF … R",
        ),
    ] {
        let found = error(text);
        assert!(found.starts_with(expected), "{found}");
    }
}

#[test]
fn long_repeats_run_as_if_written_out() {
    let block = |k: usize| format!("L X+{} Y+{} Z-1 F500 ; {k}\n", k % 7, k % 11);
    let blocks: String = (0..1500).map(block).collect();
    let repeated = read(&format!("LBL 1\n{blocks}CALL LBL 1 REP 2\n"));
    assert_eq!(moves(&repeated).len(), 4500);
    assert_eq!(moves(&repeated), moves(&read(&blocks.repeat(3))));
}

#[test]
fn patterns_of_places() {
    let drilled = |pattern: &str, call: &str| {
        let drill = "CYCL DEF 200 Q200=2 Q201=-5 Q206=100 Q202=5 Q210=0 Q203=1 Q204=20 Q211=0\n";
        let program = read(&format!("PATTERN DEF {pattern}\n{drill}{call}\n"));
        let bottoms = moves(&program)
            .into_iter()
            .filter(|(_, rapid, feed)| !rapid && *feed == Some(100.0));
        bottoms
            .map(|([x, y, z], ..)| [x, y, z].map(|c| (c * 1e6).round() / 1e6))
            .collect::<Vec<_>>()
    };
    let all = "CYCL CALL PAT FMAX M3";
    assert_eq!(
        drilled("POS1 (X+25 Y+33.5 Z+0) POS2( X+50 Y+75 Z+4 )", all),
        [[25.0, 33.5, -4.0], [50.0, 75.0, 0.0]]
    );
    assert_eq!(
        drilled("~\nPOS1( X+1 Y+2 Z+0 ) ~\nPOS2( X+3 Y+4 Z+0 )", all),
        [[1.0, 2.0, -4.0], [3.0, 4.0, -4.0]]
    );
    assert_eq!(
        drilled("ROW1 (X+10 Y+20 D+8 NUM3 ROT+90 Z+0)", all),
        [[10.0, 20.0, -4.0], [10.0, 28.0, -4.0], [10.0, 36.0, -4.0]]
    );
    assert_eq!(
        drilled("PAT1 (X+0 Y+0 DX+10 DY+5 NUMX2 NUMY2 ROT+0 ROTX+0 ROTY+90 Z+0)", all),
        [[0.0, 0.0, -4.0], [10.0, 0.0, -4.0], [5.0, 0.0, -4.0], [-5.0, 0.0, -4.0]]
    );
    let frame = drilled("FRAME1 (X+0 Y+0 DX+10 DY+5 NUMX4 NUMY3 ROT+0 ROTX+0 ROTY+0 Z+0)", all);
    assert_eq!(frame.len(), 10);
    assert!(
        frame
            .iter()
            .all(|[x, y, _]| [0.0, 30.0].contains(x) || [0.0, 10.0].contains(y)),
        "{frame:?}"
    );
    let mut once = frame.clone();
    once.dedup();
    assert_eq!(once, frame);
    assert_eq!(
        drilled("CIRC1 (X+5 Y+5 D20 START+90 NUM4 Z+0)", all),
        [
            [5.0, 15.0, -4.0],
            [-5.0, 5.0, -4.0],
            [5.0, -5.0, -4.0],
            [15.0, 5.0, -4.0]
        ]
    );
    let quarter = [[15.0, 5.0, -4.0], [5.0, 15.0, -4.0]];
    assert_eq!(
        drilled("PITCHCIRC1 (X+5 Y+5 D20 START+0 STEP+90 NUM2 Z+0)", all),
        quarter
    );
    assert_eq!(
        drilled("PITCHCIRC1 (X+5 Y+5 D20 START+0 END+90 NUM2 Z+0)", all),
        quarter
    );
    assert_eq!(
        drilled("POS1 (X+1 Y+1 Z+0)", "CYCL CALL POS X+7 Y+8 Z+3 FMAX M3"),
        [[7.0, 8.0, -1.0]]
    );
}

#[test]
fn between_places_the_tool_is_not_lower_than_at_the_call() {
    let program = read(
        "CYCL DEF 200 Q200=2 Q201=-5 Q206=100 Q202=5 Q203=0 Q204=10\nPATTERN DEF POS1 (X+1 Y+1 Z+0) POS2 (X+9 Y+1 Z+0)\nCYCL CALL PAT F5000 M3\n",
    );
    let across: Vec<_> = moves(&program)
        .into_iter()
        .filter(|([_, _, z], ..)| *z == 50.0)
        .collect();
    // To the first place, up from Q204, and across.
    let feed = Some(5000.0);
    assert_eq!(
        across,
        [
            ([1.0, 1.0, 50.0], false, feed),
            ([1.0, 1.0, 50.0], true, None),
            ([9.0, 1.0, 50.0], false, feed)
        ]
    );
}

#[test]
fn what_is_wrong_with_a_pattern_is_said() {
    let read = |text: &str| heidenhain::read(&format!("{START}{text}"), &ReadOptions::default());
    let error = |text: &str| read(text).expect_err(text).to_string();
    let drill = "CYCL DEF 200 Q200=2 Q201=-5 Q206=100 Q202=5 Q203=0 Q204=10\n";
    assert!(error(&format!("{drill}CYCL CALL PAT\n")).contains("expected PATTERN DEF"));
    assert!(error("PATTERN DEF POS1 (X+1 Y+1 Z+0)\nCYCL CALL PAT\n").contains("expected CYCL DEF"));
    assert!(error("PATTERN DEF HEX1 (X+1 Y+1 Z+0)\n").contains("HEX"));
    assert!(error("PATTERN DEF ROW1 (X+1 Y+1 NUM3 Z+0)\n").contains("without D"));
    assert!(error("PATTERN DEF PAT1 (X+1 Y+1 DX1 DY1 NUMX200 NUMY200)\n").contains("at most 10000"));
    // A table of points is left out, and that is said.
    let program = read(&format!("{drill}SEL PATTERN \"HOLES.PNT\"\nCYCL CALL PAT\n")).unwrap();
    let what = &program.assumptions[0].what;
    assert_eq!(what, "the moves of the cycle at the points of HOLES.PNT");
}
