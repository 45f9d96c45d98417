//! Moves to places that only the machine knows (`M91`, `M92`), and back along the tool (`M140`).

use super::interpreter::Reader;
use super::moves::{Datum, MoveWords};
use crate::text::assumption::Assumption;
use crate::text::error::NcProblem;

impl Reader<'_> {
    /// `M91`: in machine coordinates of the spindle's nose. What `M92` is measured from, no machine says here.
    pub(super) fn go_from_datum(&mut self, datum: Datum, words: &MoveWords, abc: [f64; 3]) -> Result<(), NcProblem> {
        let place = self.track.machine_place().filter(|_| datum == Datum::Machine);
        if let Some((nose, _)) = place {
            let goal = std::array::from_fn(|k| {
                let (value, relative) = words.axes[k]?;
                Some(match k {
                    3.. => abc[k - 3],
                    _ if relative => nose[k] + value,
                    _ => value,
                })
            });
            if self.track.go_to_machine(goal, words.rapid)? {
                return Ok(());
            }
        }
        self.track
            .note("moves in machine coordinates are left out: the path breaks here");
        self.track.turn_unknown(abc)?;
        self.track.leave([0, 1, 2].map(|k| words.axes[k].is_some()));
        Ok(())
    }

    /// `M140`: back along the tool, by so much or to the end of the travel.
    pub(super) fn retract(&mut self, way: Option<f64>, rapid: bool) -> Result<(), NcProblem> {
        let (Some(way), Some(here)) = (way, self.track.known()) else {
            if way.is_none() {
                let taken = "the move is left out; where the tool is then is known again from the next moves";
                let what = "the end of the travel along the tool (M140 MB MAX)";
                self.track
                    .assume(Assumption::new(what, taken, "M140 MB with a length").harmless());
            }
            self.track.leave([true; 3]);
            return Ok(());
        };
        let axis = self.track.direction()?;
        let at = self.track.frame().point(here);
        let back = std::array::from_fn(|k| at[k] + way * axis[k]);
        let target = self.track.frame().inverse_point(back).unwrap_or(here);
        self.track.line(target, self.track.abc, rapid)
    }
}
