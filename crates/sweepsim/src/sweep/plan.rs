//! A tool and a path, prepared for any lines.

use crate::cutter::Cutter;
use crate::error::SweepError;
use crate::sweep::options::Options;
use crate::time::path_parts::{self, PathPart};
use crate::tolerances::Tolerances;
use sweepsim_dexel::Frame;
use sweepsim_motion::{Path, Tool};

/// A tool and a path, prepared for any lines.
pub(crate) struct Plan {
    pub cutter: Cutter,
    pub parts: Vec<PathPart>,
    pub tolerances: Tolerances,
}

impl Plan {
    /// Transforms everything into `frame`. `extent`: coordinates of the lines.
    pub fn new(
        tool: &Tool,
        path: &Path,
        frame: &Frame,
        extent: impl Iterator<Item = f64>,
        options: &Options,
    ) -> Result<Self, SweepError> {
        let cutter = Cutter::new(tool);
        // Turned by any angle, and moved.
        let far = if frame.is_world() {
            path.size()
        } else {
            3.0_f64.sqrt() * path.size() + frame.origin().iter().map(|c| c.abs()).sum::<f64>()
        };
        let size = extent.map(f64::abs).fold(cutter.reach.max(far), f64::max);
        let tolerances = Tolerances::new(options.tolerance, size)?;
        Ok(Self {
            parts: path_parts::parts(path, frame, tool.is_revolved(), cutter.reach, &tolerances),
            cutter,
            tolerances,
        })
    }
}
