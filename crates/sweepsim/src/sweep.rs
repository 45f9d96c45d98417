//! The sweep of a path: crossings of all dexel lines, chunk by chunk, counted to intervals, audited, and repaired.

use crate::crossings::{Cutter, Harvest, Numbered, Search, Workspace};
use crate::envelope::Size;
use crate::generic::{self, Part};
use crate::lattice::Lattice;
use rayon::prelude::*;
use std::fmt;
use std::str::FromStr;
use std::sync::Mutex;
use sweepsim_dexel::{AuditFailure, Dexels, Grid, Interval, cover};
use sweepsim_motion::{Path, Tool};
use sweepsim_solve::Reason;
use thiserror::Error;

/// How crossings are found. All methods give the same intervals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// One subdivision for all lines: boxes on which the envelope system is injective.
    #[default]
    Charts,
    /// Every line for itself: the paper's Algorithm 4.
    Lines,
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Charts => "charts",
            Self::Lines => "lines",
        })
    }
}

/// A name that is no method.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("unknown method `{0}`: expected `charts` or `lines`")]
pub struct UnknownMethod(pub String);

impl FromStr for Method {
    type Err = UnknownMethod;

    fn from_str(name: &str) -> Result<Self, UnknownMethod> {
        match name {
            "charts" => Ok(Self::Charts),
            "lines" => Ok(Self::Lines),
            _ => Err(UnknownMethod(name.to_owned())),
        }
    }
}

/// How to sweep.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// How far interval ends may be off, in the unit of all lengths (see the crate's page on generic position).
    pub tolerance: f64,
    /// How crossings are found.
    pub method: Method,
    /// What [`Source::path`](sweepsim_dexel::Source) says.
    pub path_number: u16,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tolerance: 1e-6,
            method: Method::Charts,
            path_number: 0,
        }
    }
}

impl Options {
    /// The default with this tolerance.
    #[must_use]
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            ..Self::default()
        }
    }

    /// Chooses the method.
    #[must_use]
    pub fn method(mut self, method: Method) -> Self {
        self.method = method;
        self
    }

    /// Chooses the number of the path that sources carry.
    #[must_use]
    pub fn path_number(mut self, number: u16) -> Self {
        self.path_number = number;
        self
    }
}

/// Watches a sweep, and may end it.
pub trait Monitor: Sync {
    /// `done` of `total` moves are swept.
    fn advance(&self, done: usize, total: usize) {
        let _ = (done, total);
    }

    /// Whether to give up.
    fn cancelled(&self) -> bool {
        false
    }
}

impl Monitor for () {}

/// A dexel whose intervals could not be established.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unresolved {
    /// Column.
    pub i: usize,
    /// Row.
    pub j: usize,
    /// What went wrong.
    pub reason: String,
}

/// What a sweep did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Moves of the path.
    pub moves: usize,
    /// Crossings found.
    pub crossings: u64,
    /// Boxes that the subdivision looked at.
    pub boxes: u64,
    /// Boxes that were charts.
    pub charts: u64,
    /// Dexels that the tool touches.
    pub covered: usize,
    /// Dexels whose audit failed at first, and closed for a line moved within the tolerance.
    pub repaired: usize,
    /// Dexels whose audit did not close.
    pub unresolved: Vec<Unresolved>,
}

impl Statistics {
    /// Adds those of another path.
    pub fn merge(&mut self, other: &Self) {
        self.moves += other.moves;
        self.crossings += other.crossings;
        self.boxes += other.boxes;
        self.charts += other.charts;
        self.covered = self.covered.max(other.covered);
        self.repaired += other.repaired;
        self.unresolved.extend(other.unresolved.iter().cloned());
    }
}

/// A swept volume.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// Its dexels; ends carry the normal of the envelope and the segment and time that made them.
    pub volume: Dexels,
    /// What was done.
    pub statistics: Statistics,
}

/// Why there is no sweep.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SweepError {
    /// The monitor asked to give up.
    #[error("cancelled")]
    Cancelled,
    /// The tolerance is not a positive number.
    #[error("the tolerance is {0}, but must be positive")]
    Tolerance(f64),
    /// The tolerance is finer than numbers of the path's size resolve.
    #[error("the tolerance {tolerance} is too fine for coordinates of up to {size}: at least {least} is needed")]
    TooFine {
        /// The tolerance.
        tolerance: f64,
        /// The largest coordinate.
        size: f64,
        /// The finest tolerance there.
        least: f64,
    },
}

