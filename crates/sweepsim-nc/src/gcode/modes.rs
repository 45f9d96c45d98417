//! What stays in effect until another word changes it.

use super::codes::{MotionMode, SpindleTurning};
use crate::drive::ArcPlane;
use crate::machines::WorkFrame;
use crate::model::program::FeedMode;

/// A height in a drilling cycle (mm), absolute or relative as the block that gave it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Level {
    pub value: f64,
    pub incremental: bool,
}

impl Level {
    /// Its coordinate, if relative heights start from there.
    pub fn from(self, start: f64) -> f64 {
        match self.incremental {
            true => start + self.value,
            false => self.value,
        }
    }
}

/// The words of drilling cycles, which stay until the cycle ends.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct CycleWords {
    /// The plane R, relative to where the cycles began, and the bottom, relative to the plane.
    pub plane: Option<Level>,
    pub bottom: Option<Level>,
    pub peck: Option<f64>,
    /// In seconds.
    pub dwell: Option<f64>,
    /// Sideways shifts of G76 and G87.
    pub shift: Option<[f64; 2]>,
    /// The height from which the cycle began, to which G98 returns.
    pub initial: Option<f64>,
}

/// What has switched tip control on.
#[derive(Default)]
pub(crate) struct TipControl {
    /// The machine's kinematics (M428).
    pub kinematics: bool,
    /// The length offset (G43.4).
    pub by_length: bool,
    /// G43.5: tool vectors.
    pub vectors: bool,
}

/// Modal state.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Modes {
    pub motion: Option<MotionMode>,
    /// The last move's before a cycle: G80 goes back to it.
    pub before_cycle: Option<MotionMode>,
    pub plane: ArcPlane,
    pub absolute: bool,
    pub absolute_centres: bool,
    pub inch: bool,
    pub feed_mode: FeedMode,
    /// Whether the axes rest after each block (G61), and after this one (G9).
    pub exact_stop: bool,
    pub stops_here: bool,
    pub feed: Option<f64>,
    /// The feed was given in inches.
    pub feed_in_inches: bool,
    pub speed: Option<f64>,
    pub spindle: SpindleTurning,
    /// The way along a thread in one revolution, as given.
    pub pitch: Option<f64>,
    /// Where the last cubic curve came from, relative to its end: the next one may go on smoothly.
    pub curve_tangent: Option<[f64; 2]>,
    /// G99: cycles retract to their plane R.
    pub retract_to_plane: bool,
    /// Okuma's G71 Z, in mm: the level that takes the place of where a cycle began.
    pub return_level: Option<f64>,
    pub cycle: CycleWords,
    /// D: the register of the cutter's diameter.
    pub register: Option<f64>,
    /// G16, and its last radius and angle.
    pub polar: bool,
    pub polar_words: [Option<f64>; 2],
    /// G68 and G51.
    pub rotation: Option<WorkFrame>,
    /// The angle of G68, in degrees.
    pub turned_by: f64,
    pub scaling: Option<WorkFrame>,
    /// G51.1: where the mirror of each axis is.
    pub mirror: [Option<f64>; 3],
    /// G68.2 or G254: a plane that the tool is turned to.
    pub tilt: Option<WorkFrame>,
    /// G254: the plane follows the table.
    pub dynamic: bool,
}

impl Modes {
    pub(crate) fn new(inch: bool) -> Self {
        Self {
            plane: [0, 1, 2],
            absolute: true,
            inch,
            ..Self::default()
        }
    }

    /// From the program's coordinates to those that work offsets apply to.
    pub(crate) fn local_map(&self) -> WorkFrame {
        let turns = [&self.rotation, &self.tilt].into_iter().flatten();
        turns.fold(self.unturned_map(), |map, step| step.then(&map))
    }

    /// From the program's coordinates to those that G68 turns: Fanuc mirrors and scales first.
    pub(crate) fn unturned_map(&self) -> WorkFrame {
        let mut map = WorkFrame::default();
        if self.mirror.iter().any(Option::is_some) {
            let factors = self.mirror.map(|at| if at.is_some() { -1.0 } else { 1.0 });
            map = WorkFrame::scaled(factors).about(self.mirror.map(|at| at.unwrap_or(0.0)));
        }
        self.scaling.as_ref().map_or(map, |scaling| scaling.then(&map))
    }
}
