//! The parts of a path: its motions in a frame, in generic position (see [`Tolerances`]).

use crate::time::circles::{LevelArc, VerticalArc, VerticalArcPart, tip_arc};
use crate::time::joined::Stretch;
use crate::tolerances::Tolerances;
use nalgebra::{Matrix3, Vector3};
use std::ops::Range;
use sweepsim_dexel::Frame;
use sweepsim_motion::{Path, Segment};

/// A motion, and its place in the path.
#[derive(Clone, Debug)]
pub struct PathPart {
    pub segment: Segment,
    pub(crate) kind: PartKind,
    /// Number of the move.
    pub number: u32,
    /// When it begins in the move, and the fraction of the move that it covers: moves with large turns have several parts.
    pub start: f32,
    pub share: f32,
}

/// What is known of a motion beyond its segment.
#[derive(Clone, Debug)]
pub(crate) enum PartKind {
    /// A whole straight move without rotation along which the tip's displacement grows, so that the next one may be [joined](super::joined) to it; those that it
    /// consists of, if they are several.
    Joins(Vec<Stretch>),
    /// The same as a circle or helix about a line along the dexels, for a tool of revolution that stands along them.
    LevelArc(LevelArc),
    /// The same as a circle in a plane along the dexels, for any tool of revolution.
    VerticalArc(VerticalArc),
    Other,
}

impl PathPart {
    /// A part of a move from a time on, without a closed form of its own.
    pub fn new(segment: Segment, number: u32, [start, share]: [f32; 2]) -> Self {
        Self {
            segment,
            kind: PartKind::Other,
            number,
            start,
            share,
        }
    }

    pub(crate) fn level_arc(&self) -> Option<LevelArc> {
        match self.kind {
            PartKind::LevelArc(arc) => Some(arc),
            _ => None,
        }
    }

    pub(crate) fn vertical_arc(&self) -> Option<VerticalArc> {
        match self.kind {
            PartKind::VerticalArc(arc) => Some(arc),
            _ => None,
        }
    }
}

/// A tool, and how it is searched.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// Whether it is symmetric about its axis.
    pub symmetric: bool,
    /// Whether all of it is searched in closed form.
    pub closed: bool,
}

