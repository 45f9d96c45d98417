//! Moves along the tool's own axis: all of its wall slides along itself.

use crate::translations::{TOLERANCE, UP, cases, path, tools};
use proptest::prelude::*;
use sweepsim::nalgebra::Vector3;
use sweepsim::{Method, Options, sweep};
use sweepsim_dexel::Grid;
use sweepsim_motion::{Apt, Tool};

const METHODS: [Method; 5] = [
    Method::General,
    Method::Charts,
    Method::Planes,
    Method::Lines,
    Method::Surface,
];

/// The direction in which tips are displaced, where the tool's axis isn't almost across it.
const DISPLACED: [f64; 3] = [0.569_840_290_998, 0.331_172_830_617, 0.752_022_194_331];

/// A move along the tool's own axis meets hardly any line: none that it passes by is left open.
#[test]
fn retracts_open_no_line_beside_the_tool() {
    let grid = Grid::new([-6.546, -6.546], [97.143, 94.023], [300, 300]).expect("a grid");
    let tool = Tool::ball(3.0, 37.5).expect("a ball end");
    for k in 0..60 {
        let [x, y] = [15.5 + f64::from(k % 8) / 3.0, 1.5 + 2.0 * f64::from(k) / 3.0];
        let moves = path(&[[x, y, -19.506], [x, y, 1.0]], UP);
        let done = sweep(&tool, &moves, &grid, &Options::new(TOLERANCE), &()).expect("a sweep");
        assert!(
            done.statistics.unresolved.is_empty() && done.statistics.repaired == 0,
            "{k}"
        );
    }
}

/// Along a tilted axis the wall slides along itself, and the displacement of tips alone decides where `g` vanishes on it: at a ruling, all of which passes beside the lines next to it at
/// all times. They cost no more than others.
#[test]
fn lines_beside_a_ruling_that_slides_along_itself() {
    let axis = [0.3, 0.2, 1.0];
    let tip = [15.5, 37.0 / 3.0 - 1.0 / 6.0, -19.506];
    let way = 19.0 / Vector3::from(axis).norm();
    let moves = path(&[tip, [0, 1, 2].map(|k| tip[k] + way * axis[k])], axis);
    // A line within 1e-5 of the ruling, and the direction across it.
    let (near, across) = ([18.512_175, 17.758_175], [-0.5547, 0.832_05]);
    let drill = Apt {
        d: 6.0,
        r: 0.0,
        e: 3.0,
        f: 0.0,
        a: 31.0,
        b: 0.0,
        h: 10.0,
    };
    let tools = [
        Tool::ball(3.0, 10.0).expect("a ball end"),
        Tool::bull(3.0, 0.8, 10.0).expect("a bull nose"),
        Tool::apt(&drill).expect("a drill").0,
    ];
    for tool in &tools {
        for method in &METHODS[..4] {
            let boxes = |off: f64| {
                let [x, y] = [0, 1].map(|k| near[k] + off * across[k]);
                let grid = Grid::new([x - 0.1, y - 0.1], [x + 0.1, y + 0.1], [1, 1]).expect("a grid");
                let options = Options::new(TOLERANCE).method(*method);
                let done = sweep(tool, &moves, &grid, &options, &()).expect("a sweep");
                assert!(done.statistics.unresolved.is_empty(), "{method}, {off}");
                done.statistics.boxes
            };
            let beside = boxes(0.11).max(boxes(-0.11)).max(40);
            for off in [1e-2, 1e-3, 3e-4, 1e-4, 5e-5, 2e-5] {
                for off in [off, -off] {
                    let own = boxes(off);
                    assert!(own <= 3 * beside, "{method}, {off}: {own} {beside}");
                }
            }
        }
    }
}

/// How a line passes by a ruling.
#[derive(Clone, Debug)]
struct Beside {
    /// How far up the wall and the way, as a fraction of both.
    height: f64,
    /// The distance from the ruling, in parts of a unit.
    off: f64,
    /// Which of the two rulings.
    side: f64,
}

