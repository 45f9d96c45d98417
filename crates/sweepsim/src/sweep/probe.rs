//! The intervals of a sweep on single lines.

use crate::error::SweepError;
use crate::methods::workspace::Workspace;
use crate::sweep::options::Options;
use crate::sweep::plan::Plan;
use crate::sweep::schedule::CHUNK;
use rayon::prelude::*;
use std::sync::Mutex;
use sweepsim_dexel::{Dexels, Frame, Grid, Interval};
use sweepsim_motion::{Path, Tool};
use sweepsim_solve::Monitor;

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
            .unwrap_or_else(|| Workspace::new(&plan.cutter, plan.tolerances.last_step()));
        let mut volume = Dexels::empty(grid);
        let mut established = true;
        for chunk in plan.parts.chunks(CHUNK) {
            let united = job
                .repair(chunk, 0, 0, &mut own)
                .map(|intervals| volume.unite(0, &intervals));
            established &= matches!(united, Ok(Ok(())));
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
