//! Targets with their limits, and deviations from them for reports.

use crate::base::cache::{Digest, Key};
use crate::session::Session;
use sweepsim::verify::{Deviation, DeviationKind, Deviations, Region, Target, TargetError, TargetRegion, TargetShape};
use sweepsim_dexel::{Dexels, Grid, TriangleSoup};
use sweepsim_formats::{DeviationSummary, Limits, ReportedRegion};

/// The limits of a target that comes without any, in millimetres.
pub(crate) const LIMIT: f64 = 0.1;

/// The target of a job, for a stock on this grid.
pub(super) fn of_job(session: Session, grid: &Grid) -> Result<Option<Target>, TargetError> {
    let job = session.job;
    let Some(target) = &job.target else { return Ok(None) };
    let parts = job.limits.as_ref().map(|limits| target.by_region(limits));
    let (rest, regions) = regions_of(&target.mesh, parts, job.limits.as_ref(), job.tolerance);
    let shape = || TargetShape::new(&target.mesh, rest, &regions);
    let (shape, lines) = rayon::join(shape, || kept(session, grid));
    on_grid(session, grid, &shape?, lines).map(Some)
}

/// A target on another grid.
pub(super) fn on(session: Session, target: &Target, grid: &Grid) -> Result<Target, TargetError> {
    on_grid(session, grid, target.shape(), kept(session, grid))
}

fn key(session: Session, grid: &Grid) -> Key {
    Digest::of("target").bytes(&session.digests().1).value(grid).key()
}

/// What of the target is on the lines of a grid, if it was made before.
fn kept(session: Session, grid: &Grid) -> Option<[Dexels; 3]> {
    let cache = session.cache()?;
    let known = cache.get(&key(session, grid))?;
    let lines = read_lines(known, grid);
    if lines.is_none() {
        cache.spoilt();
    }
    lines
}

/// A target on the lines of a grid: as kept, or made and kept.
fn on_grid(
    session: Session,
    grid: &Grid,
    shape: &TargetShape,
    lines: Option<[Dexels; 3]>,
) -> Result<Target, TargetError> {
    if let Some(lines) = lines {
        return shape.known(lines);
    }
    let target = shape.on(grid)?;
    let Some(cache) = session.cache() else {
        return Ok(target);
    };
    let mut lines = Vec::new();
    for own in [target.solid(), target.core(), target.allowed()] {
        let state = own.state();
        lines.extend((state.len() as u64).to_le_bytes());
        lines.extend(state);
    }
    cache.put(key(session, grid), lines);
    Ok(target)
}

fn read_lines(mut known: &[u8], grid: &Grid) -> Option<[Dexels; 3]> {
    let mut next = || {
        let (length, rest) = known.split_first_chunk::<8>()?;
        let (state, rest) = rest.split_at_checked(usize::try_from(u64::from_le_bytes(*length)).ok()?)?;
        known = rest;
        Dexels::from_state(*grid, state)
    };
    Some([next()?, next()?, next()?])
}

/// A target by region: `parts` has what of its surface is in no region, then each region.
pub(crate) fn with_limits(
    mesh: &TriangleSoup,
    parts: Option<Vec<TriangleSoup>>,
    limits: Option<&Limits>,
    grid: &Grid,
    tolerance: f64,
) -> Result<Target, TargetError> {
    let (rest, regions) = regions_of(mesh, parts, limits, tolerance);
    Target::with_regions(mesh, grid, rest, &regions)
}

/// What of a target's surface is in no region, and the regions.
fn regions_of(
    mesh: &TriangleSoup,
    parts: Option<Vec<TriangleSoup>>,
    limits: Option<&Limits>,
    tolerance: f64,
) -> (TargetRegion, Vec<TargetRegion>) {
    // Below the tolerance of the dexels there is nothing to judge.
    let least = |limits: [f64; 2]| limits.map(|limit| limit.max(2.0 * tolerance));
    let (Some(limits), Some(parts)) = (limits, parts) else {
        return (TargetRegion::new(mesh.clone(), least([LIMIT; 2])), Vec::new());
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
    (rest, parts.collect())
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

/// How far a surface reaches beyond the lines of a grid, if that is more than the limit.
pub(crate) fn beyond(corners: impl Iterator<Item = [f64; 3]>, grid: &Grid, limit: f64) -> Option<f64> {
    let (min, max) = (grid.min(), grid.max());
    let far = corners.map(|p| {
        let p = grid.frame().from_world(p);
        [0, 1].map(|k| (min[k] - p[k]).max(p[k] - max[k]))
    });
    Some(far.flatten().fold(0.0, f64::max)).filter(|far| *far > limit)
}

pub(super) fn summed(deviation: &Deviation) -> DeviationSummary {
    let mut summary = DeviationSummary::default();
    (summary.max, summary.mean, summary.rms) = (deviation.max, deviation.mean, deviation.rms);
    (summary.count, summary.area) = (deviation.count, deviation.area);
    summary
}
