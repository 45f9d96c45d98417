//! Cycles on contours of all controls, against the geometry of their shapes.

use sweepsim_nc::{Program, ReadOptions, heidenhain, siemens};

type Flat = [f64; 2];

fn options() -> ReadOptions {
    let mut options = ReadOptions::default();
    options.diameters.insert(1, 6.0);
    options
}

fn klartext(text: &str) -> Program {
    let text = format!("TOOL CALL 1 Z S9\nL X+0 Y+0 Z+50 R0 FMAX\n{text}");
    heidenhain::read(&text, &options()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn sinumerik(text: &str) -> Program {
    let text = format!("T1 D1\nM6\nG0 X0 Y0 Z50\n{text}");
    siemens::read(&text, &options()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn distance(p: Flat, [a, b]: [Flat; 2]) -> f64 {
    let way = [b[0] - a[0], b[1] - a[1]];
    let square = way[0] * way[0] + way[1] * way[1];
    let s = ((p[0] - a[0]) * way[0] + (p[1] - a[1]) * way[1]) / square;
    let s = if square > 0.0 { s.clamp(0.0, 1.0) } else { 0.0 };
    (p[0] - a[0] - s * way[0]).hypot(p[1] - a[1] - s * way[1])
}

/// The edges of a polygon.
fn edges(points: &[Flat]) -> Vec<[Flat; 2]> {
    (0..points.len())
        .map(|k| [points[k], points[(k + 1) % points.len()]])
        .collect()
}

fn holds(points: &[Flat], [x, y]: Flat) -> bool {
    let crosses = |[a, b]: [Flat; 2]| (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
    edges(points).into_iter().filter(|edge| crosses(*edge)).count() % 2 == 1
}

/// The straight cuts at a level, and whether all cuts are at or above it.
fn cuts(program: &Program, level: f64) -> Vec<[Flat; 2]> {
    let mut found = Vec::new();
    let mut last: Option<[f64; 3]> = None;
    for pose in program.poses.iter() {
        let tip = pose.pose.tip();
        assert!(tip[2] >= level - 1e-9, "{tip:?}");
        if let Some(from) = last.filter(|from| !pose.rapid && from[2] == level && tip[2] == level) {
            found.push([[from[0], from[1]], [tip[0], tip[1]]]);
        }
        last = Some(tip);
    }
    found
}

const POCKET: [Flat; 4] = [[-40.0, -25.0], [40.0, -25.0], [40.0, 25.0], [-40.0, 25.0]];
/// With a corner to the inside.
const ISLAND: [Flat; 5] = [[-10.0, -8.0], [15.0, -8.0], [15.0, 10.0], [2.0, 1.0], [-10.0, 10.0]];

/// All that a tool of this radius reaches between the pocket and the island is taken at a level, and nothing else.
#[track_caller]
fn takes_the_area(program: &Program, level: f64, radius: f64, left: f64) {
    let all: Vec<[Flat; 2]> = edges(&POCKET).into_iter().chain(edges(&ISLAND)).collect();
    let cuts = cuts(program, level);
    let clear = |p: Flat| all.iter().map(|edge| distance(p, *edge)).fold(f64::INFINITY, f64::min);
    for cut in &cuts {
        for s in 0..=4 {
            let p: Flat = std::array::from_fn(|k| cut[0][k] + 0.25 * f64::from(s) * (cut[1][k] - cut[0][k]));
            assert!(
                clear(p) >= radius + left - 1e-5 && holds(&POCKET, p) && !holds(&ISLAND, p),
                "{p:?}"
            );
        }
    }
    let (mut tried, mut near) = (0, 0);
    let reached = |p: Flat| cuts.iter().any(|cut| distance(p, *cut) <= radius + 1e-3);
    for i in -79..80 {
        for j in -49..50 {
            let p = [0.5 * f64::from(i) + 0.13, 0.5 * f64::from(j) + 0.17];
            // Where the tool's middle may be, all is taken.
            if holds(&POCKET, p) && !holds(&ISLAND, p) && clear(p) >= radius + left {
                assert!(reached(p), "{p:?} is left");
                tried += 1;
            }
        }
    }
    // And so is what is just beside the middle of each edge.
    for [a, b] in &all {
        let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        let long = (b[0] - a[0]).hypot(b[1] - a[1]);
        for side in [-1.0, 1.0] {
            let off = side * (left + 0.01);
            let p = [
                middle[0] - off * (b[1] - a[1]) / long,
                middle[1] + off * (b[0] - a[0]) / long,
            ];
            if holds(&POCKET, p) && !holds(&ISLAND, p) {
                assert!(reached(p), "beside {middle:?}");
                near += 1;
            }
        }
    }
    assert!(tried > 5000 && near == 9, "{tried} {near}");
}

/// The blocks of a contour: from its first point around.
fn around(points: &[Flat], first: &str, word: fn(Flat) -> String) -> String {
    let mut text = format!("{}{first}\n", word(points[0]));
    for k in 1..=points.len() {
        text += &format!("{}\n", word(points[k % points.len()]));
    }
    text
}

fn klartext_contours(cycle: &str) -> String {
    let word = |[x, y]: Flat| format!("L X{x:+} Y{y:+}");
    format!(
        "CYCL DEF 14.0 CONTOUR\nCYCL DEF 14.1 CONTOUR LABEL1 /2\n\
         CYCL DEF 20 CONTOUR DATA ~\nQ1=-10 ~\nQ2=+1 ~\nQ3=+0.5 ~\nQ4=+1 ~\nQ5=+2 ~\nQ6=+2 ~\nQ7=+60\n{cycle}CYCL CALL\n\
         L Z+90 FMAX M30\nLBL 1\n{}LBL 0\nLBL 2\n{}LBL 0\n",
        around(&POCKET, " RL", word),
        around(&ISLAND, " RR", word)
    )
}

#[test]
fn roughing_leaves_the_allowance() {
    let program = klartext(&klartext_contours("CYCL DEF 22 ROUGH-OUT Q10=-4 Q11=100 Q12=500\n"));
    takes_the_area(&program, -7.0, 3.0, 0.5);
    // Levels 4 mm apart, from the surface at 2 mm to 1 mm above the bottom.
    let mut levels: Vec<f64> = program
        .poses
        .iter()
        .filter(|pose| !pose.rapid)
        .map(|pose| pose.pose.tip()[2])
        .collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    assert_eq!(levels, [-7.0, -6.0, -2.0]);
    // The floor and the edges alone.
    takes_the_area(
        &klartext(&klartext_contours(
            "CYCL DEF 23 FLOOR Q11=100 Q12=500\nCYCL CALL\nCYCL DEF 24 SIDES Q9=+1 Q10=-20 Q11=100 Q12=500 Q14=0.5\n",
        )),
        -8.0,
        3.0,
        0.5,
    );
}

#[test]
fn siemens_takes_the_same() {
    let word = |[x, y]: Flat| format!("G1 X{x} Y{y}");
    let contour = |name: &str, points: &[Flat]| {
        format!(
            "E_LAB_A_{name}: ;#SM Z:2\nG17 G90 DIAMOF\n{}E_LAB_E_{name}:\n",
            around(points, "", word)
        )
    };
    let text = format!(
        "CYCLE62(\"POCKET\",1,,)\nCYCLE62(\"ISLAND\",1,,)\n\
         CYCLE63(\"P\",1,50,2,2,-8,500,100,3,4,0.5,1,0,,,,,,1,2,,,,0,100201,101)\nG0 Z60\nM30\n{}{}",
        contour("POCKET", &POCKET),
        contour("ISLAND", &ISLAND)
    );
    takes_the_area(&sinumerik(&text), -7.0, 3.0, 0.5);
    let along = |side: i32| {
        let text = format!(
            "CYCLE62(\"POCKET\",1,,)\nCYCLE72(\"\",50,2,2,-8,0,0,0,500,100,1,{side},1,3,100,1,3)\nM30\n{}",
            contour("POCKET", &POCKET)
        );
        cuts(&sinumerik(&text), -8.0)
    };
    let extent = |cuts: &[[Flat; 2]]| cuts.iter().flatten().map(|p| p[0]).fold(f64::NEG_INFINITY, f64::max);
    // On the contour, within it (left of it, counter-clockwise), and around it.
    let found = [40, 41, 42].map(|side| extent(&along(side)));
    assert!(
        found.iter().zip([40.0, 37.0, 43.0]).all(|(a, b)| (a - b).abs() < 1e-6),
        "{found:?}"
    );
    // Around its corners the tool keeps its distance.
    let all = edges(&POCKET);
    for [a, b] in along(42) {
        let p = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        let off = all.iter().map(|edge| distance(p, *edge)).fold(f64::INFINITY, f64::min);
        assert!((3.0 - 1e-5..3.002).contains(&off), "{off}");
    }
}

#[test]
fn a_contour_train_keeps_its_side() {
    let text = "CYCL DEF 14.0 CONTOUR\nCYCL DEF 14.1 CONTOUR LABEL1\n\
                CYCL DEF 25 CONTOUR TRAIN Q1=-5 Q3=0 Q5=0 Q7=50 Q10=-5 Q11=100 Q12=500 Q15=1\nCYCL CALL\nM30\n\
                LBL 1\nL X+0 Y+0 RR\nL X+30\nCC X+30 Y+10\nC X+40 Y+10 DR+\nL Y+40\nLBL 0\n";
    let cuts = cuts(&klartext(text), -5.0);
    let points: Vec<Flat> = cuts.iter().flatten().copied().collect();
    // Right of the contour: below its first line, around its corner, beside its last.
    assert_eq!(points.first(), Some(&[0.0, -3.0]));
    assert!(distance(*points.last().unwrap(), [[43.0, 40.0]; 2]) < 2e-3);
    for p in points.iter().filter(|p| p[0] > 30.0 && p[1] < 10.0) {
        let off = (p[0] - 30.0).hypot(p[1] - 10.0);
        assert!((13.0 - 2e-3..13.0 + 2e-3).contains(&off), "{off}");
    }
}

#[test]
fn contours_that_are_not_understood_are_said() {
    let missing =
        klartext("CYCL DEF 14.0 CONTOUR\nCYCL DEF 14.1 CONTOUR LABEL7\nCYCL DEF 22 ROUGH-OUT Q10=-4\nCYCL CALL\n");
    let said = &missing.assumptions[0];
    assert!(said.changes_verdict && said.what == "the moves of cycle 22", "{said}");
    let missing = sinumerik("CYCLE62(\"NONE\",1,,)\nCYCLE63(\"P\",1,50,2,2,-8,500)\nCYCLE64(\"P\",1)\nG1 X5 F9\n");
    let mut said: Vec<&str> = missing.assumptions.iter().map(|one| one.what.as_str()).collect();
    said.sort_unstable();
    let orders = ["CYCLE62", "CYCLE63"].map(|name| format!("the order of the parameters of {name}"));
    assert_eq!(
        said,
        ["the moves of CYCLE63", "the moves of CYCLE64", &orders[0], &orders[1]]
    );
    // They may change the verdict, and are not taken where nothing may be assumed.
    assert!(missing.assumptions.iter().all(|one| one.changes_verdict));
    let mut strict = options();
    strict.strict = true;
    for call in [
        "CYCLE78(50,0,2,-9,,,,8,1.25,1,0)",
        "CYCLE70(50,0,2,-9,20,1,0,1.5,1,0,500,0,10,20)",
    ] {
        let error = siemens::read(&format!("T1 D1\nM6\nG0 X0 Y0 Z50\n{call}\n"), &strict)
            .unwrap_err()
            .to_string();
        assert!(error.contains("no manual was at hand"), "{error}");
    }
    assert_eq!(missing.poses.last().unwrap().pose.tip(), [5.0, 0.0, 50.0]);
}

/// The distances from an axis at which the tool cuts at a level.
fn radii(program: &Program, level: f64, [x, y]: Flat) -> [f64; 2] {
    let cuts = cuts(program, level);
    let radii = || cuts.iter().flatten().map(|p| (p[0] - x).hypot(p[1] - y));
    assert!(cuts.len() > 20);
    [radii().fold(f64::INFINITY, f64::min), radii().fold(0.0, f64::max)]
}

#[test]
fn circular_slots() {
    // 10 mm wide about (5, 5) at a radius of 30 mm, from 20 degrees on for 70.
    let klartext = klartext(
        "CYCL DEF 254 CIRCULAR SLOT Q215=0 Q219=10 Q368=0 Q375=60 Q367=0 Q216=5 Q217=5 Q376=20 Q248=70 Q378=0 Q377=1 \
         Q207=500 Q351=1 Q201=-4 Q202=4 Q369=0 Q206=100 Q338=0 Q200=2 Q203=0 Q204=50\nCYCL CALL\n",
    );
    let siemens = sinumerik("SLOT2(50,0,2,-4,,1,70,10,5,5,30,20,0,100,500,4,0,0,0)\n");
    for program in [&klartext, &siemens] {
        let [inner, outer] = radii(program, -4.0, [5.0, 5.0]);
        assert!(
            (inner - 28.0).abs() < 2e-3 && (outer - 32.0).abs() < 2e-3,
            "{inner} {outer}"
        );
        let cuts = cuts(program, -4.0);
        let angles = || {
            cuts.iter()
                .flatten()
                .map(|p| (p[1] - 5.0).atan2(p[0] - 5.0).to_degrees())
        };
        // Its ends are half circles about the ends of its middle line.
        let end = (2.0_f64 / 30.0).asin().to_degrees();
        let (first, last) = (angles().fold(f64::MAX, f64::min), angles().fold(f64::MIN, f64::max));
        assert!(
            (first - (20.0 - end)).abs() < 0.02 && (last - (90.0 + end)).abs() < 0.02,
            "{first} {last}"
        );
    }
    let tips = |program: &Program| program.poses.iter().filter(|pose| !pose.rapid).count();
    assert_eq!(tips(&klartext), tips(&siemens));
}

#[test]
fn threads_within_and_around() {
    let cycle = |number: u32, more: &str| {
        let text = format!(
            "L X+10 Y+20 FMAX\nCYCL DEF {number} THREAD Q335=20 Q239=1.5 Q201=-9 Q200=2 Q203=0 Q204=50 Q207=500 {more}\nCYCL CALL\n"
        );
        let program = klartext(&text);
        let deep = program.poses.iter().map(|pose| pose.pose.tip()[2]).fold(0.0, f64::min);
        let at_depth = |pose: &&sweepsim_nc::ProgramPose| pose.pose.tip()[2] == -9.0 && !pose.rapid;
        let poses = program.poses.iter().filter(at_depth);
        let radii: Vec<f64> = poses
            .map(|pose| (pose.pose.tip()[0] - 10.0).hypot(pose.pose.tip()[1] - 20.0))
            .collect();
        (deep, radii)
    };
    for number in [262, 263, 264, 265] {
        let (deep, radii) = cycle(number, "Q356=-12 Q202=3");
        assert_eq!(deep, if matches!(number, 263 | 264) { -12.0 } else { -9.0 }, "{number}");
        assert!(radii.iter().all(|radius| *radius < 7.0 + 1e-9), "{radii:?}");
        assert!(radii.iter().filter(|radius| (*radius - 7.0).abs() < 1e-9).count() > 10);
    }
    // Around a stud the tool is never within.
    let (deep, radii) = cycle(267, "");
    assert!(
        deep == -9.0 && radii.iter().all(|radius| *radius > 13.0 - 1e-9),
        "{radii:?}"
    );
    let around = sinumerik(
        "CYCLE70(50,0,2,-9,20,1,0,1.5,1,0,500,0,10,20,0,0,0)\nCYCLE70(50,0,2,-9,20,1,0,1.5,1,0,500,1,10,60,0,0,0)\n",
    );
    let low = around
        .poses
        .iter()
        .filter(|pose| pose.pose.tip()[2] == -9.0 && !pose.rapid);
    let off = |pose: &sweepsim_nc::ProgramPose, y: f64| (pose.pose.tip()[0] - 10.0).hypot(pose.pose.tip()[1] - y);
    let found: Vec<[f64; 2]> = low.map(|pose| [off(pose, 20.0), off(pose, 60.0)]).collect();
    assert!(found.iter().any(|[within, _]| (within - 7.0).abs() < 1e-9));
    assert!(found.iter().any(|[_, around]| (around - 12.0).abs() < 1e-9));
    assert!(
        found
            .iter()
            .all(|[within, around]| *within < 7.0 + 1e-9 || *around > 12.0 - 1e-9)
    );
}

#[test]
fn faces_go_over_their_edges_but_not_over_walls() {
    let bounds = |cycle: &str| {
        let program = klartext(&format!("L X-30 Y-20 FMAX\nCYCL DEF {cycle}\nCYCL CALL\n"));
        let tips: Vec<[f64; 3]> = program
            .poses
            .iter()
            .filter(|pose| !pose.rapid)
            .map(|pose| pose.pose.tip())
            .collect();
        let bound = |k: usize, pick: fn(f64, f64) -> f64, start: f64| tips.iter().map(|tip| tip[k]).fold(start, pick);
        [0, 1, 2].map(|k| [bound(k, f64::min, f64::INFINITY), bound(k, f64::max, f64::NEG_INFINITY)])
    };
    let sides = "Q218=60 Q219=40 Q227=2.5 Q386=0 Q369=0 Q202=1 Q370=1 Q207=500 Q200=2 Q204=50";
    let near = |a: [[f64; 2]; 3], b: [[f64; 2]; 3]| {
        (0..3).all(|k| (a[k][0] - b[k][0]).abs() < 1e-9 && (a[k][1] - b[k][1]).abs() < 1e-9)
    };
    // The middle of the tool comes to the edge, so that all of it is taken; on the side with a wall, beside it.
    let from_corner = bounds(&format!("232 FACE Q389=2 Q225=-30 Q226=-20 {sides}"));
    assert!(
        near(from_corner, [[-30.0, 30.0], [-20.0, 20.0], [0.0, 1.5]]),
        "{from_corner:?}"
    );
    assert_eq!(bounds(&format!("233 FACE Q215=0 Q389=2 {sides}")), from_corner);
    let walled = bounds(&format!("233 FACE Q215=0 Q389=2 Q347=1 Q348=-2 {sides}"));
    assert!(near(walled, [[-30.0, 27.0], [-17.0, 20.0], [0.0, 1.5]]), "{walled:?}");
}

#[test]
fn patterns_of_a_cycle() {
    let places = |pattern: &str| {
        let text = format!("CYCL DEF 200 DRILLING Q200=2 Q201=-5 Q206=100 Q202=5 Q203=0 Q204=20\n{pattern}\n");
        let program = klartext(&text);
        let bottoms = program.poses.iter().filter(|pose| !pose.rapid);
        bottoms
            .map(|pose| pose.pose.tip().map(|c| (c * 1e6).round() / 1e6 + 0.0))
            .collect::<Vec<_>>()
    };
    let circle =
        places("CYCL DEF 220 CIRCLE Q216=10 Q217=0 Q244=20 Q245=0 Q246=360 Q247=0 Q241=4 Q200=2 Q203=3 Q204=20");
    assert_eq!(
        circle,
        [
            [20.0, 0.0, -2.0],
            [10.0, 10.0, -2.0],
            [0.0, 0.0, -2.0],
            [10.0, -10.0, -2.0]
        ]
    );
    let rows = places("CYCL DEF 221 ROWS Q225=1 Q226=2 Q237=10 Q238=5 Q242=2 Q243=2 Q224=0");
    assert_eq!(
        rows,
        [[1.0, 2.0, -5.0], [11.0, 2.0, -5.0], [11.0, 7.0, -5.0], [1.0, 7.0, -5.0]]
    );
}
