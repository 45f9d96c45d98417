//! Machines: positions of their axes and poses of the tool, both ways, against formulas and matrices written down independently.

use nalgebra::{Isometry3, Translation3, Unit, UnitQuaternion, Vector3};
use sweepsim_motion::Pose;
use sweepsim_nc::{
    Kinematics, LinearAxis, Machine, MachineDescription, MachineError, Position, ReachError, RotaryAxis,
};
use sweepsim_props::*;

fn kinematics(name: &str) -> Kinematics {
    Machine::named(name).unwrap().kinematics.unwrap().as_ref().clone()
}

fn about(axis: [f64; 3], degrees: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&Unit::new_normalize(axis.into()), degrees.to_radians())
}

/// The chain as a product of homogeneous transforms, in machine coordinates with quaternions: another way than the crate's.
fn oracle(machine: &Kinematics, at: &Position, length: f64) -> Isometry3<f64> {
    let description = machine.description();
    let zero = Vector3::from(description.part_zero);
    let angle = |letter: char| at.abc["ABC".find(letter).unwrap()];
    let turn = |axis: &RotaryAxis, pivot: Vector3<f64>| {
        Translation3::from(pivot) * about(axis.axis, angle(axis.letter)) * Translation3::from(-pivot)
    };
    let mut chain = Isometry3::from(Translation3::from(-zero));
    for axis in &description.table {
        chain *= turn(axis, axis.pivot.into());
    }
    for axis in machine.linear() {
        let k = "XYZ".find(axis.letter).unwrap();
        let unit: Vector3<f64> = [Vector3::x(), Vector3::y(), Vector3::z()][k];
        let way = axis
            .direction
            .map_or(unit, |direction| Vector3::from(direction).normalize());
        chain *= Translation3::from(way * at.xyz[k]);
    }
    // The nose of the spindle, a tool's length above the tip, where the head's pivots are measured from.
    chain *= Translation3::from(zero + Vector3::z() * length);
    for axis in &description.head {
        chain *= turn(axis, axis.pivot.into());
    }
    chain * Translation3::from(Vector3::z() * -length)
}

fn vector() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-1.0..1.0_f64)
}

fn direction() -> impl Strategy<Value = [f64; 3]> {
    prop_oneof![
        vector().prop_filter("too short", |v| Vector3::from(*v).norm() > 0.1),
        prop::sample::select(vec![
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.0, -1.0, 0.0],
            [0.0, 1.0, 1.0]
        ]),
    ]
}

/// Machines with two rotary axes in any directions, skewed linear axes, and random pivots.
fn machine() -> impl Strategy<Value = Kinematics> {
    (
        [direction(), direction()],
        [vector(), vector(), vector(), vector()],
        0..3_usize,
        prop::sample::select(vec!["AB", "CA", "CB", "BA"]),
    )
        .prop_filter_map("no machine", |(axes, vectors, in_table, letters)| {
            let mut letters = letters.chars();
            let mut axis = |k: usize| RotaryAxis::new(letters.next().unwrap(), axes[k], vectors[k].map(|c| 300.0 * c));
            let mut rotary = vec![axis(0), axis(1)];
            let head = rotary.split_off(in_table);
            let mut skew = LinearAxis::new('Y');
            skew.direction = Some([0.1 * vectors[3][0], 1.0, 0.1 * vectors[3][1]]);
            let description = MachineDescription {
                table: rotary,
                head,
                linear: vec![skew],
                part_zero: vectors[2].map(|c| 200.0 * c),
                ..MachineDescription::default()
            };
            Kinematics::new(description).ok()
        })
}

