//! How long feed moves take on axes that accelerate: by hand, and against sampled speeds on random paths.

use std::f64::consts::{FRAC_1_SQRT_2, PI};
use std::fmt::Write;

use sweepsim_nc::{AxisLaw, CORNER_DEVIATION, Controller, Machine, Program, ReadOptions, gcode, siemens};
use sweepsim_props::*;

pub fn options(machine: &str) -> ReadOptions {
    let mut options = ReadOptions::default();
    options.machine = Machine::read(machine).unwrap();
    options
}

/// Axes with these accelerations; more fields of the machine.
pub fn mill(accelerations: [f64; 3], more: &str) -> ReadOptions {
    let [x, y, z] = accelerations;
    options(&format!(
        "Machine(name: \"mill\", linear: [(letter: 'X', acceleration: {x:?}), (letter: 'Y', acceleration: {y:?}), (letter: 'Z', acceleration: {z:?})], {more})"
    ))
}

/// The times of the feed moves in seconds.
fn feeds(program: &Program) -> Vec<f64> {
    let moves = program.poses.iter().zip(program.times());
    moves
        .filter(|(pose, _)| pose.joined && !pose.rapid)
        .map(|(_, time)| time.seconds.unwrap())
        .collect()
}

pub fn times(text: &str, options: &ReadOptions) -> Vec<f64> {
    feeds(&gcode::read(&format!("G21 G90\nG0 X0 Y0 Z0\n{text}"), options).unwrap())
}

#[track_caller]
pub fn near(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() < 1e-9, "{found:?} {expected:?}");
    }
}

#[test]
fn from_rest_to_rest() {
    let mill = mill([1000.0, 500.0, 100.0], "");
    // 100 mm/s after 0.1 s and 5 mm; the same at the end.
    near(&times("G1 X100 F6000\n", &mill), &[0.2 + 0.9]);
    // 2 mm never reach it.
    near(&times("G1 X2 F6000\n", &mill), &[2.0 * 0.002_f64.sqrt()]);
    // Y bounds a diagonal: 500 √2 mm/s² along it.
    let a = 500.0 * 2.0_f64.sqrt();
    near(
        &times("G1 X300 Y300 F6000\n", &mill),
        &[300.0 * 2.0_f64.sqrt() / 100.0 + 100.0 / a],
    );
    // By inverse time and per revolution, the speed is 10 mm/s.
    near(&times("G93 G1 Z10 F60\n", &mill), &[1.0 + 0.1]);
    near(&times("S600 M3 G95 G1 Z10 F1\n", &mill), &[1.0 + 0.1]);
    // Two collinear moves are one; what stands between decides whether the axes rest.
    let one = times("G1 X100 F6000\n", &mill);
    let two = times("G1 X37.5 F6000\n(MSG, no rest)\nX100\n", &mill);
    near(&[two.iter().sum()], &one);
    near(&two, &[0.05 + 0.375, 0.05 + 0.625]);
    for rest in ["G4 P1", "M8", "S500 M3", "M0"] {
        near(
            &times(&format!("G1 X37.5 F6000\n{rest}\nG1 X100\n"), &mill),
            &[0.1 + 0.375, 0.1 + 0.625],
        );
    }
    // A faster move takes over where the slower one ends: from 50 to 100 mm/s in 0.05 s and 3.75 mm.
    near(
        &times("G1 X10 F3000\nX100 F6000\n", &mill),
        &[0.05 + 8.75 / 50.0, 0.05 + 0.1 + (90.0 - 3.75 - 5.0) / 100.0],
    );
    // The axes rest before and after a rapid.
    near(&times("G1 X10 F6000\nG0 X20\nG1 X30\n", &mill), &[0.2, 0.2]);
}

