//! The tool at rest between two motions: at a kink of the path, or at an end of it.

use crate::cutter::outline::Outline;
use crate::envelope::{JointSide, Near, OnPlaced, PlacedMap, ROOT, Twist};
use crate::methods::harvest::{Collector, Harvest, unit};
use crate::methods::method::CrossingMethod;
use crate::methods::search::Search;
use crate::methods::translation::{self, Neighbour};
use crate::methods::turning;
use crate::methods::workspace::Workspace;
use crate::time::over::DyadicInterval;
use crate::time::path_parts::PathPart;
use crate::time::pieces::back_size;
use nalgebra::{Matrix3, Vector3};
use sweepsim_dexel::{Crossing, Source};
use sweepsim_motion::{Segment, SegmentEnd, turned_back};
use sweepsim_solve::Preimage;

/// The velocity at one end of a segment, in the coordinates of a tool turned by `turn`.
pub(in crate::methods) fn twist(segment: &Segment, end: SegmentEnd, turn: &Matrix3<f64>) -> JointSide {
    let [spin, travel] = segment.velocity(end).map(Vector3::from);
    JointSide::Moving(Twist {
        sizes: [spin, travel].map(|v| back_size(&[*turn], &v, segment.turns().len() > 1)),
        spin: turned_back(turn, &spin).into(),
        travel: turned_back(turn, &travel).into(),
    })
}

/// The motions before and after the placement at the start of a part, or at the end of the last part of a path.
pub(in crate::methods) fn sides(parts: &[PathPart], at: usize, end: SegmentEnd) -> [JointSide; 2] {
    let segment = &parts[at].segment;
    if end == SegmentEnd::Finish {
        return [
            twist(segment, SegmentEnd::Finish, &segment.end()),
            JointSide::Beyond(true),
        ];
    }
    let turn = segment.start();
    let before = at.checked_sub(1).map_or(JointSide::Beyond(false), |k| {
        twist(&parts[k].segment, SegmentEnd::Finish, &turn)
    });
    [before, twist(segment, SegmentEnd::Start, &turn)]
}

impl Search<'_> {
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
        let slack = translation::slack(self.size.system_rounding);
        let done = &mut space.done.placed;
        let part = &self.parts[at];
        if translation::stands(part) {
            let collector = (&mut collector, self.above(at, tip[2]));
            translation::placements(outline, (tip, slack), sides, collector, source, done);
        } else {
            let place = (&part.segment.start(), tip, slack);
            let collector = (&mut collector, self.above(at, tip[2]));
            translation::leaning(outline, place, sides, collector, source, done);
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
        let highest = self.highest(at);
        turning::placement(
            (outline, highest),
            sides,
            source,
            &mut searching,
            &mut space.done.placed,
        );
    }

    /// The tool at rest: it bounds the sweep where it moves inwards either just before or just after, but not both.
    pub fn placed<'a>(
        &self,
        method: &impl CrossingMethod<'a>,
        (at, end): (usize, SegmentEnd),
        space: &mut Workspace,
        harvest: &mut Harvest,
    ) {
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
            let query = self.query((at, (DyadicInterval::WHOLE, ROOT.1)), number);
            method.on_placed(query, end, &mut map, &mut space.solvers, &mut sink);
            if cells.trim() {
                space.grazing.forget(number);
            }
        }
    }
}
