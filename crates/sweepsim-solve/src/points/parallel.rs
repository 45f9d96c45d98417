//! The 0-D search on several threads. The result depends neither on their number nor on which finishes first: the search goes breadth
//! first until there are [`PARTS`] boxes, which are searched independently, and their results are joined in the order of the boxes.

use super::flood::COARSE;
use super::solver::Order;
use super::{PointSolver, Points};
use crate::coefficients::{Cell, pop};
use crate::search::{SolveError, Watch};
use crate::{CancelOnly, Monitor, System};
use rayon::prelude::*;
use std::collections::VecDeque;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The number of boxes that are searched independently: many more than threads, since they differ in cost.
const PARTS: usize = 128;

impl PointSolver {
    /// As [`solve`](Self::solve), on the threads of the current rayon pool. The result is the same for any number of threads, unless
    /// [`SolveOptions::time`](crate::SolveOptions::time) is set or the monitor cancels the search. It may differ from the result of `solve` in the
    /// last digits, and in how unresolved boxes are cut. Budgets of boxes apply to each of at most 128 parts of the search. The monitor
    /// [advances](Monitor::advance) by parts, and [visits](Monitor::visit) no boxes.
    ///
    /// ```
    /// use sweepsim_solve::{Bernstein, Enclosure, PointSolver, System};
    ///
    /// let x = Bernstein::from_fn(&[3], |i| [1.0, -2.0, 2.0, -1.0][i[0]])?;
    /// let system = System::new(&[Enclosure::UNIT], [&x])?;
    /// let points = PointSolver::default().solve_parallel(&system, &())?;
    /// assert_eq!(points.roots.len(), 3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`solve`](Self::solve).
    pub fn solve_parallel(&mut self, system: &System, monitor: &dyn Monitor) -> Result<Points, SolveError> {
        self.check(system)?;
        self.start_clock();
        self.restart();
        self.coarsest = COARSE;
        let layout = &system.layout;
        let mut watch = Watch::until(self.deadline);
        let mut waiting: VecDeque<(Cell, u32)> = VecDeque::from([(system.root(), 0)]);
        while waiting.len() < PARTS {
            let Some((cell, depth)) = waiting.pop_front() else {
                break;
            };
            self.cell = cell;
            let stop = watch.stop(&self.options, &self.statistics, 0, monitor);
            if let Some(cause) = stop {
                self.leave(cause);
                while let Some((cell, _)) = waiting.pop_front() {
                    self.cell = cell;
                    self.leave(cause);
                }
                break;
            }
            self.visit(system, depth);
            while let Some(depth) = self.depths.pop() {
                let mut cell = Cell::default();
                pop(&mut self.stack, &mut cell, layout);
                waiting.push_back((cell, depth));
            }
        }
        let deadline = self.deadline;
        let (done, total) = (AtomicUsize::new(0), waiting.len());
        let parts: Vec<Self> = waiting
            .into_par_iter()
            .with_max_len(1)
            .map(|(cell, depth)| {
                let mut part = Self::new(self.options.clone());
                (part.deadline, part.coarsest) = (deadline, COARSE);
                part.search(system, &cell, depth, &CancelOnly(monitor), Order::LargestInCrowds);
                monitor.advance(done.fetch_add(1, Ordering::Relaxed) + 1, total);
                part
            })
            .collect();
        for part in parts {
            self.found.extend(part.found);
            self.open.extend(part.open);
            self.statistics.merge(&part.statistics);
        }
        self.deadline = self.end;
        self.finish(system);
        Ok(self.points(system))
    }
}
