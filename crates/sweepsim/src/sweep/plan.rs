//! A tool and a path, prepared for any lines.

use crate::cutter::Cutter;
use crate::error::SweepError;
use crate::methods::translation::GAP;
use crate::sweep::options::{Method, Options};
use crate::sweep::short_tools::ShortTools;
use crate::sweep::spare::{Spaces, SpareLists};
use crate::time::path_parts::{self, Kind, PathPart};
use crate::tolerances::Tolerances;
use std::ops::Range;
use std::sync::Arc;
use sweepsim_dexel::Frame;
use sweepsim_motion::{Path, Tool};

/// A tool and a path, prepared for any lines.
pub(crate) struct Plan {
    pub cutter: Arc<Cutter>,
    /// The same tool, cut off.
    pub short: Arc<ShortTools>,
    pub parts: Vec<PathPart>,
    pub tolerances: Tolerances,
    pub spaces: Spaces,
    pub lists: SpareLists,
    /// The largest coordinate of tool, lines and path.
    size: f64,
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
        Self::of_moves((tool, path, 0..path.moves()), frame, extent, options)
    }

    /// The same, of some moves only.
    pub fn of_moves(
        (tool, path, moves): (&Tool, &Path, Range<usize>),
        frame: &Frame,
        extent: impl Iterator<Item = f64>,
        options: &Options,
    ) -> Result<Self, SweepError> {
        let cutter = Arc::new(Cutter::new(tool));
        let size = extent.map(f64::abs).fold(cutter.reach.max(far(path, frame)), f64::max);
        let prepared = (cutter, Arc::new(ShortTools::new(tool)));
        Self::prepared(prepared, (tool, path, moves), frame, size, options)
    }

    /// The same tool along another path, over the same lines: what is prepared of the tool serves both.
    pub fn along(&self, (tool, path): (&Tool, &Path), frame: &Frame, options: &Options) -> Result<Self, SweepError> {
        let far = far(path, frame);
        // Limits follow from the size, and workspaces are kept for each: rounded up, there are few.
        let rounded = far.log2().ceil().exp2();
        let size = match far > self.size {
            true if Tolerances::new(options.tolerance, rounded).is_ok() => rounded,
            true => far,
            false => self.size,
        };
        let prepared = (Arc::clone(&self.cutter), Arc::clone(&self.short));
        let plan = Self::prepared(prepared, (tool, path, 0..path.moves()), frame, size, options)?;
        Ok(Self {
            spaces: Arc::clone(&self.spaces),
            lists: Arc::clone(&self.lists),
            ..plan
        })
    }

    fn prepared(
        (cutter, short): (Arc<Cutter>, Arc<ShortTools>),
        (tool, path, moves): (&Tool, &Path, Range<usize>),
        frame: &Frame,
        size: f64,
        options: &Options,
    ) -> Result<Self, SweepError> {
        let tolerances = Tolerances::new(options.tolerance, size)?;
        let whole = cutter.outline.as_ref().is_some_and(|outline| outline.complete);
        let kind = Kind {
            symmetric: tool.is_revolved(),
            closed: whole && options.method == Method::Mixed,
        };
        let parts = path_parts::parts((path, moves), frame, kind, cutter.reach, &tolerances);
        Ok(Self {
            parts,
            cutter,
            short,
            tolerances,
            spaces: Spaces::default(),
            lists: SpareLists::default(),
            size,
        })
    }

    /// Lines and tips are displaced by less than this.
    pub fn margin(&self) -> f64 {
        self.tolerances.outside() + self.tolerances.rounding()
    }

    /// What is so far above all material is far enough.
    pub fn gap(&self) -> f64 {
        self.margin().max(GAP * self.cutter.reach)
    }
}

/// The largest coordinate of a path in a frame: turned by any angle, and moved.
fn far(path: &Path, frame: &Frame) -> f64 {
    if frame.is_world() {
        path.size()
    } else {
        3.0_f64.sqrt() * path.size() + frame.origin().iter().map(|c| c.abs()).sum::<f64>()
    }
}