/// The motions of some moves of a path in a frame, with displaced tips. Moves of length zero are left out.
///
/// A tool that is not symmetric about its axis moves without turning about it, unless the poses specify how it turns.
/// How it has turned by then follows from all moves before.
/// Motions that are not exact are within [`Tolerances::law_deviation`] for a tool of this `reach`.
pub(crate) fn parts(
    (whole, moves): (&Path, Range<usize>),
    frame: &Frame,
    Kind { symmetric, closed }: Kind,
    reach: f64,
    tolerances: &Tolerances,
) -> Vec<PathPart> {
    // A long path is unpacked only where it is swept; the moves before and after tell how its ends are displaced.
    let around = moves.start.saturating_sub(1)..(moves.end + 1).min(whole.moves());
    let (path, first) = whole.unpacked(around.clone());
    let (path, poses) = (&*path, path.poses());
    let turn = Matrix3::from_columns(&frame.axes().map(Vector3::from)).transpose();
    let shift = -turn * Vector3::from(frame.origin());
    let seen = |segment: Segment| {
        if frame.is_world() {
            segment
        } else {
            segment.moved(&turn, shift)
        }
    };
    // Either all poses have sides, or none.
    let carried = !symmetric && poses.iter().all(|pose| pose.side().is_none());
    let before = if carried {
        carried_to((whole, moves.start), seen, reach, tolerances)
    } else {
        None
    };
    let tip = |k: usize| Vector3::from(frame.from_world(poses[k - first].tip()));
    let axis = |k: usize| Vector3::from(frame.turn_from_world(poses[k - first].axis()));
    // Ends of an arc of a tool that lies along an axis of the grid are not displaced out of its plane.
    let displaced = |k: usize, planes: [Option<usize>; 2]| {
        let mut by = tolerances.tip_displacement(k, axis(k));
        planes.into_iter().flatten().for_each(|normal| by[normal] = 0.0);
        by
    };
    let plane = |from: usize, to: usize| {
        symmetric
            .then(|| exact_plane(path, to - 1 - first, frame, [tip(from), tip(to)]))
            .flatten()
            .filter(|normal| closed || *normal < 2)
    };
    let mut parts: Vec<PathPart> = Vec::with_capacity(moves.len());
    let put = |parts: &mut Vec<PathPart>,
               number: usize,
               segments: Vec<Segment>,
               tips: [Vector3<f64>; 2],
               by: [Vector3<f64>; 2]| {
        let share = 1.0 / segments.len() as f64;
        let ends = [tips[0] + by[0], tips[1] + by[1]];
        let at = |n: usize| ends[0] + (ends[1] - ends[0]) * (n as f64 * share);
        let last = segments.len() - 1;
        let arcs = segments.iter().all(Segment::is_arc);
        let grows = by[0].dot(&(by[1] - by[0])) >= 0.0;
        for (n, segment) in segments.into_iter().enumerate() {
            let last_one = parts.last().map(|part| &part.segment).or(before.as_ref());
            let segment = match last_one {
                Some(before) if carried => segment.after(before),
                _ => segment,
            };
            let segment = if arcs {
                segment.with_tips([at(n), if n == last { ends[1] } else { at(n + 1) }])
            } else {
                let mix = |n: usize| by[0] + (by[1] - by[0]) * (n as f64 * share);
                segment.displaced([mix(n), if n == last { by[1] } else { mix(n + 1) }])
            };
            let joins = last == 0 && arcs && grows && segment.turns().len() == 1;
            parts.push(PathPart {
                kind: if joins {
                    PartKind::Joins(Vec::new())
                } else {
                    PartKind::Other
                },
                ..PathPart::new(segment, number as u32, [n as f64 * share, share].map(|x| x as f32))
            });
        }
    };
    let mut from = moves.start;
    let mut last = if around.start < from && !path.rests(around.start - first, from - first) {
        plane(around.start, from)
    } else {
        None
    };
    for to in moves.start + 1..=moves.end {
        if !path.rests(from - first, to - first) {
            let segments = if symmetric {
                path.segments_of_symmetric(to - 1 - first, reach, tolerances.law_deviation())
            } else {
                path.segments(to - 1 - first, reach, tolerances.law_deviation())
            };
            let own = plane(from, to);
            let next = (to + 1..=around.end)
                .find(|next| !path.rests(to - first, next - first))
                .and_then(|next| plane(to, next));
            let by = [displaced(from, [last, own]), displaced(to, [own, next])];
            last = own;
            let limit = tolerances.circle_deviation();
            let level_arc = symmetric
                .then(|| LevelArc::parts(path, to - 1 - first, frame, (segments.len(), reach), (by, limit)))
                .flatten();
            let vertical_arc = match level_arc {
                None if symmetric => VerticalArc::parts(path, to - 1 - first, (frame, reach), (by, limit)),
                _ => None,
            };
            match level_arc {
                Some(level_arc) => parts.extend(on_level_arcs(to - 1, level_arc)),
                None if vertical_arc.is_some() => {
                    let vertical_arc = vertical_arc.into_iter().flatten();
                    parts.extend(vertical_arc.map(|part| on_vertical_arc(to - 1, part)));
                }
                None => {
                    let segments = segments.into_iter().map(seen).collect();
                    put(&mut parts, to - 1, segments, [tip(from), tip(to)], by);
                }
            }
            from = to;
        }
    }
    if from == 0
        && let Some(pose) = poses.first()
    {
        // A tool that stands still: sweep it along the displacement.
        let by = tolerances.tip_displacement(0, axis(0));
        let still = [by, by + tolerances.standstill(axis(0))];
        let segments = Segment::between(pose, pose).into_iter().map(seen);
        put(&mut parts, 0, segments.collect(), [tip(0); 2], still);
    }
    parts
}

