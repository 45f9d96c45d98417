//! The sweep of a path: crossings of all dexel lines, chunk by chunk, counted to intervals, audited, and repaired.

use crate::boundary::{self, Boundary};
use crate::crossings::{Cutter, Forms, Harvest, How, Numbered, Search, Workspace};
use crate::envelope::Size;
use crate::generic::{self, Part};
use crate::lattice::Lattice;
use crate::lines::Bundles;
use rayon::prelude::*;
use std::fmt;
use std::str::FromStr;
use std::sync::Mutex;
use sweepsim_dexel::{AuditFailure, Dexels, Frame, Grid, Interval, Operation, cover};
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
    /// The system of every line, each root with its own certificate: the paper's Algorithm 4. Lines share the subdivision that leads there.
    Lines,
    /// Curves in the planes `x = const`, cut by the lines: the paper's Algorithm 3.
    Planes,
    /// The envelope as surfaces, cut by the lines: the paper's Algorithm 1.
    Surface,
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Charts => "charts",
            Self::Lines => "lines",
            Self::Planes => "planes",
            Self::Surface => "surface",
        })
    }
}

/// A name that is no method.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("unknown method `{0}`: expected `charts`, `planes`, `lines` or `surface`")]
pub struct UnknownMethod(pub String);

impl FromStr for Method {
    type Err = UnknownMethod;

