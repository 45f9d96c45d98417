//! Moves that turn the tool, line by line: see `docs/algorithms/turning.md`.
//!
//! Legend: `a(t)` the tool's axis and `b(t)` its tip, `V` the velocity of a point of the tool, `G` a positive multiple
//! of `g = ⟨n, V⟩` on a surface of the tool where a line meets it, `z` along the dexels. Of a tool of revolution,
//! balls, cylinders about the axis, discs and sharp edges are solved: a line meets each of them in closed form at any
//! time, and `G` has one unknown, the time. Its sign at the ends of a short span tells whether it is 0 in between,
//! where a bound of its slope holds for all lines. What is not certain is left to charts, for the lines and the span of
//! time in question.

mod axis_motion;
mod ball;
mod ceiling;
mod cylinder;
mod disc;
mod lean;
mod resting;
mod rim;
mod shell;
mod spans;
mod zero;

use crate::cutter::outline::{Ball, Outline, Piece, Rim, Shape};
use crate::methods::harvest::Collector;
use axis_motion::{AxisMotion, Moment};
pub(crate) use ceiling::LeaningCeiling;
use cylinder::Cylinder;
use disc::Disc;
use resting::{Resting, RestingSide};
use rim::RimSearch;
use shell::settle_shell;
use spans::settle;
use std::ops::Range;
use sweepsim_dexel::Source;
use sweepsim_motion::{Segment, SegmentEnd};

/// The patches or edges of a piece.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Element {
    Patches(Range<usize>),
    Edges(Range<usize>),
}

/// What is left to charts.
#[derive(Clone, Debug)]
pub(crate) struct Leftover {
    pub element: Element,
    /// From the first time, up to the second.
    pub times: [f64; 2],
    /// All lines, or only some.
    pub all: bool,
    pub lines: Vec<u32>,
}

impl Leftover {
    /// Whether both are all lines of one element, one after the other.
    fn follows(&self, next: &Self) -> bool {
        self.all && self.element == next.element && self.times[1] == next.times[0]
    }
}

/// What all parts of a search share.
pub(crate) struct Searching<'a, 'b> {
    pub collector: &'a mut Collector<'b>,
    pub accuracy: Accuracy,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Accuracy {
    /// The rounding error of coordinates.
    pub slack: f64,
    /// Heights may be off by this much.
    pub height_tolerance: f64,
}

/// A surface of the tool that is solved here.
enum Kind {
    Ball(Ball),
    Cylinder(Cylinder),
    Disc(Disc),
}

impl Kind {
    /// Of a piece as far as it is below a height.
    fn of(piece: &Piece, highest: f64) -> Option<Self> {
        let heights = [piece.from[1].min(piece.to[1]), piece.from[1].max(piece.to[1])];
        match piece.shape {
            Shape::Line { normal: [0.0, up] } => Some(Self::Disc(Disc {
                height: piece.from[1],
                radii: [piece.from[0].min(piece.to[0]), piece.from[0].max(piece.to[0])],
                up,
            })),
            Shape::Line { normal: [1.0, _] } => Some(Self::Cylinder(Cylinder {
                radius: piece.from[0],
                ends: [heights[0], heights[1].min(highest)],
            })),
            Shape::Arc { .. } => piece.ball().map(Self::Ball),
            Shape::Line { .. } => None,
        }
    }
}

/// The envelope and the edges of a tool along a segment that turns. Marks what it settles as done; the rest of that is
/// for charts. What is `highest` above the tip, or higher, is left out.
pub(crate) fn envelope(
    outline: &Outline,
    (segment, highest): (&Segment, f64),
    searching: &mut Searching,
    source: impl Fn(f64) -> Source,
    done: [&mut [bool]; 2],
) -> Vec<Leftover> {
    let mut leftovers = Vec::new();
    let Some(motion) = &AxisMotion::new(segment) else {
        return leftovers;
    };
    let mut search = (searching, &mut leftovers);
    let piece = |(searching, leftovers): &mut (&mut Searching, &mut Vec<Leftover>), piece: &Piece| {
        if piece.heights()[0] > highest {
            return Some(());
        }
        let kind = Kind::of(piece, highest)?;
        let element = Element::Patches(piece.patches.clone());
        settle(motion, &element, leftovers, |span| match &kind {
            Kind::Ball(ball) => settle_shell(ball, (motion, span), searching, &source),
            Kind::Cylinder(cylinder) => settle_shell(cylinder, (motion, span), searching, &source),
            Kind::Disc(disc) => settle_shell(disc, (motion, span), searching, &source),
        });
        Some(())
    };
    let rim = |(searching, leftovers): &mut (&mut Searching, &mut Vec<Leftover>), rim: &Rim| {
        if rim.height > highest {
            return Some(());
        }
        let element = Element::Edges(rim.edges.clone());
        let search = RimSearch::new(rim, motion, searching.accuracy, &source);
        settle(motion, &element, leftovers, |span| {
            search.settle(span, searching.collector)
        });
        Some(())
    };
    outline.settle(&mut search, piece, rim, done);
    leftovers
}

/// The tool at rest at one end of a segment, of which at least one side turns, but for what is `highest` above the tip,
/// or higher. Marks what it settles as done.
pub(crate) fn placement(
    (outline, highest): (&Outline, f64),
    [before, after]: [Option<&Segment>; 2],
    source: Source,
    searching: &mut Searching,
    done: &mut [bool],
) {
    let (own, end) = match (before, after) {
        (_, Some(segment)) => (segment, SegmentEnd::Start),
        (Some(segment), None) => (segment, SegmentEnd::Finish),
        (None, None) => return,
    };
    let (turn, tip) = match end {
        SegmentEnd::Start => (own.start(), own.tips()[0]),
        SegmentEnd::Finish => (own.end(), own.tips()[1]),
    };
    let side = |segment: Option<&Segment>, end: SegmentEnd, beyond: bool| match segment {
        Some(segment) => RestingSide::Moving(Moment::resting(&turn, tip, segment.velocity(end))),
        None => RestingSide::Beyond(beyond),
    };
    let sides = [
        side(before, SegmentEnd::Finish, false),
        side(after, SegmentEnd::Start, true),
    ];
    let resting = Resting {
        pose: Moment::resting(&turn, tip, [[0.0; 3]; 2]),
        sides: &sides,
        source,
    };
    for piece in &outline.pieces {
        let settled = match Kind::of(piece, highest) {
            _ if piece.heights()[0] > highest => Some(()),
            Some(Kind::Ball(ball)) => resting.shell(&ball, searching),
            // No line meets the wall of an upright tool at rest.
            Some(Kind::Cylinder(_)) if resting.pose.lean() == 0.0 => Some(()),
            Some(Kind::Cylinder(cylinder)) => resting.shell(&cylinder, searching),
            Some(Kind::Disc(disc)) => resting.shell(&disc, searching),
            None => None,
        };
        if settled.is_some() {
            done[piece.patches.clone()].fill(true);
        }
    }
}
