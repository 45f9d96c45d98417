//! Follows the trees of a certificate, and looks at each leaf.
//!
//! A tree is about some moves of a path and one of the convex solids that cover its tool. Its root is all of
//! these moves and the cube around the target. A division of time is into both halves, of the list of pieces or
//! of one; one of the cell is into its eight parts, without those that the box of what is swept misses. So the
//! leaves cover all times, and all of the cube, and nothing of the target is outside of it.

use crate::cell::{Budget, Cell, NoCell};
use crate::leaf::{During, Near, lever};
use crate::motion::Run;
use crate::surface::Surface;
use crate::tree::{Reader, Tree};
use crate::vector::{V3, cross, sub, unit};

/// Some moves of a path, or a part of one of their pieces.
#[derive(Clone, Copy)]
enum When {
    Node(usize),
    Part { stretch: usize, times: [f64; 2] },
}

/// A leaf of a tree that does not hold.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Failed {
    /// The path.
    pub path: usize,
    /// The move, from 0.
    pub number: usize,
    /// Lower corner of the cell.
    pub low: [f64; 3],
    /// Upper corner of the cell.
    pub high: [f64; 3],
    /// Why.
    pub why: &'static str,
}

/// What a walk has found.
#[derive(Debug, Default)]
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
const DEEPEST: usize = 200;
/// Pieces are not divided farther in time.
const SHORTEST: f64 = 1e-12;

pub(crate) struct Walk<'a> {
    pub surface: &'a Surface,
    pub budget: &'a Budget,
    pub run: &'a Run<'a>,
    pub tree: &'a Tree<'a>,
    reader: Reader<'a>,
    normals: Vec<V3>,
    /// No leaf may be deeper.
    most: f64,
    /// Added to all bounds.
    more: f64,
    found: Found,
}

impl<'a> Walk<'a> {
    pub fn new(
        (surface, budget): (&'a Surface, &'a Budget),
        run: &'a Run<'a>,
        tree: &'a Tree<'a>,
        (most, more): (f64, f64),
    ) -> Self {
        Self {
            surface,
            budget,
            run,
            tree,
            reader: Reader(tree.bytes),
            normals: Vec::new(),
            most,
            more,
            found: Found::default(),
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
                let mask = self.reader.byte()?;
                for octant in 0..8 {
                    if mask >> octant & 1 == 1 {
                        match cell.child(octant, self.surface, self.budget) {
                            Ok(child) => self.node(child, when, depth + 1)?,
                            Err(NoCell::TooMany) => {
                                self.fail(cell, when, "more cells than are looked at");
                                return None;
                            }
                            Err(NoCell::TooSmall) => {
                                self.fail(cell, when, "a cell is too small");
                                return None;
                            }
                        }
                    } else {
                        let missed = |node: usize| {
                            let centre = cell.centre_of_child(octant)?;
                            Some(self.run.nodes[node].misses(&centre, 0.5 * cell.half))
                        };
                        let is_missed = matches!(when, When::Node(node) if missed(node) == Some(true));
                        if !is_missed {
                            self.fail(cell, when, "a part of a cell is left out");
                        }
                    }
                }
            }
            kind => {
                let normals = match kind {
                    2..=4 => 0,
                    5..=7 => 1,
                    8 | 10 => 2,
                    9 => 3,
                    _ => return None,
                };
                let normals: Vec<V3> = (0..normals).map(|_| self.normal()).collect::<Option<_>>()?;
                match self.bound(cell, when, kind, &normals) {
                    None => self.fail(cell, when, REASONS[usize::from(kind)]),
                    // Nothing of the solid is in the target here.
                    Some(f64::NEG_INFINITY) => {}
                    Some(bound) => {
                        let bound = (bound + self.more).max(0.0);
                        self.found.bound = self.found.bound.max(bound);
                        if !(bound <= self.most) {
                            self.fail(cell, when, "may be deeper");
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
            0 => {
                let bytes = self.reader.bytes(12)?;
                let number = |k: usize| f32::from_le_bytes([bytes[k], bytes[k + 1], bytes[k + 2], bytes[k + 3]]);
                unit(&[0, 4, 8].map(|k| f64::from(number(k))))?
            }
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

    /// No point is deeper, as far as the leaf says.
    fn bound(&self, cell: &Cell, when: When, kind: u8, normals: &[V3]) -> Option<f64> {
        // Whatever is said of it: nothing of the target is in the cell.
        if cell.is_clear() {
            return Some(f64::NEG_INFINITY);
        }
        if kind == 4 {
            let depth = cell.depth_by_middle(self.surface);
            return depth.is_finite().then_some(depth);
        }
        let during = match when {
            When::Node(number) => During::Node(&self.run.nodes[number]),
            When::Part { stretch, times } => {
                let own = &self.run.stretches[stretch];
                let (ends, duration) = (times.map(|t| own.at(t)), times[1] - times[0]);
                let lever = lever(self.run, cell, &ends, own.travel(duration));
                During::Part {
                    ends,
                    still: own.keeps_axis(),
                    bend: own.bend(lever, duration),
                }
            }
        };
        let near = Near {
            run: self.run,
            during,
            cell,
            surface: self.surface,
        };
        let nothing = |is_empty: bool| is_empty.then_some(f64::NEG_INFINITY);
        match (kind, normals) {
            (2, _) => nothing(near.missed()),
            // Said to be clear, and not.
            (3, _) => None,
            (5, [n]) => nothing(near.separated(n)),
            (6, [n]) => near.lifted(n, true),
            (7, [n]) => near.lifted(n, false),
            (8 | 9, _) => near.lifted_above(normals),
            (10, [n, m]) => near.slab(n, m),
            _ => None,
        }
    }

    fn fail(&mut self, cell: &Cell, when: When, why: &'static str) {
        self.found.failed_count += 1;
        if self.found.failed.len() == MOST_FAILED {
            return;
        }
        let (stretch, _) = match when {
            When::Node(node) => (self.run.nodes[node].first, 0.0),
            When::Part { stretch, times } => (stretch, times[0]),
        };
        self.found.failed.push(Failed {
            path: self.tree.path,
            number: self.run.stretches[stretch].number,
            low: cell.centre.map(|c| c - cell.half),
            high: cell.centre.map(|c| c + cell.half),
            why,
        });
    }
}

/// What is said of a leaf that does not hold, by its kind.
const REASONS: [&str; 11] = [
    "",
    "",
    "the swept box does not miss the cell",
    "the cell may be near the surface, or inside",
    "the depth of the middle is not known",
    "no plane separates the solid from the cell",
    "the cell is not lifted out",
    "the solid is not lifted out",
    "the solid is not lifted above both planes",
    "the solid is not lifted above the planes",
    "it is not between both planes",
];
