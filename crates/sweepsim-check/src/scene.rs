//! What a certificate is about, as plain numbers: the caller reads it out of the program's files.

use crate::vector::V3;
use serde::Serialize;
use sha2::{Digest, Sha256};
use std::io::{BufWriter, IntoInnerError, Write};

/// The corners of a triangle, counter-clockwise seen from outside of the solid.
pub type Triangle = [V3; 3];

/// Solids, tools, their paths, and what is asked of them. All lengths are in the same unit.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Scene {
    /// Solids between triangles: the target, and fixtures.
    pub solids: Vec<Vec<Triangle>>,
    /// What moves: the outlines of cutters and of other bodies of tools.
    pub outlines: Vec<Outline>,
    /// Paths: motions one after the other.
    pub paths: Vec<Vec<Motion>>,
    /// No point of a body is farther than this from where [rational motions](Course::Rational) say.
    pub deviation: f64,
    /// The material is within one of these convex regions, without a skin
    pub stock: Vec<Vec<Plane>>,
    /// of this thickness.
    pub skin: f64,
    /// Points are only known to be removed, or outside of the stock, if they are so by this.
    pub margin: f64,
    /// What is asked.
    pub questions: Vec<Question>,
}

/// A tool, as solids of revolution about its axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Outline {
    /// The outline of a tool of revolution in `(ρ, ζ)`, from the tip on the axis to the top on the axis, with the tool
    /// on its left; of others, [hulls](Curve::Hull) that they are in.
    pub curves: Vec<Curve>,
    /// Convex solids that the tool holds, if the outline does not say it all: their corners, from the axis to the axis.
    pub cores: Vec<Vec<[f64; 2]>>,
}

/// A curve of an outline.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Curve {
    /// A rational Bézier curve: its control points, each with its weight; two are a line.
    Bezier(Vec<([f64; 2], f64)>),
    /// No curve, but points: their hull, turned about the axis, has the tool in it.
    Hull(Vec<[f64; 2]>),
    /// An arc of a circle.
    Arc {
        /// The centre.
        centre: [f64; 2],
        /// The radius.
        radius: f64,
        /// The angles at its ends, from `ρ` towards `ζ`: they fall where the tool is outside of the circle.
        angles: [f64; 2],
    },
}

/// Part of a move.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Motion {
    /// The number of the move.
    pub number: usize,
    /// Whether it is only possible that the tool moves so: another course of a rapid.
    pub possible: bool,
    /// Whether it must not cut, as rapids must not: it counts as removing nothing.
    pub idle: bool,
    /// How it moves.
    pub course: Course,
}

/// A motion of a tool for `t` from 0 to 1.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Course {
    /// Between two poses, tip and unit axis each: the tip goes straight, while the axis turns the shortest way, by no
    /// more than 90°, along a rational arc.
    Linear([[V3; 2]; 2]),
    /// The tip and the axis by Bernstein coefficients of numerators and weights, within the
    /// [deviation](Scene::deviation) of what the program says. An axis that keeps still has one.
    Rational([Vec<(V3, f64)>; 2]),
}

/// All points `x` with `⟨n, x⟩ ≤ c`: `n` and `c`.
pub type Plane = (V3, f64);

/// A question: a [claim](crate::Claim) answers it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Question {
    /// Its name.
    pub about: String,
    /// What is measured.
    pub measure: Measure,
    /// What is measured should be no more.
    pub limit: f64,
    /// The number of the solid, if it is about one.
    pub solid: usize,
    /// What moves: a path and an outline each.
    pub movers: Vec<(usize, usize)>,
    /// If it is about material, what cuts it: a path and an outline each. Paths come one after the other.
    pub cutters: Vec<(usize, usize)>,
}

/// What is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub enum Measure {
    /// How deep a mover gets into the solid at any time; less than 0 is how far it stays away.
    #[default]
    Depth,
    /// How high what is left of the stock stands above the solid in the end, as far as it hangs together with it.
    Height,
    /// How deep a mover gets into what is left of the stock at that time; less than 0 is how far it stays away. The
    /// depth of a point is its distance from what was removed before, or is outside of the stock.
    Material,
    /// The same in motions that must not cut.
    MaterialInRapids,
}

impl Scene {
    /// The SHA-256 of all its numbers, in hexadecimal.
    #[must_use]
    pub fn digest(&self) -> String {
        let mut all = BufWriter::with_capacity(1 << 16, Digested(Sha256::new()));
        // Every number has a notation of its own, and writing cannot fail.
        let written = serde_json::to_writer(&mut all, self).map_err(Into::into);
        let all = written.and_then(|()| all.into_inner().map_err(IntoInnerError::into_error));
        all.map_or_else(|error| error.to_string(), |all| hexadecimal(&all.0.finalize()))
    }
}

struct Digested(Sha256);

impl Write for Digested {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// Bytes as text.
pub(crate) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
