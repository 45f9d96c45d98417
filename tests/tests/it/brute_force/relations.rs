//! Motions beyond SLERP: transformations that must not change the volume, and volumes known in closed form.

use crate::brute_force::corpus::tools;
use crate::brute_force::judge::{Tally, same_sweeps, swept_along};
use crate::brute_force::named_motions::{Named, grid, motions, pose};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};
use sweepsim::Method;
use sweepsim_dexel::Grid;
use sweepsim_motion::{Law, Lollipop, Move, Path, Pose, Profile, ProfileSegment, TipArc, Tool, Turn, Turning};
use sweepsim_tests::oracle::Motion;

/// Checks all named motions that `relate` turns into another path, with two tools.
fn related(relate: impl Fn(&Named) -> Option<Path> + Sync, least: usize) {
    let tools: Vec<_> = tools()
        .into_iter()
        .filter(|(name, _)| matches!(*name, "bull" | "dovetail"))
        .collect();
    assert_eq!(tools.len(), 2);
    let results: Vec<Result<Option<Tally>, String>> = motions()
        .par_iter()
        .map(|named| {
            let Some(other) = relate(named) else { return Ok(None) };
            let mut total = Tally::default();
            for (name, tool) in &tools {
                let told = |error: String| format!("{name}, {}: {error}", named.name);
                let grid = grid(1, &named.path);
                let [one, other] = [&named.path, &other].map(|path| swept_along(tool, path, &grid, Method::Mixed));
                let profile = tool.profile().expect("a solid of revolution");
                let tally = same_sweeps(
                    profile,
                    &named.motion,
                    &grid,
                    &one.map_err(told)?,
                    &other.map_err(told)?,
                );
                total.covered += tally.map_err(told)?.covered;
            }
            Ok(Some(total))
        })
        .collect();
    let errors: Vec<String> = results
        .iter()
        .filter_map(|result| result.as_ref().err().cloned())
        .collect();
    assert!(errors.is_empty(), "{}", errors.join("\n"));
    let checked: Vec<Tally> = results.into_iter().flatten().flatten().collect();
    assert!(checked.len() >= least, "{}", checked.len());
    assert!(checked.iter().all(|tally| tally.covered > 10));
}

fn moves(path: &Path) -> Option<Vec<Move>> {
    let moves: Vec<Move> = (0..path.moves()).map(|k| path.way(k)).collect();
    // A user-defined motion has no moves.
    (path.poses()[0].side().is_none()).then_some(moves)
}

#[test]
fn paths_backwards_sweep_the_same() {
    related(
        |named| {
            let moves: Vec<Move> = moves(&named.path)?.iter().rev().map(Move::reversed).collect();
            let poses: Vec<Pose> = named.path.poses().iter().rev().copied().collect();
            // A spiral's drift turns with the arc that it is added to.
            (named.name != "spiral: two radii").then(|| Path::with_moves(poses, moves).expect("a path"))
        },
        20,
    );
}

/// Moves at constant speed may be cut anywhere: here at 0.37 of their time.
#[test]
fn moves_cut_in_two_sweep_the_same() {
    let cut = 0.37;
    related(
        |named| {
            let (mut poses, mut halves) = (vec![named.path.poses()[0]], Vec::new());
            for (k, way) in moves(&named.path)?.into_iter().enumerate() {
                let end = named.path.poses()[k + 1];
                let middle = named.motion.at(k, cut);
                let angles = |from: [f64; 2], to: [f64; 2]| [0, 1].map(|i| from[i] + (to[i] - from[i]) * cut);
                let turning = match way.turning {
                    Turning::Slerp => [Turning::Slerp; 2],
                    Turning::Even => [Turning::Even; 2],
                    Turning::Rotary { table, from, to } => {
                        let at = angles(from, to);
                        let part = |from, to| Turning::Rotary { table, from, to };
                        [part(from, at), part(at, to)]
                    }
                };
                let axis = match turning[0] {
                    Turning::Rotary { table, to, .. } => table.axis(to),
                    _ => middle.axis.into(),
                };
                let course = [[0.0, cut], [cut, 1.0]].map(|times| way.course.during(times));
                poses.extend([pose(middle.tip.into(), axis), end]);
                halves.extend([0, 1].map(|i| Move {
                    course: course[i],
                    turning: turning[i],
                }));
            }
            (named.name != "spiral: two radii").then(|| Path::with_moves(poses, halves).expect("a path"))
        },
        20,
    );
}

