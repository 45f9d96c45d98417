//! Bodies for ready machines: plausible ones, of the sizes that are asked for.
//!
//! A size is given after the machine's name: `trunnion-ac,table=320,travel=500x400x400,zero=60,length=120`.

use std::collections::BTreeMap;

use super::MILL_TURN;
use crate::machines::bodies::{BodyDescription, BodyShape, Carries};
use crate::machines::description::{LinearAxis, MachineDescription};
use crate::machines::error::MachineError;

/// The sizes of a ready machine, in mm.
#[derive(Clone, Copy, Debug)]
struct Sizes {
    /// Diameter of a round table, width of another one.
    table: f64,
    /// Of X, Y and Z.
    travel: [f64; 3],
    /// How high the program's zero is above the table.
    zero: f64,
    /// From the spindle's nose to the tip.
    length: f64,
}

const USUAL: Sizes = Sizes {
    table: 320.0,
    travel: [500.0, 400.0, 400.0],
    zero: 50.0,
    length: 100.0,
};

fn refused(found: &str) -> MachineError {
    MachineError::Value {
        what: "a size of a ready machine".to_owned(),
        found: format!("{found:?}"),
        expected: "table=MM, travel=XxYxZ, zero=MM or length=MM",
    }
}

impl Sizes {
    fn read(words: &str) -> Result<Self, MachineError> {
        let mut sizes = USUAL;
        for word in words.split(',').map(str::trim).filter(|word| !word.is_empty()) {
            let (name, value) = word.split_once('=').ok_or_else(|| refused(word))?;
            let numbers: Option<Vec<f64>> = value.split('x').map(|number| number.trim().parse().ok()).collect();
            let numbers = numbers.filter(|all| all.iter().all(|n: &f64| *n > 0.0 && n.is_finite()));
            match (name.trim(), numbers.as_deref()) {
                ("table", Some(&[size])) => sizes.table = size,
                ("zero", Some(&[size])) => sizes.zero = size,
                ("length", Some(&[size])) => sizes.length = size,
                ("travel", Some(&[x, y, z])) => sizes.travel = [x, y, z],
                _ => return Err(refused(word)),
            }
        }
        Ok(sizes)
    }
}

fn body(name: &str, on: &str, shape: BodyShape) -> BodyDescription {
    BodyDescription {
        name: name.to_owned(),
        on: on.to_owned(),
        shape,
    }
}

fn block(min: [f64; 3], max: [f64; 3]) -> BodyShape {
    BodyShape::Block { min, max }
}

fn upright(from: f64, to: f64, radius: f64) -> BodyShape {
    let [from, to] = [from, to].map(|z| [0.0, 0.0, z]);
    BodyShape::Cylinder { from, to, radius }
}

/// The machine with limits and bodies.
pub(super) fn with_bodies(mut machine: MachineDescription, words: &str) -> Result<MachineDescription, MachineError> {
    let sizes = Sizes::read(words)?;
    let [x, y, _] = sizes.travel.map(|way| 0.5 * way);
    // The machine's zero is where the nose is with all axes at home: Z at its top.
    let (half, floor) = (0.5 * sizes.table, -sizes.travel[2]);
    let zero = floor + sizes.zero;
    machine.part_zero = [0.0, 0.0, zero];
    machine.table.iter_mut().for_each(|axis| axis.pivot[2] += zero);
    let letters =
        |axes: &[crate::machines::description::RotaryAxis]| axes.iter().map(|axis| axis.letter).collect::<String>();
    let (table, head) = (letters(&machine.table), letters(&machine.head));
    machine.tool_length = sizes.length;
    // A table that turns is heavy: the tool moves. Another one goes along X and Y.
    let carries = if table.is_empty() && head.is_empty() {
        Carries::Part
    } else {
        Carries::Tool
    };
    // Those that are there have speeds and accelerations.
    let mut rates = std::mem::take(&mut machine.linear).into_iter();
    let mut linear = |letter, limits, carries| {
        let mut axis = rates.next().unwrap_or_else(|| LinearAxis::new(letter));
        (axis.limits, axis.carries, axis.home) = (Some(limits), carries, Some(0.0));
        axis
    };
    // The nose gets down to the table.
    machine.linear = vec![
        linear('X', [-x, x], carries),
        linear('Y', [-y, y], carries),
        linear('Z', [floor, 0.0], Carries::Tool),
    ];
    let rotary = machine.table.iter_mut().chain(&mut machine.head);
    rotary.for_each(|axis| axis.home = Some(0.0));
    machine.tool_change = vec![BTreeMap::from([('Z', 0.0)])];
    if machine.name == MILL_TURN {
        turn(&mut machine, [2.0 * x, y, half, floor]);
        return Ok(machine);
    }
    let (bodies, lowest) = table_bodies(&machine, half, [floor, zero]);
    machine.bodies = bodies;
    let bed = block(
        [-x - half - 100.0, -y - half - 100.0, lowest - 220.0],
        [x + half + 100.0, y + half + 100.0, lowest - 20.0],
    );
    machine.bodies.push(body("bed", "base", bed));
    machine.bodies.extend(head_bodies(&head));
    if carries == Carries::Part {
        // A column behind the table, which goes back by half of Y's travel.
        let near = y + half + 40.0;
        let column = block([-150.0, near, lowest - 20.0], [150.0, near + 300.0, 600.0]);
        machine.bodies.push(body("column", "base", column));
    }
    Ok(machine)
}

