//! Follows the trees of a certificate, and looks at each leaf.
//!
//! A tree is about some motions of a path and one of the convex solids that cover what moves. Its root is all of these
//! motions and the cube around the solid. A division of time is into both halves, of the list of motions or of one; one
//! of the cell is into its eight parts, without those that the box of what is swept misses. So the leaves cover all
//! times, and all of the cube, and nothing of the solid is outside of it.

use crate::cell::Cell;
use crate::leaf::{During, Near};
use crate::motion::Run;
use crate::surface::Surface;
use crate::vector::{MORE, V3, add, cross, norm_up, scaled, size, sub, unit};

/// Some motions of a path, or a part of one.
#[derive(Clone, Copy)]
enum When {
    Node(usize),
    Part { stretch: usize, times: [f64; 2] },
}

/// A leaf that does not hold.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Failed {
    /// The path and the move; of heights, nothing.
    pub place: Option<(usize, usize)>,
    /// Lower corner of the cell.
    pub low: [f64; 3],
    /// Upper corner of the cell.
    pub high: [f64; 3],
    /// Why.
    pub why: &'static str,
}

/// What a walk has found.
#[derive(Debug)]
pub(crate) struct Found {
    pub nodes: usize,
    /// The largest bound of all leaves that are bounded.
    pub bound: f64,
    pub failed: Vec<Failed>,
    pub failed_count: usize,
}

/// As many failures are described.
const MOST_FAILED: usize = 20;
/// Nothing is divided more often.
pub(crate) const DEEPEST: usize = 200;
/// Pieces are not divided farther in time.
const SHORTEST: f64 = 1e-12;

impl Found {
    pub fn nothing() -> Self {
        Self {
            nodes: 0,
            bound: f64::NEG_INFINITY,
            failed: Vec::new(),
            failed_count: 0,
        }
    }

    pub fn fail(&mut self, place: Option<(usize, usize)>, [low, high]: [V3; 2], why: &'static str) {
        self.failed_count += 1;
        if self.failed.len() < MOST_FAILED {
            self.failed.push(Failed { place, low, high, why });
        }
    }

    pub fn join(&mut self, other: Self) {
        self.nodes += other.nodes;
        self.bound = self.bound.max(other.bound);
        self.failed_count += other.failed_count;
        self.failed.extend(other.failed);
    }
}

/// Reads bytes.
pub(crate) struct Reader<'a>(pub &'a [u8]);

impl<'a> Reader<'a> {
    pub fn byte(&mut self) -> Option<u8> {
        self.bytes(1).map(|own| own[0])
    }

    /// Groups of seven bits, the lowest first.
    pub fn number(&mut self) -> Option<usize> {
        let mut number = 0_usize;
        for shift in (0..35).step_by(7) {
            let byte = self.byte()?;
            number |= usize::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Some(number);
            }
        }
        None
    }

    pub fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (own, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(own)
    }

    pub fn float(&mut self) -> Option<f64> {
        let bytes = self.bytes(4)?;
        Some(f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])))
    }
}

pub(crate) struct Walk<'a> {
    surface: &'a Surface,
    run: &'a Run<'a>,
    path: usize,
    reader: Reader<'a>,
    normals: Vec<V3>,
    /// No leaf may be deeper.
    most: f64,
    /// Added to all bounds.
    more: f64,
    found: Found,
}

impl<'a> Walk<'a> {
    /// `most`: no leaf may be deeper; `more`: is added to all bounds.
    pub fn new(surface: &'a Surface, run: &'a Run<'a>, path: usize, bytes: &'a [u8], [most, more]: [f64; 2]) -> Self {
        let (reader, normals, found) = (Reader(bytes), Vec::new(), Found::nothing());
        Self {
            surface,
            run,
            path,
            reader,
            normals,
            most,
            more,
            found,
        }
    }

    pub fn walked(mut self, root: &Cell) -> Found {
        let all = When::Node(self.run.nodes.len() - 1);
        if self.node(root, all, 0).is_none() {
            self.fail(root, all, "the tree ends early, or is none");
        } else if !self.reader.0.is_empty() {
            self.fail(root, all, "something comes after the tree");
        }
        self.found
    }

    /// `None` if the tree cannot be read.
    fn node(&mut self, cell: &Cell, when: When, depth: usize) -> Option<()> {
        self.found.nodes += 1;
        if depth > DEEPEST {
            return None;
        }
        match self.reader.byte()? {
            0 => {
                for half in self.halves(when)? {
                    self.node(cell, half, depth + 1)?;
                }
            }
            1 => {
                let reached = self.reader.byte()?;
                let far = if self.is_apart() { self.more - self.most } else { 0.0 };
                let missed = |centre: V3| matches!(when, When::Node(k) if self.run.nodes[k].misses(&centre, 0.5 * cell.half, far));
                let left_out = (0..8).filter(|octant| reached >> octant & 1 == 0);
                if !{ left_out }.all(|octant| cell.centre_of_child(octant).is_some_and(missed)) {
                    self.fail(cell, when, "a part of a cell is left out");
                }
                for octant in (0..8).filter(|octant| reached >> octant & 1 == 1) {
                    match cell.child(octant, self.surface) {
                        Ok(child) => self.node(child, when, depth + 1)?,
                        Err(why) => {
                            self.fail(cell, when, why);
                            return None;
                        }
                    }
                }
            }
            kind => {
                let count = match kind {
                    7 => usize::from(self.reader.byte()?),
                    _ => *NORMALS.get(usize::from(kind))?,
                };
                let normals: Vec<V3> = (0..count).map(|_| self.normal()).collect::<Option<_>>()?;
                match self.bound(cell, when, kind, &normals) {
                    None => self.fail(cell, when, REASONS[usize::from(kind)]),
                    Some(bound) => {
                        let bound = bound + self.more;
                        self.found.bound = self.found.bound.max(bound);
                        if !(bound <= self.most) {
                            self.fail(cell, when, "may be deeper, or nearer");
                        }
                    }
                }
            }
        }
        Some(())
    }

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

    fn normal(&mut self) -> Option<V3> {
        let normal = match self.reader.number()? {
            0 => unit(&[self.reader.float()?, self.reader.float()?, self.reader.float()?])?,
            1 => {
                let number = self.reader.number()?;
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

    fn fail(&mut self, cell: &Cell, when: When, why: &'static str) {
        let stretch = match when {
            When::Node(node) => self.run.nodes[node].first,
            When::Part { stretch, .. } => stretch,
        };
        let place = (self.path, self.run.stretches[stretch].number);
        self.found.fail(
            Some(place),
            [-1.0, 1.0].map(|side| cell.centre.map(|c| c + side * cell.half)),
            why,
        );
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
