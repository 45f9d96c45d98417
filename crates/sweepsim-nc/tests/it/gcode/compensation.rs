//! Cutter compensation against offsets computed independently.

use sweepsim_motion::TipCourse;
use sweepsim_nc::{Controller, ReadOptions, ToolOffset, gcode};
use sweepsim_props::*;

use super::{assert_near, options, program, program_with, tips};
use crate::pieces::{Piece, distance_to_point, polygon, rounded_rectangle, samples, star};

/// The program of a closed contour with a tangential entry and exit of 10 mm.
fn contour_program(contour: &[Piece], left: bool, diameter: f64) -> String {
    let Piece::Line(a, b) = contour[0] else {
        panic!("begin with a line")
    };
    let length = distance_to_point(a, b);
    let t = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
    let mut text = format!(
        "G21 G90 G17 F100\nG0 X{:.9} Y{:.9} Z0\nG{} D{diameter}\nG1 X{:.9} Y{:.9}\n",
        a[0] - 10.0 * t[0],
        a[1] - 10.0 * t[1],
        if left { "41.1" } else { "42.1" },
        a[0],
        a[1]
    );
    for piece in contour {
        text += &piece.block();
    }
    text += "G40\nG1 X500 Y500\n";
    text
}

/// Reads with exact arcs, and checks that the tool keeps its distance from the contour everywhere, on its side.
fn check_distance(contour: &[Piece], left: bool, radius: f64, controller: Option<Controller>) -> Result<(), String> {
    let mut options = ReadOptions::default();
    options.exact_arcs = true;
    options.controller = controller;
    let text = contour_program(contour, left, 2.0 * radius);
    let program = gcode::read(&text, &options).map_err(|error| error.to_string())?;
    let last = program.poses.len() - 1;
    // From the end of the entry to the end of the contour.
    let points = samples(&program, 1..last);
    assert!(points.len() > 20 * contour.len() / 2);
    let round = controller != Some(Controller::Fanuc);
    for point in points {
        let distance = contour
            .iter()
            .map(|piece| piece.distance(point))
            .fold(f64::MAX, f64::min);
        if distance < radius - 1e-6 {
            return Err(format!("{point:?} is {distance} from the contour\n{text}"));
        }
        let most = if round { radius } else { radius * 2.0_f64.sqrt() };
        if distance > most + 1e-6 {
            return Err(format!("{point:?} is {distance} from the contour, too far\n{text}"));
        }
    }
    // The side: beside the middle of the first line.
    let Piece::Line(a, b) = contour[0] else { unreachable!() };
    let tip: [f64; 3] = program.poses[1].pose.tip();
    let side = (b[0] - a[0]) * (tip[1] - a[1]) - (b[1] - a[1]) * (tip[0] - a[0]);
    assert_eq!(side > 0.0, left);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn the_tool_keeps_its_distance_from_polygons(
        radii in collection::vec(20.0..30.0_f64, 4..9),
        left in any::<bool>(),
        reverse in any::<bool>(),
        radius in 0.1..1.0_f64,
        fanuc in any::<bool>(),
    ) {
        let mut points = star(&radii);
        if reverse {
            points.reverse();
        }
        let controller = fanuc.then_some(Controller::Fanuc);
        let result = check_distance(&polygon(&points), left, radius, controller);
        prop_assert!(result.is_ok(), "{}", result.unwrap_err());
    }

    /// Rectangles with rounded corners, outside and inside, in both directions.
    #[test]
    fn the_tool_keeps_its_distance_from_arcs(
        corner in 1.5..9.0_f64,
        outside in any::<bool>(),
        left in any::<bool>(),
        bulge in any::<bool>(),
        radius in 0.1..1.4_f64,
    ) {
        let pieces = rounded_rectangle(corner, bulge.then_some(outside));
        let result = check_distance(&pieces, left, radius, None);
        prop_assert!(result.is_ok(), "{}", result.unwrap_err());
    }
}

