//! Crossings are counted into intervals, audited, and repaired.

use crate::error::SweepError;
use crate::methods::harvest::{Harvest, Numbered};
use crate::methods::workspace::Workspace;
use crate::sweep::boundary_operator::{self, BoundaryOperator};
use crate::sweep::report::{Statistics, UnresolvedDexel, UnresolvedReason};
use crate::sweep::schedule::SweepJob;
use crate::time::path_parts::PathPart;
use crate::tolerances::Tolerances;
use rayon::prelude::*;
use sweepsim_dexel::{AuditFailure, Crossing, Dexels, Interval, IntervalSet, Operation, cover};
use sweepsim_solve::Cause;

impl SweepJob<'_> {
    /// Counts the crossings of a chunk into intervals, repairs lines that do not add up, and unites the intervals with the volume.
    pub fn count(
        &self,
        chunk: &[PathPart],
        harvest: Harvest,
        volume: &mut Dexels,
        statistics: &mut Statistics,
        failed: &mut Vec<UnresolvedDexel>,
    ) -> Result<(), SweepError> {
        let Harvest {
            mut crossings,
            mut open,
            ..
        } = harvest;
        open.sort_by_key(|(line, _)| *line);
        let mut bad: Vec<u32> = open.iter().map(|(line, _)| *line).collect();
        bad.dedup();
        if !bad.is_empty() {
            crossings.retain(|(line, _)| bad.binary_search(line).is_err());
        }
        let mut wrong: Vec<u32> = match self.boundary {
            BoundaryOperator::Coverage => {
                let same = self.tolerances.same_height();
                let failures = volume.update_by_crossings(Operation::Union, &crossings, same);
                failures.into_iter().map(|(line, _)| line).collect()
            }
            BoundaryOperator::Paper => {
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
        wrong.extend(&bad);
        wrong.sort_unstable();
        wrong.dedup();
        let repaired: Vec<Result<Vec<Interval>, UnresolvedReason>> = wrong
            .par_iter()
            .map(|line| self.with_space(|space| self.repair(chunk, *line, 1, space)))
            .collect();
        if self.monitor.cancelled() {
            return Err(SweepError::Cancelled);
        }
        for (line, result) in wrong.into_iter().zip(repaired) {
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

    /// Solves one line, from the given attempt on displaced farther each time, until its audit closes.
    pub fn repair(
        &self,
        chunk: &[PathPart],
        line: u32,
        first: usize,
        space: &mut Workspace,
    ) -> Result<Vec<Interval>, UnresolvedReason> {
        let mut reason = UnresolvedReason::Budget;
        for attempt in first..=Tolerances::REPAIRS {
            if self.monitor.cancelled() {
                break;
            }
            let mut harvest = Harvest::default();
            self.line(chunk, line as usize, attempt, space, &mut harvest);
            if let Some((_, why)) = harvest.open.first() {
                reason = match why {
                    Cause::Boxes => UnresolvedReason::Budget,
                    _ => UnresolvedReason::SmallestBox,
                };
                continue;
            }
            match self.intervals(&harvest.crossings) {
                Ok(intervals) => return Ok(intervals),
                Err(failure) => reason = UnresolvedReason::Audit(failure),
            }
        }
        Err(reason)
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
