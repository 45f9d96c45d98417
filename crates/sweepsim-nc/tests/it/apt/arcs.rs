//! Arcs, against an evaluation of their own.

use super::{exact, read, tips};
use std::f64::consts::{PI, TAU};
use sweepsim_motion::TipCourse;
use sweepsim_nc::{ReadOptions, apt, shortest};
use sweepsim_props::*;

fn angle(text: &str) -> f64 {
    let program = exact(text);
    match program.poses.last().unwrap().way().course {
        TipCourse::Arc(arc) => arc.angle(),
        _ => 0.0,
    }
}

#[test]
fn the_sense_is_that_of_the_normal() {
    let quarter = |normal: &str| angle(&format!("GOTO/5,0,1\nCIRCLE/0,0,1,{normal}\nGOTO/0,5,1\n"));
    assert!((quarter("0,0,1") - PI / 2.0).abs() < 1e-12);
    assert!((quarter("0,0,-1") - 1.5 * PI).abs() < 1e-12);
    assert!(
        (quarter("0,0,1.,5,0.06,0.5,10,0") - PI / 2.0).abs() < 1e-12,
        "radius and tolerances"
    );
    // From a part by SolidWorks: the shorter way about -z.
    let text = "GOTO/312.230082,103.235419,-0.5\nCIRCLE/156.54054,50.,-0.5,0,0,-1.\nGOTO/312.230082,-3.235419,-0.5\n";
    assert!((angle(text) - 2.0 * (53.235419_f64 / 155.689542).atan()).abs() < 1e-6);
}

#[test]
fn the_same_end_is_a_full_turn() {
    let text = "GOTO/64.95,59.5,-7.\nCIRCLE/59.5,59.5,-7.,0,0,1.\nGOTO/64.95,59.5,-7.\n";
    assert!((angle(text) - TAU).abs() < 1e-12);
    // Within the digits of the file.
    assert!((angle(&text.replace("GOTO/64.95,59.5,-7.\nC", "GOTO/64.95,59.50001,-7.\nC")) - TAU).abs() < 1e-12);
    // Centre and radius about z (Creo).
    assert!((angle("GOTO/1,0,0\nCIRCLE/0,0,0,1\nGOTO/1,0,0\n") - TAU).abs() < 1e-12);
}

#[test]
fn movarc_ends_by_its_angle_or_by_the_next_point() {
    let by_point = "GOTO/5,0,0\nMOVARC/0,0,0,0,0,1,5,ANGLE,90\nGOTO/0,5,0\n";
    assert_eq!(exact(by_point).poses.len(), 2);
    assert!((angle(by_point) - PI / 2.0).abs() < 1e-12);
    let by_angle = "GOTO/5,0,0\nMOVARC/0,0,0,0,0,1,5,ANGLE,90\nFEDRAT/100,MMPM\nGOTO/0,9,0\n";
    let program = exact(by_angle);
    let tip = program.poses[1].pose.tip();
    assert!((tip[0].abs() < 1e-12) && (tip[1] - 5.0).abs() < 1e-12);
    assert_eq!(
        (program.poses.len(), program.poses[1].line, program.poses[2].line),
        (3, 2, 4)
    );
    assert_eq!(
        exact("GOTO/5,0,0\nMOVARC/0,0,0,0,0,1,5,ANGLE,90\nFINI\n").poses.len(),
        2
    );
    let named = "GOTO/5,0,0\nMOVARC/CENTER,0,0,0,AXIS,0,0,1,RADIUS,5\nGOTO/-5,0,0\n";
    assert!((angle(named) - PI).abs() < 1e-12);
    // Several turns and a rise.
    let helix = "GOTO/5,0,0\nMOVARC/0,0,0,0,0,1,5,ANGLE,1080\nGOTO/5,0,-6\n";
    assert!((angle(helix) - 3.0 * TAU).abs() < 1e-9);
}

#[test]
fn an_arc_after_a_break_starts_with_a_pose() {
    let program = exact("GOTO/5,0,0\nLOAD/TOOL,2\nCIRCLE/0,0,0,0,0,1\nGOTO/0,5,0\n");
    assert_eq!(tips(&program), [[5.0, 0.0, 0.0], [5.0, 0.0, 0.0], [0.0, 5.0, 0.0]]);
    assert_eq!(program.sections().count(), 2);
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = a.iter().map(|c| c * c).sum::<f64>().sqrt();
    a.map(|c| c / length)
}

proptest! {
    /// Centre, normal, radius and angle give the ends; the reader must find the arc, and all its chords on it.
    #[test]
    fn arcs_agree_with_their_parameters(
        centre in prop::array::uniform3(-100.0..100.0_f64),
        normal in prop::array::uniform3(-1.0..1.0_f64),
        side in prop::array::uniform3(-1.0..1.0_f64),
        radius in 0.5..200.0_f64,
        turn in 0.02..6.26_f64,
        rise in -5.0..5.0_f64,
        inch in any::<bool>(),
    ) {
        prop_assume!(normal.iter().map(|c| c * c).sum::<f64>() > 0.01);
        let n = unit(normal);
        let v = cross(n, side);
        prop_assume!(v.iter().map(|c| c * c).sum::<f64>() > 0.01);
        let v = unit(v);
        let u = cross(v, n);
        let at = |angle: f64, rise: f64| -> [f64; 3] {
            std::array::from_fn(|k| centre[k] + radius * (angle.cos() * u[k] + angle.sin() * v[k]) + rise * n[k])
        };
        let words = |point: [f64; 3]| point.map(shortest).join(",");
        let text = format!(
            "UNITS/{}\nGOTO/{}\nCIRCLE/{},{},{}\nGOTO/{}\n",
            if inch { "INCHES" } else { "MM" },
            words(at(0.0, 0.0)), words(centre), words(n), shortest(radius), words(at(turn, rise)),
        );
        let unit = if inch { 25.4 } else { 1.0 };
        let program = exact(&text);
        prop_assert_eq!(program.poses.len(), 2);
        let TipCourse::Arc(arc) = program.poses[1].way().course else { panic!("an arc") };
        prop_assert!((arc.angle() - turn).abs() < 1e-9);
        let mut options = ReadOptions::default();
        options.arc_tolerance = 0.05;
        let chords = apt::read(&text, &options).unwrap();
        let count = chords.poses.len() - 1;
        for (k, pose) in chords.poses.iter().enumerate() {
            let s = k as f64 / count as f64;
            let expected = at(s * turn, s * rise).map(|c| c * unit);
            for (found, expected) in pose.pose.tip().iter().zip(expected) {
                prop_assert!((found - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{} {}", found, expected);
            }
        }
        let sagitta = radius * unit * (1.0 - (0.5 * turn / count as f64).cos());
        prop_assert!(sagitta <= 0.05 * (1.0 + 1e-9));
    }
}

#[test]
fn chords_are_noted() {
    let program = read("GOTO/5,0,0\nCIRCLE/0,0,0,0,0,1\nGOTO/0,5,0\n");
    assert!(program.poses.len() > 10);
    assert!(program.poses[1..].iter().all(|pose| pose.line == 3 && pose.joined));
    assert_eq!(program.notes[0].message, "arcs are divided into chords");
}
