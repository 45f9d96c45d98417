//! A walk through the cells of a patch along one move: those with lines on their way are looked at, and divided where no move has asked for that before.

use super::directed_motion::{DirectedMotion, Directions};
use super::lines::Lines;
use super::tree::{Known, Tree};
use crate::cutter::cells::Cells;
use crate::cutter::patch_forms::PatchForms;
use sweepsim_dexel::Source;
use sweepsim_solve::Monitor;

/// An element that takes more looks at cells along one move is left to charts.
const MOST: u64 = 20_000;
/// So is one that takes more looks at cells for its own direction alone, which no other move can use.
const MOST_OWN: u64 = 400;

/// There are too many cells.
pub(super) struct TooMany;

/// What comes next in a walk.
enum Next {
    Visit(u32),
    /// Release the cells made since.
    Release(usize),
}

/// The walk through the cells of one patch.
pub(super) struct Walk<'a, 'b, S> {
    pub element: &'a PatchForms,
    pub cells: &'a mut Cells,
    pub motion: &'a DirectedMotion,
    /// Cells that are all this high above the tip are above the ceiling.
    pub highest: f64,
    pub monitor: &'a dyn Monitor,
    pub looks: u64,
    /// Of these, those for the direction alone.
    pub own_looks: u64,
    pub visits: u64,
    pub lines: Lines<'a, 'b, S>,
}

impl<S: Fn(f64) -> Source> Walk<'_, '_, S> {
    pub fn tree(&mut self, tree: &mut Tree, directions: &Directions) -> Result<(), TooMany> {
        let system_rounding = self.motion.system_rounding;
        let mut stack = vec![Next::Visit(0)];
        while let Some(next) = stack.pop() {
            let number = match next {
                Next::Visit(number) => number,
                Next::Release(mark) => {
                    self.cells.release(mark);
                    continue;
                }
            };
            let node = tree.node(number);
            let (cell, window) = (node.cell, self.lines.reach([node.p, node.q]));
            self.visits += 1;
            if node.lowest > self.highest || !self.motion.floor.meets(self.lines.collector.lines, window) {
                continue;
            }
            if self.monitor.cancelled() {
                return Ok(());
            }
            if self.visits > 4 * MOST || self.looks > MOST || self.own_looks > MOST_OWN {
                return Err(TooMany);
            }
            let of = (self.element, &mut *self.cells);
            let before = self.looks;
            let known = tree.known(number, of, (directions, system_rounding), &mut self.looks);
            if directions.spread == 0.0 {
                self.own_looks += self.looks - before;
            }
            match known {
                Known::Empty => {}
                Known::Chart(chart) => self.lines.chart(chart, window),
                Known::Parts(parts) => stack.extend(parts.into_iter().rev().map(Next::Visit)),
                Known::Rest(rest) => {
                    // Such cells are kept for a family. All that are made until it is visited again are its parts.
                    if directions.spread == 0.0 {
                        stack.push(Next::Release(tree.node(rest).cell as usize));
                    }
                    stack.push(Next::Visit(rest));
                }
                Known::Mixed => {
                    let own = &self.motion.own;
                    let mut tree = Tree::new(self.element, self.cells, cell, own, system_rounding);
                    self.tree(&mut tree, own)?;
                }
                Known::Least => self.lines.leave(window),
            }
        }
        Ok(())
    }
}
