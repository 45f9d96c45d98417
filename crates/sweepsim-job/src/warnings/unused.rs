//! Parts of a job that a command does not look at, or that are there for nothing.

use sweepsim_formats::Job;

/// What of a job a command looks at, besides tools and paths.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Use {
    /// Its name.
    pub command: &'static str,
    pub stock: bool,
    pub grid: bool,
    /// Whether moves are judged: bodies, fixtures, target and limits.
    pub judges: bool,
}

/// Fields without effect.
pub(super) fn unused(job: &Job, used: Use) -> Vec<String> {
    let mut all = Vec::new();
    if !used.judges {
        let given = [
            ("target", job.target.is_some()),
            ("limits", job.limits.is_some()),
            ("fixtures", job.setups.iter().any(|setup| !setup.fixtures.is_empty())),
            ("bodies", !job.bodies.is_empty()),
            ("clearance", job.clearance > 0.0),
        ];
        let names: Vec<String> = given
            .iter()
            .filter(|(_, given)| *given)
            .map(|(name, _)| format!("`{name}`"))
            .collect();
        if let Some((last, first)) = names.split_last() {
            let list = if first.is_empty() {
                last.clone()
            } else {
                format!("{} and {last}", first.join(", "))
            };
            all.push(format!("`{}` does not look at {list}: `verify` does", used.command));
        }
    } else if job.limits.is_some() && job.target.is_none() {
        all.push("`limits` without a `target`: there is nothing to compare with".to_owned());
    }
    if used.judges && job.clearance > 0.0 && job.bodies.is_empty() {
        all.push("`clearance` without `bodies`: there is nothing to keep away".to_owned());
    }
    let idle: Vec<String> = job
        .tools
        .keys()
        .filter(|number| job.paths.iter().all(|path| path.tool != **number))
        .map(u32::to_string)
        .collect();
    match idle.as_slice() {
        [] => {}
        [one] => all.push(format!("no path uses tool {one}")),
        several => all.push(format!("no path uses the tools {}", several.join(", "))),
    }
    all
}
