//! Targets with their limits, and deviations from them for reports.

use sweepsim::verify::{Deviation, DeviationKind, Deviations, Region, Target, TargetError, TargetRegion};
use sweepsim_dexel::{Grid, TriangleSoup};
use sweepsim_formats::{DeviationSummary, Job, Limits, ReportedRegion};

/// The limits of a target that comes without any, in millimetres.
pub(crate) const LIMIT: f64 = 0.1;

/// The target of a job, for a stock on this grid.
pub(super) fn of_job(job: &Job, grid: &Grid) -> Result<Option<Target>, TargetError> {
    let Some(target) = &job.target else { return Ok(None) };
    let parts = job.limits.as_ref().map(|limits| target.by_region(limits));
    with_limits(&target.mesh, parts, job.limits.as_ref(), grid, job.tolerance).map(Some)
}

/// A target by region: `parts` has what of its surface is in no region, then each region.
pub(crate) fn with_limits(
    mesh: &TriangleSoup,
    parts: Option<Vec<TriangleSoup>>,
    limits: Option<&Limits>,
    grid: &Grid,
    tolerance: f64,
) -> Result<Target, TargetError> {
    // Below the tolerance of the dexels there is nothing to judge.
    let least = |limits: [f64; 2]| limits.map(|limit| limit.max(2.0 * tolerance));
    let (Some(limits), Some(parts)) = (limits, parts) else {
        return Target::new(mesh, grid, LIMIT.max(2.0 * tolerance), LIMIT.max(2.0 * tolerance));
    };
    let own = std::iter::once([limits.gouge, limits.excess]);
    let all = own.chain(limits.regions.iter().map(|region| [region.gouge, region.excess]));
    let mut parts = parts
        .into_iter()
        .zip(all)
        .map(|(part, limits)| TargetRegion::new(part, least(limits)));
    let rest = parts
        .next()
        .unwrap_or_else(|| TargetRegion::new(mesh.clone(), least([limits.gouge, limits.excess])));
    Target::with_regions(mesh, grid, rest, &parts.collect::<Vec<_>>())
}

/// The name of the region of the limits that a deviation exceeds.
pub(super) fn name(region: &Region, limits: Option<&Limits>) -> Option<String> {
    let number = region.part.checked_sub(1)?;
    Some(limits?.regions.get(number)?.name.clone())
}

pub(crate) fn regions(found: &Deviations, limits: Option<&Limits>) -> Vec<ReportedRegion> {
    let region = |region: &Region| {
        let mut reported = ReportedRegion::default();
        reported.kind = match region.kind {
            DeviationKind::Gouge => "gouge",
            DeviationKind::Excess => "excess",
        }
        .to_owned();
        reported.region = name(region, limits);
        (reported.place, reported.depth) = (region.place, region.depth);
        (reported.area, reported.volume) = (region.area, region.volume);
        reported
    };
    found.regions.iter().map(region).collect()
}

pub(super) fn summed(deviation: &Deviation) -> DeviationSummary {
    let mut summary = DeviationSummary::default();
    (summary.max, summary.mean, summary.rms) = (deviation.max, deviation.mean, deviation.rms);
    (summary.count, summary.area) = (deviation.count, deviation.area);
    summary
}
