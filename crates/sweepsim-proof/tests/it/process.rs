//! Shanks and rapids beside a stock while it is cut.

use crate::clear::certified;
use nalgebra::Vector3;
use std::cell::Cell;
use sweepsim_dexel::Stock;
use sweepsim_motion::{Move, Path, Pose, Profile, ProfileSegment, TipArc, Tool};
use sweepsim_proof::{Cutter, Movers, Room, Touched, Work, cover_and_cores, touched};
use sweepsim_props::test_runner::{Config, RngSeed, TestRunner};
use sweepsim_props::*;

pub(crate) const ROOM: Room = Room {
    distance: -1e-3,
    deviation: 1e-6,
    zones: 200_000,
};

pub(crate) fn block() -> Stock {
    Stock::Block {
        min: [-30.0, -20.0, -20.0],
        max: [30.0, 20.0, 0.0],
    }
}

/// A cylinder about the axis between two heights above the tip.
fn cylinder(radius: f64, [low, high]: [f64; 2]) -> Tool {
    let line = |rho, zeta| ProfileSegment::Line { to: [rho, zeta] };
    let outline = vec![line(radius, low), line(radius, high), line(0.0, high)];
    Tool::from_profile(Profile::new([0.0, low], outline).expect("an outline"))
}

pub(crate) struct Scene {
    pub path: Path,
    pub cutter: Tool,
    pub body: Tool,
    /// The moves that are rapids.
    pub rapids: Vec<usize>,
}

impl Scene {
    /// A flat end mill of 10 mm that cuts over `flute`, with a shank above.
    pub fn new(tips: &[[f64; 3]], flute: f64, shank: f64) -> Self {
        let poses = tips.iter().map(|tip| Pose::new(*tip, [0.0, 0.0, 1.0]).expect("a pose"));
        Self {
            path: Path::new(poses.collect()).expect("a path"),
            cutter: Tool::flat(5.0, flute).expect("a tool"),
            body: cylinder(shank, [flute, 60.0]),
            rapids: Vec::new(),
        }
    }

    fn touched(&self, movers: Movers, room: &Room) -> Touched {
        self.touched_in(&block(), movers, room)
    }

    pub fn touched_in(&self, stock: &Stock, movers: Movers, room: &Room) -> Touched {
        let is_rapid = |number: usize| self.rapids.contains(&number);
        let [cutter, bodies] = [&self.cutter, &self.body].map(|tool| cover_and_cores(tool, 1e-4));
        let work = [Work {
            cutter: Cutter::new(&cutter, &self.path, None),
            bodies: &bodies,
            is_rapid: &is_rapid,
        }];
        let found = touched(stock, &work, movers, room, &());
        let found = found.expect("a stock").expect("not cancelled");
        // What is proven can be checked.
        let is_proven = found.open_count == 0 && found.moves.is_empty();
        assert_eq!(found.trees.is_some(), is_proven);
        if is_proven {
            let own = certified(self, stock, movers, room, &found).checked();
            assert!(own.is_proven() && own.bound == -room.distance, "{movers:?}: {own:?}");
        }
        found
    }

    /// The moves that touch; nothing may be open.
    fn moves(&self, movers: Movers, room: &Room) -> Vec<usize> {
        let found = self.touched(movers, room);
        let open = &found.open;
        assert_eq!(
            found.open_count, 0,
            "{movers:?} {room:?}: open after {}: {open:?}",
            found.zones
        );
        found.moves.iter().map(|(_, witness)| witness.number).collect()
    }
}

/// A slot in steps of so much, down to a depth: in and out along x.
pub(crate) fn slot(step: f64, depth: f64) -> Vec<[f64; 3]> {
    let mut tips = vec![[-40.0, 0.0, 5.0]];
    let mut z = 0.0;
    let mut side = -40.0;
    while z > -depth + 1e-9 {
        z -= step;
        tips.push([side, 0.0, z]);
        side = -side;
        tips.push([side, 0.0, z]);
    }
    tips
}

#[test]
fn a_shank_as_wide_as_its_cutter_slides_along_the_walls_of_its_slot() {
    let scene = Scene::new(&slot(4.0, 12.0), 5.0, 5.0);
    assert_eq!(scene.moves(Movers::Bodies, &ROOM), [0_usize; 0]);
    // Within the depth that is allowed, and beyond.
    let wider = |by: f64| Scene::new(&slot(4.0, 12.0), 5.0, 5.0 + by).moves(Movers::Bodies, &ROOM);
    assert_eq!(wider(0.000_9), [0_usize; 0]);
    // The cutter is 5 mm long: the shank is in the slot from the second step on.
    assert_eq!(wider(0.003), [3, 5]);
    // The first step is deeper than the cutter is long.
    let scene = Scene::new(&slot(8.0, 16.0), 5.0, 5.0);
    assert_eq!(scene.moves(Movers::Bodies, &ROOM), [1, 3]);
}

