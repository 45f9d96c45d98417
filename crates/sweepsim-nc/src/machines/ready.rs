//! Ready machines: the commonest kinds, without limits that only a maker knows, and one whose times were measured.

mod bodies;

use super::description::{LinearAxis, MachineDescription, Rapid, RotaryAxis};
use super::error::MachineError;
use bodies::with_bodies;

/// The names of the ready machines.
pub(super) const NAMES: [&str; 14] = [
    "3-axis",
    "rotary-a",
    "rotary-b",
    "trunnion-ac",
    "trunnion-bc",
    "trunnion-ab",
    "head-bc",
    "head-ac",
    "head-b-table-c",
    "head-a-table-c",
    "nutating-head-bc",
    "nutating-table-bc",
    "mill-turn",
    HURCO,
];

/// The one whose part is in a chuck, before a head that comes from its side.
const MILL_TURN: &str = "mill-turn";

/// A mill of NIST's test bed, with the speeds and accelerations that its log of one part shows: `docs/validation.md`.
const HURCO: &str = "hurco-04";

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];
/// The axis of a nutating head or table: 45° between Y and Z.
const NUTATING: [f64; 3] = [0.0, 1.0, 1.0];
/// From the spindle's nose to the pivot of a head, in mm.
const PIVOT: [f64; 3] = [0.0, 0.0, 150.0];

/// The machine of a name, with [bodies](bodies) if sizes follow it.
pub(super) fn named(text: &str) -> Option<Result<MachineDescription, MachineError>> {
    let (name, sizes) = match text.split_once(',') {
        Some((name, sizes)) => (name, Some(sizes)),
        None => (text, None),
    };
    let plain = plain(name.trim())?;
    Some(match sizes {
        Some(sizes) => with_bodies(plain, sizes),
        None => Ok(plain),
    })
}

fn plain(name: &str) -> Option<MachineDescription> {
    let name = NAMES.iter().find(|known| known.eq_ignore_ascii_case(name))?;
    let at_zero = |letter, axis| RotaryAxis::new(letter, axis, [0.0; 3]);
    let in_head = |letter, axis| RotaryAxis::new(letter, axis, PIVOT);
    let (table, head) = match *name {
        "rotary-a" => (vec![at_zero('A', X)], vec![]),
        "rotary-b" => (vec![at_zero('B', Y)], vec![]),
        "trunnion-ac" => (vec![at_zero('C', Z), at_zero('A', X).within(-120.0, 120.0)], vec![]),
        "trunnion-bc" => (vec![at_zero('C', Z), at_zero('B', Y).within(-120.0, 120.0)], vec![]),
        "trunnion-ab" => (vec![at_zero('B', Y), at_zero('A', X).within(-120.0, 120.0)], vec![]),
        "head-bc" => (vec![], vec![in_head('C', Z), in_head('B', Y).within(-120.0, 120.0)]),
        "head-ac" => (vec![], vec![in_head('C', Z), in_head('A', X).within(-120.0, 120.0)]),
        "head-b-table-c" | MILL_TURN => (vec![at_zero('C', Z)], vec![in_head('B', Y).within(-120.0, 120.0)]),
        "head-a-table-c" => (vec![at_zero('C', Z)], vec![in_head('A', X).within(-120.0, 120.0)]),
        "nutating-head-bc" => (vec![], vec![in_head('C', Z), in_head('B', NUTATING)]),
        "nutating-table-bc" => (vec![at_zero('C', Z), at_zero('B', NUTATING)], vec![]),
        _ => (vec![], vec![]),
    };
    let machine = MachineDescription {
        name: (*name).to_owned(),
        table,
        head,
        ..MachineDescription::default()
    };
    Some(if *name == HURCO { hurco(machine) } else { machine })
}

/// Rapids go at 338.67 mm/s, the largest speed that the log holds at; the rest was fitted to it.
fn hurco(mut machine: MachineDescription) -> MachineDescription {
    machine.linear = ['X', 'Y', 'Z'].map(LinearAxis::new).into();
    for axis in &mut machine.linear {
        axis.speed = Some(20_320.0);
        (axis.acceleration, axis.rapid_acceleration) = (Some(320.0), Some(1400.0));
    }
    (machine.corner_deviation, machine.smoothing, machine.rapid) = (Some(0.0024), 0.059, Rapid::Straight);
    machine
}
