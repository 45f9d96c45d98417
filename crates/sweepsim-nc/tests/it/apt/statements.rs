//! The meaning of statements, one by one.

use super::{exact, notes, read, tips};
use sweepsim_nc::{Coolant, EventKind, FeedMode, ReadOptions, Spindle, Units, apt};

#[test]
fn points_and_axes() {
    let program = read("GOTO/1,2,3\nGOTO/4,5,6,0,3,4\n  goto / 7., $\n 8., 9.\nGODLTA/1,1,1\nGODLTA/-5\n");
    assert_eq!(
        tips(&program),
        [
            [1.0, 2.0, 3.0],
            [4.0, 5.0, 6.0],
            [7.0, 8.0, 9.0],
            [8.0, 9.0, 10.0],
            [8.0, 6.0, 6.0]
        ]
    );
    let axes: Vec<_> = program.poses.iter().map(|pose| pose.pose.axis()).collect();
    assert_eq!((axes[0], axes[1]), ([0.0, 0.0, 1.0], [0.0, 0.6, 0.8]));
    assert!(axes[2..].iter().all(|axis| *axis == axes[1]), "the axis is modal");
    let lines: Vec<_> = program.poses.iter().map(|pose| pose.line).collect();
    assert_eq!(lines, [1, 2, 3, 5, 6]);
    assert_eq!(notes(&program), ["a tool axis is not of unit length: normalised"]);
}

#[test]
fn rapid_is_for_one_move() {
    let program =
        read("FEDRAT/400.0,MMPM\nRAPID/\nGOTO/0,0,5\nGOTO/0,0,0\nFEDRAT/MMPR,0.25\nGOTO/1,0,0\nRAPID\nGODLTA/0,0,1\n");
    let rapid: Vec<_> = program.poses.iter().map(|pose| pose.rapid).collect();
    assert_eq!(rapid, [true, false, false, true]);
    let feeds: Vec<_> = program.poses.iter().map(|pose| (pose.feed, pose.feed_mode)).collect();
    assert_eq!(feeds[1], (Some(400.0), FeedMode::PerMinute));
    assert_eq!(feeds[2], (Some(0.25), FeedMode::PerRevolution));
    assert_eq!(feeds[3].0, None);
}

#[test]
fn units() {
    let program = read("UNITS/INCHES\nFEDRAT/254,MMPM\nRAPID\nGOTO/1,2,3\nGOTO/1,2,0\n");
    assert_eq!(tips(&program)[0], [25.4, 50.8, 3.0 * 25.4]);
    assert_eq!((program.units, program.poses[1].feed), (Units::Inch, Some(10.0)));
    // Without a statement the feeds tell.
    let program = read("GOTO/1,0,0\nFEDRAT/IPM,10\nGOTO/2,0,0\n");
    assert_eq!((tips(&program)[0], program.units), ([25.4, 0.0, 0.0], Units::Inch));
    assert_eq!(notes(&program), ["no units are given: inches, as in the feeds"]);
    let mut options = ReadOptions::default();
    options.inch = true;
    let program = apt::read("GOTO/1,0,0\nFEDRAT/MMPM,10\nGOTO/2,0,0\n", &options).unwrap();
    assert_eq!(tips(&program)[0], [1.0, 0.0, 0.0]);
    assert_eq!(tips(&apt::read("GOTO/1,0,0\n", &options).unwrap())[0], [25.4, 0.0, 0.0]);
    assert_eq!(tips(&read("UNIT/CM\nGOTO/1,0,0\n"))[0], [10.0, 0.0, 0.0]);
}

#[test]
fn from_and_home_break_the_path() {
    let program = read("FROM/0,0,50\nRAPID\nGOTO/1,0,5\nGOTO/1,0,0\nGOHOME\nRAPID\nGOTO/9,9,9\n");
    let joined: Vec<_> = program.poses.iter().map(|pose| pose.joined).collect();
    assert_eq!(joined, [false, true, true, false]);
    assert_eq!(program.sections().count(), 2);
    assert_eq!(program.notes[0].line, 5);
}

#[test]
fn frames_are_converted_to_the_first() {
    // The second system is turned by 90° about z and shifted.
    let text = "MSYS/10,0,0,1,0,0,0,1,0\nGOTO/1,2,3,1,0,0\nMSYS/0,5,0,0,1,0,-1,0,0\nGOTO/1,2,3,1,0,0\n";
    let program = read(text);
    // (1, 2, 3) in the second is (0, 5, 0) + (-2, 1, 3) in the file, and (-12, 6, 3) in the first.
    assert_eq!(tips(&program), [[1.0, 2.0, 3.0], [-12.0, 6.0, 3.0]]);
    assert_eq!(program.poses[1].pose.axis(), [0.0, 1.0, 0.0]);
    assert_eq!(
        notes(&program),
        ["another MSYS: coordinates are converted to that of the first one"]
    );
    // Coordinates of the world do not depend on CSYS.
    let program = read("TRNTYP/WORLD,0,0,0\nCSYS/0,1,0,5,-1,0,0,0,0,0,1,0\nGOTO/1,2,3\n");
    assert_eq!((tips(&program)[0], program.notes.len()), ([1.0, 2.0, 3.0], 0));
}

