//! Programs posted for machines, and read back; and moves without tip control as machines make them.

use std::collections::BTreeMap;

use nalgebra::{Rotation3, Vector3};
use sweepsim_motion::{Pose, Turning};
use sweepsim_nc::{
    AxisFault, AxisLaw, Kinematics, Machine, Position, Program, ProgramPose, ReadOptions, check, gcode, siemens, write,
};
use sweepsim_props::*;

fn machine(name: &str) -> (Machine, Kinematics) {
    let machine = Machine::named(name).unwrap();
    let kinematics = machine.kinematics.clone().unwrap().as_ref().clone();
    (machine, kinematics)
}

pub fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    (Vector3::from(a) - Vector3::from(b)).norm()
}

fn program(poses: &[Pose]) -> Program {
    let mut program = Program::default();
    for (index, pose) in poses.iter().enumerate() {
        let mut pose = ProgramPose::new(*pose, index + 1);
        pose.rapid = index == 0;
        pose.joined = index > 0;
        pose.tool = Some(3);
        pose.feed = Some(800.0);
        program.poses.push(pose);
    }
    program
}

/// The last pose of each block.
fn ends(program: &Program) -> Vec<Pose> {
    let by_line: BTreeMap<usize, Pose> = program.poses.iter().map(|pose| (pose.line, pose.pose)).collect();
    by_line.into_values().collect()
}

pub fn options(machine: Machine) -> ReadOptions {
    let mut options = ReadOptions::default();
    options.machine = machine;
    options.arc_tolerance = 0.05;
    options
}

/// X, Y, Z and A, B, C.
type Axes = ([f64; 3], [f64; 3]);

/// A machine by its index, positions within its limits, and a length of the tool.
fn runs() -> impl Strategy<Value = (usize, Vec<Axes>, f64)> {
    let position = (
        prop::array::uniform3(-200.0..200.0_f64),
        prop::array::uniform3(-100.0..100.0_f64),
    );
    (
        0..Machine::names().len(),
        collection::vec(position, 2..6),
        0.0..150.0_f64,
    )
}

/// Posts positions of a machine as poses, and reads them back.
#[track_caller]
fn keeps_the_poses(name: &str, positions: &[Axes], length: f64, tip_control: bool, rotary_law: bool) {
    let mut description = machine(name).1.description().clone();
    description.tool_lengths.insert(3, length);
    let machine = Machine::new(description).unwrap();
    let kinematics = machine.kinematics.clone().unwrap();
    let mut poses: Vec<Pose> = positions
        .iter()
        .map(|(xyz, abc)| kinematics.pose(&Position::new(*xyz, *abc), length).unwrap())
        .collect();
    // A block that moves nothing has no pose of its own.
    poses.dedup();
    let posted = write::GcodeOptions::for_machine(machine.clone(), tip_control);
    let text = write::gcode(&program(&poses), &posted).unwrap().text;
    let mut options = options(machine);
    if rotary_law {
        options.law = AxisLaw::Rotary;
    }
    let again = gcode::read(&text, &options).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let found = ends(&again);
    assert_eq!(found.len(), poses.len(), "{}", text);
    for (found, expected) in found.iter().zip(&poses) {
        assert!(
            apart(found.tip(), expected.tip()) < 1e-9,
            "{found:?} {expected:?}\n{text}"
        );
        assert!(
            apart(found.axis(), expected.axis()) < 1e-9,
            "{found:?} {expected:?}\n{text}"
        );
    }
    // The axes are known at each pose, and are where the machine is.
    assert_eq!(again.positions.len(), again.poses.len());
    for (position, pose) in again.positions.iter().zip(&again.poses) {
        assert!(apart(kinematics.pose(position, length).unwrap().tip(), pose.pose.tip()) < 1e-9);
    }
}

