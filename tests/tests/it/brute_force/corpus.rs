//! Named sweeps: every tool with every kind of motion, generic, degenerate, almost degenerate and self-intersecting.
//! Both methods are judged by brute force on all of them, and must agree with each other.

use crate::brute_force::cases::{Case, Cutter, Window};
use crate::brute_force::judge::{TOLERANCE, Tally, judge, same_volume, swept};
use crate::brute_force::sample::sample;
use rayon::prelude::*;
use std::f64::consts::TAU;
use sweepsim::{BoundaryOperator, Method, Options, sweep};
use sweepsim_motion::{Apt, Lens, Path, Pose, Profile, ProfileSegment, Tool, Turn};
use sweepsim_tests::tools::{drill, lollipop, scaled_concave};

/// Where a tool's tip is and where its axis points.
type Placement = ([f64; 3], [f64; 3]);

const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// Tiny differences.
const SMALL: [f64; 6] = [1e-1, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15];

fn profile(segments: Vec<ProfileSegment>) -> Tool {
    Tool::from_profile(Profile::new([0.0, 0.0], segments).expect("a profile"))
}

/// A seven-parameter cutter: d, r, e, f, a, b, h.
fn apt([d, r, e, f, a, b, h]: [f64; 7]) -> Tool {
    Tool::apt(&Apt { d, r, e, f, a, b, h }).expect("a cutter").0
}

/// A point of 8°, a side of 3°, and a corner of radius 0.4 that touches both lines.
fn rounded_taper() -> Tool {
    let (a, b, r, e) = (8.0_f64, 3.0_f64, 0.4, 1.3);
    let ((sin_a, cos_a), (sin_b, cos_b)) = (a.to_radians().sin_cos(), b.to_radians().sin_cos());
    // The centre's distances from the bottom line and from the side line are both r.
    let f = (r + e * sin_a) / cos_a;
    let d = 2.0 * (r + e * cos_b - f * sin_b) / (cos_b - sin_a / cos_a * sin_b);
    apt([d, r, e, f, a, b, 7.0])
}

/// One tool of each kind, of radius about 2.
pub fn tools() -> Vec<(&'static str, Tool)> {
    let line = |rho: f64, zeta: f64| ProfileSegment::Line { to: [rho, zeta] };
    let dovetail = profile(vec![line(2.0, 0.0), line(1.0, 3.0), line(1.0, 9.0), line(0.0, 9.0)]);
    let taper = profile(vec![
        // A ball of radius 1 whose cone begins where it is 10° steep.
        ProfileSegment::Arc {
            to: [10_f64.to_radians().cos(), 1.0 - 10_f64.to_radians().sin()],
            centre: [0.0, 1.0],
            turn: Turn::Ccw,
        },
        line(2.0, 7.0),
        line(0.0, 7.0),
    ]);
    let barrel = profile(vec![
        line(1.2, 0.0),
        ProfileSegment::Arc {
            to: [1.2, 6.0],
            centre: [-4.0, 3.0],
            turn: Turn::Ccw,
        },
        line(0.0, 6.0),
    ]);
    vec![
        ("ball", Tool::ball(2.0, 8.0).expect("a ball end")),
        ("flat", Tool::flat(2.0, 6.0).expect("a flat end")),
        ("bull", Tool::bull(2.0, 0.6, 7.0).expect("a bull nose")),
        ("concave", scaled_concave(0.25)),
        ("drill", drill(2.0, 0.7, 7.0)),
        ("lollipop", lollipop(2.0, 0.7, 9.0)),
        ("dovetail", dovetail),
        ("taper", taper),
        ("barrel", barrel),
        (
            "lens",
            Tool::lens(Lens {
                radius: 2.0,
                bottom: 5.0,
                corner: 0.0,
                length: 7.0,
            })
            .expect("a lens"),
        ),
        ("hollow end", apt([4.0, 0.0, 0.0, 0.0, -12.0, 4.0, 6.0])),
        ("rounded taper with a point", rounded_taper()),
    ]
}

pub fn lean(degrees: f64, towards: f64) -> [f64; 3] {
    let ((sin, cos), (s, c)) = (degrees.to_radians().sin_cos(), towards.to_radians().sin_cos());
    [sin * c, sin * s, cos]
}

