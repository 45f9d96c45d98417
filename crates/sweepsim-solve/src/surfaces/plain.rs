//! Which boxes are plain: a derivative has one sign on the box and on all its faces.

use crate::coefficients::{Cell, Layout, Slopes};

/// Whether the cell and its faces and edges are plain.
pub(super) fn plain(layout: &Layout, cell: &Cell) -> bool {
    let slopes = layout.slopes(cell);
    let signed = |j: usize| slopes.lo[0][j] > 0.0 || slopes.hi[0][j] < 0.0;
    let fixed = [signed(0), signed(1), signed(2)];
    if !fixed.contains(&true) {
        return false;
    }
    if fixed == [true; 3] {
        return true;
    }
    for normal in 0..3 {
        for upper in [false, true] {
            let face = layout.face(cell, normal, upper);
            let along = [usize::from(normal == 0), 2 - usize::from(normal == 2)];
            if !plain_part(&face, [fixed[along[0]], fixed[along[1]]]) {
                return false;
            }
        }
    }
    true
}

/// Whether a face, and each of its edges, has a derivative of one sign or no zero.
fn plain_part(face: &Layout, fixed: [bool; 2]) -> bool {
    let mut cell = face.root();
    if fixed == [true; 2] {
        return true;
    }
    let totals = face.ranges(&mut cell);
    if totals.0[0] > 0.0 || totals.1[0] < 0.0 {
        return true;
    }
    let slopes = face.slopes(&cell);
    let signed = |s: &Slopes, j: usize| s.lo[0][j] > 0.0 || s.hi[0][j] < 0.0;
    let own = [fixed[0] || signed(&slopes, 0), fixed[1] || signed(&slopes, 1)];
    if own == [false; 2] {
        return false;
    }
    for along in 0..2 {
        if own[along] {
            continue;
        }
        for upper in [false, true] {
            let edge = face.face(&cell, 1 - along, upper);
            let mut part = edge.root();
            let totals = edge.ranges(&mut part);
            let slopes = edge.slopes(&part);
            if totals.0[0] <= 0.0 && totals.1[0] >= 0.0 && !signed(&slopes, 0) {
                return false;
            }
        }
    }
    true
}
