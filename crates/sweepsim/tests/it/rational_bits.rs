//! Tools of rational B-spline surfaces, whose homogeneous coordinates are rounded products: equal ones are equal up to
//! rounding only.

use crate::far_and_fine::difference;
use crate::freeform::{FACES, block};
use crate::grazing_curves::carried;
use nalgebra::{Rotation3, Vector3};
use sweepsim::{Method, Options, sweep};
use sweepsim_dexel::{Frame, Grid};
use sweepsim_motion::{Path, Tool};
use sweepsim_spline::{KnotVector, RationalSpline};

/// As flat at both poles as a cubic is, at heights whose products with most weights are rounded.
const PROFILE: [[f64; 2]; 8] = [
    [0.0, 0.1],
    [0.7, 0.1],
    [1.4, 0.1],
    [2.0, 0.4],
    [2.0, 3.1],
    [2.1, 6.7],
    [1.0, 6.7],
    [0.0, 6.7],
];

fn cubic_up() -> KnotVector {
    let knots = (-3_i32..=8).map(|k| 0.3 * f64::from(k.clamp(0, 5)));
    KnotVector::new(3, knots.collect()).expect("knots")
}

/// A circle of nine points made oval, with a cubic profile.
pub fn ring() -> Tool {
    let h = std::f64::consts::FRAC_1_SQRT_2;
    let around = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4].map(f64::from);
    let around = KnotVector::new(2, around.to_vec()).expect("knots");
    let circle = [
        [1.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
        [-1.0, 1.0],
        [-1.0, 0.0],
        [-1.0, -1.0],
        [0.0, -1.0],
        [1.0, -1.0],
        [1.0, 0.0],
    ];
    let points = PROFILE.iter().flat_map(|[radius, height]| {
        circle
            .iter()
            .flat_map(move |[c, s]| [1.1 * radius * c + 0.1 * radius * s, 0.9 * radius * s, *height])
    });
    let weights = PROFILE
        .iter()
        .flat_map(|_| (0..9).map(|k| if k % 2 == 0 { 1.0 } else { h }));
    surface(around, points.collect(), &weights.collect::<Vec<f64>>())
}

/// A periodic surface that closes smoothly around its axis, with weights that change irregularly within 15 %.
pub fn burr() -> Tool {
    const DISTINCT: usize = 10;
    let around = KnotVector::new(3, (-3..=13).map(|k| 0.7 * f64::from(k)).collect()).expect("knots");
    let columns = || (0..DISTINCT + 3).map(|k| k % DISTINCT);
    let points = PROFILE.iter().flat_map(|[radius, height]| {
        columns().flat_map(move |k| {
            let angle = std::f64::consts::TAU * k as f64 / DISTINCT as f64;
            [radius * angle.cos(), radius * angle.sin(), *height]
        })
    });
    let weights = (0..PROFILE.len())
        .flat_map(|row| columns().map(move |k| 1.0 + 0.15 * (1.7 * k as f64 + 2.9 * row as f64).sin()));
    surface(around, points.collect(), &weights.collect::<Vec<f64>>())
}

fn surface(around: KnotVector, points: Vec<f64>, weights: &[f64]) -> Tool {
    let surface = RationalSpline::new(vec![around, cubic_up()], 3, &points, weights).expect("a surface");
    Tool::from_surfaces(&[surface], 1e-9).expect("a tool")
}

/// A block like that of `freeform`, turned about its axis, whose corners have the weights of a list, if there is one:
/// no face is moved by them.
fn turned_block([min, max]: [[f64; 3]; 2], angle: f64, weights: Option<[f64; 8]>) -> Tool {
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
    let corner = |k: usize| -> [f64; 3] {
        let corner = [0, 1, 2].map(|a| if k >> a & 1 == 0 { min[a] } else { max[a] });
        (turn * Vector3::from(corner)).into()
    };
    let knots = || vec![KnotVector::new(1, vec![0.0, 0.0, 1.0, 1.0]).expect("knots"); 2];
    let surfaces = FACES.map(|face| {
        let points = face.map(corner).concat();
        let weights = face.map(|k| weights.map_or(1.0, |weights| weights[k]));
        RationalSpline::new(knots(), 3, &points, &weights).expect("a surface")
    });
    Tool::from_surfaces(&surfaces, 1e-9).expect("a tool")
}