/// Segments whose crossings are counted together. Longer chunks save caps, shorter ones memory.
const CHUNK: usize = 256;
/// Segments that a worker takes at a time.
const BLOCK: usize = 4;
/// Times that a line is solved again, each time moved elsewhere.
const ATTEMPTS: usize = 5;

/// The volume that `tool` sweeps along `path`, on the dexels of `grid`.
///
/// Runs in the current rayon pool; the result does not depend on the number of threads.
///
/// # Errors
/// [`SweepError`]: cancelled, or a tolerance that is none.
pub fn sweep(
    tool: &Tool,
    path: &Path,
    grid: &Grid,
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<Sweep, SweepError> {
    let tolerance = options.tolerance;
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(SweepError::Tolerance(tolerance));
    }
    let cutter = Cutter::new(tool);
    let size = grid
        .min()
        .into_iter()
        .chain(grid.max())
        .map(f64::abs)
        .fold(cutter.reach.max(path.size()), f64::max);
    let least = 2e4 * f64::EPSILON * size;
    if tolerance < least {
        return Err(SweepError::TooFine { tolerance, size, least });
    }
    let parts = generic::parts(path, tool.is_revolved(), cutter.reach, tolerance);
    let job = Job {
        cutter: &cutter,
        grid,
        tolerance,
        method: options.method,
        path: options.path_number,
        size: Size {
            spacing: grid.spacing(),
            slack: 64.0 * f64::EPSILON * size,
        },
        // The square of the last step, times lengths of the tool's size, is a small part of the tolerance.
        accept: (1e-3 * tolerance / size).sqrt().clamp(1e-9, 1e-5),
        spaces: Mutex::new(Vec::new()),
        monitor,
    };
    let mut volume = Dexels::empty(*grid);
    let mut statistics = Statistics {
        moves: path.moves(),
        ..Statistics::default()
    };
    let mut failed: Vec<Unresolved> = Vec::new();
    for (number, chunk) in parts.chunks(CHUNK).enumerate() {
        let harvest = job.harvest(chunk)?;
        statistics.crossings += harvest.crossings.len() as u64;
        statistics.boxes += harvest.statistics.boxes;
        statistics.charts += harvest.statistics.charts;
        job.count(chunk, harvest, &mut volume, &mut statistics, &mut failed)?;
        monitor.advance((number * CHUNK + chunk.len()).min(parts.len()), parts.len());
    }
    statistics.covered = volume.covered();
    failed.sort_by_key(|u| (u.i, u.j));
    failed.dedup_by_key(|u| (u.i, u.j));
    statistics.unresolved = failed;
    Ok(Sweep { volume, statistics })
}

/// What all chunks of a sweep share.
struct Job<'a> {
    cutter: &'a Cutter,
    grid: &'a Grid,
    tolerance: f64,
    method: Method,
    path: u16,
    size: Size,
    accept: f64,
    /// Workspaces that no worker uses just now.
    spaces: Mutex<Vec<Workspace>>,
    monitor: &'a dyn Monitor,
}

