//! Programs as machines run them: rotary axes at constant speed, and arcs that stay arcs.

use std::f64::consts::{PI, TAU};

use sweepsim_motion::{Course, Turning};
use sweepsim_nc::{AxisLaw, ReadOptions, gcode};

const PROGRAM: &str =
    "G21 G90 M428\nG0 X0 Y0 Z5 A0 C0\nG1 X10 A30 C350 F200\nG17 G3 X10 Y20 I0 J10 C700\nG2 X10 Y20 I1 J0\n";

#[test]
fn programs_as_machines_run_them() {
    let mut options = ReadOptions::default();
    options.law = AxisLaw::Rotary;
    options.exact_arcs = true;
    let program = gcode::read(PROGRAM, &options).unwrap();
    let ways: Vec<_> = program.poses.iter().map(|pose| pose.way).collect();
    assert_eq!(ways.len(), 4, "nothing is divided");
    let turned = |k: usize| match ways[k].turning {
        Turning::Rotary { from, to, .. } => (from, to),
        other => panic!("{other:?}"),
    };
    assert_eq!(turned(1), ([0.0, 0.0], [30.0, 350.0]));
    assert_eq!(turned(2), ([30.0, 350.0], [30.0, 700.0]));
    match (ways[2].course, ways[3].course) {
        (Course::Arc(half), Course::Arc(full)) => {
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
                .all(|pose| pose.way == sweepsim_motion::Move::default())
    );
    // The other planes go round their own axes, the right-handed way.
    for (plane, normal) in [
        ("G18 G3 X0 Z10 I-5 K5", [0.0, 1.0, 0.0]),
        ("G19 G3 Y10 Z10 J5 K5", [1.0, 0.0, 0.0]),
    ] {
        let text = format!("G21 G90\nG0 X0 Y0 Z0\nG1 Z0.5\nG1 Z0\n{plane}\n");
        let program = gcode::read(&text, &options).unwrap();
        let way = program.poses[program.poses.len() - 1].way;
        assert!(matches!(way.course, Course::Arc(arc) if arc.normal() == normal && arc.angle() > 0.0));
    }
}
