//! The move that turns the tool into a tilted plane: the linear axes of a known machine stand still.

use nalgebra::Vector3;
use sweepsim_motion::TipCourse;
use sweepsim_nc::{Machine, NcError, Position, Program, ReadOptions, check, gcode, heidenhain, siemens, write};
use sweepsim_props::*;

fn options(name: &str) -> ReadOptions {
    let mut options = ReadOptions::default();
    options.machine = Machine::named(name).unwrap();
    options.arc_tolerance = 0.01;
    options
}

/// The same part of a program in three languages: a start, a turn by Rz(turn) Ry(tilt), and a point in the plane.
fn programs(
    start: [f64; 3],
    tilt: f64,
    turn: f64,
    options: &ReadOptions,
) -> Vec<(&'static str, Result<Program, NcError>)> {
    let [x, y, z] = start;
    let normal = [
        tilt.to_radians().sin() * turn.to_radians().cos(),
        tilt.to_radians().sin() * turn.to_radians().sin(),
        tilt.to_radians().cos(),
    ];
    let (about_x, about_y) = (
        (-normal[1]).atan2(normal[2]).to_degrees(),
        normal[0].asin().to_degrees(),
    );
    vec![
        (
            "G68.2",
            gcode::read(
                &format!(
                    "G0 X{x} Y{y} Z{z}\nG68.2 X0 Y0 Z0 I{} J{tilt} K0\nG53.1\nG0 X1 Y2 Z30\n",
                    turn + 90.0
                ),
                options,
            ),
        ),
        (
            "CYCLE800",
            siemens::read(
                &format!(
                    "T1 D1\nG0 X{x} Y{y} Z{z}\nCYCLE800(0,\"\",0,57,0,0,0,{about_x},{about_y},0,0,0,0,1)\nG0 X1 Y2 Z30\n"
                ),
                options,
            ),
        ),
        (
            "PLANE",
            heidenhain::read(
                &format!(
                    "TOOL CALL 1 Z\nL X{x:+} Y{y:+} Z{z:+} FMAX\nPLANE SPATIAL SPA+0 SPB{tilt:+} SPC{turn:+} TURN FMAX\nL X+1 Y+2 Z+30 FMAX\n"
                ),
                options,
            ),
        ),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn the_axes_stand_still_while_the_tool_turns(
        start in prop::array::uniform3(-50.0..50.0_f64),
        tilt in 5.0..60.0_f64,
        turn in -170.0..170.0_f64,
        name in prop::sample::select(vec!["trunnion-ac", "trunnion-bc", "head-bc", "head-b-table-c", "nutating-head-bc"]),
    ) {
        let options = options(name);
        let machine = options.machine.kinematics.clone().unwrap();
        for (language, read) in programs(start, tilt, turn, &options) {
            let program = read.unwrap_or_else(|error| panic!("{language}: {error}"));
            // One path, without a break.
            prop_assert!(program.poses[1..].iter().all(|pose| pose.joined), "{name}, {language}");
            let length = machine.tool_length(program.poses[0].tool);
            let last = program.poses.len() - 1;
            let end = &program.positions[last - 1];
            // The turn ends with the axes where they were, and the tool across the plane.
            for k in 0..3 {
                prop_assert!((end.xyz[k] - start[k]).abs() < 1e-9, "{name}, {language}: {end:?}");
            }
            let axis: [f64; 3] = program.poses[last - 1].pose.axis();
            let (st, ct) = tilt.to_radians().sin_cos();
            let normal = Vector3::new(st * turn.to_radians().cos(), st * turn.to_radians().sin(), ct);
            prop_assert!((Vector3::from(axis) - normal).norm() < 1e-9);
            // Each pose on the way is the machine's, by its forward chain, with the axes still and the angles in proportion.
            for pose in 1..last {
                let at: &Position = &program.positions[pose];
                prop_assert!((Vector3::from(at.xyz) - Vector3::from(start)).norm() < 1e-9);
                let expected: [f64; 3] = machine.pose(at, length).unwrap().tip();
                let tip: [f64; 3] = program.poses[pose].pose.tip();
                prop_assert!((Vector3::from(expected) - Vector3::from(tip)).norm() < 1e-9, "{name}, {language}");
                prop_assert!(program.poses[pose].rapid && !program.poses[pose].tip_control);
            }
            prop_assert!(check(&program, &machine).iter().all(|finding| finding.line > 0));
        }
    }
}

#[test]
fn without_a_machine_the_path_breaks() {
    for (language, read) in programs([1.0, 2.0, 30.0], 30.0, 40.0, &ReadOptions::default()) {
        let program = read.unwrap();
        assert!(program.poses.iter().skip(1).any(|pose| !pose.joined), "{language}");
        assert!(
            program
                .notes
                .iter()
                .any(|note| note.message.contains("the path breaks here")),
            "{language}"
        );
    }
}

#[test]
fn posted_arcs_come_back() {
    let text = "G0 X10 Y0 Z0\nG3 X0 Y10 I-10 J0 F100\nG2 X0 Y10 Z-4 I5 J0 P2\nG18 G3 X0 Z6 I5 K5\nG19 G2 Y20 Z6 J5 K0\nG17 G1 X5\nG3 X5 Y20 I1 J2\n";
    for name in ["3-axis", "rotary-a", "trunnion-ac", "head-bc"] {
        let mut options = options(name);
        options.exact_arcs = true;
        let read = gcode::read(text, &options).unwrap();
        for tip_control in [false, true] {
            let posted = write::GcodeOptions::for_machine(options.machine.clone(), tip_control);
            let posted = write::gcode(&read, &posted).unwrap().text;
            assert_eq!(
                posted.matches("G2 ").count() + posted.matches("G3 ").count(),
                5,
                "{posted}"
            );
            let back = gcode::read(&posted, &options).unwrap_or_else(|error| panic!("{error}\n{posted}"));
            assert_eq!(back.poses.len(), read.poses.len(), "{posted}");
            for (a, b) in back.poses.iter().zip(&read.poses) {
                let off = |a: [f64; 3], b: [f64; 3]| (Vector3::from(a) - Vector3::from(b)).norm();
                assert!(off(a.pose.tip(), b.pose.tip()) < 1e-9, "{name}: {posted}");
                match (a.way().course, b.way().course) {
                    (TipCourse::Arc(a), TipCourse::Arc(b)) => {
                        assert!(
                            off(a.centre(), b.centre()) < 1e-9 && off(a.normal(), b.normal()) < 1e-9,
                            "{name}: {posted}"
                        );
                        assert!((a.angle() - b.angle()).abs() < 1e-9, "{name}: {posted}");
                    }
                    (a, b) => assert_eq!(a, b),
                }
            }
        }
    }
}

#[test]
fn a_turn_at_the_feed_has_that_feed() {
    let options = options("trunnion-ac");
    for (motion, rapid, feed) in [("G1 Z29 F100", false, Some(100.0)), ("G0 Z29 F100", true, None)] {
        let text = format!("G0 X1 Y2 Z30\n{motion}\nG68.2 X0 Y0 Z0 I0 J30 K0\nG53.1\nG0 X1 Y2 Z30\n");
        let program = gcode::read(&text, &options).unwrap_or_else(|error| panic!("{error}"));
        let turns: Vec<_> = program.poses.iter().filter(|pose| pose.line == 4).collect();
        assert!(!turns.is_empty());
        assert!(
            turns.iter().all(|pose| (pose.rapid, pose.feed) == (rapid, feed)),
            "{turns:?}"
        );
    }
}
