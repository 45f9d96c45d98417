//! The frames in effect.

use crate::drive::{WorkOffset, WorkOffsets};
use crate::machines::WorkFrame;
use crate::model::read_options::ReadOptions;

/// The frames in effect.
#[derive(Clone, Debug)]
pub(super) struct Frames {
    /// `CYCL DEF 7`, before the plane is tilted and after.
    pub shift: [f64; 3],
    pub tilted_shift: [f64; 3],
    /// `PLANE`.
    pub tilt: Option<WorkFrame>,
    /// `CYCL DEF 8`, 10, 11.
    pub mirror: [bool; 3],
    pub rotation: f64,
    pub scale: Option<f64>,
    /// `CYCL DEF 26`: the factors of the axes, and the point that stays.
    pub axis_scales: [f64; 3],
    pub fixed: [f64; 3],
    /// Whether a shift or a plane came after a mirror, a rotation or a scale that is still in effect.
    pub order_unknown: bool,
    /// `CYCL DEF 247`.
    pub work: WorkOffsets,
}

/// The name of a preset; those from 1 on are in the table of the control.
fn preset_name(number: WorkOffset) -> String {
    format!("preset {number}")
}

impl Frames {
    pub fn new(options: &ReadOptions) -> Self {
        Self {
            shift: [0.0; 3],
            tilted_shift: [0.0; 3],
            tilt: None,
            mirror: [false; 3],
            rotation: 0.0,
            scale: None,
            axis_scales: [1.0; 3],
            fixed: [0.0; 3],
            order_unknown: false,
            work: WorkOffsets::new(preset_name, 1000, options),
        }
    }

    pub fn tilted(&self) -> bool {
        self.tilt.is_some()
    }

    /// Whether a mirror, a rotation or a scale is in effect.
    pub fn transformed(&self) -> bool {
        let scaled = self.scale.is_some_and(|scale| scale != 1.0) || self.axis_scales != [1.0; 3];
        self.mirror.contains(&true) || self.rotation != 0.0 || scaled
    }

    /// Whether arcs and lengths are turned or scaled within the plane.
    pub fn total(&self, plane: [usize; 3]) -> WorkFrame {
        let mut frame = self.work.frame().then(&WorkFrame::shifted(self.shift));
        if let Some(tilt) = &self.tilt {
            frame = frame.then(tilt).then(&WorkFrame::shifted(self.tilted_shift));
        }
        let mirror = self.mirror.map(|mirrored| if mirrored { -1.0 } else { 1.0 });
        if self.mirror.contains(&true) {
            frame = frame.then(&WorkFrame::scaled(mirror));
        }
        if self.rotation != 0.0 {
            frame = frame.then(&WorkFrame::turned(plane[2], self.rotation));
        }
        if let Some(scale) = self.scale.filter(|scale| *scale != 1.0) {
            frame = frame.then(&WorkFrame::scaled([scale; 3]));
        }
        if self.axis_scales != [1.0; 3] {
            frame = frame.then(&WorkFrame::scaled(self.axis_scales).about(self.fixed));
        }
        frame
    }
}
