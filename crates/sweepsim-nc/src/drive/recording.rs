//! Contours that a cycle takes from a subprogram: its moves are kept, not made.

use super::contour::{ProgramPlace, Stroke};
use super::cycles::Course;
use super::track::Track;
use crate::text::error::NcProblem;

/// The moves so far, each with its start, and the side that compensation was switched on for.
#[derive(Clone, Debug, Default)]
pub(in crate::drive) struct Recording {
    strokes: Vec<([f64; 3], Stroke)>,
    left: Option<bool>,
    before: Before,
}

/// What is as before after a recording.
#[derive(Clone, Copy, Debug, Default)]
struct Before {
    xyz: [Option<f64>; 3],
    feed: Option<f64>,
    place: ProgramPlace,
    direction: Option<[f64; 3]>,
}

impl Track {
    /// From here on, moves are kept and not made.
    pub fn record_moves(&mut self) -> Result<(), NcProblem> {
        self.refuse_contour("a cycle on contours")?;
        let before = Before {
            xyz: self.xyz,
            feed: self.feed,
            place: self.place,
            direction: self.contour.direction,
        };
        self.xyz = self.xyz.map(|x| Some(x.unwrap_or(0.0)));
        self.recording = Some(Recording {
            before,
            ..Recording::default()
        });
        Ok(())
    }

    /// The course of the moves since then, in a plane; the tool is where it was.
    pub fn recorded(&mut self, plane: [usize; 3]) -> Result<Course, NcProblem> {
        let settled = self.refuse_contour("a cycle on contours");
        let recording = self.recording.take().unwrap_or_default();
        let before = recording.before;
        (self.xyz, self.feed, self.place) = (before.xyz, before.feed, before.place);
        self.contour.direction = before.direction;
        settled?;
        Course::of(&recording.strokes, plane, recording.left)
    }

    /// Whether a move of the tool is kept instead of being made.
    pub(in crate::drive) fn keeps(&mut self, stroke: &Stroke) -> bool {
        let from = self.xyz.map(|x| x.unwrap_or(0.0));
        let Some(recording) = &mut self.recording else {
            return false;
        };
        recording.strokes.push((from, *stroke));
        self.arrive(stroke.end, stroke.abc);
        true
    }

    /// Whether compensation is only noted.
    pub(in crate::drive) fn keeps_side(&mut self, left: bool) -> bool {
        let recording = self.recording.as_mut();
        recording.map(|recording| recording.left = Some(left)).is_some()
    }

    pub fn is_recording(&self) -> bool {
        self.recording.is_some()
    }
}
