//! Klartext of Heidenhain's controls.

use std::fmt::Write as _;

use super::comments;
use super::steps::{Aim, Block, Language, Step};
use super::{GcodeOptions, letters, number};
use crate::model::event::{Coolant, EventKind, Spindle};
use crate::model::program::{FeedMode, Program};
use crate::model::stock::StockDescription;

/// What is in effect.
pub(super) struct Klartext {
    decimals: usize,
    tip_control: bool,
    letters: [bool; 3],
    name: String,
    text: String,
    controlled: bool,
    feed: Option<(f64, FeedMode)>,
    speed: Option<f64>,
    xyz: [Option<f64>; 3],
    aim: Aim,
}

impl Klartext {
    pub fn new(program: &Program, options: &GcodeOptions) -> Self {
        let title = program.title.as_deref().unwrap_or("");
        let mut name: String = title
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
            .take(24)
            .collect();
        if name.is_empty() {
            name = "PROGRAM".to_owned();
        }
        let mut made = Self {
            decimals: options.decimals,
            tip_control: options.tip_control,
            letters: letters(options),
            text: format!("BEGIN PGM {name} MM\n"),
            name,
            controlled: false,
            feed: None,
            speed: None,
            xyz: [None; 3],
            aim: Aim::Up,
        };
        if let Some(StockDescription::Block { min, max }) = program.stock {
            let corner = |point| made.point(point, [true; 3]);
            let (low, high) = (corner(min), corner(max));
            let _ = write!(made.text, "BLK FORM 0.1 Z{low}\nBLK FORM 0.2{high}\n");
        }
        for line in comments::of(program) {
            let _ = writeln!(made.text, "; {}", line.replace(['\n', '\r'], " "));
        }
        made
    }

    pub fn finish(mut self) -> String {
        self.release();
        let _ = write!(self.text, "L M30\nEND PGM {} MM\n", self.name);
        self.text
    }

    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn signed(&self, value: f64) -> String {
        let text = number(value, self.decimals);
        if text.starts_with('-') {
            text
        } else {
            format!("+{text}")
        }
    }

    fn point(&self, xyz: [f64; 3], which: [bool; 3]) -> String {
        let words = (0..3).filter(|&k| which[k]);
        words
            .map(|k| format!(" {}{}", ['X', 'Y', 'Z'][k], self.signed(xyz[k])))
            .collect()
    }

    fn release(&mut self) {
        if std::mem::take(&mut self.controlled) {
            self.line("M129");
        }
    }

    fn event(&mut self, event: &EventKind, lose: &mut dyn FnMut(&str)) {
        let line = match event {
            EventKind::ToolChange(_) => return,
            EventKind::Spindle(spindle) => {
                let (rpm, code) = match spindle {
                    Spindle::Stopped => (None, "L M5"),
                    Spindle::Clockwise { rpm } => (*rpm, "L M3"),
                    Spindle::CounterClockwise { rpm } => (*rpm, "L M4"),
                };
                if rpm.is_some() && self.speed != rpm {
                    self.speed = rpm;
                    let speed = number(rpm.unwrap_or(0.0), self.decimals);
                    self.line(&format!("TOOL CALL Z S{speed}"));
                }
                code.to_owned()
            }
            EventKind::Coolant(Coolant::Off) => "L M9".to_owned(),
            EventKind::Coolant(Coolant::Mist) => "L M7".to_owned(),
            EventKind::Coolant(Coolant::Flood) => "L M8".to_owned(),
            EventKind::Coolant(_) => return lose("coolant through the spindle"),
            EventKind::Dwell { seconds } => {
                let seconds = number(*seconds, self.decimals);
                format!("CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL {seconds}")
            }
            EventKind::Stop => "STOP".to_owned(),
            EventKind::OptionalStop => "L M1".to_owned(),
            EventKind::Message(text) => {
                lose("texts for the operator: they become comments");
                format!("; {}", text.replace(['\n', '\r'], " "))
            }
        };
        self.line(&line);
    }

