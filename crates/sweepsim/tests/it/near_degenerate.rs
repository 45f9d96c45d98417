//! What almost degenerate input costs: in boxes of the subdivision, which no clock disturbs. By each method it may cost
//! three times its generic neighbour, whatever the distance from degeneracy, with the exceptions listed here.
//!
//! `cargo test -p sweepsim --release --test it near_degenerate -- --include-ignored --nocapture` prints the table of
//! the docs.

use crate::far_and_fine::difference;
use sweepsim::{Method, Options, Statistics, sweep};
use sweepsim_dexel::Grid;
use sweepsim_motion::{Apt, Law, Move, Path, Pose, RotaryTable, TipArc, TipCourse, Tool, Turning};

pub const UP: [f64; 3] = [0.0, 0.0, 1.0];
/// From far to none at all.
pub const DISTANCES: [f64; 11] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-9, 1e-12, 1e-15, 0.0];
/// The neighbour that is generic.
pub const GENERIC: f64 = 0.23;
pub const MOST: f64 = 3.0;
pub const METHODS: [Method; 5] = [
    Method::General,
    Method::Mixed,
    Method::Surface,
    Method::Planes,
    Method::Lines,
];

pub fn pose(tip: [f64; 3], axis: [f64; 3]) -> Pose {
    Pose::new(tip, axis).expect("a pose")
}

/// An axis `angle` away from z, in a direction not aligned with the grid.
pub fn leaning(angle: f64) -> [f64; 3] {
    let (s, c) = angle.sin_cos();
    [0.6_f64.cos() * s, 0.6_f64.sin() * s, c]
}

pub fn through(poses: Vec<Pose>, law: Law) -> Path {
    Path::with_law(poses, law).expect("a path")
}

/// An arc of the tip of 100° about the origin, of this radius, rising by `rise`.
pub fn arc(radius: f64, rise: f64, axes: [[f64; 3]; 2], turning: Turning) -> Path {
    let (s, c) = 1.745_f64.sin_cos();
    let (from, to) = ([radius, 0.0, 0.0], [radius * c, radius * s, rise]);
    let course = TipCourse::Arc(TipArc::between(from, to, [0.0; 3], UP, 1).expect("an arc"));
    let poses = vec![pose(from, axes[0]), pose(to, axes[1])];
    Path::with_moves(poses, vec![Move { course, turning }]).expect("a path")
}

/// A straight move while the tool turns about its own axis, which leans by `tilt`.
pub fn turning_about_its_axis(tips: [[f64; 3]; 2], tilt: f64) -> Path {
    let (table, tilt) = (RotaryTable::Ac, tilt.to_degrees());
    let [from, to] = [[tilt, 10.0], [tilt, 95.0]];
    let poses = vec![pose(tips[0], table.axis(from)), pose(tips[1], table.axis(to))];
    let way = Move::straight(Turning::Rotary { table, from, to });
    Path::with_moves(poses, vec![way]).expect("a path")
}

/// A turn about a line along the dexels, `d` from the nearest one, while the tip moves along it by `rise`; the axis
/// leans by `tilt` out of the plane across the line.
pub fn about_a_line(d: f64, rise: f64, tilt: f64) -> (Path, Grid) {
    let poses = [0.2, -0.2].map(|side| pose([0.0, 0.0, rise * side], [side, 1.0, tilt]));
    (through(poses.into(), Law::Slerp), around([0.8 * d, 0.6 * d]))
}

/// 15 × 15 lines, the middle one at a place.
pub fn around([x, y]: [f64; 2]) -> Grid {
    Grid::new([x - 4.5, y - 4.5], [x + 4.5, y + 4.5], [15, 15]).expect("a grid")
}

/// An axis that leans by `d` out of the plane across the direction in which the tips of upright tools are displaced.
fn from_across_displacement(d: f64) -> [f64; 3] {
    let way = [0.569_840_290_998, 0.331_172_830_617, 0.752_022_194_331_f64];
    let across = [0.0, way[2], -way[1]];
    let norm = way[2].hypot(way[1]);
    std::array::from_fn(|k| across[k] / norm + d * way[k])
}