/// All fourteen machines, whatever the random ones are.
#[test]
fn all_machines() {
    let positions = [
        ([10.0, -20.0, 30.0], [0.0; 3]),
        ([11.0, -22.0, 33.0], [25.0, -35.0, 70.0]),
        ([-60.0, 5.0, 12.0], [25.0, -35.0, -80.0]),
        ([0.5, 0.25, -4.0], [-15.0, 60.0, 10.0]),
    ];
    assert_eq!(Machine::names().len(), 14);
    for name in Machine::names() {
        for (tip_control, rotary_law) in [(false, false), (false, true), (true, false), (true, true)] {
            keeps_the_poses(name, &positions, 87.5, tip_control, rotary_law);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, ..ProptestConfig::default() })]

    #[test]
    fn every_machine_keeps_the_poses((index, positions, length) in runs(), tip_control in any::<bool>(), rotary_law in any::<bool>()) {
        keeps_the_poses(Machine::names()[index], &positions, length, tip_control, rotary_law);
    }

    /// Between the poses of a block, the tool is where the machine's axes put it, within the tolerance.
    #[test]
    fn axes_move_in_step((index, positions, length) in runs()) {
        let mut description = machine(Machine::names()[index]).1.description().clone();
        description.tool_length = length;
        let machine = Machine::new(description).unwrap();
        let kinematics = machine.kinematics.clone().unwrap();
        let used: Vec<usize> = kinematics.rotary().map(|axis| "ABC".find(axis.letter).unwrap()).collect();
        let ends: Vec<Position> = positions
            .iter()
            .take(2)
            .map(|(xyz, abc)| Position::new(*xyz, std::array::from_fn(|k| if used.contains(&k) { abc[k] } else { 0.0 })))
            .collect();
        let block = |at: &Position| {
            let mut block = format!("X{} Y{} Z{}", at.xyz[0], at.xyz[1], at.xyz[2]);
            for &k in &used {
                block += &format!(" {}{}", ["A", "B", "C"][k], at.abc[k]);
            }
            block
        };
        let text = format!("G0 {}\nG1 {} F100", block(&ends[0]), block(&ends[1]));
        let options = options(machine);
        let read = gcode::read(&text, &options).unwrap();
        let parts = read.poses.len() - 1;
        for part in 0..parts {
            let [from, to] = [&read.poses[part], &read.poses[part + 1]];
            for step in 0..=8 {
                let s = f64::from(step) / 8.0;
                let truth = kinematics.pose(&ends[0].towards(&ends[1], (part as f64 + s) / parts as f64), length).unwrap();
                let mix = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] { std::array::from_fn(|k| a[k] + s * (b[k] - a[k])) };
                prop_assert!(apart(mix(from.pose.tip(), to.pose.tip()), truth.tip()) <= options.arc_tolerance * (1.0 + 1e-9) + 1e-9);
                let axis = match to.way().turning {
                    Turning::Rotary { table, from, to } => table.axis([0, 1].map(|k| from[k] + s * (to[k] - from[k]))),
                    _ => {
                        let (a, b) = (Vector3::from(from.pose.axis()), Vector3::from(to.pose.axis()));
                        let angle = a.cross(&b).norm().atan2(a.dot(&b));
                        let turn = Rotation3::rotation_between(&a, &b).unwrap().powf(if angle > 0.0 { s } else { 0.0 });
                        (turn * a).into()
                    }
                };
                // A point 100 mm from the tip is within the tolerance as well.
                prop_assert!(100.0 * apart(axis, truth.axis()) <= options.arc_tolerance + 1e-7);
            }
        }
    }
}

