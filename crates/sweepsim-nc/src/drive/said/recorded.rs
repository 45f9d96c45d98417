//! What a program does besides moving, where it is called from, and its end: as much as may be kept.

use std::borrow::Cow;

use crate::drive::contour::ProgramPlace;
use crate::drive::trace::Canonical;
use crate::drive::track::Track;
use crate::model::event::{Event, EventKind, MOST_TEXT};
use crate::model::positions::ProgramPositions;
use crate::model::program::{Call, NoteKind, Program};
use crate::text::error::{NcError, NcProblem, TextPosition};

/// The most calls: bounds the memory that a file of a few bytes can demand.
const MOST_CALLS: usize = 5_000_000;

impl Track {
    pub fn note(&mut self, message: impl Into<Cow<'static, str>>) {
        let message = message.into();
        if NoteKind::of(&message) != NoteKind::Read {
            self.doubt();
        }
        self.notes.add(self.place.line, message);
    }

    /// Something of this block was assumed, left out or ignored.
    pub(in crate::drive) fn doubt(&mut self) {
        if !std::mem::replace(&mut self.doubted, true) {
            self.program.understood = self.program.understood.saturating_sub(1);
        }
    }

    /// A block is executed.
    pub fn begin_block(&mut self) {
        self.program.blocks += 1;
        self.program.understood += 1;
        self.doubted = false;
    }

    /// Something that happens after the moves so far.
    pub fn event(&mut self, kind: EventKind) -> Result<(), NcProblem> {
        if self.is_recording() {
            return Ok(());
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
        match self.event_waits(kind) {
            Some(kind) => self.record(kind),
            None => Ok(()),
        }
    }

    /// The tool rests.
    pub fn rest(&mut self, seconds: f64) -> Result<(), NcProblem> {
        if !(0.0..=1e9).contains(&seconds) {
            return Err(NcProblem::value(
                "the time of a dwell",
                seconds,
                "a number of seconds from 0 on",
            ));
        }
        if let Some(trace) = &mut self.trace {
            trace.commands.push(Canonical::Dwell(seconds));
        }
        match seconds > 0.0 {
            true => self.event(EventKind::Dwell { seconds }),
            false => Ok(()),
        }
    }

    /// Whether there may be one more pose or event than `count`.
    pub(in crate::drive) fn check_room(&self, count: usize) -> Result<(), NcProblem> {
        if count < self.most_poses {
            return Ok(());
        }
        Err(NcProblem::value(
            "the number of poses and events",
            self.most_poses,
            "smaller: divide the program, or allow a larger arc tolerance",
        ))
    }

    pub(in crate::drive) fn record(&mut self, kind: EventKind) -> Result<(), NcProblem> {
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

    /// Returns to the calling place.
    pub fn returns(&mut self) {
        if let Some(call) = self.place.call.and_then(|call| self.program.calls.get(call as usize)) {
            self.place = ProgramPlace {
                file: call.file,
                line: call.line,
                call: call.parent,
            };
        }
    }

    /// Ends the contour that may be on, after all blocks of `text`. The problems found so far, and what is wrong with the program as a whole.
    pub fn close(&mut self, text: &str, lenient: bool, mut errors: Vec<NcError>) -> Result<(), NcError> {
        if let Err(problem) = self.end_compensation(None) {
            if lenient {
                self.note(format!("left out: {problem}"));
            } else {
                let line = self.place.line.max(1);
                let whole = text.lines().nth(line - 1).unwrap_or("");
                let position = TextPosition::in_line(line, whole, 1, whole.chars().count());
                errors.push(NcError::new(problem, Some(position)));
            }
        }
        if let Some(error) = NcError::all(errors) {
            return Err(error);
        }
        self.check_moves(text)
    }

    /// Whether the program, all of `text`, has moved the tool.
    pub fn check_moves(&self, text: &str) -> Result<(), NcError> {
        if self.has_moved() {
            return Ok(());
        }
        let line = text.lines().count().max(1);
        let problem = NcProblem::syntax("this program has no move: expected at least one with X, Y and Z known");
        Err(NcError::new(problem, Some(TextPosition::in_line(line, "", 1, 1))))
    }

    pub fn finish(mut self) -> Program {
        self.assume_offsets();
        self.program.assumptions = self.assumptions.finish();
        for assumption in &self.program.assumptions {
            self.notes.add(assumption.line, assumption.to_string());
        }
        self.program.notes = self.notes.finish();
        let machine = &mut self.program.machine;
        machine.table = machine.table.or(self.driver.implied_table());
        if self.program.positions.len() != self.program.poses.len() {
            self.program.positions = ProgramPositions::default();
        }
        self.program
    }
}
