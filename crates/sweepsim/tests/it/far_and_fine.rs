//! Moves a million times as long as the tool, tools moved along or across their own axis, and tolerances down to the
//! least: a move costs about as much as its shorter neighbour, is certified, and removes the same. Where rounding
//! decides what only a displacement of the tip should, the search would otherwise never end.

use std::time::{Duration, Instant};
use sweepsim::{Method, Options, SweepError, sweep};
use sweepsim_dexel::{Dexels, Grid};
use sweepsim_motion::{Dovetail, Lollipop, Path, Pose, Tool};
use sweepsim_solve::Monitor;

/// The methods, each with the most boxes of a far or finely resolved move in those of its neighbour.
const THRIFTY: [(Method, f64); 2] = [(Method::General, 2.2), (Method::Surface, 2.2)];
/// In the wall of a lollipop's neck, lines cannot be certified one by one at the least tolerance: charts repair them
/// together. The boxes of `planes` are those of the curves, too.
const OTHERS: [(Method, f64); 2] = [(Method::Planes, 1.5), (Method::Lines, 2.8)];

/// Ends a sweep that takes far too long, and so makes it fail.
struct Patience(Instant);

impl Monitor for Patience {
    fn cancelled(&self) -> bool {
        self.0.elapsed() > Duration::from_secs(20)
    }
}

fn tools() -> Vec<(&'static str, Tool)> {
    let tools = [
        ("ball", Tool::ball(2.0, 9.0)),
        ("flat", Tool::flat(2.0, 9.0)),
        ("bull", Tool::bull(2.0, 0.5, 9.0)),
        (
            "lollipop",
            Tool::lollipop(Lollipop {
                radius: 2.0,
                neck: 1.0,
                length: 9.0,
            }),
        ),
        (
            "dovetail",
            Tool::dovetail(Dovetail {
                radius: 2.0,
                angle: 60.0,
                height: 1.5,
                neck: 0.9,
                length: 9.0,
            }),
        ),
    ];
    tools.map(|(name, tool)| (name, tool.expect("a tool"))).into()
}

