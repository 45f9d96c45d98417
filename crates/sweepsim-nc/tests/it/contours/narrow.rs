//! Slots that three or more moves make narrower than the tool.

use sweepsim_nc::{Controller, ReadOptions, gcode};
use sweepsim_props::*;

use super::{Dialect, contour_program, options, read};
use crate::pieces::{Piece, samples};

/// The walls of a bottle from inside: down its neck of this width, round the belly and up the neck.
fn bottle(width: f64, waist: f64) -> Vec<Piece> {
    let w = 0.5 * width;
    let points = [
        [-w, 40.0],
        [-w, 20.0],
        [-20.0, 20.0],
        [-20.0, 0.0],
        [0.0, waist],
        [20.0, 0.0],
        [20.0, 20.0],
        [w, 20.0],
        [w, 40.0],
    ];
    points.windows(2).map(|pair| Piece::Line(pair[0], pair[1])).collect()
}

fn warnings(text: &str, dialect: Dialect, radius: f64) -> Vec<String> {
    let program = read(text, dialect == Dialect::Klartext, &options(2.0 * radius));
    let notes = program.notes.iter().map(ToString::to_string);
    notes.filter(|note| note.contains("does not fit between")).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// A warning if, and only if, the tool comes nearer than its radius to the contour, by sampling.
    #[test]
    fn narrow_necks_are_noticed(width in 1.0..12.0_f64, radius in 0.5..4.0_f64, waist in -8.0..8.0_f64, klartext in any::<bool>()) {
        let dialect = if klartext { Dialect::Klartext } else { Dialect::Siemens { meetings: false } };
        let contour = bottle(width, waist);
        let text = contour_program(&contour, true, dialect);
        let program = read(&text, klartext, &options(2.0 * radius));
        let nearest = samples(&program, 1..program.poses.len() - 1)
            .into_iter()
            .flat_map(|point| contour.iter().map(move |piece| piece.distance(point)).collect::<Vec<_>>())
            .fold(f64::MAX, f64::min);
        let found = warnings(&text, dialect, radius);
        if nearest < radius - 0.02 {
            prop_assert!(found.len() == 1, "{nearest} {radius} {found:?}\n{text}");
        } else if nearest > radius - 0.005 {
            prop_assert!(found.is_empty(), "{nearest} {radius} {found:?}\n{text}");
        }
    }
}

#[test]
fn the_lines_of_a_narrow_slot() {
    // The neck is 3 mm wide, the tool 4: beside one wall it is 1 mm from the corner at the end of the other.
    let contour = bottle(3.0, -5.0);
    for dialect in [Dialect::Siemens { meetings: true }, Dialect::Klartext] {
        let text = contour_program(&contour, true, dialect);
        let line = text.lines().position(|line| line.contains("Y20")).unwrap() + 1;
        assert_eq!(
            warnings(&text, dialect, 2.0),
            [format!(
                "line {}: the tool of radius 2 mm does not fit between the moves of lines {line} and {}: it goes 1.000 mm into the contour",
                line + 6,
                line + 6
            )]
        );
        assert!(warnings(&text, dialect, 1.4).is_empty());
    }
    let mut text = String::from("G0 X-1.5 Y50 Z0\nF100\nG1 G41.1 D4 Y40\n");
    for piece in &contour {
        let Piece::Line(_, [x, y]) = piece else { unreachable!() };
        text += &format!("X{x} Y{y}\n");
    }
    text += "G40 X99 Y99\n";
    for controller in [Controller::LinuxCnc, Controller::Fanuc] {
        let mut options = ReadOptions::default();
        options.controller = Some(controller);
        let found = gcode::read(&text, &options).unwrap();
        let found: Vec<String> = found.notes.iter().map(ToString::to_string).collect();
        let expected = "the tool of radius 2 mm does not fit between the moves of lines 4 and 10: it goes 1.000 mm into the contour";
        assert!(found.iter().any(|note| note.ends_with(expected)), "{found:?}");
    }
}

/// On arcs from outside and back out again, which cross the tool's way along the first and the last move.
#[test]
fn arcs_to_a_contour_and_from_it_are_no_walls() {
    let text = "G20 G90 G17 G0 X0. Y1.25 Z-0.3\nG1 G41 D2 X-0.5 F50.\nG3 X0. Y0.75 R0.5\nG1 X1.94\nG2 X2. Y0.69 R0.06\nG1 Y-0.69\n\
        G2 X1.94 Y-0.75 R0.06\nG1 X-1.94\nG2 X-2. Y-0.69 R0.06\nG1 Y0.69\nG2 X-1.94 Y0.75 R0.06\nG1 X0.\nG3 X0.5 Y1.25 R0.5\n\
        G1 G40 X0.\n";
    for controller in [Controller::LinuxCnc, Controller::Haas] {
        let mut options = ReadOptions::default();
        options.controller = Some(controller);
        options.diameters.insert(2, 0.375 * 25.4);
        let notes = gcode::read(text, &options).unwrap().notes;
        assert!(
            notes.iter().all(|note| !note.message.contains("does not fit")),
            "{notes:?}"
        );
    }
}
