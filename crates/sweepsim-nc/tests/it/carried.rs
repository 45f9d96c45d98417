//! Blocks without tip control in which a table turns the part.

use crate::posted::{apart, options};
use sweepsim_motion::{Path, TipCourse};
use sweepsim_nc::{Machine, Position, apt, gcode, write};

/// While a table turns, a block is one move, in which the tool is where the machine's axes put it, to the last digits; and so it is when it is
/// posted again, as one block for the same machine and in chords under tip control.
#[test]
fn a_table_carries_the_part() {
    let ends = [
        ([10.0, -20.0, 30.0], [25.0, -35.0, 70.0]),
        ([14.0, 5.0, -12.0], [-50.0, 80.0, 330.0]),
    ];
    let mut carried = Vec::new();
    for name in Machine::names() {
        let mut description = Machine::named(name).unwrap().kinematics.unwrap().description().clone();
        description.tool_length = 87.5;
        let machine = Machine::new(description).unwrap();
        let kinematics = machine.kinematics.clone().unwrap();
        let axes: Vec<usize> = kinematics
            .rotary()
            .map(|axis| "ABC".find(axis.letter).unwrap())
            .collect();
        // Each of them alone, and all together.
        let together = (axes.len() == 2).then(|| axes.clone());
        for turning in axes.iter().map(|axis| vec![*axis]).chain(together) {
            let mut positions = ends.map(|(xyz, abc)| Position::new(xyz, abc));
            for k in (0..3).filter(|k| !turning.contains(k)) {
                let kept = if axes.contains(&k) { ends[0].1[k] } else { 0.0 };
                positions.iter_mut().for_each(|position| position.abc[k] = kept);
            }
            let block = |at: &Position| {
                let words = axes.iter().map(|&k| format!(" {}{}", ["A", "B", "C"][k], at.abc[k]));
                format!(
                    "X{} Y{} Z{}{}",
                    at.xyz[0],
                    at.xyz[1],
                    at.xyz[2],
                    words.collect::<String>()
                )
            };
            let text = format!("G93\nG0 {}\nG1 {} F2\n", block(&positions[0]), block(&positions[1]));
            let mut options = options(machine.clone());
            options.upright_arcs = true;
            let read = gcode::read(&text, &options).unwrap();
            let last = read.poses.last().unwrap();
            let TipCourse::Carried(_) = last.way().course else {
                // By chords: heads, nutating tables, and tools along the axis of the turn.
                assert!(read.poses.len() > 10, "{name}");
                continue;
            };
            assert_eq!((read.poses.len(), last.feed), (2, Some(2.0)), "{name}");
            let letters: String = turning.iter().map(|&k| ["A", "B", "C"][k]).collect();
            carried.push(format!("{name} {letters}"));
            let poses = read.poses.iter().map(|pose| pose.pose).collect();
            let path = Path::with_moves(poses, vec![last.way()]).unwrap();
            let segments = path.segments(0, 100.0, 1e-9);
            for (n, segment) in segments.iter().enumerate() {
                for s in [0.0, 0.2, 0.7, 1.0] {
                    let time = (n as f64 + segment.time(s)) / segments.len() as f64;
                    let at = positions[0].towards(&positions[1], time);
                    let (truth, (turn, tip)) = (kinematics.pose(&at, 87.5).unwrap(), segment.at(s));
                    assert!(apart(tip, truth.tip()) < 2e-9, "{name} {tip:?} {truth:?}");
                    assert!(
                        apart(turn.column(2).into_owned().into(), truth.axis()) < 2e-11,
                        "{name}"
                    );
                }
            }
            let times: Vec<f64> = read.times().iter().filter_map(|time| time.seconds).collect();
            assert!((times.last().unwrap() - 30.0).abs() < 1e-9, "{name} {times:?}");
            let mut statements = Vec::new();
            let lost = write::clsf(&read, &mut statements).unwrap();
            assert!(
                lost.iter().any(|what| what.contains("while the table turns")),
                "{name} {lost:?}"
            );
            let again = apt::read(std::str::from_utf8(&statements).unwrap(), &options).unwrap();
            let chords = again.poses.len() - 1;
            assert!(
                chords > 10
                    && again
                        .poses
                        .iter()
                        .skip(1)
                        .all(|pose| pose.feed == Some(2.0 * chords as f64))
            );
            for (k, pose) in again.poses.iter().enumerate() {
                let truth = kinematics
                    .pose(&positions[0].towards(&positions[1], k as f64 / chords as f64), 87.5)
                    .unwrap();
                assert!(apart(pose.pose.tip(), truth.tip()) < 1e-9 && apart(pose.pose.axis(), truth.axis()) < 1e-9);
            }
            for tip_control in [false, true] {
                let posted =
                    write::gcode(&read, &write::GcodeOptions::for_machine(machine.clone(), tip_control)).unwrap();
                let again = gcode::read(&posted.text, &options).unwrap();
                // A turn of more than half a turn is not the nearest one.
                let is_block = !tip_control
                    && turning
                        .iter()
                        .all(|&k| (positions[1].abc[k] - positions[0].abc[k]).abs() < 180.0);
                assert_eq!(again.poses.len() == 2, is_block, "{name} {}", posted.text);
                let own = again.poses.last().unwrap();
                assert!(
                    apart(own.pose.tip(), last.pose.tip()) < 1e-6 && apart(own.pose.axis(), last.pose.axis()) < 1e-6
                );
                let seconds: f64 = again.times().iter().skip(1).filter_map(|time| time.seconds).sum();
                assert!((seconds - 30.0).abs() < 0.1, "{name} {seconds}");
                let chords = again.poses.len() - 1;
                for (k, pose) in again.poses.iter().enumerate().filter(|_| !is_block) {
                    let at = positions[0].towards(&positions[1], k as f64 / chords as f64);
                    assert!(
                        apart(pose.pose.tip(), kinematics.pose(&at, 87.5).unwrap().tip()) < 1e-6,
                        "{name}"
                    );
                }
            }
        }
    }
    let expected = [
        "rotary-a A",
        "rotary-b B",
        "trunnion-ac C",
        "trunnion-ac A",
        "trunnion-ac CA",
        "trunnion-bc C",
        "trunnion-bc B",
        "trunnion-bc CB",
        "head-b-table-c C",
        "head-a-table-c C",
        "mill-turn C",
    ];
    assert_eq!(carried, expected);
}

/// After a full turn the tool points where it did, but has been elsewhere; a tool along the axis of the turn has not.
#[test]
fn full_turns_are_moves() {
    let mut options = options(Machine::named("trunnion-ac").unwrap());
    options.upright_arcs = true;
    for (block, is_carried) in [
        ("X50 A3600", true),
        ("A360", true),
        ("C360", false),
        ("A360 C-720", true),
    ] {
        let read = gcode::read(&format!("G0 X10 Y5 Z20 A0 C0\nG1 {block} F100\n"), &options).unwrap();
        let last = read.poses.last().unwrap();
        assert_eq!(
            matches!(last.way().course, TipCourse::Carried(_)),
            is_carried,
            "{block}"
        );
        assert_eq!(read.poses.len() == 2, is_carried, "{block}");
    }
}