/// Everything turned by a right angle about z: dexel `(i, j)` becomes `(n − 1 − j, i)`.
#[test]
fn a_right_angle_about_z_turns_the_volume() {
    let (_, tool) = &tools()[2];
    let profile = tool.profile().expect("a solid of revolution");
    let quarter = |v: Vector3<f64>| [-v.y, v.x, v.z];
    let about_z = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    let mut checked = 0;
    for named in motions() {
        let Some(moves) = moves(&named.path) else { continue };
        let turned = moves.iter().map(|way| Move {
            course: way.course.moved(&about_z, [0.0; 3]),
            turning: match way.turning {
                // A turn by 90° about z is one of the table, which turns the part the other way.
                Turning::Rotary { table, from, to } => Turning::Rotary {
                    table,
                    from: [from[0], from[1] - 90.0],
                    to: [to[0], to[1] - 90.0],
                },
                other => other,
            },
        });
        let turned: Vec<Move> = turned.collect();
        let poses = named
            .path
            .poses()
            .iter()
            .map(|p| pose(quarter(Vector3::from(p.tip())), quarter(Vector3::from(p.axis()))));
        let path = Path::with_moves(poses.collect(), turned).expect("a path");
        let grid = grid(1, &named.path);
        let (min, max, cells) = (grid.min(), grid.max(), grid.cells());
        let turned_grid = Grid::new([-max[1], min[0]], [-min[1], max[0]], [cells[1], cells[0]]).expect("a grid");
        let one = swept_along(tool, &named.path, &grid, Method::Mixed).expect("a sweep");
        let mut other = swept_along(tool, &path, &turned_grid, Method::Mixed).expect("a sweep");
        let mut back = one.volume.clone();
        for index in 0..grid.len() {
            let (i, j) = grid.place(index);
            back.set(index, &other.volume.intervals(cells[1] - 1 - j, i).to_vec())
                .unwrap();
        }
        other.volume = back;
        let tally = same_sweeps(profile, &named.motion, &grid, &one, &other);
        assert!(tally.expect(&named.name).covered > 10);
        checked += 1;
    }
    assert!(checked >= 20, "{checked}");
}

/// A lollipop sweeps the union of what its ball and its neck sweep.
#[test]
fn a_union_of_tools_sweeps_the_union() {
    let (radius, neck, length) = (2.0, 0.7, 9.0);
    let whole = Tool::lollipop(Lollipop { radius, neck, length }).expect("a lollipop");
    let line = |rho: f64, zeta: f64| ProfileSegment::Line { to: [rho, zeta] };
    let solid = |start: f64, segments| Tool::from_profile(Profile::new([0.0, start], segments).expect("a profile"));
    let ball = solid(
        0.0,
        vec![ProfileSegment::Arc {
            to: [0.0, 2.0 * radius],
            centre: [0.0, radius],
            turn: Turn::Ccw,
        }],
    );
    let stick = solid(radius, vec![line(neck, radius), line(neck, length), line(0.0, length)]);
    let profile = whole.profile().expect("a solid of revolution");
    for named in motions().iter().step_by(2) {
        let grid = grid(1, &named.path);
        let sweep = |tool: &Tool| swept_along(tool, &named.path, &grid, Method::Mixed).expect("a sweep");
        let (one, mut parts) = (sweep(&whole), sweep(&ball));
        parts.volume.unite_all(&sweep(&stick).volume).expect("the same grid");
        let tally = same_sweeps(profile, &named.motion, &grid, &one, &parts).expect(&named.name);
        assert!(tally.covered > 10, "{}: {tally:?}", named.name);
    }
}

