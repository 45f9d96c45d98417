//! Tools of rational B-spline surfaces, whose homogeneous coordinates are rounded products: equal ones are equal up to rounding only.

use crate::far_and_fine::difference;
use crate::freeform::block;
use crate::grazing_curves::carried;
use nalgebra::{Rotation3, Vector3};
use sweepsim::{Method, Options, sweep};
use sweepsim_dexel::{Frame, Grid};
use sweepsim_motion::Tool;
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

/// A block like that of `freeform`, whose corners have the weights of a list: no face is moved by them.
fn weighted_block(min: [f64; 3], max: [f64; 3], weights: [f64; 8]) -> Tool {
    turned_block(min, max, 0.0, Some(weights))
}

/// The same, turned about its axis; polynomial without weights.
fn turned_block(min: [f64; 3], max: [f64; 3], angle: f64, weights: Option<[f64; 8]>) -> Tool {
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
    let corner = |k: usize| -> [f64; 3] {
        let corner = Vector3::from([0, 1, 2].map(|a| if k >> a & 1 == 0 { min[a] } else { max[a] }));
        if angle == 0.0 {
            corner.into()
        } else {
            (turn * corner).into()
        }
    };
    let faces = [
        [0, 2, 1, 3],
        [4, 5, 6, 7],
        [0, 1, 4, 5],
        [2, 6, 3, 7],
        [0, 4, 2, 6],
        [1, 3, 5, 7],
    ];
    let knots = || vec![KnotVector::new(1, vec![0.0, 0.0, 1.0, 1.0]).expect("knots"); 2];
    let surfaces = faces.map(|face| {
        let points = face.map(corner).concat();
        let weights = face.map(|k| weights.map_or(1.0, |weights| weights[k]));
        RationalSpline::new(knots(), 3, &points, &weights).expect("a surface")
    });
    Tool::from_surfaces(&surfaces, 1e-9).expect("a tool")
}

/// Faces that slide along themselves, at places whose products with the weights are rounded, cost what those of polynomials do; plunges by default had taken some hundred times as long.
#[test]
fn weights_of_flat_faces_cost_nothing() {
    let (min, max) = ([-1.3, -0.7, 0.1], [1.1, 0.9, 3.7]);
    let weights = [0.86, 0.89, 1.24, 0.73, 1.17, 0.91, 1.03, 0.77];
    let tools = [block(min, max), weighted_block(min, max, weights)];
    let moves = [
        [[0.3, 0.2, 1.0], [0.3, 0.2, -1.0]],
        [[0.3, 0.2, 1.0], [0.3, 0.2 + 2.5e-9, -2.0]],
        [[-1.0, 0.3, 0.0], [1.5, -0.4, 0.0]],
        [[-1.0, 0.0, 0.0], [1.5, 0.0, 0.0]],
    ];
    let grid = Grid::new([-3.0, -3.0], [3.0, 3.0], [31, 29]).expect("a grid");
    let frames = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
        .map(|z| Frame::new([0.05; 3], z, [z[2], z[0], z[1]]).expect("a frame"));
    for (tips, turn) in moves
        .iter()
        .flat_map(|tips| [[0.0; 3], [0.0, 0.0, 0.4]].map(|turn| (tips, turn)))
    {
        for (frame, method, tolerance) in frames
            .iter()
            .flat_map(|frame| [Method::Charts, Method::General].map(|method| (frame, method)))
            .flat_map(|(frame, method)| [1e-4, 1e-6, 1e-9].map(|tolerance| (frame, method, tolerance)))
        {
            let [plain, own] = tools.each_ref().map(|tool| {
                let options = Options::new(tolerance).method(method);
                sweep(tool, &carried(tips, turn), &grid.in_frame(*frame), &options, &()).expect("a sweep")
            });
            let what = format!("{tips:?}, {turn:?}, {frame:?}, {method} at {tolerance:e}");
            let [few, found] = [&plain.statistics, &own.statistics];
            assert!(
                found.unresolved.is_empty() && found.repaired <= few.repaired,
                "{what}: {found:?} {few:?}"
            );
            assert!(
                found.boxes <= 2 * few.boxes + 100,
                "{what}: {} {}",
                found.boxes,
                few.boxes
            );
            let apart = difference(&own.volume, &plain.volume, 10.0, 0.0).along_lines;
            assert!(apart < 10.0 * tolerance, "{what}: {apart:e}");
        }
    }
}

/// So do faces that are not across the tool's own axes, by all methods: at 1e-8, charts and the general method had solved 88 to 186 of the 399 lines again, in up to a thousand times as long.
#[test]
fn weights_of_turned_faces_cost_nothing() {
    const ANGLE: f64 = 0.5;
    let (min, max) = ([-1.3, -0.7, 0.1], [1.1, 0.9, 3.7]);
    let weights = [0.86, 0.89, 1.24, 0.73, 1.17, 0.91, 1.03, 0.77];
    let tools = [None, Some(weights)].map(|weights| turned_block(min, max, ANGLE, weights));
    let along = [2.0 * ANGLE.cos(), 2.0 * ANGLE.sin()];
    let moves = [
        [[0.3, 0.2, 1.0], [0.3, 0.2, -1.0]],
        [[-1.0, 0.3, 0.0], [1.5, -0.4, 0.0]],
        [[0.0; 3], [along[0], along[1], 0.0]],
        [[0.0; 3], [along[0], along[1], -0.7]],
    ];
    let grid = Grid::new([-3.0, -3.0], [3.0, 3.0], [21, 19]).expect("a grid");
    let frames = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
        .map(|z| Frame::new([0.05; 3], z, [z[2], z[0], z[1]]).expect("a frame"));
    let methods = [
        Method::Charts,
        Method::General,
        Method::Lines,
        Method::Planes,
        Method::Surface,
    ];
    for (tips, frame, method) in moves
        .iter()
        .flat_map(|tips| frames.iter().map(move |frame| (tips, frame)))
        .flat_map(|(tips, frame)| methods.map(|method| (tips, frame, method)))
    {
        for tolerance in [1e-6, 1e-8] {
            let [plain, own] = tools.each_ref().map(|tool| {
                let options = Options::new(tolerance).method(method);
                sweep(tool, &carried(tips, [0.0; 3]), &grid.in_frame(*frame), &options, &()).expect("a sweep")
            });
            let what = format!("{tips:?}, {frame:?}, {method} at {tolerance:e}");
            let [few, found] = [&plain.statistics, &own.statistics];
            assert!(
                found.unresolved.is_empty() && found.repaired <= few.repaired,
                "{what}: {found:?} {few:?}"
            );
            // Planes are cut in the parameters, of which places on a rational face are no linear functions.
            let times = if method == Method::Planes { 3 } else { 2 };
            assert!(
                found.boxes <= times * few.boxes + 100,
                "{what}: {} {}",
                found.boxes,
                few.boxes
            );
            let apart = difference(&own.volume, &plain.volume, 10.0, 0.0).along_lines;
            assert!(apart < 10.0 * tolerance, "{what}: {apart:e}");
        }
    }
}
