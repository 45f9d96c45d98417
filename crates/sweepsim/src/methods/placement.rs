//! The tool at rest between two motions: at a kink of the path, or at an end of it.

use crate::cutter::outline::Outline;
use crate::envelope::{Near, OnPlaced, PlacedMap, ROOT, Side, Twist};
use crate::methods::harvest::{Harvest, unit};
use crate::methods::method::CrossingMethod;
use crate::methods::search::Search;
use crate::methods::translation::{self, Collector, Neighbour, Resting};
use crate::methods::turning;
use crate::methods::workspace::Workspace;
use crate::time::over::Part;
use crate::time::path_parts::PathPart;
use crate::time::pieces::back_size;
use nalgebra::{Matrix3, Vector3};
use sweepsim_dexel::{Crossing, Source};
use sweepsim_motion::{Segment, SegmentEnd, turned_back};
use sweepsim_solve::Preimage;

/// Charts of a tool at rest are made to be kept for other joints if so many parts are counted together.
const SEVERAL: usize = 4;

/// A turn, and the tip.
type Pose = (Matrix3<f64>, Vector3<f64>);

/// The velocity at one end of a segment, in the coordinates of a tool turned by `turn`.
pub(super) fn twist(segment: &Segment, end: SegmentEnd, turn: &Matrix3<f64>) -> Side {
    let [spin, travel] = segment.velocity(end).map(Vector3::from);
    Side::Moving(Twist {
        sizes: [spin, travel].map(|v| back_size(&[*turn], &v, segment.turns().len() > 1)),
        spin: turned_back(turn, &spin).into(),
        travel: turned_back(turn, &travel).into(),
    })
}

/// The motions before and after the placement at the start of a part, or at the end of the last part of a path.
pub(super) fn sides(parts: &[PathPart], at: usize, end: SegmentEnd) -> [Side; 2] {
    let segment = &parts[at].segment;
    if end == SegmentEnd::Finish {
        return [twist(segment, SegmentEnd::Finish, &segment.end()), Side::Beyond(true)];
    }
    let turn = segment.start();
    let before = at.checked_sub(1).map_or(Side::Beyond(false), |k| {
        twist(&parts[k].segment, SegmentEnd::Finish, &turn)
    });
    [before, twist(segment, SegmentEnd::Start, &turn)]
}

