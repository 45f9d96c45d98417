//! Arcs that are kept because they are cheaper than their chords: about z and in planes along z, with the tool along z, and about the axis of a tool that leans.

use sweepsim_motion::TipCourse;
use sweepsim_nc::{Machine, Program, ReadOptions, apt, gcode, heidenhain, siemens};

fn options() -> ReadOptions {
    let mut options = ReadOptions::default();
    options.level_arcs = true;
    options
}

/// The number of arcs, and that of straight moves.
fn courses(program: &Program) -> [usize; 2] {
    let moves = program.poses.iter().skip(1);
    let arcs = moves
        .filter(|pose| matches!(pose.way().course, TipCourse::Arc(_)))
        .count();
    [arcs, program.poses.len() - 1 - arcs]
}

#[track_caller]
fn gcode_courses(text: &str) -> [usize; 2] {
    let text = format!("G21 G90 G94 F100\nG0 X0 Y0 Z0\n{text}\nM2\n");
    courses(&gcode::read(&text, &options()).unwrap_or_else(|error| panic!("{text}\n{error}")))
}

#[test]
fn arcs_about_z_are_kept() {
    assert_eq!(gcode_courses("G17 G3 X0 Y10 I0 J5"), [1, 0]);
    // Helices, full turns, several turns.
    assert_eq!(gcode_courses("G17 G2 X0 Y10 Z-2 I0 J5"), [1, 0]);
    assert_eq!(gcode_courses("G17 G2 X0 Y0 Z-2 I4 J3 P3"), [1, 0]);
    let text = "L X+0 Y+0 Z+0 FMAX\nCC X+5 Y+0\nC X+10 Y+0 DR-\n";
    assert_eq!(courses(&heidenhain::read(text, &options()).unwrap()), [1, 0]);
    let text = "G90 G0 X0 Y0 Z0\nG3 X0 Y10 I0 J5 F100\nM30\n";
    assert_eq!(courses(&siemens::read(text, &options()).unwrap()), [1, 0]);
    let text = "UNITS/MM\nGOTO/0,0,0,0,0,1\nMOVARC/0,5,0,0,0,1,5,ANGLE,180\nGOTO/0,10,0\nFINI\n";
    assert_eq!(courses(&apt::read(text, &options()).unwrap()), [1, 0]);
}

/// In planes along z, without leaving them, in any of the formats.
#[test]
fn arcs_in_planes_along_z_are_kept_if_asked_for() {
    let mut upright = options();
    upright.upright_arcs = true;
    upright.arc_tolerance = 1e-5;
    let head = "G21 G90 G94 F100\nG0 X0 Y0 Z0\n";
    for (text, kept) in [
        ("G18 G3 X10 Z0 I5 K0", true),
        ("G19 G2 Y10 Z0 J5 K0", true),
        ("G19 G2 Y0 Z0 J5 K3", true),
        ("G17 G3 X0 Y10 I0 J5", true),
        // It leaves its plane; a spiral; a radius of 138 m.
        ("G18 G3 X10 Y1 Z0 I5 K0", false),
        ("G18 G3 X-0.002 Z0.0005 I5 K0", false),
        ("G18 G2 X10 Z0 R138000", false),
    ] {
        let program = gcode::read(&format!("{head}{text}\nM2\n"), &upright).unwrap();
        assert_eq!(courses(&program) == [1, 0], kept, "{text}: {:?}", courses(&program));
    }
    let text = "UNITS/MM\nGOTO/0,0,0,0,0,1\nMOVARC/5,0,0,0,1,0,5,ANGLE,180\nGOTO/10,0,0\nFINI\n";
    assert_eq!(courses(&apt::read(text, &upright).unwrap()), [1, 0]);
    let text = "G90 G0 X0 Y0 Z0\nG18 G3 X10 Z0 I5 K0 F100\nM30\n";
    assert_eq!(courses(&siemens::read(text, &upright).unwrap()), [1, 0]);
    // Few chords are cheaper.
    upright.arc_tolerance = 2e-3;
    assert_eq!(courses(&siemens::read(text, &upright).unwrap()), [1, 0]);
    upright.arc_tolerance = 0.2;
    assert!(courses(&siemens::read(text, &upright).unwrap())[1] > 1);
}

