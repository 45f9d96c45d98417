//! Programs for a machine from the moves of another.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use nalgebra::Vector3;
use sweepsim_motion::{Course, TipArc};
use thiserror::Error;

use crate::machines::{Kinematics, Position, ReachError};
use crate::model::program::{FeedMode, Program};

/// How to write a program for a machine.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct PostOptions {
    /// Under tip control (`G43.4`): coordinates are the tip in the part's frame. Otherwise they are those of the machine's axes.
    pub tip_control: bool,
}

impl PostOptions {
    /// With or without tip control.
    #[must_use]
    pub fn tip_control(on: bool) -> Self {
        Self { tip_control: on }
    }
}

/// Why a program cannot be written for a machine.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PostError {
    /// A pose that the machine does not reach.
    #[error("line {line}: {error}")]
    Reach {
        /// The index of the pose.
        pose: usize,
        /// Its line in the program that it was read from.
        line: usize,
        /// Why.
        error: ReachError,
    },
    /// A move along an arc in no plane of the machine's axes, or along which rotary axes turn.
    #[error(
        "line {line}: this arc is in no plane of the machine's axes: read the program without exact arcs, as chords"
    )]
    Arc {
        /// The index of the pose at its end.
        pose: usize,
        /// Its line.
        line: usize,
    },
}

/// Writes a program as G-code for a machine: one block per pose, with the positions that its control would choose, in millimetres and
/// degrees with all digits. Arcs in a plane of the axes, along which no rotary axis turns, are `G2` and `G3`.
///
/// Poses are what is kept. Between them the axes of the machine move in their own way: the axis of the tool as
/// [`AxisLaw::Rotary`](crate::AxisLaw) has it, and without tip control the tip leaves the straight line. Feeds without tip control are in inverse
/// time (`G93`) where a rotary axis turns. Rapid moves are `G0`.
///
/// # Errors
/// [`PostError`]: a pose out of reach, or an arc that is none of the axes.
///
/// ```
/// use sweepsim_nc::{Machine, PostOptions, ReadOptions, gcode, post};
/// let machine = Machine::named("head-bc").ok_or("no such machine")?;
/// let kinematics = machine.kinematics.as_ref().ok_or("no axes")?;
/// let path = gcode::read("M428 G0 X0 Y0 Z5 B0 C0\nG1 X10 B30 C45 F500", &ReadOptions::default())?;
/// let text = post(&path, kinematics, &PostOptions::tip_control(false))?;
/// // The pivot is 150 mm above the tip: the axes move further than the tip, and the feed becomes a duration.
/// assert!(text.contains("G0 X0 Y0 Z5 B0 C0\nG93\nG1 X-43.033"), "{text}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn post(program: &Program, machine: &Kinematics, options: &PostOptions) -> Result<String, PostError> {
    let mut text = String::from("%\nG21 G90 G94 G17 G40\n");
    let mut tool = None;
    let mut at: Option<Position> = None;
    let mut mode = FeedMode::PerMinute;
    let mut controlled = false;
    let mut plane = 2;
    let letters: Vec<usize> = (0..3).filter(|&k| machine.rotaries().has(k)).collect();
    for (index, pose) in program.poses.iter().enumerate() {
        if pose.tool != tool {
            tool = pose.tool;
            if let Some(tool) = tool {
                if controlled {
                    text.push_str("G49\n");
                    controlled = false;
                }
                let _ = writeln!(text, "T{tool} M6");
            }
        }
        if options.tip_control && !controlled {
            let _ = writeln!(text, "G43.4 H{}", tool.unwrap_or(1));
            controlled = true;
        }
        let length = machine.tool_length(tool);
        let near = at.unwrap_or_else(|| machine.start(length));
        let position = machine
            .nearest(&pose.pose, length, &near)
            .map_err(|error| PostError::Reach {
                pose: index,
                line: pose.line,
                error,
            })?;
        let turns = at.is_some_and(|at| at.abc != position.abc);
        let xyz = if options.tip_control {
            pose.pose.tip()
        } else {
            position.xyz
        };
        let mut xyz = xyz;
        let mut block = String::from(if pose.rapid || !pose.joined { "G0" } else { "G1" });
        let mut centre = String::new();
        if let (Course::Arc(arc), true) = (pose.way.course, pose.joined) {
            let start = at.filter(|at| at.abc == position.abc).map(|at| {
                if options.tip_control {
                    program.poses[index - 1].pose.tip()
                } else {
                    at.xyz
                }
            });
            let found = start.and_then(|_| {
                let along = |way: [f64; 3]| match options.tip_control {
                    true => way,
                    false => machine.linear_along(way, position.abc),
                };
                PostedArc::new(&arc, program.poses[index - 1].pose.tip(), &along)
            });
            let (Some(found), Some(start)) = (found, start) else {
                let line = pose.line;
                return Err(PostError::Arc { pose: index, line });
            };
            if found.whole {
                // A full turn ends where it starts, to the last digit.
                for k in [(found.w + 1) % 3, (found.w + 2) % 3] {
                    xyz[k] = start[k];
                }
            }
            if found.w != plane {
                plane = found.w;
                text.push_str(["G19\n", "G18\n", "G17\n"][plane]);
            }
            block = String::from(if found.sweep > 0.0 { "G3" } else { "G2" });
            centre = found.words();
        }
        for (letter, value) in ['X', 'Y', 'Z'].into_iter().zip(xyz) {
            let _ = write!(block, " {letter}{value}");
        }
        for &k in &letters {
            let _ = write!(block, " {}{}", ['A', 'B', 'C'][k], position.abc[k]);
        }
        block.push_str(&centre);
        if let Some(feed) = pose.feed.filter(|_| !pose.rapid && pose.joined) {
            let way = index.checked_sub(1).map_or(0.0, |before| {
                let from = program.poses[before].pose.tip();
                pose.pose
                    .tip()
                    .iter()
                    .zip(from)
                    .map(|(a, b)| (a - b).powi(2))
                    .sum::<f64>()
                    .sqrt()
            });
            let inverse = !options.tip_control && turns && way > 0.0 && pose.feed_mode == FeedMode::PerMinute;
            let (wanted, value) = if inverse {
                (FeedMode::InverseTime, feed / way)
            } else {
                (pose.feed_mode, feed)
            };
            if wanted != mode {
                mode = wanted;
                text.push_str(match mode {
                    FeedMode::PerMinute => "G94\n",
                    FeedMode::PerRevolution => "G95\n",
                    FeedMode::InverseTime => "G93\n",
                });
            }
            let _ = write!(block, " F{value}");
        }
        text.push_str(&block);
        text.push('\n');
        at = Some(position);
    }
    if controlled {
        text.push_str("G49\n");
    }
    text.push_str("M30\n%\n");
    Ok(text)
}