/// A ball withdraws on a slope, beside a row that went on below: what has removed the most around a place has not
/// removed all of a zone.
#[test]
fn a_ball_withdraws_on_a_slope() {
    let row = |y: f64, moves: u32| (0..=moves).map(move |k| [6.0 - 0.22 * f64::from(k), y, -1.0 - 0.08 * f64::from(k)]);
    let mut tips: Vec<[f64; 3]> = row(0.0, 40).collect();
    // Up, and down again where the second row begins.
    tips.extend([[-2.8, 0.0, 5.0], [6.0, 0.21, 5.0]]);
    tips.extend(row(0.21, 20));
    let end = tips.len() - 1;
    tips.push([tips[end][0], tips[end][1], 5.0]);
    let mut scene = Scene::new(&tips, 15.0, 5.0);
    (scene.cutter, scene.rapids) = (Tool::ball(3.0, 30.0).expect("a tool"), vec![40, 41, end]);
    assert_eq!(scene.moves(Movers::Rapids, &ROOM), [0_usize; 0]);
    // Where it did not go down before, it touches.
    tips[end][2] -= 0.5;
    tips[end + 1] = [tips[end][0], tips[end][1] + 0.1, 5.0];
    scene.path = Scene::new(&tips, 15.0, 5.0).path;
    assert_eq!(scene.moves(Movers::Rapids, &ROOM), [end]);
}

#[test]
fn rapids_through_the_stock_are_found_between_the_lines() {
    let mut tips = slot(4.0, 8.0);
    // Up, over, down again into the slot, along it, and up.
    let end = tips[tips.len() - 1];
    let first = tips.len() - 1;
    tips.extend([
        [end[0], 0.0, 5.0],
        [0.0, 0.0, 5.0],
        [0.0, 0.0, -8.0],
        [12.0, 0.0, -8.0],
        [12.0, 0.0, 5.0],
    ]);
    let rapids: Vec<usize> = (first..tips.len() - 1).collect();
    let mut scene = Scene::new(&tips, 15.0, 5.0);
    scene.rapids.clone_from(&rapids);
    assert_eq!(scene.moves(Movers::Rapids, &ROOM), [0_usize; 0]);
    // A hundredth beside the slot, on the way along it, and then down at its side.
    let mut off = tips.clone();
    off[first + 4][1] = 0.01;
    off[first + 5][1] = 0.01;
    let mut scene = Scene::new(&off, 15.0, 5.0);
    scene.rapids = rapids;
    assert_eq!(scene.moves(Movers::Rapids, &ROOM), [first + 3, first + 4]);
}

#[test]
fn a_shank_follows_its_cutter_along_arcs() {
    let up = [0.0, 0.0, 1.0];
    let pose = |tip: [f64; 3]| Pose::new(tip, up).expect("a pose");
    let circle = |z: f64| Move::arc(TipArc::new([0.0, 0.0, z], up, std::f64::consts::TAU).expect("a circle"));
    let (mut poses, mut moves) = (vec![pose([8.0, 0.0, 5.0])], Vec::new());
    for z in [-4.0, -8.0, -12.0] {
        poses.extend([pose([8.0, 0.0, z]), pose([8.0, 0.0, z])]);
        moves.extend([Move::default(), circle(z)]);
    }
    let mut scene = Scene::new(&slot(4.0, 4.0), 5.0, 5.0);
    scene.path = Path::with_moves(poses, moves).expect("a path");
    assert_eq!(scene.moves(Movers::Bodies, &ROOM), [0_usize; 0]);
    scene.body = cylinder(5.05, [5.0, 60.0]);
    assert_eq!(scene.moves(Movers::Bodies, &ROOM), [2, 3, 4, 5]);
}

#[test]
fn a_clearance_is_kept_or_not() {
    // A holder 3 mm wider than the cutter, 2 mm above the stock at the end.
    let mut scene = Scene::new(&slot(4.0, 12.0), 5.0, 5.0);
    scene.body = cylinder(8.0, [14.0, 60.0]);
    let room = |distance: f64| Room { distance, ..ROOM };
    assert_eq!(scene.moves(Movers::Bodies, &room(1.9)), [0_usize; 0]);
    let found = scene.touched(Movers::Bodies, &room(2.2));
    assert_eq!(
        found.moves.iter().map(|(_, w)| w.number).collect::<Vec<_>>(),
        [5],
        "{found:?}"
    );
    let (_, witness) = &found.moves[0];
    assert!(witness.depth >= 2.0 && witness.depth <= 2.2, "{witness:?}");
    assert!(Vector3::from(witness.place).z > 1.9);
}

