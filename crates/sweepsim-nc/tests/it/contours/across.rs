//! Contours in other planes than XY, and moves across the plane between those of a contour.

use sweepsim_motion::TipCourse;
use sweepsim_nc::{Controller, ReadOptions, gcode};

use super::{assert_near, options, read, tips};

#[test]
fn a_plunge_before_the_entry_is_straight_down() {
    let expected = [
        [0.0, -20.0, 5.0],
        [0.0, -20.0, -5.0],
        [-5.0, 0.0, -5.0],
        [-5.0, 20.0, -5.0],
        [0.0, 25.0, -5.0],
        [20.0, 25.0, -5.0],
        [40.0, 40.0, -5.0],
    ];
    let siemens = "T1 D1 F100\nG0 X0 Y-20 Z5\nG41\nG1 Z-5\nX0 Y0\nY20\nX20\nG40 X40 Y40\n";
    assert_near(&tips(&read(siemens, false, &options(10.0))), &expected);
    let klartext =
        "TOOL CALL 1 Z S9\nL X+0 Y-20 Z+5 R0 FMAX\nL Z-5 RL F100\nL X+0 Y+0\nL Y+20\nL X+20\nL X+40 Y+40 R0\n";
    assert_near(&tips(&read(klartext, true, &options(10.0))), &expected);
    for controller in [None, Some(Controller::Fanuc)] {
        let mut given = ReadOptions::default();
        given.exact_arcs = true;
        given.controller = controller;
        given.diameters.insert(1, 10.0);
        let text = "G21 G90 G0 X0. Y-20. Z5.\nG41 D1\nG1 Z-5. F100\nX0. Y0.\nY20.\nX20.\nG40 X40. Y40.\n";
        let found = tips(&gcode::read(text, &given).unwrap());
        assert_near(&found[..4], &expected[..4]);
    }
}

#[test]
fn a_plunge_between_an_arc_and_an_inside_corner() {
    // Three quarters of a circle about (-10, 0), down, and up to its middle: the offset x = -11 and the circle of radius 9
    // meet.
    let text = |down: &str| {
        format!("T1 D1 F100\nG0 X5 Y-10 Z0\nG1 G41 X0 Y-10\nY0\nG3 X-10 Y-10 I-10 J0\n{down}G1 Y0\nG40 X-10 Y5\n")
    };
    let found = tips(&read(&text("G1 Z-1\n"), false, &options(2.0)));
    let y = -(80.0_f64.sqrt());
    let expected = [
        [5.0, -10.0, 0.0],
        [-1.0, -10.0, 0.0],
        [-1.0, 0.0, 0.0],
        [-11.0, y, 0.0],
        [-11.0, y, -1.0],
        [-11.0, 0.0, -1.0],
        [-10.0, 5.0, -1.0],
    ];
    assert_near(&found, &expected);
    assert_eq!(tips(&read(&text(""), false, &options(2.0))).len(), expected.len() - 1);
}

#[test]
fn round_corners_lie_in_the_plane_of_the_contour() {
    // Outside of a corner in ZX and in YZ, between lines.
    for (plane, [u, v, w], name) in [("G18", ["Z", "X", "Y"], [2, 0, 1]), ("G19", ["Y", "Z", "X"], [1, 2, 0])] {
        let start = format!("T1 D1 F100 {plane}\nG0 {u}-10 {v}0 {w}0\n");
        let at = |a: f64, b: f64| {
            let mut point = [0.0; 3];
            (point[name[0]], point[name[1]]) = (a, b);
            point
        };
        for (text, expected) in [
            (
                format!("{start}G1 G42 {u}-5\n{u}0\n{v}10\nG40 {v}20\n"),
                vec![
                    at(-10.0, 0.0),
                    at(-5.0, -1.0),
                    at(0.0, -1.0),
                    at(1.0, 0.0),
                    at(1.0, 10.0),
                    at(0.0, 20.0),
                ],
            ),
            (
                format!("{start}G1 {u}0 RND=2\n{v}10\n"),
                vec![at(-10.0, 0.0), at(-2.0, 0.0), at(0.0, 2.0), at(0.0, 10.0)],
            ),
        ] {
            let program = read(&text, false, &options(2.0));
            assert_near(&tips(&program), &expected);
            let arcs = program.poses.iter().filter_map(|pose| match pose.way().course {
                TipCourse::Arc(arc) => Some(arc.normal()),
                _ => None,
            });
            let normals: Vec<[f64; 3]> = arcs.collect();
            assert_eq!(normals.len(), 1, "{text}");
            assert_eq!(normals[0][name[2]].abs(), 1.0, "{text}");
        }
    }
    let klartext = "TOOL CALL 1 Y S9\nL Z-10 X+0 Y+0 R0 FMAX\nL Z-5 RR F100\nL Z+0\nL X+10\nL X+20 R0\n";
    let program = read(klartext, true, &options(2.0));
    let expected = [
        [0.0, 0.0, -10.0],
        [-1.0, 0.0, -5.0],
        [-1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
        [10.0, 0.0, 1.0],
        [20.0, 0.0, 0.0],
    ];
    assert_near(&tips(&program), &expected);
}
