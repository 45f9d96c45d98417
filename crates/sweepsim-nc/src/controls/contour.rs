//! Contours of cycles: blocks that run for their moves, which are kept and not made.

use super::run::Running;
use crate::drive::{ArcPlane, Course};
use crate::text::error::{Located, NcProblem};

/// The most blocks of a contour.
const MOST_BLOCKS: usize = 100_000;

/// The course of the moves of some blocks in a plane. `enter` goes to the first of them, `goes_on` tells whether there
/// are more, and `leave` goes back.
pub(super) fn course<R: Running>(
    running: &mut R,
    plane: ArcPlane,
    enter: impl FnOnce(&mut R),
    goes_on: impl Fn(&R) -> bool,
    leave: impl FnOnce(&mut R),
) -> Result<Course, Located> {
    let fail = |problem: NcProblem| (problem, 0..0);
    running.track().record_moves().map_err(fail)?;
    enter(running);
    let mut ran = Ok(());
    for _ in 0..MOST_BLOCKS {
        if !goes_on(running) {
            break;
        }
        let Some(at) = running.advance() else { break };
        ran = running.run(at);
        if ran.is_err() {
            break;
        }
    }
    leave(running);
    let recorded = running.track().recorded();
    ran?;
    let recorded = recorded.map_err(fail)?;
    Course::of(&recorded.strokes, plane, recorded.left).map_err(fail)
}
