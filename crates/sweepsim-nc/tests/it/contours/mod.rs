//! Cutter compensation, rounded corners and chamfers on Siemens's and Heidenhain's controls, against offsets computed independently.

mod across;
mod by_hand;
mod errors;
mod narrow;

use std::fmt::Write as _;

use sweepsim_motion::TipCourse;
use sweepsim_nc::{Program, ReadOptions, ToolOffset, heidenhain, siemens};
use sweepsim_props::*;

use crate::found::{assert_near, tips};
use crate::pieces::{Piece, distance_to_point, polygon, rounded_rectangle, samples, star};

#[derive(Clone, Copy, Debug, PartialEq)]
enum Dialect {
    /// Siemens: arcs (G450) or meetings (G451) round outside corners.
    Siemens {
        meetings: bool,
    },
    Klartext,
}

fn options(diameter: f64) -> ReadOptions {
    let mut options = ReadOptions::default();
    options.exact_arcs = true;
    options.tool_offsets.insert(1, ToolOffset { length: 0.0, diameter });
    options
}

fn read(text: &str, klartext: bool, options: &ReadOptions) -> Program {
    let found = if klartext {
        heidenhain::read(text, options)
    } else {
        siemens::read(text, options)
    };
    found.unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The program of a closed contour with a tangential entry of 10 mm, and a straight exit.
fn contour_program(contour: &[Piece], left: bool, dialect: Dialect) -> String {
    let Piece::Line(a, b) = contour[0] else {
        panic!("begin with a line")
    };
    let length = distance_to_point(a, b);
    let start = [0, 1].map(|k| a[k] - 10.0 * (b[k] - a[k]) / length);
    let mut text = String::new();
    match dialect {
        Dialect::Siemens { meetings } => {
            let corner = if meetings { 451 } else { 450 };
            let _ = writeln!(text, "T1 D1 F100 G{corner}\nG0 X{:.9} Y{:.9} Z0", start[0], start[1]);
            let side = if left { 41 } else { 42 };
            let _ = writeln!(text, "G1 G{side} X{:.9} Y{:.9}", a[0], a[1]);
            for piece in contour {
                text += &piece.block();
            }
            text += "G40 G1 X500 Y500\n";
        }
        Dialect::Klartext => {
            let _ = writeln!(
                text,
                "TOOL CALL 1 Z S100\nL X{:.9} Y{:.9} Z+0 R0 FMAX",
                start[0], start[1]
            );
            let side = if left { "RL" } else { "RR" };
            let _ = writeln!(text, "L X{:.9} Y{:.9} {side} F100", a[0], a[1]);
            for piece in contour {
                let _ = match *piece {
                    Piece::Line(_, b) => writeln!(text, "L X{:.9} Y{:.9}", b[0], b[1]),
                    Piece::Arc(_, b, c, ccw) => {
                        let sense = if ccw { "DR+" } else { "DR-" };
                        writeln!(
                            text,
                            "CC X{:.9} Y{:.9}\nC X{:.9} Y{:.9} {sense}",
                            c[0], c[1], b[0], b[1]
                        )
                    }
                };
            }
            text += "L X+500 Y+500 R0\n";
        }
    }
    text
}

fn check_distance(contour: &[Piece], left: bool, radius: f64, dialect: Dialect) -> Result<(), String> {
    let text = contour_program(contour, left, dialect);
    let program = read(&text, dialect == Dialect::Klartext, &options(2.0 * radius));
    if let Some(note) = program.notes.iter().find(|note| note.message.contains("does not fit")) {
        return Err(format!("{note}\n{text}"));
    }
    let points = samples(&program, 1..program.poses.len() - 1);
    assert!(points.len() > 10 * contour.len());
    // The offsets of a corner of 100° meet farthest from it.
    let most = match dialect {
        Dialect::Siemens { meetings: true } => radius / 50_f64.to_radians().cos(),
        _ => radius,
    };
    let mut beyond = false;
    for point in points {
        let distance = contour
            .iter()
            .map(|piece| piece.distance(point))
            .fold(f64::MAX, f64::min);
        if distance < radius - 1e-6 || distance > most + 1e-6 {
            return Err(format!(
                "{point:?} is {distance} from the contour, the radius is {radius}\n{text}"
            ));
        }
        beyond |= distance > radius + 1e-6;
    }
    if beyond && dialect != (Dialect::Siemens { meetings: true }) {
        return Err("round corners keep the distance".into());
    }
    let Piece::Line(a, b) = contour[0] else { unreachable!() };
    let tip: [f64; 3] = program.poses[1].pose.tip();
    let side = (b[0] - a[0]) * (tip[1] - a[1]) - (b[1] - a[1]) * (tip[0] - a[0]);
    assert_eq!(side > 0.0, left);
    Ok(())
}

fn dialects() -> impl Strategy<Value = Dialect> {
    prop_oneof![
        Just(Dialect::Siemens { meetings: false }),
        Just(Dialect::Siemens { meetings: true }),
        Just(Dialect::Klartext)
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, ..ProptestConfig::default() })]

    #[test]
    fn the_tool_keeps_its_distance_from_polygons(
        radii in collection::vec(20.0..30.0_f64, 4..9),
        left in any::<bool>(),
        reverse in any::<bool>(),
        radius in 0.1..1.0_f64,
        dialect in dialects(),
    ) {
        let mut points = star(&radii);
        if reverse {
            points.reverse();
        }
        let result = check_distance(&polygon(&points), left, radius, dialect);
        prop_assert!(result.is_ok(), "{}", result.unwrap_err());
    }

    #[test]
    fn the_tool_keeps_its_distance_from_arcs(
        corner in 1.5..9.0_f64,
        outside in any::<bool>(),
        left in any::<bool>(),
        bulge in any::<bool>(),
        radius in 0.1..1.4_f64,
        klartext in any::<bool>(),
    ) {
        let dialect = if klartext { Dialect::Klartext } else { Dialect::Siemens { meetings: false } };
        let result = check_distance(&rounded_rectangle(corner, bulge.then_some(outside)), left, radius, dialect);
        prop_assert!(result.is_ok(), "{}", result.unwrap_err());
    }

    /// A corner of two lines, or of a line and an arc: the rounding touches both, has its radius, and begins and ends on them.
    #[test]
    fn rounded_corners_touch_both_moves(
        radius in 0.2..2.0_f64,
        angle in prop_oneof![20.0..160.0_f64, 200.0..340.0_f64],
        bow in prop_oneof![Just(None), (12.0..40.0_f64).prop_map(Some), (-40.0..-12.0_f64).prop_map(Some)],
        first_is_arc in any::<bool>(),
        klartext in any::<bool>(),
    ) {
        // Along X to the origin, or from there along the chord of an arc with the radius |bow|; in the other order where `first_is_arc`.
        let (sin, cos) = angle.to_radians().sin_cos();
        let far = [20.0 * cos, 20.0 * sin];
        let (start, end) = if first_is_arc { (far, [-20.0, 0.0]) } else { ([-20.0, 0.0], far) };
        // The centre of the arc between the origin and `far`.
        let centre = bow.map(|bow| {
            let height = (bow * bow - 100.0_f64).sqrt().copysign(bow);
            [0.5 * far[0] - height * sin, 0.5 * far[1] + height * cos]
        });
        let ccw = |from: [f64; 2], to: [f64; 2], c: [f64; 2]| {
            (from[0] - c[0]) * (to[1] - c[1]) - (from[1] - c[1]) * (to[0] - c[0]) > 0.0
        };
        let go = |from: [f64; 2], to: [f64; 2], curved: bool| match centre.filter(|_| curved) {
            None if klartext => format!("L X{:.12} Y{:.12} F9\n", to[0], to[1]),
            None => format!("G1 X{:.12} Y{:.12}", to[0], to[1]),
            Some(c) if klartext => {
                let sense = if ccw(from, to, c) { "DR+" } else { "DR-" };
                format!("CC X{:.12} Y{:.12}\nC X{:.12} Y{:.12} {sense} F9\n", c[0], c[1], to[0], to[1])
            }
            Some(c) => format!(
                "G{} X{:.12} Y{:.12} I=AC({:.12}) J=AC({:.12})",
                if ccw(from, to, c) { 3 } else { 2 }, to[0], to[1], c[0], c[1]
            ),
        };
        let (one, two) = (go(start, [0.0; 2], first_is_arc), go([0.0; 2], end, !first_is_arc));
        let text = if klartext {
            format!("L X{:.12} Y{:.12} Z+0 FMAX\n{one}RND R{radius:.12}\n{two}", start[0], start[1])
        } else {
            format!("F9 G0 X{:.12} Y{:.12} Z0\n{one} RND={radius:.12}\n{two}\n", start[0], start[1])
        };
        let mut options = ReadOptions::default();
        options.exact_arcs = true;
        let found = if klartext { heidenhain::read(&text, &options) } else { siemens::read(&text, &options) };
        // The angle between the moves, where the arc leaves the corner.
        let between = centre.map(|c| {
            let side = (c[0] * far[1] - c[1] * far[0]).signum();
            (side * c[1] / distance_to_point(c, [0.0; 2])).acos().to_degrees()
        });
        let program = match found {
            // Moves that turn by no more than one degree have no corner.
            Ok(program) if program.poses.len() == 3 => {
                prop_assert!(between.is_some_and(|between| between > 178.99), "{text}");
                return Err(TestCaseError::reject("no corner"));
            }
            Ok(program) => program,
            // The corner takes more than the moves have: 20 mm.
            Err(error) => {
                prop_assert!(error.to_string().contains("must be smaller"), "{error}\n{text}");
                let Some(between) = between else { panic!("lines have room for each of these corners: {text}") };
                let half = (0.5 * between.to_radians()).tan();
                // The wedge ends where the arc bends back to the line.
                prop_assert!(radius / half > 5.0_f64.min(8.0 * half), "{error}\n{text}");
                return Err(TestCaseError::reject("no room for the corner"));
            }
        };
        let _ = samples(&program, 0..program.poses.len());
        prop_assert_eq!(program.poses.len(), 4, "{}", text);
        prop_assert!(between.is_none_or(|between| between < 179.01), "{text}");
        let TipCourse::Arc(arc) = program.poses[2].way().course else { panic!("{text}") };
        let c: [f64; 3] = arc.centre();
        let c = [c[0], c[1]];
        let ends: [[f64; 2]; 2] = [1, 2].map(|k: usize| { let tip: [f64; 3] = program.poses[k].pose.tip(); [tip[0], tip[1]] });
        for (end, curved) in ends.into_iter().zip([first_is_arc, !first_is_arc]) {
            prop_assert!((distance_to_point(end, c) - radius).abs() < 1e-8, "{text}");
            match centre.filter(|_| curved) {
                // On the line, and the centre straight above it.
                None => {
                    let line = if bow.is_none() && curved { [cos, sin] } else { [1.0, 0.0] };
                    prop_assert!((end[0] * line[1] - end[1] * line[0]).abs() < 1e-8, "{text}");
                    prop_assert!(((c[0] - end[0]) * line[0] + (c[1] - end[1]) * line[1]).abs() < 1e-8, "{text}");
                }
                // On the circle, and in line with both centres.
                Some(big) => {
                    let far = bow.unwrap_or(0.0).abs();
                    prop_assert!((distance_to_point(end, big) - far).abs() < 1e-8, "{text}");
                    let between = distance_to_point(c, big);
                    prop_assert!((between - far - radius).abs() < 1e-8 || (between - (far - radius).abs()).abs() < 1e-8, "{text}");
                }
            }
        }
        prop_assert!(arc.angle() < std::f64::consts::PI, "{}", text);
    }
}
