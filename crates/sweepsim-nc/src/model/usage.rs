//! How far and how long each tool of a program moves.

use std::f64::consts::{PI, TAU};

use sweepsim_motion::TipCourse;

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
    /// The duration of the feed moves and dwells, in seconds, as far as their feeds are known: see [`Program::times`].
    /// The dwells after the last move are those of its tool.
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
                usage.add(last, &pose, (self.units.in_mm(), rpm), time.seconds);
                if pose.rapid {
                    usage.rapid_seconds += time.seconds.unwrap_or(0.0);
                }
            }
            last = Some(pose);
        });
        let of_last = last.and_then(|last| all.iter_mut().find(|usage| usage.tool == last.tool));
        if let Some(usage) = of_last {
            usage.seconds += self.rest_at_end();
        }
        all
    }
}

impl Program {
    /// The box around the tip in all moves, along arcs as well, and at all poses: the smallest and the largest coordinates, in millimetres.
    ///
    /// ```
    /// use sweepsim_nc::{ReadOptions, gcode};
    /// let mut options = ReadOptions::default();
    /// options.exact_arcs = true;
    /// let circle = gcode::read("G21\nG0 X0 Y0 Z0\nG2 X0 Y0 I5 J0 F100\n", &options)?;
    /// assert_eq!(circle.extent(), Some([[0.0, -5.0, 0.0], [10.0, 5.0, 0.0]]));
    /// # Ok::<(), sweepsim_nc::NcError>(())
    /// ```
    #[must_use]
    pub fn extent(&self) -> Option<[[f64; 3]; 2]> {
        let mut last: Option<ProgramPose> = None;
        self.poses.in_order().fold(None, |all, pose| {
            let from = last.take().filter(|_| pose.joined);
            let found = from.map_or([pose.pose.tip(); 2], |from| course_extent(&from, &pose));
            last = Some(pose);
            Some(all.map_or(found, |all| joined(all, found)))
        })
    }
}

/// The box around two boxes.
fn joined([low, high]: [[f64; 3]; 2], [a, b]: [[f64; 3]; 2]) -> [[f64; 3]; 2] {
    [
        [0, 1, 2].map(|k| low[k].min(a[k])),
        [0, 1, 2].map(|k| high[k].max(b[k])),
    ]
}

/// The box around the tip in a move.
///
/// On an arc a coordinate is `m + R cos(θ − φ) + g θ`, with `g` from the rise of a helix. Its extremes are at the ends and where `sin(θ − φ) = g / R`: of
/// those a full turn apart the first and the last are enough.
fn course_extent(from: &ProgramPose, to: &ProgramPose) -> [[f64; 3]; 2] {
    let (a, b) = (from.pose.tip(), to.pose.tip());
    let ends = joined([a; 2], [b; 2]);
    let arc = match to.way().course {
        TipCourse::Straight => return ends,
        TipCourse::Arc(arc) => arc,
        course @ TipCourse::Carried(turns) => {
            let angle: f64 = turns.turns().map(|turn| turn.angle().abs()).sum();
            let samples = (256.0 * angle / TAU).ceil().max(4.0);
            return sampled_extent(samples as usize, |time| course.tip([a, b], time));
        }
    };
    let (n, angle) = (arc.normal(), arc.angle());
    let dot = |v: [f64; 3]| v[0] * n[0] + v[1] * n[1] + v[2] * n[2];
    let radial = [0, 1, 2].map(|k| a[k] - arc.centre()[k]);
    let along = dot(radial);
    let u = [0, 1, 2].map(|k| radial[k] - along * n[k]);
    let v = [0, 1, 2].map(|k| n[(k + 1) % 3] * u[(k + 2) % 3] - n[(k + 2) % 3] * u[(k + 1) % 3]);
    let rise = dot([0, 1, 2].map(|k| b[k] - a[k])) / angle;
    let (first, last) = (angle.min(0.0), angle.max(0.0));
    let mut all = ends;
    for k in 0..3 {
        let (r, phase, g) = (u[k].hypot(v[k]), v[k].atan2(u[k]), rise * n[k]);
        if !(g.abs() < r) {
            continue;
        }
        let off = (g / r).asin();
        for root in [phase + off, phase + PI - off] {
            let up = root + TAU * ((first - root) / TAU).ceil();
            let down = root + TAU * ((last - root) / TAU).floor();
            for turn in [up, down].into_iter().filter(|turn| (first..=last).contains(turn)) {
                let value = a[k] + u[k] * (turn.cos() - 1.0) + v[k] * turn.sin() + g * turn;
                (all[0][k], all[1][k]) = (all[0][k].min(value), all[1][k].max(value));
            }
        }
    }
    all
}

