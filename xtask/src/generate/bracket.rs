//! A bracket to verify: a small part with a step, a slot, a round pocket and a groove, its program, and the same
//! program with five faults.

use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Size of the part in x, y and downwards; the program's zero is its front left corner on top.
const SIZE: [f64; 3] = [100.0, 60.0, 24.0];
/// The round pocket: centre, radius, depth.
const POCKET: ([f64; 2], f64, f64) = ([45.0, 30.0], 16.0, 7.0);
/// Sides of the pocket's polygon: a multiple of 8. They are within 0.009 mm of the circle.
const SIDES: usize = 96;

type Point = [f64; 3];

/// The part: its section along x, extruded along y, with the pocket in its top.
fn part() -> Vec<[Point; 3]> {
    let [long, wide, tall] = SIZE;
    // From left to right over the top, then the bottom.
    let mut outline = vec![
        [0.0, 0.0],
        [10.0, 0.0],
        [10.0, -10.0],
        [22.0, -10.0],
        [22.0, 0.0],
        [68.0, 0.0],
        [68.0, -9.0],
        [79.0, -9.0],
    ];
    // The groove of the ball end: a half circle.
    let parts = 48;
    for k in 1..parts {
        let (s, c) = (TAU / 2.0 * (1.0 + f64::from(k) / f64::from(parts))).sin_cos();
        outline.push([84.0 + 5.0 * c, -9.0 + 5.0 * s]);
    }
    outline.extend([[89.0, -9.0], [long, -9.0]]);
    let mut triangles = Vec::new();
    let mut quad = |a: Point, b: Point, c: Point, d: Point| triangles.extend([[a, b, c], [a, c, d]]);
    let at = |[x, z]: [f64; 2], y: f64| [x, y, z];
    for pair in outline.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        if a != [22.0, 0.0] {
            quad(at(a, 0.0), at(b, 0.0), at(b, wide), at(a, wide));
        }
    }
    let (left, right) = ([0.0, -tall], [long, -tall]);
    quad(at(left, 0.0), at(outline[0], 0.0), at(outline[0], wide), at(left, wide));
    let last = outline[outline.len() - 1];
    quad(at(last, 0.0), at(right, 0.0), at(right, wide), at(last, wide));
    // The bottom and both ends have a corner below each corner of the outline, so that all edges match.
    let below = |p: [f64; 2]| [p[0], -tall];
    let mut ends = Vec::new();
    for pair in outline.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        if a[0] == b[0] {
            continue;
        }
        quad(
            at(below(a), 0.0),
            at(below(a), wide),
            at(below(b), wide),
            at(below(b), 0.0),
        );
        // Beside a step, an end has the corners of both its sides.
        let chain = |[x, top]: [f64; 2]| {
            let mut chain: Vec<[f64; 2]> = outline.iter().filter(|p| p[0] == x && p[1] <= top).copied().collect();
            chain.sort_by(|p, q| q[1].total_cmp(&p[1]));
            chain.push([x, -tall]);
            chain
        };
        let (left, right) = (chain(a), chain(b));
        let mut cap = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
            ends.push([at(p, 0.0), at(q, 0.0), at(r, 0.0)]);
            ends.push([at(p, wide), at(r, wide), at(q, wide)]);
        };
        for k in 1..left.len() {
            cap(left[k - 1], left[k], right[0]);
        }
        for k in 1..right.len() {
            cap(left[left.len() - 1], right[k], right[k - 1]);
        }
    }
    triangles.extend(ends);
    pocket(&mut triangles);
    triangles
}

/// The top between slot and step, with the round pocket.
fn pocket(triangles: &mut Vec<[Point; 3]>) {
    let (centre, radius, depth) = POCKET;
    let rim = |k: usize, z: f64| {
        let (s, c) = (TAU * (k % SIDES) as f64 / SIDES as f64).sin_cos();
        [centre[0] + radius * c, centre[1] + radius * s, z]
    };
    let corners = [
        [68.0, SIZE[1], 0.0],
        [22.0, SIZE[1], 0.0],
        [22.0, 0.0, 0.0],
        [68.0, 0.0, 0.0],
    ];
    let quarter = SIDES / 4;
    for (n, corner) in corners.iter().enumerate() {
        for k in n * quarter..(n + 1) * quarter {
            triangles.push([*corner, rim(k + 1, 0.0), rim(k, 0.0)]);
        }
        triangles.push([*corner, corners[(n + 1) % 4], rim((n + 1) * quarter, 0.0)]);
    }
    let floor = [centre[0], centre[1], -depth];
    for k in 0..SIDES {
        let (a, b) = (k, k + 1);
        triangles.push([rim(a, 0.0), rim(b, 0.0), rim(b, -depth)]);
        triangles.push([rim(a, 0.0), rim(b, -depth), rim(a, -depth)]);
        triangles.push([floor, rim(a, -depth), rim(b, -depth)]);
    }
}

