//! Whether noise hides what is left of a cell's equations.
//!
//! An equation may be far from 0 on a cell and yet add nothing to the others: near a multiple root, combinations of equations vanish up to their
//! noise, and further splits only multiply the cells. So the equations are eliminated from one another (on their mean Jacobian, each row in units of its
//! noise, with complete pivoting). Combinations whose slopes are below their noise are evaluated at sample points; if all their values are, too, the cell
//! is *drowned*: nothing that the solver could compute decides it. This decides only when to stop, so it need not be rigorous.

use super::solver::PointSolver;
use crate::coefficients::Layout;
use crate::numbers::{MAX_UNKNOWNS, Row, ZERO};

/// A slope or a value below this many times its noise says nothing.
const CLEAR: f64 = 4.0;
/// If the preconditioned equations' noise is below this fraction of every side, nothing is hidden.
pub(super) const FAINT: f64 = 0.02;

/// What noise hides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Hidden {
    /// Nothing.
    Nothing,
    /// An equation's rest vanishes, but along the widest side the others still decide.
    Narrow,
    /// An equation's rest vanishes, and positions along the widest side remain undetermined.
    Wide,
}

impl PointSolver {
    /// Examines the current cell. A side below `thin` times the widest does not count as wide.
    pub(super) fn hidden(&mut self, layout: &Layout, thin: f64) -> Hidden {
        let n = layout.n;
        let cell = &self.cell;
        let mut rows = layout.mean_slopes(&cell.c);
        let mut noise = [0.0; MAX_UNKNOWNS];
        let mut weights = ZERO;
        for i in 0..n {
            noise[i] = layout.value_error(cell, i);
            weights[i][i] = 1.0;
            if !noise[i].is_finite() {
                return Hidden::Nothing;
            }
        }
        let own = noise;
        // The pivot's row of each column, or of each row its column.
        let (mut pivot_row, mut used) = ([usize::MAX; MAX_UNKNOWNS], [false; MAX_UNKNOWNS]);
        for _ in 0..n {
            let mut best = (0.0, 0, 0);
            for i in (0..n).filter(|i| !used[*i]) {
                for j in (0..n).filter(|j| pivot_row[*j] == usize::MAX) {
                    let share = rows[i][j].abs() / noise[i];
                    if share > best.0 {
                        best = (share, i, j);
                    }
                }
            }
            let (share, p, q) = best;
            if share <= CLEAR {
                break;
            }
            used[p] = true;
            pivot_row[q] = p;
            let (row, weight) = (rows[p], weights[p]);
            for i in (0..n).filter(|i| !used[*i]) {
                let factor = rows[i][q] / row[q];
                for j in 0..n {
                    rows[i][j] -= factor * row[j];
                    weights[i][j] -= factor * weight[j];
                }
                rows[i][q] = 0.0;
                noise[i] = (0..n).map(|e| weights[i][e].abs() * own[e]).sum();
            }
        }
        let left = || (0..n).filter(|i| !used[*i]);
        if left().next().is_none() {
            return Hidden::Nothing;
        }
        let mut above = [false; MAX_UNKNOWNS];
        let corners = if n <= 3 { 1usize << n } else { 2 };
        for number in 0..corners + 2 * n + 1 {
            let mut s: Row = [0.5; MAX_UNKNOWNS];
            if number < corners {
                for (j, s) in s.iter_mut().enumerate() {
                    *s = f64::from(u8::from((if n <= 3 { number >> j } else { number }) & 1 == 1));
                }
            } else if number < corners + 2 * n {
                let face = number - corners;
                s[face / 2] = (face % 2) as f64;
            }
            let value = layout.values(&cell.c, &s, &mut self.buffer);
            for i in left() {
                let sum: f64 = (0..n).map(|e| weights[i][e] * value[e]).sum();
                above[i] |= sum.abs() > CLEAR * noise[i];
            }
        }
        if left().all(|i| above[i]) {
            return Hidden::Nothing;
        }
        // A variable is undetermined if no equation has it as its pivot, or if that equation mixes it with such a variable.
        let mut open = [false; MAX_UNKNOWNS];
        loop {
            let mut changed = false;
            for j in (0..n).filter(|j| !open[*j]).collect::<smallvec::SmallVec<[usize; 8]>>() {
                let p = pivot_row[j];
                let tied = p == usize::MAX || (0..n).any(|k| open[k] && rows[p][k].abs() >= thin * rows[p][j].abs());
                open[j] = tied;
                changed |= tied;
            }
            if !changed {
                break;
            }
        }
        let width = |j: usize| self.cell.hi[j] - self.cell.lo[j];
        let widest = (0..n).fold(0.0, |w: f64, j| w.max(width(j)));
        if (0..n).any(|j| open[j] && width(j) >= thin * widest) {
            Hidden::Wide
        } else {
            Hidden::Narrow
        }
    }
}