/// In tilted planes, about the tool's axis, in any of the formats.
#[test]
fn arcs_about_a_leaning_tool_are_kept_if_asked_for() {
    let mut tilted = options();
    tilted.tilted_arcs = true;
    tilted.arc_tolerance = 1e-5;
    let plane = "G21 G90 G94 F100\nG68.2 X1 Y2 Z3 I20 J30 K10\nG53.1\n";
    let upright = "G21 G90 G94 F100\nG68.2 X1 Y2 Z3 I20 J30 K10\n";
    for machine in [None, Some("trunnion-ac"), Some("head-bc")] {
        tilted.machine = machine.map_or_else(Machine::default, |name| Machine::named(name).unwrap());
        for (head, text, kept) in [
            (plane, "G17 G3 X0 Y10 I0 J5", true),
            (plane, "G17 G2 X0 Y0 I4 J3", true),
            // It leaves its plane; a spiral; a radius of 138 m; across the tool's axis; 25 chords.
            (plane, "G17 G3 X0 Y10 Z1 I0 J5", false),
            (plane, "G17 G3 X-0.002 Y0.0005 I5 J0", false),
            (plane, "G17 G2 X10 Y0 R138000", false),
            (plane, "G18 G3 X10 Z0 I5 K0", false),
            (plane, "G17 G3 X0 Y0.01 I0 J0.005", false),
            // The tool stands along z.
            (upright, "G17 G3 X0 Y10 I0 J5", false),
        ] {
            let head = format!("{head}G0 X0 Y0 Z0\n");
            let poses = |text: &str, options: &ReadOptions| gcode::read(&format!("{head}{text}M2\n"), options).unwrap();
            let before = courses(&poses("", &tilted));
            let after = courses(&poses(&format!("{text}\n"), &tilted));
            let own = [after[0] - before[0], after[1] - before[1]];
            assert_eq!(own == [1, 0], kept, "{machine:?} {text}: {own:?}");
            assert!(kept || own[0] == 0, "{text}");
            // Not without being asked.
            let mut others = options();
            others.machine = tilted.machine.clone();
            others.upright_arcs = true;
            assert_eq!(courses(&poses(&format!("{text}\n"), &others))[0], before[0], "{text}");
        }
    }
    tilted.machine = Machine::default();
    let text = "UNITS/MM\nGOTO/0,0,0,0,0.6,0.8\nMOVARC/5,0,0,0,0.6,0.8,5,ANGLE,180\nGOTO/10,0,0\nFINI\n";
    assert_eq!(courses(&apt::read(text, &tilted).unwrap()), [1, 0]);
    let text = "G90 G0 X0 Y0 Z0\nCYCLE800(0,\"\",0,57,0,0,0,30,40,0,0,0,0,1)\nG0 X0 Y0 Z0\nG3 X0 Y10 I0 J5 F100\nM30\n";
    assert_eq!(courses(&siemens::read(text, &tilted).unwrap())[0], 1);
    let text = "L X+0 Y+0 Z+50 FMAX\nPLANE SPATIAL SPA+0 SPB+30 SPC+0 TURN FMAX\nL X+0 Y+0 Z+0 FMAX\nCC X+5 Y+0\nC X+10 Y+0 DR-\n";
    assert_eq!(courses(&heidenhain::read(text, &tilted).unwrap())[0], 1);
}

#[test]
fn others_are_divided() {
    for text in [
        // Another plane, a spiral that no circle replaces, and a radius of 138 m.
        "G18 G3 X10 Z0 I5 K0",
        "G17 G3 X-0.002 Y0.0005 I5 J0",
        "G17 G2 X10 Y0 R138000",
    ] {
        let [arcs, chords] = gcode_courses(text);
        assert!(arcs == 0 && chords > 0, "{text}: {arcs} arcs, {chords} chords");
    }
}

/// Coordinates of wide arcs have fewer decimals than chords within so little need.
#[test]
fn wide_arcs_are_divided_finely() {
    let text = "G21 G90 G94 F100\nG0 X0 Y0 Z0\nG17 G2 X10 Y0 R8000\nM2\n";
    for (arc_tolerance, kept) in [(1e-4, true), (1e-5, false)] {
        let mut options = options();
        options.arc_tolerance = arc_tolerance;
        let program = gcode::read(text, &options).unwrap();
        assert_eq!(courses(&program) == [1, 0], kept, "{arc_tolerance}");
    }
}

/// With three decimals, the ends of an arc are never equally far from its centre.
#[test]
fn rounded_arcs_are_kept_as_circles() {
    let text = "G21 G90 G17 F100\nG0 X3 Y0 Z0\nG3 X1.852 Y2.360 I-3 J0\nM2\n";
    let program = gcode::read(text, &options()).unwrap();
    let [from, to] = [&program.poses[0], &program.poses[1]];
    let TipCourse::Arc(arc) = to.way().course else {
        panic!("chords")
    };
    let [x, y, _] = arc.centre();
    let radii = [from, to].map(|end| (end.pose.tip()[0] - x).hypot(end.pose.tip()[1] - y));
    assert!((radii[0] - radii[1]).abs() < 1e-12, "{radii:?}");
    assert!(x.hypot(y) < 1e-3 && x.hypot(y) > 1e-6);
}