/// A chuck before its headstock, and a head on a slide from the side: X goes from its home, where tools are changed, to
/// a little beyond the middle.
fn turn(machine: &mut MachineDescription, [x, y, half, floor]: [f64; 4]) {
    (machine.linear[0].limits, machine.linear[0].home) = (Some([-0.1 * x, 0.9 * x]), Some(0.9 * x));
    machine.tool_change.push(BTreeMap::from([('X', 0.9 * x)]));
    let chuck = upright(floor - 60.0, floor, half);
    let headstock = block(
        [-half - 40.0, -half - 40.0, floor - 400.0],
        [half + 40.0, half + 40.0, floor - 80.0],
    );
    // The slide is on the far side of the head, and the bed behind it.
    let slide = block([-80.0, 75.0, 70.0], [480.0, 275.0, 230.0]);
    let behind = y + 275.0 + 50.0;
    let bed = block(
        [-half - 200.0, behind, floor - 400.0],
        [x + 500.0, behind + 300.0, 400.0],
    );
    machine.bodies = vec![
        body("chuck", "C", chuck),
        body("headstock", "base", headstock),
        body("bed", "base", bed),
        body("slide", "Z", slide),
        body("spindle", "B", upright(0.0, 230.0, 65.0)),
    ];
}

/// What carries the part, and how low it reaches.
fn table_bodies(machine: &MachineDescription, half: f64, [floor, zero]: [f64; 2]) -> (Vec<BodyDescription>, f64) {
    let round = |on: &str| body("table", on, upright(floor - 40.0, floor, half));
    match &machine.table[..] {
        [] => {
            let top = block([-half, -half, floor - 60.0], [half, half, floor]);
            let on = if machine.head.is_empty() { "X" } else { "base" };
            (vec![body("table", on, top)], floor - 60.0)
        }
        [only] if only.letter == 'C' => (vec![round("C")], floor - 40.0),
        [only] => {
            // A rotary on a table: its axis goes through the program's zero, and so does that of its plate.
            let name = only.letter.to_string();
            let along = usize::from(only.letter == 'B');
            let at = |way: f64, z: f64| {
                let mut point = [0.0, 0.0, z];
                point[along] = way;
                point
            };
            let plate = BodyShape::Cylinder {
                from: at(-half - 40.0, zero),
                to: at(-half, zero),
                radius: 60.0,
            };
            let lowest = floor - 100.0;
            let mut low = at(-half - 200.0, lowest);
            let mut high = at(-half - 50.0, zero + 80.0);
            (low[1 - along], high[1 - along]) = (-90.0, 90.0);
            (
                vec![body("plate", &name, plate), body("rotary", "base", block(low, high))],
                lowest,
            )
        }
        [inner, outer, ..] => {
            // A cradle under the table, with arms to both sides along the outer axis.
            let along = usize::from(outer.letter == 'B');
            let (on, arm) = (outer.letter.to_string(), half + 30.0);
            let corner = |way: f64, across: f64, z: f64| if along == 0 { [way, across, z] } else { [across, way, z] };
            let low = floor - 110.0;
            let mut all = vec![round(&inner.letter.to_string())];
            all.push(body(
                "cradle",
                &on,
                block(corner(-arm - 50.0, -half, low), corner(arm + 50.0, half, floor - 50.0)),
            ));
            for (name, from, to) in [("left arm", -arm - 50.0, -arm), ("right arm", arm, arm + 50.0)] {
                all.push(body(
                    name,
                    &on,
                    block(corner(from, -60.0, floor - 50.0), corner(to, 60.0, zero + 60.0)),
                ));
            }
            // However far it tilts.
            let reach = (low - zero).hypot(half).max(60.0_f64.hypot(60.0));
            (all, zero - reach)
        }
    }
}

/// What carries the tool: from the nose up.
fn head_bodies(head: &str) -> Vec<BodyDescription> {
    let ram = |from: f64| body("ram", "Z", block([-120.0, -120.0, from], [120.0, 120.0, from + 500.0]));
    let mut letters = head.chars().rev();
    match (letters.next(), letters.next()) {
        (None, _) => vec![body("spindle", "Z", upright(0.0, 150.0, 60.0)), ram(150.0)],
        (Some(tilting), turning) => {
            // The spindle tilts about a pivot 150 mm above its nose, between two arms.
            let arms = turning.map_or_else(|| "Z".to_owned(), |letter| letter.to_string());
            let across = |side: f64, z: [f64; 2]| {
                let (near, far) = (side * 75.0, side * 115.0);
                let (least, most) = (near.min(far), near.max(far));
                match tilting {
                    'A' => block([least, -60.0, z[0]], [most, 60.0, z[1]]),
                    _ => block([-60.0, least, z[0]], [60.0, most, z[1]]),
                }
            };
            let mut all = vec![body("spindle", &tilting.to_string(), upright(0.0, 230.0, 65.0))];
            all.push(body("left arm of the head", &arms, across(-1.0, [90.0, 360.0])));
            all.push(body("right arm of the head", &arms, across(1.0, [90.0, 360.0])));
            all.push(ram(360.0));
            all
        }
    }
}