/// Two directions across such an axis, at right angles.
fn across_axis(axis: [f64; 3]) -> [[f64; 3]; 2] {
    let norm = |v: [f64; 3]| v[0].hypot(v[1]).hypot(v[2]);
    let unit = |v: [f64; 3]| v.map(|c| c / norm(v));
    let [x, y, z] = unit(axis);
    let u = if x == 0.0 && y == 0.0 {
        [1.0, 0.0, 0.0]
    } else {
        unit([y, -x, 0.0])
    };
    [u, [y * u[2] - z * u[1], z * u[0] - x * u[2], x * u[1] - y * u[0]]]
}

/// An arc of 100° about the origin and a direction, of this radius, rising by `rise`, of a tool with an axis of its
/// own.
fn across(normal: [f64; 3], axis: [f64; 3], radius: f64, rise: f64) -> Path {
    let [u, v] = across_axis(normal);
    let at = |angle: f64, rise: f64| {
        let (s, c) = angle.sin_cos();
        let tip = std::array::from_fn(|k| radius * (c * u[k] + s * v[k]) + rise * normal[k]);
        pose(tip, axis)
    };
    let arc = TipArc::new([0.0; 3], normal, 1.745).expect("an arc");
    Path::with_moves(vec![at(0.0, 0.0), at(1.745, rise)], vec![Move::arc(arc)]).expect("a path")
}

