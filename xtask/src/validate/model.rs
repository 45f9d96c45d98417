//! How long the blocks of a program take on the Hurco: the project's own times of moves, and constants for what is no
//! move.

use super::log::Run;
use std::collections::BTreeMap;
use sweepsim_nc::{Machine, MachineDescription, ReadOptions, gcode};

/// The ready machine that is judged: its largest speeds are not fitted.
pub const MACHINE: &str = "hurco-04";

/// The end of the dial of feed overrides.
const DIAL: f64 = 1.5;

/// What blocks do besides, and whether it is a rapid to or from places in machine coordinates, which are not in the
/// program: those are as slow as the rapid override makes them.
pub const WAITS: [(&str, bool); 8] = [
    ("change of tool", false),
    ("start of the spindle", false),
    ("approach", true),
    ("`M5`", false),
    ("`M01`", false),
    ("home", true),
    ("parking", true),
    ("other", false),
];

/// What is fitted.
#[derive(Clone, Copy, Debug)]
pub struct Fit {
    /// Of each axis, in mm/s².
    pub acceleration: f64,
    /// The same in rapids.
    pub rapid_acceleration: f64,
    /// How tightly corners are taken, in mm.
    pub corner: f64,
    /// Over how many seconds the control averages speeds.
    pub smoothing: f64,
    /// Seconds of what is no move between places that the program gives: see [`WAITS`].
    pub waits: [f64; WAITS.len()],
}

impl Fit {
    /// Of the ready machine.
    pub fn ready() -> Result<Self, String> {
        let machine = description()?;
        let axis = machine.linear.first().ok_or("no axes")?;
        Ok(Self {
            acceleration: axis.acceleration.ok_or("no acceleration")?,
            rapid_acceleration: axis.rapid_acceleration.ok_or("no rapid_acceleration")?,
            corner: machine.corner_deviation.ok_or("no corner_deviation")?,
            smoothing: machine.smoothing,
            waits: [0.0; WAITS.len()],
        })
    }

    /// The ready machine with what is fitted in place of its own, at a rapid override.
    fn machine(&self, rapid: f64) -> Result<Machine, String> {
        let mut machine = description()?;
        (machine.corner_deviation, machine.smoothing) = (Some(self.corner), self.smoothing);
        for axis in &mut machine.linear {
            axis.speed = axis.speed.map(|speed| speed * rapid);
            (axis.acceleration, axis.rapid_acceleration) = (Some(self.acceleration), Some(self.rapid_acceleration));
        }
        Machine::new(machine).map_err(|error| error.to_string())
    }

    /// What is fitted, in words.
    pub fn text(&self) -> String {
        format!(
            "acceleration {:.0} mm/s², in rapids {:.0} mm/s², corners {:.4} mm, smoothing {:.3} s",
            self.acceleration, self.rapid_acceleration, self.corner, self.smoothing
        )
    }
}

fn description() -> Result<MachineDescription, String> {
    let machine = Machine::named(MACHINE).and_then(|machine| machine.kinematics);
    Ok(machine.ok_or("no such machine")?.description().clone())
}

/// What a block does besides cutting, as a place in [`Fit::waits`]; `None`: it only moves.
pub fn wait(block: &str) -> Option<usize> {
    let has = |word: &str| block.contains(word);
    if has("M6") {
        Some(0)
    } else if has("M3") && has("S") && !has("M30") {
        Some(1)
    } else if has("M8") {
        Some(2)
    } else if has("M01") {
        Some(4)
    } else if has("G28") {
        Some(5)
    } else if has("G58") {
        Some(6)
    } else if has("M5") {
        Some(3)
    } else {
        let moves = ["X", "Y", "Z", "I", "J"].iter().any(|word| has(word));
        (!moves).then_some(7)
    }
}

/// A program as the machine runs it: a list of blocks.
pub struct Blocks {
    pub lines: Vec<String>,
}