/// The block of the tests below.
const BLOCK: [[f64; 3]; 2] = [[-1.3, -0.7, 0.1], [1.1, 0.9, 3.7]];
const WEIGHTS: [f64; 8] = [0.86, 0.89, 1.24, 0.73, 1.17, 0.91, 1.03, 0.77];

/// Along each axis, off the origin.
fn frames() -> [Frame; 3] {
    let along = |z: [f64; 3]| Frame::new([0.05; 3], z, [z[2], z[0], z[1]]).expect("a frame");
    [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(along)
}

/// The second tool is swept as certainly as the first, to the same dexels, and takes at most `times` as many boxes.
fn as_cheap(tools: &[Tool; 2], path: &Path, grid: &Grid, options: &Options, times: u64) {
    let [plain, own] = tools
        .each_ref()
        .map(|tool| sweep(tool, path, grid, options, &()).expect("a sweep"));
    let [few, found] = [&plain.statistics, &own.statistics];
    let what = format!("{path:?}, {:?}, {options:?}: {found:?} {few:?}", grid.frame());
    assert!(found.unresolved.is_empty() && found.repaired <= few.repaired, "{what}");
    assert!(found.boxes <= times * few.boxes + 100, "{what}");
    let apart = difference(&own.volume, &plain.volume, 10.0, 0.0).along_lines;
    assert!(apart < 10.0 * options.tolerance, "{what}: {apart:e}");
}

/// Faces that slide along themselves, at places whose products with the weights are rounded, cost what those of
/// polynomials do; plunges by default had taken some hundred times as long.
#[test]
fn weights_of_flat_faces_cost_nothing() {
    let [min, max] = BLOCK;
    let tools = [block(min, max), turned_block(BLOCK, 0.0, Some(WEIGHTS))];
    let moves = [
        [[0.3, 0.2, 1.0], [0.3, 0.2, -1.0]],
        [[0.3, 0.2, 1.0], [0.3, 0.2 + 2.5e-9, -2.0]],
        [[-1.0, 0.3, 0.0], [1.5, -0.4, 0.0]],
        [[-1.0, 0.0, 0.0], [1.5, 0.0, 0.0]],
    ];
    let grid = Grid::new([-3.0, -3.0], [3.0, 3.0], [31, 29]).expect("a grid");
    for tips in &moves {
        for path in [[0.0; 3], [0.0, 0.0, 0.4]].map(|turn| carried(tips, turn)) {
            for grid in frames().map(|frame| grid.in_frame(frame)) {
                for method in [Method::Mixed, Method::General] {
                    for tolerance in [1e-4, 1e-6, 1e-9] {
                        as_cheap(&tools, &path, &grid, &Options::new(tolerance).method(method), 2);
                    }
                }
            }
        }
    }
}

/// So do faces that are not across the tool's own axes, by all methods; at 1e-8, charts and the general method had
/// solved 88 to 186 of the 399 lines again, which took up to a thousand times as long.
#[test]
fn weights_of_turned_faces_cost_nothing() {
    const ANGLE: f64 = 0.5;
    let tools = [None, Some(WEIGHTS)].map(|weights| turned_block(BLOCK, ANGLE, weights));
    let along = [2.0 * ANGLE.cos(), 2.0 * ANGLE.sin()];
    let moves = [
        [[0.3, 0.2, 1.0], [0.3, 0.2, -1.0]],
        [[-1.0, 0.3, 0.0], [1.5, -0.4, 0.0]],
        [[0.0; 3], [along[0], along[1], 0.0]],
        [[0.0; 3], [along[0], along[1], -0.7]],
    ];
    // Planes are cut in the parameters, of which places on a rational face are not linear functions.
    let methods = [
        (Method::Mixed, 2),
        (Method::General, 2),
        (Method::Lines, 2),
        (Method::Planes, 3),
        (Method::Surface, 2),
    ];
    let grid = Grid::new([-3.0, -3.0], [3.0, 3.0], [21, 19]).expect("a grid");
    for path in moves.map(|tips| carried(&tips, [0.0; 3])) {
        for grid in frames().map(|frame| grid.in_frame(frame)) {
            for (method, times) in methods {
                for tolerance in [1e-6, 1e-8] {
                    as_cheap(&tools, &path, &grid, &Options::new(tolerance).method(method), times);
                }
            }
        }
    }
}
