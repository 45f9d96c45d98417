//! What `simulate` and `sweep` compute, and with which options.

use crate::arguments::RunOptions;
use crate::warnings::Use;
use sweepsim::{Options, UnresolvedDexel};
use sweepsim_formats::{Job, ReportedDexel};

/// What to compute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Task {
    /// The remaining stock.
    Simulate,
    /// The swept volume.
    Sweep,
    /// The remaining stock, and all that is wrong with the program.
    Verify,
}

impl Task {
    /// The name of the command.
    pub fn name(self) -> &'static str {
        match self {
            Self::Simulate => "simulate",
            Self::Sweep => "sweep",
            Self::Verify => "verify",
        }
    }

    /// What of a job it looks at.
    pub fn uses(self) -> Use {
        let command = match self {
            Self::Simulate => "`simulate`",
            Self::Sweep => "`sweep`",
            Self::Verify => "`verify`",
        };
        Use {
            command,
            stock: self != Self::Sweep,
            grid: true,
            judges: self == Self::Verify,
        }
    }
}

/// The options of the sweep.
pub(crate) fn sweeping(job: &Job, options: &RunOptions) -> Options {
    Options::new(job.tolerance)
        .method(options.method)
        .boundary(options.boundary)
        .tile(options.tile)
}

/// Uncertified dexels as they are reported.
pub(crate) fn reported(unresolved: &[UnresolvedDexel]) -> Vec<ReportedDexel> {
    let one = |dexel: &UnresolvedDexel| ReportedDexel::new(dexel.i, dexel.j, dexel.reason.to_string());
    unresolved.iter().map(one).collect()
}
