//! Tables are read back as written, and nothing that a reader gets makes it panic.

use sweepsim_motion::Pose;
use sweepsim_nc::{Machine, ProgramPose, ReadOptions, gcode, read_file, table, write};
use sweepsim_props::*;

fn length() -> impl Strategy<Value = f64> {
    prop_oneof![
        -1e3..1e3,
        (-1_000_000_i32..1_000_000).prop_map(|n| f64::from(n) * 1e-3),
        (-100_i32..100).prop_map(f64::from),
        Just(-0.0),
    ]
}

fn pose() -> impl Strategy<Value = ProgramPose> {
    let axis = (-1.0..1.0, -1.0..1.0, 0.1..1.0).prop_map(|(x, y, z)| [x, y, z]);
    let extras = (any::<bool>(), prop::option::of(1.0..1e4), prop::option::of(0_u32..20));
    ([length(), length(), length()], axis, extras).prop_map(|(tip, axis, (rapid, feed, tool))| {
        let mut pose = ProgramPose::new(Pose::new(tip, axis).unwrap(), 1);
        (pose.rapid, pose.feed, pose.tool) = (rapid, feed, tool);
        pose
    })
}

fn like(words: &'static [&'static str]) -> impl Strategy<Value = String> {
    let word = prop_oneof![
        prop::sample::select(words).prop_map(str::to_owned),
        "\\PC{0,3}",
        "[-0-9.eE+]{0,6}"
    ];
    collection::vec(word, 0..60).prop_map(|words| words.concat())
}

proptest! {
    #[test]
    fn tables_are_read_back(mut poses in collection::vec(pose(), 1..12)) {
        poses.dedup_by(|b, a| a.pose == b.pose && a.tool == b.tool);
        let mut bytes = Vec::new();
        table::write(&poses, &mut bytes).unwrap();
        let read = table::read(std::str::from_utf8(&bytes).unwrap(), 1.0).unwrap();
        prop_assert_eq!(read.poses.len(), poses.len());
        for (found, expected) in read.poses.iter().zip(&poses) {
            prop_assert_eq!(found.pose.tip(), expected.pose.tip());
            let (a, b) = (found.pose.axis(), expected.pose.axis());
            prop_assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-15));
            prop_assert_eq!((found.rapid, found.feed, found.tool), (expected.rapid, expected.feed, expected.tool));
        }
    }

    #[test]
    fn programs_are_read_back(points in collection::vec([length(), length(), length()], 1..20)) {
        let text: String = points.iter().map(|[x, y, z]| format!("G1 X{x} Y{y} Z{z}\n")).collect();
        let read = gcode::read(&text, &ReadOptions::default()).unwrap();
        let mut expected = points.clone();
        expected.dedup();
        let found: Vec<[f64; 3]> = read.poses.iter().map(|pose| pose.pose.tip()).collect();
        prop_assert_eq!(found, expected);
    }

    #[test]
    fn no_table_panics(text in like(&["x,y,z,i,j,k", ",rapid,feed,tool", "\n", ",", "0", "1", "\"", "NaN", "inf", " "]), unit in any::<f64>()) {
        let _ = table::read(&text, unit);
        let _ = table::read(&format!("x,y,z,i,j,k\n{text}"), 25.4);
    }

    #[test]
    fn no_program_panics(
        text in like(&["G0", "G1", "G2", "G3 ", "G10 L2", "G92", "G43.4", "M6", "T1", "X1", "Y", "Z0", "I1", "R2", "A90", "C1e", "\n", "\n", "#", "(", "/"]),
        tip_control in any::<bool>(),
        exact_arcs in any::<bool>(),
        arc_tolerance in prop_oneof![Just(1e-3), Just(0.0), Just(f64::NAN), Just(f64::INFINITY), Just(1e-300)],
    ) {
        let mut options = ReadOptions::default();
        options.machine = Machine::default().tip_control(tip_control);
        options.exact_arcs = exact_arcs;
        options.arc_tolerance = arc_tolerance;
        let _ = gcode::read(&text, &options);
        let _ = gcode::read(&format!("G0 X0 Y0 Z0\n{text}"), &options);
    }

    #[test]
    fn no_file_panics(bytes in collection::vec(any::<u8>(), 0..200), extension in prop::sample::select(&["csv", "nc", "apt", "x", ""][..])) {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join(format!("file.{extension}"));
        std::fs::write(&file, bytes).unwrap();
        if let Err(error) = read_file(&file, &ReadOptions::default()) {
            prop_assert_eq!(error.file(), Some(file.as_path()));
        }
    }
}

#[test]
fn units_must_be_positive() {
    let text = "x,y,z,i,j,k\n1,0,0,0,0,1\n";
    assert_eq!(table::read(text, 25.4).unwrap().poses[0].pose.tip()[0], 25.4);
    for unit in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(table::read(text, unit).is_err(), "{unit}");
    }
}

