//! What is asked of proofs: limits, widths, budgets, and the solids that are followed.

use super::targets;
use std::collections::{BTreeMap, BTreeSet};
use sweepsim_formats::{Job, JobPath};
use sweepsim_proof::{Convex, Cutter, Limits, cover, scene};

/// An enclosure is no wider than this part of its limit, where nothing goes deeper than that.
pub(super) const WIDTH: f64 = 0.1;
/// Concave outlines are replaced by chords within this part of the limit.
pub(super) const CHORDS: f64 = 0.01;
/// The most pairs of a cell and a time that are looked at in a request: so many, and so many for each move.
const PAIRS: usize = 500_000;
const PAIRS_OF_MOVE: usize = 400;
/// The least and the largest of the limits that are allowed somewhere, of gouges or of excess.
pub(super) fn limits(job: &Job, of: impl Fn([f64; 2]) -> f64) -> [f64; 2] {
    let own = job.limits.as_ref();
    let general = own.map_or([targets::LIMIT; 2], |limits| [limits.gouge, limits.excess]);
    let regions = own.into_iter().flat_map(|limits| &limits.regions);
    let regions = regions.map(|region| [region.gouge, region.excess]);
    let mut all = std::iter::once(general)
        .chain(regions)
        .map(|limits| of(limits).max(floor(job)));
    let first = all.next().unwrap_or(targets::LIMIT);
    all.fold([first; 2], |[least, most], limit| [least.min(limit), most.max(limit)])
}

/// Below the tolerance of the dexels there is nothing to judge.
pub(super) fn floor(job: &Job) -> f64 {
    2.0 * job.tolerance
}

/// What cutters cut with, as solids.
pub(super) fn cutters(job: &Job, tolerance: f64) -> BTreeMap<u32, Vec<Convex>> {
    let tools = job.tools.iter();
    tools.map(|(number, tool)| (*number, cover(tool, tolerance))).collect()
}

/// Solids along the paths of a job.
pub(super) fn along<'a>(job: &'a Job, solids: &'a BTreeMap<u32, Vec<Convex>>) -> Vec<Cutter<'a>> {
    let cutter = |path: &'a JobPath| Cutter {
        solids: solids.get(&path.tool).map_or(&[][..], Vec::as_slice),
        path: &path.path,
        others: Some(&path.other_courses),
    };
    job.paths.iter().map(cutter).collect()
}

pub(super) fn pairs(job: &Job) -> usize {
    PAIRS + PAIRS_OF_MOVE * job.moves()
}

/// What is asked of gouges in a job.
pub(super) struct Asked {
    solids: BTreeMap<u32, Vec<Convex>>,
    pub limits: Limits,
}

impl Asked {
    pub fn new(job: &Job) -> Self {
        let [least, _] = limits(job, |[gouge, _]| gouge);
        Self {
            solids: cutters(job, CHORDS * least),
            limits: Limits {
                depth: least,
                width: WIDTH * least,
                pairs: pairs(job),
            },
        }
    }

    /// The cutters of all paths, each with the number of its tool.
    pub fn cutters<'a>(&'a self, job: &'a Job) -> Vec<(u32, Cutter<'a>)> {
        let tools = job.paths.iter().map(|path| path.tool);
        tools.zip(along(job, &self.solids)).collect()
    }

    /// Target, tools and paths in plain numbers: of the tools, those that are used.
    pub fn scene(&self, job: &Job) -> Option<sweepsim_check::Scene> {
        let target = job.target.as_ref()?;
        let used: BTreeSet<u32> = job.paths.iter().map(|path| path.tool).collect();
        let tools = used.iter().map(|number| (*number, &job.tools[number]));
        Some(scene(&target.mesh, tools, &self.cutters(job), &self.limits))
    }
}
