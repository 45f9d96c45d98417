//! Cells on a stack of numbers, and the cheapest tests of them.

use super::layout::{Cell, Layout};
use crate::numbers::Row;

pub(crate) fn within_domain(cell: &Cell, n: usize) -> bool {
    (0..n).all(|j| cell.lo[j] >= 0.0 && cell.hi[j] <= 1.0)
}

pub(crate) fn excluded(totals: &(Row, Row), m: usize) -> bool {
    (0..m).any(|i| totals.0[i] > 0.0 || totals.1[i] < 0.0)
}

pub(crate) fn push(stack: &mut Vec<f64>, cell: &Cell, layout: &Layout) {
    let (n, m) = (layout.n, layout.rows());
    stack.extend_from_slice(&cell.lo[..n]);
    stack.extend_from_slice(&cell.hi[..n]);
    cell.noise.push_to(stack, m);
    cell.scale.push_to(stack, m);
    stack.extend_from_slice(&cell.c);
}

pub(crate) fn pop(stack: &mut Vec<f64>, cell: &mut Cell, layout: &Layout) {
    let (n, m) = (layout.n, layout.rows());
    let size = 2 * n + 2 * m + layout.len;
    let start = stack.len() - size;
    let record = &stack[start..];
    cell.lo[..n].copy_from_slice(&record[..n]);
    cell.hi[..n].copy_from_slice(&record[n..2 * n]);
    cell.noise.copy_from(&record[2 * n..2 * n + m]);
    cell.scale.copy_from(&record[2 * n + m..2 * n + 2 * m]);
    cell.c.clear();
    cell.c.extend_from_slice(&record[2 * n + 2 * m..]);
    stack.truncate(start);
}
