//! Trees about depths and distances.
//!
//! A tree is about some motions of a path and one of the convex solids that cover what moves. Its root is all of these
//! motions and the cube around the solid. A division of time is into both halves, of the list of motions or of one; one
//! of the cell is into its eight parts, without those that the box of what is swept misses. So the leaves cover all
//! times, and all of the cube, and nothing of the solid is outside of it.

mod cell;
mod leaf;

pub(crate) use cell::Cell;

use crate::motion::Run;
use crate::surface::Surface;
use crate::tree::{Checked, Place, Proof, Reader, Step, walked};
use crate::vector::{MORE, V3, add, cross, norm_up, scaled, size, sub, unit};
use leaf::{During, Near};

/// Pieces are not divided farther in time.
const SHORTEST: f64 = 1e-12;

/// Some motions of a path, or a part of one.
#[derive(Clone, Copy)]
pub(crate) enum When {
    Node(usize),
    Part { stretch: usize, times: [f64; 2] },
}

pub(crate) struct Walk<'a> {
    surface: &'a Surface,
    run: &'a Run<'a>,
    path: usize,
    normals: Vec<V3>,
    /// No leaf may be deeper.
    most: f64,
    /// Added to all bounds.
    more: f64,
}

/// Looks at a tree about a solid on its run. `most`: no leaf may be deeper; `more`: is added to all bounds.
pub(crate) fn depths(
    (root, surface): (&Cell, &Surface),
    (run, path): (&Run, usize),
    bytes: &[u8],
    [most, more]: [f64; 2],
) -> Checked {
    let all = When::Node(run.nodes.len() - 1);
    let normals = Vec::new();
    let walk = Walk {
        surface,
        run,
        path,
        normals,
        most,
        more,
    };
    walked(walk, &[(root, all)], bytes)
}

impl<'a> Proof for Walk<'a> {
    type Part = (&'a Cell, When);

    fn node(&mut self, part: &Self::Part, kind: u8, reader: &mut Reader, found: &mut Checked) -> Step<Self::Part> {
        let (cell, when) = *part;
        match kind {
            0 => Some(Ok(self.halves(when)?.map(|half| (cell, half)).to_vec())),
            1 => {
                let reached = reader.byte()?;
                let far = if self.is_apart() { self.more - self.most } else { 0.0 };
                let missed = |centre: V3| matches!(when, When::Node(k) if self.run.nodes[k].misses(&centre, 0.5 * cell.half, far));
                let left_out = (0..8).filter(|octant| reached >> octant & 1 == 0);
                if !{ left_out }.all(|octant| cell.centre_of_child(octant).is_some_and(missed)) {
                    let (place, around) = self.place(part);
                    found.fail(place, around, "a part of a cell is left out");
                }
                let reached = (0..8).filter(|octant| reached >> octant & 1 == 1);
                let child = |octant| Ok((cell.child(octant, self.surface)?, when));
                Some(reached.map(child).collect())
            }
            kind => {
                let count = match kind {
                    7 => usize::from(reader.byte()?),
                    _ => *NORMALS.get(usize::from(kind))?,
                };
                let normals: Vec<V3> = (0..count).map(|_| self.normal(reader)).collect::<Option<_>>()?;
                let Some(bound) = self.bound(cell, when, kind, &normals) else {
                    return Some(Err(REASONS[usize::from(kind)]));
                };
                let bound = bound + self.more;
                found.bound = found.bound.max(bound);
                Some((bound <= self.most).then(Vec::new).ok_or("may be deeper, or nearer"))
            }
        }
    }

    fn place(&self, (cell, when): &Self::Part) -> Place {
        let stretch = match *when {
            When::Node(node) => self.run.nodes[node].first,
            When::Part { stretch, .. } => stretch,
        };
        let around = [-1.0, 1.0].map(|side| cell.centre.map(|c| c + side * cell.half));
        (Some((self.path, self.run.stretches[stretch].number)), around)
    }
}

impl Walk<'_> {
    fn halves(&self, when: When) -> Option<[When; 2]> {
        let (stretch, times) = match when {
            When::Node(number) => {
                let node = &self.run.nodes[number];
                match node.halves {
                    Some(halves) => return Some(halves.map(When::Node)),
                    None => (node.first, [0.0, 1.0]),
                }
            }
            When::Part { stretch, times } => (stretch, times),
        };
        // Halves of halves of 1: exact.
        let [from, to] = times;
        let middle = 0.5 * (from + to);
        (to - from > SHORTEST).then(|| [[from, middle], [middle, to]].map(|times| When::Part { stretch, times }))
    }

    fn normal(&mut self, reader: &mut Reader) -> Option<V3> {
        let normal = match reader.number()? {
            0 => unit(&[reader.float()?, reader.float()?, reader.float()?])?,
            1 => {
                let number = reader.number()?;
                let [a, b, c] = self.surface.triangles.get(number)?;
                unit(&cross(&sub(b, a), &sub(c, a)))?
            }
            ago => *self.normals.get((self.normals.len() + 1).checked_sub(ago)?)?,
        };
        self.normals.push(normal);
        Some(normal)
    }

    /// Whether a distance is claimed. A depth of 0 is none, though it has to be shown with some room.
    fn is_apart(&self) -> bool {
        self.most < 0.0
    }

    /// No point is deeper, as far as the leaf says.
    fn bound(&self, cell: &Cell, when: When, kind: u8, normals: &[V3]) -> Option<f64> {
        // Whatever is said of it: nothing of the target is in the cell, or of its surface.
        let (is_clear, is_outside) = cell.is_clear();
        if is_outside || is_clear && self.is_apart() {
            return Some(f64::NEG_INFINITY);
        }
        if kind == 4 && !self.is_apart() {
            let depth = cell.depth_by_middle(self.surface);
            return depth.is_finite().then_some(depth.max(0.0));
        }
        let during = match when {
            When::Node(number) => During::Node(&self.run.nodes[number]),
            When::Part { stretch, times } => {
                let own = &self.run.stretches[stretch];
                let (ends, duration) = (times.map(|t| own.at(t)), times[1] - times[0]);
                // No point in the cell that is reached is farther from the tip; of distances, none of the solid.
                let middle = scaled(&add(&ends[0].tip, &ends[1].tip), 0.5);
                let far = norm_up(&sub(&middle, &cell.centre)) + 3_f64.sqrt() * cell.half * MORE;
                let far = far + own.travel(duration) + ends[0].tip_error + ends[1].tip_error;
                let far = if self.is_apart() {
                    f64::INFINITY
                } else {
                    far * MORE + 1e-12 * size(&cell.centre)
                };
                let bend = own.bend(self.run.body.reach.min(far), duration);
                During::Part {
                    ends,
                    still: own.keeps_axis(),
                    bend,
                }
            }
        };
        let (run, surface, apart) = (self.run, self.surface, self.is_apart());
        Near {
            run,
            during,
            cell,
            surface,
            most: self.most - self.more,
            apart,
        }
        .bound(kind, normals)
    }
}

/// How many normals a leaf has, by its kind; of the one above several planes, it says so itself.
const NORMALS: [usize; 9] = [0, 0, 0, 0, 0, 1, 1, 0, 2];
/// What is said of a leaf that does not hold.
const REASONS: [&str; 9] = [
    "",
    "",
    "the swept box does not miss the cell",
    "the cell may be near the surface, or inside",
    "the depth of the middle is not known",
    "no plane separates the solid from the cell",
    "the solid is not lifted out",
    "the solid is not lifted above the planes",
    "it is not between both planes",
];
