//! Set-ups: the part stays where it is, and the tools come from elsewhere.

use super::Random;
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use std::ops::ControlFlow;
use sweepsim::SweepError;
use sweepsim::prelude::*;
use sweepsim::verify::{FindingKind, MoveState, Scene, ToolPath, Verification, VerifyOptions, verify};
use sweepsim_dexel::{Frame, Operation};
use sweepsim_motion::{Assembly, Law, RotaryTable};

const TOLERANCE: f64 = 1e-6;

fn stock() -> Dexels {
    let grid = Grid::new([-10.0, -8.0], [10.0, 8.0], [50, 40]).unwrap();
    let (min, max) = ([-10.0, -8.0, 0.0], [10.0, 8.0, 12.0]);
    Stock::Block { min, max }.dexels(&grid).unwrap()
}

fn run(program: &[ToolPath]) -> Verification {
    let options = VerifyOptions::new(Options::new(TOLERANCE));
    let go_on = &mut |_: &_| ControlFlow::Continue(());
    verify(Scene::new(stock()), program, &options, go_on, &()).unwrap()
}

fn path(poses: &[([f64; 3], [f64; 3])], law: Law) -> Path {
    let poses = poses.iter().map(|(tip, axis)| Pose::new(*tip, *axis).unwrap());
    Path::with_law(poses.collect(), law).unwrap()
}

/// The largest difference of two results on any line, in total length.
fn difference(a: &Dexels, b: &Dexels) -> f64 {
    let length = |from: &Dexels, other: &Dexels| -> f64 {
        let mut rest = from.clone();
        rest.combine(Operation::Difference, other).unwrap();
        let of_line = |line: usize| rest.at(line).heights().map(|[low, high]| high - low).sum::<f64>();
        (0..rest.grid().len()).map(of_line).fold(0.0, f64::max)
    };
    length(a, b).max(length(b, a))
}

/// Poses in the part's frame are turned by hand into those of a set-up anywhere; moved back, they cut the same part.
#[test]
fn a_set_up_anywhere_cuts_what_the_same_moves_cut_in_the_frame_of_the_part() {
    let mut random = Random::new(14);
    let cutter = Assembly::new(Tool::ball(2.5, 20.0).unwrap());
    for law in [Law::Slerp, Law::ConstantSpeed] {
        for _ in 0..4 {
            let poses: Vec<([f64; 3], [f64; 3])> = (0..4)
                .map(|_| {
                    let tip = [
                        random.within(-12.0, 12.0),
                        random.within(-9.0, 9.0),
                        random.within(6.0, 11.0),
                    ];
                    (tip, [random.within(-0.5, 0.5), random.within(-0.5, 0.5), 1.0])
                })
                .collect();
            let axis = Unit::new_normalize(Vector3::from([0, 1, 2].map(|_| random.within(-1.0, 1.0))));
            let turn: Matrix3<f64> = Rotation3::from_axis_angle(&axis, random.within(-3.0, 3.0)).into();
            let shift = Vector3::from([0, 1, 2].map(|_| random.within(-50.0, 50.0)));
            let to_setup = |tip: [f64; 3]| <[f64; 3]>::from(turn.tr_mul(&(Vector3::from(tip) - shift)));
            let turned = |v: [f64; 3]| <[f64; 3]>::from(turn.tr_mul(&Vector3::from(v)));
            let there: Vec<_> = poses
                .iter()
                .map(|(tip, axis)| (to_setup(*tip), turned(*axis)))
                .collect();
            let written = path(&poses, law);
            let moved = path(&there, law).moved(&turn, shift).unwrap();
            let results = [&written, &moved].map(|path| run(&[ToolPath::new(&cutter, path)]));
            assert!(results.iter().all(|result| result.unresolved.is_empty()));
            assert!(results[0].paths[0].volume > 1.0);
            let worst = difference(&results[0].remaining, &results[1].remaining);
            assert!(worst < 4.0 * TOLERANCE, "{law:?}: {worst}");
        }
    }
}

/// The rotary axes of a set-up turn about its own x and z, not about those of the part.
#[test]
fn rotary_axes_belong_to_the_set_up() {
    let cutter = Assembly::new(Tool::flat(2.0, 20.0).unwrap());
    // On its side: the set-up's z is the part's x.
    let turn = Matrix3::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0);
    // In the set-up: a quarter of the table turns at a constant tilt.
    let (sine, cosine) = 0.4_f64.sin_cos();
    let own = [
        ([-8.0, 4.0, 5.0], [0.0, sine, cosine]),
        ([8.0, 8.0, 5.0], [sine, 0.0, cosine]),
    ];
    let moved = path(&own, Law::Rotary(RotaryTable::Ac)).moved(&turn, [0.0; 3]).unwrap();
    // By hand: the axis on its cone, in steps of half a degree.
    let steps = 180;
    let dense: Vec<([f64; 3], [f64; 3])> = (0..=steps)
        .map(|k| {
            let part = f64::from(k) / f64::from(steps);
            let (s, c) = (part * std::f64::consts::FRAC_PI_2).sin_cos();
            let at = |v: [f64; 3]| <[f64; 3]>::from(turn * Vector3::from(v));
            (
                at([-8.0 + 16.0 * part, 4.0 + 4.0 * part, 5.0]),
                at([s * sine, c * sine, cosine]),
            )
        })
        .collect();
    let written = path(&dense, Law::Slerp);
    let [a, b] = [&moved, &written].map(|path| run(&[ToolPath::new(&cutter, path)]).remaining);
    // Each great circle leaves the cone by less than (half a degree)²/8 · sin 0.4 at most: 20 mm up the tool that is
    // 8e-5 mm; lines that graze a wall see more of it, so compare volumes.
    let volume = |dexels: &Dexels| dexels.volume();
    assert!(volume(&stock()) - volume(&a) > 100.0);
    assert!((volume(&a) - volume(&b)).abs() < 0.05, "{} {}", volume(&a), volume(&b));
}