#[test]
fn corners() {
    let even = mill([1000.0; 3], "");
    // A circle tangent to both legs, 0.01 mm from the corner: r (√2 − 1) = 0.01. Towards the inside both axes give 1000 √2 mm/s².
    let corner = |deviation: f64| (1000.0 * 2.0_f64.sqrt() * deviation / (2.0_f64.sqrt() - 1.0)).sqrt();
    // A leg from rest to 100 mm/s to the speed of the corner.
    let leg = |v: f64| {
        let ramps = 5.0 + (1e4 - v * v) / 2000.0;
        0.1 + (100.0 - v) / 1000.0 + (100.0 - ramps) / 100.0
    };
    let text = "G1 X100 F6000\nY100\n";
    near(&times(text, &even), &[leg(corner(CORNER_DEVIATION)); 2]);
    near(
        &times(text, &mill([1000.0; 3], "corner_deviation: 0.1")),
        &[leg(corner(0.1)); 2],
    );
    // Back on the same way, and exact stops: from rest to rest.
    for stop in [
        "G1 X100 F6000\nX0\n",
        "G61 G1 X100 F6000\nY100\n",
        "G61.1 G1 X100 F6000\nX200\n",
        "G9 G1 X100 F6000\nY100\n",
    ] {
        near(&times(stop, &even), &[1.1; 2]);
    }
    near(
        &times("G61\nG64 G1 X100 F6000\nY100\n", &even),
        &[leg(corner(CORNER_DEVIATION)); 2],
    );
    near(
        &times("G1 X100 F6000\nG9 Y100\nY200\n", &even)[1..],
        &[leg(corner(CORNER_DEVIATION)), 1.1],
    );
    // Grbl knows G61 as its only mode.
    let mut grbl = even.clone();
    grbl.controller = Some(Controller::Grbl);
    near(
        &times("G61 G1 X100 F6000\nY100\n", &grbl),
        &[leg(corner(CORNER_DEVIATION)); 2],
    );
    // Siemens: G60 stays, G9 does not.
    let siemens = |text: &str| feeds(&siemens::read(&format!("G71 G90\nG0 X0 Y0 Z0\n{text}"), &even).unwrap());
    near(
        &siemens("G60 G1 X100 F6000\nX200\nG64 X300\nX400\n"),
        &[1.1, 1.1, 0.15 + 0.95 - 0.05, 1.05],
    );
    near(&siemens("G9 G1 X100 F6000\nX200\nX300\n"), &[1.1, 1.05, 1.05]);
    assert!(Machine::read("Machine(name: \"\", corner_deviation: 0)").is_err());
    assert!(Machine::read("Machine(name: \"\", corner_deviation: -1)").is_err());
}

/// Half a circle of radius 20 by chords, or as an arc: the axes hold √(a r) after the ramps.
#[test]
fn chords_of_an_arc_take_as_long_as_the_arc() {
    let (a, r) = (800.0, 20.0);
    let mut options = mill([a; 3], "");
    let whole = |feed: f64, a: f64| {
        let v = (feed / 60.0).min(f64::sqrt(a * r));
        PI * r / v + v / a
    };
    for feed in [3000.0, 20_000.0] {
        options.exact_arcs = true;
        let text = format!("G1 F{feed}\nG3 X0 Y40 I0 J20\n");
        near(&times(&text, &options), &[whole(feed, a)]);
        // Tangent lines change nothing but add their own ways.
        let longer = times(&format!("G1 X50 F{feed}\nG3 X50 Y40 I0 J20\nG1 X0\n"), &options);
        assert!(longer[1] < whole(feed, a));
        // In another plane, rising, and about a table that is turned.
        near(
            &times(&format!("G19 G1 F{feed}\nG2 Y0 Z40 J0 K20\n"), &options),
            &[whole(feed, a)],
        );
        options.exact_arcs = false;
        let chords = times(&text, &options);
        assert!(chords.len() > 50);
        let sum: f64 = chords.iter().sum();
        // The arc counts the slowest of its directions; on the diagonals both axes give √2 times as much.
        let least = whole(feed, a * 2.0_f64.sqrt());
        assert!(
            sum > 0.999 * least && sum < 1.001 * whole(feed, a),
            "{least} {sum} {}",
            whole(feed, a)
        );
        // The middle of the arc has no ramps: at constant speed within what the chords' directions change.
        let middle = chords[chords.len() / 2];
        let fair = PI * r / chords.len() as f64 / (feed / 60.0).min(f64::sqrt(a * r));
        assert!(middle > 0.8 * fair && middle < 1.05 * fair, "{middle} {fair}");
    }
}

