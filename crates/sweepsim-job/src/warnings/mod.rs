//! What is odd about a job although it can be run: each in one sentence, with the figures, and with what to do about
//! it.

mod extent;
mod fineness;
mod paths;
mod roof;
mod unused;

use sweepsim_dexel::Dexels;
use sweepsim_formats::Job;

pub(crate) use extent::is_beside;
pub use extent::is_covered;
pub(crate) use unused::Use;

/// What can be said of a job before the work. `used`: what of it the command looks at.
pub(crate) fn before(job: &Job, used: Use) -> Vec<String> {
    let mut all = unused::unused(job, used);
    if used.stock {
        all.extend(extent::uncovered(job));
        // Judged, each path has its volume in the end.
        if !used.judges {
            all.extend(paths::miss(job));
        }
    }
    if used.grid {
        all.extend(fineness::tolerance(job));
        all.extend(fineness::cells(job, used.stock));
    }
    all.extend(paths::still(job));
    all
}

/// What can be said of what remains of the stock. `removed`: the volume that each path removed, if it is known.
pub(crate) fn after(job: &Job, remaining: &Dexels, volume: Option<f64>, removed: Option<&[f64]>) -> Vec<String> {
    let mut all = paths::without_effect(job, volume, removed);
    all.extend(roof::roofs(job, remaining));
    all
}
