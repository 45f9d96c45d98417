//! Crossings are counted into intervals, audited, and repaired.

use crate::error::SweepError;
use crate::methods::harvest::{Gathered, Harvest, Numbered};
use crate::methods::workspace::Workspace;
use crate::sweep::boundary_operator::{self, BoundaryOperator};
use crate::sweep::report::{Statistics, UnresolvedDexel, UnresolvedReason};
use crate::sweep::schedule::SweepJob;
use crate::time::path_parts::PathPart;
use crate::tolerances::Tolerances;
use rayon::prelude::*;
use std::collections::BTreeMap;
use sweepsim_dexel::{AuditFailure, Crossing, Dexels, Interval, IntervalSet, Operation, cover};
use sweepsim_solve::Cause;

/// Lines that share the budget of repairs, at least.
const FEW: usize = 64;

/// Swept intervals of some lines, sorted by line, and the lines that stayed unresolved.
#[derive(Clone, Debug, Default)]
pub(crate) struct SweptLines {
    pub lines: Vec<(u32, Vec<Interval>)>,
    pub unresolved: Vec<UnresolvedDexel>,
    /// The number of crossings.
    pub crossings: u64,
}

impl SweptLines {
    /// Both together.
    pub fn united(self, other: Self) -> Self {
        let unresolved = [self.unresolved, other.unresolved].concat();
        let crossings = self.crossings + other.crossings;
        if self.lines.is_empty() {
            let lines = other.lines;
            return Self {
                lines,
                unresolved,
                crossings,
            };
        }
        let mut all: BTreeMap<u32, Vec<Interval>> = self.lines.into_iter().collect();
        for (line, more) in other.lines {
            let own = all.entry(line).or_default();
            own.extend(more);
            if let Ok(set) = IntervalSet::from_intervals(own.iter().copied()) {
                *own = set.pieces().to_vec();
            }
        }
        Self {
            lines: all.into_iter().collect(),
            unresolved,
            crossings,
        }
    }
}

