//! A tool and a path, prepared for any lines.

use crate::cutter::Cutter;
use crate::sweep::options::Options;
use crate::sweep::report::SweepError;
use crate::time::path_parts::{self, PathPart};
use sweepsim_dexel::Frame;
use sweepsim_motion::{Path, Tool};

/// A tool and a path, prepared for any lines.
pub(crate) struct Plan {
    pub cutter: Cutter,
    pub parts: Vec<PathPart>,
    pub size: f64,
    pub accept: f64,
}

impl Plan {
    /// Everything as seen from `frame`. `extent`: coordinates of the lines.
    pub fn new(
        tool: &Tool,
        path: &Path,
        frame: &Frame,
        extent: impl Iterator<Item = f64>,
        options: &Options,
    ) -> Result<Self, SweepError> {
        let tolerance = options.tolerance;
        if !(tolerance > 0.0 && tolerance.is_finite()) {
            return Err(SweepError::Tolerance(tolerance));
        }
        let cutter = Cutter::new(tool);
        // Turned by any angle, and moved.
        let far = if frame.is_world() {
            path.size()
        } else {
            3.0_f64.sqrt() * path.size() + frame.origin().iter().map(|c| c.abs()).sum::<f64>()
        };
        let size = extent.map(f64::abs).fold(cutter.reach.max(far), f64::max);
        let least = 2e4 * f64::EPSILON * size;
        if tolerance < least {
            return Err(SweepError::TooFine { tolerance, size, least });
        }
        Ok(Self {
            parts: path_parts::parts(path, frame, tool.is_revolved(), cutter.reach, tolerance),
            // The square of the last step, times lengths of the tool's size, is a small part of the tolerance.
            accept: (1e-3 * tolerance / size).sqrt().clamp(1e-9, 1e-5),
            cutter,
            size,
        })
    }
}
