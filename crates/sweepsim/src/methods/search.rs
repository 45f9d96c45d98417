//! The equations of a stretch of path, and the meaning of their solutions: the crossings of dexel lines with the envelope, the edges, the kinks and the
//! two caps.

mod ceiling;
pub(super) mod placement;

pub(crate) use ceiling::Ceiling;

use crate::cutter::Cutter;
use crate::cutter::cells::Cells;
use crate::cutter::outline::Outline;
use crate::envelope::{EdgeMap, OnEdge, OnPatch, PatchMap, ROOT, Size};
use crate::methods::harvest::{Collector, Harvest, unit};
use crate::methods::lattice::Lattice;
use crate::methods::lattice::LineMask;
use crate::methods::method::{CrossingMethod, Query};
use crate::methods::translation::{self, Grazed, Heading, Patches};
use crate::methods::turning::{self, Accuracy, Element, Leftover, Searching};
use crate::methods::workspace::Workspace;
use crate::time::over::{DyadicInterval, Over, comes_near};
use crate::time::path_parts::{PartKind, PathPart};
use crate::time::pieces::Times;
use sweepsim_dexel::{Crossing, Source};
use sweepsim_motion::{Segment, SegmentEnd};
use sweepsim_solve::{CancelOnly, ChartMap, Monitor, Preimage, Sink};

/// A search of some lines along some parts of a path.
///
/// Only what calls a [method](CrossingMethod) depends on it, so that closed forms are compiled once.
#[derive(Clone)]
pub(crate) struct Search<'a> {
    pub cutter: &'a Cutter,
    pub parts: &'a [PathPart],
    /// The tool and the window of all lines: of each motion, only the part in which it is over them is searched.
    pub over: Over,
    pub lines: &'a Lattice<'a>,
    pub size: Size,
    /// Whether moves without rotation are to be solved by curves, of any tool.
    pub closed: bool,
    /// The tool's meridian, if moves without rotation are to be solved in closed form.
    pub outline: Option<&'a Outline>,
    /// A height above which crossings are not wanted.
    pub ceiling: Option<&'a Ceiling>,
    /// Heights closer than this may be the same.
    pub height_tolerance: f64,
    /// Number of the path, for sources.
    pub path: u32,
    pub monitor: &'a dyn Monitor,
}

