//! Bicubic B-splines through the points of a sheet, with its derivatives.

use super::SweptSheet;
use nalgebra::Vector3;

/// Pieces along each parameter: at first, and at most.
const FEWEST: usize = 4;
const MOST: usize = 256;
/// How much farther than its face a spline goes on, in parts of the range.
const MARGIN: f64 = 0.01;
/// Derivatives are those of the surface, so distances are largest in the middle, and about there.
const COMPARED: [f64; 3] = [0.25, 0.5, 0.75];

/// The point at a pair of parameters and its derivatives by the first, the second and both.
type Jet = [Vector3<f64>; 4];

/// A bicubic B-spline with one derivative in common at its inner knots, each of which is double.
#[derive(Clone, Debug)]
pub(crate) struct TensorSpline {
    /// Where pieces begin and end along both parameters.
    pub knots: [Vec<f64>; 2],
    /// Control points, by the first parameter and then by the second.
    pub points: Vec<Vec<Vector3<f64>>>,
    /// The largest distance found from the sheet.
    pub off: f64,
}

impl TensorSpline {
    /// A spline over a range of parameters that is nowhere farther than `limit` from the sheet, by nine points of each
    /// piece; `None` if none is found.
    pub fn new(sheet: &SweptSheet, range: [[f64; 2]; 2], limit: f64) -> Option<Self> {
        let range = range.map(|[from, to]| {
            let room = MARGIN * (to - from);
            [from - room, to + room]
        });
        let mut counts = [FEWEST; 2];
        while counts.iter().all(|count| *count <= MOST) {
            let knots = [0, 1].map(|k: usize| evenly(range[k], counts[k]));
            let mut jets = Vec::with_capacity(knots[0].len());
            for u in &knots[0] {
                let row: Option<Vec<Jet>> = knots[1].iter().map(|v| sheet.jet([*u, *v])).collect();
                jets.push(row?);
            }
            // Along lines of knots first: they tell which parameter needs more.
            let [by_u, by_v] = [off(sheet, &knots, &jets, true)?, off(sheet, &knots, &jets, false)?];
            let worst = by_u.max(by_v);
            if worst <= 0.5 * limit {
                let within = inside(sheet, &knots, &jets)?;
                if within <= limit {
                    return Some(Self {
                        points: control(&knots, &jets),
                        knots,
                        off: within.max(worst),
                    });
                }
            }
            for (count, own) in counts.iter_mut().zip([by_u, by_v]) {
                if worst <= 0.5 * limit || own > 0.5 * limit {
                    *count = *count * 3 / 2;
                }
            }
        }
        None
    }
}

fn evenly([from, to]: [f64; 2], pieces: usize) -> Vec<f64> {
    (0..=pieces)
        .map(|k| from + (to - from) * k as f64 / pieces as f64)
        .collect()
}

/// The cubic between two points with derivatives, over a step.
fn cubic([a, da]: [Vector3<f64>; 2], [b, db]: [Vector3<f64>; 2], step: f64, w: f64) -> Vector3<f64> {
    let v = 1.0 - w;
    let (c, d) = (a + da * (step / 3.0), b - db * (step / 3.0));
    a * (v * v * v) + c * (3.0 * v * v * w) + d * (3.0 * v * w * w) + b * (w * w * w)
}

/// The largest distance along lines of knots, of the first parameter or of the second.
fn off(sheet: &SweptSheet, knots: &[Vec<f64>; 2], jets: &[Vec<Jet>], first: bool) -> Option<f64> {
    let mut most = 0.0_f64;
    let (along, across) = if first { (0, 1) } else { (1, 0) };
    let at = |i: usize, j: usize| if first { jets[i][j] } else { jets[j][i] };
    for j in 0..knots[across].len() {
        for i in 1..knots[along].len() {
            let (a, b) = (at(i - 1, j), at(i, j));
            let [from, to] = [knots[along][i - 1], knots[along][i]];
            let by = 1 + along;
            let p = cubic([a[0], a[by]], [b[0], b[by]], to - from, 0.5);
            let mut uv = [0.0; 2];
            (uv[along], uv[across]) = (0.5 * (from + to), knots[across][j]);
            most = most.max((p - sheet.place(uv)?).norm());
        }
    }
    Some(most)
}

/// The largest distance inside the pieces.
fn inside(sheet: &SweptSheet, knots: &[Vec<f64>; 2], jets: &[Vec<Jet>]) -> Option<f64> {
    let mut most = 0.0_f64;
    for i in 1..knots[0].len() {
        for j in 1..knots[1].len() {
            let [u, v] = [knots[0][i - 1], knots[1][j - 1]];
            let [du, dv] = [knots[0][i] - u, knots[1][j] - v];
            for x in COMPARED {
                // Of the curve at this part of the first parameter, both ends with the derivative by the second.
                let end = |j: usize| {
                    let [a, b] = [jets[i - 1][j], jets[i][j]];
                    [0, 2].map(|of| cubic([a[of], a[of + 1]], [b[of], b[of + 1]], du, x))
                };
                let [from, to] = [end(j - 1), end(j)];
                for y in COMPARED {
                    let p = cubic(from, to, dv, y);
                    most = most.max((p - sheet.place([u + x * du, v + y * dv])?).norm());
                }
            }
        }
    }
    Some(most)
}

/// The steps from each knot to the control points beside it.
fn beside(knots: &[f64]) -> Vec<[f64; 2]> {
    let last = knots.len() - 1;
    (0..=last)
        .map(|k| {
            let before = if k == 0 { 0.0 } else { (knots[k - 1] - knots[k]) / 3.0 };
            let after = if k == last {
                0.0
            } else {
                (knots[k + 1] - knots[k]) / 3.0
            };
            [before, after]
        })
        .collect()
}

fn control(knots: &[Vec<f64>; 2], jets: &[Vec<Jet>]) -> Vec<Vec<Vector3<f64>>> {
    let steps = [beside(&knots[0]), beside(&knots[1])];
    let mut rows = Vec::with_capacity(2 * knots[0].len());
    for (own, us) in jets.iter().zip(&steps[0]) {
        for x in us {
            let row = own
                .iter()
                .zip(&steps[1])
                .flat_map(|([p, by_u, by_v, by_both], vs)| vs.map(|y| p + by_u * *x + by_v * y + by_both * (x * y)));
            rows.push(row.collect());
        }
    }
    rows
}
