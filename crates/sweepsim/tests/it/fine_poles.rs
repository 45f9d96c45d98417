//! What lines under the pole of a free-form patch cost at tolerances at which rounding hides how far they are from its
//! way: in boxes, as in [`near_degenerate`](crate::near_degenerate).
//!
//! `cargo test -p sweepsim --release --test it fine_poles -- --include-ignored --nocapture` prints the table of the
//! docs.

use crate::far_and_fine::difference;
use crate::grazing_curves::{bit, bud, pad};
use crate::near_degenerate::{DISTANCES, Family, GENERIC, METHODS, MOST, around, work};
use crate::near_poles::{over_poles, over_poles_on_curves};
use crate::rational_bits::{burr, ring};
use sweepsim::nalgebra::{Rotation3, Vector3};
use sweepsim::{Method, Options, sweep};
use sweepsim_dexel::Dexels;
use sweepsim_motion::Tool;

/// Tolerances down to almost the least.
const FINE: [f64; 5] = [1e-7, 3e-8, 1e-8, 1e-9, 6e-10];
/// Two of them, for tests that take seconds.
const FEW: [f64; 2] = [FINE[1], FINE[4]];

/// Lines that rounding leaves undecided are given up early, and solved again at a distance, which takes about as many
/// boxes as all lines do otherwise. `lines` leaves to charts what would have taken it fewer.
fn cheap_at_fine_tolerances(
    tool: (&str, &Tool),
    methods: &[Method],
    list: &[Family],
    distances: &[f64],
    tolerances: &[f64],
) {
    let wrong = dear_at_fine_tolerances(tool, methods, list, distances, (tolerances, MOST));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What takes more than `most` times the boxes of its generic neighbour.
fn dear_at_fine_tolerances(
    (name, tool): (&str, &Tool),
    methods: &[Method],
    list: &[Family],
    distances: &[f64],
    (tolerances, most): (&[f64], f64),
) -> Vec<String> {
    let mut wrong = Vec::new();
    for &(what, family) in list {
        let swept = |d: f64, tolerance: f64, method: Method| {
            let input = family(d);
            let options = Options::new(tolerance).method(method);
            let found = sweep(tool, &input.0, &input.1, &options, &()).expect("a sweep");
            (work(method, &found.statistics, &input.1), found)
        };
        // At a tolerance of 1e-6, which all others are compared with.
        let coarse: Vec<Dexels> = distances
            .iter()
            .map(|d| swept(*d, 1e-6, Method::Mixed).1.volume)
            .collect();
        for &tolerance in tolerances {
            for &method in methods {
                let (generic, _) = swept(GENERIC, tolerance, method);
                for (d, coarse) in distances.iter().zip(&coarse) {
                    let (work, found) = swept(*d, tolerance, method);
                    let (ratio, again, open) = (
                        work / generic,
                        found.statistics.repaired,
                        found.statistics.unresolved.len(),
                    );
                    let apart = difference(&found.volume, coarse, 10.0, 0.0).along_lines;
                    let line = format!(
                        "{tolerance:e}, {method}, {name}, {what}, {d:e}: {ratio:.2} of {generic}, {again} again, {open} open, {apart:e}"
                    );
                    println!("{line}");
                    // No other line is solved again.
                    if !(ratio <= most && again <= 15 && open == 0 && apart < 1e-5) {
                        wrong.push(line);
                    }
                }
            }
        }
    }
    wrong
}

#[test]
fn poles_over_lines_cost_little_at_fine_tolerances() {
    cheap_at_fine_tolerances(("bud", &bud()), &METHODS, &over_poles(), &[1e-12], &FEW);
}

/// Tools whose poles are as flat as a cubic is.
fn flat_poles() -> [(&'static str, Tool); 4] {
    [("pad", pad()), ("bit", bit()), ("ring", ring()), ("burr", burr())]
}

/// Most cost as little; where rounding hides a few of the lines, these are solved again. If rounding were not bounded
/// cell by cell, all 15 in a row would be, for up to 41 times the boxes.
#[test]
fn poles_as_flat_as_a_cubic_cost_little_by_default() {
    const DEAREST: f64 = 10.0;
    let distances = [1e-9, 0.0];
    let of_tool = |(name, tool): &(&str, Tool)| {
        dear_at_fine_tolerances(
            (name, tool),
            &[Method::Mixed],
            &over_poles(),
            &distances,
            (&FEW, DEAREST),
        )
    };
    let wrong: Vec<String> = flat_poles().iter().flat_map(of_tool).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
#[ignore = "takes half a minute"]
fn so_they_do_at_all_distances() {
    cheap_at_fine_tolerances(("bud", &bud()), &METHODS, &over_poles(), &DISTANCES, &FINE);
}

fn cheap_on_curves(methods: &[Method], distances: &[f64], tolerances: &[f64]) {
    // By `general`, as the docs say, the line under a pole as flat as a cubic that slides straight is solved again.
    let is_dear = |name: &str, method: Method, what: &str| {
        name == "pad" && method == Method::General && what == "tilt of a level move over a line"
    };
    for (name, tool) in [("bud", bud()), ("pad", pad())] {
        for method in methods {
            let mut list = over_poles_on_curves();
            list.retain(|(what, _)| !is_dear(name, *method, what));
            cheap_at_fine_tolerances((name, &tool), &[*method], &list, distances, tolerances);
        }
    }
}

#[test]
fn so_they_do_on_curves() {
    cheap_on_curves(&[Method::Mixed], &[1e-9], &FEW[1..]);
}

#[test]
#[ignore = "takes two minutes"]
fn so_they_do_on_curves_at_all_distances() {
    cheap_on_curves(&METHODS[..2], &DISTANCES, &FINE);
}

#[test]
fn so_they_do_anywhere() {
    cheap_anywhere(&[0.0]);
}

#[test]
#[ignore = "takes half a minute"]
fn so_they_do_anywhere_at_all_distances() {
    cheap_anywhere(&DISTANCES);
}

/// In no plane of the grid, and far from the origin: then all components of a velocity are rounded.
fn cheap_anywhere(distances: &[f64]) {
    let turn = Rotation3::new(Vector3::new(0.3, 0.5, -0.2)).into_inner();
    let shift = Vector3::new(31.7, -17.3, 7.1);
    for (name, tool) in [("bud", bud()), ("pad", pad())] {
        for (what, family) in over_poles_on_curves() {
            // As the docs say, whether a face slides along itself is lost in the rounding of such a turn.
            if what.contains("about the own axis") {
                continue;
            }
            for &d in distances {
                let (path, grid) = family(d);
                let [x, y] = [0, 1].map(|k| 0.5 * (grid.min()[k] + grid.max()[k]));
                let place = turn * Vector3::new(x, y, 0.0) + shift;
                let (path, grid) = (path.moved(&turn, shift).expect("a path"), around([place.x, place.y]));
                let boxes = |tolerance: f64| {
                    let found = sweep(&tool, &path, &grid, &Options::new(tolerance), &())
                        .expect("a sweep")
                        .statistics;
                    let (again, open) = (found.repaired, found.unresolved.len());
                    assert!(
                        again <= 1 && open == 0,
                        "{name}, {what}, {d:e} at {tolerance:e}: {again} again, {open} open"
                    );
                    work(Method::Mixed, &found, &grid)
                };
                // Motions that have no exact form are cut into more parts.
                let (usual, fine) = (boxes(1e-6), boxes(1e-8));
                assert!(
                    fine <= 6.0 * usual,
                    "{name}, {what}, {d:e}: {fine} boxes, {usual} at 1e-6"
                );
            }
        }
    }
}
