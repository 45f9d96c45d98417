//! How far and how long each tool of a program moves.

use sweepsim_motion::Course;

use crate::model::event::{EventKind, Spindle};
use crate::model::program::{FeedMode, Program, ProgramPose};

/// What a tool does in a program.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct ToolUsage {
    /// Its number, if the program names one.
    pub tool: Option<u32>,
    /// The number of its feed moves,
    pub feed_moves: usize,
    /// and of its rapids.
    pub rapid_moves: usize,
    /// The length of the tip's feed moves, in millimetres,
    pub feed_length: f64,
    /// and of its rapids.
    pub rapid_length: f64,
    /// The duration of the feed moves and dwells, in seconds, as far as their feeds are known; with the accelerations of the axes, where the machine has
    /// them: see [`Program::times`].
    pub seconds: f64,
    /// The duration of the rapids, in seconds: see [`Program::times`].
    pub rapid_seconds: f64,
    /// How many of the feed moves are arcs.
    pub arcs: usize,
    /// The box around the tip in its feed moves: the smallest and the largest coordinates, in millimetres.
    pub extent: Option<[[f64; 3]; 2]>,
    /// The smallest and the largest feed, in millimetres per minute, of the moves whose feed counts minutes.
    pub feeds: Option<[f64; 2]>,
    /// The slowest and the fastest turn of the spindle in its feed moves, in revolutions per minute.
    pub speeds: Option<[f64; 2]>,
    /// The number of feed moves of unknown duration: without a feed, or per revolution of a spindle of unknown speed.
    pub untimed: usize,
}

impl Program {
    /// How far and how long each tool moves, in the order of their first use.
    ///
    /// ```
    /// use sweepsim_nc::{ReadOptions, gcode};
    /// let program = gcode::read("G21\nT1 M6\nG0 X0 Y0 Z0\nG1 X100 F600\nG4 P2\nG0 Z10\n", &ReadOptions::default())?;
    /// let usage = &program.usage()[0];
    /// assert_eq!((usage.tool, usage.feed_length, usage.rapid_length), (Some(1), 100.0, 10.0));
    /// assert_eq!(usage.seconds, 12.0);
    /// # Ok::<(), sweepsim_nc::NcError>(())
    /// ```
    #[must_use]
    pub fn usage(&self) -> Vec<ToolUsage> {
        let mut all: Vec<ToolUsage> = Vec::new();
        let mut events = self.events.iter().peekable();
        let mut rpm = None;
        let mut last: Option<ProgramPose> = None;
        let accelerates = self.accelerates().is_some();
        let mut poses = self.poses.in_order().enumerate();
        self.each_time(|time| {
            let Some((index, pose)) = poses.next() else { return };
            let at = all.iter().position(|usage| usage.tool == pose.tool).unwrap_or_else(|| {
                all.push(ToolUsage {
                    tool: pose.tool,
                    ..ToolUsage::default()
                });
                all.len() - 1
            });
            let usage = &mut all[at];
            while let Some(event) = events.next_if(|event| event.pose <= index) {
                match event.kind {
                    EventKind::Dwell { seconds } => usage.seconds += seconds,
                    EventKind::Spindle(Spindle::Stopped) => rpm = None,
                    EventKind::Spindle(
                        Spindle::Clockwise { rpm: speed } | Spindle::CounterClockwise { rpm: speed },
                    ) => {
                        rpm = speed;
                    }
                    _ => {}
                }
            }
            if let (true, Some(last)) = (pose.joined, &last) {
                let least = time.seconds.filter(|_| accelerates).unwrap_or(0.0);
                usage.add(last, &pose, (self.units.in_mm(), rpm), least);
                if pose.rapid {
                    usage.rapid_seconds += time.seconds.unwrap_or(0.0);
                }
            }
            last = Some(pose);
        });
        all
    }
}

impl ToolUsage {
    /// Adds a move that takes at least so many seconds.
    fn add(&mut self, from: &ProgramPose, to: &ProgramPose, (unit, rpm): (f64, Option<f64>), least: f64) {
        let length = length(from, to);
        if to.rapid {
            self.rapid_moves += 1;
            self.rapid_length += length;
            return;
        }
        self.feed_moves += 1;
        self.feed_length += length;
        self.arcs += usize::from(matches!(to.way().course, Course::Arc(_)));
        for tip in [from.pose.tip(), to.pose.tip()] {
            let [low, high] = self.extent.get_or_insert([tip; 2]);
            for k in 0..3 {
                low[k] = low[k].min(tip[k]);
                high[k] = high[k].max(tip[k]);
            }
        }
        let widen = |range: &mut Option<[f64; 2]>, value: f64| {
            let [low, high] = range.get_or_insert([value; 2]);
            (*low, *high) = (low.min(value), high.max(value));
        };
        if let (Some(feed), FeedMode::PerMinute) = (to.feed, to.feed_mode) {
            widen(&mut self.feeds, feed * unit);
        }
        if let Some(rpm) = rpm {
            widen(&mut self.speeds, rpm);
        }
        let minutes = match (to.feed.filter(|feed| *feed > 0.0), to.feed_mode) {
            (Some(feed), FeedMode::PerMinute) => Some(length / (feed * unit)),
            (Some(feed), FeedMode::PerRevolution) => rpm.map(|rpm| length / (feed * unit * rpm)),
            (Some(feed), FeedMode::InverseTime) => Some(1.0 / feed),
            (None, _) => None,
        };
        match minutes.filter(|minutes| minutes.is_finite()) {
            Some(minutes) => self.seconds += (60.0 * minutes).max(least),
            None => self.untimed += 1,
        }
    }
}

/// The length of the tip's way.
pub(crate) fn length(from: &ProgramPose, to: &ProgramPose) -> f64 {
    let (a, b) = (from.pose.tip(), to.pose.tip());
    let chord = [0, 1, 2].map(|k| b[k] - a[k]);
    match to.way().course {
        Course::Straight => chord[0].hypot(chord[1]).hypot(chord[2]),
        Course::Arc(arc) => {
            let (centre, normal) = (arc.centre(), arc.normal());
            let dot = |v: [f64; 3]| v[0] * normal[0] + v[1] * normal[1] + v[2] * normal[2];
            let radial = [0, 1, 2].map(|k| a[k] - centre[k]);
            let along = dot(radial);
            let across = [0, 1, 2].map(|k| radial[k] - along * normal[k]);
            let radius = across[0].hypot(across[1]).hypot(across[2]);
            (radius * arc.angle()).hypot(dot(chord))
        }
    }
}