/// A convex body translated by a vector of length `d` sweeps its volume and `d` times the area of its shadow along it.
#[test]
fn volumes_of_simple_sweeps_are_those_of_the_closed_forms() {
    let (radius, length) = (2.0, 6.0);
    let flat = Tool::flat(radius, length).expect("a flat end");
    let ball = Tool::ball(radius, length).expect("a ball end");
    let way = Vector3::new(3.0, 1.0, -0.5);
    let axis = Vector3::new(0.3, -0.2, 1.0).normalize();
    let across = f64::abs(axis.dot(&way.normalize()));
    let along = f64::sqrt(1.0 - across * across);
    let flat_volume = PI * radius * radius * length;
    let shadow = PI * radius * radius * across + 2.0 * radius * length * along;
    let level = Vector3::new(3.0, 1.0, 0.0);
    let ball_volume = PI * radius * radius * (length - radius) + 2.0 / 3.0 * PI * radius.powi(3);
    let ball_shadow = 2.0 * radius * (length - radius) + FRAC_PI_2 * radius * radius;
    let cases = [
        ("tilted cylinder", flat, axis, way, flat_volume + way.norm() * shadow),
        (
            "ball end",
            ball,
            Vector3::z(),
            level,
            ball_volume + level.norm() * ball_shadow,
        ),
    ];
    for (name, tool, axis, way, expected) in cases {
        let poses = [Vector3::zeros(), way]
            .map(|tip| pose(tip.into(), axis.into()))
            .to_vec();
        for law in [Law::Slerp, Law::ConstantSpeed] {
            let path = Path::with_law(poses.clone(), law).expect("a path");
            let cells = 240;
            let (low, high) = ([-4.0, -4.5], [8.0, 5.0]);
            let grid = Grid::new(low, high, [cells, cells]).expect("a grid");
            let found = swept_along(&tool, &path, &grid, Method::Mixed)
                .expect("a sweep")
                .volume
                .volume();
            // The height over the convex shadow is concave, at most the length of the longest chord. The midpoint rule
            // errs in the cells that the outline crosses, at most 2 P/a + 4 of them, by at most the height each (half
            // of it on either side); inside, concavity makes it too large by less than that of a ring of cells once
            // more.
            let [a, b] = grid.spacing();
            let outline = 2.0 * way.xy().norm() + 2.0 * PI * (radius + length * axis.xy().norm());
            let error = (2.0 * outline / a.min(b) + 4.0) * a * b * length;
            assert!((found - expected).abs() < error, "{name}: {found} {expected} {error}");
            // The bound must also be meaningful: in fact it is well below a hundredth.
            assert!((found / expected - 1.0).abs() < 5e-3, "{name}: {found} {expected}");
        }
    }
}

/// A tool of revolution that goes around its own centre line, or turns about its tip, leaves a solid of revolution:
/// known by its radius.
#[test]
fn a_level_circle_leaves_a_disk() {
    let (radius, round) = (2.0, 1.3);
    let tool = Tool::flat(radius, 6.0).expect("a flat end");
    let at = pose([round, 0.0, 0.0], [0.0, 0.0, 1.0]);
    let arc = TipArc::between([round, 0.0, 0.0], [round, 0.0, 0.0], [0.0; 3], [0.0, 0.0, 1.0], 1).expect("an arc");
    let path = Path::with_moves(vec![at, at], vec![Move::arc(arc)]).expect("a path");
    let grid = Grid::new([-4.03, -4.01], [4.0, 4.02], [41, 41]).expect("a grid");
    let sweep = swept_along(&tool, &path, &grid, Method::Mixed).expect("a sweep");
    let motion = Motion::of_moves(&[at, at], &[Move::arc(arc)]);
    assert!(motion.arcs().len() >= 8);
    let mut covered = 0;
    for index in 0..grid.len() {
        let (i, j) = grid.place(index);
        let (x, y) = (grid.x(i), grid.y(j));
        let inside = x.hypot(y) < radius + round;
        let intervals = sweep.volume.intervals(i, j).to_vec();
        // The circle is less than the radius: no hole is left in the middle.
        assert_eq!(intervals.len(), usize::from(inside), "({x}, {y})");
        if let Some(interval) = intervals.first() {
            assert!(interval.lower.z.abs() < 1e-6 && (interval.upper.z - 6.0).abs() < 1e-6);
            covered += 1;
        }
    }
    assert!(covered > 600, "{covered}");
}