/// An arc in a plane of the axes.
struct PostedArc {
    /// The axis across the plane.
    w: usize,
    /// From the start to the centre.
    offset: [f64; 3],
    /// Counter-clockwise about the axis `w`.
    sweep: f64,
    turns: f64,
    /// Whether it consists of full turns.
    whole: bool,
}

impl PostedArc {
    /// The arc of the tip from `tip`, where ways of the tip are those of the axes by `along`.
    fn new(arc: &TipArc, tip: [f64; 3], along: &dyn Fn([f64; 3]) -> [f64; 3]) -> Option<Self> {
        let normal = Vector3::from(arc.normal());
        let out = Vector3::from(arc.centre()) - Vector3::from(tip);
        let inward = out - normal * normal.dot(&out);
        let across = normal.cross(&inward);
        let [n, i, a] = [normal, inward, across].map(|way| Vector3::from(along(way.into())));
        let radius = inward.norm();
        // Axes at right angles, with the arc's plane across one of them.
        let round =
            (i.norm() - radius).abs() < 1e-9 && (a.norm() - radius).abs() < 1e-9 && i.dot(&a).abs() < 1e-9 * radius;
        let w = (0..3).find(|&w| (n[w].abs() - 1.0).abs() < 1e-12)?;
        let flat = i[w].abs() < 1e-9 && a[w].abs() < 1e-9;
        // The axes may be left-handed.
        let sense = i.cross(&a)[w].signum();
        if !(round && flat) {
            return None;
        }
        let sweep = arc.angle() * sense;
        let turns = sweep.abs() / TAU;
        let whole = (turns - turns.round()).abs() < 1e-9;
        Some(Self {
            w,
            offset: i.into(),
            sweep,
            turns: if whole { turns.round() } else { turns.ceil() },
            whole,
        })
    }

    fn words(&self) -> String {
        let mut words = String::new();
        for k in (0..3).filter(|&k| k != self.w) {
            let _ = write!(words, " {}{}", ['I', 'J', 'K'][k], self.offset[k]);
        }
        if self.turns > 1.0 {
            let _ = write!(words, " P{}", self.turns);
        }
        words
    }
}
