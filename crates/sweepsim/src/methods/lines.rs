//! Algorithm 4: for each line, the point systems of patches (Eq. 6), of edges (Eq. 7), and of caps and kinks.
//!
//! From line to line only `x` and `y` change, so the systems of one patch under one motion form a [`Bundle`]: they share one subdivision, each as
//! long as the box may hold a solution, and each root has its own certificate.

use crate::envelope::systems::{EdgeMotion, PatchMotion, PlacedPatch};
use crate::envelope::{
    AnyBox, Apart, EdgeMap, InPart, JointSide, OfPart, OnEdge, OnPatch, OnPlaced, PatchMap, PlacedMap, ROUNDING,
};
use crate::methods::charts::Charts;
use crate::methods::lattice::LineMask;
use crate::methods::method::{CrossingMethod, Query, WorkShare, in_blocks};
use crate::methods::search::placement::sides;
use crate::methods::workspace::Solvers;
use crate::time::over::{DyadicInterval, Over};
use crate::time::path_parts::PathPart;
use rayon::prelude::*;
use sweepsim_motion::{NormalField, Patch, SegmentEnd, Tool};
use sweepsim_solve::{Bundle, CancelOnly, Preimage, Sink, UnresolvedTarget};
use sweepsim_spline::Bernstein;

/// The number of dexel columns whose lines form a bundle.
const STRIP: usize = 128;

/// The systems of each part of a chunk.
pub(crate) struct Lines {
    bundles: Vec<PartBundles>,
}

/// The systems of one part of a path. Where they cannot be built (numbers out of range), charts are used.
#[derive(Clone, Debug)]
struct PartBundles {
    patches: Vec<Option<Bundle<3>>>,
    edges: Vec<Option<Bundle<2>>>,
    /// At its start and, if it is the last part, at its end.
    placed: [Vec<Option<Bundle<2>>>; 2],
}

impl PartBundles {
    /// Those of `parts[at]`.
    fn new(tool: &Tool, parts: &[PathPart], at: usize, part: DyadicInterval) -> Self {
        let segment = &parts[at].segment;
        let face = |patch: &Patch| {
            let [u, v] = Apart::new(&patch.shrunk_sides()).rest;
            let motion = PatchMotion::over(patch, segment, [u, v, part]);
            let ([x, y, _], weight) = motion.position();
            Bundle::new(vec![x.clone(), y.clone()], weight, vec![motion.condition().clone()]).ok()
        };
        let rim = |edge| {
            let motion = EdgeMotion::over(edge, segment, part);
            let ([x, y, _], weight) = motion.position();
            let [before, after] = motion.conditions().clone();
            let bundle = Bundle::new(vec![x.clone(), y.clone()], weight, vec![]).ok()?;
            bundle.where_signs_differ(before, after).ok()
        };
        let placed = |end: SegmentEnd| {
            let (turn, tip) = match end {
                SegmentEnd::Start => (segment.start(), nalgebra::Vector3::from(segment.tips()[0])),
                SegmentEnd::Finish => (segment.end(), nalgebra::Vector3::from(segment.tips()[1])),
            };
            let [before, after] = sides(parts, at, end);
            let bundle = |patch: &Patch| {
                let place = PlacedPatch::new(patch, &turn, &tip);
                let ([x, y, _], weight) = place.position();
                let bundle = Bundle::new(vec![x.clone(), y.clone()], weight, vec![]).ok()?;
                let [before, after] = [before, after].map(|side| condition(&side, patch.field()));
                bundle.where_signs_differ(before?, after?).ok()
            };
            tool.patches().iter().map(bundle).collect()
        };
        Self {
            patches: tool.patches().iter().map(face).collect(),
            edges: tool.edges().iter().map(rim).collect(),
            placed: [
                placed(SegmentEnd::Start),
                if at + 1 == parts.len() {
                    placed(SegmentEnd::Finish)
                } else {
                    Vec::new()
                },
            ],
        }
    }
}

/// Solves a bundle whose forms are those over a part of the map's domain. Returns the lines that it leaves to charts, none of whose solutions are reported.
fn bundled<const N: usize, M: AnyBox<N>>(
    bundle: &Bundle<N>,
    map: &mut M,
    part: [DyadicInterval; N],
    query: Query,
    solvers: &mut Solvers,
    sink: &mut impl Sink<N, M::Seen>,
) -> Option<LineMask> {
    let monitor = &CancelOnly(query.monitor);
    let mark = sink.mark();
    let (mut rest, mut sink) = (Vec::new(), OfPart { sink, part });
    let mut decided = Decided {
        sink: &mut sink,
        rest: &mut rest,
    };
    if part.iter().all(DyadicInterval::is_whole) {
        solvers.bundles.solve(bundle, map, query.lines, &mut decided, monitor);
    } else {
        let map = InPart::new(map, part);
        solvers.bundles.solve(bundle, &map, query.lines, &mut decided, monitor);
    }
    rest.sort_unstable();
    rest.dedup();
    if rest.is_empty() {
        return None;
    }
    sink.forget_targets(mark, &rest);
    LineMask::new(query.lines.grid, rest.iter().map(|line| *line as u32))
}

