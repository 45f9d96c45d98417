//! The Brouwer degree in three and more unknowns, from certified roots on the faces of a box.
//!
//! Leave out one equation `fᵢ`. Where the others vanish together on the boundary, `fᵢ` does not, or the degree is not defined; the degree counts
//! those of these points at which `fᵢ > 0`, with orientation (the preimage of a direction, seen from outside):
//!
//! ```text
//! deg(f, B) = Σ (−1)^(i + k) · side · sign det ∂(f without fᵢ)/∂(z without zₖ)      over the roots on faces zₖ = const with fᵢ > 0
//! ```
//!
//! with `side` 1 on upper faces and −1 on lower ones. The roots are those of systems in one unknown less, which the point solver finds with a
//! certificate each, and with their orientations. If it leaves anything open, if a root may lie on an edge between faces, or if the sign of `fᵢ` is not certain,
//! the next equation is left out; if none will do, nothing is claimed.

use super::PointSolver;
use crate::System;
use crate::coefficients::{Cell, Layout};
use crate::search::SolveOptions;

/// Unknowns up to which degrees are computed: faces take too long in more.
pub(super) const MOST_UNKNOWNS: usize = 4;
/// Boxes for all faces together, for each equation left out.
const BOXES: u64 = 2_000;
/// Enclosures are widened by this much before the sign of the remaining equation is determined.
const WIDER: f64 = 1e-9;

/// The degree of the system's equations on the cell.
pub(super) fn degree(system: &System, cell: &Cell, solver: &PointSolver) -> Option<i32> {
    if system.layout.tape.is_some() {
        return None;
    }
    (0..system.layout.n).find_map(|left_out| without(system, cell, left_out, solver))
}

/// The same, by leaving out this equation.
fn without(system: &System, cell: &Cell, left_out: usize, solver: &PointSolver) -> Option<i32> {
    let n = system.layout.n;
    let mut degree = 0;
    let mut boxes = 0;
    for variable in 0..n {
        for upper in [false, true] {
            let mut face = system.on_face(cell, variable, upper);
            let whole = face.layout.clone();
            face.layout = whole.without(left_out);
            let mut roots = PointSolver::new(SolveOptions {
                boxes: BOXES - boxes,
                unresolved: 0,
                time: solver.time_left(),
                ..SolveOptions::default()
            });
            roots.run(&face, &());
            boxes += roots.statistics.boxes;
            if !roots.open.is_empty() || boxes >= BOXES {
                return None;
            }
            for root in &roots.found {
                if root.boundary {
                    return None;
                }
                let mut around = whole.root();
                for j in 0..n - 1 {
                    around.lo[j] = (root.lo[j] - WIDER).max(0.0);
                    around.hi[j] = (root.hi[j] + WIDER).min(1.0);
                }
                whole.refresh(&mut around, &mut roots.doubles);
                let (lo, hi) = whole.ranges(&mut around);
                if lo[left_out] > 0.0 {
                    let side = if upper { 1 } else { -1 };
                    let place = if (left_out + variable).is_multiple_of(2) { 1 } else { -1 };
                    degree += side * place * i32::from(root.orientation);
                } else if hi[left_out] >= 0.0 {
                    return None;
                }
            }
        }
    }
    Some(degree)
}

impl Layout {
    /// The layout without one of its equations. Its coefficients stay where they are.
    fn without(&self, equation: usize) -> Self {
        let mut rest = Self {
            m: self.m - 1,
            ..self.clone()
        };
        rest.blend = None;
        rest.parts.retain(|part| part.equation != equation);
        for part in &mut rest.parts {
            part.equation -= usize::from(part.equation > equation);
        }
        for row in [
            &mut rest.remainder,
            &mut rest.slope_remainder,
            &mut rest.first_noise,
            &mut rest.missing,
            &mut rest.factor,
        ] {
            for e in equation + 1..self.m {
                row[e - 1] = row[e];
            }
        }
        rest
    }
}