fn motions() -> Vec<(String, Vec<Placement>)> {
    let o = [0.0; 3];
    let mut all: Vec<(String, Vec<Placement>)> = Vec::new();
    let mut put = |name: &str, placements: Vec<Placement>| all.push((name.to_owned(), placements));
    put(
        "oblique translation",
        vec![([-3.0, -1.0, 0.0], lean(15.0, 0.0)), ([3.0, 1.5, 1.0], lean(15.0, 0.0))],
    );
    put(
        "50 degrees on the way",
        vec![
            ([-3.0, -1.0, 0.0], lean(25.0, 90.0)),
            ([3.0, 1.5, 1.0], lean(25.0, -90.0)),
        ],
    );
    put(
        "170 degrees",
        vec![
            ([-1.0, 0.0, 0.0], lean(80.0, 10.0)),
            ([1.0, 0.5, 0.3], lean(90.0, 190.0)),
        ],
    );
    put("turn about the tip", vec![(o, UP), (o, lean(70.0, 20.0))]);
    put(
        "horizontal, upright",
        vec![([-2.5, 0.3, 0.0], UP), ([2.5, 0.3, 0.0], UP)],
    );
    put(
        "along a grid diagonal",
        vec![([-2.0, -2.0, 0.0], UP), ([2.0, 2.0, 0.0], UP)],
    );
    put("plunge", vec![([0.0, 0.0, 3.0], UP), ([0.0, 0.0, -2.0], UP)]);
    put(
        "retract along a leaning axis",
        vec![
            (o, lean(40.0, 30.0)),
            (lean(40.0, 30.0).map(|c| 4.0 * c), lean(40.0, 30.0)),
        ],
    );
    put("rest", vec![(o, lean(20.0, 45.0))]);
    put(
        "lying on its side",
        vec![([-2.0, 0.0, 0.0], lean(90.0, 0.0)), ([-2.0, 3.0, 0.5], lean(90.0, 0.0))],
    );
    put(
        "upside down",
        vec![
            ([0.0, 0.0, 5.0], lean(180.0, 0.0)),
            ([2.0, 1.0, 5.5], lean(170.0, 50.0)),
        ],
    );
    put("to and fro", vec![(o, UP), ([3.0, 0.2, 0.5], lean(20.0, 0.0)), (o, UP)]);
    put("corner", vec![([-3.0, 0.0, 0.0], UP), (o, UP), ([0.0, 3.0, 0.0], UP)]);
    let ring = |radius: f64, tilt: f64, count: usize| -> Vec<Placement> {
        (0..=count)
            .map(|k| {
                let angle = k as f64 * TAU / count as f64;
                (
                    [radius * angle.cos(), radius * angle.sin(), 0.0],
                    lean(tilt, angle.to_degrees()),
                )
            })
            .collect()
    };
    put("circle smaller than the tool", ring(0.5, 0.0, 8));
    put("circle, leaning outwards", ring(1.5, 20.0, 8));
    put("cone about the tip", ring(0.0, 35.0, 6));
    put(
        "swallowtail",
        vec![
            ([-1.0, 0.0, 0.0], lean(40.0, 180.0)),
            ([1.0, 0.0, 0.0], lean(40.0, 0.0)),
        ],
    );
    put(
        "swing about a high point",
        vec![
            ([-4.0, 0.0, 1.0], lean(35.0, 0.0)),
            ([4.0, 0.0, 1.0], lean(35.0, 180.0)),
        ],
    );
    for small in SMALL {
        all.push((
            format!("axis change {small:e}"),
            vec![(o, UP), ([2.0, 0.7, 0.4], [small, 0.0, 1.0])],
        ));
        all.push((
            format!("tilt {small:e} of a level move"),
            vec![(o, [small, 0.0, 1.0]), ([2.0, 0.7, 0.0], [small, 0.0, 1.0])],
        ));
        all.push((
            format!("height difference {small:e}"),
            vec![(o, UP), ([2.0, 0.7, small], UP)],
        ));
        all.push((
            format!("move of {small:e}"),
            vec![(o, lean(10.0, 0.0)), ([small, 0.5 * small, 0.0], lean(10.0, 0.0))],
        ));
    }
    all
}

fn cases() -> Vec<(String, Case)> {
    let mut cases = Vec::new();
    for (tool_name, tool) in tools() {
        for (number, (motion, placements)) in motions().into_iter().enumerate() {
            let poses = placements
                .iter()
                .map(|(tip, axis)| Pose::new(*tip, *axis).expect("a pose"));
            let cutter = Cutter {
                name: tool_name.to_owned(),
                tool: tool.clone(),
                radius: 2.0,
            };
            // Every third grid has lines in walls and through axes.
            let window = if number % 3 == 0 {
                Window::Aligned { parts: 2, reach: 4 }
            } else {
                Window::Free {
                    shift: [0.11, -0.07],
                    half: 2.3,
                    lines: 9,
                }
            };
            let poses = poses.collect();
            cases.push((format!("{tool_name}: {motion}"), Case { cutter, poses, window }));
        }
    }
    cases
}

