//! The arc of a move.

use sweepsim_motion::{Move, TipArc, TipCourse, Turning};

/// The arc of a move, and whether the tool does not turn if its axis is the same at both ends: rotary axes may go around.
pub(crate) fn tip_arc(way: &Move) -> Option<(TipArc, bool)> {
    let TipCourse::Arc(arc) = way.course else { return None };
    let still = match way.turning {
        Turning::Slerp | Turning::Even => true,
        Turning::Rotary { from, to, .. } => from == to,
    };
    Some((arc, still))
}
