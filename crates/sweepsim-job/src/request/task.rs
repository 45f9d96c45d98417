//! What a request asks for.

use crate::base::JobError;
use crate::warnings::Use;
use serde::{Deserialize, Serialize};

/// What to compute.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Task {
    /// The remaining stock.
    Simulate,
    /// The swept volume.
    Sweep,
    /// The remaining stock, and all that is wrong with the program.
    Verify,
    /// The curves in which a plane cuts the swept volume.
    Section,
}

impl Task {
    /// The name of the command.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Simulate => "simulate",
            Self::Sweep => "sweep",
            Self::Verify => "verify",
            Self::Section => "section",
        }
    }

    /// What of a job it looks at.
    pub(crate) fn uses(self) -> Use {
        Use {
            command: self.name(),
            stock: matches!(self, Self::Simulate | Self::Verify),
            grid: self != Self::Section,
            judges: self == Self::Verify,
        }
    }
}

/// The outputs of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Output {
    /// `dexels.csv`.
    Dexels,
    /// `part.ply`; with [`Method::Surface`](sweepsim::Method::Surface) and [`Task::Sweep`] also the envelope.
    Mesh,
    /// `part.png`.
    Picture,
    /// `report.html` and `report.json`.
    Report,
    /// `part.dexels`: dexels with normals and sources.
    Binary,
    /// `part.tridexels`: the same along x, y and z, so that later runs go on with sharp walls.
    Tridexels,
    /// `part.step`: planes, cylinders and other surfaces with the edges between them, for CAD systems.
    Step,
    /// `certificate.json`: what [`Task::Verify`] has proven, for [`check`](crate::check).
    Certificate,
}

impl Output {
    /// What is written if nothing else is asked for.
    pub const DEFAULT: [Self; 5] = [Self::Dexels, Self::Mesh, Self::Picture, Self::Report, Self::Certificate];
}

/// Refuses outputs that a task does not have.
pub(super) fn check_outputs(task: Task, asked: &[Output], proof: bool) -> Result<(), JobError> {
    if !asked.contains(&Output::Certificate) || (task == Task::Verify && proof) {
        return Ok(());
    }
    let why = match task {
        Task::Verify => "there is none without a proof: leave out --no-proof, or it",
        _ => "expected dexels, mesh, picture, report, binary, tridexels or step: `verify` alone proves something",
    };
    Err(JobError::request("only certificate", why))
}

/// The directions of the dexels that meshes and pictures are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Directions {
    /// Along x, y and z.
    Xyz,
    /// Along z only.
    Z,
}