#[test]
fn all_methods_on_all_named_sweeps() {
    let cases = cases();
    assert!(cases.len() >= 200, "{}", cases.len());
    let cases = sample("named sweeps", &cases, 60);
    let check = |(name, case): &(String, Case)| -> Result<Tally, String> {
        let grid = case.grid();
        let tally = judge(case, Method::Mixed).map_err(|error| format!("{name}: {error}"))?;
        let auto = swept(case, &case.poses, &grid, Method::Mixed)?;
        for method in [Method::General, Method::Lines, Method::Planes, Method::Surface] {
            swept(case, &case.poses, &grid, method)
                .and_then(|other| same_volume(case, &grid, &auto, &other))
                .map_err(|error| format!("{name}: auto and {method}: {error}"))?;
        }
        Ok(tally)
    };
    let results: Vec<Result<Tally, String>> = cases.par_iter().map(check).collect();
    let errors: Vec<String> = results
        .iter()
        .filter_map(|result| result.as_ref().err().cloned())
        .collect();
    let covered: usize = results.iter().flatten().map(|tally| tally.covered).sum();
    println!("{} sweeps, {covered} covered lines", cases.len());
    assert!(
        errors.is_empty(),
        "{} of {}:\n{}",
        errors.len(),
        cases.len(),
        errors.join("\n")
    );
    assert!(covered > 10 * cases.len(), "the grids must meet the tools: {covered}");
}

/// A cutter with three fins, as for T-slots. Where a line is in its body at one time and meets two fins at another, the
/// sheets of one move's envelope overlap as `start start end start end end`: one interval, that the paper's Algorithm 2
/// cuts in two.
#[test]
fn the_papers_boundary_operator_errs_where_a_move_overlaps_itself() {
    let line = |rho: f64, zeta: f64| ProfileSegment::Line { to: [rho, zeta] };
    let mut outline = vec![line(2.0, 0.0)];
    for fin in 0..3 {
        let foot = 1.6 * f64::from(fin);
        outline.extend([
            line(2.0, foot + 0.6),
            line(0.5, foot + 0.6),
            line(0.5, foot + 1.6),
            line(2.0, foot + 1.6),
        ]);
    }
    outline.extend([line(2.0, 5.4), line(0.0, 5.4)]);
    let finned = profile(outline);
    let window = || Window::Free {
        shift: [0.11, -0.07],
        half: 2.5,
        lines: 24,
    };
    let moves = [
        (
            "tilting",
            [0.0, 0.0, 0.0],
            lean(40.0, 20.0),
            [1.0, 0.4, 0.3],
            lean(30.0, 190.0),
        ),
        (
            "plunging",
            [0.0, 0.0, 3.0],
            lean(50.0, 0.0),
            [1.5, 0.2, -1.0],
            lean(10.0, 70.0),
        ),
        (
            "sideways",
            [-2.0, -1.0, 0.0],
            lean(20.0, 100.0),
            [2.0, 1.0, 0.5],
            lean(25.0, 300.0),
        ),
    ];
    for (name, from, start, to, end) in moves {
        let case = Case {
            cutter: Cutter {
                name: "finned".to_owned(),
                tool: finned.clone(),
                radius: 2.0,
            },
            poses: vec![
                Pose::new(from, start).expect("a pose"),
                Pose::new(to, end).expect("a pose"),
            ],
            window: window(),
        };
        // Brute force agrees with the count.
        let tally = judge(&case, Method::Mixed).expect(name);
        assert!(tally.covered > 40, "{name}: {}", tally.covered);
        let (path, grid) = (Path::new(case.poses.clone()).expect("a path"), case.grid());
        let volume = |boundary| {
            let options = Options::new(TOLERANCE).boundary(boundary);
            sweep(&finned, &path, &grid, &options, &()).expect(name).volume.volume()
        };
        let (counted, paper) = (volume(BoundaryOperator::Coverage), volume(BoundaryOperator::Paper));
        println!("{name}: {counted:.3} by the count, {paper:.3} by the paper's operator");
        // It only ever loses material, and much more than rounding here.
        assert!(paper < 0.999 * counted, "{name}: {paper} {counted}");
    }
}

/// On the named sweeps, whose moves do not overlap themselves in this way, it is right once its last interval is
/// restored.
#[test]
fn the_papers_boundary_operator_is_right_where_moves_do_not_overlap_themselves() {
    let differs = |(name, case): &(String, Case)| -> Option<String> {
        let grid = case.grid();
        let path = Path::new(case.poses.clone()).expect(name);
        let volume = |boundary| {
            // Closed forms solve a line in a wall again elsewhere, on the other side perhaps; here both operators must
            // see the same line.
            let options = Options::new(TOLERANCE).boundary(boundary).method(Method::General);
            sweep(&case.cutter.tool, &path, &grid, &options, &())
                .expect(name)
                .volume
                .volume()
        };
        let (counted, paper) = (volume(BoundaryOperator::Coverage), volume(BoundaryOperator::Paper));
        // Both make ends within the tolerance; a line has a few of them.
        let slack = 10.0 * TOLERANCE * grid.spacing()[0] * grid.spacing()[1] * grid.len() as f64;
        ((counted - paper).abs() > slack).then(|| format!("{name}: {paper} for {counted}"))
    };
    let wrong: Vec<String> = cases().par_iter().filter_map(differs).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
