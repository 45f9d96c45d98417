//! Poses of long programs are packed: nothing of them is lost.

use std::fmt::Write as _;
use sweepsim_motion::{Move, Pose, TipArc, Turning};
use sweepsim_nc::{FeedMode, ProgramPose, ProgramPoses, ReadOptions, gcode};

/// Poses of all kinds, so that every field differs from neighbour to neighbour now and then.
fn poses(count: usize) -> Vec<ProgramPose> {
    let mut state = 7_u64;
    let mut any = |most: u64| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state % most
    };
    let mut made = Vec::new();
    for k in 0..count {
        let tip = [
            0.01 * any(5000) as f64,
            k as f64 * 0.125,
            25.4 * (any(100) as f64 / 10.0),
        ];
        let axis = [0.1 * any(3) as f64, 0.0, 1.0];
        let pose = if any(50) == 0 {
            Pose::with_side(tip, axis, [0.0, 1.0, 0.0])
        } else {
            Pose::new(tip, axis)
        };
        let mut pose = ProgramPose::new(pose.unwrap(), 3 * k + any(3) as usize);
        pose.rapid = any(9) == 0;
        pose.file = any(40) as usize / 39;
        pose.joined = any(20) != 0;
        pose.tool = [None, Some(0), Some(7), Some(u32::MAX)][any(4) as usize];
        pose.feed = [None, Some(800.0), Some(any(1000) as f64 / 7.0)][any(3) as usize];
        pose.feed_mode = [FeedMode::PerMinute, FeedMode::PerRevolution, FeedMode::InverseTime][any(3) as usize];
        pose.call = [None, Some(0), Some(any(100) as u32)][any(3) as usize];
        pose.tip_control = any(2) == 0;
        pose.exact_stop = any(5) == 0;
        pose.set_way(match any(6) {
            0 => Move::arc(TipArc::new(tip, [0.0, 0.0, 1.0], 0.5 + any(5) as f64).unwrap()),
            1 => Move::straight(Turning::Even),
            _ => Move::default(),
        });
        made.push(pose);
    }
    made
}

#[test]
fn packed_poses_are_what_was_pushed() {
    for count in [0, 1, 4095, 4096, 4097, 9000] {
        let all = poses(count);
        let packed: ProgramPoses = all.iter().cloned().collect();
        assert_eq!((packed.len(), packed.is_empty()), (count, count == 0));
        assert_eq!(packed.last(), all.last());
        assert!(packed.in_order().eq(all.iter().cloned()));
        for k in (0..count).step_by(131) {
            assert_eq!(packed.at(k).as_ref(), Some(&all[k]));
        }
        assert_eq!(packed.at(count), None);
        assert_eq!(packed, all.clone().into());
        assert!(packed.clone().into_iter().eq(all.iter().cloned()));
        assert_eq!(&packed[..], &all[..]);
    }
}

#[test]
fn times_and_usage_of_a_long_program_are_those_of_its_parts() {
    let mut text = String::from("G21 G90\nT1 M6\nM3 S1000\nG0 X0 Y0 Z5\n");
    for k in 0..9000 {
        let _ = match k % 450 {
            0 => writeln!(text, "G0 Z5\nX{} Y{}\nG4 P0.5\nG1 Z0 F{}", k % 7, k / 90, 300 + k % 11),
            1 => writeln!(text, "G2 I1 J0"),
            _ => writeln!(text, "G1 X{:.3}", 0.013 * f64::from(k)),
        };
    }
    let mut options = ReadOptions::default();
    options.exact_arcs = true;
    let program = gcode::read(&text, &options).unwrap();
    assert!(program.poses.len() > 8_900, "{}", program.poses.len());
    let times = program.times();
    let mut clock = program.clock();
    assert!(
        program
            .poses
            .in_order()
            .map(|pose| clock.next(&pose))
            .eq(times.iter().copied())
    );
    // By hand: minutes of feed moves, and the dwells.
    let [usage] = &program.usage()[..] else {
        panic!("one tool")
    };
    let all = times.iter().enumerate();
    let cutting: f64 = all
        .filter(|(k, _)| !program.poses[*k].rapid)
        .map(|(_, time)| time.seconds.unwrap_or_default())
        .sum();
    let rests: f64 = times.iter().map(|time| time.rest).sum();
    assert_eq!(rests, 10.0);
    assert!(
        (usage.seconds - cutting - rests).abs() < 1e-6 * cutting,
        "{} {cutting}",
        usage.seconds
    );
}