#[test]
fn arcs_on_turned_tables() {
    let machine = "Machine(name: \"t\", table: [(letter: 'C', axis: (0, 0, 1), acceleration: 50)],
        linear: [(letter: 'X', acceleration: 1000), (letter: 'Y', acceleration: 1000), (letter: 'Z', acceleration: 10)])";
    let mut options = options(machine);
    options.exact_arcs = true;
    // C stands, at 30 degrees: Z takes no part.
    let (v, a) = (100.0, 1000.0);
    let expected = PI * 20.0 / v + v / a;
    let text = "G21 G90\nG0 X0 Y0 Z0 C30\nG1 F6000\nG3 X0 Y40 I0 J20\n";
    near(&feeds(&gcode::read(text, &options).unwrap()), &[expected]);
    // A helix: Z's share is 1/√2.
    let rise = 20.0 * PI;
    let text = format!("G21 G90\nG0 X0 Y0 Z0 C0\nG1 F600\nG3 X0 Y40 Z{rise:?} I0 J20\n");
    let a = 10.0 / FRAC_1_SQRT_2;
    near(
        &feeds(&gcode::read(&text, &options).unwrap()),
        &[rise * 2.0_f64.sqrt() / 10.0 + 10.0 / a],
    );
    // The table alone turns, by chords: 10 degrees/s after 0.2 s.
    let text = "G21 G90\nG0 X10 Y0 Z0 C0\nG1 C90 F600\n";
    let chords = feeds(&gcode::read(text, &options).unwrap());
    let sum: f64 = chords.iter().sum();
    assert!(chords.len() > 10 && (sum - 9.2).abs() < 2e-3, "{sum}");
    // An arc while the table turns is from rest to rest, bounded by the slowest linear axis and by the table.
    options.law = AxisLaw::Rotary;
    let text = "G21 G90 M428\nG0 X0 Y0 Z0 C0\nG1 F600\nG3 X0 Y40 I0 J20 C2\nG1 X-100\n";
    // The line is turned with the table, so that X alone goes a little less than all of it.
    let (way, turned) = (20.0 * PI, 2.0_f64.to_radians().cos());
    near(
        &feeds(&gcode::read(text, &options).unwrap()),
        &[way / 10.0 + 10.0 / 10.0, 100.0 / 10.0 + 10.0 / 1000.0 * turned],
    );
}

/// Times by hand are in `usage` as well, and only where the machine has accelerations.
#[test]
fn usage_counts_accelerations() {
    let program = |options: &ReadOptions| gcode::read("G21\nT1 M6\nG0 X0 Y0 Z0\nG1 X100 F6000\n", options).unwrap();
    assert_eq!(program(&ReadOptions::default()).usage()[0].seconds, 1.0);
    assert_eq!(program(&options("Machine(name: \"plain\")")).usage()[0].seconds, 1.0);
    near(&[program(&mill([1000.0; 3], "")).usage()[0].seconds], &[1.1]);
}