impl Blocks {
    /// The operations: where each begins, with a change of tools.
    pub fn operations(&self) -> Vec<usize> {
        let changes = self.lines.iter().enumerate().filter(|(_, line)| line.contains("M6"));
        changes.map(|(k, _)| k + 1).collect()
    }

    /// Programmed feeds by line, in mm/s.
    pub fn feeds(&self) -> Vec<f64> {
        let mut feed = 0.0;
        let each = self.lines.iter().map(|line| {
            feed = word(line, 'F').unwrap_or(feed);
            feed * 25.4 / 60.0
        });
        each.collect()
    }

    /// The feed override of each operation, from the logged speeds: the 80th percentile over its longer blocks of the
    /// speed in the middle of a block, as a share of the feed, in steps of the dial of 5 %. An operation without long
    /// blocks has that of the one before.
    pub fn overrides(&self, run: &Run, ideal: &BTreeMap<usize, f64>) -> BTreeMap<usize, f64> {
        let feeds = self.feeds();
        let starts = self.operations();
        let mut found = BTreeMap::new();
        let mut last = 1.0;
        for (k, start) in starts.iter().enumerate() {
            let end = starts.get(k + 1).copied().unwrap_or(usize::MAX);
            let mut shares = Vec::new();
            for pair in run.blocks.windows(2) {
                let ((from, line), (to, next)) = (pair[0], pair[1]);
                let long = next == line + 1 && ideal.get(&line).is_some_and(|seconds| *seconds > 0.6);
                if !(long && (*start..end).contains(&line)) || wait(&self.lines[line - 1]).is_some() {
                    continue;
                }
                let inside = run.speeds.iter().filter(|(time, _)| from + 0.3 < *time && *time < to);
                let fastest = inside.map(|(_, speed)| *speed).fold(0.0, f64::max);
                let share = fastest / feeds[line - 1];
                // Beyond the dial are rapids of cycles.
                if (0.01..DIAL).contains(&share) {
                    shares.push(share);
                }
            }
            shares.sort_by(f64::total_cmp);
            if let Some(share) = shares.get(shares.len() * 4 / 5) {
                last = (share / 0.05).round() * 0.05;
            }
            found.insert(*start, last);
        }
        found
    }

    /// Seconds of the moves of each line, as times of feeds and of rapids: feeds changed by the override of their
    /// operation, rapids by another one.
    pub fn moves(
        &self,
        fit: &Fit,
        feeds: &BTreeMap<usize, f64>,
        rapid: f64,
    ) -> Result<BTreeMap<usize, [f64; 2]>, String> {
        let mut text = String::new();
        for (k, line) in self.lines.iter().enumerate() {
            let share = feeds.range(..=k + 1).next_back().map_or(1.0, |(_, share)| *share);
            match word(line, 'F') {
                Some(feed) => {
                    let at = line.find('F').unwrap_or(0);
                    let rest = line[at + 1..].trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
                    text += &format!("{}F{:.6}{rest}\n", &line[..at], feed * share);
                }
                None => text += &format!("{line}\n"),
            }
        }
        let mut options = ReadOptions::default();
        options.exact_arcs = true;
        options.lenient = true;
        options.machine = fit.machine(rapid)?;
        let program = gcode::read(&text, &options).map_err(|error| error.to_string())?;
        let mut lines: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
        for (pose, time) in program.poses.in_order().zip(program.times()) {
            let entry = lines.entry(pose.line).or_default();
            entry[usize::from(pose.rapid)] += time.seconds.unwrap_or(0.0) + time.rest;
        }
        Ok(lines)
    }
}

/// The number after a letter of a block.
fn word(line: &str, letter: char) -> Option<f64> {
    let code = line.split('(').next()?;
    let rest = &code[code.find(letter)? + 1..];
    let end = rest
        .find(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-'))
        .unwrap_or(rest.len());
    rest[..end].parse().ok()
}