impl<'a, M: CrossingMethod<'a>> Search<'_, M> {
    /// Settles what it can of the placement of a tool between two moves without rotation, or arcs with which it turns.
    fn placed_in_closed_form(
        &self,
        (at, end): (usize, SegmentEnd),
        outline: &Outline,
        source: Source,
        space: &mut Workspace,
        harvest: &mut Harvest,
    ) {
        let Some(own) = Neighbour::of(&self.parts[at], end) else {
            return;
        };
        let [tip, last] = self.parts[at].segment.tips();
        let before = match at.checked_sub(1) {
            None => Some(Neighbour::Beyond(false)),
            Some(k) => Neighbour::of(&self.parts[k], SegmentEnd::Finish),
        };
        let (tip, sides) = match (end, before) {
            (SegmentEnd::Finish, _) => (last, [own, Neighbour::Beyond(true)]),
            (SegmentEnd::Start, Some(before)) => (tip, [before, own]),
            (SegmentEnd::Start, None) => return,
        };
        let mut collector = Collector {
            lines: self.lines,
            harvest,
        };
        let slack = translation::slack(self.size.slack);
        let done = &mut space.done.placed;
        let part = &self.parts[at];
        if translation::stands(part) {
            let collector = (&mut collector, self.ceiling);
            translation::placements(outline, (tip, slack), sides, collector, source, done);
        } else {
            let place = (&part.segment.start(), tip, slack);
            translation::leaning(outline, place, sides, &mut collector, source, done);
        }
    }

    /// Settles what it can of the placement of a tool between two moves of which one turns.
    fn placed_line_by_line(
        &self,
        (at, end): (usize, SegmentEnd),
        outline: &Outline,
        source: Source,
        space: &mut Workspace,
        harvest: &mut Harvest,
    ) {
        let own = Some(&self.parts[at].segment);
        let sides = match end {
            SegmentEnd::Start => [at.checked_sub(1).map(|k| &self.parts[k].segment), own],
            SegmentEnd::Finish => [own, None],
        };
        let mut collector = Collector {
            lines: self.lines,
            harvest,
        };
        let mut searching = self.searching(&mut collector);
        turning::placement(outline, sides, source, &mut searching, &mut space.done.placed);
    }

    /// The pose and the motions before and after a placement at which the tool turns on neither side, or only with an arc as it may about its own axis.
    fn between_translations(
        &self,
        at: usize,
        end: SegmentEnd,
        pose: Pose,
        sides: [Side; 2],
    ) -> Option<(Pose, [Side; 2])> {
        let part = &self.parts[at];
        let before = match end {
            SegmentEnd::Start => at.checked_sub(1).map(|k| &self.parts[k]),
            SegmentEnd::Finish => None,
        };
        let all = |is: fn(&PathPart) -> bool| is(part) && before.is_none_or(is);
        if all(|part| part.segment.is_arc() && part.segment.turns().len() == 1) {
            return Some((pose, sides));
        }
        if self.outline.is_none() || !all(translation::stands) {
            return None;
        }
        // Charts of one orientation serve all of these placements.
        let along = |neighbour: Option<Neighbour>, beyond: bool| match neighbour {
            Some(Neighbour::Along(travel)) => Side::Moving(Twist {
                spin: [0.0; 3],
                travel,
                sizes: [[0.0; 3], travel.map(f64::abs)],
            }),
            _ => Side::Beyond(beyond),
        };
        let own = Neighbour::of(part, end);
        let last = before.and_then(|part| Neighbour::of(part, SegmentEnd::Finish));
        let sides = match end {
            SegmentEnd::Start => [along(last, false), along(own, false)],
            SegmentEnd::Finish => [along(own, false), Side::Beyond(true)],
        };
        Some(((Matrix3::identity(), pose.1), sides))
    }

    /// The tool at rest: it bounds the sweep where it moves inwards either just before or just after, but not both.
    pub fn placed(&self, at: usize, end: SegmentEnd, space: &mut Workspace, harvest: &mut Harvest) {
        space.done.placed.fill(false);
        let segment = &self.parts[at].segment;
        let (pose, source) = match end {
            SegmentEnd::Start => ((segment.start(), segment.tips()[0].into()), self.source(at, 0.0)),
            SegmentEnd::Finish => ((segment.end(), segment.tips()[1].into()), self.source(at, 1.0)),
        };
        if let Some(outline) = self.outline {
            self.placed_in_closed_form((at, end), outline, source, space, harvest);
            if !space.done.placed.iter().any(|done| *done) {
                self.placed_line_by_line((at, end), outline, source, space, harvest);
            }
            if space.done.placed.iter().all(|done| *done) {
                return;
            }
        }
        let sides = sides(self.parts, at, end);
        if self.closed
            && self.parts.len() >= SEVERAL
            && let Some((pose, sides)) = self.between_translations(at, end, pose, sides)
        {
            let mut resting = Resting {
                pose,
                sides,
                size: self.size,
                collector: &mut Collector {
                    lines: self.lines,
                    harvest,
                },
                last: space.solvers.placed.options.accept,
                source,
                monitor: self.monitor,
            };
            let tool = (&self.cutter.patches[..], &mut space.patches[..]);
            space.grazing.rest(tool, &mut resting, &mut space.done.placed);
        }
        for (number, (element, cells)) in self.cutter.patches.iter().zip(&mut space.patches).enumerate() {
            if space.done.placed[number] {
                continue;
            }
            let mut map = PlacedMap::new(element, cells, pose, sides, self.size);
            let mut sink = harvest.reaper(|found: &Preimage<2, OnPlaced>| {
                let negative = |side: Near<2>| i8::from(side.at(&found.x, &found.from) < 0.0);
                let change = negative(found.seen.after) - negative(found.seen.before);
                (change != 0).then(|| Crossing {
                    z: found.seen.height.at(&found.x, &found.from),
                    jump: -found.orientation * change,
                    normal: unit(found.seen.normal),
                    source,
                })
            });
            let query = self.query((at, (Part::WHOLE, ROOT.1)), number);
            self.method
                .on_placed(query, end, &mut map, &mut space.solvers, &mut sink);
            if cells.trim() {
                space.grazing.forget(number);
            }
        }
    }
}
