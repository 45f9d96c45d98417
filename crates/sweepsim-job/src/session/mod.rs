//! What all parts of a run work with: the plan, and who watches.

mod plan;
mod three_axes;

pub(crate) use plan::Pieces;
pub use plan::{Guess, Plan};
pub(crate) use sweepsim::solve::CancelOnly;
pub(crate) use three_axes::{
    TriSolid, check, coarse_grids_aside, grids_aside, heights, joined, lattice, solid, stock, stock_heights, stock_on,
    surface, too_many,
};

use crate::base::JobError;
use crate::base::cache::{Digest, Key, RunCache};
use crate::request::Request;
use std::fmt::Display;
use std::path::Path;
use std::time::Instant;
use sweepsim::{Cut, Monitor, SweepError, UnresolvedDexel};
use sweepsim_formats::{Job, Report, ReportedDexel};

/// A job that is worked on.
#[derive(Clone, Copy)]
pub(crate) struct Session<'a> {
    pub plan: &'a Plan,
    pub request: &'a Request,
    pub job: &'a Job,
    pub monitor: &'a dyn Monitor,
}

impl<'a> Session<'a> {
    pub fn new(plan: &'a Plan, monitor: &'a dyn Monitor) -> Self {
        let (request, job) = (&plan.request, &plan.job);
        Self {
            plan,
            request,
            job,
            monitor,
        }
    }

    /// The job's file.
    pub fn file(&self) -> &'a Path {
        self.request.input.name()
    }

    /// The folder that the names of programs refer to.
    pub fn folder(&self) -> &'a Path {
        self.file().parent().unwrap_or(Path::new(""))
    }

    /// What earlier runs have found.
    pub fn cache(&self) -> Option<&'a RunCache> {
        self.plan.cache.as_ref()
    }

    /// Digests of the stock, and of the target with its limits, and colours and faces that they may hold for: for those
    /// who ask the cache.
    pub fn digests(&self) -> (Key, Key) {
        let job = self.job;
        let stock = || Digest::of("stock").stock(&job.stock).key();
        let target = || {
            let own = Digest::of("target").value(&job.limits).floats(&[job.tolerance]);
            match &job.target {
                Some(target) => {
                    let own = own.number(1).triangles(&target.mesh);
                    own.value(&target.colours).value(&target.faces)
                }
                None => own.number(0),
            }
            .key()
        };
        match self.cache() {
            Some(cache) => (*cache.stock.get_or_init(stock), *cache.target.get_or_init(target)),
            None => (stock(), target()),
        }
    }

    /// Names the phase that begins.
    pub fn phase(&self, name: &'static str) {
        self.monitor.phase(name);
    }

    /// The tools of the job, and their paths.
    pub fn cuts(&self) -> Vec<Cut<'a>> {
        let cut = |path: &'a sweepsim_formats::JobPath| Cut::new(&self.job.tools[&path.tool], &path.path);
        self.job.paths.iter().map(cut).collect()
    }

    /// The error if a sweep fails.
    pub fn failed(&self, error: SweepError) -> JobError {
        JobError::of_sweep(error, self.file())
    }

    /// An error that concerns the job.
    pub fn failure(&self, why: impl Display) -> JobError {
        JobError::file(self.file(), why)
    }
}

/// Runs a phase of the work, and adds its duration to the report.
pub(crate) fn phase<T>(report: &mut Report, name: &str, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    *report.seconds.entry(name.to_owned()).or_default() += start.elapsed().as_secs_f64();
    result
}

/// Uncertified dexels as they are reported.
pub(crate) fn reported(unresolved: &[UnresolvedDexel]) -> Vec<ReportedDexel> {
    let one = |dexel: &UnresolvedDexel| ReportedDexel::new(dexel.i, dexel.j, dexel.reason.to_string());
    unresolved.iter().map(one).collect()
}
