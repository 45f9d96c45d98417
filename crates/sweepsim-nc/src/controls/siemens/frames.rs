//! Frames: work offsets, programmable frames and swivelled planes.

use super::interpreter::Reader;
use super::state::{FrameChange, Operation};
use super::words::Words;
use crate::drive::{Coordinates, WorkOffset};
use crate::machines::WorkFrame;
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcProblem};

impl Reader<'_> {
    /// Brings all frames into effect.
    pub(super) fn apply_frames(&mut self) -> Result<(), NcProblem> {
        let offset = self.frames.work.frame();
        self.track
            .set_frame(offset.then(&self.frames.swivel).then(&self.frames.programmed))
    }

    /// Another work offset: the tool stays where it is.
    pub(super) fn select_offset(&mut self, number: WorkOffset) -> Result<(), NcProblem> {
        self.frames.work.active = number;
        self.apply_frames()
    }

    pub(super) fn operate(&mut self, operation: Operation, words: &Words) -> Result<(), Located> {
        let unit = self.modes.unit();
        let values = ["X", "Y", "Z"].map(|axis| words.plain(axis));
        for axis in ["A", "B", "C"] {
            if let Some(word) = words.get(axis)
                && word.value != 0.0
            {
                let problem = NcProblem::unsupported("frames that move rotary axes are", "expected X, Y, Z");
                return Err((problem, word.span.clone()));
            }
        }
        let or = |missing: f64| values.map(|value| value.unwrap_or(missing));
        let change = match operation.kind {
            FrameChange::Shift => WorkFrame::shifted(or(0.0).map(|value| value * unit)),
            FrameChange::Turn => match words.plain("RPL") {
                Some(angle) => WorkFrame::turned(self.modes.plane[2], angle),
                // About Z, then about the new Y, then about the new X.
                None => WorkFrame::spatial(or(0.0)),
            },
            FrameChange::Scale => {
                let factors = or(1.0);
                if factors.contains(&0.0) {
                    return Err((NcProblem::value("a scale", 0, "other than 0"), words.span("X")));
                }
                WorkFrame::scaled(factors)
            }
            FrameChange::Mirror => WorkFrame::scaled(values.map(|value| if value.is_some() { -1.0 } else { 1.0 })),
        };
        let before = self.frames.programmed;
        self.frames.programmed = if operation.additive {
            if operation.kind == FrameChange::Turn && before.scale().is_none() {
                let problem = "turning after a scale that is not the same for all axes is";
                let expected = "the order on the control is not known; expected the scale after the turn";
                return Err((NcProblem::unsupported(problem, expected), words.whole()));
            }
            before.then(&change)
        } else {
            change
        };
        for k in 0..3 {
            self.frames.kept[k] = self.frames.kept[k].or(self.track.xyz[k]);
        }
        self.frames.kept_turned |= operation.kind != FrameChange::Shift;
        self.apply_frames().map_err(|problem| (problem, words.whole()))
    }

    /// `CYCLE800(_FR, _TC, _ST, _MODE, _X0, _Y0, _Z0, _A, _B, _C, _X1, _Y1, _Z1, _DIR, …)`: a swivelled plane.
    pub(super) fn swivel(&mut self, arguments: &[Option<f64>]) -> Result<(), NcProblem> {
        let get = |index: usize| arguments.get(index).copied().flatten().unwrap_or(0.0);
        if arguments.iter().all(Option::is_none) {
            self.frames.swivel = WorkFrame::default();
            self.frames.swivelled = false;
            self.apply_frames()?;
            return self.plane_coordinates();
        }
        let mode = get(3);
        let mode = NcProblem::whole("_MODE of CYCLE800", mode, 0..=255, "a whole number from 0 to 255")?;
        if mode >> 6 != 0 {
            return Err(NcProblem::unsupported(
                "CYCLE800 with solid or projection angles, or with angles of rotary axes, is",
                "expected _MODE 57, 39, 27 … : axis by axis",
            ));
        }
        let unit = self.modes.unit();
        let mut frame = WorkFrame::shifted([get(4), get(5), get(6)].map(|value| value * unit));
        for (turn, angle) in [get(7), get(8), get(9)].into_iter().enumerate() {
            let axis = (mode >> (2 * turn)) & 3;
            match axis {
                0 if angle != 0.0 => {
                    return Err(NcProblem::value(
                        "_MODE of CYCLE800",
                        mode,
                        "with an axis (1, 2 or 3 in two bits) for each angle",
                    ));
                }
                0 => {}
                _ => frame = frame.then(&WorkFrame::turned(axis as usize - 1, angle)),
            }
        }
        frame = frame.then(&WorkFrame::shifted(
            [get(10), get(11), get(12)].map(|value| value * unit),
        ));
        let additive = get(2) % 10.0 == 1.0;
        if additive && self.frames.programmed != WorkFrame::default() {
            let taken = "it ends: the plane is upon the last swivelled plane alone";
            let what = "the programmable frame before an additive CYCLE800";
            self.track
                .assume(Assumption::new(what, taken, "TRANS without words before it"));
        }
        self.frames.swivel = if additive {
            self.frames.swivel.then(&frame)
        } else {
            frame
        };
        self.frames.programmed = WorkFrame::default();
        // Coordinates become those of the tip first: the frame is the part's.
        self.frames.swivelled = true;
        self.plane_coordinates()?;
        self.apply_frames()?;
        if get(13) == 0.0 {
            self.track
                .note("CYCLE800 without a direction turns no axis: the tool keeps its direction");
        } else {
            let normal = self.frames.swivel.direction([0.0, 0.0, 1.0]);
            // With _FR the tool is first drawn back to where only the machine knows.
            let rapid = (get(0) == 0.0).then_some(true);
            if self.track.turn_to(normal, rapid)? {
                self.track.note("CYCLE800 turns the rotary axes: the path breaks here");
            }
        }
        Ok(())
    }

    /// In a swivelled plane coordinates are those of the tip, as under tip control.
    pub(super) fn plane_coordinates(&mut self) -> Result<(), NcProblem> {
        let tip = self.frames.swivelled || self.modes.tip_control;
        self.track
            .set_coordinates(if tip { Coordinates::Tip } else { Coordinates::Axes })
    }
}