impl SweepJob<'_> {
    /// The swept intervals of the lines that have any, counted, audited, and repaired where they do not add up. For few lines of a large grid, where
    /// [`count`](Self::count) would visit all.
    pub fn swept_lines(&self, chunk: &[PathPart]) -> Result<SweptLines, SweepError> {
        let Gathered {
            crossings: lists,
            mut open,
            ..
        } = self.harvest(chunk)?;
        let mut crossings = lists.concat();
        self.reuse(lists);
        open.sort_by_key(|(line, _)| *line);
        open.dedup_by_key(|(line, _)| *line);
        // A stable sort: the order of crossings on a line does not depend on threads.
        crossings.par_sort_by_key(|(line, _)| *line);
        // A line with an open box may have no crossing at all.
        let missing = |line: &u32| crossings.binary_search_by_key(line, |(line, _)| *line).is_err();
        let lonely: Vec<u32> = open.iter().map(|(line, _)| *line).filter(missing).collect();
        // How many fail their audit is not known yet: few, if they were asked for one by one.
        let most = self.repairs.of_each(open.len().max(FEW));
        let solve = |line: u32, group: &[Numbered]| {
            let certain = open.binary_search_by_key(&line, |(line, _)| *line).is_err();
            let counted = certain.then(|| self.intervals(group).ok()).flatten();
            let found = match counted {
                Some(intervals) => Ok(intervals),
                None => self.with_space(|space| self.repair(chunk, line, (1, most), space).0),
            };
            (line, found)
        };
        let mut solved: Vec<_> = crossings
            .par_chunk_by(|a, b| a.0 == b.0)
            .map(|group| solve(group[0].0, group))
            .collect();
        solved.extend(lonely.into_iter().map(|line| solve(line, &[])));
        solved.sort_by_key(|(line, _)| *line);
        if self.monitor.cancelled() {
            return Err(SweepError::Cancelled);
        }
        let mut swept = SweptLines {
            crossings: crossings.len() as u64,
            ..SweptLines::default()
        };
        for (line, found) in solved {
            match found {
                Ok(intervals) if intervals.is_empty() => {}
                Ok(intervals) => swept.lines.push((line, intervals)),
                Err(reason) => {
                    let (i, j) = self.grid.place(line as usize);
                    swept.unresolved.push(UnresolvedDexel { i, j, reason });
                }
            }
        }
        Ok(swept)
    }

    /// Counts the crossings of a chunk into intervals, repairs lines that do not add up, and unites the intervals with the volume.
    pub fn count(
        &self,
        chunk: &[PathPart],
        harvest: Gathered,
        volume: &mut Dexels,
        statistics: &mut Statistics,
        failed: &mut Vec<UnresolvedDexel>,
    ) -> Result<(), SweepError> {
        let Gathered {
            crossings: lists,
            mut open,
            ..
        } = harvest;
        open.sort_by_key(|(line, _)| *line);
        let mut bad: Vec<u32> = open.iter().map(|(line, _)| *line).collect();
        bad.dedup();
        let mut wrong: Vec<u32> = match self.boundary {
            BoundaryOperator::Coverage => {
                let same = self.tolerances.same_height();
                let slices: Vec<&[Numbered]> = lists.iter().map(Vec::as_slice).collect();
                let failures = volume.update_by_lists(Operation::Union, &slices, &bad, same);
                failures.into_iter().map(|(line, _)| line).collect()
            }
            BoundaryOperator::Paper => {
                let mut crossings = lists.concat();
                crossings.retain(|(line, _)| bad.binary_search(line).is_err());
                crossings.sort_by_key(|(line, _)| *line);
                let mut wrong = Vec::new();
                for group in crossings.chunk_by(|a, b| a.0 == b.0) {
                    let mut line: Vec<_> = group.iter().map(|(_, crossing)| *crossing).collect();
                    if volume.unite(group[0].0 as usize, &in_order(&mut line)).is_err() {
                        wrong.push(group[0].0);
                    }
                }
                wrong
            }
        };
        self.reuse(lists);
        wrong.extend(&bad);
        wrong.sort_unstable();
        wrong.dedup();
        let most = self.repairs.of_each(wrong.len());
        let repaired: Vec<(Result<Vec<Interval>, UnresolvedReason>, u64)> = wrong
            .par_iter()
            .with_max_len(1)
            .map(|line| self.with_space(|space| self.repair(chunk, *line, (1, most), space)))
            .collect();
        let boxes = repaired.iter().map(|(_, boxes)| boxes).sum();
        self.repairs.spend(boxes);
        statistics.boxes += boxes;
        if self.monitor.cancelled() {
            return Err(SweepError::Cancelled);
        }
        for (line, (result, _)) in wrong.into_iter().zip(repaired) {
            let united = result.and_then(|intervals| Ok(volume.unite(line as usize, &intervals)?));
            match united {
                Ok(()) => statistics.repaired += 1,
                Err(reason) => {
                    let (i, j) = self.grid.place(line as usize);
                    failed.push(UnresolvedDexel { i, j, reason });
                }
            }
        }
        Ok(())
    }

    /// Solves one line, from the given attempt on displaced farther each time, until its audit closes or the search has examined about as many boxes as it
    /// may. Also the number of boxes.
    pub fn repair(
        &self,
        chunk: &[PathPart],
        line: u32,
        (first, most): (usize, u64),
        space: &mut Workspace,
    ) -> (Result<Vec<Interval>, UnresolvedReason>, u64) {
        let (mut reason, mut boxes) = (UnresolvedReason::Budget, 0);
        for attempt in first..=Tolerances::REPAIRS {
            if self.monitor.cancelled() || boxes > most {
                break;
            }
            let mut harvest = Harvest::default();
            self.line(chunk, line as usize, (attempt, most - boxes), space, &mut harvest);
            boxes += harvest.statistics.boxes;
            if let Some((_, why)) = harvest.open.first() {
                reason = match why {
                    Cause::Boxes => UnresolvedReason::Budget,
                    _ => UnresolvedReason::SmallestBox,
                };
                continue;
            }
            match self.intervals(&harvest.crossings) {
                Ok(intervals) => return (Ok(intervals), boxes),
                Err(failure) => reason = UnresolvedReason::Audit(failure),
            }
        }
        (Err(reason), boxes)
    }

    /// The intervals of one line.
    fn intervals(&self, group: &[Numbered]) -> Result<Vec<Interval>, AuditFailure> {
        let mut crossings: Vec<_> = group.iter().map(|(_, crossing)| *crossing).collect();
        match self.boundary {
            BoundaryOperator::Coverage => {
                let mut intervals = Vec::new();
                cover(&mut crossings, self.tolerances.same_height(), &mut intervals)?;
                Ok(intervals)
            }
            BoundaryOperator::Paper => Ok(in_order(&mut crossings)),
        }
    }
}

/// The intervals that Algorithm 2 makes of the crossings of a line, with overlapping ones united. Where crossings are missing, some may have zero
/// length.
fn in_order(crossings: &mut [Crossing]) -> Vec<Interval> {
    let intervals = boundary_operator::by_normals(crossings).into_iter();
    IntervalSet::from_intervals(intervals.filter(|interval| interval.lower.z < interval.upper.z))
        .map(|set| set.pieces().to_vec())
        .unwrap_or_default()
}
