//! The tool, prepared once for all moves: its patches and edges as forms, cut into cells on demand.

pub(crate) mod cells;
pub(crate) mod direct;
mod errors;
pub(crate) mod outline;
pub(crate) mod patch_forms;
mod places;
pub(crate) mod reduced;
pub(crate) mod revolution;
mod tangents;
mod vanishing;

use nalgebra::Vector3;
use outline::Outline;
use patch_forms::PatchForms;
use sweepsim_motion::Tool;

/// A tool, prepared.
pub(crate) struct Cutter {
    pub patches: Vec<PatchForms>,
    pub edges: Vec<PatchForms>,
    /// The meridian, if the tool is one of revolution.
    pub outline: Option<Outline>,
    /// No point of the tool is farther from its tip.
    pub reach: f64,
}

impl Cutter {
    pub fn new(tool: &Tool) -> Self {
        let (patches, edges) = PatchForms::all(tool);
        let reach = tool
            .patches()
            .iter()
            .flat_map(|patch| {
                let weights = patch.weight().coefficients();
                (0..weights.len()).map(move |i| {
                    Vector3::from([0, 1, 2].map(|k| patch.position()[k].coefficients()[i] / weights[i])).norm()
                })
            })
            .fold(0.0, f64::max);
        Self {
            patches,
            edges,
            outline: Outline::new(tool),
            reach,
        }
    }
}
