//! The 1-D search on several threads. It goes breadth first until there are [`PARTS`] cells. No crossing lies on a face that two of them share but those already
//! found, so they are searched independently. Pieces are joined in the order of a depth-first search, so the result is that of one thread.

use super::subdivide::{FaceCrossing, GraphPiece, OpenCell, Search};
use super::trace::Tracer;
use super::{CurveSolver, Curves};
use crate::coefficients::Cell;
use crate::points::PointSolver;
use crate::search::{SolveError, SolveStatistics, Watch, spread};
use crate::{CancelOnly, Monitor, System};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// The number of cells that are searched independently: more than threads, since they differ in cost, but not so many that most pieces are traced before.
const PARTS: usize = 32;

/// A cell to be searched.
struct Waiting {
    cell: Cell,
    depth: u32,
    crossings: Vec<usize>,
    /// At each split from the root, whether it is in the upper part.
    path: Vec<bool>,
}

/// What was found in a cell.
struct CellFindings {
    path: Vec<bool>,
    /// New crossings, numbered after those known to all parts.
    crossings: Vec<FaceCrossing>,
    pieces: Vec<GraphPiece>,
    open: Vec<OpenCell>,
    statistics: SolveStatistics,
}

impl CurveSolver {
    /// As [`solve`](Self::solve), on the threads of the current rayon pool. The result is the same for any number of threads, and that of `solve`, unless a
    /// budget ends the search: [`vertices`](crate::SolveOptions::vertices) is divided among at most 32 parts of the search, and other budgets apply to each of them.
    /// [`time`](crate::SolveOptions::time) is that of the whole. The monitor [advances](Monitor::advance) by parts, and [visits](Monitor::visit) no boxes.
    ///
    /// ```
    /// use sweepsim_solve::{CurveSolver, Enclosure, System};
    ///
    /// let domain = [Enclosure::new(-2.0, 2.0)?; 2];
    /// let system = System::parse(&["x^2 + y^2 = 1"], &["x", "y"], &domain)?;
    /// let mut solver = CurveSolver::new(1e-6);
    /// assert_eq!(solver.solve_parallel(&system, &())?.curves, solver.solve(&system, &())?.curves);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`solve`](Self::solve).
    pub fn solve_parallel(&mut self, system: &System, monitor: &dyn Monitor) -> Result<Curves, SolveError> {
        self.check(system)?;
        let (shape, tolerance) = (self.shape, self.tolerance);
        let cancel = CancelOnly(monitor);
        let mut search = self.search(system, &cancel);
        let (root, first, skin) = search.boundary(&cancel);
        let (waiting, mut parts) = breadth_first(&mut search, root, first, &cancel);
        let known = search.crossings.len();
        let (done, total) = (AtomicUsize::new(0), waiting.len());
        let room = search.tracer.room / total.max(1);
        let (options, face, deadline) = (search.options.clone(), search.points.options.clone(), search.deadline);
        let crossings = &search.crossings;
        let searched = spread(true, waiting, |next: Waiting| {
            let left = deadline.map(|d| d.saturating_duration_since(Instant::now()));
            let options = options.clone().time(left).vertices(room);
            let mut points = PointSolver::new(face.clone());
            let mut part = Search {
                system,
                tracer: Tracer::new(system, (tolerance, shape), &options, &cancel),
                options,
                points: &mut points,
                crossings: crossings.clone(),
                pieces: Vec::new(),
                open: Vec::new(),
                statistics: SolveStatistics::default(),
                ranges: crate::coefficients::PartRanges::default(),
                deadline,
            };
            part.run((next.cell, next.depth), next.crossings, &cancel, &mut |_, _| {});
            monitor.advance(done.fetch_add(1, Ordering::Relaxed) + 1, total);
            CellFindings {
                path: next.path,
                crossings: part.crossings.split_off(known),
                pieces: part.pieces,
                open: part.open,
                statistics: part.statistics,
            }
        });
        parts.extend(searched);
        // Below before above, as a depth-first search goes.
        parts.sort_by(|a, b| a.path.cmp(&b.path));
        for part in parts {
            let by = search.crossings.len() - known;
            let number = |c: usize| if c < known { c } else { c + by };
            search.crossings.extend(part.crossings);
            search.pieces.extend(part.pieces.into_iter().map(|piece| GraphPiece {
                ends: piece.ends.map(number),
                trace: piece.trace,
            }));
            search.open.extend(part.open.into_iter().map(|mut cell| {
                cell.crossings.iter_mut().for_each(|c| *c = number(*c));
                cell
            }));
            search.statistics.merge(&part.statistics);
        }
        Ok(search.assemble(skin))
    }
}

/// Searches breadth first; what is left to be searched, and what was found.
fn breadth_first(
    search: &mut Search<'_>,
    root: Cell,
    first: Vec<usize>,
    monitor: &dyn Monitor,
) -> (Vec<Waiting>, Vec<CellFindings>) {
    let mut watch = Watch::new(&search.options);
    let mut lower = Cell::default();
    let mut parts = Vec::new();
    // Open boxes on the region's own faces.
    collect(search, Vec::new(), &mut parts);
    let mut waiting = VecDeque::from([Waiting {
        cell: root,
        depth: 0,
        crossings: first,
        path: Vec::new(),
    }]);
    while waiting.len() < PARTS {
        let Some(mut next) = waiting.pop_front() else { break };
        if let Some(cause) = search.stop(&mut watch, monitor) {
            search.leave(&next.cell, next.crossings, cause);
            collect(search, next.path, &mut parts);
            for rest in std::mem::take(&mut waiting) {
                search.leave(&rest.cell, rest.crossings, cause);
                collect(search, rest.path, &mut parts);
            }
            break;
        }
        let (_, children) = search.visit(&mut next.cell, &mut lower, next.depth, next.crossings, monitor);
        if let Some((below, above)) = children {
            for (cell, crossings, upper) in [(lower.clone(), below, false), (next.cell, above, true)] {
                let mut path = next.path.clone();
                path.push(upper);
                waiting.push_back(Waiting {
                    cell,
                    depth: next.depth + 1,
                    crossings,
                    path,
                });
            }
        } else {
            collect(search, next.path, &mut parts);
        }
    }
    (waiting.into(), parts)
}

/// Moves what the search found to a part of its own.
fn collect(search: &mut Search<'_>, path: Vec<bool>, parts: &mut Vec<CellFindings>) {
    let (pieces, open) = (std::mem::take(&mut search.pieces), std::mem::take(&mut search.open));
    parts.push(CellFindings {
        path,
        crossings: Vec::new(),
        pieces,
        open,
        statistics: SolveStatistics::default(),
    });
}
