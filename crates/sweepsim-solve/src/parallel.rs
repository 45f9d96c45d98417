//! The 0-D search on several threads. What is found depends neither on their number nor on who finishes first: the search goes breadth
//! first until there are [`PARTS`] boxes, which are searched apart, and their results are joined in the boxes' order.

use crate::System;
use crate::layout::Cell;
use crate::points::{PointSolver, Points, SolveError, pop};
use crate::search::{Observer, SolveStatistics, Watch};
use rayon::prelude::*;
use std::collections::VecDeque;

/// Boxes that are searched apart: many more than threads, since they differ in cost.
const PARTS: usize = 128;

/// Asks a shared function whether to go on.
struct Shared<'a, F>(&'a F);

impl<F: Fn(&SolveStatistics) -> bool> Observer for Shared<'_, F> {
    fn proceed(&mut self, statistics: &SolveStatistics) -> bool {
        (self.0)(statistics)
    }
}

impl PointSolver {
    /// As [`solve`](Self::solve), on the threads of the current rayon pool. The result is the same for any number of threads (unless
    /// [`SolveOptions::time`](crate::SolveOptions::time) is set or `proceed` stops it); it may differ from `solve`'s in the last digits, and in how boxes that stay
    /// open are cut. Budgets hold for each of at most 128 parts of the search, and `proceed` gets the counts of one part.
    ///
    /// ```
    /// use sweepsim_solve::{Interval, PointSolver, System};
    /// use sweepsim_spline::Bernstein;
    ///
    /// let x = Bernstein::from_fn(&[3], |i| [1.0, -2.0, 2.0, -1.0][i[0]])?;
    /// let system = System::new(&[Interval::new(0.0, 1.0)], [&x])?;
    /// let points = PointSolver::default().solve_parallel(&system, |_| true)?;
    /// assert_eq!(points.roots.len(), 3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`solve`](Self::solve).
    pub fn solve_parallel(
        &mut self,
        system: &System,
        proceed: impl Fn(&SolveStatistics) -> bool + Sync,
    ) -> Result<Points, SolveError> {
        self.check(system)?;
        self.restart();
        let layout = &system.layout;
        let mut watch = Watch::new(&self.options);
        let mut waiting: VecDeque<(Cell, u32)> = VecDeque::from([(system.root(), 0)]);
        while waiting.len() < PARTS {
            let Some((cell, depth)) = waiting.pop_front() else {
                break;
            };
            self.cell = cell;
            let stop = watch.stop(&self.options, &self.statistics, self.open.len(), &mut Shared(&proceed));
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
        let parts: Vec<Self> = waiting
            .into_par_iter()
            .map(|(cell, depth)| {
                let mut part = Self::new(self.options.clone());
                part.search(system, &cell, depth, &mut Shared(&proceed));
                part
            })
            .collect();
        for part in parts {
            self.found.extend(part.found);
            self.open.extend(part.open);
            self.statistics.merge(&part.statistics);
        }
        self.finish(layout.n);
        Ok(self.points(system))
    }
}
