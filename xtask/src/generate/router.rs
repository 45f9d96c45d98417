//! `fixtures/tools/router-bit.ron`, after the form tool of the paper (Figure 10): one bicubic B-spline surface of 13 ×
//! 14 control points, with a concave and a convex part.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use sweepsim_motion::Tool;
use sweepsim_spline::{KnotVector, RationalSpline};

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

/// How many of them differ.
const DISTINCT: usize = AROUND - 3;

/// The control points at each height of the profile.
fn points() -> impl Iterator<Item = [[f64; 3]; AROUND]> {
    let angle = |k: usize| TAU * (k % DISTINCT) as f64 / DISTINCT as f64;
    // The middle of three neighbouring control points of a uniform cubic has weights 1, 4, 1 over 6: this makes its
    // radius that of the profile.
    let wider = 3.0 / (2.0 + libm::cos(angle(1)));
    PROFILE.into_iter().map(move |[radius, height]| {
        std::array::from_fn(|k| {
            let across = [libm::cos(angle(k)), libm::sin(angle(k))].map(|part| rounded(part * radius * wider));
            [across[0], across[1], height]
        })
    })
}

/// The knots around the tool and along its profile.
fn knots() -> [Vec<i32>; 2] {
    let last = PROFILE.len() as i32 - 3;
    let up = (-3..=last + 3).map(|k| k.clamp(0, last)).collect();
    [(-3..=AROUND as i32).collect(), up]
}

/// The bit with weights that change irregularly from one control point to the next, by up to 5 %: a tool of rational
/// patches, for measurements.
pub fn rational() -> Result<Tool, String> {
    let weight = |row: usize, k: usize| 1.0 + 0.05 * libm::sin((37 * row + 101 * (k % DISTINCT)).pow(2) as f64);
    let weights: Vec<f64> = (0..PROFILE.len() * AROUND)
        .map(|at| weight(at / AROUND, at % AROUND))
        .collect();
    let points: Vec<f64> = points().flatten().flatten().collect();
    let knots = knots().map(|knots| KnotVector::new(3, knots.into_iter().map(f64::from).collect()));
    let knots = knots
        .into_iter()
        .collect::<Result<Vec<_>, _>>()
        .map_err(|error| error.to_string())?;
    let surface = RationalSpline::new(knots, 3, &points, &weights).map_err(|error| error.to_string())?;
    Tool::from_surfaces(&[surface], 1e-6).map_err(|error| error.to_string())
}

fn tool() -> String {
    let mut text = String::from(
        "// A router bit as one bicubic B-spline surface of 13 × 14 control points.\n\
         // Made by `cargo xtask generate` (xtask/src/generate/router.rs).\n\
         Surfaces(\n    tolerance: 1e-6,\n    surfaces: [\n        Surface(\n            degrees: (3, 3),\n",
    );
    let list = |knots: Vec<i32>| {
        let words: Vec<String> = knots.iter().map(i32::to_string).collect();
        format!("[{}]", words.join(", "))
    };
    let [around, up] = knots().map(list);
    // A String takes all that is written to it.
    let _ = write!(
        text,
        "            knots: (\n                {around},\n                {up},\n            ),\n            points: [\n"
    );
    for row in points() {
        let words: Vec<String> = row.iter().map(|[x, y, z]| format!("({x}, {y}, {z})")).collect();
        let _ = writeln!(text, "                [{}],", words.join(", "));
    }
    text.push_str("            ],\n        ),\n    ],\n)\n");
    text
}

/// Micrometres are enough.
fn rounded(value: f64) -> f64 {
    (value * 1e3).round() / 1e3 + 0.0
}

/// The bit's outline, `(radius, height)` from the tip to the top, as a polygon within `chord` of it: the middle curve
/// of the surface's control points.
pub fn outline(chord: f64) -> Vec<[f64; 2]> {
    let spans = PROFILE.len() - 3;
    let mut points = vec![at(0, 0.0)];
    for span in 0..spans {
        // The curve bends by less than a half turn within a span, over at most 6 mm.
        let parts = (3.0 / (8.0 * chord).sqrt()).ceil() as usize;
        points.extend((1..=parts).map(|k| at(span, k as f64 / parts as f64)));
    }
    thinned(&points, chord)
}

/// A point of the clamped cubic spline of the profile, by de Boor's algorithm.
fn at(span: usize, t: f64) -> [f64; 2] {
    let last = (PROFILE.len() - 3) as f64;
    let knot = |k: usize| (k as f64 - 3.0).clamp(0.0, last);
    let u = span as f64 + t;
    let mut d: Vec<[f64; 2]> = PROFILE[span..span + 4].to_vec();
    for round in 1..=3 {
        for j in (round..=3).rev() {
            let k = span + j;
            let share = (u - knot(k)) / (knot(k + 4 - round) - knot(k));
            d[j] = [0, 1].map(|c| (1.0 - share) * d[j - 1][c] + share * d[j][c]);
        }
    }
    d[3]
}

/// The polygon without corners that are within `chord` of the line between its neighbours (Douglas, Peucker 1973).
fn thinned(points: &[[f64; 2]], chord: f64) -> Vec<[f64; 2]> {
    fn keep(points: &[[f64; 2]], chord: f64, kept: &mut Vec<[f64; 2]>) {
        let (a, b) = (points[0], points[points.len() - 1]);
        let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        let length = (dx * dx + dy * dy).sqrt();
        let off = |p: &[f64; 2]| ((p[0] - a[0]) * dy - (p[1] - a[1]) * dx).abs() / length;
        let far = (1..points.len() - 1).max_by(|i, j| off(&points[*i]).total_cmp(&off(&points[*j])));
        match far.filter(|k| off(&points[*k]) > chord) {
            Some(k) => {
                keep(&points[..=k], chord, kept);
                keep(&points[k..], chord, kept);
            }
            None => kept.push(b),
        }
    }
    let mut kept = vec![points[0]];
    keep(points, chord, &mut kept);
    kept
}

/// The files, with their places under `fixtures/`.
pub fn files() -> Vec<(&'static str, String)> {
    vec![("tools/router-bit.ron", tool())]
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_formats::Job;

    #[test]
    fn the_outline_is_that_of_the_surface() {
        let job = Job::read(&crate::workspace::fixtures().join("jobs/railing.ron")).expect("a job");
        let outline = outline(1e-4);
        let radius = |height: f64| {
            let above = outline.iter().position(|p| p[1] > height).expect("within the bit");
            let [[r, low], [s, high]] = [outline[above - 1], outline[above]];
            r + (s - r) * (height - low) / (high - low)
        };
        let mut checked = 0;
        for patch in job.tools[&1].patches() {
            for (u, v) in [(0.1, 0.3), (0.5, 0.5), (0.9, 0.8)] {
                let [x, y, z] = patch.point(u, v);
                // On the bottom and on the dome at the top heights tell little.
                if (0.5..23.0).contains(&z) {
                    assert!((x.hypot(y) - radius(z)).abs() < 0.005, "{x} {y} {z}: {}", radius(z));
                    checked += 1;
                }
            }
        }
        assert!(checked > 200, "{checked}");
    }
}
