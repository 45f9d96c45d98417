//! Where dexels leave open how the surface runs between two lines.

use super::edge::{Edge, Link, slopes};
use super::{Dexel, Field, end};
use crate::dexels::Dexels;
use crate::intervals::Interval;
use rayon::prelude::*;

/// The part of the difference of two slopes by which the height between two lines may miss their mean.
const BENT: f64 = 0.1;
/// How far packed normals, and ends within a tolerance, move a slope.
const BLUR: f64 = 3e-4;
/// Beside a wall a face is not followed along more than this slope.
const STEEP: f64 = 3.0;

/// Heights at which one of two neighbouring lines has material and the other has none, where no smooth face is known
/// that runs from one to the other: the surface is somewhere between them at each of these heights. Where two faces
/// meet at an edge, both ends may be as high. In the frame of the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The line with material there, and the one without.
    pub lines: [[f64; 2]; 2],
    /// Numbers of the squares on both sides of the edge between them; see `Field`.
    pub squares: [[usize; 2]; 2],
    /// The heights.
    pub heights: [f64; 2],
    /// How much higher and lower the faces that end at the step may run before they do.
    pub beyond: f64,
}

/// All steps between neighbouring lines, the empty lines around the grid included.
pub fn steps(dexels: &Dexels) -> Vec<Step> {
    let field = Field::new(dexels);
    let [columns, rows] = field.cells;
    let of_column = |si: usize| {
        let mut found = Vec::new();
        for sj in 0..=rows + 1 {
            for axis in 0..2 {
                if [si, sj][axis] <= field.cells[axis] {
                    between(&field, [si, sj], axis, &mut found);
                }
            }
        }
        found
    };
    (0..=columns + 1).into_par_iter().flat_map_iter(of_column).collect()
}

/// The steps between a line and the next along an axis.
fn between(field: &Field<'_>, s: [usize; 2], axis: usize, found: &mut Vec<Step>) {
    let [a, b] = field.edge_dexels(s, axis);
    if a.line.is_empty() && b.line.is_empty() {
        return;
    }
    let distance = field.spacing[axis];
    let edge = Edge::new(a.line, b.line, axis, distance);
    let known = |p: usize, q: usize| match edge.links[0][p] {
        // Where faces meet at an angle, the triangles round it.
        Link::None | Link::Crease(_) => false,
        Link::Smooth(other) => other == q && is_one_face([a.line, b.line], [p, q], axis, distance),
    };
    let slope = |line: &[Interval], e: usize| slopes(end(line, e), e % 2 == 1)[axis].abs().min(STEEP);
    // All ends of both lines, going up; between two of them, both lines have material or none, or one has.
    let mut ends: Vec<(f64, usize, usize)> = Vec::new();
    for (side, Dexel { line, .. }) in [a, b].into_iter().enumerate() {
        ends.extend((0..2 * line.len()).map(|e| (end(line, e).z, side, e)));
    }
    ends.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.2.cmp(&other.2)));
    let mut inside = [false; 2];
    for pair in ends.windows(2) {
        let [(low, side, e), (high, next, f)] = [pair[0], pair[1]];
        inside[side] = e % 2 == 0;
        let across = match (side, next) {
            (0, 1) => known(e, f),
            (1, 0) => known(f, e),
            _ => false,
        };
        let creased = match (side, next) {
            (0, 1) => edge.links[0][e] == Link::Crease(f),
            (1, 0) => edge.links[0][f] == Link::Crease(e),
            _ => false,
        };
        if inside[0] == inside[1] || across || (low == high && !creased) {
            continue;
        }
        let [below, above] = [(side, e), (next, f)].map(|(side, e)| slope([a, b][side].line, e));
        let back = if axis == 0 {
            [s[0], s[1].wrapping_sub(1)]
        } else {
            [s[0].wrapping_sub(1), s[1]]
        };
        found.push(Step {
            lines: if inside[0] { [a.at, b.at] } else { [b.at, a.at] },
            squares: [s, back],
            heights: [low, high],
            beyond: distance * below.max(above),
        });
    }
}

/// Whether the height from one end to the other is what the slopes at both say: on a smooth face it is their mean times
/// the distance, but for terms of third order.
fn is_one_face(lines: [&[Interval]; 2], [p, q]: [usize; 2], axis: usize, distance: f64) -> bool {
    let [a, b] =
        [(lines[0], p), (lines[1], q)].map(|(line, e)| (end(line, e).z, slopes(end(line, e), e % 2 == 1)[axis]));
    let miss = (b.0 - a.0) / distance - 0.5 * (a.1 + b.1);
    let steep = a.1.abs().max(b.1.abs());
    miss.abs() <= BENT * (a.1 - b.1).abs() + BLUR * (1.0 + steep * steep)
}