#[test]
fn events_titles_and_stock() {
    let text = "PARTNO bracket / 7\nINSERT/Stock Size X313.08 Y100. Z9.\nLOAD/TOOL,2,ADJUST,2\nSPINDL/2200,RPM,CLW\nCOOLNT/FLOOD\n\
                PPRINT hello, world\nGOTO/0,0,0\nDELAY/1.5\nSPINDL/OFF\nCOOLNT/OFF\nOPSTOP\nFINI\nGOTO/1,1,1\n";
    let program = read(text);
    assert_eq!(
        (program.title.as_deref(), program.poses.len()),
        (Some("bracket / 7"), 1)
    );
    assert_eq!(
        program.stock,
        Some(sweepsim_nc::StockDescription::Size([313.08, 100.0, 9.0]))
    );
    let kinds: Vec<_> = program
        .events
        .iter()
        .map(|event| (event.pose, event.line, event.kind.clone()))
        .collect();
    assert_eq!(
        kinds,
        [
            (0, 3, EventKind::ToolChange(2)),
            (0, 4, EventKind::Spindle(Spindle::Clockwise { rpm: Some(2200.0) })),
            (0, 5, EventKind::Coolant(Coolant::Flood)),
            (0, 6, EventKind::Message("hello, world".into())),
            (1, 8, EventKind::Dwell { seconds: 1.5 }),
            (1, 9, EventKind::Spindle(Spindle::Stopped)),
            (1, 10, EventKind::Coolant(Coolant::Off)),
            (1, 11, EventKind::OptionalStop),
        ]
    );
}

#[test]
fn harmless_statements_are_silent_and_unknown_ones_noted() {
    let text = "TOOL PATH/CAVITY_MILL,TOOL,MILL\nPAINT/PATH\nPAINT/SPEED,10\nMULTAX/ON\nMACHIN/UNCX01,1\nSELECT/TOOL,16\nGOTO/0,0,0\n\
                ROTATE/TABLE,90\nWIBBLE/5\nWIBBLE/6\nSETUP/1,2\nEND-OF-PATH\nFINI\n";
    assert_eq!(
        notes(&read(text)),
        [
            "ROTATE: the tool axes of GOTO say how the part is turned; ignored",
            "WIBBLE is not understood: ignored (2 times, first here)",
            "SETUP is for the post-processor: ignored",
        ]
    );
}

#[test]
fn curves() {
    // A parabola from (0, 0) over (1, 2) to (2, 0): y = 2 x (2 - x) / 2.
    let text = "GOTO/0,0,0\nNURBS/\nKNOT/0,0,0\nKNOT/1,1,1\nCNTRL/0,0,0\nCNTRL/1,2,0\nCNTRL/2,0,0\nGOTO/3,0,0\n";
    let program = read(text);
    let points = tips(&program);
    assert_eq!((points[0], points[points.len() - 1]), ([0.0; 3], [3.0, 0.0, 0.0]));
    assert!(points.len() > 20);
    for pair in points[..points.len() - 1].windows(2) {
        let [a, b] = [pair[0], pair[1]];
        assert!((b[1] - b[0] * (2.0 - b[0])).abs() < 1e-12);
        let (x, y) = (0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]));
        assert!((y - x * (2.0 - x)).abs() <= 1e-3, "the chord at {x} is too far");
    }
    assert!(notes(&program).contains(&"NURBS curves are divided into chords"));
}

#[test]
fn several_points_on_an_arc() {
    // Creo with points and arc: the last one is the end.
    let text = "GOTO / 10, 0, 0\nCIRCLE / 0, 0, 0, 0, 0, 1, 10\nGOTO / 7.0710678, 7.0710678, 0\n0, 10, 0, $\n-7.0710678, 7.0710678, 0\nGOTO/0,0,0\n";
    let program = exact(text);
    assert_eq!(
        tips(&program),
        [[10.0, 0.0, 0.0], [-7.071_067_8, 7.071_067_8, 0.0], [0.0; 3]]
    );
}

#[test]
fn lenient_reading_lists_what_it_left_out() {
    let mut options = ReadOptions::default();
    options.lenient = true;
    let program = apt::read("GOTO/0,0,0\nCOPY/1,3\nGOTO/1,0,0\n", &options).unwrap();
    assert_eq!(
        program.sections().count(),
        2,
        "the path breaks where something was left out"
    );
    assert!(
        program.notes[0]
            .message
            .starts_with("left out: copies of the path are not supported yet")
    );
    assert!(apt::read("PL1=PLANE/0,0,1,0\nGOTO/0,0,0\n", &options).is_err());
}
