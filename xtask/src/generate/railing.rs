//! The fourth example of the paper (Figure 14): a wooden hand-railing, moulded by a router bit whose axis follows the
//! rise of the rail, and the gouge in the concavity of its path.
//!
//! The rail runs level, eases upwards, rises, eases over and runs level again: a curve in the plane `y = 0` of lines
//! and two arcs. Across it stands a section that is the same everywhere. The tip of the bit follows the curve beside
//! the rail, on one side forth and on the other back, and its axis is the curve's normal. So the surface that it makes
//! is the section along the curve, as long as the curve bends little: at a height `ζ` where the bit has radius `r` and
//! slope `r′`, the neighbouring placements stay out of the rail if `κ r r′ < (1 − κ ζ)²`.
//!
//! `railing.ron` takes the first easing on its first side too sharply, so that the bit runs deeper into the rail than
//! the rail is thick there: the gouge. `railing-eased.ron` has no fault. Both have the same target.

use super::router::outline;
use super::toolpath::{Placement, csv, decimals};
use libm::{cos, sin, tan};
use nalgebra::Vector3;
use std::fmt::Write as _;

/// Radius of both easings along the curve, and of the one that is taken too sharply.
const EASING: f64 = 60.0;
const SHARP: f64 = 15.0;
/// Radians of an easing.
const RISE: f64 = std::f64::consts::PI / 6.0;
/// The rail's length along `x`, and the length of the level piece at each of its ends.
const LENGTH: f64 = 96.0;
const LEVEL: f64 = 14.0;
/// How far the path goes beyond both ends.
const BEYOND: f64 = 12.0;
/// The blank: half its width, and its lower and upper side above the curve.
const HALF: f64 = 24.0;
const SIDES: [f64; 2] = [1.5, 21.0];
/// The axis of the bit from the middle of the rail.
const ASIDE: f64 = 26.0;
/// Radians between neighbouring poses, and between sections of the meshes.
const STEP: f64 = RISE / 15.0;
/// The deviation of a section's polygon.
const CHORD: f64 = 0.004;

/// A point of the curve, with the angle of its rise.
#[derive(Clone, Copy, Debug)]
struct Station {
    x: f64,
    z: f64,
    rise: f64,
}

impl Station {
    /// The point of the section at `y` across and `height` above the curve.
    fn at(&self, y: f64, height: f64) -> Vector3<f64> {
        let (s, c) = (sin(self.rise), cos(self.rise));
        Vector3::new(self.x - height * s, y, self.z + height * c)
    }

    fn bit(&self, y: f64) -> Placement {
        Placement {
            tip: self.at(y, 0.0),
            axis: self.at(0.0, 1.0) - self.at(0.0, 0.0),
        }
    }
}

/// The curve from `x = −beyond` to `LENGTH + beyond`: the ends of its lines, and points of its arcs. The first easing
/// has radius `first`; the lines are the same for any.
fn curve(first: f64, beyond: f64) -> Vec<Station> {
    let steps = (RISE / STEP + 0.5) as usize;
    // The corner that an arc replaces is this much of its radius away from both of its ends.
    let reach = tan(0.5 * RISE);
    let corner = [LEVEL + EASING * reach, 0.0];
    let slope = LENGTH - 2.0 * LEVEL - 2.0 * EASING * sin(RISE);
    let height = 2.0 * EASING * (1.0 - cos(RISE)) + slope * tan(RISE);
    let mut stations = vec![Station {
        x: -beyond,
        z: 0.0,
        rise: 0.0,
    }];
    for k in 0..=steps {
        let rise = RISE * k as f64 / steps as f64;
        stations.push(Station {
            x: corner[0] - first * reach + first * sin(rise),
            z: corner[1] + first * (1.0 - cos(rise)),
            rise,
        });
    }
    for k in (0..=steps).rev() {
        let rise = RISE * k as f64 / steps as f64;
        stations.push(Station {
            x: LENGTH - LEVEL - EASING * sin(rise),
            z: height - EASING * (1.0 - cos(rise)),
            rise,
        });
    }
    stations.push(Station {
        x: LENGTH + beyond,
        z: height,
        rise: 0.0,
    });
    stations
}

/// Forth on one side and back on the other.
fn path(first: f64) -> Vec<Placement> {
    let forth = curve(first, BEYOND);
    let back = curve(EASING, BEYOND);
    let mut path: Vec<Placement> = forth.iter().map(|station| station.bit(-ASIDE)).collect();
    path.extend(back.iter().rev().map(|station| station.bit(ASIDE)));
    path
}

/// One side of the section: heights and distances from the middle, from below.
fn side() -> Vec<[f64; 2]> {
    let outline: Vec<[f64; 2]> = outline(CHORD);
    // The outline's point at a height; the bit is wider than any of its heights once only.
    let cut = |height: f64| {
        let above = outline.iter().position(|p| p[1] > height).unwrap_or(1).max(1);
        let [a, b] = [outline[above - 1], outline[above]];
        let t = (height - a[1]) / (b[1] - a[1]);
        [height, ASIDE - (a[0] + (b[0] - a[0]) * t)]
    };
    let inner = outline.iter().filter(|p| p[1] > SIDES[0] && p[1] < SIDES[1]);
    let mut side = vec![cut(SIDES[0])];
    side.extend(inner.map(|[radius, height]| [*height, ASIDE - radius]));
    side.push(cut(SIDES[1]));
    side
}