fn stl() -> String {
    let mut text = String::from("solid bracket\n");
    for [a, b, c] in part() {
        let (u, v) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
        let normal = [0, 1, 2].map(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
        let size = normal.iter().map(|c| c * c).sum::<f64>().sqrt();
        let [x, y, z] = normal.map(|c| c / size + 0.0);
        let _ = writeln!(text, "facet normal {x:.6} {y:.6} {z:.6}\nouter loop");
        for p in [a, b, c] {
            let [x, y, z] = p.map(|c| c + 0.0);
            let _ = writeln!(text, "vertex {x:.6} {y:.6} {z:.6}");
        }
        text.push_str("endloop\nendfacet\n");
    }
    text.push_str("endsolid bracket\n");
    text
}

/// The program, without a fault.
const PROGRAM: &str = "%
(BRACKET, ZERO AT THE FRONT LEFT CORNER ON TOP)
G21 G90 G17 G40 G54
T1 M6 (END MILL D12)
S8000 M3
G0 X94 Y-8 Z20
(STEP)
G0 Z2
G1 Z-4.5 F900
Y68
G0 Z2
X84
G1 Z-4.5
Y-8
G0 Z2
X74
G1 Z-4.5
Y68
G0 Z2
X94
G1 Z-9
Y-8
G0 Z2
X84
G1 Z-9
Y68
G0 Z2
X74
G1 Z-9
Y-8
(SLOT)
G0 Z5
X16
G1 Z-5 F700
Y68
Z-10
Y-8
G0 Z2
(POCKET)
X50 Y30
G1 Z0.5 F500
G3 X50 Y30 Z-3.5 I-5 J0
G3 X50 Y30 I-5 J0
G1 X55 F800
G3 X55 Y30 I-10 J0
G1 X50
G3 X50 Y30 Z-7 I-5 J0 F500
G3 X50 Y30 I-5 J0
G1 X55 F800
G3 X55 Y30 I-10 J0
G1 X50
G0 Z20
T2 M6 (BALL END D10)
S10000 M3
G0 X84 Y-8
Z5
(GROOVE)
G1 Z-11.5 F600
Y68
Z-14
Y-8
G0 Z20
M30
%
";

/// What is wrong in the other program: the line as it is, the wrong one, and which of the lines that read so.
const FAULTS: [(&str, &str, usize); 4] = [
    // Too far to the right: into the clamp.
    ("X94", "X95", 0),
    // Six tenths too high: material is left.
    ("Z-10", "Z-9.4", 0),
    // A sign lost: the rapid to the pocket goes through material.
    ("G0 Z2\n(POCKET)", "G0 Z-2\n(POCKET)", 0),
    // One digit too many: the circle reaches more than a millimetre too far.
    ("G3 X55 Y30 I-10 J0", "G3 X55 Y30 I-10.6 J0", 1),
];

fn faulty() -> String {
    let mut text = PROGRAM.to_owned();
    for (right, wrong, which) in FAULTS {
        let lines = format!("\n{right}\n");
        let place = text
            .match_indices(&lines)
            .nth(which)
            .expect("the program has this line")
            .0;
        text.replace_range(place..place + lines.len(), &format!("\n{wrong}\n"));
    }
    text
}

/// The job of a program. `reach` is where the holder of the ball end begins above its tip.
fn job(program: &str, what: &str, reach: f64) -> String {
    format!(
        "// {what}
// Verify it with
//
//     cargo run --release -- verify fixtures/verify/{program}.ron
//
// and open out/{program}/report.html in a browser.
Job(
    grid: Grid(min: (0, 0), max: (100, 60), cells: (200, 120)),
    stock: Block(min: (0, 0, -24), max: (100, 60, 0)),
    tools: {{
        1: Flat(radius: 6, length: 26),
        2: Ball(radius: 5, length: {reach}),
    }},
    // What moves along and must not touch anything, from the tip upwards.
    bodies: {{
        1: [Holder(Profile(start: (0, 26), segments: [Line((16, 26)), Line((16, 40)), Line((22, 50)), Line((22, 62)), Line((0, 62))]))],
        2: [Holder(Profile(start: (0, {reach}), segments: [Line((18, {reach})), Line((18, 34)), Line((22, 42)), Line((22, 56)), Line((0, 56))]))],
    }},
    // A clamp at the right side.
    fixtures: [Block(min: (100.5, 22, -24), max: (116, 38, 2))],
    paths: [Path(file: \"{program}.nc\", arcs: Exact)],
    target: Mesh(\"bracket.stl\"),
    limits: Limits(gouge: 0.02, excess: 0.05),
)
"
    )
}

/// Every file: its place under `fixtures/` and its text.
pub fn files() -> Vec<(&'static str, String)> {
    let good = "A bracket: step, slot, round pocket and groove. Nothing is wrong with its program.";
    let bad = "The same bracket. Its program has four wrong words, and the ball end is clamped too short.";
    vec![
        ("verify/bracket.stl", stl()),
        ("verify/bracket.nc", PROGRAM.to_owned()),
        ("verify/bracket.ron", job("bracket", good, 18.0)),
        ("verify/bracket-faulty.nc", faulty()),
        ("verify/bracket-faulty.ron", job("bracket-faulty", bad, 13.0)),
    ]
}