/// The axis of the frame that is normal to the plane of an arc to the last digit, if a tool that lies exactly along an axis of the frame, across the dexels, moves along it without turning.
///
/// The plane then holds the tool's axis, or is perpendicular to it. If it is perpendicular to the dexels, the search by charts takes longer where the tool moves along its axis, over the lines at which
/// its wall is widest: two branches of the envelope meet there. If it is perpendicular to the axis, faces across the tool's axis slide along themselves, parallel to the dexels: they are seen edge-on as long as they
/// stay in one plane to the last digit.
fn exact_plane(path: &Path, number: usize, frame: &Frame, ends: [Vector3<f64>; 2]) -> Option<usize> {
    let (arc, still) = tip_arc(&path.way(number))?;
    let poses = [path.pose(number), path.pose(number + 1)];
    let along = |v: [f64; 3], k: usize| v[k].abs() == 1.0 && (0..3).all(|other| other == k || v[other] == 0.0);
    let [axis, normal] = [poses[0].axis(), arc.normal()].map(|v| frame.turn_from_world(v));
    let lies = (0..2).any(|k| along(axis, k));
    let plane = |k: &usize| along(normal, *k) && ends[0][*k] == ends[1][*k];
    let one = still && poses[0].axis() == poses[1].axis();
    (one && lies).then(|| (0..3).find(plane)).flatten()
}

/// So many moves are unpacked at a time.
const BLOCK: usize = 1 << 12;

/// The last motion before a move of a tool that goes on as it has turned.
fn carried_to(
    (whole, end): (&Path, usize),
    seen: impl Fn(Segment) -> Segment,
    reach: f64,
    tolerances: &Tolerances,
) -> Option<Segment> {
    let mut last: Option<Segment> = None;
    let mut from = 0;
    while from < end {
        let until = end.min(from + BLOCK);
        let (path, first) = whole.unpacked(from..until);
        for to in from + 1..=until {
            if path.rests(from - first, to - first) {
                continue;
            }
            for segment in path
                .segments(to - 1 - first, reach, tolerances.law_deviation())
                .into_iter()
                .map(&seen)
            {
                last = Some(match &last {
                    Some(before) => segment.after(before),
                    None => segment,
                });
            }
            from = to;
        }
        from = until;
    }
    last
}

/// The parts of one move, of equal duration.
fn on_level_arcs(number: usize, parts: Vec<(LevelArc, Segment)>) -> impl Iterator<Item = PathPart> {
    let share = 1.0 / parts.len() as f64;
    parts.into_iter().enumerate().map(move |(n, (arc, segment))| PathPart {
        kind: PartKind::LevelArc(arc),
        ..PathPart::new(segment, number as u32, [n as f64 * share, share].map(|x| x as f32))
    })
}

