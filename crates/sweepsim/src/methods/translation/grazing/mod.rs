//! Grazing curves of any patch: see `docs/algorithms/translations.md`.
//!
//! `g(u, v)` does not contain the time, so that `(p, g) = (p of the line, 0)` is a system of two equations in `(u, v)`. Cells in which the map `(p, g)` is
//! injective are found along the curve once for all moves of nearly the same direction, and divided only as far as lines ask for it.

mod at_rest;
mod chart;
mod course;
mod face;
mod knot;
mod lines;
mod newton;
mod span;
mod tree;

use super::rows::meets;
use super::{Ceiling, Collector};
use crate::cutter::cells::Cells;
use crate::cutter::patch_forms::PatchForms;
use crate::envelope::{Near, OnPlaced, PlacedMap, Side, Size};
use crate::methods::harvest::unit;
use at_rest::{Finds, Search, Still, TooMany};
use course::{Course, Directions, Key};
use face::Face;
use lines::{Lines, Target};
use nalgebra::{Matrix3, Vector3};
use sweepsim_dexel::Source;
use sweepsim_motion::Segment;
use sweepsim_solve::Monitor;
use tree::{Known, Tree};

/// The number of families of directions that are kept.
const FAMILIES: usize = 64;
/// The number of orientations that are kept.
const POSES: usize = 8;
/// The number of cells of all of them.
const CELLS: usize = 100_000;
/// A patch that takes more looks at cells along one move is left to charts.
const MOST: u64 = 20_000;
/// So is one that takes more looks at cells for its own direction alone, which no other move can use.
const MOST_OWN: u64 = 400;

/// What is kept of a tool from one move to the next.
#[derive(Debug, Default)]
pub(crate) struct Grazing {
    /// The latest one comes last.
    families: Vec<Family>,
    /// The same for orientations at rest.
    poses: Vec<(Matrix3<f64>, Vec<Option<Still>>)>,
    targets: Vec<Target>,
}

/// The cells of all patches, for directions that are almost the same.
#[derive(Debug)]
struct Family {
    key: Key,
    directions: Directions,
    trees: Vec<Option<Tree>>,
}

/// A search of lines along one move.
pub(crate) struct Grazed<'a, 'b> {
    pub segment: &'a Segment,
    pub collector: &'a mut Collector<'b>,
    pub ceiling: Option<&'a Ceiling>,
    /// The rounding error of coordinates.
    pub slack: f64,
    /// Heights this close are the same.
    pub near: f64,
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
        for (_, trees) in &mut self.poses {
            trees[patch] = None;
        }
    }

    /// The number of the family of a course, which is the last one then.
    fn family(&mut self, course: &Course, segment: &Segment, patches: usize) -> Option<&mut Family> {
        let (key, directions) = course.family(segment)?;
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
    pub fn settle(
        &mut self,
        (elements, cells): (&[PatchForms], &mut [Cells]),
        grazed: &mut Grazed,
        source: &impl Fn(f64) -> Source,
        done: &mut [bool],
    ) {
        if done.iter().all(|done| *done) {
            return;
        }
        let Some(course) = Course::new(grazed.segment, grazed.slack) else {
            return;
        };
        let mut targets = std::mem::take(&mut self.targets);
        let Some(family) = self.family(&course, grazed.segment, elements.len()) else {
            return;
        };
        let spacing = grazed.collector.lines.spacing();
        let lowest = course.from[2].min(course.from[2] + course.way[2]);
        let highest = grazed
            .ceiling
            .map_or(f64::INFINITY, |ceiling| ceiling.above(lowest, spacing));
        let mut trimmed = Vec::new();
        for (number, (element, cells)) in elements.iter().zip(cells).enumerate() {
            if done[number] {
                continue;
            }
            let mark = grazed.collector.mark();
            let face = Face::new(element, &course.own);
            let mut walk = Walk {
                element,
                cells: &mut *cells,
                course: &course,
                highest,
                monitor: grazed.monitor,
                looks: 0,
                own_looks: 0,
                visits: 0,
                lines: Lines {
                    face: &face,
                    course: &course,
                    collector: &mut *grazed.collector,
                    source,
                    near: grazed.near,
                    last: grazed.last,
                    evaluations: 0,
                    targets,
                },
            };
            let tree = family.trees[number]
                .get_or_insert_with(|| Tree::new(element, walk.cells, 0, &family.directions, course.slack));
            let outcome = walk.tree(tree, &family.directions);
            let Walk { lines, looks, .. } = walk;
            let evaluations = lines.evaluations;
            targets = lines.targets;
            let statistics = &mut grazed.collector.harvest.statistics;
            statistics.boxes += looks;
            statistics.evaluations += evaluations;
            match outcome {
                Ok(()) => done[number] = true,
                Err(TooMany) => grazed.collector.forget(mark),
            }
            if cells.trim() {
                trimmed.push(number);
            }
        }
        self.targets = targets;
        trimmed.into_iter().for_each(|number| self.forget(number));
    }
}

