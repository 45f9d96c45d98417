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
use sweepsim_dexel::{AuditFailure, Crossing, Dexels, Interval, IntervalSet, Operation, cover};
use sweepsim_solve::Cause;

/// Lines that share the budget of repairs, at least.
const FEW: usize = 64;
/// Lines that are solved again by one search, at most.
const TOGETHER: usize = 64;

/// Swept intervals of some lines, sorted by line, and the lines that stayed unresolved.
#[derive(Clone, Debug, Default)]
pub struct SweptLines {
    pub lines: Vec<(u32, Vec<Interval>)>,
    pub unresolved: Vec<UnresolvedDexel>,
    /// The number of crossings.
    pub crossings: u64,
}

impl SweptLines {
    /// All together: of two ends at the same height, that of the first is kept.
    pub fn united(all: Vec<Self>) -> Self {
        let several = all.iter().filter(|one| !one.lines.is_empty()).count() > 1;
        let mut whole = Self::default();
        for one in all {
            whole.lines.extend(one.lines);
            whole.unresolved.extend(one.unresolved);
            whole.crossings += one.crossings;
        }
        if several {
            // A stable sort: those of a line stay in their order.
            whole.lines.sort_by_key(|(line, _)| *line);
            whole.lines.dedup_by(|(line, more), (last, own)| {
                let same = line == last;
                if same {
                    own.append(more);
                    if let Ok(set) = IntervalSet::from_intervals(own.iter().copied()) {
                        *own = set.pieces().to_vec();
                    }
                }
                same
            });
        }
        whole
    }
}

/// The intervals of a line that was solved again.
type Repaired = Result<Vec<Interval>, UnresolvedReason>;

/// What a line is solved again with.
#[derive(Clone, Copy, Debug)]
pub struct Repair {
    /// The first attempt.
    pub attempt: usize,
    /// The number of boxes for all attempts.
    pub most: u64,
    /// Why it is unresolved without another one.
    pub reason: UnresolvedReason,
}

