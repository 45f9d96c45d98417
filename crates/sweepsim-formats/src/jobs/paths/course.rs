//! The course of a section of a program: its poses, and between them the corners of rapids that the machine makes as dog-legs.

use super::OtherCourse;
use sweepsim_motion::{Move, Path, Pose};
use sweepsim_nc::{AxisFinding, Program, ProgramPose};

/// How far dog-legs may be from the machine's own course while rotary axes turn, in millimetres.
const TURNING: f64 = 1e-3;

/// A pose, and how the tool gets there.
pub(crate) struct Step {
    pub pose: Pose,
    pub way: Move,
    /// The pose of the program at whose move's end it is, or on whose way.
    pub of: usize,
    /// Its part of that move's duration, from 0 to 1.
    pub share: [f64; 2],
}

/// The steps of a section that begins at pose `begin` of the program: one for each pose, and more for dog-legs.
pub(crate) fn course(program: &Program, begin: usize, section: &[ProgramPose]) -> Vec<Step> {
    let mut steps = Vec::with_capacity(section.len());
    for (k, pose) in section.iter().enumerate() {
        let of = begin + k;
        let corners = if k == 0 { None } else { program.dog_leg(of, TURNING) };
        match corners {
            None => steps.push(Step {
                pose: pose.pose,
                way: pose.way,
                of,
                share: [0.0, 1.0],
            }),
            Some(corners) => steps.extend(corners.windows(2).map(|pair| Step {
                pose: pair[1].1,
                way: Move::default(),
                of,
                share: [pair[0].0, pair[1].0],
            })),
        }
    }
    steps
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
    let own = findings
        .iter()
        .filter(|finding| (first.of..=last.of).contains(&finding.pose));
    own.filter_map(|finding| {
        let holds = |step: &&(usize, &Step)| step.1.of == finding.pose && finding.time <= step.1.share[1];
        let (at, step) = steps.iter().enumerate().find(|step| holds(&step))?;
        let [from, to] = step.share;
        let mut moved = finding.clone();
        moved.pose = at;
        moved.time = ((finding.time - from) / (to - from)).clamp(0.0, 1.0);
        Some(moved)
    })
    .collect()
}
