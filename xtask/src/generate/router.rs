//! `fixtures/tools/router-bit.ron` and a job that runs it along the edge of a board, as the paper's hand-railing (Figure 14): one
//! bicubic B-spline surface of 13 × 14 control points, with a concave and a convex part.

use std::fmt::Write as _;

/// Control points round about: the last three repeat the first, so that the surface closes smoothly.
const AROUND: usize = 13;
/// Radius and height of the control points from the tip to the top.
const PROFILE: [[f64; 2]; 14] = [
    [0.0, 0.0],
    [2.5, 0.0],
    [5.0, 0.0],
    [5.8, 0.3],
    [6.0, 3.0],
    [6.0, 5.5],
    [3.2, 7.0],
    [2.6, 10.0],
    [3.4, 13.0],
    [7.5, 14.0],
    [8.0, 18.0],
    [7.0, 23.0],
    [3.5, 24.0],
    [0.0, 24.0],
];

fn tool() -> String {
    let distinct = AROUND - 3;
    let angle = |k: usize| std::f64::consts::TAU * (k % distinct) as f64 / distinct as f64;
    // The middle of three neighbouring control points of a uniform cubic has weights 1, 4, 1 over 6: this makes its radius that of the profile.
    let wider = 3.0 / (2.0 + libm::cos(angle(1)));
    let mut text = String::from(
        "// A router bit as one bicubic B-spline surface of 13 × 14 control points.\n\
         // Made by `cargo xtask generate` (xtask/src/generate/router.rs).\n\
         Surfaces(\n    tolerance: 1e-6,\n    surfaces: [\n        Surface(\n            degrees: (3, 3),\n",
    );
    let list = |knots: Vec<i32>| {
        let words: Vec<String> = knots.iter().map(i32::to_string).collect();
        format!("[{}]", words.join(", "))
    };
    let around = list((-3..=AROUND as i32).collect());
    let last = PROFILE.len() as i32 - 3;
    let up = list((-3..=last + 3).map(|k| k.clamp(0, last)).collect());
    // A String takes all that is written to it.
    let _ = write!(
        text,
        "            knots: (\n                {around},\n                {up},\n            ),\n            points: [\n"
    );
    for [radius, height] in PROFILE {
        text.push_str("                [");
        for k in 0..AROUND {
            let (x, y) = (
                libm::cos(angle(k)) * radius * wider,
                libm::sin(angle(k)) * radius * wider,
            );
            let comma = if k + 1 < AROUND { ", " } else { "" };
            let _ = write!(text, "({}, {}, {height}){comma}", rounded(x), rounded(y));
        }
        text.push_str("],\n");
    }
    text.push_str("            ],\n        ),\n    ],\n)\n");
    text
}

/// Micrometres are enough.
fn rounded(value: f64) -> f64 {
    (value * 1e3).round() / 1e3 + 0.0
}

fn job() -> String {
    let mut poses = String::new();
    for k in 0..=24 {
        let s = f64::from(k) / 24.0;
        let (x, sway) = (-12.0 + 84.0 * s, libm::sin(std::f64::consts::TAU * s));
        let _ = writeln!(
            poses,
            "            (({}, {}, {}), ({}, {}, 1.0)),",
            rounded(x),
            rounded(-2.0 + 1.5 * sway),
            rounded(-1.0 - sway),
            rounded(0.15 * libm::cos(std::f64::consts::TAU * s)),
            rounded(0.25 * sway),
        );
    }
    format!(
        "// A router bit, one B-spline surface, along the edge of a board: after the hand-railing of the paper's Figure 14.\n\
         // Made by `cargo xtask generate` (xtask/src/generate/router.rs).\n\
         Job(\n    tolerance: 1e-6,\n    grid: Grid(min: (0.0, 0.0), max: (60.0, 24.0), cells: (150, 60)),\n    \
         stock: Block(min: (0.0, 0.0, 0.0), max: (60.0, 24.0, 20.0)),\n    tools: {{ 1: Surface(\"../tools/router-bit.ron\") }},\n    \
         paths: [\n        Path(tool: 1, poses: [\n{poses}        ]),\n    ],\n)\n"
    )
}

/// The files, with their places under `fixtures/`.
pub fn files() -> Vec<(&'static str, String)> {
    vec![("tools/router-bit.ron", tool()), ("jobs/railing.ron", job())]
}
