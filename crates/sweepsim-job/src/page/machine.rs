//! The machine as it is shown: its bodies, and what its axes do over time.

use super::PageSource;
use super::course::Courses;
use crate::show::solids;
use sweepsim_formats::OnMachine;
use sweepsim_machine::{Body, Course, Joint};
use sweepsim_report::{JOINTS, Machine, MachineJoint, MachinePoint, Solid, SolidKind};

/// Parts of a move in which an axis goes no straight way.
const PARTS: usize = 8;
/// The most points.
const POINTS: usize = 200_000;
/// Bodies of more triangles are not shown.
const LARGEST: usize = 100_000;

/// The machine of the first path that is on one with bodies, over all paths on it.
pub(super) fn machine(source: &PageSource, made: &Courses) -> Option<(Machine, Vec<Solid>)> {
    let job = source.session.job;
    let on = |path: &'_ sweepsim_formats::JobPath| path.on_machine.clone().filter(|on| !on.bodies.is_empty());
    let first = job.paths.iter().position(|path| on(path).is_some())?;
    let path = &job.paths[first];
    let own = on(path)?;
    let chain = own.course.chain();
    let joint = |joint: &Joint| match joint {
        Joint::Linear(axis) => MachineJoint {
            axis: (**axis).into(),
            pivot: None,
        },
        Joint::Rotary { axis, pivot } => MachineJoint {
            axis: (**axis).into(),
            pivot: Some((*pivot).into()),
        },
    };
    let zero = own.course.machine().description().part_zero;
    let at = |p: [f64; 3]| path.frame.to_world([0, 1, 2].map(|k| p[k] - zero[k]));
    let origin = at([0.0; 3]);
    let axis = |k: usize| {
        let mut unit = [0.0; 3];
        unit[k] = 1.0;
        let end = at(unit);
        [0, 1, 2].map(|k| end[k] - origin[k])
    };
    let names: Vec<&str> = own.bodies.iter().map(|body| body.name.as_str()).collect();
    let contacts = source
        .report
        .findings
        .iter()
        .flatten()
        .filter(|finding| finding.kind == "machine");
    let contacts = contacts.filter_map(|finding| {
        let clock = made.clock(finding.path?, finding.r#move?, finding.time?)?;
        let met = names.iter().enumerate();
        let met = met.filter(|(_, name)| finding.bodies.iter().any(|body| body == *name));
        Some((clock, met.map(|(number, _)| number as u16).collect()))
    });
    let machine = Machine {
        joints: chain.linkage().joints().iter().map(joint).collect(),
        base: chain.base(),
        place: [origin, axis(0), axis(1), axis(2)],
        points: points(source, made, &own),
        contacts: contacts.collect(),
    };
    Some((machine, own.bodies.iter().map(solid).collect()))
}

/// What the axes do on all paths for this machine.
pub(super) fn points(source: &PageSource, made: &Courses, own: &OnMachine) -> Vec<MachinePoint> {
    let job = source.session.job;
    let every = job.moves().div_ceil(POINTS).max(1);
    let mut points = Vec::new();
    for (number, path) in job.paths.iter().enumerate() {
        let same = |on: &&OnMachine| on.course.machine() == own.course.machine();
        let Some(course) = path.on_machine.as_ref().filter(same).map(|on| &on.course) else {
            continue;
        };
        for piece in 0..course.moves() {
            let (moved, _, is_other) = course.place(piece, 0.0);
            if is_other || moved % every != 0 {
                continue;
            }
            let bent = course.bend(piece).iter().any(|bend| *bend > 0.0);
            let parts = if bent { PARTS } else { 1 };
            for part in 0..=parts {
                let time = part as f64 / parts as f64;
                let (moved, of_move, _) = course.place(piece, time);
                let Some(clock) = made.clock(number, moved, of_move) else {
                    continue;
                };
                let mut values = [0.0; JOINTS];
                values.copy_from_slice(&course.at(piece, time));
                let begins = part == 0 && !course.joined(piece);
                // Where a move ends, the next one begins.
                if part > 0 || begins {
                    points.push(MachinePoint { clock, values, begins });
                }
            }
        }
    }
    points.sort_by(|a, b| a.clock.total_cmp(&b.clock));
    points
}

/// A body as triangles on its link.
fn solid(body: &Body) -> Solid {
    let (vertices, triangles) = solids::body(body, LARGEST);
    Solid {
        kind: SolidKind::Body { link: body.link as u16 },
        setup: None,
        vertices,
        triangles,
    }
}
