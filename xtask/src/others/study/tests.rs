//! The samplers' closed forms against their distances, and against the engine.

use super::columns::{Bridge, Columns, Sampled};
use super::cutter::{Cutter, Place};
use super::errors;
use super::hull::Hull;
use nalgebra::{Matrix3, Vector3};
use sweepsim::{Cut, Options, simulate};
use sweepsim_dexel::{Grid, Stock};
use sweepsim_motion::{Path, Pose, Tool};

fn place(tip: [f64; 3], axis: [f64; 3]) -> Place {
    Place {
        tip: tip.into(),
        axis: Vector3::from(axis).normalize(),
        turn: Matrix3::identity(),
    }
}

fn cutters() -> [Cutter; 2] {
    [Tool::ball(2.0, 9.0), Tool::flat(2.0, 9.0)].map(|tool| Cutter::of(&tool.unwrap()).unwrap())
}

/// Places and lines that have nothing to do with each other.
fn leaning() -> impl Iterator<Item = (Place, [f64; 2])> {
    (1..4000).map(|n| {
        let turn = |factor: f64| (f64::from(n) * factor).sin();
        let axis = [turn(0.37), turn(0.61), if n % 5 == 0 { 0.0 } else { turn(0.83) }];
        (
            place([turn(1.3), turn(1.7), turn(2.1)], axis),
            [4.0 * turn(2.9), 4.0 * turn(3.3)],
        )
    })
}

#[test]
fn intervals_end_at_distance_zero() {
    for cutter in &cutters() {
        let mut hits = 0;
        for (place, line) in leaning() {
            let mut inside = None;
            cutter.cut(&place, line, |low, high| inside = Some([low, high]));
            let at = |z: f64| cutter.distance(&place, &Vector3::new(line[0], line[1], z));
            if let Some([low, high]) = inside {
                hits += 1;
                assert!(
                    at(low).abs() < 1e-7 && at(high).abs() < 1e-7,
                    "{} {}",
                    at(low),
                    at(high)
                );
                assert!(at(0.5 * (low + high)) < 0.0 && at(low - 0.1) > 0.0 && at(high + 0.1) > 0.0);
                let bounds = cutter.bounds(&place);
                assert!((0..2).all(|k| bounds[k][0] <= line[k] && line[k] <= bounds[k][1]));
            } else {
                assert!((-150..150).all(|z| at(0.1 * f64::from(z)) > -1e-9));
            }
        }
        assert!(hits > 400, "{hits}");
    }
}

#[test]
fn hulls_hold_what_lies_between() {
    let [ball, _] = cutters();
    let mut hits = 0;
    for ((from, line), (to, _)) in leaning().zip(leaning().skip(7)) {
        let hull = Hull::new(&ball, &from, &to);
        let Some([low, high]) = hull.cut(line) else { continue };
        hits += 1;
        let bounds = hull.bounds();
        assert!((0..2).all(|k| bounds[k][0] <= line[k] && line[k] <= bounds[k][1]));
        for z in [low, high] {
            let away = hull.distance(&Vector3::new(line[0], line[1], z));
            assert!(away.abs() < 1e-7, "{away}");
        }
        for place in [&from, &to] {
            ball.cut(place, line, |start, end| {
                assert!(start > low - 1e-9 && end < high + 1e-9)
            });
        }
    }
    assert!(hits > 400, "{hits}");
}

/// Both kinds of sampling converge to the exact dexels: balls with the square of the spacing, hulls with the spacing
/// itself, because the hull of a tool that turns about a point of its axis is wide there.
#[test]
fn errors_shrink_as_they_must() {
    let tool = Tool::ball(3.0, 30.0).unwrap();
    let poses = vec![
        Pose::new([-6.0, 0.3, 0.0], [0.1, 0.0, 1.0]).unwrap(),
        Pose::new([6.0, 1.0, 1.0], [0.0, 0.4, 1.0]).unwrap(),
    ];
    let path = Path::new(poses).unwrap();
    let grid = Grid::new([-11.0, -6.0], [11.0, 12.0], [44, 36]).unwrap();
    let block = Stock::Block {
        min: [-11.0, -6.0, -5.0],
        max: [11.0, 12.0, 6.0],
    };
    let stock = block.dexels(&grid).unwrap();
    let exact = simulate(stock.clone(), &[Cut::new(&tool, &path)], &Options::new(1e-7), &())
        .unwrap()
        .remaining;
    let (points, cutter) = (errors::points(&exact), Cutter::of(&tool).unwrap());
    assert!(points.len() > 300);
    for (bridge, range) in [(Bridge::Union, 3.0..5.5), (Bridge::Hulls, 1.6..2.5)] {
        let mut before: Option<f64> = None;
        for spacing in [1.0, 0.5, 0.25, 0.125] {
            let parts = Sampled::path(&path, &cutter, 12.0, spacing);
            let found = errors::errors(&points, &[(&cutter, &parts)], bridge);
            assert!(found.rms <= found.p99 && found.p99 <= found.max);
            if let Some(before) = before {
                let factor = before / found.rms;
                assert!(
                    range.contains(&factor),
                    "{bridge:?} {spacing}: {before} to {}",
                    found.rms
                );
            }
            before = Some(found.rms);
            let mut columns = Columns::of(&stock);
            columns.remove(&cutter, &parts, bridge);
            let left = columns.volume() - exact.volume();
            // Material is left where tools are placed; at most a film over the surface of some 300 mm².
            if bridge == Bridge::Union {
                assert!(left > 0.0 && left < 600.0 * found.max, "{left}");
            }
        }
    }
}