/// Lying on a plate below, with a clamp on the far side of it; in the next set-up upside down, and the plate where the
/// first cuts.
#[test]
fn fixtures_count_in_their_own_set_up_only() {
    let cutter = Assembly::new(Tool::flat(2.0, 20.0).unwrap());
    let across = |z: f64| [([-15.0, 0.0, z], [0.0, 0.0, 1.0]), ([15.0, 0.0, z], [0.0, 0.0, 1.0])];
    let first = path(&across(9.0), Law::Slerp);
    // z down from the bottom: 3 mm deep in the set-up is z = 3 in the part.
    let over = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
    let second = path(&across(-3.0), Law::Slerp).moved(&over, [0.0; 3]).unwrap();
    let grid = Grid::new([-20.0, -12.0], [20.0, 12.0], [100, 60]).unwrap();
    let plate = |z: [f64; 2]| {
        let (min, max) = ([-20.0, -12.0, z[0]], [20.0, 12.0, z[1]]);
        Stock::Block { min, max }.dexels(&grid).unwrap()
    };
    let (below, above) = (plate([-9.0, 0.0]), plate([12.0, 20.0]));
    let program = |fixtures: [&Dexels; 2]| {
        let paths = [&first, &second].map(|path| ToolPath::new(&cutter, path));
        run(&[paths[0].with_fixtures(fixtures[0]), paths[1].with_fixtures(fixtures[1])])
    };
    let good = program([&below, &above]);
    assert_eq!(good.findings, []);
    // The slots of both set-ups, of 4 × 20 × 3 mm each.
    assert!(
        good.paths.iter().all(|path| (path.volume - 240.0).abs() < 1e-3),
        "{:?}",
        good.paths
    );
    // With the plates of the other set-up, both hit.
    let bad = program([&above, &below]);
    let found: Vec<_> = bad.findings.iter().map(|found| (found.kind, found.path)).collect();
    assert_eq!(found, [(FindingKind::Fixture, 0), (FindingKind::Fixture, 1)]);
    // The second plate is met from below.
    assert!(bad.findings[1].place[2] < 0.0);
}

/// A rapid of the second set-up goes through the slot of the first; the other way round it goes through material.
#[test]
fn the_next_set_up_begins_with_the_stock_of_the_last() {
    let cutter = Assembly::new(Tool::flat(2.0, 30.0).unwrap());
    let up = [0.0, 0.0, 1.0];
    let slot = path(&[([-15.0, 0.0, 4.0], up), ([15.0, 0.0, 4.0], up)], Law::Slerp);
    // From the side: the set-up's z is the part's −y, and its y the part's z.
    let turn = Matrix3::new(1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
    let rapid = path(&[([-15.0, 8.5, -1.0], up), ([15.0, 8.5, -1.0], up)], Law::Slerp);
    let rapid = rapid.moved(&turn, [0.0; 3]).unwrap();
    // The rapid's tip is at y = 1, its cutter reaches to y = −29: it clears the slot, and hits the wall before it.
    let thin = Assembly::new(Tool::flat(1.0, 2.0).unwrap());
    let states = [MoveState::RAPID];
    let rapid = ToolPath::new(&thin, &rapid).with_states(&states);
    let slot = ToolPath::new(&cutter, &slot);
    assert_eq!(run(&[slot, rapid]).findings, []);
    let other = run(&[rapid, slot]).findings;
    assert_eq!(other.len(), 1);
    assert_eq!((other[0].kind, other[0].path), (FindingKind::Rapid, 0));
}

#[test]
fn fixtures_on_other_lines_are_refused() {
    let cutter = Assembly::new(Tool::flat(2.0, 30.0).unwrap());
    let slot = path(&[([-15.0, 0.0, 4.0], [0.0, 0.0, 1.0])], Law::Slerp);
    let grid = Grid::new([0.0; 2], [1.0; 2], [2, 2]).unwrap();
    let tilted = Frame::new([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]).unwrap();
    let fixtures = Dexels::empty(grid.in_frame(tilted));
    let program = [ToolPath::new(&cutter, &slot).with_fixtures(&fixtures)];
    let go_on = &mut |_: &_| ControlFlow::Continue(());
    let refused = verify(Scene::new(stock()), &program, &VerifyOptions::default(), go_on, &());
    assert!(matches!(refused, Err(SweepError::Grid)));
}
