//! Work offsets, length offsets, turned, scaled, mirrored and polar coordinates.

use sweepsim_nc::{Controller, ReadOptions, ToolOffset, gcode};

use super::{assert_near, options, program, program_with, tips};

#[test]
fn turned_coordinates() {
    let start = "F100\nG0 X0 Y0 Z0\n";
    // Half a turn about (5, 0).
    assert_near(
        &tips(&program(&format!("{start}G68 X5 Y0 R180\nG1 X1 Y1\nX2\nG69\nX2"))),
        &[[0.0; 3], [9.0, -1.0, 0.0], [8.0, -1.0, 0.0], [2.0, -1.0, 0.0]],
    );
    // Arcs turn along.
    let mut exact = ReadOptions::default();
    exact.exact_arcs = true;
    let found = program_with(&format!("{start}G68 X0 Y0 R90\nG1 X10 Y0\nG3 X0 Y10 I-10 J0\n"), &exact);
    assert_near(&tips(&found)[1..], &[[0.0, 10.0, 0.0], [-10.0, 0.0, 0.0]]);
    let sweepsim_motion::TipCourse::Arc(arc) = found.poses[2].way().course else {
        panic!()
    };
    assert!((arc.angle() * arc.normal()[2] - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    // Work offsets that turn.
    assert_near(
        &tips(&program("G10 L2 P1 X10 Y0 Z0 R90\nG0 X1 Y0 Z0\nX2")),
        &[[10.0, 1.0, 0.0], [10.0, 2.0, 0.0]],
    );
}

#[test]
fn scaled_and_mirrored_coordinates() {
    let start = "F100\nG0 X0 Y0 Z0\n";
    let mut exact = ReadOptions::default();
    exact.exact_arcs = true;
    let found = program_with(
        &format!("{start}G51 X0 Y0 Z0 P2.0\nG1 X5\nG3 X0 Y5 I-5\nG50\nG1 X1"),
        &exact,
    );
    assert_near(
        &tips(&found)[1..],
        &[[10.0, 0.0, 0.0], [0.0, 10.0, 0.0], [1.0, 10.0, 0.0]],
    );
    // Mirrored arcs turn the other way.
    let found = program_with(
        &format!("{start}G51.1 X0\nG1 X5\nG3 X0 Y5 I-5\nG50.1 X0\nG1 X1"),
        &exact,
    );
    assert_near(
        &tips(&found)[1..],
        &[[-5.0, 0.0, 0.0], [0.0, 5.0, 0.0], [1.0, 5.0, 0.0]],
    );
    let sweepsim_motion::TipCourse::Arc(arc) = found.poses[2].way().course else {
        panic!()
    };
    assert!(arc.angle() * arc.normal()[2] < 0.0 && arc.centre() == [0.0, 0.0, 0.0]);
    let error = gcode::read(&format!("{start}G51 X0 Y0 I2 J1\nG3 X2 Y0 I1 J0"), &exact).unwrap_err();
    assert!(
        error.to_string().contains("arcs in coordinates with unequal scales"),
        "{error}"
    );
}

#[test]
fn centres_and_angles_of_turns() {
    let fanuc = options(Controller::Fanuc);
    // The centre of a turn is scaled, and the angle is not.
    let scaled = "F100.\nG0 X0. Y0. Z0.\nG51 X0. Y0. Z0. P2.\nG68 X10. Y0. R90.\nG1 X10. Y0.\nX20.";
    assert_near(
        &tips(&program_with(scaled, &fanuc)),
        &[[0.0; 3], [20.0, 0.0, 0.0], [20.0, 20.0, 0.0]],
    );
    // Without a centre, the tool stays where it is: also if coordinates were turned before.
    let twice = "F100.\nG0 X10. Y0. Z0.\nG68 X0. Y0. R90.\nG1 X20. Y0.\nG68 R180.\nG91 X1.";
    assert_near(
        &tips(&program_with(twice, &fanuc)),
        &[[10.0, 0.0, 0.0], [0.0, 20.0, 0.0], [-1.0, 20.0, 0.0]],
    );
    // In G91 angles add on Haas. On Fanuc a parameter decides.
    let steps = "F100.\nG0 X10. Y0. Z0.\nG91 G68 X0. Y0. R45.\nG68 X0. Y0. R45.\nG90 G1 X10. Y0.\nG69";
    let found = program_with(steps, &options(Controller::Haas));
    assert_near(&tips(&found)[1..], &[[0.0, 10.0, 0.0]]);
    assert_eq!(found.assumptions.len(), 0);
    let found = program_with(steps, &fanuc);
    let half = 50.0_f64.sqrt();
    assert_near(&tips(&found)[1..], &[[half, half, 0.0]]);
    assert!(found.assumptions[0].what.contains("the angle of a G68"));
    let mut strict = fanuc.clone();
    strict.strict = true;
    let error = gcode::read(steps, &strict).unwrap_err().to_string();
    assert!(error.contains("is left to the control: expected G90"), "{error}");
    // Scales of one axis each are in thousandths too, if they have no decimal point.
    let each = "F100.\nG0 X0. Y0. Z0.\nG51 X0. Y0. Z0. I-1000 J2000 K1.\nG1 X1. Y1. Z1.";
    assert_near(&tips(&program_with(each, &fanuc))[1..], &[[-1.0, 2.0, 1.0]]);
}

#[test]
fn polar_coordinates() {
    let found = program("F100\nG0 X0 Y0 Z5\nG16 G99 G81 X10 Y30 Z-1 R2\nX10 Y120\nG15 G80\nG0 X0 Y0");
    let (sin, cos) = 30_f64.to_radians().sin_cos();
    assert_near(&[tips(&found)[1]], &[[10.0 * cos, 10.0 * sin, 5.0]]);
    assert_near(&[tips(&found)[6]], &[[-10.0 * sin, 10.0 * cos, -1.0]]);
    // The radius and the angle stay.
    let found = program("F100\nG0 X0 Y0 Z5\nG16\nG1 X10 Y0\nY90\nX20\nZ1\nG15\nX3\n");
    let expected = [
        [10.0, 0.0, 5.0],
        [0.0, 10.0, 5.0],
        [0.0, 20.0, 5.0],
        [0.0, 20.0, 1.0],
        [3.0, 20.0, 1.0],
    ];
    assert_near(&tips(&found)[1..], &expected);
    for text in ["G0 X0 Y0 Z0\nG16 G91 X1 Y2", "G0 X0 Y0 Z0\nG16 X1 Y2\nG16 Y3"] {
        assert!(gcode::read(text, &ReadOptions::default()).is_err());
    }
}

#[test]
fn length_offsets() {
    // Without a table, programs are written for the tip.
    assert_eq!(
        tips(&program("T1 M6\nG0 X0 Y0\nG43 H1 Z5\nG1 Z-1 F9\nG49")),
        [[0.0, 0.0, 5.0], [0.0, 0.0, -1.0]]
    );
    // With one, a wrong H shows: the tip is lower by what the tool is longer.
    let mut table = ReadOptions::default();
    table.tool_offsets.insert(
        1,
        ToolOffset {
            length: 50.0,
            diameter: 6.0,
        },
    );
    table.tool_offsets.insert(
        2,
        ToolOffset {
            length: 80.0,
            diameter: 6.0,
        },
    );
    let z = |text: &str| tips(&program_with(text, &table)).last().unwrap()[2];
    assert_eq!(z("T1 M6\nG0 X0 Y0\nG43 H1 Z5\nG1 Z-1 F9"), -1.0);
    assert_eq!(z("T2 M6\nG0 X0 Y0\nG43 H1 Z5\nG1 Z-1 F9"), -31.0);
    assert_eq!(
        z("T1 M6\nG0 X0 Y0\nG43 H1 Z5\nT2 M6\nG0 X0 Y0 Z5\nG1 Z-1 F9"),
        -31.0,
        "a missing G43"
    );
    assert_eq!(
        z("T1 M6\nG0 X0 Y0\nG43.1 Z50\nG0 Z5\nG1 Z-1 F9"),
        -1.0,
        "words are offsets, not moves"
    );
    assert_eq!(z("T1 M6\nG0 X0 Y0\nG43 H1 G0 Z5\nG43.2 Z3\nG1 Z-1 F9"), 2.0);
    // G10 sets rows of the table.
    assert_eq!(
        z("T1 M6\nG10 L1 P1 Z60\nG0 X0 Y0\nG43 H1 Z5\nG10 L1 P1 Z50\nG43 H1\nG1 Z-1 F9"),
        -1.0
    );
}

#[test]
fn machine_coordinates() {
    // Where the control's variables say where its offsets are, G53 and G28 are moves like others.
    let mut known = ReadOptions::default();
    for (index, value) in [
        (5221, 100.0),
        (5222, 50.0),
        (5223, -200.0),
        (5161, 0.0),
        (5162, 0.0),
        (5163, 0.0),
    ] {
        known.variables.insert(index, value);
    }
    let found = program_with("G0 X0 Y0 Z5\nG53 G0 Z0\nG91 G28 X0\nG90 G0 X1\n", &known);
    assert_near(
        &tips(&found),
        &[
            [100.0, 50.0, -195.0],
            [100.0, 50.0, 0.0],
            [0.0, 50.0, 0.0],
            [101.0, 50.0, 0.0],
        ],
    );
    assert_eq!(found.sections().count(), 1);
    // The point on the way home is a move: into the part, if it says so.
    let found = program("G0 X0 Y0 Z5\nG90 G28 Z-3\nG0 X0 Y0 Z9");
    assert_eq!(tips(&found), [[0.0, 0.0, 5.0], [0.0, 0.0, -3.0], [0.0, 0.0, 9.0]]);
    assert_eq!(found.sections().count(), 2);
}

#[test]
fn work_offsets_of_fanuc() {
    let fanuc = options(Controller::Fanuc);
    let found = program_with(
        "G90\nG10 L2 P0 X1. Y0 Z0\nG10 L2 P1 X10. Y0 Z0\nG10 L20 P3 X20. Y0 Z0\nG54 G0 X0 Y0 Z0\nG54.1 P3 X0\nG91 G10 L2 P1 X5.\nG90 G54 G0 X0",
        &fanuc,
    );
    assert_near(&tips(&found), &[[11.0, 0.0, 0.0], [21.0, 0.0, 0.0], [16.0, 0.0, 0.0]]);
    let found = program_with(
        "G10 L20 P1 X20. Y0 Z0\nG54.1 P1 G0 X0 Y0 Z0\nG110 G0 X1.",
        &options(Controller::Haas),
    );
    assert_near(&tips(&found), &[[20.0, 0.0, 0.0], [21.0, 0.0, 0.0]]);
}

#[test]
fn the_start_can_be_given() {
    let mut start = ReadOptions::default();
    start.start = Some([1.0, 2.0, 3.0]);
    assert_eq!(
        tips(&program_with("G91 G1 X1 F10", &start)),
        [[1.0, 2.0, 3.0], [2.0, 2.0, 3.0]]
    );
}

#[test]
fn bezier_curves() {
    let bezier = |p: [[f64; 2]; 4], t: f64| -> [f64; 2] {
        let s = 1.0 - t;
        std::array::from_fn(|k| {
            s.powi(3) * p[0][k] + 3.0 * s * s * t * p[1][k] + 3.0 * s * t * t * p[2][k] + t.powi(3) * p[3][k]
        })
    };
    // The second curve goes on smoothly.
    let found = program("F100\nG0 X0 Y0 Z1\nG5 X20 Y10 I5 J10 P-4 Q8\nG5 X40 Y0 P-5 Q5\nG1 X50");
    let curves = [
        [[0.0, 0.0], [5.0, 10.0], [16.0, 18.0], [20.0, 10.0]],
        [[20.0, 10.0], [24.0, 2.0], [35.0, 5.0], [40.0, 0.0]],
    ];
    for (line, curve) in [(3, curves[0]), (4, curves[1])] {
        let points: Vec<[f64; 3]> = found
            .poses
            .windows(2)
            .filter(|pair| pair[1].line == line)
            .flat_map(|pair| {
                let (a, b): ([f64; 3], [f64; 3]) = (pair[0].pose.tip(), pair[1].pose.tip());
                [a, std::array::from_fn(|k| 0.5 * (a[k] + b[k])), b]
            })
            .collect();
        assert!(points.len() > 100);
        for point in &points {
            let off = (0..=20_000)
                .map(|k| {
                    let [x, y] = bezier(curve, f64::from(k) / 20_000.0);
                    (point[0] - x).hypot(point[1] - y)
                })
                .fold(f64::MAX, f64::min);
            assert!(off < 2e-3, "{point:?} is {off} from the curve");
        }
        assert_eq!([points[0][0], points[0][1]], curve[0]);
        assert_near(&points[points.len() - 1..], &[[curve[3][0], curve[3][1], 1.0]]);
    }
    let quadratic = program("F100\nG0 X-2 Y4 Z0\nG5.1 X2 I2 J-8");
    for tip in tips(&quadratic) {
        // The parabola y = x².
        assert!((tip[1] - tip[0] * tip[0]).abs() < 1e-9);
    }
}

/// A change of coordinates moves nothing, not even by a rounding.
#[test]
fn offsets_leave_no_moves() {
    let found = program(
        "G10 L2 P2 X0 Y0 Z0\nG55\nG0 X-33.306 Y-11.01 Z2\nG1 X1 F9\nG0 X-33.306 Y-11.01\nG10 L2 P2 Y-101.6\nG55\nZ2\nG1 Y101.6\n",
    );
    assert_near(&tips(&found)[2..], &[[-33.306, -11.01, 2.0], [-33.306, 0.0, 2.0]]);
}