impl Repair {
    /// After the first search.
    pub const fn first(most: u64) -> Self {
        Self {
            attempt: 1,
            most,
            reason: UnresolvedReason::Budget,
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
        let crossings = by_line(&lists);
        self.reuse(lists);
        open.sort_by_key(|(line, _)| *line);
        open.dedup_by_key(|(line, _)| *line);
        // A line with an open box may have no crossing at all.
        let missing = |line: &u32| crossings.binary_search_by_key(line, |(line, _)| *line).is_err();
        let lonely: Vec<u32> = open.iter().map(|(line, _)| *line).filter(missing).collect();
        // How many fail their audit is not known yet: few, if they were asked for one by one.
        let most = self.repairs.of_each(open.len().max(FEW));
        let solve = |line: u32, group: &[Numbered], lists: &mut Lists| {
            let certain = open.binary_search_by_key(&line, |(line, _)| *line).is_err();
            let counted = certain.then(|| self.intervals(group, lists).ok()).flatten();
            let found = match counted {
                Some(intervals) => Ok(intervals),
                None => self.with_space(|space| self.repair(chunk, line, Repair::first(most), space).0),
            };
            (line, found)
        };
        let mut solved: Vec<_> = crossings
            .par_chunk_by(|a, b| a.0 == b.0)
            .map_init(Lists::default, |lists, group| solve(group[0].0, group, lists))
            .collect();
        solved.extend(lonely.into_iter().map(|line| solve(line, &[], &mut Lists::default())));
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
        let repaired: Vec<(Vec<Repaired>, u64)> = wrong
            .par_chunks(TOGETHER)
            .with_max_len(1)
            .map(|lines| self.repair_together(chunk, lines, most))
            .collect();
        let boxes = repaired.iter().map(|(_, boxes)| boxes).sum();
        self.repairs.spend(boxes);
        statistics.boxes += boxes;
        if self.monitor.cancelled() {
            return Err(SweepError::Cancelled);
        }
        let results = repaired.into_iter().flat_map(|(results, _)| results);
        for (line, result) in wrong.into_iter().zip(results) {
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

    /// Solves some lines again, displaced farther at each attempt: all that are left by one search, and one by one after a search that has used up a budget, which a single line
    /// may have done. Each may use as many boxes as if it were alone, but for its shares of common searches. Also the number of boxes.
    fn repair_together(&self, chunk: &[PathPart], lines: &[u32], most: u64) -> (Vec<Repaired>, u64) {
        let mut results: Vec<Repaired> = vec![Err(UnresolvedReason::Budget); lines.len()];
        let mut left: Vec<usize> = (0..lines.len()).collect();
        let (mut attempt, mut spent, mut share) = (1, 0, 0);
        while left.len() > 1 && attempt <= Tolerances::REPAIRS && !self.monitor.cancelled() {
            let own: Vec<u32> = left.iter().map(|at| lines[*at]).collect();
            let mut harvest = Harvest::default();
            // A single line that takes many boxes must not be at the expense of the others.
            let is_done = self.with_space(|space| self.again(chunk, &own, (attempt, most / 2), space, &mut harvest));
            spent += harvest.statistics.boxes;
            share += harvest.statistics.boxes / own.len() as u64;
            if !is_done || self.monitor.cancelled() {
                break;
            }
            let Harvest {
                mut crossings,
                mut open,
                ..
            } = harvest;
            crossings.sort_by_key(|(line, _)| *line);
            open.sort_by_key(|(line, _)| *line);
            left.retain(|at| {
                let line = lines[*at];
                let [from, to] = [0, 1].map(|after| crossings.partition_point(|(own, _)| *own < line + after));
                let why = open.binary_search_by_key(&line, |(own, _)| *own).map(|at| &open[at].1);
                results[*at] = self.judged(&crossings[from..to], why.ok());
                results[*at].is_err()
            });
            attempt += 1;
            if open.iter().any(|(_, why)| *why == Cause::Boxes) {
                break;
            }
        }
        let alone = left.par_iter().with_max_len(1).map(|at| {
            let next = Repair {
                attempt,
                most: most - share.min(most),
                reason: results[*at].as_ref().err().copied().unwrap_or(UnresolvedReason::Budget),
            };
            self.with_space(|space| self.repair(chunk, lines[*at], next, space))
        });
        let (found, boxes): (Vec<Repaired>, Vec<u64>) = alone.unzip();
        for (at, found) in left.into_iter().zip(found) {
            results[at] = found;
        }
        (results, spent + boxes.iter().sum::<u64>())
    }

    /// Solves one line, displaced farther at each attempt, until its audit closes or the search has examined about as many boxes as it may. Also the number of boxes.
    pub fn repair(
        &self,
        chunk: &[PathPart],
        line: u32,
        Repair { attempt, most, reason }: Repair,
        space: &mut Workspace,
    ) -> (Repaired, u64) {
        let (mut reason, mut boxes) = (reason, 0);
        for attempt in attempt..=Tolerances::REPAIRS {
            if self.monitor.cancelled() || boxes > most {
                break;
            }
            let mut harvest = Harvest::default();
            let is_done = self.again(chunk, &[line], (attempt, most - boxes), space, &mut harvest);
            boxes += harvest.statistics.boxes;
            let why = harvest.open.first().map(|(_, why)| why);
            match self.judged(&harvest.crossings, why.or((!is_done).then_some(&Cause::Boxes))) {
                Ok(intervals) => return (Ok(intervals), boxes),
                Err(why) => reason = why,
            }
        }
        (Err(reason), boxes)
    }

    /// The intervals of a line whose search is done, unless a box was left open.
    fn judged(&self, group: &[Numbered], open: Option<&Cause>) -> Repaired {
        match open {
            Some(Cause::Boxes) => Err(UnresolvedReason::Budget),
            Some(_) => Err(UnresolvedReason::SmallestBox),
            None => self
                .intervals(group, &mut Lists::default())
                .map_err(UnresolvedReason::Audit),
        }
    }

    /// The intervals of one line.
    fn intervals(&self, group: &[Numbered], lists: &mut Lists) -> Result<Vec<Interval>, AuditFailure> {
        let (crossings, intervals) = lists;
        crossings.clear();
        crossings.extend(group.iter().map(|(_, crossing)| *crossing));
        match self.boundary {
            BoundaryOperator::Coverage => {
                cover(crossings, self.tolerances.same_height(), intervals)?;
                Ok(intervals.clone())
            }
            BoundaryOperator::Paper => Ok(in_order(crossings)),
        }
    }
}

/// Memory for the crossings and the intervals of a line.
type Lists = (Vec<Crossing>, Vec<Interval>);

/// All crossings sorted by line, those of a line in the order of the lists, which does not depend on threads.
fn by_line(lists: &[Vec<Numbered>]) -> Vec<Numbered> {
    let all = lists.concat();
    // Numbers are sorted faster than crossings are.
    let mut order: Vec<u64> = (0_u64..)
        .zip(&all)
        .map(|(at, (line, _))| u64::from(*line) << 32 | at)
        .collect();
    order.par_sort_unstable();
    order
        .into_iter()
        .map(|key| all[(key & u64::from(u32::MAX)) as usize])
        .collect()
}

/// The intervals that Algorithm 2 makes of the crossings of a line, with overlapping ones united. Where crossings are missing, some may have zero
/// length.
fn in_order(crossings: &mut [Crossing]) -> Vec<Interval> {
    let intervals = boundary_operator::by_normals(crossings).into_iter();
    IntervalSet::from_intervals(intervals.filter(|interval| interval.lower.z < interval.upper.z))
        .map(|set| set.pieces().to_vec())
        .unwrap_or_default()
}