/// The same holes and edges on three sides of a part: by a table, by a head, by tilted planes, under tip control, and in Siemens's words.
#[test]
fn one_part_in_five_languages() {
    // Sides by the Euler angles of their frames, and their origins.
    let sides = [
        ([0.0, 0.0, 20.0], [0.0, 0.0, 0.0]),
        ([30.0, 10.0, 5.0], [90.0, 60.0, -90.0]),
        ([-20.0, 5.0, 0.0], [210.0, 35.0, 40.0]),
    ];
    let local = [
        [0.0, 0.0, 10.0],
        [0.0, 0.0, -3.0],
        [12.0, -7.0, -3.0],
        [12.0, 4.0, 10.0],
    ];
    let (tilted_machine, _) = machine("head-a-table-c");
    let mut tilted = String::from("G21 G90 G54\nT3 M6\n");
    let mut siemens_text = String::from("G71 G90 G54\nT3 M6\n");
    let mut expected = Vec::new();
    for (origin, [i, j, k]) in sides {
        let frame = Rotation3::from_axis_angle(&Vector3::z_axis(), f64::to_radians(i))
            * Rotation3::from_axis_angle(&Vector3::x_axis(), f64::to_radians(j))
            * Rotation3::from_axis_angle(&Vector3::z_axis(), f64::to_radians(k));
        tilted += &format!(
            "G68.2 X{} Y{} Z{} I{i} J{j} K{k}\nG53.1\n",
            origin[0], origin[1], origin[2]
        );
        siemens_text += &format!(
            "CYCLE800(0,\"X\",0,{},{},{},{},{i},{j},{k},0,0,0,1)\n",
            3 + 4 + 3 * 16,
            origin[0],
            origin[1],
            origin[2]
        );
        for (index, point) in local.iter().enumerate() {
            let code = if index == 0 { "G0" } else { "G1 F500" };
            let block = format!("{code} X{} Y{} Z{}\n", point[0], point[1], point[2]);
            tilted += &block;
            siemens_text += &block;
            let tip = frame * Vector3::from(*point) + Vector3::from(origin);
            expected.push(Pose::new(tip.into(), (frame * Vector3::z()).into()).unwrap());
        }
        tilted += "G69\n";
    }
    let mut programs = vec![
        (
            "tilted planes",
            gcode::read(&tilted, &options(tilted_machine.clone())).unwrap(),
        ),
        (
            "tilted planes of an unknown machine",
            gcode::read(&tilted, &ReadOptions::default()).unwrap(),
        ),
        (
            "swivelled planes",
            siemens::read(&siemens_text, &options(tilted_machine)).unwrap(),
        ),
        (
            "swivelled planes of an unknown machine",
            siemens::read(&siemens_text, &ReadOptions::default()).unwrap(),
        ),
    ];
    for name in ["trunnion-ac", "head-bc", "nutating-head-bc", "head-b-table-c"] {
        for tip_control in [false, true] {
            let (machine, _) = machine(name);
            let posted = write::GcodeOptions::for_machine(machine.clone(), tip_control);
            let text = write::gcode(&program(&expected), &posted).unwrap().text;
            programs.push((name, gcode::read(&text, &options(machine)).unwrap()));
        }
    }
    for (name, program) in &programs {
        let mut program = program.clone();
        if name.contains("planes") {
            // The turns into the planes, by the axes alone, are not programmed points.
            program.poses = program.poses.into_iter().filter(|pose| pose.tip_control).collect();
        }
        let found = ends(&program);
        assert_eq!(found.len(), expected.len(), "{name}");
        for (found, expected) in found.iter().zip(&expected) {
            assert!(
                apart(found.tip(), expected.tip()) < 1e-9,
                "{name}: {found:?} {expected:?}"
            );
            assert!(
                apart(found.axis(), expected.axis()) < 1e-9,
                "{name}: {found:?} {expected:?}"
            );
        }
    }
}

