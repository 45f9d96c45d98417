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
