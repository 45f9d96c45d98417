//! The steps of a section of a program: its poses, and between them the corners of rapids that the machine makes as
//! dog-legs.

use sweepsim_nc::AxisFinding;

/// How far dog-legs may be from the machine's own course while rotary axes turn, in millimetres.
pub(super) const TURNING: f64 = 1e-3;

/// What a pose of a section is.
pub(super) struct Step {
    /// The pose of the program at whose move's end it is, or on whose way.
    pub of: usize,
    /// Its own number in the section.
    pub number: usize,
    /// Its part of that move's duration, from 0 to 1.
    pub share: [f64; 2],
}

/// The findings of these steps, at their numbers in the section. Steps are sorted by pose; those without findings need
/// not be among them.
pub(super) fn at_steps(findings: &[AxisFinding], steps: &[Step]) -> Vec<AxisFinding> {
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
            let mut own = steps[near..].iter().take_while(|step| step.of == finding.pose);
            let holds = |step: &&Step| finding.time <= step.share[1];
            let step = own.find(holds)?;
            let [from, to] = step.share;
            let mut moved = finding.clone();
            moved.pose = step.number;
            moved.time = ((finding.time - from) / (to - from)).clamp(0.0, 1.0);
            Some(moved)
        })
        .collect()
}