impl Search<'_> {
    /// The crossings of a part: its envelope and edges, the kink or cap at its start, and the cap at the end of the last part.
    pub fn part<'a>(&self, method: &impl CrossingMethod<'a>, at: usize, space: &mut Workspace, harvest: &mut Harvest) {
        let segment = &self.parts[at].segment;
        if !self.reaches(segment) {
            return;
        }
        let mark = harvest.crossings.len();
        space.solvers.limit(self.lines.len());
        space.done.clear();
        let mut leftovers = Vec::new();
        if let Some(outline) = self.outline {
            self.envelope_in_closed_form(at, outline, space, harvest);
            leftovers = self.envelope_line_by_line(at, outline, space, harvest);
        }
        if self.closed {
            self.envelope_by_curves(at, space, harvest);
        }
        let done = space.done.patches.iter().chain(&space.done.edges);
        if !(done.into_iter().all(|done| *done) && leftovers.is_empty()) {
            let mut times = Times::new(segment);
            let part = self.over.part(segment);
            let piece = if part.is_whole() {
                ROOT.1
            } else {
                times.place(part.from, part.to())
            };
            self.patches(method, (at, (part, piece)), &mut times, space, harvest);
            self.edges(method, (at, (part, piece)), &mut times, space, harvest);
            for leftover in leftovers {
                self.leftover(at, &leftover, &mut times, space, harvest);
            }
        }
        self.placed(method, (at, SegmentEnd::Start), space, harvest);
        if at + 1 == self.parts.len() {
            self.placed(method, (at, SegmentEnd::Finish), space, harvest);
        }
        if let Some(ceiling) = self.ceiling {
            harvest.keep_below(mark, ceiling.z(), self.height_tolerance);
        }
        harvest.count(&space.solvers.take_statistics());
    }

    /// Settles what it can of the envelope and the edges along a move without rotation, or along an arc with which the tool turns.
    fn envelope_in_closed_form(&self, at: usize, outline: &Outline, space: &mut Workspace, harvest: &mut Harvest) {
        let part = &self.parts[at];
        let segment = &part.segment;
        let mut collector = Collector {
            lines: self.lines,
            harvest,
        };
        let done = &mut space.done;
        let settled = [&mut done.patches[..], &mut done.edges[..]];
        let by_share = |share: f64| self.source_after(at, share);
        let collector = (&mut collector, self.highest(at));
        let rounding = self.size.system_rounding;
        match &part.kind {
            PartKind::VerticalArc(arc) => {
                let arc = (arc, segment, translation::slack(rounding), self.height_tolerance);
                translation::sweep_vertical_arc(outline, arc, collector, by_share, settled);
            }
            PartKind::LevelArc(arc) => {
                if let Some(heading) = Heading::around(arc, segment, rounding) {
                    translation::sweep_level_arc(outline, (&heading, arc), collector, by_share, settled);
                }
            }
            PartKind::Joins(_) | PartKind::Other => {
                if let Some(heading) = Heading::new(segment, rounding) {
                    let source = |t| source(part, self.path, segment.time(t));
                    translation::sweep_straight(outline, &heading, collector, source, settled);
                }
            }
        }
    }

    /// What is this high above the tip is above the ceiling all along a part.
    fn highest(&self, at: usize) -> f64 {
        let part = &self.parts[at];
        let lowest = match part.vertical_arc() {
            Some(arc) => arc.heights()[0],
            None => part
                .segment
                .tips()
                .map(|tip| tip[2])
                .into_iter()
                .fold(f64::INFINITY, f64::min),
        };
        self.above(at, lowest)
    }

    /// The same where the tip is no lower than this.
    fn above(&self, at: usize, tip: f64) -> f64 {
        let spacing = self.lines.spacing();
        self.ceiling
            .map_or(f64::INFINITY, |ceiling| ceiling.above(at, tip, spacing))
    }

    /// Settles the patches that have no closed form along a move without rotation.
    fn envelope_by_curves(&self, at: usize, space: &mut Workspace, harvest: &mut Harvest) {
        let mut grazed = Grazed {
            segment: &self.parts[at].segment,
            collector: &mut Collector {
                lines: self.lines,
                harvest,
            },
            highest: self.highest(at),
            system_rounding: self.size.system_rounding,
            height_tolerance: self.height_tolerance,
            last: space.solvers.moving.options.accept,
            monitor: self.monitor,
        };
        let patches = Patches {
            forms: &self.cutter.patches,
            cells: &mut space.patches,
            done: &mut space.done.patches,
        };
        let source = |t: f64| self.source(at, t);
        space.grazing.settle(patches, &mut grazed, &source);
    }

    /// Settles what it can of a move that turns, line by line.
    fn envelope_line_by_line(
        &self,
        at: usize,
        outline: &Outline,
        space: &mut Workspace,
        harvest: &mut Harvest,
    ) -> Vec<Leftover> {
        let mut collector = Collector {
            lines: self.lines,
            harvest,
        };
        let mut searching = self.searching(&mut collector);
        let settled = [&mut space.done.patches[..], &mut space.done.edges[..]];
        let source = |t: f64| self.source(at, t);
        let moving = (&self.parts[at].segment, self.highest(at));
        turning::envelope(outline, moving, &mut searching, source, settled)
    }

    pub(super) fn searching<'b, 'c>(&self, collector: &'c mut Collector<'b>) -> Searching<'c, 'b> {
        Searching {
            collector,
            accuracy: Accuracy {
                slack: translation::slack(self.size.system_rounding),
                height_tolerance: self.height_tolerance,
            },
        }
    }

    /// What was not certain line by line, by charts.
    fn leftover(
        &self,
        at: usize,
        leftover: &Leftover,
        times: &mut Times,
        space: &mut Workspace,
        harvest: &mut Harvest,
    ) {
        let mask = (!leftover.all).then(|| LineMask::new(self.lines.grid, leftover.lines.iter().copied()));
        let lines = match &mask {
            None => self.lines.clone(),
            Some(Some(mask)) => self.lines.clone().masked(Some(mask)),
            Some(None) => return,
        };
        let mark = times.mark();
        let piece = times.place(leftover.times[0], leftover.times[1]);
        let own = times.mark();
        let monitor = &CancelOnly(self.monitor);
        match &leftover.element {
            Element::Patches(patches) => {
                for number in patches.clone() {
                    let (mut map, mut sink) = self.patch((at, number), times, &mut space.patches, harvest);
                    let domain = map.bounds(&ROOT);
                    let part = (ROOT.0, piece);
                    space
                        .solvers
                        .moving
                        .solve_part(&mut map, part, &domain, &lines, &mut sink, monitor);
                    drop(sink);
                    times.trim(own);
                    space.trim_patch(number);
                }
            }
            Element::Edges(edges) => {
                for number in edges.clone() {
                    let (mut map, mut sink) = self.edge((at, number), times, &mut space.edges, harvest);
                    let domain = map.bounds(&ROOT);
                    let part = (ROOT.0, piece);
                    space
                        .solvers
                        .moving
                        .solve_part(&mut map, part, &domain, &lines, &mut sink, monitor);
                    drop(sink);
                    times.trim(own);
                    space.edges[number].trim();
                }
            }
        }
        times.release(mark);
    }

    /// Whether any line passes near the segment.
    fn reaches(&self, segment: &Segment) -> bool {
        let margin = |k: usize| {
            self.cutter.reach + self.size.spacing[k] * 1e-6 + self.size.system_rounding + self.lines.shift[k].abs()
        };
        comes_near(segment, self.lines.window(), [margin(0), margin(1)])
    }

    pub(super) fn query(&self, (part, times): (usize, (DyadicInterval, u32)), number: usize) -> Query<'_> {
        Query {
            part,
            number,
            lines: self.lines,
            times,
            monitor: self.monitor,
        }
    }

    /// The source of a crossing at time `t` of a part.
    pub(super) fn source(&self, at: usize, t: f64) -> Source {
        self.source_after(at, self.parts[at].segment.time(t))
    }

    /// The source of a crossing after a share of the time of a part.
    fn source_after(&self, at: usize, share: f64) -> Source {
        source(&self.parts[at], self.path, share)
    }

    /// Eq. 6, `X = x, Y = y, g = 0`: the jump is the sign of the Jacobian's determinant.
    fn patches<'a>(
        &self,
        method: &impl CrossingMethod<'a>,
        (at, within): (usize, (DyadicInterval, u32)),
        times: &mut Times,
        space: &mut Workspace,
        harvest: &mut Harvest,
    ) {
        let mark = times.mark();
        for number in 0..self.cutter.patches.len() {
            if space.done.patches[number] {
                continue;
            }
            let (mut map, mut sink) = self.patch((at, number), times, &mut space.patches, harvest);
            let query = self.query((at, within), number);
            method.on_patch(query, &mut map, &mut space.solvers, &mut sink);
            drop(sink);
            times.trim(mark);
            space.trim_patch(number);
        }
    }

    /// The map of a patch, and what becomes of its preimages.
    fn patch<'b>(
        &'b self,
        (at, number): (usize, usize),
        times: &'b mut Times,
        cells: &'b mut [Cells],
        harvest: &'b mut Harvest,
    ) -> (PatchMap<'b>, impl Sink<3, OnPatch>) {
        let element = &self.cutter.patches[number];
        let map = PatchMap::new(element, &mut cells[number], times, self.size);
        let sink = harvest.reaper(move |found: &Preimage<3, OnPatch>| {
            Some(Crossing {
                z: found.seen.height.at(&found.x, &found.from),
                jump: found.orientation,
                normal: unit(found.seen.normal),
                source: self.source(at, found.x[2]),
            })
        });
        (map, sink)
    }

    /// Eq. 7, `X = x, Y = y`: an edge bounds the sweep where exactly one of its faces moves inwards.
    fn edges<'a>(
        &self,
        method: &impl CrossingMethod<'a>,
        (at, within): (usize, (DyadicInterval, u32)),
        times: &mut Times,
        space: &mut Workspace,
        harvest: &mut Harvest,
    ) {
        let mark = times.mark();
        for number in 0..self.cutter.edges.len() {
            if space.done.edges[number] {
                continue;
            }
            let (mut map, mut sink) = self.edge((at, number), times, &mut space.edges, harvest);
            let query = self.query((at, within), number);
            method.on_edge(query, &mut map, &mut space.solvers, &mut sink);
            drop(sink);
            times.trim(mark);
            space.edges[number].trim();
        }
    }

    /// The map of an edge, and what becomes of its preimages.
    fn edge<'b>(
        &'b self,
        (at, number): (usize, usize),
        times: &'b mut Times,
        cells: &'b mut [Cells],
        harvest: &'b mut Harvest,
    ) -> (EdgeMap<'b>, impl Sink<2, OnEdge>) {
        let map = EdgeMap::new(&self.cutter.edges[number], &mut cells[number], times, self.size);
        let sink = harvest.reaper(move |found: &Preimage<2, OnEdge>| {
            let [a, b] = found.seen.sides.map(|side| side.at(&found.x, &found.from));
            if (a < 0.0) == (b < 0.0) {
                return None;
            }
            // The envelope's normal lies in the fan of the two faces, where g = 0.
            let [n, m] = found.seen.normals;
            let lengths = n.norm() * m.norm();
            Some(Crossing {
                z: found.seen.height.at(&found.x, &found.from),
                jump: if a < 0.0 { -found.orientation } else { found.orientation },
                normal: unit(n * (b.abs() / lengths) + m * (a.abs() / lengths)),
                source: self.source(at, found.x[1]),
            })
        });
        (map, sink)
    }
}

/// The source of a crossing after a share of the time of a part.
#[inline]
fn source(part: &PathPart, path: u32, share: f64) -> Source {
    let (segment, t) = part.place(share);
    Source::Cut { path, segment, t }
}
