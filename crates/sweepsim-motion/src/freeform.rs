//! Tools of any shape: patches of one's own.

use crate::boundary::{NormalField, Patch};
use crate::turned;
use nalgebra::Vector3;
use sweepsim_spline::{Bernstein, RationalSpline, SplineError};
use thiserror::Error;

/// Why a surface is no patch of a tool.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PatchError {
    /// A form does not depend on two variables.
    #[error("a patch needs forms in two variables, but {what} has {found}")]
    Variables {
        /// Which form.
        what: &'static str,
        /// How many variables it has.
        found: usize,
    },
    /// A degree is too high.
    #[error("degree {degree} is too high: at most {most} can be used")]
    Degree {
        /// The degree.
        degree: usize,
        /// What is possible.
        most: usize,
    },
    /// A coefficient is not finite.
    #[error("a coefficient of {what} is not finite")]
    NotFinite {
        /// Of which form.
        what: &'static str,
    },
    /// A weight is not positive.
    #[error("weight {index} is {value}, but must be positive")]
    Weight {
        /// Which coefficient.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// The normal vanishes inside, or everywhere.
    #[error("the surface has no normal near (u, v) = ({u}, {v}): it is folded or degenerate there")]
    NoNormal {
        /// Where.
        u: f64,
        /// Where.
        v: f64,
    },
}

/// Why patches enclose no tool.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ToolError {
    /// There is none.
    #[error("a tool needs at least one patch")]
    Empty,
    /// A side, or a part of one, lies at no other one.
    #[error("side {side} of patch {patch} joins no other side near ({}, {}, {}): the boundary is open there", .place[0], .place[1], .place[2])]
    Open {
        /// The patch, from 0.
        patch: usize,
        /// Its side.
        side: Side,
        /// The middle of the part.
        place: [f64; 3],
    },
    /// Two patches that join face opposite ways.
    #[error(
        "patches {patch} and {other} join at side {side} of the first, but one faces out of the tool and the other into it"
    )]
    Flipped {
        /// A patch, from 0.
        patch: usize,
        /// Its side.
        side: Side,
        /// The other patch.
        other: usize,
    },
    /// More than two sides lie at one place.
    #[error("three or more sides join at side {side} of patch {patch}")]
    Branching {
        /// A patch, from 0.
        patch: usize,
        /// Its side.
        side: Side,
    },
    /// All patches face inwards.
    #[error("the patches face into the tool: swap u and v of each")]
    InsideOut,
    /// A surface is not one of two variables in space.
    #[error("surface {surface} maps {variables} variables to {dimension} coordinates: expected 2 and 3")]
    Surface {
        /// The surface, from 0.
        surface: usize,
        /// Its variables.
        variables: usize,
        /// Its coordinates.
        dimension: usize,
    },
    /// A surface cannot be taken apart.
    #[error("surface {surface}: {source}")]
    Spline {
        /// The surface, from 0.
        surface: usize,
        /// Why.
        source: SplineError,
    },
    /// A piece of a surface is no patch.
    #[error("surface {surface}, where u is in [{}, {}] and v in [{}, {}]: {source}", .ranges[0].0, .ranges[0].1, .ranges[1].0, .ranges[1].1)]
    Patch {
        /// The surface, from 0.
        surface: usize,
        /// The piece between knots: its range of `u` and of `v`. The error counts `u` and `v` from 0 to 1 in it.
        ranges: [(f64, f64); 2],
        /// Why.
        source: PatchError,
    },
}

/// A side of a patch, counter-clockwise seen from outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// `v = 0`, `u` increasing.
    Bottom,
    /// `u = 1`, `v` increasing.
    Right,
    /// `v = 1`, `u` decreasing.
    Top,
    /// `u = 0`, `v` decreasing.
    Left,
}

impl std::fmt::Display for Side {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Bottom => "v = 0",
            Self::Right => "u = 1",
            Self::Top => "v = 1",
            Self::Left => "u = 0",
        })
    }
}

/// Highest degree of a patch: that of the moments, four times as high, must still be evaluated well.
const MOST: usize = 7;

fn cross(a: &[Bernstein; 3], b: &[Bernstein; 3]) -> [Bernstein; 3] {
    [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        a[i].mul(&b[j]).sub(&a[j].mul(&b[i]))
    })
}

fn scaled(forms: &[Bernstein; 3], factor: f64) -> [Bernstein; 3] {
    [0, 1, 2].map(|k| forms[k].scale(factor).assumed_exact())
}

/// The normals `F_u × F_v` of any patch, times a power of its weight, and their moments.
pub(crate) fn normals(position: &[Bernstein; 3], weight: &Bernstein) -> NormalField {
    let first = weight.coefficients()[0];
    let polynomial = weight.coefficients().iter().all(|w| *w == first);
    let (pu, pv) = (
        [0, 1, 2].map(|k| position[k].derivative(0)),
        [0, 1, 2].map(|k| position[k].derivative(1)),
    );
    let both = cross(&pu, &pv);
    let (normal, moment) = if polynomial {
        // F = P / w with a constant weight: the moment of F is that of P over it.
        let moment = cross(position, &both).map(|form| form.scale(1.0 / first));
        (both, moment)
    } else {
        let (wu, wv) = (weight.derivative(0), weight.derivative(1));
        let (with_u, with_v) = (cross(position, &pu), cross(position, &pv));
        let hat = [0, 1, 2].map(|k| {
            let sum = weight.mul(&both[k]).add(&wv.mul(&with_u[k]));
            sum.sub(&wu.mul(&with_v[k]))
        });
        let moment = cross(position, &hat);
        (hat.map(|form| weight.mul(&form)), moment)
    };
    NormalField { normal, moment }
}

