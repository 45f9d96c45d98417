//! Codes that shops use, against moves worked out by hand from the manuals.

use nalgebra::{Rotation3, Vector3};
use sweepsim_motion::TipCourse;
use sweepsim_nc::{Controller, FeedMode, Program, ReadOptions, ToolOffset, gcode};

fn options(controller: Controller) -> ReadOptions {
    let mut options = ReadOptions::default();
    options.controller = Some(controller);
    options.exact_arcs = true;
    let offset = ToolOffset {
        length: 10.0,
        diameter: 8.0,
    };
    options.tool_offsets.insert(1, offset);
    options
}

fn read(text: &str, controller: Controller) -> Program {
    gcode::read(text, &options(controller)).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn message(text: &str, controller: Controller) -> String {
    gcode::read(text, &options(controller)).unwrap_err().to_string()
}

/// Rapids with their ends.
fn moves(program: &Program) -> Vec<(bool, [f64; 3])> {
    program.poses.iter().map(|pose| (pose.rapid, pose.pose.tip())).collect()
}

/// The table of Mitsubishi's manual, 12.6: the way X1000 with an offset of 10, or −10 in its place; here 40 with the radius 4.
#[test]
fn longer_and_shorter_ways() {
    for (block, end) in [
        ("G91 G45 X40 D1", 44.0),
        ("G91 G45 X-40 D1", -44.0),
        ("G91 G46 X40 D1", 36.0),
        ("G91 G46 X-40 D1", -36.0),
        ("G91 G47 X40 D1", 48.0),
        ("G91 G47 X-40 D1", -48.0),
        ("G91 G48 X40 D1", 32.0),
        ("G91 G48 X-40 D1", -32.0),
        // No way: the sign decides.
        ("G91 G45 X0 D1", 4.0),
        ("G91 G45 X-0 D1", -4.0),
        ("G91 G46 X0 D1", -4.0),
        ("G91 G46 X-0 D1", 4.0),
        // More than the way: it turns back.
        ("G91 G48 X5 D1", -3.0),
        ("G45 X40 H1", 50.0),
        ("G90 G45 X-40 D1", -44.0),
    ] {
        let program = read(&format!("G0 X0 Y0 Z0\nG1 F100\n{block}\n"), Controller::Fanuc);
        let tip = program.poses.last().unwrap().pose.tip();
        assert!((tip[0] - end).abs() < 1e-12 && tip[1] == 0.0, "{block}: {tip:?}");
    }
    // In G90, an axis that is there does not move, and the next block goes where it says.
    let program = read("G0 X0 Y0 Z0\nG1 F100\nG45 X0 Y10 D1\nX5\n", Controller::Fanuc);
    let tips: Vec<[f64; 3]> = program.poses.iter().map(|pose| pose.pose.tip()).collect();
    assert_eq!(tips, [[0.0; 3], [0.0, 14.0, 0.0], [5.0, 14.0, 0.0]]);
    for (text, expected) in [
        (
            "G0 X0 Y0 Z0\nG1 F9 G45 X5 D1\nG45 X9",
            "3:1: G45 right after another such move in G90 is not supported yet: controls disagree on where its way begins; expected G91",
        ),
        (
            "G0 X0 Y0 Z0\nF9 G2 G46 X5 I2 D1",
            "2:7: G46 outside of straight moves is not supported yet: expected G0 or G1 with it",
        ),
        (
            "G0 X0 Y0 Z0\nG1 F9 G46 X5 H7",
            "2:7: the offset H7 is not known: expected it in the tool table",
        ),
    ] {
        assert_eq!(message(text, Controller::Fanuc), expected);
    }
}

#[test]
fn planes_of_all_kinds() {
    let turn = |axis: usize, degrees: f64| {
        let axis = [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()][axis];
        Rotation3::from_axis_angle(&axis, degrees.to_radians())
    };
    let (i, j, k) = (20.0, -35.0, 70.0);
    let angles = format!("X1 Y2 Z3 I{i} J{j} K{k}");
    let [a, b, c] = [[4.0, 0.0, 0.0], [4.0, 3.0, 1.0], [0.0, 5.0, 2.0]].map(Vector3::from);
    let points = "G68.2 P2 Q1 X4\nG68.2 P2 Q2 X4 Y3 Z1\nG68.2 P2 Q3 Y5 Z2";
    let x = (b - a).normalize();
    let z = (b - a).cross(&(c - a)).normalize();
    let by_points = Rotation3::from_basis_unchecked(&[x, z.cross(&x), z]);
    let origin = Vector3::new(1.0, 2.0, 3.0);
    for (controller, text, origin, rotation) in [
        (
            Controller::Fanuc,
            format!("G68.2 {angles}"),
            origin,
            turn(2, i) * turn(0, j) * turn(2, k),
        ),
        (
            Controller::Fanuc,
            format!("G68.2 P0 Q313 {angles}"),
            origin,
            turn(2, i) * turn(0, j) * turn(2, k),
        ),
        (
            Controller::LinuxCnc,
            format!("G68.2 P0 Q121 {angles}"),
            origin,
            turn(0, i) * turn(1, j) * turn(0, k),
        ),
        // Roll, pitch and yaw about the fixed axes: X first.
        (
            Controller::Fanuc,
            format!("G68.2 P1 {angles}"),
            origin,
            turn(2, k) * turn(1, j) * turn(0, i),
        ),
        // I is the angle about X whatever the order is; on LinuxCNC it is the first.
        (
            Controller::Fanuc,
            format!("G68.2 P1 Q312 {angles}"),
            origin,
            turn(1, j) * turn(0, i) * turn(2, k),
        ),
        (
            Controller::LinuxCnc,
            format!("G68.2 P1 Q312 {angles}"),
            origin,
            turn(1, k) * turn(0, j) * turn(2, i),
        ),
        (Controller::Fanuc, points.to_owned(), a, by_points),
        (
            Controller::Fanuc,
            format!("G68.2 P2 Q0 X1 Y2 Z3 R30\n{points}"),
            origin,
            by_points * turn(2, 30.0),
        ),
        // X, and a Z that is not quite at right angles.
        (
            Controller::Fanuc,
            "G68.2 P3 Q1 X1 Y2 Z3 I1 J1 K0\nG68.2 P3 Q2 I0.001 J0 K1".to_owned(),
            origin,
            {
                let z = Vector3::new(0.001, 0.0, 1.0).normalize();
                let x = Vector3::new(1.0, 1.0, 0.0);
                let x = (x - z * z.dot(&x)).normalize();
                Rotation3::from_basis_unchecked(&[x, z.cross(&x), z])
            },
        ),
        // In the plane there is.
        (
            Controller::LinuxCnc,
            "G68.2 X1 Y2 Z3 I90 J30\nG68.4 X5 I-40 J10".to_owned(),
            origin + turn(2, 90.0) * turn(0, 30.0) * Vector3::new(5.0, 0.0, 0.0),
            turn(2, 90.0) * turn(0, 30.0) * turn(2, -40.0) * turn(0, 10.0),
        ),
    ] {
        let program = read(
            &format!("G54 G0 X0 Y0 Z50\n{text}\nG53.1\nG0 X7 Y-2 Z5\nG1 Z1 F100\n"),
            controller,
        );
        let pose = program.poses.last().unwrap().pose;
        let tip = origin + rotation * Vector3::new(7.0, -2.0, 1.0);
        let axis = rotation * Vector3::z();
        let apart = |a: [f64; 3], b: Vector3<f64>| (Vector3::from(a) - b).norm();
        assert!(
            apart(pose.tip(), tip) < 1e-12 && apart(pose.axis(), axis) < 1e-12,
            "{text}\n{pose:?} {tip}"
        );
    }
    for (text, expected) in [
        (
            "G0 X0 Y0 Z0\nG68.2 P4 I9 J9",
            "2:1: tilted planes by projection angles (G68.2 P4) are not supported yet: expected P0 to P3",
        ),
        (
            "G0 X0 Y0 Z0\nG68.2 P5",
            "2:1: P of G68.2 is 5, but must be 0, 1, 2 or 3",
        ),
        (
            "G0 X0 Y0 Z0\nG68.2 P1 Q113",
            "2:1: Q, the order of axes of a tilted plane is 113, but must be three digits from 1 to 3, no two alike beside each other",
        ),
        (
            "G0 X0 Y0 Z0\nG68.2 P2 Q2",
            "2:1: Q of G68.2 P2 is 2, but must be 0 here",
        ),
        (
            "G0 X0 Y0 Z0\nG68.2 P2 Q1\nG0 X1",
            "3:1: the plane of G68.2 P2 is not complete: expected its next Q before this",
        ),
        (
            "G0 X0 Y0 Z0\nG68.2 P2 Q1\nG68.2 P2 Q2 X1\nG68.2 P2 Q3 X2",
            "4:1: the three points of this plane are on one line: expected others",
        ),
        (
            "G0 X0 Y0 Z0\nG68.4 I9",
            "2:1: G68.4 without a tilted plane: expected G68.2 before it",
        ),
    ] {
        assert_eq!(message(text, Controller::Fanuc), expected);
    }
}

/// Down beside the axis, across, up to Z, and out again.
#[test]
fn back_boring() {
    let expected = [
        (true, [0.0, 0.0, 5.0]),
        (true, [10.0, 20.0, 5.0]),
        (false, [11.0, 20.0, 5.0]),
        (true, [11.0, 20.0, -30.0]),
        (false, [10.0, 20.0, -30.0]),
        (false, [10.0, 20.0, -22.0]),
        (false, [11.0, 20.0, -22.0]),
        (true, [11.0, 20.0, 5.0]),
        (false, [10.0, 20.0, 5.0]),
        (true, [0.0, 0.0, 9.0]),
    ];
    let fanuc = "M3 S500\nG0 X0 Y0 Z5\nG87 X10 Y20 Z-22 R-30 I1 F50\nG80\nG0 X0 Y0 Z9\n";
    for (controller, text) in [
        (Controller::Fanuc, fanuc.to_owned()),
        (Controller::Haas, fanuc.replace("G87", "G77")),
    ] {
        assert_eq!(moves(&read(&text, controller)), expected);
    }
    // Haas's G87 is a boring whose retraction is by hand.
    let bored = read("M3 S500\nG0 X0 Y0 Z5\nG87 X10 Z-22 R1 F50\nG80\n", Controller::Haas);
    assert_eq!(moves(&bored)[3], (false, [10.0, 0.0, -22.0]));
    for (text, controller, expected) in [
        (
            "G0 X0 Y0 Z5\nG87 X1 Z-2 R-3 Q1 F9",
            Controller::Fanuc,
            "2:1: back boring with a shift by Q is not supported yet: its direction is a setting of the machine; expected the shift by I and J",
        ),
        (
            "G0 X0 Y0 Z5\nG87 X1 Z-2 R3 I1 F9",
            Controller::Fanuc,
            "2:1: the plane R of a back boring is 3, but must be below Z, -2",
        ),
        (
            "G0 X0 Y0 Z5\nG77 X1 Z-2 R3 F9",
            Controller::Fanuc,
            "2:1: G77: cycles of lathes are not supported yet: expected G73, G74 or G81 to G89, or the moves written out",
        ),
    ] {
        assert_eq!(message(text, controller), expected);
    }
}

/// Haas's examples: one circle, and several.
#[test]
fn circular_pockets() {
    for (code, sense) in [("G12", -1.0), ("G13", 1.0)] {
        let text = format!("G0 X3 Y0 Z1\n{code} X0 I10 Z-2 F50 D1\nG0 Z5\n{code} I5 K21 Q8 Z-3 D1\n");
        let program = read(&text, Controller::Haas);
        let found: Vec<(f64, f64)> = program
            .poses
            .iter()
            .filter_map(|pose| match pose.way().course {
                TipCourse::Arc(arc) if (arc.angle().abs() - std::f64::consts::TAU).abs() < 1e-12 => {
                    let [x, y, z] = pose.pose.tip();
                    let [cx, cy, _] = arc.centre();
                    assert_eq!((cx, cy), (0.0, 0.0));
                    assert!(arc.angle() * arc.normal()[2] * sense > 0.0);
                    Some((x.hypot(y), z))
                }
                _ => None,
            })
            .collect();
        // The tool's radius is 4.
        assert_eq!(found, [(6.0, -2.0), (1.0, -3.0), (9.0, -3.0), (17.0, -3.0)]);
        // It begins and ends in the centre.
        assert_eq!(program.poses.last().unwrap().pose.tip(), [0.0, 0.0, -3.0]);
        assert!(
            program
                .notes
                .iter()
                .any(|note| note.message.starts_with(&format!("{code}: the tool goes")))
        );
    }
    let deep = read("G91 G0 X0 Y0 Z1\nG13 I10 Z-2 F50 D0 L3\n", Controller::Haas);
    assert_eq!(deep.poses.last().unwrap().pose.tip()[2], -5.0);
    for (text, expected) in [
        (
            "G0 X0 Y0 Z0\nG13 I4 D1 F9",
            "2:1: I of G13 is 4, but must be greater than the tool's radius, 4",
        ),
        (
            "G0 X0 Y0 Z0\nG13 K4 D1 F9",
            "2:1: G13 without I: expected the radius of the first circle",
        ),
        (
            "G0 X0 Y0 Z0\nG13 I5 K9 D1 F9",
            "2:1: K without Q in G13: expected the step between circles",
        ),
        (
            "G0 X0 Y0 Z0\nG13 I9 L2 D1 F9",
            "2:1: L of G13 in G90: expected G91, where each repeat goes down by Z",
        ),
    ] {
        assert_eq!(message(text, Controller::Haas), expected);
    }
    assert_eq!(
        message("G0 X0 Y0 Z0\nG13 I9 D1 F9", Controller::Fanuc),
        "2:1: G13 is not supported yet: it is a circular pocket on Haas only; expected --controller haas"
    );
}

/// Threads: straight, with a feed per revolution.
#[test]
fn threads() {
    let feeds = |program: &Program| -> Vec<_> {
        let cuts = program.poses.iter().filter(|pose| pose.joined && !pose.rapid);
        cuts.map(|pose| (pose.feed, pose.feed_mode)).collect()
    };
    let turned = [
        (Some(1.25), FeedMode::PerRevolution),
        (Some(1.25), FeedMode::PerRevolution),
    ];
    let text = "S100 M3\nG0 X0 Y0 Z5\nG33 Z-10 K1.25\nZ-12\nG0 Z5\n";
    assert_eq!(feeds(&read(text, Controller::LinuxCnc)), turned);
    let tapped = read("S100 M3\nG0 X0 Y0 Z5\nG33.1 Z-10 K1.25\n", Controller::LinuxCnc);
    assert_eq!(feeds(&tapped), turned);
    assert_eq!(
        moves(&tapped)[1..],
        [(false, [0.0, 0.0, -10.0]), (false, [0.0, 0.0, 5.0])]
    );
    let fanuc = read(
        "S100 M3\nG0 X0 Y0 Z5\nG33 Z-10 F1.25\nG32 Z-12 F1.25\n",
        Controller::Fanuc,
    );
    assert_eq!(feeds(&fanuc), turned);
    assert_eq!(
        message("G0 X0 Y0 Z5\nG33 Z-10 F9", Controller::LinuxCnc),
        "2:1: a thread without its pitch: expected K, the way in one revolution"
    );
}
