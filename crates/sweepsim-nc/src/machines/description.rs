//! What a machine is made of, as `machine.ron` says it.

use std::collections::BTreeMap;
use std::path::Path;

use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use super::bodies::{BASE, BodyDescription, BodyShape, Carries};
use super::error::MachineError;

/// A machine, as written in `machine.ron`: lengths in millimetres, angles in degrees, from the part to the tool.
///
/// Positive coordinates and angles move the tool relative to the part, whichever of them the axis carries: a table's `C` about `(0, 0, 1)` turns
/// the part clockwise, seen from above, for a positive angle, as ISO 841 has it. Where the part turns the other way, the axis is `(0, 0, -1)`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Machine")]
pub struct MachineDescription {
    /// Its name, for messages.
    pub name: String,
    /// The rotary axes that carry the part, beginning at the part.
    #[serde(default)]
    pub table: Vec<RotaryAxis>,
    /// The linear axes. Those that are missing move along the coordinate axis of their letter, without limits.
    #[serde(default)]
    pub linear: Vec<LinearAxis>,
    /// The rotary axes that carry the tool, ending at the tool.
    #[serde(default)]
    pub head: Vec<RotaryAxis>,
    /// The zero point of programs in machine coordinates, with all rotary axes at 0: where the work offset (`G54`) is.
    #[serde(default)]
    pub part_zero: [f64; 3],
    /// The length of a tool from the spindle's nose to its tip, unless `tool_lengths` has it.
    #[serde(default)]
    pub tool_length: f64,
    /// The lengths of tools by number.
    #[serde(default, deserialize_with = "each_once")]
    pub tool_lengths: BTreeMap<u32, f64>,
    /// How rapid moves are made.
    #[serde(default)]
    pub rapid: Rapid,
    /// How tightly feed moves take their corners, in mm; without it [`CORNER_DEVIATION`](crate::CORNER_DEVIATION). Only
    /// [`Program::times`](crate::Program::times) counts it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub corner_deviation: Option<f64>,
    /// Over how many seconds the control averages speeds, so that accelerations do not jump; 0 if it does not. Only
    /// [`Program::times`](crate::Program::times) counts it, where any axis has an acceleration.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub smoothing: f64,
    /// Whether programs are under tip control from the start.
    #[serde(default)]
    pub tip_control: bool,
    /// Where tools are changed: rapids one after the other, each of the axes that it names, in machine coordinates and degrees.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tool_change: Vec<BTreeMap<char, f64>>,
    /// Its bodies.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<BodyDescription>,
    /// How near its bodies may come to each other, in mm.
    #[serde(default)]
    pub clearance: f64,
    /// Pairs of bodies, by their names, that are not looked at, besides those on one link or on two that an axis joins.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub may_touch: Vec<(String, String)>,
}

/// Reads a map in which no key may come twice: otherwise the last one would count, without a word.
fn each_once<'de, D: Deserializer<'de>>(deserializer: D) -> Result<BTreeMap<u32, f64>, D::Error> {
    struct Once;
    impl<'de> Visitor<'de> for Once {
        type Value = BTreeMap<u32, f64>;

        fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
            f.write_str("a map of numbers")
        }

        fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
            let mut all = BTreeMap::new();
            while let Some((key, value)) = map.next_entry()? {
                if all.insert(key, value).is_some() {
                    return Err(A::Error::custom(format!("a second {key}: expected each once")));
                }
            }
            Ok(all)
        }
    }
    deserializer.deserialize_map(Once)
}

impl MachineDescription {
    /// Names of files as seen from here, where they are given beside the machine's own file.
    pub(super) fn beside(&mut self, file: &Path) {
        let folder = file.parent().unwrap_or_else(|| Path::new(""));
        for body in &mut self.bodies {
            if let BodyShape::File(name) = &mut body.shape {
                *name = folder.join(&*name).to_string_lossy().into_owned();
            }
        }
    }

    /// Whether bodies have shapes, links and names that are right.
    pub(super) fn check_bodies(&self) -> Result<(), MachineError> {
        let value = |what: String, found: String, expected| Err(MachineError::Value { what, found, expected });
        let axes = self.table.iter().chain(&self.head).map(|axis| axis.letter);
        let letters: Vec<char> = axes.chain(['X', 'Y', 'Z']).collect();
        for (number, body) in self.bodies.iter().enumerate() {
            let known = body.on == BASE || letters.iter().any(|letter| body.on == letter.to_string());
            if !known {
                let expected = "the letter of one of its axes, or base";
                return value(
                    format!("`on` of the body {}", body.name),
                    format!("{:?}", body.on),
                    expected,
                );
            }
            if self.bodies[..number].iter().any(|other| other.name == body.name) {
                return value(
                    "the name of a body".into(),
                    format!("{:?}", body.name),
                    "another one for each",
                );
            }
            if let Err((found, expected)) = body.shape.check() {
                return value(format!("the shape of the body {}", body.name), found, expected);
            }
        }
        if !(self.clearance >= 0.0 && self.clearance.is_finite()) {
            return value("clearance".into(), self.clearance.to_string(), "0 or more");
        }
        for name in self.may_touch.iter().flat_map(|(a, b)| [a, b]) {
            if !self.bodies.iter().any(|body| body.name == *name) {
                return value("a name in may_touch".into(), format!("{name:?}"), "that of a body");
            }
        }
        Ok(())
    }
}

