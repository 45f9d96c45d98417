//! The bodies of a machine, as `machine.ron` says them, and on which links they are.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::description::MachineDescription;
use super::error::MachineError;

/// A body of a machine. Its coordinates are those of the machine with all axes at 0: the spindle's nose is then at the zero point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyDescription {
    /// Its name.
    pub name: String,
    /// What carries it: the letter of an axis, or `base` for what stands still.
    pub on: String,
    /// Its shape.
    pub shape: BodyShape,
}

/// The shape of a body, in millimetres.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub enum BodyShape {
    /// An upright block.
    Block {
        /// Lower corner.
        min: [f64; 3],
        /// Upper corner.
        max: [f64; 3],
    },
    /// A cylinder.
    Cylinder {
        /// The centre of one end.
        from: [f64; 3],
        /// The centre of the other end.
        to: [f64; 3],
        /// Its radius.
        radius: f64,
    },
    /// What is turned: an outline about an axis.
    Turned {
        /// The point of the axis at height 0.
        at: [f64; 3],
        /// The direction of the axis, of any length.
        axis: [f64; 3],
        /// Radius and height of its corners, with rising heights.
        outline: Vec<[f64; 2]>,
    },
    /// A closed mesh or a solid from a file, beside that of the machine.
    File(String),
}

/// What carries a linear axis: the side of the chain that moves, seen from the base.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Carries {
    /// The tool.
    #[default]
    Tool,
    /// The part.
    Part,
}

/// What stands still.
pub(super) const BASE: &str = "base";

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

impl BodyShape {
    fn check(&self) -> Result<(), (String, &'static str)> {
        let finite = |points: &[[f64; 3]]| points.iter().flatten().all(|c| c.is_finite());
        let shown = |point: &[f64; 3]| format!("({}, {}, {})", point[0], point[1], point[2]);
        match self {
            Self::Block { min, max } => {
                let good = finite(&[*min, *max]) && (0..3).all(|k| min[k] < max[k]);
                let found = || {
                    (
                        format!("{} to {}", shown(min), shown(max)),
                        "two corners, the lower one first",
                    )
                };
                good.then_some(()).ok_or_else(found)
            }
            Self::Cylinder { from, to, radius } => {
                let good = finite(&[*from, *to]) && from != to && *radius > 0.0 && radius.is_finite();
                let found = format!("from {} to {} with radius {radius}", shown(from), shown(to));
                good.then_some(()).ok_or((found, "two points and a positive radius"))
            }
            Self::Turned { at, axis, outline } => {
                let rising = outline.windows(2).all(|pair| pair[0][1] <= pair[1][1]);
                let ends = outline.first().zip(outline.last());
                let good = finite(&[*at, *axis])
                    && *axis != [0.0; 3]
                    && ends.is_some_and(|(low, high)| low[1] < high[1])
                    && rising
                    && outline.iter().all(|[r, z]| *r >= 0.0 && r.is_finite() && z.is_finite());
                let expected = "corners of radius and rising height about an axis";
                good.then_some(()).ok_or_else(|| (format!("{outline:?}"), expected))
            }
            Self::File(name) => {
                let good = !name.is_empty();
                good.then_some(())
                    .ok_or_else(|| ("no name".into(), "the name of a file"))
            }
        }
    }
}
