//! Paths that do nothing.

use crate::base::words::{counted, length};
use sweepsim::Cut;
use sweepsim_formats::Job;

/// The most paths that are named one by one.
const MOST_NAMED: usize = 5;

/// A path in words: where it comes from, and its tool.
pub(super) fn named(job: &Job, number: usize) -> String {
    let path = &job.paths[number];
    let lines = path.origins.first().zip(path.origins.last());
    match lines {
        Some((first, last)) if first.line < last.line => {
            format!("path {number} ({}:{}–{})", path.source, first.line, last.line)
        }
        Some((first, _)) => format!("path {number} ({}:{})", path.source, first.line),
        None if path.source.starts_with("path ") => path.source.clone(),
        None => format!("path {number} ({})", path.source),
    }
}

/// Some paths, and the number of the others.
fn list(job: &Job, paths: &[usize]) -> String {
    let names: Vec<String> = paths.iter().take(MOST_NAMED).map(|n| named(job, *n)).collect();
    let more = paths.len().saturating_sub(MOST_NAMED);
    let rest = if more > 0 {
        format!(" and {more} more")
    } else {
        String::new()
    };
    format!("{}{rest}", names.join(", "))
}

/// Paths without a move: the tool removes no more than what it covers where it stands.
pub(super) fn still(job: &Job) -> Option<String> {
    if job.moves() == 0 {
        return Some("the job moves nothing: no path has a move".to_owned());
    }
    let still: Vec<usize> = (0..job.paths.len())
        .filter(|n| job.paths[*n].path.moves() == 0)
        .collect();
    (!still.is_empty()).then(|| {
        format!(
            "{} of a single pose {} only what the tool covers there: {}",
            counted(still.len() as u64, "path"),
            if still.len() == 1 { "removes" } else { "remove" },
            list(job, &still)
        )
    })
}

/// Feed paths whose tool stays away from the stock.
pub(super) fn miss(job: &Job) -> Option<String> {
    let [low, high] = job.stock.bounds()?;
    let apart = |number: &usize| {
        let path = &job.paths[*number];
        if path.rapid.count() == path.rapid.len() {
            return None;
        }
        let [a, b] = Cut::new(&job.tools[&path.tool], &path.path).bounds()?;
        let gap = (0..3)
            .map(|k| (a[k] - high[k]).max(low[k] - b[k]))
            .fold(f64::NEG_INFINITY, f64::max);
        (gap > 0.0).then_some((*number, gap))
    };
    let missing: Vec<(usize, f64)> = (0..job.paths.len()).filter_map(|number| apart(&number)).collect();
    let (_, nearest) = missing.iter().copied().reduce(|a, b| if b.1 < a.1 { b } else { a })?;
    let numbers: Vec<usize> = missing.iter().map(|(number, _)| *number).collect();
    Some(format!(
        "{} with feed moves {} the stock by {} mm or more: {}",
        counted(numbers.len() as u64, "path"),
        if numbers.len() == 1 { "misses" } else { "miss" },
        length(nearest),
        list(job, &numbers)
    ))
}

/// Paths that remove nothing, where the volumes are known; and a job that removes nothing at all.
pub(super) fn without_effect(job: &Job, volume: Option<f64>, removed: Option<&[f64]>) -> Vec<String> {
    if job.moves() == 0 {
        return Vec::new();
    }
    if volume == Some(0.0) {
        return vec!["nothing was removed from the stock".to_owned()];
    }
    let Some(removed) = removed else { return Vec::new() };
    // A sliver as thin as the tolerance on a whole dexel.
    let [dx, dy] = job.grid.spacing();
    let nothing = job.tolerance * dx * dy;
    let idle = |n: &usize| {
        let path = &job.paths[*n];
        removed.get(*n).is_some_and(|removed| *removed <= nothing) && path.rapid.count() < path.rapid.len()
    };
    let idle: Vec<usize> = (0..job.paths.len()).filter(idle).collect();
    if idle.is_empty() {
        return Vec::new();
    }
    let verb = if idle.len() == 1 { "removes" } else { "remove" };
    vec![format!(
        "{} with feed moves {verb} nothing: {}",
        counted(idle.len() as u64, "path"),
        list(job, &idle)
    )]
}
