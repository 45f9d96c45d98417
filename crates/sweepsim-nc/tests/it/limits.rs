//! Limits of axes inside of moves, and rapids of axes that need not arrive together, against dense sampling by the forward chain.

use nalgebra::{Matrix3, Vector3};
use sweepsim_motion::TipCourse;
use sweepsim_nc::{AxisFault, Kinematics, Machine, Position, Program, Rapid, ReadOptions, check, gcode};
use sweepsim_props::*;

/// X, Y, Z at which the tip is at a point, at given angles: the forward chain is affine in them.
fn solve(machine: &Kinematics, tip: Vector3<f64>, abc: [f64; 3], length: f64) -> [f64; 3] {
    let at = |xyz: [f64; 3]| {
        let tip: [f64; 3] = machine.pose(&Position::new(xyz, abc), length).unwrap().tip();
        Vector3::from(tip)
    };
    let zero = at([0.0; 3]);
    let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|unit| at(unit) - zero);
    let inverse = Matrix3::from_columns(&columns).try_inverse().unwrap();
    (inverse * (tip - zero)).into()
}

/// The position on the way to a pose at `s`.
fn between(program: &Program, machine: &Kinematics, pose: usize, s: f64) -> Position {
    let (before, end) = (&program.poses[pose - 1], &program.poses[pose]);
    let (from, to) = (&program.positions[pose - 1], &program.positions[pose]);
    if !end.tip_control && !matches!(end.way().course, TipCourse::Arc(_)) {
        return from.towards(to, s);
    }
    let (a, b): ([f64; 3], [f64; 3]) = (before.pose.tip(), end.pose.tip());
    let (a, b) = (Vector3::from(a), Vector3::from(b));
    let tip = match end.way().course {
        TipCourse::Arc(arc) => {
            let (c, n) = (Vector3::from(arc.centre()), Vector3::from(arc.normal()));
            let out = a - c;
            let along = n * n.dot(&out);
            let turned = nalgebra::Rotation3::from_axis_angle(&nalgebra::Unit::new_normalize(n), s * arc.angle())
                * (out - along);
            c + along + turned + n * (s * n.dot(&(b - a)))
        }
        _ => a + (b - a) * s,
    };
    let abc = from.towards(to, s).abc;
    Position::new(solve(machine, tip, abc, machine.tool_length(end.tool)), abc)
}

