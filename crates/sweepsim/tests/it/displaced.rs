//! The closed forms and the general method compared: both displace lines and tips by a part of the tolerance, not always alike.

use proptest::prelude::*;
use sweepsim::{Method, Options, Sweep, sweep};
use sweepsim_dexel::{Grid, Interval};
use sweepsim_motion::{Path, Tool};

/// Whether the ends agree, each within the tolerance measured across the surface.
pub fn same(a: &[Interval], b: &[Interval], tolerance: f64) -> bool {
    let near = |(a, b): (&Interval, &Interval)| {
        [(a.lower, b.lower), (a.upper, b.upper)].iter().all(|(a, b)| {
            let steep = f64::from(a.normal[2]).abs().max(f64::from(b.normal[2]).abs()).max(1e-3);
            (a.z - b.z).abs() <= tolerance / steep
        })
    };
    a.len() == b.len() && a.iter().zip(b).all(near)
}

/// Compares both, and returns them. A line in a wall may be on either side of it: then it must agree with a line beside it.
pub fn agree(name: &str, tool: &Tool, path: &Path, grid: &Grid, tolerance: f64) -> Result<[Sweep; 2], TestCaseError> {
    let on =
        |grid: &Grid, method| sweep(tool, path, grid, &Options::new(tolerance).method(method), &()).expect("a sweep");
    let [closed, charts] = [Method::Charts, Method::General].map(|method| on(grid, method));
    for found in [&closed, &charts] {
        prop_assert!(found.statistics.unresolved.is_empty(), "{name}: {:?}", found.statistics);
    }
    for index in 0..grid.len() {
        let [a, b] = [&closed, &charts].map(|found| found.volume.at(index).to_vec());
        if same(&a, &b, tolerance) {
            continue;
        }
        let (i, j) = grid.place(index);
        let displaced = |step: [f64; 2]| {
            let [x, y] = [grid.x(i) + step[0] * tolerance, grid.y(j) + step[1] * tolerance];
            let half = 1e-3;
            let one = Grid::new([x - half, y - half], [x + half, y + half], [1, 1]).expect("a grid");
            on(&one.in_frame(*grid.frame()), Method::General).volume.at(0).to_vec()
        };
        let around = (0..8).map(|k| std::f64::consts::FRAC_PI_4 * f64::from(k));
        let steps = around
            .clone()
            .flat_map(|angle| [0.05, 0.3].map(|r| [r * angle.cos(), r * angle.sin()]));
        // Where lines are solved again, seen from where they are solved first: two vertical tangents in one place magnify any difference.
        let again = [[3e-3, 1.970], [1e-2, 3.520], [3e-2, 5.323], [0.1, 1.154], [0.2, 2.747]];
        let moved = |[r, angle]: [f64; 2]| {
            [
                r * angle.cos() - 1e-3 * 0.7391_f64.cos(),
                r * angle.sin() - 1e-3 * 0.7391_f64.sin(),
            ]
        };
        let mut others = Vec::new();
        let is_one = steps.chain(again.map(moved)).any(|step| {
            others.push(displaced(step));
            others.last().is_some_and(|other| same(&a, other, tolerance))
        });
        if is_one {
            continue;
        }
        // In a wall, ends of different moves may be those of different lines, since tips are displaced as well.
        others.extend(around.map(|angle| displaced([angle.cos(), angle.sin()])));
        let is_between = are_between(&a, &others, tolerance);
        prop_assert!(is_between, "{name}: {:?}: {a:?} {b:?}", (i, j));
    }
    Ok([closed, charts])
}

/// Whether every end is between those of lines displaced by no more than the tolerance, so that it is that of one between these.
fn are_between(own: &[Interval], displaced: &[Vec<Interval>], tolerance: f64) -> bool {
    let alike: Vec<_> = displaced.iter().filter(|other| other.len() == own.len()).collect();
    let within = |z: f64, end: &dyn Fn(&[Interval]) -> f64| {
        alike.iter().any(|other| end(other) <= z + tolerance) && alike.iter().any(|other| end(other) >= z - tolerance)
    };
    own.iter()
        .enumerate()
        .all(|(k, own)| within(own.lower.z, &|list| list[k].lower.z) && within(own.upper.z, &|list| list[k].upper.z))
}
