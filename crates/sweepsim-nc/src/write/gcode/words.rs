//! Words of letters and numbers: RS-274, Fanuc, Haas, Grbl and Siemens.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use super::arcs::is_whole;
use super::comments;
use super::steps::{Aim, Block, Language, Step};
use super::{GcodeOptions, letters, number};
use crate::model::event::{Coolant, EventKind, Spindle};
use crate::model::program::{FeedMode, Program};
use crate::model::read_options::Controller;

/// What is in effect.
pub(super) struct Words {
    dialect: Controller,
    decimals: usize,
    tip_control: bool,
    /// Which of A, B and C the machine has.
    letters: [bool; 3],
    text: String,
    tool: Option<u32>,
    /// The length of the tool is in effect.
    length: bool,
    /// Tip control is on.
    controlled: bool,
    motion: &'static str,
    plane: usize,
    mode: FeedMode,
    feed: Option<f64>,
    xyz: [Option<f64>; 3],
    aim: Aim,
}

impl Words {
    pub fn new(program: &Program, options: &GcodeOptions) -> Self {
        let mut text = String::new();
        let title = program.title.as_deref().filter(|title| !title.trim().is_empty());
        let siemens = options.dialect == Controller::Siemens;
        match options.dialect {
            Controller::Grbl | Controller::Siemens => {}
            Controller::Fanuc | Controller::Haas => text.push_str("%\nO0001\n"),
            _ => text.push_str("%\n"),
        }
        for line in title.map(str::to_owned).into_iter().chain(comments::of(program)) {
            comment(&mut text, &line, siemens);
        }
        text.push_str(match options.dialect {
            Controller::Siemens => "G17 G71 G90 G94 G40\n",
            Controller::Grbl => "G21 G17 G90 G94\n",
            _ => "G21 G17 G90 G94 G40 G49 G80\n",
        });
        Self {
            dialect: options.dialect,
            decimals: options.decimals,
            tip_control: options.tip_control,
            letters: letters(options),
            text,
            tool: None,
            length: false,
            controlled: false,
            motion: "",
            plane: 2,
            mode: FeedMode::PerMinute,
            feed: None,
            xyz: [None; 3],
            aim: Aim::Up,
        }
    }

    pub fn finish(mut self) -> String {
        self.release();
        self.line(match self.dialect {
            Controller::Grbl | Controller::Siemens => "M30",
            _ => "M30\n%",
        });
        self.text
    }

    fn siemens(&self) -> bool {
        self.dialect == Controller::Siemens
    }

    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// A number that is no whole one by itself.
    fn decimal(&self, value: f64) -> String {
        let mut text = number(value, self.decimals);
        // Without a point, Fanuc takes it in the smallest increment.
        if matches!(self.dialect, Controller::Fanuc | Controller::Haas) && !text.contains('.') {
            text.push('.');
        }
        text
    }

    /// Ends tip control.
    fn release(&mut self) {
        if std::mem::take(&mut self.controlled) {
            self.line(match self.dialect {
                Controller::LinuxCnc => "M429",
                Controller::Siemens => "TRAFOOF",
                _ => "G49",
            });
        }
    }

    /// Begins tip control, if a move needs it.
    fn control(&mut self, aim: Aim) {
        let vector = match aim {
            Aim::Up => return,
            Aim::Angles(_) if !self.tip_control => return,
            Aim::Angles(_) => false,
            Aim::Vector(_) => true,
        };
        if std::mem::replace(&mut self.controlled, true) {
            return;
        }
        let number = self.tool.unwrap_or(1);
        let line = match self.dialect {
            Controller::Siemens => "TRAORI".to_owned(),
            Controller::LinuxCnc => "M428".to_owned(),
            Controller::Haas => format!("G234 H{number}"),
            _ if vector => format!("G43.5 H{number}"),
            _ => format!("G43.4 H{number}"),
        };
        self.length = true;
        self.line(&line);
    }

    fn event(&mut self, event: &EventKind, lose: &mut dyn FnMut(&str)) {
        let speed = |rpm: &Option<f64>| rpm.map_or_else(String::new, |rpm| format!("S{} ", number(rpm, self.decimals)));
        let line = match event {
            EventKind::ToolChange(_) => return,
            EventKind::Spindle(Spindle::Stopped) => "M5".to_owned(),
            EventKind::Spindle(Spindle::Clockwise { rpm }) => format!("{}M3", speed(rpm)),
            EventKind::Spindle(Spindle::CounterClockwise { rpm }) => format!("{}M4", speed(rpm)),
            EventKind::Coolant(Coolant::Off) => "M9".to_owned(),
            EventKind::Coolant(Coolant::Mist) => "M7".to_owned(),
            EventKind::Coolant(Coolant::Flood) => "M8".to_owned(),
            EventKind::Coolant(Coolant::Through) if self.dialect == Controller::Haas => "M88".to_owned(),
            EventKind::Coolant(Coolant::ThroughOff) if self.dialect == Controller::Haas => "M89".to_owned(),
            EventKind::Coolant(_) => return lose("coolant through the spindle"),
            EventKind::Dwell { seconds } => {
                let seconds = self.decimal(*seconds);
                match self.dialect {
                    Controller::Siemens => format!("G4 F{seconds}"),
                    Controller::Fanuc => format!("G4 X{seconds}"),
                    _ => format!("G4 P{seconds}"),
                }
            }
            EventKind::Stop => "M0".to_owned(),
            EventKind::OptionalStop => "M1".to_owned(),
            EventKind::Message(text) if self.siemens() => {
                format!("MSG(\"{}\")", text.replace('"', "'").replace(['\n', '\r'], " "))
            }
            EventKind::Message(text) => format!("(MSG, {})", plain(text)),
        };
        self.line(&line);
    }