/// A machine with limits at `share` of the range that its axes take along the program, so that some are left.
fn limited(base: &Machine, program: &Program, shares: [f64; 2]) -> Machine {
    let kinematics = base.kinematics.as_ref().unwrap();
    let mut description = kinematics.description().clone();
    let mut ranges = [[f64::MAX, f64::MIN]; 3];
    for pose in 1..program.poses.len() {
        for k in 0..=50 {
            let at = between(program, kinematics, pose, f64::from(k) / 50.0);
            for (range, value) in ranges.iter_mut().zip(at.xyz) {
                *range = [range[0].min(value), range[1].max(value)];
            }
        }
    }
    // Machine coordinates are those of the program, with the nose a tool length above.
    let zero = Vector3::from(description.part_zero) + Vector3::z() * kinematics.tool_length(program.poses[0].tool);
    description.linear = ['X', 'Y', 'Z']
        .into_iter()
        .enumerate()
        .map(|(k, letter)| {
            let [low, high] = ranges[k].map(|value| value + zero[k]);
            let mut axis = sweepsim_nc::LinearAxis::new(letter);
            let (low, high) = (low, high.max(low + 0.01));
            let width = high - low;
            axis.limits = Some([low + shares[0] * width - 1e-4, high - shares[1] * width + 1e-4]);
            axis
        })
        .collect();
    Machine::new(description).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    #[test]
    fn limits_are_watched_along_moves(
        name in prop::sample::select(vec!["trunnion-ac", "trunnion-bc", "head-bc", "head-ac", "head-b-table-c", "nutating-head-bc", "nutating-table-bc"]),
        points in collection::vec((prop::array::uniform3(-40.0..40.0_f64), -50.0..50.0_f64, -170.0..170.0_f64), 2..4),
        arc in (-30.0..30.0_f64, 5.0..30.0_f64, any::<bool>(), 0.0..3.0_f64),
        shares in prop::array::uniform2(prop_oneof![Just(-0.01), 0.0..0.2_f64]),
        tip_control in any::<bool>(),
    ) {
        let base = Machine::named(name).unwrap();
        let tilting = if name.contains("-ac") { 'A' } else { 'B' };
        let mut text = String::from(if tip_control { "M428\n" } else { "G17\n" });
        for (index, (p, tilt, turn)) in points.iter().enumerate() {
            let code = if index == 0 { "G0" } else { "G1 F100" };
            text += &format!("{code} X{:.6} Y{:.6} Z{:.6} {tilting}{tilt:.6} C{turn:.6}\n", p[0], p[1], p[2]);
        }
        let (tilt, radius, clockwise, turns) = arc;
        text += &format!("G1 {tilting}{tilt:.6}\nG91\nG{} X0 Y0 Z{turns:.6} I{radius:.6} P{}\n", if clockwise { 2 } else { 3 }, 1 + turns as u32);
        let mut options = ReadOptions::default();
        options.exact_arcs = true;
        options.arc_tolerance = 0.05;
        options.machine = base.clone();
        let program = gcode::read(&text, &options).unwrap();
        let machine = limited(&base, &program, shares);
        let kinematics = machine.kinematics.as_ref().unwrap();
        let findings = check(&program, kinematics);
        let length = kinematics.tool_length(program.poses[0].tool);
        let zero = kinematics.description().part_zero[2] + length;
        for pose in 1..program.poses.len() {
            for (k, axis) in kinematics.linear().iter().enumerate() {
                let [low, high] = axis.limits.unwrap();
                let value = |s: f64| between(&program, kinematics, pose, s).xyz[k] + if k == 2 { zero } else { kinematics.description().part_zero[k] };
                let samples: Vec<f64> = (0..=400).map(|i| value(f64::from(i) / 400.0)).collect();
                // A move that begins outside counts where it goes farther on that side.
                let beyond = |v: f64| {
                    let start = samples[0];
                    (v - high.max(start)).max(low.min(start) - v)
                };
                let worst = samples.iter().copied().map(beyond).fold(f64::MIN, f64::max);
                let found = findings.iter().find(|finding| {
                    finding.pose == pose && matches!(finding.fault, AxisFault::Limit { letter, .. } if letter == axis.letter)
                });
                match found {
                    None => prop_assert!(worst <= 1e-5, "pose {pose}, {}: {worst} beyond\n{text}", axis.letter),
                    Some(finding) => {
                        let AxisFault::Limit { value: farthest, .. } = finding.fault else { unreachable!() };
                        prop_assert!(beyond(farthest) > 0.0, "{finding}\n{text}");
                        // Samples may miss the peak, by as much as the course bends between them.
                        let outside = (farthest - high).max(low - farthest);
                        prop_assert!(worst > -1e-2 && outside > worst - 1e-2, "{finding}: {worst}\n{text}");
                        prop_assert!(beyond(value(finding.time)) < 1e-3, "{finding}\n{text}");
                        let earlier = (0..400).map(|i| f64::from(i) / 400.0).take_while(|s| *s < finding.time);
                        for s in earlier {
                            prop_assert!(beyond(value(s)) <= 1e-6, "{finding} at {}, but also at {s}\n{text}", finding.time);
                        }
                    }
                }
            }
        }
    }

    /// Each axis of a dog-leg goes at its own speed until it has arrived.
    #[test]
    fn rapids_of_independent_axes(
        from in prop::array::uniform3(-100.0..100.0_f64),
        to in prop::array::uniform3(-100.0..100.0_f64),
        turns in prop::array::uniform2((-90.0..90.0_f64, -90.0..90.0_f64)),
        speeds in prop::array::uniform3(prop::option::of(1000.0..30000.0_f64)),
        turning in prop::array::uniform2(1000.0..20000.0_f64),
    ) {
        let mut description = Machine::named("trunnion-bc").unwrap().kinematics.unwrap().description().clone();
        description.rapid = Rapid::DogLeg;
        description.linear = ['X', 'Y', 'Z'].into_iter().zip(speeds).map(|(letter, speed)| {
            let mut axis = sweepsim_nc::LinearAxis::new(letter);
            axis.speed = speed;
            axis
        }).collect();
        for (axis, speed) in description.table.iter_mut().zip(turning) {
            axis.speed = Some(speed);
        }
        let letters: Vec<char> = description.table.iter().map(|axis| axis.letter).collect();
        let machine = Machine::new(description).unwrap();
        let kinematics = machine.kinematics.as_ref().unwrap();
        let (from, to) = (
            Position::new(from, [0.0, turns[0].0, turns[1].0]),
            Position::new(to, [0.0, turns[0].1, turns[1].1]),
        );
        let points = kinematics.rapid_path(&from, &to);
        prop_assert!(points[0].position == from && points[0].time == 0.0);
        let end = points.last().unwrap();
        prop_assert!(end.position == to && end.time == 1.0);
        // The speeds that each axis is said to have: minutes of each, and of all.
        let slowest = speeds.iter().flatten().copied().fold(f64::INFINITY, f64::min);
        let slowest = if slowest.is_finite() { slowest } else { 1.0 };
        let flat = |at: &Position| [at.xyz[0], at.xyz[1], at.xyz[2], at.abc[1], at.abc[2]];
        let rotary = |letter: char| turning[letters.iter().position(|own| *own == letter).unwrap()];
        let rates = [speeds[0].unwrap_or(slowest), speeds[1].unwrap_or(slowest), speeds[2].unwrap_or(slowest), rotary('B'), rotary('C')];
        let (a, b) = (flat(&from), flat(&to));
        let needed: Vec<f64> = (0..5).map(|k| (b[k] - a[k]).abs() / rates[k]).collect();
        let total = needed.iter().copied().fold(0.0, f64::max);
        for i in 0..=100 {
            let time = f64::from(i) / 100.0;
            let leg = points.windows(2).find(|pair| time <= pair[1].time).unwrap();
            let s = (time - leg[0].time) / (leg[1].time - leg[0].time);
            let at = flat(&leg[0].position.towards(&leg[1].position, s));
            for k in 0..5 {
                let way = (rates[k] * time * total).min((b[k] - a[k]).abs());
                let expected = a[k] + way * (b[k] - a[k]).signum();
                prop_assert!((at[k] - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{k} at {time}: {} but {expected}", at[k]);
            }
        }
    }
}

#[test]
fn dog_legs_of_a_program() {
    let text = r#"Machine(name: "mill", rapid: DogLeg, linear: [(letter: 'X', speed: 10000), (letter: 'Y', speed: 10000), (letter: 'Z', speed: 5000)],
        table: [(letter: 'C', axis: (0, 0, 1), speed: 3600)])"#;
    let mut options = ReadOptions::default();
    options.machine = Machine::read(text).unwrap();
    let program = gcode::read(
        "G0 X0 Y0 Z0\nX40 Y10 Z-5\nG1 X50 Y0 F100\nG0 Y9\nG0 X50 Y9 C90\n",
        &options,
    )
    .unwrap();
    let legs = program.dog_leg(1, 1e-3).unwrap();
    // Y and Z take 60 ms each, X 240 ms.
    let corners: Vec<(f64, [f64; 3])> = legs.iter().map(|(time, pose)| (*time, pose.tip())).collect();
    assert_eq!(
        corners,
        [(0.0, [0.0; 3]), (0.25, [10.0, 10.0, -5.0]), (1.0, [40.0, 10.0, -5.0])]
    );
    // Where axes turn without tip control, the poses are those of the dog-leg: C arrives after 1.5 s, X after 300 ms.
    let turned = gcode::read("G0 X0 Y0 Z0\nX50 C90\n", &options).unwrap();
    let at: Vec<[f64; 2]> = turned.positions.iter().map(|at| [at.xyz[0], at.abc[2]]).collect();
    assert!(
        at.len() > 10 && at.contains(&[50.0, 18.0]) && at.ends_with(&[[50.0, 90.0]]),
        "{at:?}"
    );
    assert!(
        at.iter().all(|[x, c]| (x - (c / 18.0 * 50.0).min(50.0)).abs() < 1e-9),
        "{at:?}"
    );
    // Feed moves, moves of one axis, and machines whose rapids are straight.
    assert!(
        program.dog_leg(2, 1e-3).is_none() && program.dog_leg(3, 1e-3).is_none() && program.dog_leg(0, 1e-3).is_none()
    );
    assert!(program.dog_leg(99, 1e-3).is_none());
    options.machine = Machine::named("rotary-a").unwrap();
    let straight = gcode::read("G0 X0 Y0 Z0\nX40 Y10\n", &options).unwrap();
    assert!(straight.dog_leg(1, 1e-3).is_none());
}

#[test]
fn an_arc_bulges_beyond_its_ends() {
    let text =
        "Machine(name: \"mill\", linear: [(letter: 'X', limits: (-100, 9)), (letter: 'Y', limits: (-100, 100))])";
    let machine = Machine::read(text).unwrap();
    let mut options = ReadOptions::default();
    options.exact_arcs = true;
    options.machine = machine.clone();
    // Both ends are at x = 0; the arc reaches x = 10 in its middle, and x = 9 when its angle from -90° is asin 0.9.
    let program = gcode::read("G0 X0 Y-10 Z0\nG3 X0 Y10 I0 J10 F100\n", &options).unwrap();
    let findings = check(&program, machine.kinematics.as_ref().unwrap());
    assert_eq!(findings.len(), 1);
    assert!(
        matches!(findings[0].fault, AxisFault::Limit { letter: 'X', value, limits: [_, 9.0] } if (value - 10.0).abs() < 1e-12)
    );
    assert!(
        (findings[0].time - 0.9_f64.asin() / std::f64::consts::PI).abs() < 1e-6,
        "{}",
        findings[0].time
    );
    assert_eq!(
        findings[0].to_string(),
        "line 2: X is 10, outside of its limits -100 to 9"
    );
}

/// A feed in inches is 25.4 times as fast, along a way; turns in place are in degrees.
#[test]
fn axes_are_as_slow_for_feeds_in_inches() {
    let text = "Machine(name: \"mill\", table: [(letter: 'C', axis: (0, 0, 1), speed: 900)], linear: [(letter: 'X', speed: 1000)])";
    let machine = Machine::read(text).unwrap();
    let mut options = ReadOptions::default();
    options.machine = machine.clone();
    let slow = |text: &str| -> Vec<(char, f64)> {
        let program = gcode::read(text, &options).unwrap();
        let findings = check(&program, machine.kinematics.as_ref().unwrap());
        let speeds = findings.iter().filter_map(|finding| match finding.fault {
            AxisFault::Speed { letter, needed, .. } => Some((letter, needed)),
            _ => None,
        });
        speeds.collect()
    };
    assert_eq!(slow("G21 G0 X0 Y0 Z0 C0\nG1 X25.4 F1270\n"), [('X', 1270.0)]);
    let [('X', needed)] = slow("G20 G0 X0 Y0 Z0 C0\nG1 X1 F50\n")[..] else {
        panic!("the axis would not be too slow")
    };
    assert!((needed - 1270.0).abs() < 1e-9, "{needed}");
    assert!(slow("G20 G0 X0 Y0 Z0 C0\nG1 X1 F39\n").is_empty());
}
