//! Pockets, slots and studs of cycles: what the tool takes is the shape, point by point.

use sweepsim_motion::TipCourse;
use sweepsim_nc::{Program, ReadOptions, heidenhain, siemens};

/// A shape from which material is taken, and the depth of its floor.
struct Taken {
    /// How far a point of the plane is within it; 0 where either will do.
    inside: fn(f64, f64) -> f64,
    size: f64,
    floor: f64,
}

fn options() -> ReadOptions {
    let mut options = ReadOptions::default();
    options.diameters.insert(1, 6.0);
    options.arc_tolerance = 1e-4;
    options
}

/// The chords of all feed moves, with their height.
fn chords(program: &Program) -> Vec<([f64; 3], [f64; 3])> {
    let poses: Vec<_> = program.poses.iter().collect();
    let pairs = poses.windows(2).filter(|pair| pair[1].joined && !pair[1].rapid);
    pairs
        .map(|pair| {
            assert!(
                !matches!(pair[1].way().course, TipCourse::Arc(_)),
                "chords were asked for"
            );
            (pair[0].pose.tip(), pair[1].pose.tip())
        })
        .collect()
}

/// Checks on a grid of points that the tool of 6 mm takes the shape at its floor, and nothing else: `inside` is the distance into it.
#[track_caller]
fn check(program: &Program, shape: &Taken) {
    let chords = chords(program);
    let deepest = chords.iter().map(|(_, to)| to[2]).fold(f64::INFINITY, f64::min);
    assert!((deepest - shape.floor).abs() < 1e-9, "the floor is at {deepest}");
    let reach = |x: f64, y: f64| {
        let distance = |(a, b): &([f64; 3], [f64; 3])| {
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let long = dx * dx + dy * dy;
            let t = if long > 0.0 {
                (((x - a[0]) * dx + (y - a[1]) * dy) / long).clamp(0.0, 1.0)
            } else {
                0.0
            };
            (x - a[0] - t * dx).hypot(y - a[1] - t * dy)
        };
        let floor = chords.iter().filter(|(a, b)| a[2] == deepest && b[2] == deepest);
        floor.map(distance).fold(f64::INFINITY, f64::min)
    };
    let (mut taken, mut kept) = (0, 0);
    for i in -40..=40 {
        for j in -40..=40 {
            let (x, y) = (f64::from(i) * shape.size / 40.0, f64::from(j) * shape.size / 40.0);
            let (inside, near) = ((shape.inside)(x, y), reach(x, y));
            if inside > 0.01 {
                assert!(near <= 3.0 + 1e-3, "({x}, {y}) is left standing: {near}");
                taken += 1;
            } else if inside < -0.01 {
                assert!(near >= 3.0 - 1e-3, "({x}, {y}) is taken: {near}");
                kept += 1;
            }
        }
    }
    assert!(taken > 200 && kept > 200, "{taken} and {kept} points");
}

/// How far a point is within a rectangle with round corners.
fn rounded(x: f64, y: f64, half: [f64; 2], corner: f64) -> f64 {
    let (dx, dy) = (x.abs() - half[0] + corner, y.abs() - half[1] + corner);
    corner - dx.max(0.0).hypot(dy.max(0.0)) - dx.max(dy).min(0.0)
}

