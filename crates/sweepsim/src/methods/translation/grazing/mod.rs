//! Grazing curves of any patch: see `docs/algorithms/grazing-curves.md`.
//!
//! On moves without rotation, `g(u, v)` does not contain the time, so that `(p, g) = (p of the line, 0)` is a system of two equations in `(u, v)`. Cells in which the map `(p, g)` is
//! injective are found along the curve once for all moves of nearly the same direction, and divided only as far as lines ask for it.

mod chart;
mod directed_motion;
mod face;
mod knot;
mod lines;
mod newton;
mod span;
mod tree;
mod walk;

use crate::cutter::cells::Cells;
use crate::cutter::patch_forms::PatchForms;
use crate::methods::harvest::Collector;
use directed_motion::{DirectedMotion, Directions, Key};
use face::Face;
use lines::{Lines, Target};
use sweepsim_dexel::Source;
use sweepsim_motion::Segment;
use sweepsim_solve::Monitor;
use tree::Tree;
use walk::Walk;

/// The number of families of directions that are kept.
const FAMILIES: usize = 64;
/// The number of cells of all of them.
const CELLS: usize = 100_000;

/// What is kept of a tool from one move to the next.
#[derive(Debug, Default)]
pub(crate) struct Grazing {
    /// The latest one comes last.
    families: Vec<Family>,
    targets: Vec<Target>,
}

/// The cells of all patches, for directions that are almost the same.
#[derive(Debug)]
struct Family {
    key: Key,
    directions: Directions,
    trees: Vec<Option<Tree>>,
}

/// The patches of a tool.
pub(crate) struct Patches<'a> {
    pub forms: &'a [PatchForms],
    pub cells: &'a mut [Cells],
    /// Which of them are settled.
    pub done: &'a mut [bool],
}

/// A search of lines along one move.
pub(crate) struct Grazed<'a, 'b> {
    pub segment: &'a Segment,
    pub collector: &'a mut Collector<'b>,
    /// What is this high above the tip is above the ceiling at all times.
    pub highest: f64,
    /// The rounding error of coordinates.
    pub system_rounding: f64,
    /// Heights this close are the same.
    pub height_tolerance: f64,
    /// The longest last step of Newton's method.
    pub last: f64,
    pub monitor: &'a dyn Monitor,
}

impl Grazing {
    /// Forgets a patch: to be called when its cells are dropped.
    pub fn forget(&mut self, patch: usize) {
        for family in &mut self.families {
            family.trees[patch] = None;
        }
    }

    /// The number of the family of a motion, which is the last one then.
    fn family(&mut self, motion: &DirectedMotion, patches: usize) -> Option<&mut Family> {
        let (key, directions) = motion.family()?;
        if let Some(known) = self.families.iter().position(|family| family.key == key) {
            let family = self.families.remove(known);
            self.families.push(family);
        } else {
            let trees = self.families.iter().flat_map(|family| family.trees.iter().flatten());
            if trees.map(Tree::len).sum::<usize>() > CELLS {
                self.families.clear();
            }
            if self.families.len() == FAMILIES {
                self.families.remove(0);
            }
            self.families.push(Family {
                key,
                directions,
                trees: vec![None; patches],
            });
        }
        self.families.last_mut()
    }

    /// Settles the patches that are not done along a move without rotation, as far as that is possible.
    pub fn settle(&mut self, patches: Patches, grazed: &mut Grazed, source: &impl Fn(f64) -> Source) {
        let Patches { forms, cells, done } = patches;
        if done.iter().all(|done| *done) {
            return;
        }
        let Some(motion) = DirectedMotion::new(grazed.segment, grazed.system_rounding) else {
            return;
        };
        let mut targets = std::mem::take(&mut self.targets);
        let Some(family) = self.family(&motion, forms.len()) else {
            return;
        };
        let mut trimmed = Vec::new();
        for (number, (element, cells)) in forms.iter().zip(cells).enumerate() {
            if done[number] {
                continue;
            }
            let (mark, directions) = (grazed.collector.mark(), &family.directions);
            let tree = family.trees[number]
                .get_or_insert_with(|| Tree::new(element, cells, 0, directions, motion.system_rounding));
            let face = &Face::new(element, &motion.own);
            let of = (element, &mut *cells);
            done[number] = grazed.element(of, (face, &motion), (tree, directions), source, &mut targets);
            if !done[number] {
                grazed.collector.forget(mark);
            }
            if cells.trim() {
                trimmed.push(number);
            }
        }
        self.targets = targets;
        trimmed.into_iter().for_each(|number| self.forget(number));
    }
}

impl Grazed<'_, '_> {
    /// Settles one patch, and returns whether that was possible; otherwise what was found is of no use.
    fn element(
        &mut self,
        (element, cells): (&PatchForms, &mut Cells),
        (face, motion): (&Face, &DirectedMotion),
        (tree, directions): (&mut Tree, &Directions),
        source: &impl Fn(f64) -> Source,
        targets: &mut Vec<Target>,
    ) -> bool {
        let mut walk = Walk {
            element,
            cells,
            motion,
            highest: self.highest,
            monitor: self.monitor,
            looks: 0,
            own_looks: 0,
            visits: 0,
            lines: Lines {
                face,
                motion,
                collector: &mut *self.collector,
                source,
                height_tolerance: self.height_tolerance,
                last: self.last,
                evaluations: 0,
                targets: std::mem::take(targets),
            },
        };
        let outcome = walk.tree(tree, directions);
        let Walk { lines, looks, .. } = walk;
        *targets = lines.targets;
        let evaluations = lines.evaluations;
        let statistics = &mut self.collector.harvest.statistics;
        statistics.boxes += looks;
        statistics.evaluations += evaluations;
        outcome.is_ok()
    }
}
