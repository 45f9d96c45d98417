//! Contours worked out by hand.

use sweepsim_motion::TipCourse;
use sweepsim_nc::{EventKind, ReadOptions};

use super::{assert_near, options, read, tips};
use crate::pieces::samples;

#[test]
fn a_square_by_hand() {
    let square = "T1 D1 F100\nG0 X-10 Y-5 Z0\nG1 G42 X0 Y0\nX10\nY10\nX0\nM8\nG40 X-20 Y20\n";
    // Round corners: quarter circles; the entry ends beside the start of the next move, the exit begins beside the end of the last one.
    let found = read(square, false, &options(2.0));
    let expected = [
        [-10.0, -5.0, 0.0],
        [0.0, -1.0, 0.0],
        [10.0, -1.0, 0.0],
        [11.0, 0.0, 0.0],
        [11.0, 10.0, 0.0],
        [10.0, 11.0, 0.0],
        [0.0, 11.0, 0.0],
        [-20.0, 20.0, 0.0],
    ];
    assert_near(&tips(&found), &expected);
    let lines: Vec<usize> = found.poses.iter().map(|pose| pose.line).collect();
    assert_eq!(lines, [2, 3, 4, 5, 5, 6, 6, 8]);
    // Coolant comes after the last side, of which the end waits for the exit.
    let coolant = found
        .events
        .iter()
        .find(|event| matches!(event.kind, EventKind::Coolant(_)))
        .unwrap();
    assert_eq!((coolant.pose, coolant.line), (7, 7));
    let klartext =
        "TOOL CALL 1 Z S9\nL X-10 Y-5 Z+0 R0 FMAX\nL X+0 Y+0 RR F100\nL X+10\nL Y+10 RR\nL X+0\nM8\nL X-20 Y+20 R0\n";
    assert_near(&tips(&read(klartext, true, &options(2.0))), &expected);
    // To the meetings.
    let found = read(&square.replace("G42", "G451 G42"), false, &options(2.0));
    assert_near(
        &tips(&found)[1..],
        &[
            [0.0, -1.0, 0.0],
            [11.0, -1.0, 0.0],
            [11.0, 11.0, 0.0],
            [0.0, 11.0, 0.0],
            [-20.0, 20.0, 0.0],
        ],
    );
    // In a mirrored frame the tool is on the mirrored side; a radius of the program itself; an allowance.
    let mut own = ReadOptions::default();
    own.exact_arcs = true;
    let text = format!("$TC_DP6[1,1]=0.5 OFFN=0.5\nMIRROR X0\n{square}");
    let mirrored = read(&text, false, &own);
    let expected: Vec<[f64; 3]> = [
        [10.0, -5.0, 0.0],
        [0.0, -1.0, 0.0],
        [-10.0, -1.0, 0.0],
        [-11.0, 0.0, 0.0],
    ]
    .into();
    assert_near(&tips(&mirrored)[..4], &expected);
    // Inside, with a move along Z between the sides; D0 and tool 0 have no radius.
    let inside = "T1 D1 F100\nG0 X-10 Y0 Z0\nG1 G41 X0 Y0\nX10\nZ-1\nY10\nG40 Y20\n";
    assert_near(
        &tips(&read(inside, false, &options(2.0))),
        &[
            [-10.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [9.0, 1.0, 0.0],
            [9.0, 1.0, -1.0],
            [9.0, 10.0, -1.0],
            [10.0, 20.0, -1.0],
        ],
    );
}

/// *Sinumerik 808D*, Special cases of the tool radius compensation: the last move ends at right angles to it, the block with
/// the code begins anew.
#[test]
fn the_side_changes_on_siemens_as_if_compensation_began_anew() {
    let text = |code: &str| format!("T1 D1 F100\nG0 X-10 Y0 Z0\nG1 G41 X0\nX10\n{code} X20\nX30\nG40 X40\n");
    let ends = |code: &str| tips(&read(&text(code), false, &options(2.0)));
    let expected = |side: f64| {
        [
            [-10.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [10.0, 1.0, 0.0],
            [20.0, side, 0.0],
            [30.0, side, 0.0],
            [40.0, 0.0, 0.0],
        ]
    };
    assert_near(&ends("G42"), &expected(-1.0));
    assert_near(&ends("G41"), &expected(1.0));
    // Even into an inside corner.
    let inside = "T1 D1 F100\nG0 X-10 Y0 Z0\nG1 G41 X0\nX10\nG41 Y10\nY20\nG40 Y30\n";
    assert_near(
        &tips(&read(inside, false, &options(2.0)))[2..5],
        &[[10.0, 1.0, 0.0], [9.0, 10.0, 0.0], [9.0, 20.0, 0.0]],
    );
}

#[test]
fn oversizes_of_heidenhain() {
    let text = |call: &str| {
        format!(
            "TOOL DEF 7 L+50 R+1\nTOOL CALL 7 Z S9 {call}\nL X-10 Y+0 Z+0 R0 FMAX\nL X+0 Y+0 RL F100\nL X+10\nL Y+10 R0\n"
        )
    };
    let read = |call: &str| tips(&read(&text(call), true, &ReadOptions::default()));
    assert_near(
        &read(""),
        &[[-10.0, 0.0, 0.0], [0.0, 1.0, 0.0], [10.0, 1.0, 0.0], [10.0, 10.0, 0.0]],
    );
    // The tool is taken for longer and wider than it is: it stays as far away.
    assert_near(
        &read("DL+0.25 DR+0.5 DR2+0.1"),
        &[
            [-10.0, 0.0, 0.25],
            [0.0, 1.5, 0.25],
            [10.0, 1.5, 0.25],
            [10.0, 10.0, 0.25],
        ],
    );
    // Along the tool where it is turned; arcs go with it.
    let turned = "TOOL CALL 1 Z S9 DL+2\nL X+0 Y+0 Z+0 FMAX\nM128\nL B+90 C+0 F9\nL X+1\n";
    let last = *tips(&super::read(turned, true, &ReadOptions::default()))
        .last()
        .unwrap();
    assert_near(&[last], &[[3.0, 0.0, 0.0]]);
    let arc = "TOOL CALL 1 Z S9 DL+2\nL X+5 Y+0 Z+0 FMAX\nCC X+0 Y+0\nC X+0 Y+5 DR+ F9\n";
    let program = super::read(arc, true, &options(1.0));
    let _ = samples(&program, 0..2);
    assert_near(&tips(&program), &[[5.0, 0.0, 2.0], [0.0, 5.0, 2.0]]);
    // A call without a tool keeps it where it is: Z of the program is another.
    let kept = "TOOL CALL 1 Z S9\nL X+0 Y+0 Z+0 FMAX\nTOOL CALL Z S9 DL+2\nL X+1 F9\nL Z+0\n";
    let found = tips(&super::read(kept, true, &ReadOptions::default()));
    assert_near(&found, &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 2.0]]);
}