/// A search of the lines of a tool at rest.
pub(crate) struct Resting<'a, 'b> {
    pub pose: (Matrix3<f64>, Vector3<f64>),
    /// The motions before and after.
    pub sides: [Side; 2],
    pub size: Size,
    pub collector: &'a mut Collector<'b>,
    /// The longest last step of Newton's method.
    pub last: f64,
    pub source: Source,
    pub monitor: &'a dyn Monitor,
}

/// Puts crossings of a patch at rest.
struct Rests<'a, 'b> {
    collector: &'a mut Collector<'b>,
    source: Source,
}

impl Finds for Rests<'_, '_> {
    fn found(&mut self, line: usize, from: [f64; 2], at: [f64; 2], seen: &OnPlaced, orientation: i8) {
        let negative = |side: Near<2>| i8::from(side.at(&at, &from) < 0.0);
        let change = negative(seen.after) - negative(seen.before);
        if change != 0 {
            let z = seen.height.at(&at, &from);
            let jump = -orientation * change;
            self.collector.crossing(line, z, jump, unit(seen.normal), self.source);
        }
    }

    fn open(&mut self, line: usize) {
        self.collector.open(line);
    }
}

impl Grazing {
    /// Settles the patches that are not done at rest between two moves without rotation, as far as that is possible.
    pub fn rest(&mut self, (elements, cells): (&[PatchForms], &mut [Cells]), resting: &mut Resting, done: &mut [bool]) {
        let (turn, tip) = resting.pose;
        if let Some(known) = self.poses.iter().position(|(other, _)| *other == turn) {
            let pose = self.poses.remove(known);
            self.poses.push(pose);
        } else {
            let trees = self.poses.iter().flat_map(|(_, trees)| trees.iter().flatten());
            if trees.map(Still::len).sum::<usize>() > CELLS || self.poses.len() == POSES {
                self.poses.clear();
            }
            self.poses.push((turn, vec![None; elements.len()]));
        }
        let Some((_, trees)) = self.poses.last_mut() else {
            return;
        };
        let mut trimmed = Vec::new();
        for (number, (element, cells)) in elements.iter().zip(cells).enumerate() {
            if done[number] {
                continue;
            }
            let lines = resting.collector.lines;
            let mark = resting.collector.mark();
            let mut search = Search {
                map: &mut PlacedMap::new(element, &mut *cells, resting.pose, resting.sides, resting.size),
                lines,
                tip: [tip.x, tip.y],
                last: resting.last,
                monitor: resting.monitor,
                looks: 0,
                evaluations: 0,
            };
            let mut rests = Rests {
                collector: &mut *resting.collector,
                source: resting.source,
            };
            let outcome = trees[number]
                .get_or_insert_with(Still::new)
                .walk(&mut search, &mut rests);
            let Search { looks, evaluations, .. } = search;
            let statistics = &mut resting.collector.harvest.statistics;
            statistics.boxes += looks;
            statistics.evaluations += evaluations;
            match outcome {
                Ok(()) => done[number] = true,
                Err(TooMany) => resting.collector.forget(mark),
            }
            if cells.trim() {
                trimmed.push(number);
            }
        }
        trimmed.into_iter().for_each(|number| self.forget(number));
    }
}

/// What comes next in a walk.
enum Next {
    Visit(u32),
    /// Release the cells made since.
    Release(usize),
}

/// The walk through the cells of one patch.
struct Walk<'a, 'b, S> {
    element: &'a PatchForms,
    cells: &'a mut Cells,
    course: &'a Course,
    /// Cells that are all this high above the tip are above the ceiling.
    highest: f64,
    monitor: &'a dyn Monitor,
    looks: u64,
    /// Of these, those for the direction alone.
    own_looks: u64,
    visits: u64,
    lines: Lines<'a, 'b, S>,
}

impl<S: Fn(f64) -> Source> Walk<'_, '_, S> {
    fn tree(&mut self, tree: &mut Tree, directions: &Directions) -> Result<(), TooMany> {
        let slack = self.course.slack;
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
            if node.lowest > self.highest || !meets(self.lines.collector.lines, &self.lines.floor(), window) {
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
            let known = tree.known(number, of, (directions, slack), &mut self.looks);
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
                    let own = &self.course.own;
                    let mut tree = Tree::new(self.element, self.cells, cell, own, slack);
                    self.tree(&mut tree, own)?;
                }
                Known::Least => self.lines.leave(window),
            }
        }
        Ok(())
    }
}
