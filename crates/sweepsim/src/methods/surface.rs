//! Algorithm 1: the envelope of each patch as a surface in `u, v, t` (Eq. 2), intersected with all lines within the boxes that contain it.

use crate::envelope::systems::PatchMotion;
use crate::envelope::{AnyBox, EdgeMap, OnEdge, OnPatch, OnPlaced, PatchMap, PlacedMap, ROOT};
use crate::methods::charts::Charts;
use crate::methods::method::{CrossingMethod, Query};
use crate::methods::workspace::Solvers;
use crate::time::over::Over;
use crate::time::path_parts::PathPart;
use sweepsim_motion::{SegmentEnd, Tool};
use sweepsim_solve::{CancelOnly, ChartMap, Enclosure, Sink, SurfaceSolver, Targets};

/// How flat the surface is in its boxes, relative to the parameters' ranges.
const FLATNESS: f64 = 0.02;
/// The budget of boxes for an envelope surface. Well-behaved ones need about ten to a thousand.
const BOXES: u64 = 2_000;
/// A surface is sought with this many, and one for each line over which the patch may be: charts find the crossings of few lines sooner.
const LEAST_BOXES: u64 = 64;

/// Edges and patches at rest are surfaces without an equation: charts solve them.
pub(crate) struct Surfaces<'a> {
    tool: &'a Tool,
    chunk: &'a [PathPart],
}

impl<'a> CrossingMethod<'a> for Surfaces<'a> {
    fn prepare(tool: &'a Tool, chunk: &'a [PathPart], _: &Over) -> Self {
        Self { tool, chunk }
    }

    fn on_patch(&self, query: Query, map: &mut PatchMap, solvers: &mut Solvers, sink: &mut impl Sink<3, OnPatch>) {
        let values = map.values(&(ROOT.0, query.times.1));
        let lines = values.map_or(0, |values| query.lines.count(&values));
        if lines == 0 {
            return;
        }
        let motion = PatchMotion::new(&self.tool.patches()[query.number], &self.chunk[query.part].segment);
        let options = SurfaceSolver::new(FLATNESS)
            .options
            .boxes(BOXES.min(LEAST_BOXES + lines as u64))
            .unresolved(0);
        let mut solver = SurfaceSolver::with_options(FLATNESS, options);
        let surface = motion
            .envelope()
            .ok()
            .and_then(|system| solver.solve(&system, &CancelOnly(query.monitor)).ok());
        if let Some(surface) = &surface {
            solvers.moving.statistics.boxes += surface.statistics.boxes;
        }
        let Some(surface) = surface.filter(|surface| surface.unresolved.is_empty()) else {
            // No equation (the patch slides along itself), or a singular one: the whole domain is the box.
            Charts.on_patch(query, map, solvers, sink);
            return;
        };
        let domain = map.bounds(&ROOT);
        let times = Enclosure::hull(query.times.0.from, query.times.0.to());
        for mut bounds in surface.boxes {
            match bounds[2].intersection(times) {
                Some(within) if within.radius() > 0.0 => bounds[2] = within,
                _ => continue,
            }
            let mark = map.mark();
            let part = map.place(&bounds);
            solvers
                .moving
                .solve_part(map, part, &domain, query.lines, sink, &CancelOnly(query.monitor));
            map.release(mark);
        }
    }

    fn on_edge(&self, query: Query, map: &mut EdgeMap, solvers: &mut Solvers, sink: &mut impl Sink<2, OnEdge>) {
        Charts.on_edge(query, map, solvers, sink);
    }

    fn on_placed(
        &self,
        query: Query,
        end: SegmentEnd,
        map: &mut PlacedMap,
        solvers: &mut Solvers,
        sink: &mut impl Sink<2, OnPlaced>,
    ) {
        Charts.on_placed(query, end, map, solvers, sink);
    }
}