/// A family of inputs by their distance from degeneracy: the path and the grid of a distance.
pub type Family = (&'static str, fn(f64) -> (Path, Grid));

pub fn families() -> Vec<Family> {
    const SIDE: [f64; 2] = [0.0137, -0.0211];
    vec![
        ("line from the centre of a level arc", |d| {
            (arc(1.3, 0.0, [UP; 2], Turning::Even), around([0.8 * d, 0.6 * d]))
        }),
        ("rise of a helix about a line", |d| {
            (arc(1.3, d, [UP; 2], Turning::Even), around([0.0; 2]))
        }),
        ("tilt on an arc about a line", |d| {
            (arc(1.3, 0.0, [leaning(d); 2], Turning::Even), around([0.0; 2]))
        }),
        ("axis change on an arc about a line", |d| {
            (arc(1.3, 0.0, [UP, leaning(d)], Turning::Even), around([0.0; 2]))
        }),
        ("both, and a rise", |d| {
            (arc(1.3, d, [leaning(d), leaning(-d)], Turning::Even), around([0.0; 2]))
        }),
        ("tool's radius from that of the arc", |d| {
            (arc(2.0 - d, 0.0, [UP; 2], Turning::Even), around([0.0; 2]))
        }),
        ("tool's radius from that of a helix", |d| {
            (arc(2.0 - d, 0.7, [UP; 2], Turning::Even), around([0.0; 2]))
        }),
        ("tilt of a level move", |d| {
            let axis = leaning(d);
            let poses = vec![pose([-2.0, -0.7, 0.0], axis), pose([2.0, 0.9, 0.0], axis)];
            (through(poses, Law::Slerp), around(SIDE))
        }),
        ("tilt of a plunge", |d| {
            let axis = leaning(d);
            let poses = vec![pose([0.3, 0.2, 2.0], axis), pose([0.3, 0.2, -1.0], axis)];
            (through(poses, Law::Slerp), around(SIDE))
        }),
        ("axis change of a level move", |d| {
            let poses = vec![pose([-2.0, -0.7, 0.0], UP), pose([2.0, 0.9, 0.0], leaning(d))];
            (through(poses, Law::Slerp), around(SIDE))
        }),
        ("height difference of a level move", |d| {
            let poses = vec![pose([-2.0, -0.7, 0.0], UP), pose([2.0, 0.9, d], UP)];
            (through(poses, Law::Slerp), around(SIDE))
        }),
        ("length of a move", |d| {
            let axis = leaning(0.3);
            let poses = vec![pose([0.0; 3], axis), pose([0.5 * d, 0.3 * d, 0.2 * d], axis)];
            (through(poses, Law::Slerp), around(SIDE))
        }),
        ("turn about the tip", |d| {
            let poses = vec![pose([0.0; 3], leaning(0.4)), pose([0.0; 3], leaning(0.4 + d))];
            (through(poses, Law::Slerp), around(SIDE))
        }),
        ("turn about the tip over a line", |d| {
            let poses = vec![pose([0.0; 3], UP), pose([0.0; 3], leaning(0.7))];
            (through(poses, Law::ConstantSpeed), around([0.8 * d, 0.6 * d]))
        }),
        (
            "of a line from one that the tip moves along and the tool turns about",
            |d| about_a_line(d, 100.0, 0.0),
        ),
        ("of a line from one that the tool turns about", |d| {
            about_a_line(d, 0.0, 0.0)
        }),
        ("tilt while the tip moves along a line that the tool turns about", |d| {
            about_a_line(0.0, 100.0, d)
        }),
        ("move along a line that the tool turns about", |d| {
            about_a_line(0.0, 100.0 * d, 0.0)
        }),
        ("tilt while turning about the own axis", |d| {
            (turning_about_its_axis([[0.0; 3]; 2], d), around([0.0; 2]))
        }),
        ("tilt while turning about the own axis on the way", |d| {
            let tips = [[-1.0, -0.4, 0.0], [1.0, 0.5, 0.0]];
            (turning_about_its_axis(tips, d), around(SIDE))
        }),
        ("axis from across the displacement of tips, on a level move", |d| {
            let axis = from_across_displacement(d);
            let [[x, y, z], _] = across_axis(axis);
            let poses = [-1.9, 2.1].map(|far| pose([far * x, far * y, far * z], axis));
            (through(poses.into(), Law::Slerp), around(SIDE))
        }),
        ("axis from across the displacement of tips, on an arc across it", |d| {
            let axis = from_across_displacement(d);
            (across(axis, axis, 1.3, 0.0), around(SIDE))
        }),
        ("rise of a helix in a tilted plane", |d| {
            let axis = leaning(0.5);
            (across(axis, axis, 1.3, d), around(SIDE))
        }),
        ("tool's axis from that of an arc in a tilted plane", |d| {
            (across(leaning(0.5), leaning(0.5 + d), 1.3, 0.0), around(SIDE))
        }),
        ("tool's radius from that of an arc in a tilted plane", |d| {
            let axis = leaning(0.5);
            (across(axis, axis, 2.0 - d, 0.0), around(SIDE))
        }),
        ("lean of a tool on an arc about its axis", |d| {
            (across(leaning(d), leaning(d), 1.3, 0.0), around(SIDE))
        }),
        ("tool on an arc about its axis from lying", |d| {
            let axis = leaning(std::f64::consts::FRAC_PI_2 - d);
            (across(axis, axis, 1.3, 0.0), around(SIDE))
        }),
        ("axis from across the displacement of tips, at rest", |d| {
            let axis = from_across_displacement(d);
            (through(vec![pose([0.1, 0.2, 0.0], axis)], Law::Slerp), around(SIDE))
        }),
        ("line from the wall", |d| {
            let poses = vec![pose([-2.0, 0.0, 0.0], UP), pose([2.0, 0.0, 0.0], UP)];
            (through(poses, Law::Slerp), around([0.0137, 2.0 - d]))
        }),
        ("line from the wall of a plunge", |d| {
            let poses = vec![pose([0.0, 0.0, 2.0], UP), pose([0.0, 0.0, -1.0], UP)];
            (through(poses, Law::Slerp), around([0.0137, 2.0 - d]))
        }),
        ("line from the axis", |d| {
            let poses = vec![pose([-2.0, 0.0, 0.0], UP), pose([2.0, 0.0, 0.3], UP)];
            (through(poses, Law::Slerp), around([0.0137, d]))
        }),
    ]
}

pub fn tools() -> Vec<(&'static str, Tool)> {
    let drill = Apt {
        d: 4.0,
        r: 0.0,
        e: 2.0,
        f: 0.0,
        a: 31.0,
        b: 0.0,
        h: 7.0,
    };
    vec![
        ("ball", Tool::ball(2.0, 7.0).expect("a tool")),
        ("flat", Tool::flat(2.0, 7.0).expect("a tool")),
        ("bull", Tool::bull(2.0, 0.5, 7.0).expect("a tool")),
        ("drill", Tool::apt(&drill).expect("a tool").0),
    ]
}

pub fn cost(method: Method, tool: &Tool, (path, grid): &(Path, Grid)) -> Statistics {
    sweep(tool, path, grid, &Options::default().method(method), &())
        .expect("a sweep")
        .statistics
}

/// The work of a sweep, in boxes. By default, a line in closed form takes as long as a box that holds only one (1.3
/// µs), and counts as one.
pub fn work(method: Method, statistics: &Statistics, grid: &Grid) -> f64 {
    let lines = if method == Method::Mixed { grid.len() } else { 0 };
    statistics.boxes as f64 + lines as f64
}

/// Prints how many times as much work as its generic neighbour each input of a family takes, and tells whether all are
/// cheap.
pub fn is_cheap(
    method: Method,
    (what, family): Family,
    (name, tool): &(&'static str, Tool),
    distances: &[f64],
) -> Result<(), String> {
    let input = family(GENERIC);
    let generic = work(method, &cost(method, tool, &input), &input.1);
    let ratio = |d: &f64| {
        let input = family(*d);
        let found = cost(method, tool, &input);
        // In closed form, a line may be too close to an end of a curve: it is displaced, and counts as it would
        // otherwise.
        let again = if method == Method::Mixed { 0 } else { found.repaired };
        let trouble = again + found.unresolved.len();
        (work(method, &found, &input.1) / generic, trouble)
    };
    let ratios: Vec<(f64, usize)> = distances.iter().map(ratio).collect();
    let cells: Vec<String> = ratios
        .iter()
        .map(|(ratio, trouble)| match trouble {
            0 => format!("{ratio:.2}"),
            _ => format!("{ratio:.2} ({trouble} solved again or not at all)"),
        })
        .collect();
    println!("| {method}, {what}, {name}: {generic} | {} |", cells.join(" | "));
    if ratios.iter().all(|(ratio, trouble)| *ratio <= MOST && *trouble == 0) {
        Ok(())
    } else {
        Err(format!("{method}, {what}, {name}: {}", cells.join(" ")))
    }
}

fn all_are_cheap(methods: &[Method], distances: &[f64]) {
    are_cheap(methods, |_| families(), distances);
}

fn are_cheap(methods: &[Method], families: impl Fn(usize) -> Vec<Family>, distances: &[f64]) {
    println!("| work on a generic neighbour, then times | {distances:?} |");
    let (mut wrong, tools) = (Vec::new(), tools());
    for (number, method) in methods.iter().enumerate() {
        for family in families(number) {
            wrong.extend(
                tools
                    .iter()
                    .filter_map(|tool| is_cheap(*method, family, tool, distances).err()),
            );
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn almost_degenerate_input_costs_at_most_thrice_its_generic_neighbour() {
    all_are_cheap(&[Method::General], &[1e-9, 0.0]);
}

#[test]
fn so_it_does_by_all_methods() {
    // Each of four methods looks at every third family, and each family is looked at.
    let third = |number: usize| families().into_iter().skip(number % 3).step_by(3).collect();
    are_cheap(&METHODS[1..], third, &[1e-9]);
}

#[test]
#[ignore = "takes half a minute"]
fn so_it_does_by_all_methods_at_all_distances() {
    all_are_cheap(&METHODS, &DISTANCES);
}

/// Closed forms of a tool that leans by almost nothing, moving level or down.
#[test]
fn almost_upright_tools_remove_what_the_general_search_says() {
    for (what, family) in families().into_iter().filter(|(what, _)| what.starts_with("tilt of a")) {
        for (name, tool) in tools() {
            for exponent in 5..=17 {
                let (path, grid) = family(0.7 * 0.1_f64.powi(exponent));
                let found = [Method::Mixed, Method::General].map(|method| {
                    let options = Options::new(1e-6).method(method);
                    sweep(&tool, &path, &grid, &options, &()).expect("a sweep")
                });
                let name = format!("{name}, {what}, 1e-{exponent}");
                assert!(
                    found.iter().all(|found| found.statistics.unresolved.is_empty()),
                    "{name}"
                );
                assert_eq!(found[0].statistics.repaired, 0, "{name}");
                let apart = difference(&found[0].volume, &found[1].volume, 10.0, 0.0).along_lines;
                assert!(apart < 1e-5, "{name}: {apart}");
            }
        }
    }
}