fn near(a: [f64; 3], b: [f64; 3]) -> f64 {
    (Vector3::from(a) - Vector3::from(b)).norm()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn poses_are_the_product_of_the_chain(machine in machine(), xyz in vector(), abc in vector(), length in 0.0..200.0_f64) {
        let at = Position::new(xyz.map(|c| 500.0 * c), abc.map(|c| 400.0 * c));
        let expected = oracle(&machine, &at, length);
        let pose = machine.pose(&at, length).unwrap();
        prop_assert!(near(pose.tip(), expected.translation.vector.into()) < 1e-9);
        prop_assert!(near(pose.axis(), (expected.rotation * Vector3::z()).into()) < 1e-12);
    }

    #[test]
    fn both_solutions_give_the_pose(machine in machine(), xyz in vector(), abc in vector(), length in 0.0..200.0_f64) {
        let at = Position::new(xyz.map(|c| 500.0 * c), abc.map(|c| 400.0 * c));
        let pose = machine.pose(&at, length).unwrap();
        let solutions = machine.positions(&pose, length, &at).unwrap();
        prop_assert!(!solutions.positions.is_empty() && solutions.positions.len() <= 2);
        for position in &solutions.positions {
            let back = machine.pose(position, length).unwrap();
            prop_assert!(near(back.tip(), pose.tip()) < 1e-9, "{back:?} {pose:?}");
            prop_assert!(near(back.axis(), pose.axis()) < 1e-9);
        }
        // The position we came from is among them, apart from whole turns.
        let turn = |a: f64, b: f64| ((a - b + 180.0).rem_euclid(360.0) - 180.0).abs();
        let used: Vec<usize> = machine.rotary().map(|axis| "ABC".find(axis.letter).unwrap()).collect();
        let apart = |position: &Position| used.iter().map(|&k| turn(position.abc[k], at.abc[k])).fold(0.0, f64::max);
        let least = solutions.positions.iter().map(apart).fold(f64::INFINITY, f64::min);
        // Where both solutions meet, an angle is known to the root of the rounding only.
        prop_assert!(least < 1e-5, "{least} {solutions:?} {at:?}");
        // And it is the nearest to itself, turns included.
        let mut own = at;
        for k in 0..3 {
            if !used.contains(&k) {
                own.abc[k] = 0.0;
            }
        }
        let chosen = machine.nearest(&pose, length, &own).unwrap();
        prop_assert!(near(chosen.abc, own.abc) < 1e-5 && near(chosen.xyz, own.xyz) < 1e-3, "{chosen:?} {own:?}");
    }

    #[test]
    fn random_directions_are_reached_or_named(machine in machine(), axis in direction(), tip in vector()) {
        let pose = Pose::new(tip, axis).unwrap();
        match machine.positions(&pose, 0.0, &Position::default()) {
            Ok(solutions) => for position in solutions.positions {
                prop_assert!(near(machine.pose(&position, 0.0).unwrap().axis(), pose.axis()) < 1e-9);
            },
            Err(ReachError::Direction { degrees, .. }) => {
                // No angles come nearer than it says.
                for step in 0..72 {
                    let abc = [5.0 * f64::from(step); 3];
                    for inner in 0..72 {
                        let mut abc = abc;
                        if let Some(last) = machine.rotary().last() {
                            abc["ABC".find(last.letter).unwrap()] = 5.0 * f64::from(inner);
                        }
                        let off = Vector3::from(machine.axis(abc)).angle(&Vector3::from(pose.axis())).to_degrees();
                        prop_assert!(off > degrees - 1e-6);
                    }
                }
            }
            Err(other) => prop_assert!(false, "{other}"),
        }
    }
}

