//! Programs as machines run them: rotary axes at constant speed, and arcs that stay arcs.

use std::f64::consts::{PI, TAU};

use sweepsim_motion::{TipCourse, Turning};
use sweepsim_nc::{AxisFault, AxisLaw, Machine, ReadOptions, check, gcode};

const PROGRAM: &str =
    "G21 G90 M428\nG0 X0 Y0 Z5 A0 C0\nG1 X10 A30 C350 F200\nG17 G3 X10 Y20 I0 J10 C700\nG2 X10 Y20 I1 J0\n";

#[test]
fn programs_as_machines_run_them() {
    let mut options = ReadOptions::default();
    options.law = AxisLaw::Rotary;
    options.exact_arcs = true;
    let program = gcode::read(PROGRAM, &options).unwrap();
    let ways: Vec<_> = program.poses.iter().map(|pose| pose.way()).collect();
    assert_eq!(ways.len(), 4, "nothing is divided");
    let turned = |k: usize| match ways[k].turning {
        Turning::Rotary { from, to, .. } => (from, to),
        other => panic!("{other:?}"),
    };
    assert_eq!(turned(1), ([0.0, 0.0], [30.0, 350.0]));
    assert_eq!(turned(2), ([30.0, 350.0], [30.0, 700.0]));
    match (ways[2].course, ways[3].course) {
        (TipCourse::Arc(half), TipCourse::Arc(full)) => {
            assert!((half.angle() - PI).abs() < 1e-12 && (full.angle() + TAU).abs() < 1e-12);
            assert_eq!(half.centre(), [10.0, 10.0, 5.0]);
        }
        other => panic!("{other:?}"),
    }
    // By default: chords, and intermediate poses where the axis turns far.
    let plain = gcode::read(PROGRAM, &ReadOptions::default()).unwrap();
    assert!(
        plain.poses.len() > 20
            && plain
                .poses
                .iter()
                .all(|pose| pose.way() == sweepsim_motion::Move::default())
    );
    // The other planes go round their own axes, the right-handed way.
    for (plane, normal) in [
        ("G18 G3 X0 Z10 I-5 K5", [0.0, 1.0, 0.0]),
        ("G19 G3 Y10 Z10 J5 K5", [1.0, 0.0, 0.0]),
    ] {
        let text = format!("G21 G90\nG0 X0 Y0 Z0\nG1 Z0.5\nG1 Z0\n{plane}\n");
        let program = gcode::read(&text, &options).unwrap();
        let way = program.poses[program.poses.len() - 1].way();
        assert!(matches!(way.course, TipCourse::Arc(arc) if arc.normal() == normal && arc.angle() > 0.0));
    }
}

/// Times by hand: trapezoids, triangles, slow axes and feeds of all kinds.
#[test]
fn moves_take_as_long_as_their_feeds_and_axes() {
    let text = r#"Machine(
        name: "slow",
        table: [(letter: 'C', axis: (0, 0, 1), speed: 3600, acceleration: 120)],
        linear: [
            (letter: 'X', speed: 6000, acceleration: 1000),
            (letter: 'Y', speed: 12000, acceleration: 500),
            (letter: 'Z', speed: 600),
        ],
    )"#;
    let mut options = ReadOptions::default();
    options.machine = Machine::read(text).unwrap();
    let program = "G21 G90\nT1 M6\nG0 X0 Y0 Z0 C0\nX100\nX102\nX0 Y400\nG1 Z-30 F1200\nG93 X10 F2\nG94 G4 P1.5\nG95 S1000 M3 G1 X20 F0.1\nG94 G0 C90\n";
    let program = gcode::read(program, &options).unwrap();
    let times = program.times();
    let expected = [
        // 100 mm/s after 0.1 s and 5 mm; the same at the end.
        0.2 + 90.0 / 100.0,
        // 2 mm never reach it: twice √(1 mm · 2 / 1000).
        2.0 * 0.002_f64.sqrt(),
        // Y last: 200 mm/s after 0.4 s and 40 mm.
        0.8 + 320.0 / 200.0,
        // Z at its largest 10 mm/s.
        3.0,
        // Half a minute by inverse time: at 1/3 mm/s from the corner on, which is fast enough, to rest for the dwell.
        30.0 + 0.5 / 3.0 / 1000.0,
        // 100 mm/min, from rest to rest.
        6.0 + 100.0 / 60.0 / 1000.0,
        // 60 degrees per second after half a second and 15 degrees.
        1.0 + 60.0 / 60.0,
    ];
    let found: Vec<f64> = times[1..].iter().filter_map(|time| time.seconds).collect();
    // The turn, without tip control, is made of chords.
    let (straight, chords) = found.split_at(6);
    assert!(chords.len() > 10);
    let found = [straight, &[chords.iter().sum()]].concat();
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
    assert_eq!(times.iter().map(|time| time.rest).sum::<f64>(), 1.5);
    assert!(times.iter().all(|time| !time.assumed));
}

