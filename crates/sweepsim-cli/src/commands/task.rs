//! What `simulate` and `sweep` compute, and with which options.

use crate::arguments::RunOptions;
use crate::warnings::Use;
use sweepsim::Options;
use sweepsim_formats::Job;

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