impl Job<'_> {
    /// Runs `work` with a workspace.
    fn with_space<T>(&self, work: impl FnOnce(&mut Workspace) -> T) -> T {
        let kept = self.spaces.lock().map(|mut spaces| spaces.pop()).unwrap_or_default();
        let mut space = kept.unwrap_or_else(|| Workspace::new(self.cutter, self.accept));
        let result = work(&mut space);
        if let Ok(mut spaces) = self.spaces.lock() {
            spaces.push(space);
        }
        result
    }

    /// All crossings of a chunk, in an order that does not depend on the threads.
    fn harvest(&self, chunk: &[Part]) -> Result<Harvest, SweepError> {
        match self.method {
            Method::Charts => {
                let lattice = Lattice::all(self.grid, generic::shift(self.tolerance, 0));
                let search = Search {
                    cutter: self.cutter,
                    lattice: &lattice,
                    size: self.size,
                    path: self.path,
                };
                self.gather(chunk.len().div_ceil(BLOCK), |block, space, harvest| {
                    for at in block * BLOCK..((block + 1) * BLOCK).min(chunk.len()) {
                        if self.monitor.cancelled() {
                            break;
                        }
                        search.part(chunk, at, space, harvest);
                    }
                })
            }
            Method::Lines => self.gather(self.grid.len(), |line, space, harvest| {
                if !self.monitor.cancelled() {
                    self.line(chunk, line, 0, space, harvest);
                }
            }),
        }
    }

    /// The crossings of one line, moved as in the given attempt.
    fn line(&self, chunk: &[Part], line: usize, attempt: usize, space: &mut Workspace, harvest: &mut Harvest) {
        let lattice = Lattice::one(self.grid, line, generic::shift(self.tolerance, attempt));
        let search = Search {
            cutter: self.cutter,
            lattice: &lattice,
            size: self.size,
            path: self.path,
        };
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
        for part in parts {
            all.crossings.extend(part.crossings);
            all.open.extend(part.open);
            all.statistics.boxes += part.statistics.boxes;
            all.statistics.charts += part.statistics.charts;
            all.statistics.evaluations += part.statistics.evaluations;
        }
        Ok(all)
    }

    /// Counts the crossings of a chunk to intervals, repairs what does not add up, and unites the intervals with the volume.
    fn count(
        &self,
        chunk: &[Part],
        harvest: Harvest,
        volume: &mut Dexels,
        statistics: &mut Statistics,
        failed: &mut Vec<Unresolved>,
    ) -> Result<(), SweepError> {
        let Harvest {
            mut crossings,
            mut open,
            ..
        } = harvest;
        crossings.par_sort_by_key(|(line, _)| *line);
        open.sort_by_key(|(line, _)| *line);
        let mut bad: Vec<u32> = open.iter().map(|(line, _)| *line).collect();
        bad.dedup();
        let groups: Vec<&[Numbered]> = crossings.chunk_by(|a, b| a.0 == b.0).collect();
        let counted: Vec<(u32, Result<Vec<Interval>, AuditFailure>)> = groups
            .par_iter()
            .map(|group| (group[0].0, intervals(group, generic::same(self.tolerance))))
            .collect();
        let mut wrong = Vec::new();
        for (line, result) in counted {
            match result {
                Ok(intervals) if bad.binary_search(&line).is_err() => volume.unite(line as usize, &intervals),
                _ => wrong.push(line),
            }
        }
        wrong.extend(&bad);
        wrong.sort_unstable();
        wrong.dedup();
        let repaired: Vec<Result<Vec<Interval>, String>> = wrong
            .par_iter()
            .map(|line| self.with_space(|space| self.repair(chunk, *line, space)))
            .collect();
        if self.monitor.cancelled() {
            return Err(SweepError::Cancelled);
        }
        for (line, result) in wrong.into_iter().zip(repaired) {
            match result {
                Ok(intervals) => {
                    statistics.repaired += 1;
                    volume.unite(line as usize, &intervals);
                }
                Err(reason) => {
                    let (i, j) = self.grid.place(line as usize);
                    failed.push(Unresolved { i, j, reason });
                }
            }
        }
        Ok(())
    }

    /// Solves one line again, moved elsewhere within the tolerance, until its audit closes.
    fn repair(&self, chunk: &[Part], line: u32, space: &mut Workspace) -> Result<Vec<Interval>, String> {
        let mut reason = String::new();
        for attempt in 1..=ATTEMPTS {
            if self.monitor.cancelled() {
                break;
            }
            let mut harvest = Harvest::default();
            self.line(chunk, line as usize, attempt, space, &mut harvest);
            if let Some((_, why)) = harvest.open.first() {
                reason = match why {
                    Reason::Budget => "the budget of boxes is spent".to_owned(),
                    _ => "a box could not be decided at the smallest size".to_owned(),
                };
                continue;
            }
            match intervals(&harvest.crossings, generic::same(self.tolerance)) {
                Ok(intervals) => return Ok(intervals),
                Err(failure) => {
                    reason = format!(
                        "the coverage count does not close: sum {}, lowest {}, at z = {}",
                        failure.sum, failure.lowest, failure.z
                    );
                }
            }
        }
        Err(reason)
    }
}

/// The intervals of one line; crossings within `same` are at one height.
fn intervals(group: &[Numbered], same: f64) -> Result<Vec<Interval>, AuditFailure> {
    let mut crossings: Vec<_> = group.iter().map(|(_, crossing)| *crossing).collect();
    let mut intervals = Vec::new();
    cover(&mut crossings, same, &mut intervals)?;
    Ok(intervals)
}
