//! The closed forms and the general method compared: both displace lines and tips by a part of the tolerance, not
//! always alike.

use sweepsim::{Method, Options, Sweep, sweep};
use sweepsim_dexel::{End, Grid, Interval, Source};
use sweepsim_motion::{Path, Tool};
use sweepsim_props::*;

/// Whether the ends agree, each within the tolerance measured across the surface. Intervals and gaps shorter than the
/// tolerance may be missing or extra.
pub fn same(a: &[Interval], b: &[Interval], tolerance: f64) -> bool {
    alike(a, b, tolerance)
        || alike(
            &without_slivers(a, tolerance),
            &without_slivers(b, tolerance),
            tolerance,
        )
}

fn alike(a: &[Interval], b: &[Interval], tolerance: f64) -> bool {
    let near = |(a, b): (&Interval, &Interval)| {
        [(a.lower, b.lower), (a.upper, b.upper)].iter().all(|(a, b)| {
            let steep = f64::from(a.normal[2]).abs().max(f64::from(b.normal[2]).abs()).max(1e-3);
            (a.z - b.z).abs() <= tolerance / steep
        })
    };
    a.len() == b.len() && a.iter().zip(b).all(near)
}

/// The intervals with gaps shorter than the tolerance closed, but for those that are themselves shorter.
fn without_slivers(list: &[Interval], tolerance: f64) -> Vec<Interval> {
    let mut joined: Vec<Interval> = Vec::new();
    for next in list {
        match joined.last_mut() {
            Some(last) if next.lower.z - last.upper.z < tolerance => last.upper = next.upper,
            _ => joined.push(*next),
        }
    }
    joined.retain(|one| one.upper.z - one.lower.z >= tolerance);
    joined
}

/// Compares both, and returns them. A line in a wall may be on either side of it: then it must agree with a line beside
/// it.
pub fn agree(name: &str, tool: &Tool, path: &Path, grid: &Grid, tolerance: f64) -> Result<[Sweep; 2], TestCaseError> {
    agree_with(Method::General, name, tool, path, (grid, tolerance))
}

/// The same with another method than the general one.
pub fn agree_with(
    other: Method,
    name: &str,
    tool: &Tool,
    path: &Path,
    (grid, tolerance): (&Grid, f64),
) -> Result<[Sweep; 2], TestCaseError> {
    let on =
        |grid: &Grid, method| sweep(tool, path, grid, &Options::new(tolerance).method(method), &()).expect("a sweep");
    let [closed, charts] = [Method::Mixed, other].map(|method| on(grid, method));
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
        // Where lines are solved again, seen from where they are solved first: two vertical tangents in one place
        // magnify any difference.
        let again = [[6e-3, 1.970], [2e-2, 3.520], [6e-2, 5.323], [0.12, 1.154], [0.2, 2.747]];
        let moved = |[r, angle]: [f64; 2]| {
            [
                r * angle.cos() - 2e-3 * 3.6952_f64.cos(),
                r * angle.sin() - 2e-3 * 3.6952_f64.sin(),
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
        // In a wall, ends of different moves may be those of different lines, since tips are displaced as well; and
        // next to one that touches the volume others miss it.
        others.extend(around.map(|angle| displaced([angle.cos(), angle.sin()])));
        let is_between = are_between(&a, &others, tolerance);
        prop_assert!(is_between, "{name}: {:?}: {a:?} {b:?}", (i, j));
    }
    Ok([closed, charts])
}

/// Whether the intervals cover what lines displaced by no more than the tolerance all have in common, and nothing that
/// none of them has, so that every end may be that of one between these.
fn are_between(own: &[Interval], displaced: &[Vec<Interval>], tolerance: f64) -> bool {
    let own = without_slivers(own, tolerance);
    let covers =
        |list: &[Interval], z: f64, by: f64| list.iter().any(|one| one.lower.z - by < z && z < one.upper.z + by);
    let ends = |list: &[Interval]| {
        list.iter()
            .flat_map(|one| [one.lower.z, one.upper.z])
            .collect::<Vec<_>>()
    };
    let mut heights = ends(&own);
    for z in displaced.iter().flat_map(|other| ends(other)) {
        heights.extend([z - tolerance, z, z + tolerance]);
    }
    heights.sort_by(f64::total_cmp);
    let between = heights.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    let mut others = between.map(|z| {
        let any = displaced.iter().any(|other| covers(other, z, tolerance));
        let all = displaced.iter().all(|other| covers(other, z, -tolerance));
        (z, any, all)
    });
    others.all(|(z, any, all)| if covers(&own, z, 0.0) { any } else { !all })
}

#[test]
fn between_displaced_lines() {
    let list = |ends: &[[f64; 2]]| -> Vec<Interval> {
        ends.iter()
            .map(|&[lower, upper]| {
                let [lower, upper] = [lower, upper].map(|z| End {
                    z,
                    normal: [0.0; 3],
                    source: Source::Stock,
                });
                Interval { lower, upper }
            })
            .collect()
    };
    let displaced = [
        list(&[[0.0, 2.0]]),
        list(&[[0.5, 3.0]]),
        list(&[[0.2, 3.0], [5.0, 6.0]]),
    ];
    for (own, expected) in [
        (&[[0.3, 2.5]][..], true),
        (&[[0.3, 2.5], [5.5, 5.6]], true),
        (&[[-0.2, 2.5]], false),
        (&[[0.3, 1.5]], false),
        (&[[0.3, 1.0], [1.5, 3.0]], false),
        (&[[0.3, 2.5], [4.0, 5.6]], false),
        (&[], false),
    ] {
        assert_eq!(are_between(&list(own), &displaced, 0.1), expected, "{own:?}");
    }
}
