//! The default method: one subdivision for all lines. Boxes on which a map is injective are charts, and serve every line that meets them.

use crate::envelope::{EdgeMap, OnEdge, OnPatch, OnPlaced, PatchMap, PlacedMap, ROOT};
use crate::methods::method::{CrossingMethod, Query};
use crate::methods::workspace::Solvers;
use crate::time::over::{DyadicInterval, Over};
use crate::time::path_parts::PathPart;
use sweepsim_motion::{SegmentEnd, Tool};
use sweepsim_solve::{CancelOnly, ChartMap, Sink};

/// Charts need only the maps.
#[derive(Clone)]
pub(crate) struct Charts;

impl Charts {
    /// Solves Eq. 6 for a part of a patch. Solutions on its upper sides belong to other parts.
    pub fn on_part(
        [u, v]: [DyadicInterval; 2],
        query: Query,
        map: &mut PatchMap,
        solvers: &mut Solvers,
        sink: &mut impl Sink<3, OnPatch>,
    ) {
        let domain = map.bounds(&ROOT);
        let mark = map.cells.mark();
        let cell = map.cells.place(map.element, [u.from, v.from], [u.to(), v.to()]);
        let monitor = &CancelOnly(query.monitor);
        solvers
            .moving
            .solve_part(map, (cell, query.times.1), &domain, query.lines, sink, monitor);
        map.cells.release(mark);
    }
}

impl CrossingMethod<'_> for Charts {
    fn prepare(_: &Tool, _: &[PathPart], _: &Over) -> Self {
        Self
    }

    fn on_patch(&self, query: Query, map: &mut PatchMap, solvers: &mut Solvers, sink: &mut impl Sink<3, OnPatch>) {
        let (part, domain) = ((ROOT.0, query.times.1), map.bounds(&ROOT));
        let monitor = &CancelOnly(query.monitor);
        solvers
            .moving
            .solve_part(map, part, &domain, query.lines, sink, monitor);
    }

    fn on_edge(&self, query: Query, map: &mut EdgeMap, solvers: &mut Solvers, sink: &mut impl Sink<2, OnEdge>) {
        let (part, domain) = ((ROOT.0, query.times.1), map.bounds(&ROOT));
        let monitor = &CancelOnly(query.monitor);
        solvers
            .moving
            .solve_part(map, part, &domain, query.lines, sink, monitor);
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
