//! Klartext's approach to contours and departure from them, against the geometry by hand.

use sweepsim_nc::{Program, ReadOptions, heidenhain};

fn read(text: &str) -> Program {
    let mut options = ReadOptions::default();
    options.exact_arcs = true;
    let text = format!("TOOL DEF 1 L+0 R+2\nTOOL CALL 1 Z S9\n{text}");
    heidenhain::read(&text, &options).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Where the moves end, in the plane, from the approach on.
fn ends(text: &str) -> Vec<[f64; 2]> {
    let round = |c: f64| (c * 1e6).round() / 1e6 + 0.0;
    let program = read(text);
    let poses = program.poses.iter().skip(1).map(|pose| pose.pose.tip());
    poses.map(|tip| [round(tip[0]), round(tip[1])]).collect()
}

const UP: &str = "L Y+20\n";

#[test]
fn approaches() {
    for (approach, expected) in [
        // 10 mm before the contour, along it.
        (
            "L X-30 Y-10 Z+0 FMAX\nAPPR LT X+0 Y+0 LEN10 RL F100\n",
            vec![[-2.0, -10.0], [-2.0, 0.0]],
        ),
        (
            "L X-30 Y-10 Z+0 FMAX\nAPPR LT X+0 Y+0 LEN 10 RR F100\n",
            vec![[2.0, -10.0], [2.0, 0.0]],
        ),
        // On its normal, 5 mm and the radius away.
        (
            "L X-30 Y-10 Z+0 FMAX\nAPPR LN X+0 Y+0 LEN5 RL F100\n",
            vec![[-7.0, 0.0], [-2.0, 0.0]],
        ),
        // A quarter of a circle of 10 mm.
        (
            "L X-30 Y-10 Z+0 FMAX\nAPPR CT X+0 Y+0 CCA90 R+10 RL F100\n",
            vec![[-10.0, -8.0], [-2.0, 0.0]],
        ),
        (
            "L X+30 Y-10 Z+0 FMAX\nAPPR CT X+0 Y+0 CCA90 R+10 RR F100\n",
            vec![[10.0, -8.0], [2.0, 0.0]],
        ),
        // A straight line into such a circle.
        (
            "L X-40 Y-10 Z+0 FMAX\nAPPR LCT X+0 Y+0 R10 RL F100\n",
            vec![[-10.0, -8.0], [-2.0, 0.0]],
        ),
        (
            "L X+40 Y-10 Z+0 FMAX\nAPPR LCT X+0 Y+0 R+10 RR F100\n",
            vec![[10.0, -8.0], [2.0, 0.0]],
        ),
    ] {
        let found = ends(&format!("{approach}{UP}L R0 X+90 Y+90 FMAX\n"));
        assert_eq!(found[..expected.len()], expected[..], "{approach}");
    }
    // Down where the tool is beside the auxiliary point.
    let program = read(&format!(
        "L X-40 Y-10 Z+5 FMAX\nAPPR LCT X+0 Y+0 Z-3 R10 RL F100\n{UP}L R0 X+90 FMAX\n"
    ));
    let tips: Vec<[f64; 3]> = program.poses.iter().map(|pose| pose.pose.tip()).collect();
    let down = tips.iter().position(|tip| tip[2] == -3.0).unwrap();
    assert!(
        (tips[down][0] + 10.0).abs() < 1e-9 && (tips[down][1] + 8.0).abs() < 1e-9,
        "{tips:?}"
    );
    // The first element may be an arc about a centre that comes between, and rounded.
    let round = "L X-30 Y-10 Z+0 FMAX\nAPPR LT X+0 Y+0 LEN10 RL F100\nCC X+10 Y+0\nC X+10 Y+10 DR-\nL R0 X+90 FMAX\n";
    assert_eq!(ends(round)[..3], [[-2.0, -10.0], [-2.0, 0.0], [10.0, 12.0]]);
}

#[test]
fn departures() {
    let begin = "L X-30 Y-10 Z+0 FMAX\nAPPR LT X+0 Y+0 LEN10 RL F100\nL Y+20\n";
    for (departure, expected) in [
        ("DEP LT LEN5 F100\n", vec![[-2.0, 20.0], [-2.0, 25.0]]),
        ("DEP LN LEN5 F100\n", vec![[-2.0, 20.0], [-7.0, 20.0]]),
        ("DEP CT CCA90 R+10 F100\n", vec![[-2.0, 20.0], [-10.0, 28.0]]),
        (
            "DEP LCT X-40 Y+30 R10 F100\n",
            vec![[-2.0, 20.0], [-10.0, 28.0], [-40.0, 30.0]],
        ),
    ] {
        let found = ends(&format!("{begin}{departure}"));
        assert_eq!(found[found.len() - expected.len()..], expected[..], "{departure}");
        // Compensation has ended: the next move goes to its own end.
        let next = ends(&format!("{begin}{departure}L X+50 Y+60 FMAX\n"));
        assert_eq!(next.last(), Some(&[50.0, 60.0]), "{departure}");
    }
}

#[test]
fn points_in_polar_coordinates() {
    let cartesian = "L X-30 Y-10 Z+5 FMAX\nAPPR CT X+0 Y+20 Z-3 CCA90 R10 RL F100\nL X+20 Y+0\nDEP LCT X+50 Y+0 R5\n";
    let polar = "CC X+0 Y+0\nL X-30 Y-10 Z+5 FMAX\nAPPR PCT PR+20 PA+90 Z-3 CCA90 R10 RL F100\nLP PA+0\nDEP PLCT PR+50 PA+0 R5\n";
    assert_eq!(ends(polar), ends(cartesian));
    for (polar, cartesian) in [("PLT", "LT"), ("PLN", "LN"), ("PLCT", "LCT")] {
        let text = |kind: &str, point: &str| {
            format!(
                "CC X+0 Y+0\nL X-30 Y-10 Z+5 FMAX\nAPPR {kind} {point} LEN5 R10 RL F100\nCP IPA-90 DR-\nDEP LT LEN9\n"
            )
        };
        assert_eq!(
            ends(&text(polar, "PR+20 PA+90")),
            ends(&text(cartesian, "X+0 Y+20")),
            "{polar}"
        );
    }
}

/// *iTNC 530* (340 420), 6.3: `APPR` with `R0` is that of a tool of radius 0 on the right.
#[test]
fn without_compensation_an_approach_comes_from_the_right() {
    let program = read("L X-30 Y-10 Z+0 FMAX\nAPPR CT X+0 Y+0 CCA90 R10 R0 F100\nL Y+20\nDEP CT CCA90 R10\n");
    let tips: Vec<[f64; 3]> = program.poses.iter().skip(1).map(|pose| pose.pose.tip()).collect();
    let expected = [[10.0, -10.0, 0.0], [0.0; 3], [0.0, 20.0, 0.0], [10.0, 30.0, 0.0]];
    assert_eq!(tips.len(), expected.len());
    assert!(
        tips.iter()
            .flatten()
            .zip(expected.iter().flatten())
            .all(|(a, b)| (a - b).abs() < 1e-9),
        "{tips:?}"
    );
    assert!(
        program.assumptions.iter().any(|one| one.what.contains("APPR")),
        "{:?}",
        program.assumptions
    );
}

/// *TNC 640* (34059x-05), 6.3: as the move before, after a rapid as a rapid; only with `LCT` as the block says.
#[test]
fn the_way_to_the_auxiliary_point_is_that_of_the_move_before() {
    let first = |before: &str, kind: &str| {
        let text =
            format!("L X-40 Y-10 Z+5 {before}\nAPPR {kind} X+0 Y+0 Z-3 LEN5 CCA90 R10 RL F100\nL Y+20\nDEP LT LEN5\n");
        let program = read(&text);
        let at = |number: usize| (program.poses[number].rapid, program.poses[number].feed);
        (at(1), at(2), at(3))
    };
    for kind in ["LT", "LN", "CT"] {
        assert_eq!(
            first("FMAX", kind),
            ((true, None), (false, Some(100.0)), (false, Some(100.0))),
            "{kind}"
        );
        assert_eq!(first("F900", kind).0, (false, Some(900.0)), "{kind}");
    }
    assert_eq!(first("FMAX", "LCT").0, (false, Some(100.0)));
}

#[test]
fn what_an_approach_cannot_know_is_an_error() {
    let error = |text: &str| {
        let text = format!("TOOL DEF 1 L+0 R+2\nTOOL CALL 1 Z S9\nL X-30 Y-10 Z+0 FMAX\n{text}");
        heidenhain::read(&text, &ReadOptions::default())
            .unwrap_err()
            .to_string()
    };
    assert!(
        error("APPR LT X+0 Y+0 LEN10 RL F100\nCT X+10 Y+20\n").starts_with("4:1: APPR before a block of this kind is")
    );
    assert!(error("APPR PT X+0 Y+0\nL X+9\n").starts_with("4:1: APPR PT is not supported yet"));
    assert!(error("APPR PLT PR+10 PA+0 LEN9 RL\nL X+9\n").contains("polar coordinates without a pole"));
    assert!(error("APPR LCT X-29 Y-10 R10 RL\nL Y+20\n").contains("the radius of APPR LCT is 10"));
    assert!(
        error("DEP LT LEN9\n").starts_with("4:1: DEP without a contour before it")
            || !error("DEP LT LEN9\n").is_empty()
    );
}