fn beside() -> impl Strategy<Value = Beside> {
    let off = (prop_oneof![-13.0..-2.0, -7.0..-4.0], any::<bool>()).prop_map(|(power, left): (f64, bool)| {
        if left {
            -(10.0_f64.powf(power))
        } else {
            10.0_f64.powf(power)
        }
    });
    let side = any::<bool>().prop_map(|left| if left { -1.0 } else { 1.0 });
    (-0.2..1.2, off, side).prop_map(|(height, off, side)| Beside { height, off, side })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    /// Lines within roundings of the ruling on which the displacement of tips lets `g` vanish: each is settled, by all methods, and ends where the tool has been.
    #[test]
    fn lines_on_a_ruling_that_slides_along_itself(
        number in 0..13_usize,
        tilt in ([-1.0..1.0, -1.0..1.0], prop_oneof![Just(0.01), Just(0.3), 0.0..1.0_f64]),
        place in [-20.0..20.0, -20.0..20.0, -20.0..5.0],
        way in 13.0..40.0_f64,
        lines in prop::collection::vec(beside(), 6),
        radius in prop_oneof![Just(3.0), Just(2.5), 2.0..3.1],
        power in -8.0..-4.0_f64,
        down in any::<bool>(),
    ) {
        let (name, tool, _) = &tools()[number];
        let ([x, y], z) = tilt;
        let axis = Vector3::new(x, y, z);
        prop_assume!(axis.norm() > 0.1 && axis.xy().norm() > 0.01);
        let axis: Vector3<f64> = axis.normalize();
        let tip = Vector3::from(place);
        let tips = [tip, tip + axis * way].map(<[f64; 3]>::from);
        let moves = path(&if down { [tips[1], tips[0]] } else { tips }, axis.into());
        let tolerance = 10.0_f64.powf(power);
        let out = axis.cross(&Vector3::from(DISPLACED)).normalize();
        let across = Vector3::new(-axis.y, axis.x, 0.0).normalize();
        // Exact where the profile is known here, otherwise to within 1e-4 of the radius.
        let corner = [("ball", 3.0), ("flat", 0.0), ("bull", 0.8)].iter().find(|(round, _)| round == name).map(|(_, corner)| *corner);
        let width = |along: f64| match corner {
            Some(corner) if along >= corner => 3.0,
            Some(corner) => 3.0 - corner + (corner * corner - (corner - along).powi(2)).sqrt(),
            None => tool.radius_below(along),
        };
        let margin = if corner.is_some() { 0.5 * tolerance } else { 1e-3 };
        for Beside { height, off, side } in lines {
            let at = tip + out * (side * radius) + axis * (height * way) + across * off;
            let grid = Grid::new([at.x - 0.1, at.y - 0.1], [at.x + 0.1, at.y + 0.1], [1, 1]).expect("a grid");
            for method in METHODS {
                let done = sweep(tool, &moves, &grid, &Options::new(tolerance).method(method), &()).expect("a sweep");
                prop_assert!(done.statistics.unresolved.is_empty(), "{name}, {method}: {:?}", done.statistics.unresolved);
                if *name == "hollow" {
                    continue;
                }
                // What is cut has been below a part of the tool that is at least as wide, as long as the top doesn't come into it.
                let cut = |p: Vector3<f64>| {
                    let along = (p - tip).dot(&axis);
                    (0.0..way).contains(&along) && (p - tip - along * axis).norm() <= width(along)
                };
                let [x, y] = [at.x, at.y];
                let line = done.volume.at(0).to_vec();
                let on = |z: f64| Vector3::new(x, y, z);
                for end in line.iter().flat_map(|interval| [interval.lower.z, interval.upper.z]) {
                    let along = (on(end) - tip).dot(&axis);
                    if along > way - 1.0 {
                        continue;
                    }
                    let near = [Vector3::x(), Vector3::y(), Vector3::z(), axis, out, across].map(|way: Vector3<f64>| way * margin);
                    let seen = near.map(|by| [cut(on(end) + by), cut(on(end) - by)]).concat();
                    prop_assert!(seen.contains(&true) && seen.contains(&false), "{name}, {method}: {end}");
                }
                for k in 0..400 {
                    let z = tip.z - 5.0 + (way + 10.0) * f64::from(k) / 400.0;
                    let along = (on(z) - tip).dot(&axis);
                    let is_near = line.iter().any(|i| (i.lower.z - z).abs().min((i.upper.z - z).abs()) < 1e-3);
                    if along > way - 1.0 || is_near {
                        continue;
                    }
                    let inside = line.iter().any(|i| (i.lower.z..i.upper.z).contains(&z));
                    prop_assert_eq!(inside, cut(on(z)), "{}, {}: {}", name, method, z);
                }
            }
        }
    }
}
