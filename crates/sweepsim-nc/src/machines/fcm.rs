//! Machines of FreeCAD's CAM workbench: files `*.fcm`, in JSON.
//!
//! Read is what they say of axes: role, order, direction, a point of rotary ones, limits and speeds. That positive
//! angles move the tool relative to the part, as everywhere here, is not said in them.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::bodies::Carries;
use super::description::{LinearAxis, MachineDescription, RotaryAxis};
use super::error::MachineError;

#[derive(Deserialize)]
struct File {
    machine: Raw,
}

#[derive(Deserialize)]
struct Raw {
    #[serde(default)]
    name: String,
    #[serde(default)]
    units: Option<String>,
    axes: BTreeMap<String, RawAxis>,
}

#[derive(Deserialize)]
struct RawAxis {
    role: String,
    #[serde(default)]
    sequence: i64,
    #[serde(default)]
    joint: Option<RawJoint>,
    #[serde(default)]
    limits: Option<RawLimits>,
    #[serde(default)]
    max_velocity: Option<f64>,
}

#[derive(Deserialize)]
struct RawJoint {
    #[serde(default)]
    origin: [f64; 3],
    axis: [f64; 3],
}

#[derive(Deserialize)]
struct RawLimits {
    min: f64,
    max: f64,
}

/// The description in the text of such a file.
pub(super) fn description(text: &str) -> Result<MachineDescription, MachineError> {
    let file: File = serde_json::from_str(text).map_err(|error| MachineError::Syntax {
        line: error.line(),
        column: error.column(),
        message: error.to_string(),
    })?;
    let unit = match file.machine.units.as_deref() {
        Some("imperial") => 25.4,
        _ => 1.0,
    };
    let mut machine = MachineDescription {
        name: file.machine.name,
        ..MachineDescription::default()
    };
    let mut axes: Vec<(String, RawAxis)> = file.machine.axes.into_iter().collect();
    // From the base outwards: the part and the tool are at the ends.
    axes.sort_by_key(|(_, axis)| axis.sequence);
    for (name, axis) in axes {
        let wrong = |what: &str, found: String, expected| MachineError::Value {
            what: format!("the {what} of {name}"),
            found,
            expected,
        };
        let mut letters = name.chars();
        let (Some(letter), None) = (letters.next(), letters.next()) else {
            return Err(wrong("name", format!("{name:?}"), "one of X, Y, Z, A, B and C"));
        };
        // Limits that are equal stand for none.
        let limits = axis.limits.as_ref().filter(|limits| limits.min < limits.max);
        let limits = limits.map(|limits| [limits.min, limits.max]);
        let speed = axis.max_velocity.filter(|speed| *speed > 0.0);
        let direction = axis.joint.as_ref().map(|joint| joint.axis);
        let (is_linear, carries) = match axis.role.as_str() {
            "table_linear" => (true, Carries::Part),
            "head_linear" => (true, Carries::Tool),
            "table_rotary" => (false, Carries::Part),
            "head_rotary" => (false, Carries::Tool),
            other => {
                let expected = "table_linear, head_linear, table_rotary or head_rotary";
                return Err(wrong("role", format!("{other:?}"), expected));
            }
        };
        if is_linear {
            let mut own = LinearAxis::new(letter);
            (own.direction, own.carries) = (direction, carries);
            own.limits = limits.map(|limits| limits.map(|c| c * unit));
            own.speed = speed.map(|speed| speed * unit);
            // Those that carry the part are listed from the part on.
            match carries {
                Carries::Part => machine.linear.insert(0, own),
                Carries::Tool => machine.linear.push(own),
            }
            continue;
        }
        let Some(joint) = &axis.joint else {
            return Err(wrong("joint", "none".into(), "an axis"));
        };
        let mut own = RotaryAxis::new(letter, joint.axis, joint.origin.map(|c| c * unit));
        (own.limits, own.speed) = (limits, speed);
        match carries {
            Carries::Part => machine.table.insert(0, own),
            Carries::Tool => machine.head.push(own),
        }
    }
    Ok(machine)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machines::Kinematics;

    const TRUNNION: &str = r#"{ "freecad_version": "1.2.0", "machine": { "name": "cradle", "units": "imperial", "axes": {
        "X": { "type": "linear", "role": "head_linear", "joint": { "axis": [1, 0, 0] }, "limits": { "min": -10, "max": 10 }, "max_velocity": 400 },
        "Y": { "type": "linear", "role": "table_linear", "sequence": 0, "joint": { "origin": [0, 0, 0], "axis": [0, 1, 0] } },
        "Z": { "type": "linear", "role": "head_linear", "sequence": 1, "joint": { "axis": [0, 0, 1] }, "limits": { "min": 0, "max": 0 } },
        "A": { "type": "rotary", "role": "table_rotary", "sequence": 1, "joint": { "origin": [0, 0, -2], "axis": [1, 0, 0] },
               "limits": { "min": -30, "max": 110 }, "max_velocity": 3600 },
        "C": { "type": "rotary", "role": "table_rotary", "parent": "A", "sequence": 2, "joint": { "origin": [0, 0, -2], "axis": [0, 0, 1] } }
    } } }"#;

    #[test]
    fn a_trunnion_of_freecad() {
        let read = description(TRUNNION).unwrap();
        let letters = |axes: &[RotaryAxis]| axes.iter().map(|axis| axis.letter).collect::<String>();
        assert_eq!(
            (letters(&read.table), letters(&read.head), read.name.as_str()),
            ("CA".into(), "".into(), "cradle")
        );
        let [a, x] = [&read.table[1], read.table.last().unwrap()];
        assert_eq!((a, a.limits, a.speed), (x, Some([-30.0, 110.0]), Some(3600.0)));
        assert!((a.pivot[2] + 50.8).abs() < 1e-12);
        let linear: Vec<_> = read
            .linear
            .iter()
            .map(|axis| (axis.letter, axis.carries, axis.limits))
            .collect();
        assert_eq!(
            linear,
            [
                ('Y', Carries::Part, None),
                ('X', Carries::Tool, Some([-254.0, 254.0])),
                ('Z', Carries::Tool, None)
            ]
        );
        let chain = Kinematics::new(read).unwrap().chain();
        assert_eq!((chain.letters(), chain.base()), (&['C', 'A', 'Y', 'X', 'Z'][..], 3));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let error = |text: &str| description(text).unwrap_err().to_string();
        let role = TRUNNION.replacen("head_linear", "gantry", 1);
        assert!(error(&role).contains("the role of X is \"gantry\""), "{}", error(&role));
        assert!(error("{ \"machine\": {} }").contains("missing field `axes`"));
        let name = TRUNNION.replacen("\"X\"", "\"X1\"", 1);
        assert!(error(&name).contains("the name of X1"), "{}", error(&name));
    }
}
