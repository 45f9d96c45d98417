//! Algorithm 3: the envelope's sections by the planes `x = const` (Eq. 4 and 5), as curves, cut by the lines of each plane.

mod jacobian;
pub(crate) mod slicer;
mod spans;

use crate::envelope::systems::{EdgeMotion, PatchMotion, PlacedPatch, Plane};
use crate::envelope::{AnyBox, Apart, Brick, EdgeMap, InPart, OfPart, OnEdge, OnPatch, OnPlaced, PatchMap, PlacedMap};
use crate::methods::charts::Charts;
use crate::methods::lattice::Lattice;
use crate::methods::method::{CrossingMethod, Query, WorkShare};
use crate::methods::planes::slicer::Slicer;
use crate::methods::workspace::Solvers;
use crate::time::over::{DyadicInterval, Over};
use crate::time::path_parts::PathPart;
use nalgebra::{Const, DimMin, Matrix3, ToTypenum, Vector3};
use rayon::prelude::*;
use sweepsim_motion::{Segment, SegmentEnd, Tool};
use sweepsim_solve::{ChartSolver, Sink, System, SystemError};

/// The exact forms of each part of a chunk.
pub(crate) struct Planes {
    forms: Vec<Forms>,
}

/// A tool under one motion, and at rest at its start and end.
#[derive(Clone, Debug)]
struct Forms {
    patches: Vec<PatchMotion>,
    edges: Vec<EdgeMotion>,
    placed: [Vec<PlacedPatch>; 2],
}

impl Forms {
    fn new(tool: &Tool, segment: &Segment, part: DyadicInterval) -> Self {
        let [first, last] = segment.tips().map(Vector3::from);
        let at_rest = |turn: Matrix3<f64>, tip: &Vector3<f64>| {
            let patches = tool.patches().iter();
            patches.map(|patch| PlacedPatch::new(patch, &turn, tip)).collect()
        };
        Self {
            patches: tool
                .patches()
                .iter()
                .map(|patch| {
                    let [u, v] = Apart::new(&patch.shrunk_sides()).rest;
                    PatchMotion::over(patch, segment, [u, v, part])
                })
                .collect(),
            edges: tool
                .edges()
                .iter()
                .map(|edge| EdgeMotion::over(edge, segment, part))
                .collect(),
            placed: [at_rest(segment.start(), &first), at_rest(segment.end(), &last)],
        }
    }
}

/// The plane of lines with one `x`.
fn plane(lines: &Lattice) -> Plane {
    Plane::of_lines(lines.coordinate(0, lines.i[0]))
}

/// Solves a map by the curves in the lines' plane; `false`, without solutions, if that fails to decide it.
fn slice<const N: usize, M: AnyBox<N>>(
    map: &mut M,
    system: impl FnOnce() -> Result<System, SystemError>,
    query: Query,
    (slicer, charts): (&mut Slicer, &ChartSolver<M::Cell>),
    sink: &mut impl Sink<N, M::Seen>,
) -> bool
where
    Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
{
    // Most planes miss most patches.
    let root = map.root();
    let touches = map
        .values(&root)
        .is_some_and(|values| query.lines.meets([values[0], values[1]]));
    !touches || slicer.solve(map, system(), query, charts.options.accept, sink)
}

/// The same for a map under a motion, over a part of its domain, of which the system is.
fn slice_moving<const N: usize, M: AnyBox<N, Cell = Brick>>(
    map: &mut M,
    system: impl FnOnce() -> Result<System, SystemError>,
    part: [DyadicInterval; N],
    query: Query,
    solvers: &mut Solvers,
    sink: &mut impl Sink<N, M::Seen>,
) -> bool
where
    Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
{
    let solvers = (&mut solvers.slicer, &solvers.moving);
    if part.iter().all(DyadicInterval::is_whole) {
        return slice(map, system, query, solvers, sink);
    }
    let mark = map.mark();
    let mut sink = OfPart { sink, part };
    let is_decided = slice(&mut InPart::new(map, part), system, query, solvers, &mut sink);
    map.release(mark);
    is_decided
}

impl CrossingMethod<'_> for Planes {
    fn prepare(tool: &Tool, chunk: &[PathPart], over: &Over) -> Self {
        let forms = chunk
            .par_iter()
            .map(|part| Forms::new(tool, &part.segment, over.part(&part.segment)));
        Self { forms: forms.collect() }
    }

    /// Column by column, since each column is a plane.
    fn shares(parts: usize, columns: usize) -> Vec<WorkShare> {
        let column = |i: usize| WorkShare {
            parts: 0..parts,
            columns: [i, i],
        };
        (0..columns).map(column).collect()
    }

    fn on_patch(&self, query: Query, map: &mut PatchMap, solvers: &mut Solvers, sink: &mut impl Sink<3, OnPatch>) {
        let system = || self.forms[query.part].patches[query.number].section(&plane(query.lines));
        let Apart { rest: [u, v], beside } = Apart::new(&map.element.poles);
        if slice_moving(map, system, [u, v, query.times.0], query, solvers, sink) {
            for part in beside {
                Charts::on_part(part, query, map, solvers, sink);
            }
        } else {
            Charts.on_patch(query, map, solvers, sink);
        }
    }

    fn on_edge(&self, query: Query, map: &mut EdgeMap, solvers: &mut Solvers, sink: &mut impl Sink<2, OnEdge>) {
        let system = || self.forms[query.part].edges[query.number].section(&plane(query.lines));
        if !slice_moving(
            map,
            system,
            [DyadicInterval::WHOLE, query.times.0],
            query,
            solvers,
            sink,
        ) {
            Charts.on_edge(query, map, solvers, sink);
        }
    }

    fn on_placed(
        &self,
        query: Query,
        end: SegmentEnd,
        map: &mut PlacedMap,
        solvers: &mut Solvers,
        sink: &mut impl Sink<2, OnPlaced>,
    ) {
        let placed = &self.forms[query.part].placed[usize::from(end == SegmentEnd::Finish)];
        let system = || placed[query.number].section(&plane(query.lines));
        if !slice(map, system, query, (&mut solvers.slicer, &solvers.placed), sink) {
            Charts.on_placed(query, end, map, solvers, sink);
        }
    }
}
