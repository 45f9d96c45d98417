//! Spindle, coolant, dwells, stops, messages and feeds, in their order.

use sweepsim_nc::{Controller, FeedMode, Program, ReadOptions, Units, gcode};

use super::{options, program, program_with, tips};

#[test]
fn events_in_order() {
    let found = program(
        "%\nO7 (BRACKET)\nG21 T3 M6\nS8000 M3 M8\nG0 X0 Y0 Z5\n(MSG, clamp now)\nM0\nG4 P1.5\nG1 Z-1 F100\nS9000\nM5 M9\nM1\nM30\n",
    );
    let events: Vec<String> = found
        .events
        .iter()
        .map(|event| format!("{}:{} {:?}", event.pose, event.line, event.kind))
        .collect();
    assert_eq!(
        events,
        [
            "0:3 ToolChange(3)",
            "0:4 Spindle(Clockwise { rpm: Some(8000.0) })",
            "0:4 Coolant(Flood)",
            "1:6 Message(\"clamp now\")",
            "1:7 Stop",
            "1:8 Dwell { seconds: 1.5 }",
            "2:10 Spindle(Clockwise { rpm: Some(9000.0) })",
            "2:11 Spindle(Stopped)",
            "2:11 Coolant(Off)",
            "2:12 OptionalStop",
        ]
    );
    assert_eq!(found.title.as_deref(), Some("BRACKET"));
    assert_eq!(found.units, Units::Mm);
    assert_eq!(program("G20 G0 X1 Y0 Z0").units, Units::Inch);
    // Compensated moves wait for the next one; what comes between them stays there.
    let found = program("G0 X-9 Y0 Z0\nG41.1 D2\nG1 X0 Y0 F9\nX10\nM8\nY10\nG40\nG1 X0\n");
    let event = &found.events[0];
    assert_eq!((event.pose, event.line), (3, 5));
}

#[test]
fn feeds_keep_their_mode() {
    let found = program("G0 X0 Y0 Z0\nG94 G1 X1 F100\nG95 X2 F0.1\nG93 X3 F2\nG0 X4");
    let feeds: Vec<(Option<f64>, FeedMode)> = found.poses[1..]
        .iter()
        .map(|pose| (pose.feed, pose.feed_mode))
        .collect();
    assert_eq!(
        feeds,
        [
            (Some(100.0), FeedMode::PerMinute),
            (Some(0.1), FeedMode::PerRevolution),
            (Some(2.0), FeedMode::InverseTime),
            (None, FeedMode::InverseTime),
        ]
    );
}

/// Feeds are in the unit in effect where they are given, whatever the unit of the first move is.
#[test]
fn feeds_after_a_change_of_units() {
    let text =
        "G21 G0 X0 Y0 Z0\nG1 X1 F50.8\nG20 G1 X1 F2\nG93 X2 F3\nG95 S100 M3 X3 F0.1\nG21 G94 X4 F6\nG33.1 Z-1 K2";
    let feeds = |text: &str| -> Vec<f64> { program(text).poses.iter().filter_map(|pose| pose.feed).collect() };
    assert_eq!(feeds(text), [50.8, 2.0 * 25.4, 3.0, 0.1 * 25.4, 6.0, 2.0, 2.0]);
    let seconds: Vec<f64> = program("G20 G0 X0 Y0 Z0\nG1 X1 F10\nG21 X50.8 F25.4\nG20 X3\n")
        .times()
        .iter()
        .skip(1)
        .filter_map(|time| time.seconds)
        .collect();
    let expected = [6.0, 60.0, 60.0];
    assert!(
        seconds.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9),
        "{seconds:?}"
    );
}

#[test]
fn optional_blocks() {
    let text = "G0 X0 Y0 Z0\n/G1 X5\nG1 Y1";
    assert_eq!(tips(&program(text)).len(), 3);
    let mut skip = ReadOptions::default();
    skip.block_delete = true;
    assert_eq!(tips(&program_with(text, &skip)), [[0.0; 3], [0.0, 1.0, 0.0]]);
}

