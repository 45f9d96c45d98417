//! The bodies of a machine, as `machine.ron` says them, and on which links they are.

use serde::{Deserialize, Serialize};

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

impl BodyShape {
    /// Or what was found, and what was expected.
    pub(super) fn check(&self) -> Result<(), (String, &'static str)> {
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
