//! What a program does besides moving, and where it is called from: as much as may be kept.

use super::track::Track;
use crate::model::event::{Event, EventKind, MOST_TEXT};
use crate::model::program::Call;
use crate::text::error::NcProblem;

/// The most calls: bounds the memory that a file of a few bytes can demand.
const MOST_CALLS: usize = 5_000_000;

impl Track {
    /// Something that happens after the moves so far.
    pub fn event(&mut self, kind: EventKind) -> Result<(), NcProblem> {
        if let EventKind::Message(text) = &kind {
            self.text += text.len();
            if self.text > MOST_TEXT {
                let found = format!("over {MOST_TEXT} bytes");
                return Err(NcProblem::value(
                    "the text of the messages",
                    found,
                    "less: divide the program",
                ));
            }
        }
        match self.event_waits(kind) {
            Some(kind) => self.record(kind),
            None => Ok(()),
        }
    }

    /// Whether there may be one more pose or event than `count`.
    pub(super) fn check_room(&self, count: usize) -> Result<(), NcProblem> {
        if count < self.most_poses {
            return Ok(());
        }
        Err(NcProblem::value(
            "the number of poses and events",
            self.most_poses,
            "smaller: divide the program, or allow a larger arc tolerance",
        ))
    }

    pub(super) fn record(&mut self, kind: EventKind) -> Result<(), NcProblem> {
        self.check_room(self.program.events.len())?;
        let mut event = Event::new(self.program.poses.len(), self.place.line, kind);
        (event.file, event.call) = (self.place.file, self.place.call);
        self.program.events.push(event);
        Ok(())
    }

    /// A call from the current place: what follows is part of it until [`returns`](Self::returns).
    pub fn calls(&mut self) -> Result<(), NcProblem> {
        if self.program.calls.len() >= MOST_CALLS {
            return Err(NcProblem::value(
                "the number of calls",
                MOST_CALLS,
                "smaller: divide the program",
            ));
        }
        let call = Call::new(self.place.file, self.place.line, self.place.call);
        self.place.call = Some(self.program.calls.len() as u32);
        self.program.calls.push(call);
        Ok(())
    }
}