/// A program in a block, by seeds: the same way at some levels, with rapids between.
fn random_scene(kind: u8, wide: f64, way: &[[f64; 2]], (levels, step): (usize, f64), tilts: [f64; 3]) -> (Scene, Tool) {
    let tool = match kind {
        0 => Tool::ball(2.0, 4.0),
        1 => Tool::flat(2.0, 4.0),
        _ => Tool::bull(2.0, 0.7, 4.0),
    };
    let tool = tool.expect("a tool");
    let axis = |k: usize| [tilts[k % 3] * tilts[2], tilts[(k + 1) % 3] * tilts[2], 1.0];
    let (mut poses, mut rapids) = (Vec::new(), Vec::new());
    let mut add = |tip: [f64; 3], k: usize, rapid: bool| {
        if rapid {
            rapids.push(poses.len() - 1);
        }
        poses.push(Pose::new(tip, axis(k)).expect("a pose"));
    };
    add([way[0][0], way[0][1], 14.0], 0, false);
    for level in 1..=levels {
        let z = -step * level as f64;
        add([way[0][0], way[0][1], z + step + 0.1], 0, true);
        for (k, [x, y]) in way.iter().enumerate() {
            add([*x, *y, z], k, false);
        }
        // Some withdraw, others go straight back.
        let last = way.len() - 1;
        let clear = if level % 2 == 0 { 1.0 } else { z + 0.5 * step };
        add([way[last][0], way[last][1], clear], last, true);
        add([way[0][0], way[0][1], clear], 0, true);
    }
    let scene = Scene {
        path: Path::new(poses).expect("a path"),
        cutter: tool.clone(),
        body: cylinder(2.0 * wide, [4.0, 30.0]),
        rapids,
    };
    (scene, tool)
}

/// Material and the tool at dense times: how far inside of the cutter or the shank a point is, by their equations.
fn inside(kind: u8, at: (&Vector3<f64>, &Vector3<f64>), wide: f64, p: &Vector3<f64>) -> [f64; 2] {
    let off = p - at.0;
    let along = off.dot(at.1);
    let radius = (off - at.1 * along).norm();
    let corner = match kind {
        0 => 2.0,
        1 => 0.0,
        _ => 0.7,
    };
    let (right, down) = (radius - (2.0 - corner), corner - along);
    let round = corner - right.max(0.0).hypot(down.max(0.0));
    let nose = if right > 0.0 && down > 0.0 {
        round
    } else {
        f64::INFINITY
    };
    [
        nose.min(2.0 - radius).min(along).min(4.0 - along),
        (2.0 * wide - radius).min(along - 4.0).min(30.0 - along),
    ]
}

const SAMPLES: [f64; 3] = [0.4, 0.4, 0.35];
/// What is so deep in material by dense samples is deeper than is allowed.
const DEEP: f64 = 0.03;

/// The moves in which a sample of material is deep in a shank, or deep in a cutter on a rapid; and whether the program
/// brings shanks into the stock at all.
fn sampled(scene: &Scene, kind: u8, wide: f64) -> ([Vec<usize>; 2], bool) {
    let mut material: Vec<Vector3<f64>> = Vec::new();
    let counts = [60, 40, 28];
    for n in 0..counts.iter().product() {
        let at = [n % 60, n / 60 % 40, n / 2400];
        let place = |k: usize, low: f64| low + SAMPLES[k] * (at[k] as f64 + 0.5);
        material.push(Vector3::new(place(0, -12.0), place(1, -8.0), place(2, -10.0)));
    }
    let (mut touched, mut enters) = ([Vec::new(), Vec::new()], false);
    for number in 0..scene.path.moves() {
        let is_rapid = scene.rapids.contains(&number);
        for segment in scene.path.segments(number, 40.0, 1e-6) {
            for k in 0..=100 {
                let (turn, tip) = segment.at(f64::from(k) / 100.0);
                let (tip, axis) = (Vector3::from(tip), turn.column(2).into_owned());
                let mut harm = [false; 2];
                material.retain(|p| {
                    let [cut, body] = inside(kind, (&tip, &axis), wide, p);
                    harm[0] |= body > DEEP;
                    harm[1] |= is_rapid && cut > DEEP;
                    // A point is gone if some of what is around it may be.
                    is_rapid || cut < -DEEP
                });
                enters |= (tip + axis * 4.0).z < -0.5;
                for (touched, harm) in touched.iter_mut().zip(harm) {
                    if harm && touched.last() != Some(&number) {
                        touched.push(number);
                    }
                }
            }
        }
    }
    (touched, enters)
}