#[test]
fn haas_and_fanuc() {
    let last = |text: &str| {
        gcode::read(text, &ReadOptions::default())
            .unwrap_or_else(|error| panic!("{error}"))
            .poses
            .last()
            .unwrap()
            .pose
    };
    let half = 0.5_f64.sqrt();
    // G234: the tool leans by (sinB cosC, sinB sinC, cosB).
    let pose = last("G234 H1\nG0 X1 Y2 Z3 B45 C90");
    assert!(apart(pose.axis(), [0.0, half, half]) < 1e-12 && pose.tip() == [1.0, 2.0, 3.0]);
    // G254: the axes stay, the work offset turns with the table. Z is along the tool.
    let pose = last("G0 B90 C0\nG254\nG0 X1 Y2 Z3\nG1 Z0 F100");
    assert!(
        apart(pose.tip(), [0.0, 2.0, -1.0]) < 1e-12 && apart(pose.axis(), [1.0, 0.0, 0.0]) < 1e-12,
        "{pose:?}"
    );
    let pose = last("G0 B90 C0\nG254\nG0 X1 Y2 Z3\nG255\nG0 B0 C0\nG0 X5 Y6 Z7");
    assert_eq!((pose.tip(), pose.axis()), ([5.0, 6.0, 7.0], [0.0, 0.0, 1.0]));
    // G43.5: tool vectors.
    let pose = last("G43.5 H1\nG0 X0 Y0 Z5 I0 J0 K1\nG1 X9 I1 K1 F100");
    assert!(apart(pose.axis(), [half, 0.0, half]) < 1e-12 && pose.tip() == [9.0, 0.0, 5.0]);
    for (text, message) in [
        (
            "G0 X0 Y0 Z0\nG53.1",
            "2:1: G53.1 without a tilted plane: expected G68.2 before it",
        ),
        (
            "G0 X0 Y0 Z0\nG68.2 X0 Y0 Z0 I0 J30 K0\nG1 X1 A20 F9",
            "3:1: turning an axis in a tilted plane is not supported yet: the plane would turn with it; expected G69 or G255 before it",
        ),
        (
            "G43.5 H1\nG0 X0 Y0 Z0 I0 J0 K0",
            "2:1: the tool vector I J K is (0, 0, 0): expected a direction",
        ),
        (
            "G0 X0 Y0 Z0\nG1 C90 F10\n",
            "2:1: a move with the rotary axes turned is without tip control, but must be after M428, M128, G43.4 or TRAORI, or on a \
             machine whose pivots are known (`machine:`; or `tip_control: true` when the coordinates are the tip in the part's frame)",
        ),
    ] {
        assert_eq!(
            gcode::read(text, &ReadOptions::default()).unwrap_err().to_string(),
            message
        );
    }
}

#[test]
fn what_a_machine_cannot_do() {
    let (machine_with_a, _) = machine("rotary-a");
    let poses = [
        Pose::new([0.0; 3], [0.0, 0.0, 1.0]).unwrap(),
        Pose::new([1.0, 0.0, 0.0], [1.0, 0.0, 1.0]).unwrap(),
    ];
    let posted = write::GcodeOptions::for_machine(machine_with_a, true);
    let error = write::gcode(&program(&poses), &posted).unwrap_err();
    assert!(matches!(error, write::GcodeError::Reach { pose: 1, line: 2, .. }));
    let mut description = machine("trunnion-bc").1.description().clone();
    description.table[1].limits = Some([-30.0, 30.0]);
    description.table[1].speed = Some(1000.0);
    let limited = Machine::new(description).unwrap();
    let text = "M428\nG0 X0 Y0 Z0 B0 C0\nG1 X10 B20 F100\nX20 B40 F1000\nX21 B0";
    let read = gcode::read(text, &options(limited.clone())).unwrap();
    let findings = check(&read, limited.kinematics.as_ref().unwrap());
    let found: Vec<String> = findings.iter().map(ToString::to_string).collect();
    assert_eq!(
        found,
        [
            "line 4: B is 40, outside of its limits -30 to 30",
            "line 4: B would need a speed of 2000.0 per minute, but has at most 1000",
            "line 5: B would need a speed of 40000.0 per minute, but has at most 1000",
        ]
    );
    assert!(matches!(findings[0].fault, AxisFault::Limit { letter: 'B', .. }));
    // Read without a machine: what its control would choose. B40 has no solution within the limits.
    let read = gcode::read("M428\nG0 X0 Y0 Z0 B0 C0\nG1 X10 B-40 F100", &ReadOptions::default()).unwrap();
    let findings = check(&read, limited.kinematics.as_ref().unwrap());
    assert_eq!((findings.len(), findings[0].line), (1, 3));
}
