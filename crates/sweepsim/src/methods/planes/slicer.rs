//! Algorithm 3: the envelope's section by a plane `x = const`, as curves, cut by the lines of that plane.
//!
//! [`CurveSolver`] gives the curves of Eq. 4 (patches) and Eq. 5 (edges; caps and kinks alike) with the right connectivity, as
//! polylines whose vertices lie on the curve. Each *span*, the curve between two vertices, lies in a known box: its chord's,
//! widened by the polyline's tolerance. Where the Jacobian of `(X, Y, g)` is regular on the box, `Y` is monotone along the span: a
//! line crosses it once, if it passes between the two ends, or never. Where it is not (about the extrema of `Y`) and a line may
//! cross, the span is halved at a point of the curve, and the boxes of the halves shrink around it by the mean value theorem.
//!
//! The sign of `Y − y` is taken once per vertex, so a closed curve has equally many crossings in both directions. Where curves or spans
//! cannot be decided (a patch that hardly moves along its normal, a plane through a singular point), no crossings are returned, and the patch is
//! left to the charts of the column's lines.

use crate::envelope::AnyBox;
use crate::methods::method::Query;
use crate::methods::planes::spans::{Cutting, DEPTH, Vertex};
use crate::tolerances::curve_options;
use nalgebra::{Const, DimMin, ToTypenum};
use sweepsim_solve::{CancelOnly, ChartStatistics, CurveSolver, Curves, Enclosure, Sink, System, SystemError};

/// Tolerances of the polylines, relative to the parameters' ranges: the boxes of spans are this much wider than those of the chords. The next
/// tolerance is tried if a span could not be decided with the previous one.
const TOLERANCES: [f64; 3] = [0.03, 0.003, 0.0003];
/// The budget of boxes for a section, and for each search on a face of one: the first number, and the second for each line, up to the third. Well-behaved sections need about ten to a
/// hundred; charts find the crossings of few lines sooner than more.
const BOXES: [u64; 3] = [50, 4, 4_000];
/// The budget of spans for a section, including halves: the first number, and the second for each vertex. Well-behaved sections need little more than one for each vertex; where a curve almost
/// touches itself, halving would never end.
const SPANS: [u32; 2] = [100, 2];

/// Finds the curves of sections.
#[derive(Debug)]
pub(crate) struct Slicer {
    curves: CurveSolver,
    /// Spans count as boxes, regular ones as charts.
    pub statistics: ChartStatistics,
}

impl Slicer {
    pub fn new() -> Self {
        Self {
            curves: CurveSolver::with_options(TOLERANCES[0], curve_options(BOXES[2], 4)),
            statistics: ChartStatistics::default(),
        }
    }

    /// Finds the preimages of the lines of `query`, all with one `x`, by way of the curves of `system` (which is `X = x`, and `g = 0`
    /// where the map has it). Returns `false`, and no preimages, if that does not decide it.
    pub fn solve<const N: usize, M>(
        &mut self,
        map: &mut M,
        system: Result<System, SystemError>,
        query: Query,
        accept: f64,
        sink: &mut impl Sink<N, M::Seen>,
    ) -> bool
    where
        M: AnyBox<N>,
        Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
    {
        let Ok(system) = system else {
            return false;
        };
        let mark = sink.mark();
        let [first, each, most] = BOXES;
        self.curves.options.boxes = most.min(first + each * query.lines.len() as u64);
        for tolerance in TOLERANCES {
            self.curves.tolerance = tolerance;
            let Ok(curves) = self.curves.solve(&system, &CancelOnly(query.monitor)) else {
                return false;
            };
            self.statistics.boxes += curves.statistics.boxes + curves.statistics.faces;
            if !curves.singular.is_empty() {
                return false;
            }
            let vertices: usize = curves.curves.iter().map(|curve| curve.points.len()).sum();
            let mut left = SPANS[0] + SPANS[1] * vertices as u32;
            if self.cut(map, &curves, tolerance, (query, accept), &mut left, sink) {
                return true;
            }
            sink.forget(mark);
            if left == 0 {
                return false;
            }
        }
        false
    }

    /// Intersects the curves with the lines; `false` if some span stays undecided. `left`: of the budget of spans.
    fn cut<const N: usize, M>(
        &mut self,
        map: &mut M,
        Curves { curves, skin, .. }: &Curves,
        tolerance: f64,
        (query, accept): (Query, f64),
        left: &mut u32,
        sink: &mut impl Sink<N, M::Seen>,
    ) -> bool
    where
        M: AnyBox<N>,
        Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
    {
        // With a skin, curves continue beyond the domain, at most this far.
        let region = Enclosure::hull(-2.0 * skin, 1.0 + 2.0 * skin);
        let mut cutting = Cutting {
            map,
            lattice: query.lines,
            monitor: query.monitor,
            x: query.lines.coordinate(0, query.lines.i[0]),
            accept,
            sink,
            statistics: &mut self.statistics,
            left,
        };
        for curve in curves {
            let count = curve.points.len();
            let mut from: Option<Vertex<N>> = None;
            let last = if curve.ends.is_none() { count + 1 } else { count };
            for k in 0..last {
                let point = &curve.points[k % count].point;
                let to = cutting.vertex(std::array::from_fn(|j| point[j]));
                if let Some(from) = from {
                    let within = std::array::from_fn(|j| {
                        let (lo, hi) = (from.x[j].min(to.x[j]), from.x[j].max(to.x[j]));
                        Enclosure::hull((lo - tolerance).max(region.lo()), (hi + tolerance).min(region.hi()))
                    });
                    if !cutting.span(&from, &to, within, DEPTH) {
                        return false;
                    }
                }
                from = Some(to);
            }
        }
        true
    }
}