impl Patch {
    /// The patch `position / weight`, whose normal `F_u × F_v` points out of the tool.
    ///
    /// Its normals and moments are made as Bernstein forms: with `P` the position and `w` the weight,
    /// `N = w (P_u × P_v) + w_v (P × P_u) − w_u (P × P_v)`, up to the factor `w³` (after the quotient rule). Those of a piece of a surface
    /// of revolution about the third axis, which is recognised where it is one but for rounding, have a lower degree.
    ///
    /// # Errors
    /// [`PatchError`]: not two variables, a degree above 7, weights that are not positive, no normal in the inside (along the sides it
    /// may vanish: poles).
    pub fn new(position: [Bernstein; 3], weight: Bernstein) -> Result<Self, PatchError> {
        for (form, what) in position.iter().zip(["x", "y", "z"]).chain([(&weight, "the weight")]) {
            if form.variables() != 2 {
                return Err(PatchError::Variables {
                    what,
                    found: form.variables(),
                });
            }
            if let Some(&degree) = form.degrees().iter().find(|degree| **degree > MOST) {
                return Err(PatchError::Degree { degree, most: MOST });
            }
            if !form.coefficients().iter().all(|c| c.is_finite()) {
                return Err(PatchError::NotFinite { what });
            }
        }
        if let Some((index, &value)) = weight.coefficients().iter().enumerate().find(|(_, w)| **w <= 0.0) {
            return Err(PatchError::Weight { index, value });
        }
        let found = turned::field(&position, &weight);
        let NormalField { normal, moment } = found.unwrap_or_else(|| normals(&position, &weight));
        let largest = normal.iter().map(Bernstein::magnitude).fold(0.0, f64::max);
        if largest == 0.0 || !largest.is_finite() {
            return Err(PatchError::NoNormal { u: 0.5, v: 0.5 });
        }
        let field = NormalField {
            normal: scaled(&normal, 1.0 / largest),
            moment: scaled(&moment, 1.0 / largest),
        };
        check_normals(&field.normal)?;
        Ok(Self {
            position: scaled(&position, 1.0),
            weight: weight.assumed_exact(),
            field,
            revolved: None,
        })
    }

    /// The place at `(u, v)`.
    #[must_use]
    pub fn place(&self, u: f64, v: f64) -> Vector3<f64> {
        let weight = self.weight.evaluate(&[u, v]);
        Vector3::from([0, 1, 2].map(|k| self.position[k].evaluate(&[u, v]) / weight))
    }
}

/// Boxes of the inside are cut until the normals of each lie in a half space; boxes at the sides may stay undecided.
fn check_normals(normal: &[Bernstein; 3]) -> Result<(), PatchError> {
    const DEPTH: usize = 14;
    let mut stack = vec![(normal.clone(), [[0.0, 1.0]; 2], 0)];
    while let Some((forms, sides, depth)) = stack.pop() {
        let count = forms[0].coefficients().len();
        let vector = |i: usize| Vector3::from([0, 1, 2].map(|k| forms[k].coefficients()[i]));
        let mean: Vector3<f64> = (0..count).map(vector).sum();
        if (0..count).all(|i| vector(i).dot(&mean) > 0.0) {
            continue;
        }
        if depth == DEPTH {
            let at_a_side = sides.iter().any(|side| side[0] == 0.0 || side[1] == 1.0);
            if at_a_side {
                continue;
            }
            let [u, v] = sides.map(|side| 0.5 * (side[0] + side[1]));
            return Err(PatchError::NoNormal { u, v });
        }
        let axis = depth % 2;
        let halves = [0, 1, 2].map(|k| forms[k].split(axis, 0.5));
        let [a, b, c] = halves;
        let middle = 0.5 * (sides[axis][0] + sides[axis][1]);
        let (mut low, mut high) = (sides, sides);
        low[axis][1] = middle;
        high[axis][0] = middle;
        stack.push(([a.0, b.0, c.0], low, depth + 1));
        stack.push(([a.1, b.1, c.1], high, depth + 1));
    }
    Ok(())
}

/// The pieces between knots of B-spline surfaces, as patches.
///
/// # Errors
/// [`ToolError`]: not surfaces in space, or a piece that is no patch.
pub(crate) fn pieces(surfaces: &[RationalSpline]) -> Result<Vec<Patch>, ToolError> {
    let mut patches = Vec::new();
    for (surface, spline) in surfaces.iter().enumerate() {
        if (spline.variables(), spline.dimension()) != (2, 3) {
            return Err(ToolError::Surface {
                surface,
                variables: spline.variables(),
                dimension: spline.dimension(),
            });
        }
        let pieces = spline
            .pieces()
            .map_err(|source| ToolError::Spline { surface, source })?;
        // Pieces of a constant are that constant, whatever the roundings of knot insertion: the surface is polynomial, and the normals of
        // its patches have about half the degree.
        let mut weights = spline.control_points().map(|(_, weight)| weight);
        let first = weights.next();
        let constant = first.filter(|first| weights.all(|weight| weight == *first));
        for piece in pieces {
            let forms = piece.map.numerators();
            let position = [0, 1, 2].map(|k| forms[k].clone().assumed_exact());
            let mut weight = piece.map.weight().clone().assumed_exact();
            if let Some(constant) = constant {
                weight = Bernstein::from_fn(weight.degrees(), |_| constant).unwrap_or(weight);
            }
            patches.push(Patch::new(position, weight).map_err(|source| ToolError::Patch {
                surface,
                ranges: [piece.ranges[0], piece.ranges[1]],
                source,
            })?);
        }
    }
    Ok(patches)
}