fn klartext(cycle: &str) -> Program {
    let text = format!("TOOL CALL 1 Z S3000\n{cycle}\nL X+0 Y+0 Z+50 R0 FMAX M3\nCYCL CALL\n");
    heidenhain::read(&text, &options()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

const LEVELS: &str = "Q201=-10 Q202=4 Q206=100 Q200=2 Q203=+0 Q204=20 Q207=500 Q351=+1 Q370=1";

#[test]
fn klartext_pockets() {
    let rectangle = klartext(&format!(
        "CYCL DEF 251 Q215=0 Q218=40 Q219=30 Q220=5 Q224=0 Q367=0 {LEVELS}"
    ));
    check(
        &rectangle,
        &Taken {
            inside: |x, y| rounded(x, y, [20.0, 15.0], 5.0),
            size: 30.0,
            floor: -10.0,
        },
    );
    // Three levels of at most 4 mm.
    let mut levels: Vec<f64> = chords(&rectangle).iter().map(|(_, to)| to[2]).collect();
    levels.dedup();
    assert_eq!(levels, [-4.0, -8.0, -10.0]);
    let [said] = &rectangle.assumptions[..] else {
        panic!("{:?}", rectangle.assumptions)
    };
    assert!(said.what.contains("cycle 251") && !said.changes_verdict);
    let circle = klartext(&format!("CYCL DEF 252 Q215=0 Q223=30 {LEVELS}"));
    check(
        &circle,
        &Taken {
            inside: |x, y| 15.0 - x.hypot(y),
            size: 25.0,
            floor: -10.0,
        },
    );
    let slot = klartext(&format!("CYCL DEF 253 Q215=0 Q218=40 Q219=8 Q374=90 Q367=0 {LEVELS}"));
    check(
        &slot,
        &Taken {
            inside: |x, y| rounded(y, x, [20.0, 4.0], 4.0),
            size: 25.0,
            floor: -10.0,
        },
    );
    // As wide as the tool: to and fro.
    let narrow = klartext(&format!("CYCL DEF 253 Q215=0 Q218=40 Q219=6 Q374=0 Q367=0 {LEVELS}"));
    check(
        &narrow,
        &Taken {
            inside: |x, y| rounded(x, y, [20.0, 3.0], 3.0),
            size: 25.0,
            floor: -10.0,
        },
    );
    // From a corner, turned: the middle is at (0, 25).
    let corner = klartext(&format!(
        "CYCL DEF 251 Q215=0 Q218=40 Q219=30 Q220=3 Q224=45 Q367=1 {LEVELS}"
    ));
    check(
        &corner,
        &Taken {
            inside: |x, y| {
                let s = 0.5_f64.sqrt();
                let (a, b) = (s * (x + y), s * (y - x));
                rounded(a - 20.0, b - 15.0, [20.0, 15.0], 3.0)
            },
            size: 40.0,
            floor: -10.0,
        },
    );
    // Roughing leaves something on the sides and on the floor.
    let rough = klartext(&format!(
        "CYCL DEF 251 Q215=1 Q218=40 Q219=30 Q220=5 Q368=0.5 Q369=0.25 {LEVELS}"
    ));
    check(
        &rough,
        &Taken {
            inside: |x, y| rounded(x, y, [19.5, 14.5], 4.5),
            size: 30.0,
            floor: -9.75,
        },
    );
    // A tool that is too wide.
    let text = format!("TOOL CALL 1 Z S1\nCYCL DEF 253 Q218=40 Q219=5 {LEVELS}\nL X+0 Y+0 Z+50 FMAX\nCYCL CALL");
    let error = heidenhain::read(&text, &options()).unwrap_err().to_string();
    assert!(error.contains("at least as wide as the tool, 6"), "{error}");
}

#[test]
fn klartext_studs() {
    let stud = klartext(&format!("CYCL DEF 256 Q218=30 Q424=44 Q219=20 Q425=34 Q220=4 {LEVELS}"));
    // All of the raw stud but the stud is taken.
    check(
        &stud,
        &Taken {
            inside: |x, y| {
                let stud = -rounded(x, y, [15.0, 10.0], 4.0);
                let raw = rounded(x, y, [22.0, 17.0], 0.0);
                if stud > 0.0 && raw < 0.0 { 0.0 } else { stud }
            },
            size: 26.0,
            floor: -10.0,
        },
    );
    let round = klartext(&format!("CYCL DEF 257 Q223=20 Q222=40 {LEVELS}"));
    check(
        &round,
        &Taken {
            inside: |x, y| {
                let far = x.hypot(y);
                if far > 20.0 { 0.0 } else { far - 10.0 }
            },
            size: 24.0,
            floor: -10.0,
        },
    );
}

fn sinumerik(text: &str) -> Program {
    let text = format!("T1 M6\nG0 X50 Y60 Z50\n{text}\nM30\n");
    siemens::read(&text, &options()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

#[test]
fn siemens_milling_cycles() {
    let rectangle = sinumerik("POCKET3(50,0,2,-10,40,30,5,0,0,0,4,0,0,500,100,0,1)");
    check(
        &rectangle,
        &Taken {
            inside: |x, y| rounded(x, y, [20.0, 15.0], 5.0),
            size: 30.0,
            floor: -10.0,
        },
    );
    let turned = sinumerik("POCKET3(50,0,2,-10,40,30,5,1,2,90,4,0,0,500,100,0,1)");
    check(
        &turned,
        &Taken {
            inside: |x, y| rounded(y - 2.0, x - 1.0, [20.0, 15.0], 5.0),
            size: 30.0,
            floor: -10.0,
        },
    );
    let circle = sinumerik("POCKET4(50,0,2,-10,15,1,2,4,0,0,500,100,0,1)");
    check(
        &circle,
        &Taken {
            inside: |x, y| 15.0 - (x - 1.0).hypot(y - 2.0),
            size: 25.0,
            floor: -10.0,
        },
    );
    // Finishing goes along the shape alone; roughing leaves what is said.
    let rough = sinumerik("POCKET4(50,0,2,-10,15,1,2,4,0.5,0.25,500,100,0,1)");
    check(
        &rough,
        &Taken {
            inside: |x, y| 14.5 - (x - 1.0).hypot(y - 2.0),
            size: 25.0,
            floor: -9.75,
        },
    );
    let stud = sinumerik("CYCLE77(50,0,2,-10,,20,0,0,4,0,0,500,100,0,1,40)");
    check(
        &stud,
        &Taken {
            inside: |x, y| if x.hypot(y) > 20.0 { 0.0 } else { x.hypot(y) - 10.0 },
            size: 24.0,
            floor: -10.0,
        },
    );
    let slots = sinumerik("SLOT1(50,0,2,-10,,2,20,8,0,0,5,0,180,100,500,4,0,0)");
    check(
        &slots,
        &Taken {
            inside: |x, y| rounded(x.abs() - 15.0, y, [10.0, 4.0], 4.0),
            size: 32.0,
            floor: -10.0,
        },
    );
    let long = sinumerik("LONGHOLE(50,0,2,-10,,4,20,0,0,5,0,90,100,500,4)");
    check(
        &long,
        &Taken {
            inside: |x, y| {
                rounded(x.abs() - 15.0, y, [10.0, 3.0], 3.0).max(rounded(y.abs() - 15.0, x, [10.0, 3.0], 3.0))
            },
            size: 32.0,
            floor: -10.0,
        },
    );
    let face = sinumerik("CYCLE61(50,0,2,-3,-20,-10,40,20,0,4,0,500)");
    check(
        &face,
        &Taken {
            inside: |x, y| rounded(x, y, [23.0, 13.0], 3.0),
            size: 32.0,
            floor: -3.0,
        },
    );
}

#[test]
fn siemens_patterns() {
    let holes = |pattern: &str| -> Vec<[f64; 2]> {
        let program = sinumerik(&format!("MCALL CYCLE81(50,0,2,-10)\n{pattern}\nMCALL"));
        let bottoms = chords(&program);
        bottoms
            .iter()
            .filter(|(_, to)| to[2] == -10.0)
            .map(|(_, to)| [to[0], to[1]].map(|c| (c * 1e9).round() / 1e9))
            .collect()
    };
    assert_eq!(holes("HOLES1(1,2,90,5,10,3)"), [[1.0, 7.0], [1.0, 17.0], [1.0, 27.0]]);
    assert_eq!(
        holes("HOLES2(1,2,10,0,0,4)"),
        [[11.0, 2.0], [1.0, 12.0], [-9.0, 2.0], [1.0, -8.0]]
    );
    let mut grid = holes("CYCLE801(0,0,0,10,20,2,3)");
    grid.sort_by(|a, b| a.partial_cmp(b).unwrap());
    assert_eq!(
        grid,
        [
            [0.0, 0.0],
            [0.0, 20.0],
            [0.0, 40.0],
            [10.0, 0.0],
            [10.0, 20.0],
            [10.0, 40.0]
        ]
    );
    // Without a modal cycle nothing is made, and said.
    let none = sinumerik("HOLES1(1,2,90,5,10,3)\nG1 Z0 F100");
    assert!(none.assumptions[0].what.contains("HOLES1") && none.assumptions[0].changes_verdict);
    let stock = sinumerik("WORKPIECE(,,,\"BOX\",112,1,-20,-80,-50,-40,50,40)\nG1 Z0 F100").stock;
    let block = sweepsim_nc::StockDescription::Block {
        min: [-50.0, -40.0, -20.0],
        max: [50.0, 40.0, 1.0],
    };
    assert_eq!(stock, Some(block));
}
