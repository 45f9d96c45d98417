//! What a program does besides moving, and where it is called from: as much as may be kept.

use super::track::Track;
use crate::model::event::{Event, EventKind, MOST_TEXT};
use crate::model::program::Call;
use crate::text::error::NcProblem;

/// The most events and calls: bounds the memory that a file of a few bytes can demand.
const MOST_EVENTS: usize = 5_000_000;

impl Track {
    pub(super) fn record(&mut self, kind: EventKind) -> Result<(), NcProblem> {
        if self.program.events.len() >= MOST_EVENTS {
            return Err(NcProblem::value(
                "the number of events",
                MOST_EVENTS,
                "smaller: divide the program",
            ));
        }
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
        let mut event = Event::new(self.program.poses.len(), self.place.line, kind);
        (event.file, event.call) = (self.place.file, self.place.call);
        self.program.events.push(event);
        Ok(())
    }

    /// A call from the current place: what follows is part of it until [`returns`](Self::returns).
    pub fn calls(&mut self) -> Result<(), NcProblem> {
        if self.program.calls.len() >= MOST_EVENTS {
            return Err(NcProblem::value(
                "the number of calls",
                MOST_EVENTS,
                "smaller: divide the program",
            ));
        }
        let call = Call::new(self.place.file, self.place.line, self.place.call);
        self.place.call = Some(self.program.calls.len() as u32);
        self.program.calls.push(call);
        Ok(())
    }
}