    fn go(&mut self, block: &Block, lose: &mut dyn FnMut(&str)) {
        let changed: [bool; 3] = std::array::from_fn(|k| self.xyz[k] != Some(block.xyz[k]) || block.arc.is_some());
        let aims = self.aim != block.aim || block.starts;
        if !aims && !changed.contains(&true) {
            return;
        }
        self.control(block.aim);
        let mut feed = String::new();
        if let Some((value, mode)) = block.feed.filter(|_| !block.rapid) {
            if mode == FeedMode::PerRevolution && self.dialect == Controller::Grbl {
                lose("feeds per revolution, which Grbl has not");
            }
            if mode != self.mode {
                self.mode = mode;
                self.feed = None;
                self.line(match mode {
                    FeedMode::PerMinute => "G94",
                    FeedMode::PerRevolution => "G95",
                    FeedMode::InverseTime => "G93",
                });
            }
            let value = self.rounded(value);
            // In inverse time, each block has its own.
            if self.feed.replace(value) != Some(value) || mode == FeedMode::InverseTime {
                feed = format!(" F{}", self.decimal(value));
            }
        }
        if let Some(arc) = block.arc.filter(|arc| arc.w != self.plane) {
            self.plane = arc.w;
            self.line(["G19", "G18", "G17"][arc.w]);
        }
        let motion = match block.arc {
            Some(arc) if arc.sweep > 0.0 => "G3",
            Some(_) => "G2",
            None if block.rapid => "G0",
            None => "G1",
        };
        let mut text = String::new();
        if self.motion != motion || block.starts {
            self.motion = motion;
            text.push_str(motion);
        }
        let length = match self.tool {
            Some(tool) if !self.length && !matches!(self.dialect, Controller::Grbl | Controller::Siemens) => {
                self.length = true;
                format!(" G43 H{tool}")
            }
            _ => String::new(),
        };
        if block.starts && block.aim == Aim::Up && self.xyz[2].is_none() {
            // First across, then down.
            for k in [0, 1] {
                let _ = write!(text, " {}{}", ['X', 'Y'][k], self.decimal(block.xyz[k]));
            }
            self.line(text.trim_start());
            text = format!("{length} Z{}", self.decimal(block.xyz[2]));
        } else {
            text.push_str(&length);
            for k in (0..3).filter(|&k| changed[k]) {
                let _ = write!(text, " {}{}", ['X', 'Y', 'Z'][k], self.decimal(block.xyz[k]));
            }
            if aims {
                self.directions(block, &mut text);
            }
        }
        self.centre(block, &mut text);
        text.push_str(&feed);
        self.line(text.trim_start());
        self.xyz = block.xyz.map(Some);
        self.aim = block.aim;
    }

    /// A number as it will be read.
    fn rounded(&self, value: f64) -> f64 {
        number(value, self.decimals).parse().unwrap_or(value)
    }

    fn directions(&self, block: &Block, text: &mut String) {
        match block.aim {
            Aim::Up => {}
            Aim::Angles(angles) => {
                for (k, angle) in angles.into_iter().enumerate() {
                    let before = match self.aim {
                        Aim::Angles(before) if !block.starts => before[k],
                        _ => f64::NAN,
                    };
                    if self.letters[k] && angle != before {
                        let _ = write!(text, " {}{}", ['A', 'B', 'C'][k], self.decimal(angle));
                    }
                }
            }
            Aim::Vector(vector) => {
                let names = if self.siemens() {
                    ["A3=", "B3=", "C3="]
                } else {
                    ["I", "J", "K"]
                };
                for (name, value) in names.into_iter().zip(vector) {
                    let _ = write!(text, " {name}{}", self.decimal(value));
                }
            }
        }
    }

    fn centre(&self, block: &Block, text: &mut String) {
        let Some(arc) = block.arc else { return };
        for k in (0..3).filter(|&k| k != arc.w) {
            let _ = write!(text, " {}{}", ['I', 'J', 'K'][k], self.decimal(arc.offset[k]));
        }
        if self.siemens() {
            // Full turns besides what the ends say.
            let further = if is_whole(arc.sweep) {
                arc.turns - 1.0
            } else {
                (arc.sweep.abs() / TAU).floor()
            };
            if further > 0.0 {
                let _ = write!(text, " TURN={further}");
            }
        } else if arc.turns > 1.0 {
            let _ = write!(text, " P{}", arc.turns);
        }
    }
}

impl Language for Words {
    fn step(&mut self, step: &Step, lose: &mut dyn FnMut(&str)) {
        match *step {
            Step::Leave => {
                self.release();
                self.line(if self.siemens() {
                    "SUPA G0 Z0 D0\nD1"
                } else {
                    "G53 G0 Z0"
                });
                self.xyz = [None; 3];
                self.motion = "";
            }
            Step::Tool { number, changes } => {
                if changes {
                    self.release();
                    self.length = false;
                    let line = if self.siemens() {
                        format!("T{number} M6\nD1")
                    } else {
                        format!("T{number} M6")
                    };
                    self.line(&line);
                    self.xyz = [None; 3];
                    self.motion = "";
                } else {
                    self.line(&format!("T{number}"));
                }
                self.tool = Some(number);
            }
            Step::Event(event) => self.event(event, lose),
            Step::Move(block) => self.go(&block, lose),
        }
    }
}

/// Text that may stand in parentheses.
fn plain(text: &str) -> String {
    text.replace('(', "[").replace(')', "]").replace(['\n', '\r'], " ")
}

fn comment(text: &mut String, line: &str, siemens: bool) {
    let line = line.replace(['\n', '\r'], " ");
    let _ = if siemens {
        writeln!(text, "; {line}")
    } else {
        writeln!(text, "({})", plain(&line))
    };
}
