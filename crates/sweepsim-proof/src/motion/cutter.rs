//! A cutter, or a body of a tool, on its path.

use super::{Stretch, blocks, digest};
use crate::recall::Writing;
use crate::tool::Convex;
use std::ops::Range;
use sweepsim_motion::{Move, OtherCourses, Path, Segment};

/// A cutter on its path, or another body of a tool.
#[derive(Clone, Copy, Debug)]
pub struct Cutter<'a> {
    /// Solids that cover it.
    pub solids: &'a [Convex],
    /// Its path.
    pub path: &'a Path,
    /// Other courses that its moves may take.
    pub others: Option<&'a OtherCourses>,
    /// Its points are no farther from the tip.
    pub reach: f64,
}

/// A piece of a path, as a proof takes it: a rational motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The move, from 0.
    pub number: usize,
    /// The times in it at which the piece begins and ends.
    pub times: [f64; 2],
    /// The motion.
    pub segment: Segment,
    /// Whether it is of another course that the move may take.
    pub is_other: bool,
}

/// Of the blocks of moves that are looked at together.
const TOGETHER: [usize; 3] = [32, 32, 128];

impl<'a> Cutter<'a> {
    /// Solids on a path.
    #[must_use]
    pub fn new(solids: &'a [Convex], path: &'a Path, others: Option<&'a OtherCourses>) -> Self {
        let reach = solids.iter().map(Convex::reach).fold(0.0, f64::max);
        Self {
            solids,
            path,
            others,
            reach,
        }
    }

    /// The moves in blocks, which are looked at together.
    #[must_use]
    pub(crate) fn blocks(&self) -> Vec<Range<usize>> {
        let all = self.path.poses_in_order(0).map(|pose| digest(&pose.tip().into()));
        let all: Vec<u64> = all.collect();
        blocks(self.path.moves(), TOGETHER, |number| all[number]).collect()
    }

    /// The pieces of some moves: first those of the path, then those of other courses.
    ///
    /// No point of the cutter is farther from where it is on the path than the deviation.
    #[must_use]
    pub fn pieces(&self, moves: Range<usize>, deviation: f64) -> Vec<Piece> {
        let reach = self.reach;
        let mut pieces = Vec::with_capacity(moves.len());
        let (path, first) = self.path.unpacked(moves.clone());
        for number in moves.clone() {
            let segments = path.segments_of_symmetric(number - first, reach, deviation);
            add(&mut pieces, segments, (number, false), [0.0, 1.0]);
        }
        for other in self.others.iter().flat_map(|others| others.of(moves.clone())) {
            let mut from = 0.0;
            for (k, to) in other.times.iter().enumerate() {
                let segments = other.path.segments_of_symmetric(k, reach, deviation);
                add(&mut pieces, segments, (other.number, true), [from, *to]);
                from = *to;
            }
        }
        pieces
    }

    /// All that the pieces of some moves follow from but for their numbers, for a digest.
    pub(crate) fn write(&self, to: &mut Writing, moves: Range<usize>, deviation: f64) {
        to.number(moves.len());
        to.floats(&[self.reach, deviation]);
        let (path, first) = self.path.unpacked(moves.clone());
        for number in moves.start..=moves.end {
            let pose = path.pose(number - first);
            to.floats(&pose.tip());
            to.floats(&pose.axis());
            if let Some(side) = pose.side() {
                to.floats(&side);
            }
            let way = (number < moves.end).then(|| path.way(number - first));
            if let Some(way) = way.filter(|way| *way != Move::default()) {
                to.bytes(format!("{way:?}").as_bytes());
            }
        }
        for other in self.others.iter().flat_map(|others| others.of(moves.clone())) {
            to.number(other.number - moves.start);
            to.bytes(format!("{:?} {:?}", other.path, other.times).as_bytes());
        }
    }

    /// The same as stretches, which are the same wherever in a program they are: their moves count from the first.
    pub(crate) fn stretches_from_first(&self, moves: Range<usize>, deviation: f64) -> Vec<Stretch> {
        let first = moves.start;
        let stretch = |piece: Piece| Stretch::new(piece.segment, piece.number - first, piece.times);
        self.pieces(moves, deviation).into_iter().map(stretch).collect()
    }

    /// The same as stretches.
    pub(crate) fn stretches(&self, moves: Range<usize>, deviation: f64) -> Vec<Stretch> {
        let stretch = |piece: Piece| Stretch::new(piece.segment, piece.number, piece.times);
        self.pieces(moves, deviation).into_iter().map(stretch).collect()
    }
}

/// The segments of a move, of equal duration between two times of it.
fn add(pieces: &mut Vec<Piece>, segments: Vec<Segment>, (number, is_other): (usize, bool), [from, to]: [f64; 2]) {
    let count = segments.len() as f64;
    let time = |k: usize| from + (to - from) * k as f64 / count;
    for (k, segment) in segments.into_iter().enumerate() {
        pieces.push(Piece {
            number,
            times: [time(k), time(k + 1)],
            segment,
            is_other,
        });
    }
}