/// It left out turns in place and the largest speeds of axes, where no axis accelerates.
#[test]
fn usage_takes_as_long_as_the_moves() {
    let text = "G21\nT1 M6\nM428\nG0 X0 Y0 Z0 C0 A0\nG1 A30 F360\nG1 X100 F6000\n";
    let usage = |options: &ReadOptions| gcode::read(text, options).unwrap().usage()[0].seconds;
    near(&[usage(&ReadOptions::default())], &[5.0 + 1.0]);
    let slow = options(
        "Machine(name: \"slow\", table: [(letter: 'A', axis: (1, 0, 0))], linear: [(letter: 'X', speed: 600)])",
    );
    near(&[usage(&slow)], &[5.0 + 10.0]);
}

/// A path of straight moves: the ends, and the speed on each in mm/s.
#[derive(Clone, Debug)]
struct Chain {
    points: Vec<[f64; 3]>,
    speeds: Vec<f64>,
    accelerations: [f64; 3],
    deviation: f64,
}

impl Chain {
    fn times(&self, scale: f64) -> Vec<f64> {
        let mut text = String::new();
        for (point, speed) in self.points[1..].iter().zip(&self.speeds) {
            writeln!(
                text,
                "G1 X{:.6} Y{:.6} Z{:.6} F{:.6}",
                point[0],
                point[1],
                point[2],
                60.0 * speed
            )
            .unwrap();
        }
        let more = format!("corner_deviation: {:?}", self.deviation);
        times(&text, &mill(self.accelerations.map(|a| a * scale), &more))
    }

    fn tangents(&self) -> Vec<([f64; 3], f64)> {
        let pairs = self.points.windows(2);
        pairs
            .map(|pair| {
                let way: [f64; 3] = std::array::from_fn(|k| pair[1][k] - pair[0][k]);
                let length = dot(way, way).sqrt();
                (way.map(|c| c / length), length)
            })
            .collect()
    }

    /// The largest `a` with `a |direction[k]|` within what each axis can do.
    fn most(&self, direction: [f64; 3]) -> f64 {
        (0..3)
            .map(|k| self.accelerations[k] / direction[k].abs())
            .fold(f64::INFINITY, f64::min)
    }