#[test]
fn formulas_of_the_books() {
    // LinuxCNC's trtfuncs: j = p + D + Rx(−A) [Rz(−C)(w − p) − D], with D from a point of C to a point of A.
    let (p, d) = (Vector3::new(3.0, -4.0, 5.0), Vector3::new(0.0, 7.0, -11.0));
    let description = MachineDescription {
        table: vec![
            RotaryAxis::new('C', [0.0, 0.0, 1.0], p.into()),
            RotaryAxis::new('A', [1.0, 0.0, 0.0], (p + d).into()),
        ],
        ..MachineDescription::default()
    };
    let machine = Kinematics::new(description).unwrap();
    for (w, a, c) in [([10.0, 20.0, 30.0], 25.0, 130.0), ([-5.0, 0.0, 2.0], -80.0, 300.0)] {
        let (rx, rz) = (about([1.0, 0.0, 0.0], -a), about([0.0, 0.0, 1.0], -c));
        let j = p + d + rx * (rz * (Vector3::from(w) - p) - d);
        let pose = machine.pose(&Position::new(j.into(), [a, 0.0, c]), 0.0).unwrap();
        assert!(near(pose.tip(), w) < 1e-12);
    }
    // A head with B and C whose pivot is L above the tip: tip = j + L (sinB cosC, sinB sinC, 1 − cosB)... downwards, as the tip hangs
    // below the pivot: the tool leans towards +X where the tip swings towards −X.
    let head = kinematics("head-bc");
    let (length, pivot) = (80.0, 150.0);
    let (b, c) = (35.0_f64, 110.0_f64);
    let pose = head.pose(&Position::new([1.0, 2.0, 3.0], [0.0, b, c]), length).unwrap();
    let ((sb, cb), (sc, cc)) = (b.to_radians().sin_cos(), c.to_radians().sin_cos());
    let l = length + pivot;
    assert!(near(pose.tip(), [1.0 - l * sb * cc, 2.0 - l * sb * sc, 3.0 + l * (1.0 - cb)]) < 1e-12);
    assert!(near(pose.axis(), [sb * cc, sb * sc, cb]) < 1e-15);
}

#[test]
fn what_a_control_chooses() {
    let machine = kinematics("trunnion-ac");
    let at = |abc| Position::new([0.0; 3], abc);
    let pose = Pose::new([0.0; 3], [0.0, -1.0, 1.0]).unwrap();
    let both = machine.positions(&pose, 0.0, &at([0.0; 3])).unwrap();
    assert_eq!((both.positions.len(), both.free), (2, None));
    // A45 C0 and A−45 C180: the nearer one, and the nearest turn of C.
    for (near_abc, chosen) in [
        ([50.0, 0.0, 20.0], [45.0, 0.0, 0.0]),
        ([-50.0, 0.0, 160.0], [-45.0, 0.0, 180.0]),
        ([45.0, 0.0, 700.0], [45.0, 0.0, 720.0]),
        // A45 C−720 is 90 and 20 away, A−45 C−540 only 160 in C.
        ([-45.0, 0.0, -700.0], [45.0, 0.0, -720.0]),
    ] {
        let found = machine.nearest(&pose, 0.0, &at(near_abc)).unwrap();
        assert!(near(found.abc, chosen) < 1e-12, "{found:?}");
    }
    // Upright, C is arbitrary: it stays.
    let up = Pose::new([1.0, 2.0, 3.0], [0.0, 0.0, 1.0]).unwrap();
    let upright = machine.positions(&up, 0.0, &at([30.0, 0.0, 77.0])).unwrap();
    assert_eq!((upright.positions.len(), upright.free), (1, Some('C')));
    assert_eq!(upright.positions[0].abc, [0.0, 0.0, 77.0]);
    let back = machine.pose(&upright.positions[0], 0.0).unwrap();
    assert!(near(back.tip(), [1.0, 2.0, 3.0]) < 1e-12);
}

#[test]
fn limits_choose_the_solution_or_are_named() {
    let mut description = kinematics("trunnion-ac").description().clone();
    description.table[1].limits = Some([-30.0, 120.0]);
    description.table[0].limits = Some([-10.0, 1000.0]);
    let machine = Kinematics::new(description.clone()).unwrap();
    let pose = Pose::new([0.0; 3], [0.0, -1.0, 1.0]).unwrap();
    let near_other = Position::new([0.0; 3], [-45.0, 0.0, -180.0]);
    let found = machine.nearest(&pose, 0.0, &near_other).unwrap();
    assert!(near(found.abc, [45.0, 0.0, 0.0]) < 1e-12, "{found:?}");
    description.table[1].limits = Some([-30.0, 30.0]);
    let machine = Kinematics::new(description.clone()).unwrap();
    let error = machine.nearest(&pose, 0.0, &near_other).unwrap_err();
    assert!(matches!(error, ReachError::Limit { letter: 'A', .. }), "{error}");
    // Linear limits are of the spindle's nose: with the tool's length.
    let mut axis = LinearAxis::new('Z');
    axis.limits = Some([0.0, 400.0]);
    description.linear = vec![axis];
    description.part_zero = [0.0, 0.0, 100.0];
    let machine = Kinematics::new(description).unwrap();
    let up = Pose::new([0.0, 0.0, 250.0], [0.0, 0.0, 1.0]).unwrap();
    assert!(machine.nearest(&up, 50.0, &Position::default()).is_ok());
    let error = machine.nearest(&up, 60.0, &Position::default()).unwrap_err();
    assert_eq!(error.to_string(), "Z would be 410, outside of its limits 0 to 400");
}

