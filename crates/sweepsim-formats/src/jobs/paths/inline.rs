//! Paths written in the job itself: poses and moves.

use sweepsim_motion::{Law, Move, Path, PathError, Pose, PoseError, TipArc, TipCourse, Turning};

use sweepsim_nc::{RAPID_SPEED, RAPID_TURN};

use super::{Flags, Seconds};
use crate::error::Problem;
use crate::jobs::schema;

/// A problem of poses in the job, with the pose and the part of it (0: tip, 1: axis, 2: side).
pub(crate) type PoseFault = (Problem, Option<(usize, usize)>);

fn pose(raw: &schema::Pose, unit: f64) -> Result<Pose, (Problem, usize)> {
    let schema::Pose(tip, axis, side) = *raw;
    let placed = tip.map(|c| c * unit);
    let made = match side {
        None => Pose::new(placed, axis),
        Some(side) => Pose::with_side(placed, axis, side),
    };
    made.map_err(|error| {
        let part = match error {
            PoseError::TipNotFinite(_) => 0,
            PoseError::SideWithoutDirection(_) => 2,
            _ => 1,
        };
        (Problem::Pose(error), part)
    })
}

/// The path through poses in the job itself.
pub(crate) fn of_poses(raw: &[schema::Pose], law: Law, unit: f64) -> Result<Path, PoseFault> {
    let mut poses = Vec::with_capacity(raw.len());
    for (index, raw) in raw.iter().enumerate() {
        poses.push(pose(raw, unit).map_err(|(problem, part)| (problem, Some((index, part))))?);
    }
    Path::with_law(poses, law).map_err(path_fault)
}

fn path_fault(error: PathError) -> PoseFault {
    let place = match error {
        PathError::OppositeAxes { index } => Some((index + 1, 1)),
        _ => None,
    };
    (Problem::Path(error), place)
}

/// The path along moves in the job itself.
pub(crate) fn of_moves(raw: &[schema::Move], law: Law, unit: f64) -> Result<Path, PoseFault> {
    let mut poses: Vec<Pose> = Vec::with_capacity(raw.len());
    let mut arcs = Vec::new();
    for (index, raw) in raw.iter().enumerate() {
        let fault = |problem: Problem| (problem, Some((index, 0)));
        let (to, arc) = match raw {
            schema::Move::Start(to) | schema::Move::Line(to) | schema::Move::Rapid(to) => (to, None),
            schema::Move::Arc {
                to,
                centre,
                normal,
                turn,
                turns,
            } => (to, Some((centre.map(|c| c * unit), *normal, *turn, *turns))),
        };
        if matches!(raw, schema::Move::Start(_)) != (index == 0) {
            let message = "expected `Start(..)` as the first of the moves, and nowhere else";
            return Err(fault(Problem::syntax(message)));
        }
        let to = pose(to, unit).map_err(|(problem, part)| (problem, Some((index, part))))?;
        if let (Some((centre, normal, turn, turns)), Some(from)) = (arc, poses.last()) {
            let signed = match (turns, turn) {
                (1..=10_000, schema::Turn::Ccw) => i32::from(turns),
                (1..=10_000, schema::Turn::Cw) => -i32::from(turns),
                _ => return Err(fault(Problem::value("`turns` of an arc", turns, "from 1 to 10000"))),
            };
            let arc = TipArc::between(from.tip(), to.tip(), centre, normal, signed);
            arcs.push((
                index - 1,
                arc.map_err(|error| fault(Problem::syntax(error.to_string())))?,
            ));
        }
        poses.push(to);
    }
    let plain = Path::with_law(poses.clone(), law).map_err(path_fault)?;
    let mut moves: Vec<Move> = (0..plain.moves()).map(|index| plain.way(index)).collect();
    for (index, arc) in arcs {
        moves[index] = Move {
            course: TipCourse::Arc(arc),
            turning: match moves[index].turning {
                Turning::Slerp => Turning::Even,
                other => other,
            },
        };
    }
    Path::with_moves(poses, moves).map_err(path_fault)
}

/// Which of these moves are rapids.
pub(crate) fn rapids(raw: &[schema::Move]) -> impl Iterator<Item = bool> + '_ {
    let moves = raw.iter().skip(1);
    moves.map(|way| matches!(way, schema::Move::Rapid(_)))
}

/// How long each move takes, in seconds: at `feed` in millimetres per minute, or as fast as axes of unknown speed are
/// assumed to be. The duration of a turn in place at a feed is not known.
pub(crate) fn seconds(path: &Path, rapid: &Flags, feed: Option<f64>) -> Seconds {
    let of_move = |number: usize| {
        let length = path.tip_length(number);
        if rapid.get(number) {
            let [a, b] = [number, number + 1].map(|k| path.pose(k).axis());
            let cosine: f64 = (0..3).map(|k| a[k] * b[k]).sum();
            let degrees = cosine.clamp(-1.0, 1.0).acos().to_degrees();
            return Some(60.0 * (length / RAPID_SPEED).max(degrees / RAPID_TURN));
        }
        let seconds = 60.0 * length / feed?;
        (seconds > 0.0 || path.rests(number, number + 1)).then_some(seconds)
    };
    let all: Seconds = (0..path.moves()).map(of_move).collect();
    // Without any feed or rapid nothing is known of the times.
    if all.iter().all(|seconds| seconds.is_none()) {
        Seconds::default()
    } else {
        all
    }
}
