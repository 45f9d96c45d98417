//! The default method: one subdivision for all lines. Boxes on which a map is injective are charts, and serve every line that meets them.

use crate::envelope::{EdgeMap, OnEdge, OnPatch, OnPlaced, PatchMap, PlacedMap, ROOT};
use crate::methods::method::{CrossingMethod, Query};
use crate::methods::workspace::Solvers;
use crate::time::path_parts::PathPart;
use sweepsim_motion::{SegmentEnd, Tool};
use sweepsim_solve::{CancelOnly, Sink};

/// Charts need only the maps.
pub(crate) struct Charts;

impl CrossingMethod<'_> for Charts {
    fn prepare(_: &Tool, _: &[PathPart]) -> Self {
        Self
    }

    fn on_patch(&self, query: Query, map: &mut PatchMap, solvers: &mut Solvers, sink: &mut impl Sink<3, OnPatch>) {
        solvers
            .moving
            .solve(map, ROOT, query.lines, sink, &CancelOnly(query.monitor));
    }

    fn on_edge(&self, query: Query, map: &mut EdgeMap, solvers: &mut Solvers, sink: &mut impl Sink<2, OnEdge>) {
        solvers
            .moving
            .solve(map, ROOT, query.lines, sink, &CancelOnly(query.monitor));
    }

    fn on_placed(
        &self,
        query: Query,
        _: SegmentEnd,
        map: &mut PlacedMap,
        solvers: &mut Solvers,
        sink: &mut impl Sink<2, OnPlaced>,
    ) {
        solvers
            .placed
            .solve(map, 0, query.lines, sink, &CancelOnly(query.monitor));
    }
}