#[test]
fn moves_know_their_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("part.nc");
    std::fs::write(&file, "G0 X0 Y0 Z5\nG1 Z0 F100\n").unwrap();
    let program = read_file(&file, &ReadOptions::default()).unwrap();
    let last = program.poses.last().unwrap();
    assert_eq!((program.file_of(last), last.line), (Some(file.as_path()), 2));
}

#[test]
fn a_row_can_break_the_path() {
    let text = "x,y,z,i,j,k,break\n0,0,0,0,0,1,1\n1,0,0,0,0,1,\n1,0,0,0,0,1,1\n2,0,0,0,0,1,0\n3,0,0,0,0,1,true\n";
    let program = table::read(text, 1.0).unwrap();
    let joined: Vec<bool> = program.poses.iter().map(|pose| pose.joined).collect();
    assert_eq!(joined, [false, true, false, true, false]);
    let mut written = Vec::new();
    table::write(&program.poses, &mut written).unwrap();
    assert_eq!(
        table::read(std::str::from_utf8(&written).unwrap(), 1.0).unwrap().poses,
        program.poses
    );
    let error = table::read("x,y,z,i,j,k,break\n0,0,0,0,0,1,perhaps\n", 1.0).unwrap_err();
    assert_eq!(
        error.to_string(),
        "2:13: break is \"perhaps\", but must be 0, 1, true or false"
    );
}

#[test]
fn a_line_without_end_is_an_error_with_its_number() {
    let folder = tempfile::tempdir().unwrap();
    let long = "1".repeat(100_000);
    for (name, text) in [
        ("a.csv", format!("x,y,z,i,j,k\n0,0,0,0,0,1\n{long},0,0,0,0,1\n")),
        ("a.nc", format!("G21 G90\nG0 X0 Y0 Z5\nG1 X{long}\nM30\n")),
        ("a.cls", format!("UNITS/MM\nGOTO/0,0,0\nGOTO/{long},0,0\n")),
        (
            "a.h",
            format!("0 BEGIN PGM A MM\n1 L X+0 Y+0 Z+5 R0 FMAX\n2 L X+{long}\n"),
        ),
    ] {
        let file = folder.path().join(name);
        std::fs::write(&file, text).unwrap();
        let message = read_file(&file, &ReadOptions::default()).unwrap_err().to_string();
        assert!(
            message.contains(&format!("{name}:3:1: this line is longer than")),
            "{message}"
        );
        assert!(message.len() < 300, "{message}");
    }
}

#[test]
fn tables_in_text_and_from_readers_are_alike() {
    let text = "\u{feff}x,y,z,i,j,k,\"rapid\"\r\n\r\n0,0,5,0,0,1,1\r0, 1 ,5,0,0,1,\"0\"\n2,\"1\",5,0,0,1,";
    let program = table::read(text, 1.0).unwrap();
    let lines: Vec<usize> = program.poses.iter().map(|pose| pose.line).collect();
    assert_eq!(lines, [3, 4, 5]);
    for size in 1..40 {
        let reader = std::io::BufReader::with_capacity(size, text.as_bytes());
        assert_eq!(table::read_from(reader, 1.0).unwrap().poses, program.poses);
    }
    let bytes = [&b"x,y,z,i,j,k\n0,0,0,0,0,1\n0,\xc3\xa4,\xff,0,0,1\n"[..]].concat();
    let error = table::read_from(&bytes[..], 1.0).unwrap_err();
    assert_eq!(error.to_string(), "3:5: this is not a text file: expected UTF-8");
}

/// Feeds were left in inches beside lengths in millimetres, and those per revolution were taken for feeds per minute.
#[test]
fn feeds_of_programs_in_inches_are_in_millimetres() {
    let text = "G20 G0 X0 Y0 Z0\nG1 X1 F10\nG95 X2 F0.01\nG93 X3 F2\nG94 G4 P1\nX4 F20\n";
    let program = gcode::read(text, &ReadOptions::default()).unwrap();
    let mut written = Vec::new();
    let lost = table::write_program(&program, &mut written).unwrap();
    assert_eq!(
        lost,
        [
            "feeds per revolution",
            "feeds in inverse time",
            "spindle, coolant, dwells, stops and messages"
        ]
    );
    let text = String::from_utf8(written).unwrap();
    let feeds = |unit: f64| -> Vec<Option<f64>> {
        let read = table::read(&text, unit).unwrap();
        read.poses.iter().map(|pose| pose.feed).collect()
    };
    assert_eq!(feeds(1.0), [None, Some(254.0), None, None, Some(508.0)]);
    // A table in inches.
    assert_eq!(feeds(25.4)[1], Some(254.0 * 25.4));
    let mut written = Vec::new();
    write::canonical(&program, &mut written).unwrap();
    let text = String::from_utf8(written).unwrap();
    for line in [
        "feed 254 (25.4 0 0)",
        "feed 0.254/rev (50.8 0 0)",
        "feed 2 inverse",
        "feed 508 (101.6 0 0)",
    ] {
        assert!(text.contains(line), "{line}\n{text}");
    }
}