#[test]
fn lenient_reading_lists_what_it_leaves_out() {
    let text = "G0 X0 Y0 Z5\nG1 X1\nG60 X9 Y9\nX2\nG1 Y3\nG0 X4 Y4 Z4\nG1 X5\n";
    assert!(gcode::read(text, &ReadOptions::default()).is_err());
    let mut lenient = ReadOptions::default();
    lenient.lenient = true;
    let found = program_with(text, &lenient);
    assert_eq!(
        tips(&found),
        [[0.0, 0.0, 5.0], [1.0, 0.0, 5.0], [4.0, 4.0, 4.0], [5.0, 4.0, 4.0]]
    );
    // The path breaks where something is missing, and every line without its move is noted.
    assert_eq!(found.sections().map(<[_]>::len).collect::<Vec<_>>(), [2, 2]);
    let notes: Vec<String> = found.notes.iter().map(ToString::to_string).collect();
    assert_eq!(
        notes,
        [
            "line 3: left out: G60: single-direction positioning is not supported yet: the path of the tool would be unknown; expected G0, G1, G2 or G3",
            "line 4: left out: a move after a problem, until its kind is known again",
            "line 5: left out: a move after a problem, until its start is known again",
        ]
    );
    // A program without any move that can be read is empty, and says why.
    let found = program_with("G60 X1\nG60 X2", &lenient);
    assert!(found.poses.is_empty() && found.notes.len() == 1);
}

#[test]
fn settings_of_grbl() {
    let found = program_with("$21=1\n$X\nG21\nG0 X0 Y0 Z5\nG1 X1 F100\n", &options(Controller::Grbl));
    assert_eq!(found.poses.len(), 2);
    assert!(found.notes[0].message.contains("settings of the control"));
    // Homing moves the axes: nothing is known of where the tool is after it.
    let found = program("G0 X0 Y0 Z5\nG1 X1 F100\n$H\nG0 X0 Y0 Z5\nG1 X2");
    assert_eq!(found.sections().count(), 2);
    assert!(gcode::read("G0 X0 Y0 Z0\n$J=G91 X5 F10", &ReadOptions::default()).is_err());
}

/// A loop of a few lines may repeat a long text as often as blocks may be executed.
#[test]
fn the_text_of_messages_is_bounded() {
    let text = format!(
        "G0 X0 Y0 Z0\n#1=0\nN1 (MSG, {})\n#1=[#1+1]\nIF [#1 LT 160000] GOTO 1\n",
        "a".repeat(480)
    );
    let program = gcode::read(&text, &ReadOptions::default()).unwrap();
    assert_eq!(program.events.len(), (64 << 20) / 480);
    let notes: Vec<String> = program.notes.iter().map(ToString::to_string).collect();
    assert_eq!(
        notes,
        ["line 3: a message beyond 64 MiB of them, or among too many events: left out (20190 times, first here)"]
    );
}

/// Dwells after the last move belong to no move, but to its tool.
#[test]
fn dwells_after_the_last_move_count() {
    let found = program("G21\nT1 M6\nG0 X0 Y0 Z0\nG1 X100 F600\nG4 P2\nX0\nG4 P3\nM9\nG4 P4\nM30\n");
    assert_eq!(found.rest_at_end(), 7.0);
    assert_eq!(found.times().iter().map(|time| time.rest).sum::<f64>(), 2.0);
    assert_eq!(found.usage()[0].seconds, 10.0 + 2.0 + 10.0 + 7.0);
}

/// One note, at the first move that has no feed to move at.
#[test]
fn feeds_must_be_positive() {
    let said = |found: Program| {
        let notes = found.notes.iter().map(ToString::to_string);
        notes.filter(|note| note.contains("not above 0")).collect::<Vec<_>>()
    };
    let expected = |line: usize, times: &str| {
        [format!(
            "line {line}: the feed is not above 0: the control stops here, and the time of the move is not known{times}"
        )]
    };
    let read = |text: &str| said(program_with(text, &options(Controller::Fanuc)));
    assert_eq!(
        read("G0 X0 Y0 Z0\nF-5\nG1 X1\nX2 F0\nX3 F9\n"),
        expected(3, " (2 times, first here)")
    );
    assert_eq!(read("G0 X0 Y0 Z0 F0\nX5\nG1 X1 F9\n"), [""; 0]);
    let siemens = "N10 G0 X0 Y0 Z0\nN20 G1 X1 F0\n";
    assert_eq!(
        said(sweepsim_nc::siemens::read(siemens, &ReadOptions::default()).unwrap()),
        expected(2, "")
    );
    let klartext = "BEGIN PGM A MM\nL X+0 Y+0 Z+0 R0 FMAX\nL X+5 F0\nEND PGM A MM\n";
    assert_eq!(
        said(sweepsim_nc::heidenhain::read(klartext, &ReadOptions::default()).unwrap()),
        expected(3, "")
    );
}