fn on_vertical_arc(number: usize, part: VerticalArcPart) -> PathPart {
    PathPart {
        kind: PartKind::VerticalArc(part.vertical_arc),
        ..PathPart::new(part.segment, number as u32, [part.start, part.share].map(|x| x as f32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_motion::Law;
    use sweepsim_motion::{Move, PathBuilder, Pose, RotaryTable, TipCourse, Turning};
    use sweepsim_props::*;

    /// A path of random turns, some of them of rotary axes, with rests.
    fn path(moves: &[([f64; 3], bool, bool)], packed: bool) -> Path {
        let table = RotaryTable::Bc;
        let mut builder = PathBuilder::default();
        let (mut angles, mut tip) = ([20.0, 30.0], [0.0; 3]);
        builder.push(Pose::new(tip, table.axis(angles)).unwrap(), Move::default());
        for ([b, c, x], rotary, rests) in moves {
            let from = angles;
            angles = if *rests { angles } else { [angles[0] + b, angles[1] + c] };
            tip[0] += if *rests { 0.0 } else { *x };
            let turning = if *rotary && !rests {
                Turning::Rotary {
                    table,
                    from,
                    to: angles,
                }
            } else {
                Turning::Slerp
            };
            let course = TipCourse::Straight;
            builder.push(Pose::new(tip, table.axis(angles)).unwrap(), Move { course, turning });
        }
        let path = builder.finish(Law::Slerp).unwrap();
        if packed {
            path
        } else {
            path.unpacked(0..path.moves()).0.into_owned()
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(16))]

        /// A tool without symmetry has turned alike, whether moves are prepared together or some after others.
        #[test]
        fn later_moves_are_as_among_all(
            moves in collection::vec(([-30.0..30.0, -30.0..30.0, 0.1..3.0], any::<bool>(), prop::bool::weighted(0.2)), 2..30),
            times in 1..300_usize, packed in any::<bool>(), share in 0.0..1.0, leaning in any::<bool>(),
        ) {
            let moves: Vec<_> = std::iter::repeat_n(&moves, times).flatten().copied().collect();
            let path = path(&moves, packed);
            let frame = if leaning { Frame::new([1.0, 2.0, 3.0], [0.6, 0.0, 0.8], [0.0, 1.0, 0.0]).unwrap() } else { Frame::WORLD };
            let tolerances = Tolerances::new(1e-6, 1e4).unwrap();
            let of = |moves| parts((&path, moves), &frame, Kind { symmetric: false, closed: false }, 40.0, &tolerances);
            let whole = of(0..path.moves());
            let middle = (share * path.moves() as f64) as usize;
            let after = |all: &[PathPart]| all.partition_point(|part| part.number as usize <= middle);
            let later = of(middle..path.moves());
            let [expected, found] = [&whole, &later].map(|all| &all[after(all)..]);
            prop_assert_eq!(expected.len(), found.len());
            for (a, b) in expected.iter().zip(found) {
                prop_assert_eq!((a.number, a.start, a.segment.turns()), (b.number, b.start, b.segment.turns()));
                // The tip of the first move is displaced as at the first of the poses where it rests.
                prop_assert!(a.number == expected[0].number || a.segment == b.segment);
            }
        }

        /// Tips between arcs of a lying tool and other moves are displaced alike, whether moves are prepared together or some after others.
        #[test]
        fn tips_are_as_among_all(
            kinds in collection::vec((0..4_i32, 1..4_i32), 2..30), packed in any::<bool>(), share in 0.0..1.0,
        ) {
            let mut tip = [0.0; 3];
            let mut builder = PathBuilder::default();
            let pose = |tip| Pose::new(tip, [1.0, 0.0, 0.0]).unwrap();
            builder.push(pose(tip), Move::default());
            for (kind, turns) in kinds {
                // The normal of an arc's plane, and the direction of its centre.
                let [normal, out] = [[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]], [[0.0; 3]; 2]][kind as usize];
                let centre: [f64; 3] = std::array::from_fn(|k| tip[k] + 2.0 * out[k]);
                if kind == 3 {
                    tip = [tip[0] + 1.0, tip[1] + 0.3, tip[2] - 0.2];
                    builder.push(pose(tip), Move::default());
                } else {
                    let [v, n] = [out, normal].map(Vector3::from);
                    let (s, c) = (f64::from(turns) * 0.5 * std::f64::consts::PI).sin_cos();
                    let end = Vector3::from(centre) - 2.0 * (v * c + n.cross(&v) * s);
                    tip = std::array::from_fn(|k| if normal[k] == 1.0 { tip[k] } else { end[k] });
                    let arc = sweepsim_motion::TipArc::new(centre, normal, f64::from(turns) * 0.5 * std::f64::consts::PI).unwrap();
                    builder.push(pose(tip), Move::arc(arc));
                }
            }
            let path = builder.finish(Law::Slerp).unwrap();
            let path = if packed { path } else { path.unpacked(0..path.moves()).0.into_owned() };
            let tolerances = Tolerances::new(1e-6, 1e4).unwrap();
            let of = |moves| parts((&path, moves), &Frame::WORLD, Kind { symmetric: true, closed: true }, 40.0, &tolerances);
            let middle = (share * path.moves() as f64) as usize;
            let [whole, mut before, after] = [0..path.moves(), 0..middle.max(1), middle.max(1)..path.moves()].map(of);
            before.extend(after);
            prop_assert_eq!(whole.len(), before.len());
            for (a, b) in whole.iter().zip(&before) {
                prop_assert_eq!((a.number, a.vertical_arc().is_some()), (b.number, b.vertical_arc().is_some()));
                prop_assert!(a.segment == b.segment);
            }
        }
    }
}