/// The Hurco keeps its rates when it gets sizes, and they give times by hand.
#[test]
fn the_hurco_has_the_rates_of_its_log() {
    let seconds = |name: &str| {
        let mut options = ReadOptions::default();
        options.machine = Machine::named(name).unwrap();
        let text = "G21 G90\nT1 M6\nG0 X0 Y0 Z0\nG1 X32 F1920\nG0 Y-180\n";
        let program = gcode::read(text, &options).unwrap();
        let last = program.times().split_off(program.poses.len() - 2);
        [0, 1].map(|k| last[k].seconds.unwrap())
    };
    // 32 mm/s after 0.1 s, on average over 0.059 s; a rapid reaches 338.67 mm/s after 0.24 s and 41 mm.
    let v = 20_320.0 / 60.0;
    let expected = [1.0 + 0.1 + 0.059, 180.0 / v + v / 1400.0 + 0.059];
    for name in ["hurco-04", "hurco-04,table=320,travel=500x400x400", "3-axis"] {
        let found = seconds(name);
        let same = (0..2).all(|k| (found[k] - expected[k]).abs() < 1e-9);
        assert_eq!(same, name != "3-axis", "{name} {found:?} {expected:?}");
    }
}

#[test]
fn an_unknown_machine_names_the_ready_ones() {
    let error = Machine::read_file("hexapod".as_ref()).unwrap_err().to_string();
    assert!(
        error.contains("no such file") && error.contains("trunnion-ac"),
        "{error}"
    );
}

/// The feed of rotary axes that move alone counts degrees, in inches too, wherever that takes the tip.
#[test]
fn turns_of_the_table_take_as_long_as_their_degrees() {
    let text = r#"Machine(name: "slow", table: [(letter: 'C', axis: (0, 0, 1), speed: 600)])"#;
    let mut options = ReadOptions::default();
    options.machine = Machine::read(text).unwrap();
    for (units, x) in [("G21", 50.8), ("G20", 2.0)] {
        let program = format!("{units} G90\nT1 M6\nG0 X{x} Y0 Z0 C0\nG1 C180 F360\nC0 F1200\n");
        let program = gcode::read(&program, &options).unwrap();
        let seconds = |line: usize| -> f64 {
            let times = program.times();
            let all = program.poses.iter().zip(&times).filter(|(pose, _)| pose.line == line);
            all.filter_map(|(_, time)| time.seconds).sum()
        };
        assert!((seconds(4) - 30.0).abs() < 1e-9, "{units}: {}", seconds(4));
        // Twice as fast as the axis can be.
        assert!((seconds(5) - 18.0).abs() < 1e-9, "{units}: {}", seconds(5));
        let slow = check(&program, options.machine.kinematics.as_ref().unwrap());
        assert!(!slow.is_empty() && slow.iter().all(|own| own.line == 5), "{slow:?}");
        assert!(
            slow.iter().all(|own| matches!(own.fault, AxisFault::Speed { letter: 'C', needed, .. } if (needed - 1200.0).abs() < 1e-6)),
            "{slow:?}"
        );
    }
}

/// A feed in inverse time is that of its block: each chord took as long as all of them should.
#[test]
fn chords_share_the_time_of_their_block() {
    let mut options = ReadOptions::default();
    options.machine = Machine::named("trunnion-ac").unwrap();
    let text = "G21 G90\nT1 M6\nG0 X20 Y0 Z0 A0 C0\nG93 G1 X25 C90 F2\nX20 C0 A30 F3\nG18 G2 X30 I5 K0 F1\nG1 A0 F4\n";
    for exact_arcs in [false, true] {
        options.exact_arcs = exact_arcs;
        let program = gcode::read(text, &options).unwrap();
        let times = program.times();
        for (line, expected) in [(4, 30.0), (5, 20.0), (6, 60.0), (7, 15.0)] {
            let all = program.poses.iter().zip(&times).filter(|(pose, _)| pose.line == line);
            let seconds: f64 = all.filter_map(|(_, time)| time.seconds).sum();
            assert!((seconds - expected).abs() < 1e-9, "line {line}: {seconds}");
        }
    }
}

/// Of two lengths of one tool, neither is the right one.
#[test]
fn a_second_length_of_a_tool_is_an_error() {
    let text = "Machine(name: \"x\", tool_lengths: {1: 80, 2: 90, 1: 120})";
    let error = Machine::read(text).unwrap_err().to_string();
    assert!(error.contains("a second 1: expected each once"), "{error}");
}