    fn from_str(name: &str) -> Result<Self, UnknownMethod> {
        match name {
            "charts" => Ok(Self::Charts),
            "lines" => Ok(Self::Lines),
            "planes" => Ok(Self::Planes),
            "surface" => Ok(Self::Surface),
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
    /// How they become intervals.
    pub boundary: Boundary,
    /// What [`Source::path`](sweepsim_dexel::Source) says.
    pub path_number: u16,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tolerance: 1e-6,
            method: Method::Charts,
            boundary: Boundary::Coverage,
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

    /// Chooses the boundary operator.
    #[must_use]
    pub fn boundary(mut self, boundary: Boundary) -> Self {
        self.boundary = boundary;
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
/// Columns of dexels whose lines make a bundle.
const STRIP: usize = 128;
/// Times that a line is solved again, each time moved elsewhere.
const ATTEMPTS: usize = 5;

/// The volume that `tool` sweeps along `path`, on the dexels of `grid`, in whatever frame they stand. The path is in the world.
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
    let extent = grid.min().into_iter().chain(grid.max());
    let plan = Plan::new(tool, path, grid.frame(), extent, options)?;
    let job = plan.job(tool, grid, options, monitor);
    let parts = &plan.parts;
    let mut volume = Dexels::empty(*grid);
    let mut statistics = Statistics {
        moves: path.moves(),
        ..Statistics::default()
    };
    let mut failed: Vec<Unresolved> = Vec::new();
    // The paper takes each move by itself.
    let length = match options.boundary {
        Boundary::Coverage => CHUNK,
        Boundary::Paper => 1,
    };
    for (number, chunk) in parts.chunks(length).enumerate() {
        let harvest = job.harvest(chunk)?;
        statistics.crossings += harvest.crossings.len() as u64;
        statistics.boxes += harvest.statistics.boxes;
        statistics.charts += harvest.statistics.charts;
        job.count(chunk, harvest, &mut volume, &mut statistics, &mut failed)?;
        monitor.advance((number * length + chunk.len()).min(parts.len()), parts.len());
    }
    statistics.covered = volume.covered();
    failed.sort_by_key(|u| (u.i, u.j));
    failed.dedup_by_key(|u| (u.i, u.j));
    statistics.unresolved = failed;
    Ok(Sweep { volume, statistics })
}

/// The intervals of the volume that `tool` sweeps along `path` on any lines along `z`, given by their `x` and `y`; `None` for a line
/// that could not be established.
///
/// # Errors
/// [`SweepError`]: cancelled, or a tolerance that is none.
///
/// ```
/// use sweepsim::{Options, probe};
/// use sweepsim_motion::{Path, Pose, Tool};
///
/// let up = [0.0, 0.0, 1.0];
/// let path = Path::new(vec![Pose::new([0.0; 3], up)?, Pose::new([10.0, 0.0, 0.0], up)?])?;
/// let found = probe(&Tool::ball(2.0, 30.0)?, &path, &[[5.0, 0.0], [5.0, 3.0]], &Options::default(), &())?;
/// let Some(groove) = &found[0] else { unreachable!() };
/// assert!(groove.len() == 1 && groove[0].lower.z.abs() < 1e-6);
/// assert_eq!(found[1].as_ref().map(Vec::len), Some(0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn probe(
    tool: &Tool,
    path: &Path,
    lines: &[[f64; 2]],
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<Vec<Option<Vec<Interval>>>, SweepError> {
    let plan = Plan::new(tool, path, &Frame::WORLD, lines.iter().flatten().copied(), options)?;
    let space = Mutex::new(Vec::new());
    let half = 0.01 * plan.cutter.reach;
    let one = |[x, y]: &[f64; 2]| -> Option<Vec<Interval>> {
        // A grid of one line: the spacing only tells the search what is small.
        let grid = Grid::new([x - half, y - half], [x + half, y + half], [1, 1]).ok()?;
        let job = plan.job(tool, &grid, options, monitor);
        let mut own = space
            .lock()
            .ok()?
            .pop()
            .unwrap_or_else(|| Workspace::new(&plan.cutter, plan.accept));
        let mut volume = Dexels::empty(grid);
        let mut established = true;
        for chunk in plan.parts.chunks(CHUNK) {
            match job.repair(chunk, 0, 0, &mut own) {
                Ok(intervals) => volume.unite(0, &intervals),
                Err(_) => established = false,
            }
        }
        space.lock().ok()?.push(own);
        established.then(|| volume.at(0).to_vec())
    };
    let found = lines.par_iter().map(one).collect();
    if monitor.cancelled() {
        return Err(SweepError::Cancelled);
    }
    Ok(found)
}

/// A tool and a path, prepared for any lines.
pub(crate) struct Plan {
    pub cutter: Cutter,
    pub parts: Vec<Part>,
    size: f64,
    accept: f64,
}

impl Plan {
    /// Everything as seen from `frame`. `extent`: coordinates of the lines.
    pub fn new(
        tool: &Tool,
        path: &Path,
        frame: &Frame,
        extent: impl Iterator<Item = f64>,
        options: &Options,
    ) -> Result<Self, SweepError> {
        let tolerance = options.tolerance;
        if !(tolerance > 0.0 && tolerance.is_finite()) {
            return Err(SweepError::Tolerance(tolerance));
        }
        let cutter = Cutter::new(tool);
        // Turned by any angle, and moved.
        let far = if frame.is_world() {
            path.size()
        } else {
            3.0_f64.sqrt() * path.size() + frame.origin().iter().map(|c| c.abs()).sum::<f64>()
        };
        let size = extent.map(f64::abs).fold(cutter.reach.max(far), f64::max);
        let least = 2e4 * f64::EPSILON * size;
        if tolerance < least {
            return Err(SweepError::TooFine { tolerance, size, least });
        }
        Ok(Self {
            parts: generic::parts(path, frame, tool.is_revolved(), cutter.reach, tolerance),
            // The square of the last step, times lengths of the tool's size, is a small part of the tolerance.
            accept: (1e-3 * tolerance / size).sqrt().clamp(1e-9, 1e-5),
            cutter,
            size,
        })
    }

    fn job<'a>(&'a self, tool: &'a Tool, grid: &'a Grid, options: &Options, monitor: &'a dyn Monitor) -> Job<'a> {
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
struct Job<'a> {
    tool: &'a Tool,
    cutter: &'a Cutter,
    grid: &'a Grid,
    tolerance: f64,
    method: Method,
    boundary: Boundary,
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
    fn harvest(&self, chunk: &[Part]) -> Result<Harvest, SweepError> {
        let shift = generic::shift(self.tolerance, 0);
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
    fn line(&self, chunk: &[Part], line: usize, attempt: usize, space: &mut Workspace, harvest: &mut Harvest) {
        let lattice = Lattice::one(self.grid, line, generic::shift(self.tolerance, attempt));
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
        open.sort_by_key(|(line, _)| *line);
        let mut bad: Vec<u32> = open.iter().map(|(line, _)| *line).collect();
        bad.dedup();
        if !bad.is_empty() {
            crossings.retain(|(line, _)| bad.binary_search(line).is_err());
        }
        let mut wrong: Vec<u32> = match self.boundary {
            Boundary::Coverage => {
                let same = generic::same(self.tolerance);
                let failures = volume.update_by_crossings(Operation::Union, &crossings, same);
                failures.into_iter().map(|(line, _)| line).collect()
            }
            Boundary::Paper => {
                crossings.sort_by_key(|(line, _)| *line);
                for group in crossings.chunk_by(|a, b| a.0 == b.0) {
                    let mut line: Vec<_> = group.iter().map(|(_, crossing)| *crossing).collect();
                    volume.unite(group[0].0 as usize, &boundary::by_normals(&mut line));
                }
                Vec::new()
            }
        };
        wrong.extend(&bad);
        wrong.sort_unstable();
        wrong.dedup();
        let repaired: Vec<Result<Vec<Interval>, String>> = wrong
            .par_iter()
            .map(|line| self.with_space(|space| self.repair(chunk, *line, 1, space)))
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

    /// Solves one line, from the given attempt on each time moved elsewhere within the tolerance, until its audit closes.
    fn repair(&self, chunk: &[Part], line: u32, first: usize, space: &mut Workspace) -> Result<Vec<Interval>, String> {
        let mut reason = String::new();
        for attempt in first..=ATTEMPTS {
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
            match self.intervals(&harvest.crossings) {
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

    /// The intervals of one line.
    fn intervals(&self, group: &[Numbered]) -> Result<Vec<Interval>, AuditFailure> {
        let mut crossings: Vec<_> = group.iter().map(|(_, crossing)| *crossing).collect();
        match self.boundary {
            Boundary::Coverage => {
                let mut intervals = Vec::new();
                cover(&mut crossings, generic::same(self.tolerance), &mut intervals)?;
                Ok(intervals)
            }
            Boundary::Paper => Ok(boundary::by_normals(&mut crossings)),
        }
    }
}
