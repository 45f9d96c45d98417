//! Arcs of the tip under tip control while an axis turns: the same from all controls.

use sweepsim_motion::TipCourse;
use sweepsim_nc::{Controller, Machine, NcError, Program, ReadOptions, gcode, heidenhain, siemens};

/// A quarter of a circle, in which B turns from 0° to 40°, and a helix of one and a half turns, in which it turns back and C turns on, in three languages.
fn programs(options: &ReadOptions) -> [(&'static str, Result<Program, NcError>); 3] {
    let mut fanuc = options.clone();
    fanuc.controller = Some(Controller::Fanuc);
    [
        (
            "Fanuc",
            gcode::read(
                "G21 G90 F500\nG43.4 H1\nG0 X20 Y0 Z5 B0 C0\nG1 Z0\nG3 X0 Y20 Z0 I-20 J0 B40\nG3 X0 Y-20 Z3 I0 J-20 P2 B0 C30\n",
                &fanuc,
            ),
        ),
        (
            "Siemens",
            siemens::read(
                "G90 F500\nTRAORI\nG0 X20 Y0 Z5 B0 C0\nG1 Z0\nG3 X0 Y20 Z0 I-20 J0 B40\nG3 X0 Y-20 Z3 I0 J-20 TURN=1 B0 C30\n",
                options,
            ),
        ),
        (
            "Heidenhain",
            heidenhain::read(
                "TOOL CALL Z F500\nM128\nL X+20 Y+0 Z+5 B+0 C+0 FMAX\nL Z+0\nCC X+0 Y+0\nC X+0 Y+20 Z+0 B+40 DR+\nCP IPA+540 Z+3 B+0 C+30 DR+\n",
                options,
            ),
        ),
    ]
}

#[test]
fn the_same_exact_poses_from_all_controls() {
    for machine in [None, Some("trunnion-bc"), Some("head-bc")] {
        let mut options = ReadOptions::default();
        options.exact_arcs = true;
        options.machine = machine.map_or_else(Machine::default, |name| Machine::named(name).unwrap());
        let mut expected: Option<Vec<_>> = None;
        for (control, program) in programs(&options) {
            let program = program.unwrap_or_else(|error| panic!("{control}: {error}"));
            let poses: Vec<_> = program
                .poses
                .iter()
                .map(|pose| (pose.pose.axis(), pose.way(), pose.rapid, pose.feed, pose.tip_control))
                .collect();
            assert_eq!(poses.len(), 4, "{machine:?} {control}");
            let arcs = poses
                .iter()
                .filter(|(_, way, ..)| matches!(way.course, TipCourse::Arc(_)));
            assert_eq!(arcs.count(), 2, "{machine:?} {control}");
            assert_eq!(
                *expected.get_or_insert_with(|| poses.clone()),
                poses,
                "{machine:?} {control}"
            );
            let tips = [[20.0, 0.0, 5.0], [20.0, 0.0, 0.0], [0.0, 20.0, 0.0], [0.0, -20.0, 3.0]];
            for (pose, tip) in program.poses.iter().zip(tips) {
                let near = |(a, b): (f64, f64)| (a - b).abs() < 1e-13;
                assert!(
                    pose.pose.tip().into_iter().zip(tip).all(near),
                    "{machine:?} {control}: {pose:?}"
                );
            }
        }
    }
}

/// Arcs whose axis turns have no cheap kind: they are chords unless all arcs are kept.
#[test]
fn chords_unless_all_arcs_are_kept() {
    let mut options = ReadOptions::default();
    (options.level_arcs, options.upright_arcs, options.tilted_arcs) = (true, true, true);
    options.arc_tolerance = 0.01;
    let counts = programs(&options).map(|(control, program)| {
        let program = program.unwrap_or_else(|error| panic!("{control}: {error}"));
        assert!(
            program
                .poses
                .iter()
                .all(|pose| !matches!(pose.way().course, TipCourse::Arc(_)))
        );
        program.poses.len()
    });
    assert!(
        counts[0] > 100 && counts.iter().all(|count| *count == counts[0]),
        "{counts:?}"
    );
}
