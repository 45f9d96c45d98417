//! Drilling cycles, against their expansion by hand.

use super::{read, tips};
use sweepsim_nc::EventKind;

/// The heights and kinds of all moves.
fn levels(text: &str) -> Vec<(f64, bool)> {
    let program = read(text);
    program
        .poses
        .iter()
        .map(|pose| (pose.pose.tip()[2], pose.rapid))
        .collect()
}

#[test]
fn drill_of_solidworks() {
    let text = "RAPID/\nGOTO/7,5,25\nCYCLE/INIT\nCYCLE/DRILL,FEDTO,5.4,MMPM,364.49,RAPTO,3.,RTRCTO,27.5,DWELL,0\nGOTO/7,5,-2.5\n\
                GOTO/20,5,-2.5\nCYCLE/OFF\nGOTO/20,5,30\n";
    let program = read(text);
    assert_eq!(
        tips(&program),
        [
            [7.0, 5.0, 25.0],
            [7.0, 5.0, 0.5],
            [7.0, 5.0, -7.9],
            [7.0, 5.0, 25.0],
            [20.0, 5.0, 25.0],
            [20.0, 5.0, 0.5],
            [20.0, 5.0, -7.9],
            [20.0, 5.0, 25.0],
            [20.0, 5.0, 30.0],
        ]
    );
    let feeds: Vec<_> = program.poses.iter().map(|pose| pose.feed).collect();
    assert_eq!((feeds[2], feeds[6], feeds[8]), (Some(364.49), Some(364.49), None));
    let lines: Vec<_> = program.poses.iter().map(|pose| pose.line).collect();
    assert_eq!(lines, [2, 5, 5, 5, 6, 6, 6, 6, 8]);
    // Each move of the cycle knows the line of the cycle.
    let call = program.poses[2].call;
    let calls: Vec<_> = program.calls_of(call).map(|call| call.line).collect();
    assert_eq!((calls, program.poses[8].call, program.calls.len()), (vec![4], None, 1));
}

#[test]
fn pecks() {
    let start = "RAPID\nGOTO/0,0,10\n";
    let deep = levels(&format!(
        "{start}CYCLE / DEEP, DEPTH, 3.5, STEP, 2.0, MMPM, 50.0, CLEAR, 4.0\nGOTO/0,0,0\n"
    ));
    let by_hand = [
        (10.0, true),
        (4.0, true),
        (-2.0, false),
        (4.0, true),
        (-1.0, true),
        (-3.5, false),
        (4.0, true),
    ];
    assert_eq!(deep, by_hand);
    let solidworks = levels(&format!(
        "{start}CYCLE/DEEP2,FEDTO,3.5,1STPECK,2.,SUBPECK,1.,MMPM,50.,RAPTO,4.,RTRCTO,10.\nGOTO/0,0,0\n"
    ));
    assert_eq!(
        solidworks
            .iter()
            .filter(|(_, rapid)| !rapid)
            .map(|(z, _)| *z)
            .collect::<Vec<_>>(),
        [-2.0, -3.0, -3.5]
    );
    let chips = levels(&format!(
        "{start}CYCLE/BRKCHP,DEPTH,3.5,STEP,2.0,MMPM,50,CLEAR,4\nGOTO/0,0,0\n"
    ));
    assert_eq!(chips[2..], [(-2.0, false), (-1.0, true), (-3.5, false), (4.0, true)]);
}

#[test]
fn levels_of_the_dialects() {
    let start = "RAPID\nGOTO/0,0,10\n";
    let of = |cycle: &str| levels(&format!("{start}{cycle}\nGOTO/0,0,0\n"))[1..].to_vec();
    // Creo: RAPTO is measured down from CLEAR; RETURN 0 is the level from where the tool came.
    assert_eq!(
        of("CYCLE/DRILL,DEPTH,5,MMPM,50,CLEAR,3,RAPTO,1,RETURN,0"),
        [(2.0, true), (-5.0, false), (10.0, true)]
    );
    // NX: a negative depth, and AUTO for the same level.
    assert_eq!(
        of("CYCLE/DRILL,RAPTO,3.0,FEDTO,-5.0,RTRCTO,AUTO,MMPM,250"),
        [(3.0, true), (-5.0, false), (10.0, true)]
    );
    // By position: depth, feed, clearance.
    assert_eq!(
        of("CYCLE/DRILL,5,MMPM,100,2"),
        [(2.0, true), (-5.0, false), (2.0, true)]
    );
    assert_eq!(
        of("CYCLE/DRILL,5,100,MMPM,2"),
        [(2.0, true), (-5.0, false), (2.0, true)]
    );
    // Taps leave the hole at their feed.
    assert_eq!(
        of("CYCLE/TAP,DEPTH,5,MMPM,50,CLEAR,2"),
        [(2.0, true), (-5.0, false), (2.0, false)]
    );
}

#[test]
fn below_the_rapid_level_the_tool_goes_up_first() {
    let text = "RAPID\nGOTO/0,0,1\nCYCLE/DRILL,DEPTH,5,MMPM,50,CLEAR,3\nGOTO/8,0,0\nGOTO/8,8,4\n";
    assert_eq!(
        tips(&read(text)),
        [
            [0.0, 0.0, 1.0],
            [0.0, 0.0, 3.0],
            [8.0, 0.0, 3.0],
            [8.0, 0.0, -5.0],
            [8.0, 0.0, 3.0],
            [8.0, 0.0, 7.0],
            [8.0, 8.0, 7.0],
            [8.0, 8.0, -1.0],
            [8.0, 8.0, 7.0],
        ]
    );
}

#[test]
fn along_a_tilted_axis() {
    let text = "RAPID\nGOTO/0,0,0,0,0.6,0.8\nCYCLE/DRILL,DEPTH,10,MMPM,50,CLEAR,5,DWELL,0.5\nGOTO/0,0,0\n";
    let program = read(text);
    let expected = [[0.0, 0.0, 0.0], [0.0, 3.0, 4.0], [0.0, -6.0, -8.0], [0.0, 3.0, 4.0]];
    for (found, expected) in tips(&program).iter().zip(expected) {
        assert!(
            found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12),
            "{found:?} {expected:?}"
        );
    }
    assert_eq!(program.poses.len(), 4);
    assert_eq!(program.events[0].kind, EventKind::Dwell { seconds: 0.5 });
    assert_eq!(program.events[0].pose, 3, "after the move down");
}

#[test]
fn rapids_within_a_cycle_drill_nothing() {
    let text = "RAPID\nGOTO/0,0,10\nCYCLE/DRILL,DEPTH,5,MMPM,50,CLEAR,3\nGOTO/0,0,0\nRAPID\nGOTO/9,9,20\nGOTO/9,9,0\nCYCLE/OFF\n\
                GOTO/0,0,0\nCYCLE/ON\nGOTO/1,1,0\n";
    let feeds = read(text).poses.iter().filter(|pose| !pose.rapid).count();
    assert_eq!(feeds, 4, "three holes and a plain move");
}