/// Directions of a move and the tool's axis, by name.
fn directions() -> [(&'static str, [f64; 3], [f64; 3]); 7] {
    let leaning = [0.36, 0.48, 0.8];
    [
        ("level along x", [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]),
        ("level askew", [0.0, 0.0, 1.0], [0.8, 0.6, 0.0]),
        ("plunge", [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]),
        ("along the own axis", leaning, leaning),
        ("across the own axis, level", leaning, [0.8, -0.6, 0.0]),
        ("across the own axis, askew", leaning, [0.48, 0.64, -0.6]),
        ("upright tool, rising", [0.0, 0.0, 1.0], [0.6, 0.0, 0.8]),
    ]
}

/// A move that begins a little before the grid and goes on for `length`.
fn path(axis: [f64; 3], way: [f64; 3], length: f64) -> Path {
    let from = [0, 1, 2].map(|k| -0.13 - 0.07 * k as f64 - 1.5 * way[k]);
    let to = [0, 1, 2].map(|k| from[k] + length * way[k]);
    Path::new([from, to].map(|tip| Pose::new(tip, axis).expect("a pose")).into()).expect("a path")
}

fn grid() -> Grid {
    Grid::new([-4.5, -4.5], [4.5, 4.5], [15, 15]).expect("a grid")
}

/// Boxes and dexels.
fn swept(tool: &Tool, path: &Path, options: &Options, name: &str) -> (u64, Dexels) {
    let done = sweep(tool, path, &grid(), options, &Patience(Instant::now()));
    let done = done.unwrap_or_else(|error| panic!("{name}: {error}"));
    assert!(
        done.statistics.unresolved.is_empty(),
        "{name}: {:?}",
        done.statistics.unresolved
    );
    (done.statistics.boxes, done.volume)
}

/// How far ends of the same intervals are apart at most.
#[derive(Debug, Default)]
pub struct Apart {
    pub along_lines: f64,
    /// Along the mean of the ends' normals: what a displacement of a curved surface changes, however steep.
    pub across_surface: f64,
}

/// How far ends of the same intervals are apart, up to a height. Intervals of lines that cut into a ball no deeper than
/// this may be missing.
pub fn difference(a: &Dexels, b: &Dexels, top: f64, depth: f64) -> Apart {
    let mut most = Apart::default();
    for line in 0..a.grid().len() {
        let ends = |dexels: &Dexels| -> Vec<(f64, f64)> {
            let clipped = dexels.at(line).iter().map(|interval| {
                [interval.lower, interval.upper].map(|end| (end.z.clamp(-top, top), f64::from(end.normal[2])))
            });
            let is_cut = |[lower, upper]: &[(f64, f64); 2]| {
                // At an end on a ball of radius 2, a line is deeper than the outline by `2 (1 − cos α) ≈ n_z²`.
                upper.0 - lower.0 > 1e-3 && (lower.1 * lower.1).max(upper.1 * upper.1) > depth
            };
            clipped.filter(is_cut).flatten().collect()
        };
        let (a, b) = (ends(a), ends(b));
        assert_eq!(a.len(), b.len(), "line {line}: {a:?} {b:?}");
        for ((a, slope), (b, other)) in a.iter().zip(&b) {
            let along = (a - b).abs();
            most.along_lines = most.along_lines.max(along);
            most.across_surface = most.across_surface.max(along * (slope + other).abs() / 2.0);
        }
    }
    most
}

/// What exceeds the bound, for one table of all failures.
fn check(failures: &mut Vec<String>, most: f64, name: &str, [boxes, neighbour]: [u64; 2]) {
    if boxes as f64 > most * neighbour as f64 {
        failures.push(format!("{name}: {boxes} boxes, its neighbour {neighbour}"));
    }
}

fn long_moves(methods: [(Method, f64); 2]) {
    let mut failures = Vec::new();
    for (kind, tool) in tools() {
        for (way, axis, direction) in directions() {
            for (method, most) in methods {
                // Farther than the grid reaches.
                let near = path(axis, direction, 40.0);
                let (neighbour, exact) = swept(&tool, &near, &Options::new(1e-6).method(method), kind);
                for length in [1e3, 25e3, 2e6] {
                    let tolerance = 1e-6_f64.max(length * 6e-11);
                    let name = format!("{kind}, {way}, {method}, length {length}");
                    let options = Options::new(tolerance).method(method);
                    let (boxes, volume) = swept(&tool, &path(axis, direction, length), &options, &name);
                    check(&mut failures, most, &name, [boxes, neighbour]);
                    // Both sweeps are those of inputs within a third of their tolerances.
                    let apart = difference(&volume, &exact, 4.0, tolerance).across_surface;
                    assert!(apart < (tolerance + 1e-6) / 3.0, "{name}: {apart}");
                }
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

fn fine_tolerances(methods: [(Method, f64); 2]) {
    let mut failures = Vec::new();
    for (kind, tool) in tools() {
        for (way, axis, direction) in directions() {
            for (method, most) in methods {
                let path = path(axis, direction, 30.0);
                let (neighbour, _) = swept(&tool, &path, &Options::new(1e-6).method(method), kind);
                let least = match sweep(&tool, &path, &grid(), &Options::new(1e-15), &Patience(Instant::now())) {
                    Err(SweepError::TooFine { least, .. }) => least,
                    other => panic!("{other:?}"),
                };
                for tolerance in [1e-3, 1e-9_f64.max(least), least] {
                    let name = format!("{kind}, {way}, {method}, tolerance {tolerance}");
                    let (boxes, _) = swept(&tool, &path, &Options::new(tolerance).method(method), &name);
                    check(&mut failures, most, &name, [boxes, neighbour]);
                }
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn long_moves_cost_as_much_as_short_ones() {
    long_moves(THRIFTY);
}

#[test]
fn fine_tolerances_cost_as_much_as_coarse_ones() {
    fine_tolerances(THRIFTY);
}

#[test]
#[ignore = "takes a minute"]
fn other_methods_are_right_too() {
    long_moves(OTHERS);
    fine_tolerances(OTHERS);
}
