//! The tool at rest between two motions: at a kink of the path, or at an end of it.

use crate::envelope::{Side, Twist};
use crate::time::path_parts::PathPart;
use crate::time::pieces::back_size;
use nalgebra::Matrix3;
use sweepsim_motion::{Segment, SegmentEnd, turned_back};

/// The velocity at one end of a segment, in the coordinates of a tool turned by `turn`.
pub(super) fn twist(segment: &Segment, end: SegmentEnd, turn: &Matrix3<f64>) -> Side {
    let [spin, travel] = segment.velocity(end).map(nalgebra::Vector3::from);
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
