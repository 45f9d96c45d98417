//! The course of a section of a program: its poses, and between them the corners of rapids that the machine makes as dog-legs.

use super::OtherCourse;
use sweepsim_motion::{Move, Path, Pose};
use sweepsim_nc::{AxisFinding, Program, ProgramPose};

/// How far dog-legs may be from the machine's own course while rotary axes turn, in millimetres.
const TURNING: f64 = 1e-3;

/// The course of a section. Programs have millions of moves, so nothing is kept for all of them that most do not need.
pub(crate) struct Course {
    /// The poses: those of the section, and the corners of dog-legs.
    pub poses: Vec<Pose>,
    /// What each pose is, in the same order.
    pub steps: Vec<Step>,
    /// How the tool gets from each pose to the next; empty if the program says nothing of it, as tables do.
    pub ways: Vec<Move>,
}

/// What a pose of a course is.
pub(crate) struct Step {
    /// The pose of the program at whose move's end it is, or on whose way.
    pub of: usize,
    /// Its part of that move's duration, from 0 to 1.
    pub share: [f64; 2],
}

/// The course of a section that begins at pose `begin` of the program: one step for each pose, and more for dog-legs.
pub(crate) fn course(program: &Program, begin: usize, section: &[ProgramPose]) -> Course {
    let mut course = Course {
        poses: Vec::with_capacity(section.len()),
        steps: Vec::with_capacity(section.len()),
        ways: Vec::new(),
    };
    for (k, pose) in section.iter().enumerate() {
        let of = begin + k;
        let corners = if k == 0 { None } else { program.dog_leg(of, TURNING) };
        match corners {
            None => {
                if k > 0 && (!course.ways.is_empty() || pose.way() != Move::default()) {
                    course.ways.resize(course.steps.len() - 1, Move::default());
                    course.ways.push(pose.way());
                }
                course.poses.push(pose.pose);
                course.steps.push(Step { of, share: [0.0, 1.0] });
            }
            Some(corners) => {
                for pair in corners.windows(2) {
                    course.poses.push(pair[1].1);
                    let share = [pair[0].0, pair[1].0];
                    course.steps.push(Step { of, share });
                }
            }
        }
    }
    if !course.ways.is_empty() {
        course.ways.resize(course.steps.len() - 1, Move::default());
    }
    course
}

/// The dog-legs that moves of these steps may be, where that is not known.
pub(crate) fn other_courses(program: &Program, steps: &[Step]) -> Vec<OtherCourse> {
    let moves = steps.iter().skip(1).enumerate();
    let course = |(number, step): (usize, &Step)| {
        let (times, poses): (Vec<f64>, Vec<Pose>) = program.other_course(step.of, TURNING)?.into_iter().unzip();
        Some(OtherCourse {
            number,
            path: Path::new(poses).ok()?,
            times: times[1..].to_vec(),
        })
    };
    moves.filter_map(course).collect()
}

/// The findings of these steps, at their places among them.
pub(crate) fn at_steps(findings: &[AxisFinding], steps: &[Step]) -> Vec<AxisFinding> {
    let (Some(first), Some(last)) = (steps.first(), steps.last()) else {
        return Vec::new();
    };
    // Both are sorted by pose.
    let begin = findings.partition_point(|finding| finding.pose < first.of);
    let end = findings.partition_point(|finding| finding.pose <= last.of);
    findings[begin..end.max(begin)]
        .iter()
        .filter_map(|finding| {
            let near = steps.partition_point(|step| step.of < finding.pose);
            let own = steps[near..].iter().take_while(|step| step.of == finding.pose);
            let holds = |(_, step): &(usize, &Step)| finding.time <= step.share[1];
            let (at, step) = own.enumerate().find(holds)?;
            let [from, to] = step.share;
            let mut moved = finding.clone();
            moved.pose = near + at;
            moved.time = ((finding.time - from) / (to - from)).clamp(0.0, 1.0);
            Some(moved)
        })
        .collect()
}
