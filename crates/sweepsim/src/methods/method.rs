//! The interface of the methods that find crossings.

use crate::envelope::{EdgeMap, OnEdge, OnPatch, OnPlaced, PatchMap, PlacedMap};
use crate::methods::lattice::Lattice;
use crate::methods::workspace::Solvers;
use crate::time::over::{DyadicInterval, Over};
use crate::time::path_parts::PathPart;
use std::ops::Range;
use sweepsim_motion::{SegmentEnd, Tool};
use sweepsim_solve::{Monitor, Sink};

/// A map of one part of the path, and the lines whose preimages are to be found.
#[derive(Clone, Copy)]
pub(crate) struct Query<'a> {
    /// Number of the part in its chunk.
    pub part: usize,
    /// Number of the tool's patch or edge.
    pub number: usize,
    pub lines: &'a Lattice<'a>,
    /// The part of the motion outside which the tool is not over the lines, and its piece.
    pub times: (DyadicInterval, u32),
    /// Tells the inner loops whether to stop.
    pub monitor: &'a dyn Monitor,
}

/// A unit of work: these parts of the path, on the lines of these columns.
#[derive(Clone, Debug)]
pub(crate) struct WorkShare {
    pub parts: Range<usize>,
    /// The first and the last.
    pub columns: [usize; 2],
}

/// A method of finding the preimages of dexel lines under the maps of the envelope: each exactly once, or the line is reported as unresolved.
pub(crate) trait CrossingMethod<'a>: Sized + Sync {
    /// The method's data for a chunk of the path, computed once for all its lines. They are of the parts of the motions in which the tool is over the lines.
    fn prepare(tool: &'a Tool, chunk: &'a [PathPart], over: &Over) -> Self;

    /// Divides the work on this many parts and columns into units. Crossings come in the order of the units.
    fn shares(parts: usize, columns: usize) -> Vec<WorkShare> {
        in_blocks(parts)
            .map(|parts| WorkShare {
                parts,
                columns: [0, columns - 1],
            })
            .collect()
    }

    /// Solves Eq. 6 for a patch under the motion.
    fn on_patch(&self, query: Query, map: &mut PatchMap, solvers: &mut Solvers, sink: &mut impl Sink<3, OnPatch>);

    /// Solves Eq. 7 for an edge under the motion.
    fn on_edge(&self, query: Query, map: &mut EdgeMap, solvers: &mut Solvers, sink: &mut impl Sink<2, OnEdge>);

    /// Solves for the points of a patch at rest, at the start or the end of the part.
    fn on_placed(
        &self,
        query: Query,
        end: SegmentEnd,
        map: &mut PlacedMap,
        solvers: &mut Solvers,
        sink: &mut impl Sink<2, OnPlaced>,
    );
}

/// The number of parts of a path that a worker takes at a time: the charts of a tool at rest are kept for all of them.
const BLOCK: usize = 4;

/// Parts in blocks of a few.
pub(crate) fn in_blocks(parts: usize) -> impl Iterator<Item = Range<usize>> {
    (0..parts.div_ceil(BLOCK)).map(move |block| block * BLOCK..((block + 1) * BLOCK).min(parts))
}
