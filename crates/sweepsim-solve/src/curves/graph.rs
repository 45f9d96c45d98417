//! Cells in which the curve is a graph over one variable, and the tube that contains it.

use crate::coefficients::{Cell, Layout, Slopes};
use crate::numbers::{EPSILON, MAX_UNKNOWNS, Row, Square, ZERO, inverse};

/// How a cell is a graph.
pub(crate) struct Graph {
    /// The variable that it is a graph over.
    pub over: usize,
    /// Approximate inverse of the Jacobian with respect to the others (rows: the others in order; columns: equations).
    pub inverse: Square,
    /// Sign of its determinant.
    pub sign: i8,
}

/// All columns of a matrix except one, as a square matrix.
pub(crate) fn without(matrix: &Square, column: usize, m: usize) -> Square {
    let mut out = ZERO;
    for e in 0..m {
        for j in 0..m {
            out[e][j] = matrix[e][if j < column { j } else { j + 1 }];
        }
    }
    out
}

/// The determinant of all columns except one.
pub(crate) fn minor(matrix: &Square, column: usize, m: usize) -> f64 {
    let mut a = without(matrix, column, m);
    let mut determinant = 1.0;
    for c in 0..m {
        let mut pivot = c;
        for r in c + 1..m {
            if a[r][c].abs() > a[pivot][c].abs() {
                pivot = r;
            }
        }
        if a[pivot][c] == 0.0 {
            return 0.0;
        }
        if pivot != c {
            a.swap(pivot, c);
            determinant = -determinant;
        }
        determinant *= a[c][c];
        let row = a[c];
        for r in c + 1..m {
            let factor = a[r][c] / row[c];
            for j in c..m {
                a[r][j] -= factor * row[j];
            }
        }
    }
    determinant
}

/// Tries to prove that the cell's curve is a graph over a variable, or that it misses the cell altogether.
pub(crate) fn graph(
    layout: &Layout,
    cell: &Cell,
    mean: &Square,
    slopes: &Slopes,
    over: usize,
) -> Option<(Graph, bool)> {
    let m = layout.m;
    let (k, sign) = inverse(&without(mean, over, m), m)?;
    let (lo, hi) = (without(&slopes.lo, over, m), without(&slopes.hi, over, m));
    for i in 0..m {
        let mut row = 0.0;
        for j in 0..m {
            let (mut middle, mut radius, mut size) = (if i == j { -1.0 } else { 0.0 }, 0.0, 1.0);
            for e in 0..m {
                middle += k[i][e] * (0.5 * (lo[e][j] + hi[e][j]));
                radius += k[i][e].abs() * (0.5 * (hi[e][j] - lo[e][j]));
                size += k[i][e].abs() * lo[e][j].abs().max(hi[e][j].abs());
            }
            row += f64::abs(middle) + radius + 32.0 * EPSILON * size;
        }
        let contracts = row < 0.999;
        if !contracts {
            return None;
        }
    }
    let graph = Graph { over, inverse: k, sign };
    let Tube {
        centre, slope, half, ..
    } = tube(layout, cell, mean, &graph);
    let misses = (0..m).any(|i| centre[i].abs() > 0.5 + 0.5 * slope[i].abs() + half[i]);
    Some((graph, misses))
}

/// The tube that contains the curve in a cell: each other variable is `centre + slope z ± half`, `z ∈ [−½, ½]` along the graph's variable, in sides of
/// the cell from its centre.
pub(crate) struct Tube {
    pub centre: Row,
    pub slope: Row,
    pub half: Row,
    /// The part of `half` that is due to errors of the coefficients: subdivision does not reduce it.
    pub noise: Row,
}

pub(crate) fn tube(layout: &Layout, cell: &Cell, mean: &Square, graph: &Graph) -> Tube {
    let (m, over) = (layout.m, graph.over);
    let affine = layout.affine(cell, *mean);
    let k = &graph.inverse;
    let mean = &affine.slope;
    let others = without(mean, over, m);
    let (mut centre, mut slope, mut half) = ([0.0; MAX_UNKNOWNS], [0.0; MAX_UNKNOWNS], [0.0; MAX_UNKNOWNS]);
    let mut noise = [0.0; MAX_UNKNOWNS];
    for i in 0..m {
        let mut size = 1.0;
        for e in 0..m {
            centre[i] -= k[i][e] * affine.constant[e];
            slope[i] -= k[i][e] * mean[e][over];
            size += k[i][e].abs() * (affine.constant[e].abs() + mean[e][over].abs());
            half[i] += k[i][e].abs() * affine.radius[e];
            noise[i] += k[i][e].abs() * layout.value_error(cell, e);
        }
        let mut rest = 0.0;
        for j in 0..m {
            let (mut entry, mut entries) = (if i == j { -1.0 } else { 0.0 }, 1.0);
            for e in 0..m {
                entry += k[i][e] * others[e][j];
                entries += (k[i][e] * others[e][j]).abs();
            }
            rest += 0.5 * (f64::abs(entry) + 16.0 * EPSILON * entries);
        }
        half[i] = (half[i] + rest) * (1.0 + 32.0 * EPSILON) + 32.0 * EPSILON * size;
        noise[i] += 64.0 * EPSILON * size;
    }
    Tube {
        centre,
        slope,
        half,
        noise,
    }
}
