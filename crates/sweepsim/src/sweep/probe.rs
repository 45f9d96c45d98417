//! The intervals of a sweep on single lines.

use crate::error::SweepError;
use crate::sweep::audit::Repair;
use crate::sweep::options::Options;
use crate::sweep::plan::Plan;
use crate::sweep::ray::Ray;
use crate::sweep::report::UnresolvedReason;
use crate::sweep::schedule::CHUNK;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use sweepsim_dexel::{Dexels, End, Frame, Grid, Interval};
use sweepsim_motion::{Path, Tool};
use sweepsim_solve::Monitor;

/// The intervals of a swept volume on one line, or why they are uncertified.
pub type Probe = Result<Vec<Interval>, UnresolvedReason>;

/// The intervals of the volume that `tool` sweeps along `path` on lines of any direction. Heights of ends are distances from the ray's origin,
/// negative behind it; normals are in the world.
///
/// Rays of one direction share the preparation of the path.
///
/// # Errors
///
/// [`SweepError`]: cancelled, or an invalid tolerance.
///
/// ```
/// use sweepsim::prelude::*;
/// use sweepsim::{Ray, probe};
///
/// let up = [0.0, 0.0, 1.0];
/// let path = Path::new(vec![Pose::new([0.0; 3], up)?, Pose::new([10.0, 0.0, 0.0], up)?])?;
/// let tool = Tool::ball(2.0, 30.0)?;
/// let rays = [
///     Ray::new([5.0, 0.0, -1.0], up)?,                  // through the groove
///     Ray::new([5.0, 3.0, 0.0], up)?,                   // beside it
///     Ray::new([5.0, -9.0, 2.0], [0.0, 1.0, 0.0])?,     // across it
/// ];
/// let found = probe(&tool, &path, &rays, &Options::default(), &())?;
/// let through = found[0].clone()?;
/// assert!((through[0].lower.z - 1.0).abs() < 1e-6);
/// assert!(found[1].clone()?.is_empty());
/// let across = found[2].clone()?;
/// assert!((across[0].lower.z - 7.0).abs() < 1e-6 && (across[0].upper.z - 11.0).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn probe(
    tool: &Tool,
    path: &Path,
    rays: &[Ray],
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<Vec<Probe>, SweepError> {
    let mut parallel: BTreeMap<[u64; 3], Vec<usize>> = BTreeMap::new();
    for (n, ray) in rays.iter().enumerate() {
        parallel.entry(ray.direction().map(f64::to_bits)).or_default().push(n);
    }
    let mut found: Vec<Probe> = vec![Ok(Vec::new()); rays.len()];
    for numbers in parallel.values() {
        let frame = rays[numbers[0]].frame();
        let origins: Vec<[f64; 3]> = numbers.iter().map(|n| frame.from_world(rays[*n].origin())).collect();
        let lines: Vec<[f64; 2]> = origins.iter().map(|[x, y, _]| [*x, *y]).collect();
        let probed = probe_lines(tool, path, &frame, &lines, options, monitor)?;
        for ((n, [_, _, start]), intervals) in numbers.iter().zip(origins).zip(probed) {
            let end = |end: End| End {
                z: end.z - start,
                normal: frame.turn_to_world(end.normal.map(f64::from)).map(|x| x as f32),
                ..end
            };
            found[*n] = intervals.map(|all| {
                let moved = |interval: Interval| Interval {
                    lower: end(interval.lower),
                    upper: end(interval.upper),
                };
                all.into_iter().map(moved).collect()
            });
        }
    }
    Ok(found)
}

/// The intervals on lines along the `z` of a frame, given by their `x` and `y` there. All coordinates are in the frame.
pub(crate) fn probe_lines(
    tool: &Tool,
    path: &Path,
    frame: &Frame,
    lines: &[[f64; 2]],
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<Vec<Probe>, SweepError> {
    let plan = Plan::new(tool, path, frame, lines.iter().flatten().copied(), options)?;
    let monitor = &Latch::new(monitor);
    // Half a cell about the line, which only gives the search a length scale.
    let half = f64::max(0.01 * plan.cutter.reach, 16.0 * plan.tolerances.rounding());
    let one = |[x, y]: &[f64; 2]| -> Probe {
        let cell = Grid::new([x - half, y - half], [x + half, y + half], [1, 1]);
        let grid = cell.map_err(|_| UnresolvedReason::SmallestBox)?;
        let job = plan.job((tool, plan.parts.len()), &grid, options, monitor);
        let mut volume = Dexels::empty(grid);
        let mut probed: Result<(), UnresolvedReason> = Ok(());
        job.with_space(|space| {
            for chunk in plan.parts.chunks(CHUNK) {
                let whole = Repair {
                    attempt: 0,
                    ..Repair::first(job.repairs.of_each(1))
                };
                let found = job.repair(chunk, 0, whole, space).0;
                let united = found.and_then(|intervals| Ok(volume.unite(0, &intervals)?));
                probed = probed.and(united);
            }
        });
        probed.map(|()| volume.at(0).to_vec())
    };
    let found = lines.par_iter().map(one).collect();
    if monitor.cancelled() {
        return Err(SweepError::Cancelled);
    }
    Ok(found)
}

/// Remembers a cancellation, so that the remaining lines stop at once.
struct Latch<'a> {
    monitor: &'a dyn Monitor,
    cancelled: AtomicBool,
}

impl<'a> Latch<'a> {
    fn new(monitor: &'a dyn Monitor) -> Self {
        Self {
            monitor,
            cancelled: AtomicBool::new(false),
        }
    }
}

impl Monitor for Latch<'_> {
    fn cancelled(&self) -> bool {
        if self.cancelled.load(Ordering::Relaxed) {
            return true;
        }
        let cancelled = self.monitor.cancelled();
        if cancelled {
            self.cancelled.store(true, Ordering::Relaxed);
        }
        cancelled
    }
}
