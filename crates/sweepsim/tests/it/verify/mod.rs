//! Programs with and without planted faults.

mod at_joints;
mod by_force;
mod checkpoints;
mod deviation;
mod regions;
mod removal;
mod setups;
mod solids;
mod standing;
mod threads;
mod tiles;

use by_force::{Case, Cylinder, pose};
use std::ops::ControlFlow;
use sweepsim::prelude::*;
use sweepsim::verify::{MoveState, Scene, ToolPath, VerifyOptions, verify};
use sweepsim_motion::{Assembly, Move, RotaryTable, TipArc, TipCourse, Turning};

/// SplitMix64.
struct Random(u64);

impl Random {
    fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15))
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ z >> 31
    }

    fn below(&mut self, end: u64) -> u64 {
        self.next() % end
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A raster that clears the block's top down to the target, with returns above it: nothing is wrong with it.
fn clean(random: &mut Random) -> Case {
    let tilted = random.below(2) == 1;
    let radius = random.within(2.0, 3.5);
    let cutter = Cylinder { radius, z: [0.0, 12.0] };
    let holder = Cylinder {
        radius: radius + random.within(0.5, 4.0),
        z: [13.0, 40.0],
    };
    let stock = [[-10.0, -8.0, -6.0], [10.0, 8.0, 0.0]];
    let (mut poses, mut states) = (Vec::new(), Vec::new());
    let tilt = if tilted { random.within(0.02, 0.2) } else { 0.0 };
    let floor = -random.within(1.0, 3.0);
    let lead = [tilt, 0.5 * tilt, 1.0];
    let other = if tilted { [-tilt, tilt, 1.0] } else { lead };
    let mut y = -7.0;
    // A tilted flat end digs below its tip by its radius times the slope.
    let height = floor + 1.5 * tilt * radius;
    while y < 7.5 {
        for (x, z, axis, state) in [
            (-16.0, 8.0, lead, MoveState::RAPID),
            (-16.0, height, lead, MoveState::FEED),
            (16.0, height, other, MoveState::FEED),
            (16.0, 8.0, other, MoveState::RAPID),
        ] {
            poses.push(pose([x, y, z], axis));
            states.push(state);
        }
        y += random.within(2.0, 5.0);
    }
    states.remove(0);
    let target = ([[-10.0, -8.0, -6.0], [10.0, 8.0, floor - 0.1]], 0.1);
    Case {
        cutter,
        holder,
        poses,
        moves: Vec::new(),
        states,
        stock,
        clamp: Some([[-22.0, -3.0, -6.0], [-20.2, 3.0, 3.0]]),
        target: Some(target),
    }
}

#[test]
fn nothing_is_found_in_programs_without_faults() {
    for seed in 0..30 {
        let case = clean(&mut Random::new(seed));
        assert_eq!(case.verified(), [], "seed {seed}");
    }
}

/// What remains is what [`simulate`] leaves.
#[test]
fn the_rest_is_that_of_a_simulation() {
    for seed in 0..10 {
        let mut case = clean(&mut Random::new(500 + seed));
        // So that feed moves follow one another.
        case.states = vec![MoveState::FEED; case.states.len()];
        let [min, max] = case.stock;
        let stock = Stock::Block { min, max }.dexels(&case.grid()).unwrap();
        let (tool, path) = (case.cutter.tool(), case.path());
        let simulated = simulate(stock.clone(), &[Cut::new(&tool, &path)], &Options::default(), &()).unwrap();
        let assembly = Assembly::new(tool);
        let options = VerifyOptions::default().each_move(true);
        let program = [ToolPath::new(&assembly, &path)];
        let go_on = &mut |_: &_| ControlFlow::Continue(());
        let verified = verify(Scene::new(stock.clone()), &program, &options, go_on, &()).unwrap();
        for (line, expected) in simulated.remaining.iter() {
            let found = verified.remaining.at(line);
            assert_eq!(found.len(), expected.len(), "seed {seed}, line {line}");
            for (a, b) in found.heights().flatten().zip(expected.heights().flatten()) {
                assert!((a - b).abs() < 1e-9, "seed {seed}, line {line}: {a} {b}");
            }
        }
        let removed = stock.volume() - simulated.remaining.volume();
        assert!((verified.paths[0].volume - removed).abs() < 1e-6 * removed);
        let each: f64 = verified.moves.iter().map(|removal| removal.volume).sum();
        assert!((each - removed).abs() < 1e-6 * removed, "{each} {removed}");
        assert_eq!(verified.moves.len(), path.moves());
    }
}

/// Holders that come down along arcs, helices, at constant speed and by rotary axes, into the wall of a pocket.
#[test]
fn collisions_in_moves_of_other_kinds() {
    let mut sure = 0;
    for seed in 0..12 {
        let random = &mut Random::new(2000 + seed);
        let mut case = clean(random);
        let depth = random.within(2.0, 5.5);
        case.holder.z[0] = depth - random.within(-0.5, 1.5);
        let up = [0.0, 0.0, 1.0];
        let (from, to) = ([6.0, 0.0, 0.5], [-6.0, 0.0, -depth]);
        let arc = TipArc::between(from, to, [0.0; 3], up, 1).unwrap();
        let leaning = RotaryTable::Ac.axis([0.0, 0.0]);
        let end = RotaryTable::Ac.axis([12.0, 30.0]);
        let way = |course, turning| Move { course, turning };
        let rotary = Turning::Rotary {
            table: RotaryTable::Ac,
            from: [0.0, 0.0],
            to: [12.0, 30.0],
        };
        case.poses = vec![
            pose(from, up),
            pose(to, up),
            pose([5.0, 1.0, -depth], leaning),
            pose([0.0, 0.0, -1.0], end),
        ];
        case.moves = vec![
            way(TipCourse::Arc(arc), Turning::Even),
            way(TipCourse::Straight, Turning::Even),
            way(TipCourse::Straight, rotary),
        ];
        case.states = vec![MoveState::FEED; 3];
        (case.clamp, case.target) = (None, None);
        sure += case.check(&format!("seed {seed}"));
    }
    assert!(sure >= 12, "{sure}");
}

/// The kinds of planted faults.
const FAULTS: usize = 10;

/// Plants a fault of a kind in a program without any, and judges what is found by brute force; the number of sure
/// findings.
fn planted(seed: u64) -> usize {
    let random = &mut Random::new(1000 + seed);
    let mut case = clean(random);
    let fault = seed as usize % FAULTS;
    let at = random.below(case.poses.len() as u64 - 2) as usize + 1;
    let tip = case.poses[at].tip();
    let axis = case.poses[at].axis();
    match fault {
        // A rapid one block too early.
        0 => case.states[at] = MoveState::RAPID,
        // A holder that reaches lower.
        1 => {
            case.holder.z[0] -= random.within(10.5, 12.5);
            case.holder.radius += 2.0;
        }
        // A clamp in the way.
        2 => case.clamp = Some([[-14.0, -4.0, -6.0], [-11.0, 4.0, 1.0]]),
        // One digit of a coordinate wrong.
        3 => case.poses[at] = pose([tip[0], tip[1], tip[2] - random.within(1.0, 9.0)], axis),
        // The sign of the tilt, or a tilt where there is none.
        4 => case.poses[at] = pose(tip, [axis[0] + 0.4, -axis[1] - 0.2, axis[2]]),
        // The spindle stands still.
        5 => case.states[at] = MoveState::FEED.with_spindle_stopped(true),
        // Another stock, which is higher.
        6 => case.stock[1][2] += random.within(2.0, 14.0),
        // No offset for the tool's length: everything is too low.
        7 => {
            let by = random.within(1.0, 9.0);
            let lower = |p: &Pose| pose([p.tip()[0], p.tip()[1], p.tip()[2] - by], p.axis());
            case.poses = case.poses.iter().map(lower).collect();
        }
        // Inches for millimetres in one coordinate.
        8 => case.poses[at] = pose([tip[0], tip[1], tip[2] * 25.4], axis),
        // Another tool, which is thicker and shorter.
        _ => {
            case.cutter.radius += random.within(0.5, 2.0);
            case.cutter.z[1] -= random.within(2.0, 8.0);
            case.holder.z[0] -= random.within(8.0, 11.0);
        }
    }
    case.check(&format!("seed {seed}, fault {fault}"))
}

/// Not every planted fault does harm; `least` of those of each kind must.
fn planted_faults(seeds: u64, least: usize) {
    let mut sure = [0; FAULTS];
    for seed in 0..seeds {
        sure[seed as usize % FAULTS] += planted(seed);
    }
    assert!(sure.iter().sum::<usize>() >= 3 * seeds as usize, "{sure:?}");
    assert!(sure.iter().all(|sure| *sure >= least), "{sure:?}");
}

#[test]
fn planted_faults_are_found() {
    planted_faults(12, 0);
}

#[test]
#[ignore = "takes minutes"]
fn many_planted_faults_are_found() {
    planted_faults(300, 5);
}