/// Passes solutions on, and lists lines with open boxes.
struct Decided<'s, K> {
    sink: &'s mut K,
    rest: &'s mut Vec<usize>,
}

impl<const N: usize, S, K: Sink<N, S>> Sink<N, S> for Decided<'_, K> {
    fn found(&mut self, preimage: Preimage<N, S>) {
        self.sink.found(preimage);
    }

    fn mark(&self) -> usize {
        self.sink.mark()
    }

    fn forget(&mut self, mark: usize) {
        self.sink.forget(mark);
    }

    fn forget_targets(&mut self, mark: usize, targets: &[usize]) {
        self.sink.forget_targets(mark, targets);
    }

    fn unresolved(&mut self, target: UnresolvedTarget<N>) {
        self.rest.push(target.target);
    }
}

impl CrossingMethod<'_> for Lines {
    fn prepare(tool: &Tool, chunk: &[PathPart], over: &Over) -> Self {
        let bundles = (0..chunk.len()).into_par_iter();
        Self {
            bundles: bundles
                .map(|at| PartBundles::new(tool, chunk, at, over.part(&chunk[at].segment)))
                .collect(),
        }
    }

    /// In blocks of parts, and within these in strips of columns, whose lines form a bundle.
    fn shares(parts: usize, columns: usize) -> Vec<WorkShare> {
        let strips = || {
            (0..columns)
                .step_by(STRIP)
                .map(|first| [first, (first + STRIP).min(columns) - 1])
        };
        let blocks = in_blocks(parts);
        blocks
            .flat_map(|parts| {
                strips().map(move |columns| WorkShare {
                    parts: parts.clone(),
                    columns,
                })
            })
            .collect()
    }

    fn on_patch(&self, query: Query, map: &mut PatchMap, solvers: &mut Solvers, sink: &mut impl Sink<3, OnPatch>) {
        match &self.bundles[query.part].patches[query.number] {
            Some(bundle) => {
                let Apart { rest: [u, v], beside } = Apart::new(&map.element.poles);
                if let Some(mask) = bundled(bundle, map, [u, v, query.times.0], query, solvers, sink) {
                    let lines = &query.lines.clone().masked(Some(&mask));
                    Charts::on_part([u, v], Query { lines, ..query }, map, solvers, sink);
                }
                for part in beside {
                    Charts::on_part(part, query, map, solvers, sink);
                }
            }
            None => Charts.on_patch(query, map, solvers, sink),
        }
    }

    fn on_edge(&self, query: Query, map: &mut EdgeMap, solvers: &mut Solvers, sink: &mut impl Sink<2, OnEdge>) {
        match &self.bundles[query.part].edges[query.number] {
            Some(bundle) => {
                if let Some(mask) = bundled(
                    bundle,
                    map,
                    [DyadicInterval::WHOLE, query.times.0],
                    query,
                    solvers,
                    sink,
                ) {
                    let lines = &query.lines.clone().masked(Some(&mask));
                    Charts.on_edge(Query { lines, ..query }, map, solvers, sink);
                }
            }
            None => Charts.on_edge(query, map, solvers, sink),
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
        let placed = &self.bundles[query.part].placed[usize::from(end == SegmentEnd::Finish)];
        match placed.get(query.number).and_then(Option::as_ref) {
            Some(bundle) => {
                if let Some(mask) = bundled(bundle, map, [DyadicInterval::WHOLE; 2], query, solvers, sink) {
                    let lines = &query.lines.clone().masked(Some(&mask));
                    Charts.on_placed(Query { lines, ..query }, end, map, solvers, sink);
                }
            }
            None => Charts.on_placed(query, end, map, solvers, sink),
        }
    }
}

