//! Crossings of the faces of cells, certified.

use super::subdivide::{FaceCrossing, OpenCell, Search, stopped};
use crate::coefficients::Cell;
use crate::numbers::{EPSILON, MAX_UNKNOWNS, Row};
use crate::{CancelOnly, Monitor};
use std::time::Instant;

/// Skins to try, relative to the domain's sides.
const SKINS: [f64; 4] = [0.0, 1.0e-7, 2.3e-6, 4.1e-5];

impl Search<'_> {
    /// The root cell, its crossings, and the skin that it needed.
    pub(super) fn boundary(&mut self, monitor: &dyn Monitor) -> (Cell, Vec<usize>, f64) {
        let layout = &self.system.layout;
        let n = layout.n;
        let tries = if self.system.bounded() { 1 } else { SKINS.len() };
        for (number, &skin) in SKINS[..tries].iter().enumerate() {
            let mut root = self.system.root();
            if skin > 0.0 {
                for j in 0..n {
                    // Each face moves by a different amount, so that no edge passes through the same point.
                    let (below, above) = (1.0 + 0.113 * j as f64, 1.271 + 0.171 * j as f64);
                    let (lo, hi) = (root.lo[j] - skin * below, root.hi[j] + skin * above);
                    layout.restrict(&mut root, j, lo, hi);
                }
            }
            layout.ranges(&mut root);
            self.crossings.clear();
            let mut clean = true;
            let mut stuck = Vec::new();
            for j in 0..n {
                for upper in [false, true] {
                    clean &= self.cross(&root, j, upper, true, &mut stuck, monitor);
                }
            }
            if clean || number + 1 == tries || stopped(&stuck).is_some() {
                self.open.append(&mut stuck);
                return (root, (0..self.crossings.len()).collect(), skin);
            }
        }
        (self.system.root(), Vec::new(), 0.0)
    }

    /// Adds the crossings of a face of the cell; `false`, with the open boxes, if some could not be certified or lie on the face's edge.
    pub(super) fn cross(
        &mut self,
        cell: &Cell,
        axis: usize,
        upper: bool,
        outer: bool,
        stuck: &mut Vec<OpenCell>,
        monitor: &dyn Monitor,
    ) -> bool {
        let n = self.system.layout.n;
        let face = self.system.on_face(cell, axis, upper);
        self.points.options.time = self.deadline.map(|d| d.saturating_duration_since(Instant::now()));
        // The monitor does not see the boxes of searches on faces.
        self.points.run(&face, &CancelOnly(monitor));
        // Boxes of faces count towards the budget; otherwise searches that certify nothing on any face would never end.
        self.statistics.faces += self.points.statistics.boxes;
        let at = if upper { cell.hi[axis] } else { cell.lo[axis] };
        let place = |s: &Row, outward: f64| -> Row {
            let mut x = [0.0; MAX_UNKNOWNS];
            for j in 0..n {
                x[j] = if j == axis {
                    at
                } else {
                    let side = cell.hi[j] - cell.lo[j];
                    let value = cell.lo[j] + s[if j < axis { j } else { j - 1 }] * side;
                    value + outward * 4.0 * EPSILON * (value.abs() + side)
                };
            }
            x
        };
        let clean = self.points.open.is_empty() && self.points.found.iter().all(|f| !f.boundary);
        for found in &self.points.found {
            self.crossings.push(FaceCrossing {
                point: place(&found.point, 0.0),
                lo: place(&found.lo, -1.0),
                hi: place(&found.hi, 1.0),
                outer,
            });
        }
        for open in &self.points.open {
            stuck.push(OpenCell {
                lo: place(&open.lo, -1.0),
                hi: place(&open.hi, 1.0),
                cause: open.cause,
                crossings: Vec::new(),
            });
        }
        clean
    }
}