#[test]
fn unreachable_directions() {
    let tilted = Pose::new([0.0; 3], [1.0, 0.0, 1.0]).unwrap();
    for (name, degrees) in [("3-axis", 45.0), ("rotary-a", 45.0)] {
        let error = kinematics(name)
            .positions(&tilted, 0.0, &Position::default())
            .unwrap_err();
        let ReachError::Direction { degrees: found, .. } = error else {
            panic!("{error}")
        };
        assert!((found - degrees).abs() < 1e-9, "{name} {found}");
    }
    // A nutating head at 45° reaches down to the horizon, and not below.
    let nutating = kinematics("nutating-head-bc");
    let level = Pose::new([0.0; 3], [1.0, 1.0, 0.0]).unwrap();
    let below = Pose::new([0.0; 3], [1.0, 0.0, -0.1]).unwrap();
    let found = nutating.nearest(&level, 0.0, &Position::default()).unwrap();
    assert!((found.abc[1].abs() - 180.0).abs() < 1e-6);
    assert!(nutating.nearest(&below, 0.0, &Position::default()).is_err());
}

#[test]
fn ready_machines_are_read_back() {
    for name in Machine::names() {
        let machine = Machine::named(name).unwrap();
        assert_eq!(machine.kinematics.as_ref().unwrap().name(), *name);
        let text = machine.to_ron().unwrap();
        assert_eq!(Machine::read(&text).unwrap(), machine, "{text}");
    }
}

#[test]
fn no_machines() {
    for (text, message) in [
        ("Machine(name: \"x\"", "1:16: Expected comma"),
        (
            "Machine(table: [])",
            "1:18: Unexpected missing field named `name` in `Machine`",
        ),
        (
            "Machine(name: \"x\", table: [(letter: 'W', axis: (0, 0, 1))])",
            "'W' is not the letter of a rotary axis: expected A, B or C",
        ),
        (
            "Machine(name: \"x\", linear: [(letter: 'A')])",
            "'A' is not the letter of a linear axis: expected X, Y or Z",
        ),
        (
            "Machine(name: \"x\", linear: [(letter: 'X'), (letter: 'X')])",
            "two axes X: expected each letter once",
        ),
        (
            "Machine(name: \"x\", head: [(letter: 'C', axis: (0, 0, 0))])",
            "the axis of C is (0, 0, 0), but must be a direction",
        ),
        (
            "Machine(name: \"x\", head: [(letter: 'C', axis: (0, 0, 1)), (letter: 'A', axis: (0, 0, 2))])",
            "the rotary axes C and A are parallel: expected two directions",
        ),
        (
            "Machine(name: \"x\", table: [(letter: 'A', axis: (1, 0, 0)), (letter: 'C', axis: (0, 0, 1))])",
            "C, the last rotary axis before the tool, turns about the tool itself: expected another direction, or another order",
        ),
        (
            "Machine(name: \"x\", table: [(letter: 'A', axis: (1, 0, 0)), (letter: 'C', axis: (0, 0, 1)), (letter: 'B', axis: (0, 1, 0))])",
            "3 rotary axes: expected at most two",
        ),
        (
            "Machine(name: \"x\", linear: [(letter: 'X', direction: (0, 1, 0))])",
            "the linear axes do not move in three directions",
        ),
        (
            "Machine(name: \"x\", linear: [(letter: 'X', limits: (5, -5))])",
            "the limits of X is (5, -5), but must be two numbers, the lower one first",
        ),
        (
            "Machine(name: \"x\", linear: [(letter: 'X', speed: 0)])",
            "the speed of X is 0, but must be a positive number",
        ),
    ] {
        let error: MachineError = Machine::read(text).unwrap_err();
        assert_eq!(error.to_string(), message, "{text}");
    }
}
