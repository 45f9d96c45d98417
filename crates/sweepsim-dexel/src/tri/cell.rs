//! How the curves run in a cell, for each of the 256 ways to fill its corners.
//!
//! Corner `x + 2y + 4z` is the one at those offsets. Edge `4a + u + 2v` runs along axis `a` with those offsets along
//! the axes `a + 1` and `a + 2`.

/// Axis of each edge, and where it begins.
pub(super) const EDGES: [(usize, [usize; 3]); 12] = edges();

const fn edges() -> [(usize, [usize; 3]); 12] {
    let mut edges = [(0, [0; 3]); 12];
    let mut number = 0;
    while number < 12 {
        let axis = number / 4;
        let mut offset = [0; 3];
        offset[(axis + 1) % 3] = number & 1;
        offset[(axis + 2) % 3] = number >> 1 & 1;
        edges[number] = (axis, offset);
        number += 1;
    }
    edges
}

/// The curves of a kind of cell.
#[derive(Clone, Copy)]
pub(super) struct Kind {
    /// The number of curves.
    pub sheets: u8,
    /// The curve that each edge belongs to; 255 for none.
    pub sheet: [u8; 12],
}

pub(super) static CELLS: [Kind; 256] = cells();

const fn cells() -> [Kind; 256] {
    let mut cells = [Kind {
        sheets: 0,
        sheet: [255; 12],
    }; 256];
    let mut corners = 0;
    while corners < 256 {
        cells[corners] = kind(corners);
        corners += 1;
    }
    cells
}

const fn filled(corners: usize, offset: [usize; 3]) -> bool {
    corners >> (offset[0] + 2 * offset[1] + 4 * offset[2]) & 1 == 1
}

const fn kind(corners: usize) -> Kind {
    // Curves by their lowest edge.
    let mut root = [255_u8; 12];
    let mut edge = 0;
    while edge < 12 {
        let (axis, from) = EDGES[edge];
        let mut to = from;
        to[axis] = 1;
        if filled(corners, from) != filled(corners, to) {
            root[edge] = edge as u8;
        }
        edge += 1;
    }
    let mut face = 0;
    while face < 6 {
        root = join(corners, root, face / 2, face % 2);
        face += 1;
    }
    let mut sheets = 0;
    let mut sheet = [255; 12];
    let mut edge = 0;
    while edge < 12 {
        if root[edge] as usize == edge {
            sheet[edge] = sheets;
            sheets += 1;
        } else if root[edge] != 255 {
            sheet[edge] = sheet[root[edge] as usize];
        }
        edge += 1;
    }
    Kind { sheets, sheet }
}

/// Joins the edges that are neighbours on a face. The corners of the face are numbered around it as (0,0), (1,0),
/// (1,1), (0,1); edge `k` is from corner `k` to the next.
const fn join(corners: usize, mut root: [u8; 12], axis: usize, side: usize) -> [u8; 12] {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    // An edge along u has the offset v and the side as those of the axes u + 1 = v and u + 2 = axis; one along v the
    // side, then u.
    let edges = [4 * u + 2 * side, 4 * v + side + 2, 4 * u + 1 + 2 * side, 4 * v + side];
    let mut solid = [false; 4];
    let mut k = 0;
    while k < 4 {
        let mut offset = [0; 3];
        offset[axis] = side;
        offset[u] = (k == 1 || k == 2) as usize;
        offset[v] = k / 2;
        solid[k] = filled(corners, offset);
        k += 1;
    }
    let twice = solid[0] == solid[2] && solid[1] == solid[3] && solid[0] != solid[1];
    let mut k = 0;
    let mut open = 255;
    while k < 4 {
        let before = edges[(k + 3) % 4];
        if twice {
            // Around each corner with material.
            if solid[k] {
                root = unite(root, before, edges[k]);
            }
        } else if root[edges[k]] != 255 {
            if open == 255 {
                open = edges[k];
            } else {
                root = unite(root, open, edges[k]);
            }
        }
        k += 1;
    }
    root
}

const fn unite(mut root: [u8; 12], a: usize, b: usize) -> [u8; 12] {
    let (a, b) = (root[a], root[b]);
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    let mut edge = 0;
    while edge < 12 {
        if root[edge] == high {
            root[edge] = low;
        }
        edge += 1;
    }
    root
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_those_of_marching_cubes() {
        // None, a corner, two opposite ones, all but two opposite ones, half of the corners like a chessboard.
        for (corners, sheets) in [
            (0, 0),
            (255, 0),
            (1, 1),
            (129, 2),
            (126, 2),
            (0b1001_0110, 4),
            (0b0110_1001, 4),
            (0b1111, 1),
            (9, 2),
        ] {
            assert_eq!(CELLS[corners].sheets, sheets, "{corners:b}");
        }
        // Every curve has at least three edges.
        for kind in &CELLS {
            for sheet in 0..kind.sheets {
                assert!(kind.sheet.iter().filter(|s| **s == sheet).count() >= 3);
            }
        }
    }
}