#[test]
fn corners_that_meet_on_arcs() {
    // A line along X to the origin, then an arc about (0, -5) of radius 5, turning right; the tool of radius 1 on the left, outside. Tangential:
    // no corner. Then a line down from (5, -5): tangential again.
    let text = "T1 D1 F9\nG0 X-10 Y0 Z0\nG1 G41 G451 X-5 Y0\nX0\nG2 X5 Y-5 I0 J-5\nG1 Y-10\nG40 X20\n";
    let found = read(text, false, &options(2.0));
    assert_near(
        &tips(&found)[1..],
        &[
            [-5.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            [6.0, -5.0, 0.0],
            [6.0, -10.0, 0.0],
            [20.0, -10.0, 0.0],
        ],
    );
    // Up along Y to (0, 0), then an arc about (3, 0) from (0, 0), clockwise, which begins upwards: tangential. From (-4, 0) along X, the corner
    // at the origin is inside of 90° on the left: the offsets y = 1 and the circle of radius 4 about (3, 0) meet in (3 - √15, 1).
    let text = "T1 D1 F9\nG0 X-10 Y0 Z0\nG1 G41 X-4 Y0\nX0\nG2 X6 Y0 I3 J0\nG1 X9\nG40 Y20\n";
    let found = read(text, false, &options(2.0));
    let _ = samples(&found, 0..found.poses.len());
    let x = 3.0 - 15_f64.sqrt();
    assert_near(&tips(&found)[2..4], &[[x, 1.0, 0.0], [6.0 - x, 1.0, 0.0]]);
    // On the right it is an outside corner, where y = -1 and the circle of radius 2 meet in (3 - √3, -1), beyond both ends.
    let text = "T1 D1 F9\nG0 X-10 Y0 Z0\nG1 G42 G451 X-4 Y0\nX0\nG2 X3 Y3 I3 J0\nG1 X9\nG40 Y20\n";
    let found = read(text, false, &options(2.0));
    let _ = samples(&found, 0..found.poses.len());
    assert_near(&tips(&found)[2..4], &[[3.0 - 3_f64.sqrt(), -1.0, 0.0], [3.0, 2.0, 0.0]]);
}

/// Numbers are rounded to 0.001 mm: lines and arcs that are meant to be tangential are not, and their offsets miss each
/// other.
#[test]
fn tangential_moves_of_rounded_numbers() {
    for (corner, contour) in [
        ("G451", "G1 X3.696 Y18.881\nG2 X13.713 Y26.484 I9.271 J-1.815\nG1 X23\n"),
        (
            "G450",
            "G1 X1.855 Y-3.448\nG3 X7.541 Y-2.718 I2.703 J1.454\nG3 X6.160 Y-2.731 I-0.684 J-0.697\n",
        ),
    ] {
        for side in ["G41", "G42"] {
            let text = format!("T1 D1 F100 {corner}\nG0 X-2 Y-10 Z0\nG1 {side} X0 Y0\n{contour}G1 G40 X0 Y60\n");
            let program = read(&text, false, &options(0.5));
            assert!(program.notes.is_empty(), "{text}{:?}", program.notes);
        }
    }
}

#[test]
fn corner_words() {
    let mut exact = ReadOptions::default();
    exact.exact_arcs = true;
    let go = |corner: &str| tips(&read(&format!("F9 G0 X0 Y0 Z0\nG1 X10 {corner}\nY10\n"), false, &exact));
    assert_near(
        &go("RND=2"),
        &[[0.0; 3], [8.0, 0.0, 0.0], [10.0, 2.0, 0.0], [10.0, 10.0, 0.0]],
    );
    assert_near(
        &go("CHR=2"),
        &[[0.0; 3], [8.0, 0.0, 0.0], [10.0, 2.0, 0.0], [10.0, 10.0, 0.0]],
    );
    assert_near(
        &go("CHF=2*SQRT(2)"),
        &[[0.0; 3], [8.0, 0.0, 0.0], [10.0, 2.0, 0.0], [10.0, 10.0, 0.0]],
    );
    // At an angle of 60° between the lines, the chamfer is as long as what it cuts off.
    let sharp = read(
        "F9 G0 X0 Y0 Z0\nG1 X10 CHF=3\nX=IC(-5) Y=IC(5*SQRT(3))\n",
        false,
        &exact,
    );
    assert_near(&tips(&sharp)[1..3], &[[7.0, 0.0, 0.0], [8.5, 1.5 * 3_f64.sqrt(), 0.0]]);
    // Modal, until RNDM=0, with a feed of its own; not where a move leaves the plane, which is a note.
    let modal = read(
        "F9 G0 X0 Y0 Z0\nG1 RNDM=1 FRCM=5 X10\nY10\nZ-1\nX0\nRNDM=0 Y0\nX5\n",
        false,
        &exact,
    );
    assert_near(
        &tips(&modal),
        &[
            [0.0; 3],
            [9.0, 0.0, 0.0],
            [10.0, 1.0, 0.0],
            [10.0, 10.0, 0.0],
            [10.0, 10.0, -1.0],
            [1.0, 10.0, -1.0],
            [0.0, 9.0, -1.0],
            [0.0, 0.0, -1.0],
            [5.0, 0.0, -1.0],
        ],
    );
    assert_eq!(
        (modal.poses[1].feed, modal.poses[2].feed, modal.poses[3].feed),
        (Some(9.0), Some(5.0), Some(9.0))
    );
    assert!(
        modal.notes.iter().any(|note| note.message.contains("RNDM is not made")),
        "{:?}",
        modal.notes
    );
    // Rounded, then compensated: the inside corner of radius 3 becomes one of radius 2.
    let both = read(
        "T1 D1 F9\nG0 X-5 Y0 Z0\nG1 G41 X0 Y0\nX10 RND=3\nY10\nG40 Y20\n",
        false,
        &options(2.0),
    );
    assert_near(
        &tips(&both)[1..],
        &[
            [0.0, 1.0, 0.0],
            [7.0, 1.0, 0.0],
            [9.0, 3.0, 0.0],
            [9.0, 10.0, 0.0],
            [10.0, 20.0, 0.0],
        ],
    );
    // Where numbers are rounded, a line may go on at an angle of almost nothing: no corner.
    for turned in ["X20 Y0.00000001", "X20 Y0.000001", "X20 Y-0.000002"] {
        assert_eq!(go(&format!("RND=2\n{turned} RNDM=5")).len(), 5, "{turned}");
    }
    // A line and an arc that are tangential but for rounding, as RNDM finds them.
    let tangential = "F9 G0 X0 Y0 Z0\nG1 RNDM=2.178 X-2.157 Y1.669\nG2 X-4.257 Y4.751 I3.693 J4.773\n";
    assert_eq!(tips(&read(tangential, false, &exact)).len(), 3);
    // Before a rapid, too: the rounding is no rapid.
    let before_rapid = read("F9 G0 X0 Y0 Z0\nG1 RNDM=2 X10\nG0 Y10\nZ5\n", false, &exact);
    assert_near(
        &tips(&before_rapid),
        &[
            [0.0; 3],
            [8.0, 0.0, 0.0],
            [10.0, 2.0, 0.0],
            [10.0, 10.0, 0.0],
            [10.0, 10.0, 5.0],
        ],
    );
    let rapids: Vec<bool> = before_rapid.poses.iter().map(|pose| pose.rapid).collect();
    assert_eq!(rapids, [true, false, false, true, true]);
    // The rounding of Klartext has the line of its block, and its feed.
    let klartext = read("L X+0 Y+0 Z+0 FMAX\nL X+10 F9\nRND R2 F4\nL Y+10\n", true, &exact);
    let lines: Vec<(usize, Option<f64>)> = klartext.poses.iter().map(|pose| (pose.line, pose.feed)).collect();
    assert_eq!(lines, [(1, None), (2, Some(9.0)), (3, Some(4.0)), (4, Some(9.0))]);
}

#[test]
fn lines_by_their_angle() {
    let text = "F100 G0 X0 Y0 Z0\nG1 ANG=45 X10\nG91 Y10 ANG=120 RND=1\nG90 X20 ANG=0\nG18 Z10 ANG=30\nG0 ANG=90 X0\n";
    let found = tips(&read(text, false, &options(2.0)));
    let x = 10.0 - 10.0 / 3.0_f64.sqrt();
    let up = 20.0 + 10.0 * 30.0_f64.to_radians().tan();
    assert_near(&found[1..2], &[[10.0, 10.0, 0.0]]);
    assert_near(&found[4..], &[[20.0, 20.0, 0.0], [up, 20.0, 10.0], [0.0, 20.0, 10.0]]);
    let length = |a: [f64; 3], b: [f64; 3]| (a[0] - b[0]).hypot(a[1] - b[1]);
    // Rounded at (x, 20), where the lines meet at 60 degrees.
    let cut = 3.0_f64.sqrt();
    assert!((length(found[2], [x, 20.0, 0.0]) - cut).abs() < 1e-9 && (found[3][0] - x - cut).abs() < 1e-9);
    for (block, expected) in [
        ("G1 ANG=30", "ANG without an end"),
        ("G1 X5 Y5 ANG=30", "ANG beside both"),
        ("G1 X5 ANG=90", "ANG is 90"),
        ("G2 X5 ANG=30 CR=9", "ANG beside both"),
    ] {
        let error = sweepsim_nc::siemens::read(&format!("F100 G0 X0 Y0 Z0\n{block}\n"), &options(2.0));
        let error = error.unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn polar_coordinates_and_tangential_arcs() {
    let mut exact = ReadOptions::default();
    exact.exact_arcs = true;
    let end = |text: &str| *tips(&read(text, false, &exact)).last().unwrap();
    let (sin, cos) = 30_f64.to_radians().sin_cos();
    assert_near(
        &[end("G0 X1 Y2 Z3\nG111 X10 Y20\nG0 AP=30 RP=4")],
        &[[10.0 + 4.0 * cos, 20.0 + 4.0 * sin, 3.0]],
    );
    assert_near(
        &[end("G0 X1 Y2 Z3\nG110 X10 Y20\nG0 AP=30 RP=4 Z0")],
        &[[11.0 + 4.0 * cos, 22.0 + 4.0 * sin, 0.0]],
    );
    assert_near(
        &[end("G111 X10 Y20\nG112 AP=90 RP=5\nG0 Z0 AP=30 RP=4")],
        &[[10.0 + 4.0 * cos, 25.0 + 4.0 * sin, 0.0]],
    );
    // Both stay until the next pole; the angle may go on from the last one.
    assert_near(
        &[end("G111 X0 Y0\nG0 Z0 AP=10 RP=4\nRP=6\nAP=IC(20)")],
        &[[6.0 * cos, 6.0 * sin, 0.0]],
    );
    // An arc about the pole.
    let program = read("F9 G111 X1 Y1\nG0 Z0 AP=0 RP=5\nG3 AP=90\n", false, &exact);
    let last = program.poses.last().unwrap();
    let TipCourse::Arc(arc) = last.way().course else {
        panic!()
    };
    assert_near(&[last.pose.tip(), arc.centre()], &[[1.0, 6.0, 0.0], [1.0, 1.0, 0.0]]);
    // CT continues the line along X with an arc about (10, 5), then that one with another about (10, 0).
    let program = read("F9 G0 X0 Y0 Z0\nG1 X10\nCT X15 Y5\nCT X5 Y5\nG1 X0\n", false, &exact);
    let centres: Vec<[f64; 3]> = program.poses[2..4]
        .iter()
        .map(|pose| match pose.way().course {
            TipCourse::Arc(arc) => arc.centre(),
            _ => panic!(),
        })
        .collect();
    assert_near(&centres, &[[10.0, 5.0, 0.0], [10.0, 5.0, 0.0]]);
}