    /// The largest speed at a corner, by halving the range of the radius of a circle in it.
    fn corner(&self, [(last, before), (first, after)]: [([f64; 3], f64); 2]) -> f64 {
        // The angle between the legs.
        let half = 0.5 * (PI - dot(last, first).clamp(-1.0, 1.0).acos());
        let fits = |r: f64| r / half.sin() - r <= self.deviation && r / half.tan() <= 0.5 * before.min(after);
        let (mut low, mut high) = (0.0, 1e9);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            *(if fits(middle) { &mut low } else { &mut high }) = middle;
        }
        let inside: [f64; 3] = std::array::from_fn(|k| first[k] - last[k]);
        let size = dot(inside, inside).sqrt();
        (low * self.most(inside.map(|c| c / size))).sqrt()
    }

    /// How long each move takes, by the speeds at many places: lowered until none can be, in sweeps from both ends, and never faster than allowed.
    fn sampled(&self) -> Vec<f64> {
        const CELLS: usize = 4000;
        let tangents = self.tangents();
        let mut speeds = vec![0.0];
        for (k, speed) in self.speeds.iter().enumerate() {
            speeds.extend(std::iter::repeat_n(*speed, CELLS));
            *speeds.last_mut().unwrap() = match tangents.get(k + 1) {
                Some(next) => speed.min(self.speeds[k + 1]).min(self.corner([tangents[k], *next])),
                None => 0.0,
            };
        }
        let cell = |i: usize| {
            let (tangent, length) = tangents[i / CELLS];
            // Ever smaller ones towards the ends of a move, where ramps may be short.
            let place = |at: usize| match at as f64 / CELLS as f64 {
                t if t <= 0.5 => 8.0 * t.powi(4),
                t => 1.0 - 8.0 * (1.0 - t).powi(4),
            };
            (self.most(tangent), length * (place(i % CELLS + 1) - place(i % CELLS)))
        };
        let cells: Vec<_> = (0..speeds.len() - 1).map(cell).collect();
        loop {
            let before = speeds.clone();
            for i in (0..cells.len()).chain((0..cells.len()).rev()) {
                let (a, ds) = cells[i];
                // In a cell the speed changes by no more than a dt with dt = 2 ds / (v + w).
                let reach = |v: f64| (v * v + 2.0 * a * ds).sqrt();
                (speeds[i], speeds[i + 1]) = (speeds[i].min(reach(speeds[i + 1])), speeds[i + 1].min(reach(speeds[i])));
            }
            if speeds == before {
                break;
            }
        }
        let time = |i: usize| 2.0 * cells[i].1 / (speeds[i] + speeds[i + 1]);
        (0..tangents.len())
            .map(|k| (k * CELLS..(k + 1) * CELLS).map(time).sum())
            .collect()
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Steps of all sizes, straight on every now and then.
fn chain() -> impl Strategy<Value = Chain> {
    let direction = [-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64];
    let step = (direction, -2.0..2.0_f64, 0..4_u8, 0.0..2.5_f64);
    let accelerations = [1.0..3.5_f64, 1.0..3.5_f64, 1.0..3.5_f64];
    (collection::vec(step, 1..8), accelerations, -3.0..0.0_f64).prop_map(|(steps, accelerations, deviation)| {
        let (mut points, mut speeds, mut last) = (vec![[0.0; 3]], Vec::new(), [1.0, 0.0, 0.0]);
        for (direction, size, turn, speed) in steps {
            // Straight on, a small turn, or any.
            last = match turn {
                0 => last,
                1 => std::array::from_fn(|k| last[k] + 0.1 * direction[k]),
                _ => direction,
            };
            let length = 10.0_f64.powf(size) / dot(last, last).sqrt().max(0.1);
            let here: [f64; 3] = points[points.len() - 1];
            // As written: what the reader sees.
            points.push(std::array::from_fn(|k| {
                ((here[k] + length * last[k]) * 1e6).round() / 1e6
            }));
            speeds.push((10.0_f64.powf(speed) * 6e7).round() / 6e7);
        }
        Chain {
            points,
            speeds,
            accelerations: accelerations.map(|a| 10.0_f64.powf(a)),
            deviation: 10.0_f64.powf(deviation),
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    #[test]
    fn times_are_those_of_sampled_speeds(chain in chain()) {
        let moving = chain.points.windows(2).all(|pair| pair[0] != pair[1]);
        prop_assume!(moving);
        let (found, sampled) = (chain.times(1.0), chain.sampled());
        prop_assert_eq!(found.len(), sampled.len());
        for (a, b) in found.iter().zip(&sampled) {
            prop_assert!((a - b).abs() <= 1e-3 * b, "{found:?} {sampled:?}");
        }
        let sums: [f64; 2] = [found.iter().sum(), sampled.iter().sum()];
        prop_assert!((sums[0] - sums[1]).abs() <= 1e-4 * sums[1], "{sums:?}");
    }

    /// Never faster than the feeds, slower with less acceleration, and as fast as the feeds with much of it.
    #[test]
    fn times_tend_to_those_of_the_feeds(chain in chain()) {
        prop_assume!(chain.points.windows(2).all(|pair| pair[0] != pair[1]));
        let full: Vec<f64> = chain.tangents().iter().zip(&chain.speeds).map(|((_, length), speed)| length / speed).collect();
        let mut last = vec![f64::INFINITY; full.len()];
        for scale in [1e-2, 1.0, 1e2, 1e12] {
            let times = chain.times(scale);
            for ((time, full), last) in times.iter().zip(&full).zip(&last) {
                prop_assert!(*time >= full * (1.0 - 1e-9), "{times:?}");
                prop_assert!(*time <= last * (1.0 + 1e-9), "{times:?}");
            }
            last = times;
        }
        for (time, full) in last.iter().zip(&full) {
            prop_assert!((time - full).abs() < 1e-4 * full, "{time} {full}");
        }
    }
}
