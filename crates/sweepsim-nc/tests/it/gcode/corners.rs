//! Rounded corners, chamfers and angles of Fanuc's kind: `,R`, `,C` and `,A`.

use sweepsim_motion::TipCourse;
use sweepsim_nc::{Controller, gcode};

use super::{assert_near, options, tips};

fn read(text: &str) -> Result<sweepsim_nc::Program, sweepsim_nc::NcError> {
    let mut given = options(Controller::Fanuc);
    given.exact_arcs = true;
    given.diameters.insert(1, 2.0);
    gcode::read(text, &given)
}

#[test]
fn corners_of_lines_and_arcs() {
    let text = "G21 G90 G0 X0. Y0. Z0.\nG1 X20. ,R5. F100\nY20. ,C3.\nM8\nX0. , R 2.\nG3 X0. Y10. J-5.\nG1 X-9.\n";
    let program = read(text).unwrap();
    assert_near(
        &tips(&program)[..7],
        &[
            [0.0, 0.0, 0.0],
            [15.0, 0.0, 0.0],
            [20.0, 5.0, 0.0],
            [20.0, 17.0, 0.0],
            [17.0, 20.0, 0.0],
            [0.0, 20.0, 0.0],
            [0.0, 10.0, 0.0],
        ],
    );
    let TipCourse::Arc(arc) = program.poses[2].way().course else {
        panic!("an arc")
    };
    let centre: [f64; 3] = arc.centre();
    assert_near(&[centre], &[[15.0, 5.0, 0.0]]);
    // In another plane, incremental, in inches, by a variable.
    let text = "G20 G19 G91 G0 X0. Y0. Z0.\n#1=0.2\nG1 Y2. ,R#1 F10\nZ2.\n";
    let found = tips(&read(text).unwrap());
    assert_near(&found[1..3], &[[0.0, 1.8 * 25.4, 0.0], [0.0, 2.0 * 25.4, 0.2 * 25.4]]);
    // First rounded, then compensated.
    let text = "G21 G90 G0 X-5. Y0. Z0.\nG1 G41 D1 X0. F100\nX10. ,R3.\nY10.\nG40 Y20.\n";
    assert_near(
        &tips(&read(text).unwrap())[1..4],
        &[[0.0, 1.0, 0.0], [7.0, 1.0, 0.0], [9.0, 3.0, 0.0]],
    );
}

#[test]
fn lines_by_their_angle() {
    let text = "G21 G90 G0 X0. Y0. Z0.\nG1 X10. ,A45. F100\nG91 Y10. ,A120.\nG18 G90 Z10. ,A0.\nG0 X0. Y0. Z0.\nX7. ,A90. Y4.\n";
    let error = read(text).unwrap_err().to_string();
    assert!(error.contains("6:") && error.contains(",A"), "{error}");
    let found = tips(&read(text.rsplit_once("X7.").unwrap().0).unwrap());
    let x = 10.0 - 10.0 / 3.0_f64.sqrt();
    assert_near(&found[1..4], &[[10.0, 10.0, 0.0], [x, 20.0, 0.0], [x, 20.0, 10.0]]);
}

#[test]
fn corners_that_cannot_be_made_are_errors() {
    for (text, expected) in [
        ("G1 X10. ,R2. F100\nG0 Y10.\n", ",R at a rapid"),
        ("G0 X10. ,R2.\nG1 Y10. F100\n", ",R at a rapid"),
        ("G1 X10. ,C2. F100\nZ5.\n", ",C at corners out of the plane"),
        ("G1 X10. ,R9. F100\nY5.\n", "the radius of ,R is 9"),
        ("G1 X10. F100\n,R2.\n", ",R without a move"),
        ("G1 X10. ,A90. F100\n", ",A"),
        ("G1 X10. Y5. ,A0. F100\n", ",A"),
        ("G1 ,A0. F100\n", ",A without"),
        ("G1 X10. ,R-2. F100\nY9.\n", ",R"),
        ("G1 X10. ,S2. F100\n", "','"),
    ] {
        let error = read(&format!("G21 G90 G0 X0. Y0. Z0.\n{text}"))
            .unwrap_err()
            .to_string();
        assert!(error.contains(expected), "{text}{error}");
    }
    let mut given = options(Controller::LinuxCnc);
    given.strict = true;
    let error = gcode::read("G0 X0 Y0 Z0\nG1 X9 ,R2 F9\nY9\n", &given)
        .unwrap_err()
        .to_string();
    assert!(error.contains(",R"), "{error}");
}