/// The solid with this side of its symmetric section along the curve, as a PLY with quadrilaterals.
fn solid(comment: &str, side: &[[f64; 2]]) -> String {
    let stations = curve(EASING, 0.0);
    let (rows, around) = (stations.len(), 2 * side.len());
    // Counter-clockwise seen against the curve's direction: up on the side of positive y, down on the other.
    let section: Vec<[f64; 2]> = side
        .iter()
        .copied()
        .chain(side.iter().rev().map(|[height, y]| [*height, -y]))
        .collect();
    let mut faces = Vec::new();
    for row in 0..rows - 1 {
        for k in 0..around {
            let next = (k + 1) % around;
            let at = |row: usize, k: usize| row * around + k;
            faces.push([at(row, k), at(row, next), at(row + 1, next), at(row + 1, k)]);
        }
    }
    for k in 0..side.len() - 1 {
        let (a, b, c, d) = (k, k + 1, around - 2 - k, around - 1 - k);
        let last = (rows - 1) * around;
        faces.push([d, c, b, a]);
        faces.push([a, b, c, d].map(|v| last + v));
    }
    let mut text = format!(
        "ply\nformat ascii 1.0\ncomment {comment}\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        rows * around,
        faces.len()
    );
    // A String takes all that is written to it.
    for station in &stations {
        for [height, y] in &section {
            let [x, y, z] = station.at(*y, *height).into();
            let _ = writeln!(text, "{} {} {}", short(x), short(y), short(z));
        }
    }
    for [a, b, c, d] in faces {
        let _ = writeln!(text, "4 {a} {b} {c} {d}");
    }
    text
}

/// A tenth of a micrometre is enough.
fn short(value: f64) -> String {
    decimals((value * 1e4).round() / 1e4)
}

fn job(heading: &str, path: &str) -> String {
    format!(
        "{heading}
// Written by `cargo xtask generate` (xtask/src/generate/railing.rs).
Job(
    tolerance: 1e-6,
    grid: Grid(min: (0, -{HALF}), max: ({LENGTH}, {HALF}), cells: (300, 300)),
    stock: Mesh(\"../meshes/railing-blank.ply\"),
    tools: {{ 1: Surface(\"../tools/router-bit.ron\") }},
    paths: [Path(tool: 1, file: \"../paths/{path}\")],
    target: Mesh(\"../meshes/railing.ply\"),
    limits: Limits(gouge: 0.05, excess: 0.05),
)
"
    )
}

/// The files, with their places under `fixtures/`.
pub fn files() -> Vec<(&'static str, String)> {
    let gouged = "\
// A hand-railing, moulded by a router bit that is one B-spline surface: the paper's fourth example, with the gouge in
// the concavity of its path. `sweepsim verify` finds it; railing-eased.ron is without it.";
    let eased = "\
// The hand-railing of railing.ron without its fault: the concavity of the path is eased as the rail is.";
    vec![
        ("jobs/railing.ron", job(gouged, "railing.csv")),
        ("jobs/railing-eased.ron", job(eased, "railing-eased.csv")),
        ("paths/railing.csv", csv(&path(SHARP))),
        ("paths/railing-eased.csv", csv(&path(EASING))),
        (
            "meshes/railing.ply",
            solid(
                "The hand-railing as it should be (mm), by cargo xtask generate",
                &side(),
            ),
        ),
        (
            "meshes/railing-blank.ply",
            solid(
                "The blank of the hand-railing (mm), by cargo xtask generate",
                &[[SIDES[0], HALF], [SIDES[1], HALF]],
            ),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_sharp_easing_is_too_sharp_for_the_bit() {
        let outline = outline(1e-4);
        let least = |radius: f64| {
            let bend = 1.0 / radius;
            let free = |pair: &[[f64; 2]]| {
                let [[r, low], [s, high]] = [pair[0], pair[1]];
                let (slope, height) = ((s - r) / (high - low), 0.5 * (low + high));
                (1.0 - bend * height).powi(2) - bend * 0.5 * (r + s) * slope
            };
            let within = |pair: &&[[f64; 2]]| pair[0][1] > SIDES[0] && pair[1][1] < SIDES[1];
            outline
                .windows(2)
                .filter(within)
                .map(free)
                .fold(f64::INFINITY, f64::min)
        };
        // Upwards, over, and upwards too sharply.
        assert!(
            least(EASING) > 0.3 && least(-EASING) > 0.3,
            "{} {}",
            least(EASING),
            least(-EASING)
        );
        assert!(least(SHARP) < -0.3, "{}", least(SHARP));
    }

    #[test]
    fn both_curves_follow_the_same_lines() {
        let [eased, sharp] = [EASING, SHARP].map(|first| curve(first, 0.0));
        for stations in [&eased, &sharp] {
            assert_eq!(stations.len(), 34);
            for pair in stations.windows(2) {
                let rise = libm::atan2(pair[1].z - pair[0].z, pair[1].x - pair[0].x);
                // A chord has the mean of both angles.
                assert!((rise - 0.5 * (pair[0].rise + pair[1].rise)).abs() < 1e-12, "{pair:?}");
            }
        }
        // Seen along the bisector of the corner, both arcs have their centres on it, at their radius over the cosine of
        // half the rise from the corner. Their stations next to the middle are half a step from it.
        let apart = [sin(0.5 * STEP), 1.0 / cos(0.5 * RISE) - cos(0.5 * STEP)];
        let expected = (EASING - SHARP) * apart[0].hypot(apart[1]);
        for number in [8, 9] {
            let lines = [eased[number], sharp[number]].map(|station| station.at(0.0, 0.0));
            let found = (lines[0] - lines[1]).norm();
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
    }
}
