//! Programs of Okuma's controls, in words of our own.

use sweepsim_nc::write::{self, GcodeOptions};
use sweepsim_nc::{Controller, Program, ReadOptions, gcode, read_text};

use crate::found::rounded_tips;

fn read(text: &str) -> Program {
    let name = std::path::Path::new("part.min");
    read_text(text, name, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

const HEAD: &str = "$BRACKET.MIN%\nO1000 (FIRST SIDE)\nN10 G00 G17 G40 G80 G90 G94\nG21\n(T5 D=6. CR=0. - ZMIN=-3. - flat end mill)\nN20 M06 T5\nG15 H1\nG00 X0 Y0\nG56 Z50. H5\n";

#[test]
fn a_program_is_recognised_and_read() {
    let program = read(&format!("{HEAD}G01 Z-1. F100\nX20.\nG53\nG16 H0 G00 Z0\nM02\n"));
    assert_eq!(
        (program.controller, program.title.as_deref()),
        (Some(Controller::Okuma), Some("BRACKET"))
    );
    assert_eq!(program.tools[&5].diameter, Some(6.0));
    assert_eq!(
        rounded_tips(&program),
        [[0.0, 0.0, 50.0], [0.0, 0.0, -1.0], [20.0, 0.0, -1.0]]
    );
    assert!(program.poses.iter().all(|pose| pose.tool == Some(5)));
    // Another offset is elsewhere, under its own name.
    let second = read(&format!("{HEAD}G01 Z-1. F100\nG15 H2\nG00 X0 Y0 Z10.\n"));
    assert_eq!(second.assumptions[0].what, "the place of G15 H2");
    assert!(second.assumptions[0].settle.contains("--offset G15H2="));
    let mut placed = ReadOptions::default();
    placed.offsets.insert("G15H2".into(), [100.0, 0.0, 0.0]);
    let name = std::path::Path::new("part.min");
    let program = read_text(&format!("{HEAD}G01 Z-1. F100\nG15 H2\nG00 X0 Y0 Z10.\n"), name, &placed).unwrap();
    assert_eq!(*rounded_tips(&program).last().unwrap(), [100.0, 0.0, 10.0]);
}

#[test]
fn cycles_return_to_the_level_of_g71() {
    for cycle in ["G81", "G181"] {
        let text = format!("{HEAD}G00 Z20.\nG71 Z30.\n{cycle} X1. Y2. Z-5. R2. F100 M53\nX9. Y2. M54\nG80\nM02\n");
        let program = read(&text);
        assert_eq!(
            rounded_tips(&program)[2..],
            [
                [1.0, 2.0, 20.0],
                [1.0, 2.0, 2.0],
                [1.0, 2.0, -5.0],
                [1.0, 2.0, 30.0],
                [9.0, 2.0, 30.0],
                [9.0, 2.0, 2.0],
                [9.0, 2.0, -5.0],
                [9.0, 2.0, 2.0],
            ],
            "{cycle}"
        );
    }
    let tapped = read(&format!(
        "{HEAD}S500 M03\nG71 Z30.\nG284 X1. Y2. Z-5. R2. F500 M53\nG80\nM02\n"
    ));
    assert!(rounded_tips(&tapped).contains(&[1.0, 2.0, -5.0]));
}

#[test]
fn tip_control_and_offsets_that_turn() {
    let turned = read(&format!("{HEAD}G169\nG01 X1. Y0 Z0 A90. F100\nG170\nM02\n"));
    let axis = turned.poses.last().unwrap().pose.axis();
    assert!(axis[2].abs() < 1e-9 && axis[1].abs() > 0.999, "{axis:?}");
    // As G254: coordinates are along the table that has turned, and the tool is along their z.
    let text = format!(
        "{HEAD}CALL OO88 PH=1 PA=90 PC=0\nG00 A90. C0.\nG00 X1. Y2. Z3.\nG01 Z0. F100\nCALL OO88 PA=0 PC=0\nM02\n"
    );
    let program = read(&text);
    let last = &program.poses[program.poses.len() - 1];
    let (tip, axis) = (last.pose.tip(), last.pose.axis());
    assert!(axis[1].abs() > 0.999 && (tip[0] - 1.0).abs() < 1e-9, "{tip:?} {axis:?}");
    // From Z3 to Z0 it has gone along its own axis.
    let before = program.poses[program.poses.len() - 2].pose.tip();
    let way: Vec<f64> = (0..3).map(|k| before[k] - tip[k]).collect();
    assert!(
        (0..3).all(|k| (way[k] - 3.0 * axis[k]).abs() < 1e-9),
        "{way:?} {axis:?}"
    );
}

#[test]
fn what_is_not_read_says_so() {
    let error = |text: &str| {
        let mut options = ReadOptions::default();
        options.controller = Some(Controller::Okuma);
        gcode::read(text, &options).unwrap_err().to_string()
    };
    assert!(error("G0 X0 Y0 Z0\nG11 X1 Y1 P90\n").contains("2:1: G11: turned coordinates are"));
    let missing = read(&format!("{HEAD}CALL O1234\nG00 X1. Y1. Z5.\n"));
    assert!(missing.assumptions[0].what.contains("O1234") && missing.assumptions[0].changes_verdict);
    let called = read(&format!("{HEAD}G01 Z0 F100\nCALL OO30 PX=1\nG00 X1. Y1. Z5.\n"));
    assert!(called.assumptions[0].what.contains("OO30") && called.assumptions[0].changes_verdict);
    // It is not written.
    let mut options = GcodeOptions::default();
    options.dialect = Controller::Okuma;
    assert!(
        write::gcode(&called, &options)
            .unwrap_err()
            .to_string()
            .contains("okuma are not written")
    );
}