fn small_block() -> Stock {
    Stock::Block {
        min: [-12.0, -8.0, -10.0],
        max: [12.0, 8.0, 0.0],
    }
}

/// Whether a place is in material at a time, as far as dense samples tell: no cutter held it before, but for so much.
fn is_material(scene: &Scene, kind: u8, wide: f64, (number, time): (usize, f64), place: &Vector3<f64>) -> bool {
    let inside_block = place.z < 1e-3 && place.z > -10.001 && place.x.abs() < 12.001 && place.y.abs() < 8.001;
    inside_block
        && (0..=number).filter(|n| !scene.rapids.contains(n)).all(|n| {
            scene.path.segments(n, 40.0, 1e-6).iter().all(|segment| {
                (0..=400)
                    .map(|k| f64::from(k) / 400.0)
                    .filter(|t| n < number || *t <= time)
                    .all(|t| {
                        let (turn, tip) = segment.at(t);
                        let axis = turn.column(2).into_owned();
                        inside(kind, (&tip.into(), &axis), wide, place)[0] < 1e-3
                    })
            })
        })
}

/// Random programs; so many of the statements should be broken, and so many proven.
fn random_scenes(cases: u32, least: u32) {
    let counts = Cell::new([0_u32; 4]);
    // The same scenes in each run: how many of a few are broken, proven or open is counted.
    let mut runner = TestRunner::new(Config {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(0),
        ..Config::with_cases(cases)
    });
    let way = collection::vec([-9.0..9.0_f64, -5.0..5.0_f64], 2..4);
    let scenes = (
        0..3_u8,
        prop_oneof![Just(1.0), 0.5..1.2_f64],
        way,
        (1..4_usize, 1.0..3.5_f64),
        (-1.0..1.0_f64, -1.0..1.0_f64, prop_oneof![Just(0.0), 0.0..0.25_f64]),
    );
    let done = runner.run(&scenes, |(kind, wide, way, levels, (a, b, c))| {
        let (way, tilts): (Vec<[f64; 2]>, _) = (way, [a, b, c]);
        let (scene, _) = random_scene(kind, wide, &way, levels, tilts);
        let (sampled, enters) = sampled(&scene, kind, wide);
        let mut now = counts.get();
        for (movers, sampled) in [Movers::Bodies, Movers::Rapids].into_iter().zip(sampled) {
            let room = Room { zones: 40_000, ..ROOM };
            let found = scene.touched_in(&small_block(), movers, &room);
            let known: Vec<usize> = found.moves.iter().map(|(_, witness)| witness.number).collect();
            for number in &sampled {
                prop_assert!(
                    known.contains(number) || found.open_count > 0,
                    "{movers:?}: {number} of {sampled:?} is not in {known:?}"
                );
            }
            for (_, witness) in &found.moves {
                let place = Vector3::from(witness.place);
                prop_assert!(witness.depth > 1e-3);
                prop_assert!(
                    is_material(&scene, kind, wide, (witness.number, witness.time), &place),
                    "{movers:?}: {witness:?}"
                );
                let (turn, tip) = scene.path.segments(witness.number, 40.0, 1e-6)[0].at(witness.time);
                let axis = turn.column(2).into_owned();
                let own = inside(kind, (&tip.into(), &axis), wide, &place);
                let own = if movers == Movers::Bodies {
                    own[0].max(own[1])
                } else {
                    own[0]
                };
                prop_assert!(own > -1e-6, "{movers:?}: {witness:?} is not of the solid: {own}");
            }
            now[0] += u32::from(!sampled.is_empty());
            now[1] += u32::from(found.open_count > 0);
            now[2] += u32::from(found.open_count == 0 && found.moves.is_empty());
        }
        now[3] += u32::from(enters);
        counts.set(now);
        Ok(())
    });
    let [touched, open, free, enters] = counts.get();
    println!(
        "of {cases}: {touched} statements are broken by samples, {open} open, {free} proven; {enters} shanks enter"
    );
    done.expect("all scenes hold");
    assert!(touched >= least && free >= least && enters >= least && open <= cases / 4);
}

#[test]
fn random_programs_touch_what_samples_say() {
    random_scenes(3, 1);
}

#[test]
#[ignore = "takes minutes"]
fn two_hundred_random_programs_touch_what_samples_say() {
    random_scenes(200, 50);
}
