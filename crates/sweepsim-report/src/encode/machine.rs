//! The machine: its joints, and their values over time.

use super::arrays::{Arrays, Scale};
use crate::scene::{JOINTS, Machine, MachineJoint};
use serde::Serialize;

/// Steps of clocks and values.
const STEPS: u32 = 1 << 24;
const NAMES: [&str; JOINTS] = ["axes.0", "axes.1", "axes.2", "axes.3", "axes.4", "axes.5"];

#[derive(Clone, Debug, Serialize)]
pub(crate) struct MachineHead {
    joints: Vec<JointHead>,
    base: usize,
    place: [[f64; 3]; 4],
    clock: Scale,
    values: Vec<Scale>,
    contacts: Vec<(f64, Vec<u16>)>,
}

#[derive(Clone, Debug, Serialize)]
struct JointHead {
    axis: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    pivot: Option<[f64; 3]>,
}

pub(crate) fn machine(machine: &Machine) -> (MachineHead, Arrays) {
    let points = &machine.points;
    let mut arrays = Arrays::default();
    let clock = Scale::over(points.iter().map(|point| point.clock), STEPS);
    let clocks: Vec<u32> = points.iter().map(|point| clock.steps(point.clock, STEPS)).collect();
    arrays.u32("axes.clock", &clocks);
    let begins: Vec<u16> = points.iter().map(|point| u16::from(point.begins)).collect();
    arrays.u16("axes.begins", &begins);
    let values = NAMES.iter().enumerate().take(machine.joints.len()).map(|(k, name)| {
        let scale = Scale::over(points.iter().map(|point| point.values[k]), STEPS);
        let steps: Vec<u32> = points.iter().map(|point| scale.steps(point.values[k], STEPS)).collect();
        arrays.u32(name, &steps);
        scale
    });
    let values = values.collect();
    let joint = |joint: &MachineJoint| JointHead {
        axis: joint.axis,
        pivot: joint.pivot,
    };
    let head = MachineHead {
        joints: machine.joints.iter().take(JOINTS).map(joint).collect(),
        base: machine.base,
        place: machine.place,
        clock,
        values,
        contacts: machine.contacts.clone(),
    };
    (head, arrays)
}