    /// The word of a feed, if it changes.
    fn feed(&mut self, block: &Block, lose: &mut dyn FnMut(&str)) -> String {
        if block.rapid {
            return " FMAX".to_owned();
        }
        let Some((value, mode)) = block.feed else {
            return String::new();
        };
        let (value, mode) = match mode {
            FeedMode::InverseTime => {
                lose("feeds in inverse time: they become feeds per minute");
                (value * block.length, FeedMode::PerMinute)
            }
            mode => (value, mode),
        };
        if mode == FeedMode::PerRevolution {
            lose("feeds per revolution");
            return String::new();
        }
        let value = number(value, self.decimals).parse().unwrap_or(value);
        if self.feed.replace((value, mode)) == Some((value, mode)) {
            return String::new();
        }
        format!(" F{}", number(value, self.decimals))
    }

    fn go(&mut self, block: &Block, lose: &mut dyn FnMut(&str)) {
        let controls = match block.aim {
            Aim::Up => false,
            Aim::Angles(_) => self.tip_control,
            Aim::Vector(_) => true,
        };
        if controls && !std::mem::replace(&mut self.controlled, true) {
            self.line("M128");
        }
        if let Some(arc) = block.arc {
            let Some(start) = self.xyz[0].zip(self.xyz[1]) else {
                return;
            };
            let feed = self.feed(block, lose);
            let centre = [start.0 + arc.offset[0], start.1 + arc.offset[1], 0.0];
            let sense = if arc.sweep > 0.0 { "DR+" } else { "DR-" };
            let centre = self.point(centre, [true, true, false]);
            self.line(&format!("CC{centre}"));
            if arc.turns > 1.0 || self.xyz[2] != Some(block.xyz[2]) {
                let angle = self.signed(arc.sweep.to_degrees());
                let height = self.point(block.xyz, [false, false, true]);
                self.line(&format!("CP IPA{angle}{height} {sense}{feed}"));
            } else {
                let end = self.point(block.xyz, [true, true, false]);
                self.line(&format!("C{end} {sense}{feed}"));
            }
            self.xyz = block.xyz.map(Some);
            return;
        }
        let changed: [bool; 3] = std::array::from_fn(|k| self.xyz[k] != Some(block.xyz[k]));
        let aims = self.aim != block.aim || block.starts;
        if !aims && !changed.contains(&true) {
            return;
        }
        let feed = self.feed(block, lose);
        let mut text = match block.aim {
            Aim::Up if block.starts && self.xyz[2].is_none() => {
                // First across, then down.
                let across = self.point(block.xyz, [true, true, false]);
                self.line(&format!("L{across} R0 FMAX"));
                format!("L{}", self.point(block.xyz, [false, false, true]))
            }
            Aim::Vector(vector) if aims => {
                let point = self.point(block.xyz, [true; 3]);
                let [x, y, z] = vector.map(|value| self.signed(value));
                format!("LN{point} TX{x} TY{y} TZ{z}")
            }
            Aim::Angles(angles) if aims => {
                let mut text = format!("L{}", self.point(block.xyz, changed));
                for k in (0..3).filter(|&k| self.letters[k]) {
                    let _ = write!(text, " {}{}", ['A', 'B', 'C'][k], self.signed(angles[k]));
                }
                text
            }
            _ => format!("L{}", self.point(block.xyz, changed)),
        };
        if text.starts_with("L ") {
            text.push_str(" R0");
        }
        text.push_str(&feed);
        self.line(&text);
        self.xyz = block.xyz.map(Some);
        self.aim = block.aim;
    }
}

impl Language for Klartext {
    fn step(&mut self, step: &Step, lose: &mut dyn FnMut(&str)) {
        match *step {
            Step::Leave => {
                self.release();
                self.line("L Z+0 R0 FMAX M91");
                self.xyz = [None; 3];
            }
            Step::Tool { number, changes } => {
                if changes {
                    self.release();
                    self.xyz = [None; 3];
                }
                self.line(&format!("TOOL CALL {number} Z"));
            }
            Step::Event(event) => self.event(event, lose),
            Step::Move(block) => self.go(&block, lose),
        }
    }
}