/// `g` at a placement, in the patch's parameters; beyond the ends of a path, a constant of the same sign.
fn condition(side: &JointSide, field: &NormalField) -> Option<Bernstein> {
    let twist = match side {
        JointSide::Beyond(negative) => return Some(Bernstein::constant(2, if *negative { -1.0 } else { 1.0 })),
        JointSide::Moving(twist) => twist,
    };
    let pairs = || {
        let turning = twist.spin.iter().zip(field.moment());
        turning.chain(twist.travel.iter().zip(field.normal()))
    };
    let sum = pairs().fold(Bernstein::constant(2, 0.0), |sum, (factor, form)| {
        if *factor == 0.0 {
            sum
        } else {
            sum.add(&form.scale(*factor))
        }
    });
    // The velocity is rounded as well.
    let size: f64 = pairs().map(|(factor, form)| factor.abs() * largest(form)).sum();
    let zero = sum.coefficients().iter().all(|c| *c == 0.0);
    let error = if zero { 0.0 } else { sum.error() + ROUNDING * size };
    Bernstein::with_error(sum.degrees(), sum.coefficients().to_vec(), error).ok()
}

fn largest(form: &Bernstein) -> f64 {
    form.coefficients().iter().fold(0.0, |m, c| m.max(c.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cutter::{cells::Cells, patch_forms::PatchForms};
    use crate::envelope::{EdgeMap, PatchMap, PlacedMap, Size};
    use crate::time::pieces::Times;
    use sweepsim_motion::{Pose, Segment};
    use sweepsim_props::*;
    use sweepsim_solve::ChartMap;

    const SIZE: Size = Size {
        spacing: [1.0; 2],
        system_rounding: 1e-12,
    };

    /// `X`, `Y` of forms at a point.
    fn plane(([x, y, _], weight): (&[Bernstein; 3], &Bernstein), at: &[f64]) -> [f64; 2] {
        [x, y].map(|form| form.evaluate(at) / weight.evaluate(at))
    }

    proptest! {
        /// Bundles take bounds from the forms and points from the maps, so both must describe the same functions.
        #[test]
        fn maps_are_what_the_forms_say(
            tool in 0..3usize,
            lean in [-0.8..0.8, -0.8..0.8],
            tip in [-20.0..20.0, -20.0..20.0, -20.0..20.0],
            at in [0.0..1.0, 0.0..1.0, 0.0..1.0],
            moves in prop::bool::ANY,
        ) {
            let tool = [Tool::ball(5.0, 30.0), Tool::flat(5.0, 30.0), Tool::bull(5.0, 1.0, 30.0)][tool].clone().unwrap();
            let start = Pose::new([0.0; 3], [0.1, 0.2, 1.0]).unwrap();
            let axis = if moves { [lean[0], lean[1], 1.0] } else { [0.1, 0.2, 1.0] };
            let segment: Segment = Segment::between(&start, &Pose::new(tip, axis).unwrap()).remove(0);
            let mut times = Times::new(&segment);
            let (faces, rims) = PatchForms::all(&tool);
            // About a hundred roundings of numbers of up to a hundred, and of products of two.
            let near = |a: f64, b: f64| (a - b).abs() <= 1e-10;
            for (patch, element) in tool.patches().iter().zip(&faces) {
                let motion = PatchMotion::new(patch, &segment);
                let mut cells = Cells::new(element);
                let map = PatchMap::new(element, &mut cells, &mut times, SIZE);
                let [x, y, g] = map.evaluate(&at).value;
                let [a, b] = plane(motion.position(), &at);
                prop_assert!(near(x, a) && near(y, b) && near(g, motion.condition().evaluate(&at)));
                let [before, after] = [
                    crate::methods::search::placement::twist(&segment, SegmentEnd::Start, &segment.start()),
                    JointSide::Beyond(true),
                ];
                let (turn, own_tip) = (segment.start(), nalgebra::Vector3::from(segment.tips()[0]));
                let map = PlacedMap::new(element, &mut cells, (turn, own_tip), [before, after], SIZE);
                let sample = map.evaluate(&[at[0], at[1]]);
                let [a, b] = plane(PlacedPatch::new(patch, &turn, &own_tip).position(), &at[..2]);
                prop_assert!(near(sample.value[0], a) && near(sample.value[1], b));
                let origin = [at[0], at[1]];
                for (near_side, side) in [(sample.seen.before, before), (sample.seen.after, after)] {
                    let form = condition(&side, patch.field()).unwrap();
                    prop_assert!(near(near_side.at(&origin, &origin), form.evaluate(&origin)));
                }
            }
            for (edge, element) in tool.edges().iter().zip(&rims) {
                let motion = EdgeMotion::new(edge, &segment);
                let mut cells = Cells::new(element);
                let map = EdgeMap::new(element, &mut cells, &mut times, SIZE);
                let origin = [at[0], at[2]];
                let sample = map.evaluate(&origin);
                let [a, b] = plane(motion.position(), &origin);
                prop_assert!(near(sample.value[0], a) && near(sample.value[1], b));
                for (side, form) in sample.seen.sides.iter().zip(motion.conditions()) {
                    prop_assert!(near(side.at(&origin, &origin), form.evaluate(&origin)));
                }
            }
        }
    }
}
