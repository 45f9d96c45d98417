//! The work of a sweep, shared out among threads: which lines meet which parts of the path.

use crate::cutter::Cutter;
use crate::envelope::Size;
use crate::methods::lattice::Lattice;
use crate::methods::lines::Bundles;
use crate::methods::search::{Forms, Harvest, How, Search, Workspace};
use crate::sweep::boundary_operator::Boundary;
use crate::sweep::options::{Method, Options};
use crate::sweep::plan::Plan;
use crate::sweep::report::{Monitor, SweepError};
use crate::time::path_parts::{self, PathPart};
use rayon::prelude::*;
use std::sync::Mutex;
use sweepsim_dexel::Grid;
use sweepsim_motion::Tool;

/// Segments whose crossings are counted together. Longer chunks save caps, shorter ones memory.
pub(super) const CHUNK: usize = 256;
/// Segments that a worker takes at a time.
const BLOCK: usize = 4;
/// Columns of dexels whose lines make a bundle.
const STRIP: usize = 128;
/// Times that a line is solved again, each time moved elsewhere.
pub(super) const ATTEMPTS: usize = 5;

impl Plan {
    pub(super) fn job<'a>(
        &'a self,
        tool: &'a Tool,
        grid: &'a Grid,
        options: &Options,
        monitor: &'a dyn Monitor,
    ) -> Job<'a> {
        Job {
            tool,
            cutter: &self.cutter,
            grid,
            tolerance: options.tolerance,
            method: options.method,
            boundary: options.boundary,
            path: options.path_number,
            size: Size {
                spacing: grid.spacing(),
                slack: 64.0 * f64::EPSILON * self.size,
            },
            accept: self.accept,
            spaces: Mutex::new(Vec::new()),
            monitor,
        }
    }
}

/// What all chunks of a sweep share.
pub(super) struct Job<'a> {
    pub tool: &'a Tool,
    pub cutter: &'a Cutter,
    pub grid: &'a Grid,
    pub tolerance: f64,
    pub method: Method,
    pub boundary: Boundary,
    pub path: u16,
    pub size: Size,
    pub accept: f64,
    /// Workspaces that no worker uses just now.
    pub spaces: Mutex<Vec<Workspace>>,
    pub monitor: &'a dyn Monitor,
}

impl Job<'_> {
    /// Runs `work` with a workspace.
    pub fn with_space<T>(&self, work: impl FnOnce(&mut Workspace) -> T) -> T {
        let kept = self.spaces.lock().map(|mut spaces| spaces.pop()).unwrap_or_default();
        let mut space = kept.unwrap_or_else(|| Workspace::new(self.cutter, self.accept));
        let result = work(&mut space);
        if let Ok(mut spaces) = self.spaces.lock() {
            spaces.push(space);
        }
        result
    }

    fn search<'b>(&'b self, lattice: &'b Lattice<'b>, how: How<'b>) -> Search<'b> {
        Search {
            tool: self.tool,
            cutter: self.cutter,
            how,
            lattice,
            size: self.size,
            path: self.path,
        }
    }

    /// All crossings of a chunk, in an order that does not depend on the threads.
    pub fn harvest(&self, chunk: &[PathPart]) -> Result<Harvest, SweepError> {
        let shift = path_parts::shift(self.tolerance, 0);
        match self.method {
            Method::Charts | Method::Surface => {
                let lattice = Lattice::all(self.grid, shift);
                let how = if self.method == Method::Charts {
                    How::Charts
                } else {
                    How::Surface
                };
                let search = self.search(&lattice, how);
                self.gather(chunk.len().div_ceil(BLOCK), |block, space, harvest| {
                    for at in block * BLOCK..((block + 1) * BLOCK).min(chunk.len()) {
                        if self.monitor.cancelled() {
                            break;
                        }
                        search.part(chunk, at, space, harvest);
                    }
                })
            }
            Method::Planes => {
                let forms: Vec<Forms> = chunk
                    .par_iter()
                    .map(|part| Forms::new(self.tool, &part.segment))
                    .collect();
                self.gather(self.grid.cells()[0], |column, space, harvest| {
                    let lattice = Lattice::column(self.grid, column, shift);
                    let search = self.search(&lattice, How::Planes(&forms));
                    for at in 0..chunk.len() {
                        if self.monitor.cancelled() {
                            break;
                        }
                        search.part(chunk, at, space, harvest);
                    }
                })
            }
            Method::Lines => {
                let bundles: Vec<Bundles> = (0..chunk.len())
                    .into_par_iter()
                    .map(|at| Bundles::new(self.tool, chunk, at))
                    .collect();
                let blocks = chunk.len().div_ceil(BLOCK);
                let strips = self.grid.cells()[0].div_ceil(STRIP);
                self.gather(blocks * strips, |number, space, harvest| {
                    let (block, strip) = (number / strips, number % strips);
                    let columns = [strip * STRIP, ((strip + 1) * STRIP).min(self.grid.cells()[0]) - 1];
                    let lattice = Lattice::columns(self.grid, columns, shift);
                    let search = self.search(&lattice, How::Lines(&bundles));
                    for at in block * BLOCK..((block + 1) * BLOCK).min(chunk.len()) {
                        if self.monitor.cancelled() {
                            break;
                        }
                        search.part(chunk, at, space, harvest);
                    }
                })
            }
        }
    }

    /// The crossings of one line, moved as in the given attempt.
    pub fn line(&self, chunk: &[PathPart], line: usize, attempt: usize, space: &mut Workspace, harvest: &mut Harvest) {
        let lattice = Lattice::one(self.grid, line, path_parts::shift(self.tolerance, attempt));
        let search = self.search(&lattice, How::Charts);
        for at in 0..chunk.len() {
            search.part(chunk, at, space, harvest);
        }
    }

    fn gather(
        &self,
        count: usize,
        work: impl Fn(usize, &mut Workspace, &mut Harvest) + Sync,
    ) -> Result<Harvest, SweepError> {
        let parts: Vec<Harvest> = (0..count)
            .into_par_iter()
            .map(|number| {
                let mut harvest = Harvest::default();
                self.with_space(|space| work(number, space, &mut harvest));
                harvest
            })
            .collect();
        if self.monitor.cancelled() {
            return Err(SweepError::Cancelled);
        }
        let mut all = Harvest::default();
        all.crossings
            .reserve(parts.iter().map(|part| part.crossings.len()).sum());
        for part in parts {
            all.crossings.extend(part.crossings);
            all.open.extend(part.open);
            all.statistics.boxes += part.statistics.boxes;
            all.statistics.charts += part.statistics.charts;
            all.statistics.evaluations += part.statistics.evaluations;
        }
        Ok(all)
    }
}