#[test]
fn a_square_by_hand() {
    let text = |side: &str| format!("G0 X-10 Y0 Z0\n{side} D2\nG1 X0 Y0 F100\nX10\nY10\nX0\nY0\nG40\nG0 X-10\n");
    let mut exact = ReadOptions::default();
    exact.exact_arcs = true;
    // Inside: the corners are where the offsets meet.
    let inside = program_with(&text("G41.1"), &exact);
    assert_near(
        &tips(&inside),
        &[
            [-10.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [9.0, 1.0, 0.0],
            [9.0, 9.0, 0.0],
            [1.0, 9.0, 0.0],
            [1.0, 0.0, 0.0],
            [-10.0, 0.0, 0.0],
        ],
    );
    // Outside: quarter circles about the corners.
    let outside = program_with(&text("G42.1"), &exact);
    assert_near(
        &tips(&outside)[1..5],
        &[[0.0, -1.0, 0.0], [10.0, -1.0, 0.0], [11.0, 0.0, 0.0], [11.0, 10.0, 0.0]],
    );
    assert!(matches!(outside.poses[3].way().course, TipCourse::Arc(arc) if arc.centre() == [10.0, 0.0, 0.0]));
    // Lines keep the lines of the program; an arc at a corner belongs to the move after it.
    let lines: Vec<usize> = outside.poses.iter().map(|pose| pose.line).collect();
    assert_eq!(lines[..5], [1, 3, 4, 5, 5]);
    // Fanuc's corners are the meetings of the offsets, its entry ends beside the next move's start.
    let mut fanuc = options(Controller::Fanuc);
    fanuc.tool_offsets.insert(
        7,
        ToolOffset {
            length: 0.0,
            diameter: 2.0,
        },
    );
    let found = program_with(
        "G0 X-10. Y-10. Z0\nG42 D7 G1 X0 Y0 F100\nX10.\nY10.\nX0\nG40 G1 X-20.\n",
        &fanuc,
    );
    assert_near(
        &tips(&found),
        &[
            [-10.0, -10.0, 0.0],
            [0.0, -1.0, 0.0],
            [10.0, -1.0, 0.0],
            [11.0, -1.0, 0.0],
            [11.0, 0.0, 0.0],
            [11.0, 10.0, 0.0],
            [11.0, 11.0, 0.0],
            [10.0, 11.0, 0.0],
            [0.0, 11.0, 0.0],
            [-20.0, 10.0, 0.0],
        ],
    );
}

#[test]
fn heights_and_planes() {
    // A move along Z waits with the one before it.
    let found = program("G0 X-10 Y0 Z0\nG41.1 D2\nG1 X0 Y0 F100\nX10 Z-1\nZ-2\nY10\nG40\nG1 X0 Y20\n");
    assert_near(
        &tips(&found),
        &[
            [-10.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [9.0, 1.0, -1.0],
            [9.0, 1.0, -2.0],
            [9.0, 10.0, -2.0],
            [0.0, 20.0, -2.0],
        ],
    );
    let found = program("G18 G0 Z-10 X0 Y0\nG41.1 D2\nG1 Z0 X0 F100\nZ10\nX10\nG40\nG1 X20 Z0\n");
    assert_near(
        &tips(&found)[1..4],
        &[[1.0, 0.0, 0.0], [1.0, 0.0, 9.0], [10.0, 0.0, 9.0]],
    );
    // A negative diameter is the other side.
    let other = program("G0 X-10 Y0 Z0\nG42.1 D-2\nG1 X0 Y0 F100\nX10\nG40\nG1 X0 Y20\n");
    assert_near(&tips(&other)[1..3], &[[0.0, 1.0, 0.0], [10.0, 1.0, 0.0]]);
}

/// Fanuc's D stays; on LinuxCNC, G41 without D is about the tool in the spindle.
#[test]
fn the_register_stays_until_another_one() {
    let ends = |text: &str, controller: Controller| {
        let mut given = options(controller);
        given.diameters.extend([(3, 10.0), (21, 4.0)]);
        let text = format!("T3 M6\nG21 G90 G0 X0. Y-20. Z5.\n{text}");
        gcode::read(&text, &given).map(|program| tips(&program))
    };
    let before = "G43 H3 D21\nG41 G1 X0. Y0. F100\nY20.\nG40 X20.\n";
    assert_near(
        &ends(before, Controller::Fanuc).unwrap()[1..3],
        &[[-2.0, 0.0, 5.0], [-2.0, 20.0, 5.0]],
    );
    let twice = "G41 D21 G1 X0. Y0. F100\nY20.\nG40 X20.\nG41 X30. Y20.\nY40.\nG40 X40.\n";
    assert_near(
        &ends(twice, Controller::Haas).unwrap()[4..6],
        &[[28.0, 20.0, 5.0], [28.0, 40.0, 5.0]],
    );
    assert_near(
        &ends(twice, Controller::LinuxCnc).unwrap()[4..6],
        &[[25.0, 25.0, 5.0], [25.0, 40.0, 5.0]],
    );
    // Another radius beside the contour.
    let change = "G41 D21 G1 X0. Y0. F100\nY20. D3\nX20.\nG40 X30.\n";
    let error = ends(change, Controller::Fanuc).unwrap_err().to_string();
    assert!(
        error.contains("a change of the radius while cutter compensation is on"),
        "{error}"
    );
    assert!(ends(&change.replace("D3", "D21"), Controller::Fanuc).is_ok());
}

/// LinuxCNC takes corners of up to 0.05 radians for none: the offsets may have a gap there.
#[test]
fn a_small_corner_before_an_arc_is_none_on_linuxcnc() {
    let text = "G21 G90 G0 X-20 Y0 Z0\nG42.1 D5\nG1 X-10 F100\nX0\nG2 X1.396 Y-39.976 I0.698 J-19.988\nG40\nG1 X-20\n";
    let mut options = options(Controller::LinuxCnc);
    options.exact_arcs = true;
    let found = tips(&gcode::read(text, &options).unwrap());
    assert_near(&found[2..3], &[[0.0, -2.5, 0.0]]);
    // The arc ends beside its own end.
    let [x, y, _] = found[3];
    assert!(((x - 0.698).hypot(y + 19.988) - 17.5).abs() < 2e-3, "{found:?}");
}