/// What is 0 is not written.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// A linear axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinearAxis {
    /// X, Y or Z.
    pub letter: char,
    /// The direction in which positive coordinates move the tool relative to the part; without it that of the letter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// Whether it moves the tool or the part.
    #[serde(default)]
    pub carries: Carries,
    /// The least and the largest coordinate of the spindle's nose, in machine coordinates.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limits: Option<[f64; 2]>,
    /// The largest speed, in mm/min.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// The largest acceleration, in mm/s².
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<f64>,
    /// The largest jerk, in mm/s³: how fast the acceleration changes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub jerk: Option<f64>,
    /// That of rapids, in mm/s², where it is another.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rapid_acceleration: Option<f64>,
    /// Where it stands at the start, in machine coordinates.
    #[serde(default)]
    pub start: f64,
    /// Where `G28` takes it, in machine coordinates.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub home: Option<f64>,
    /// Where `G30` takes it, in machine coordinates.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub second_home: Option<f64>,
}

/// A rotary axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RotaryAxis {
    /// A, B or C.
    pub letter: char,
    /// The direction about which positive angles turn the tool relative to the part, right-handed: of any length.
    pub axis: [f64; 3],
    /// A point of the axis with all rotary axes at 0. In the table in machine coordinates, in the head from the spindle's nose.
    #[serde(default)]
    pub pivot: [f64; 3],
    /// The least and the largest angle, in degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limits: Option<[f64; 2]>,
    /// The largest speed, in degrees per minute.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// The largest acceleration, in degrees/s².
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<f64>,
    /// The largest jerk, in degrees/s³.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub jerk: Option<f64>,
    /// Where it stands at the start, in degrees.
    #[serde(default)]
    pub start: f64,
    /// Where `G28` takes it, in degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub home: Option<f64>,
    /// Where `G30` takes it, in degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub second_home: Option<f64>,
}

impl LinearAxis {
    /// The axis of a letter, without limits.
    #[must_use]
    pub fn new(letter: char) -> Self {
        Self {
            letter,
            direction: None,
            carries: Carries::Tool,
            limits: None,
            speed: None,
            acceleration: None,
            jerk: None,
            rapid_acceleration: None,
            start: 0.0,
            home: None,
            second_home: None,
        }
    }
}

impl RotaryAxis {
    /// An axis through `pivot`, without limits.
    #[must_use]
    pub fn new(letter: char, axis: [f64; 3], pivot: [f64; 3]) -> Self {
        Self {
            letter,
            axis,
            pivot,
            limits: None,
            speed: None,
            acceleration: None,
            jerk: None,
            start: 0.0,
            home: None,
            second_home: None,
        }
    }

    /// The same with limits in degrees.
    #[must_use]
    pub fn within(self, least: f64, largest: f64) -> Self {
        Self {
            limits: Some([least, largest]),
            ..self
        }
    }
}

/// How rapid moves are made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Rapid {
    /// Not known. They are taken to be straight, and verification looks at [the other course](crate::Program::other_course) as well.
    #[default]
    Unknown,
    /// All axes arrive together.
    Straight,
    /// Each axis moves at its largest speed, so that they arrive one after the other.
    DogLeg,
}

/// A position of all axes, in a program's coordinates: where the tip would be in the part's frame if the rotary axes were at 0, in
/// millimetres, and the angles of the rotary axes in degrees. Letters that the machine has no axis for are 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Position {
    /// X, Y, Z.
    pub xyz: [f64; 3],
    /// A, B, C.
    pub abc: [f64; 3],
}

impl Position {
    /// A position.
    #[must_use]
    pub fn new(xyz: [f64; 3], abc: [f64; 3]) -> Self {
        Self { xyz, abc }
    }

    /// The position at `s` from 0 (here) to 1 (there), all axes at constant speed.
    #[must_use]
    pub fn towards(&self, other: &Self, s: f64) -> Self {
        let mix =
            |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|k| if s == 1.0 { b[k] } else { a[k] + s * (b[k] - a[k]) });
        Self {
            xyz: mix(self.xyz, other.xyz),
            abc: mix(self.abc, other.abc),
        }
    }
}

/// Refuses a number that is no good.
pub(super) fn check(
    what: impl Fn() -> String,
    found: f64,
    good: bool,
    expected: &'static str,
) -> Result<(), MachineError> {
    if good {
        return Ok(());
    }
    Err(MachineError::Value {
        what: what(),
        found: found.to_string(),
        expected,
    })
}

/// The numbers that both kinds of axes have.
pub(super) fn check_axis(
    letter: char,
    limits: Option<[f64; 2]>,
    rates: [Option<f64>; 4],
    start: f64,
) -> Result<(), MachineError> {
    if let Some([least, largest]) = limits {
        let ordered = least < largest && least.is_finite() && largest.is_finite();
        if !ordered {
            return Err(MachineError::Value {
                what: format!("the limits of {letter}"),
                found: format!("({least}, {largest})"),
                expected: "two numbers, the lower one first",
            });
        }
    }
    for (rate, name) in rates
        .into_iter()
        .zip(["speed", "acceleration", "jerk", "rapid_acceleration"])
    {
        if let Some(rate) = rate {
            let good = rate > 0.0 && rate.is_finite();
            check(|| format!("the {name} of {letter}"), rate, good, "a positive number")?;
        }
    }
    if let [_, None, Some(jerk), _] = rates {
        let expected = "beside an acceleration";
        check(|| format!("the jerk of {letter}"), jerk, false, expected)?;
    }
    check(
        || format!("the start of {letter}"),
        start,
        start.is_finite(),
        "a number",
    )
}