/// The box around a smooth course, of whose wiggles none is shorter than some samples: of each coordinate, the parabola through three of them.
fn sampled_extent(samples: usize, at: impl Fn(f64) -> [f64; 3]) -> [[f64; 3]; 2] {
    let points: Vec<[f64; 3]> = (0..=samples).map(|k| at(k as f64 / samples as f64)).collect();
    let ends = points
        .iter()
        .fold([points[0]; 2], |all, point| joined(all, [*point; 2]));
    points.windows(3).fold(ends, |all, three| {
        let extreme = |k: usize| {
            let [p, q, r] = [three[0][k], three[1][k], three[2][k]];
            let (slope, bend) = (0.5 * (r - p), p - 2.0 * q + r);
            // Its extreme, if that is between the first and the last.
            if slope.abs() < bend.abs() {
                q - 0.5 * slope * slope / bend
            } else {
                q
            }
        };
        joined(all, [[0, 1, 2].map(extreme); 2])
    })
}

impl ToolUsage {
    /// Adds a move that takes at least so many seconds.
    fn add(&mut self, from: &ProgramPose, to: &ProgramPose, (unit, rpm): (f64, Option<f64>), seconds: Option<f64>) {
        let length = length(from, to);
        if to.rapid {
            self.rapid_moves += 1;
            self.rapid_length += length;
            return;
        }
        self.feed_moves += 1;
        self.feed_length += length;
        self.arcs += usize::from(matches!(to.way().course, TipCourse::Arc(_)));
        let found = course_extent(from, to);
        self.extent = Some(self.extent.map_or(found, |all| joined(all, found)));
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
        match seconds {
            Some(seconds) => self.seconds += seconds,
            None => self.untimed += 1,
        }
    }
}

/// The length of the tip's way.
pub(crate) fn length(from: &ProgramPose, to: &ProgramPose) -> f64 {
    to.way().course.length([from.pose.tip(), to.pose.tip()])
}

#[cfg(test)]
mod tests {
    use crate::machines::Machine;
    use crate::model::program::Program;
    use crate::model::read_options::ReadOptions;

    /// Arcs and helices in all planes, turned too, and moves of a part that turns, against points along chords.
    #[test]
    fn boxes_hold_arcs_and_touch_them() {
        let mut options = ReadOptions {
            exact_arcs: true,
            ..ReadOptions::default()
        };
        let mut programs = Vec::new();
        for turn in ["", "G68 X0 Y0 R33\n", "G68.2 X1 Y2 Z3 I20 J35 K10\n"] {
            for arc in [
                "G17 G2 X0 Y0 I5 J2 F100",
                "G17 G3 X4 Y4 I4 J0 F100",
                "G17 G3 X4 Y4 Z7 I4 J0 P3 F100",
                "G17 G2 X0 Y0 Z-30 I-3 J1 P2 F100",
                "G18 G2 X6 Z5 I3 K0 F100",
                "G18 G3 X6 Z5 Y2 I3 K0 P2 F100",
                "G19 G3 Y0 Z5 J1 K-4 F100",
            ] {
                programs.push((
                    None,
                    format!("G21\nM428\nG0 X0 Y0 Z5 A0 B0\n{turn}G0 X0 Y0 Z5\n{arc}\n"),
                ));
            }
        }
        for block in ["A70", "A-250 Z9", "X4 Y-3 A400", "Y6 Z1 A-1000"] {
            let text = format!("G21\nG0 X0 Y2 Z5 A20\nG1 {block} F100\n");
            programs.push((Some("rotary-a"), text));
        }
        let mut bulges = [0; 2];
        for (machine, text) in programs {
            options.machine = machine.map_or_else(Machine::default, |name| Machine::named(name).unwrap());
            let program = crate::gcode::read(&text, &options).unwrap_or_else(|error| panic!("{text}{error}"));
            let [low, high] = program.extent().unwrap();
            options.exact_arcs = false;
            options.arc_tolerance = 1e-5;
            let chords = crate::gcode::read(&text, &options).unwrap();
            options.exact_arcs = true;
            assert!(chords.poses.len() > 100 && program.poses.len() < 5, "{text}");
            let tips =
                |program: &Program| -> Vec<[f64; 3]> { program.poses.in_order().map(|pose| pose.pose.tip()).collect() };
            for k in 0..3 {
                let range = tips(&chords)
                    .iter()
                    .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], tip| {
                        [a.min(tip[k]), b.max(tip[k])]
                    });
                assert!(
                    (low[k] - range[0]).abs() < 2e-5 && (high[k] - range[1]).abs() < 2e-5,
                    "{text}{k}: {low:?} {high:?} {range:?}"
                );
                let ends = tips(&program);
                let largest = ends[ends.len() - 2..].iter().fold(f64::MIN, |all, tip| all.max(tip[k]));
                bulges[usize::from(machine.is_some())] += usize::from(range[1] > largest + 0.1);
            }
        }
        assert!(bulges[0] > 15 && bulges[1] > 2, "{bulges:?}");
    }
}
