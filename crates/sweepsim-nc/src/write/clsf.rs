//! CLSF: the statements that [`apt::read`](crate::apt::read) reads.

use std::f64::consts::TAU;
use std::io::{Result, Write};

use sweepsim_motion::{Move, TipArc, TipCourse, Turning};

use crate::model::event::{Coolant, EventKind, Spindle};
use crate::model::program::{FeedMode, Program, ProgramPose};
use crate::text::numbers::shortest;
use crate::write::chords::chords;

/// Ends of an arc nearer than this, in mm, look like those of a full turn.
const NEAR: f64 = 1e-2;
/// How far chords may be from what a table carries, in mm.
const CHORD: f64 = 1e-3;

fn words(point: [f64; 3]) -> String {
    point.map(shortest).join(",")
}

/// Writes a program as CLSF in millimetres, with its tools where seven parameters can describe them. Returns what it could not say.
///
/// ```
/// use sweepsim_nc::{ReadOptions, apt, gcode, write};
/// let program = gcode::read("G21\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F200\n", &ReadOptions::default())?;
/// let mut text = Vec::new();
/// let lost = write::clsf(&program, &mut text)?;
/// assert_eq!(lost, ["tool 1 is not described"]);
/// let again = apt::read(std::str::from_utf8(&text)?, &ReadOptions::default())?;
/// assert_eq!(again.poses[1].pose, program.poses[1].pose);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Those of the writer.
pub fn clsf(program: &Program, writer: &mut impl Write) -> Result<Vec<String>> {
    let mut output = Output {
        program,
        writer,
        lost: Vec::new(),
        feed: None,
        unit: program.units.in_mm(),
    };
    if let Some(title) = &program.title {
        writeln!(output.writer, "PARTNO {}", title.replace(['\n', '\r'], " "))?;
    }
    writeln!(output.writer, "UNITS/MM\nMULTAX/ON")?;
    let mut events = program.events.iter().peekable();
    let mut last: Option<&ProgramPose> = None;
    for (index, pose) in program.poses.iter().enumerate() {
        while let Some(event) = events.next_if(|event| event.pose <= index) {
            output.event(&event.kind)?;
        }
        output.pose(pose, last)?;
        last = Some(pose);
    }
    for event in events {
        output.event(&event.kind)?;
    }
    writeln!(output.writer, "FINI")?;
    Ok(output.lost)
}

struct Output<'a, W> {
    program: &'a Program,
    writer: &'a mut W,
    lost: Vec<String>,
    feed: Option<(f64, FeedMode)>,
    /// Millimetres per unit of feeds.
    unit: f64,
}

impl<W: Write> Output<'_, W> {
    fn lose(&mut self, what: String) {
        if !self.lost.contains(&what) {
            self.lost.push(what);
        }
    }

    fn pose(&mut self, pose: &ProgramPose, last: Option<&ProgramPose>) -> Result<()> {
        if !pose.joined {
            match pose.tool {
                Some(number) if last.is_none_or(|last| last.tool != pose.tool) => self.tool(number)?,
                _ if last.is_some() => writeln!(self.writer, "GOHOME")?,
                _ => {}
            }
        }
        let course = pose.way().course;
        if let (true, Some(last), TipCourse::Carried(_)) = (pose.joined, last, course) {
            self.lose(format!("moves while the table turns: chords within {CHORD} mm"));
            let all = chords(&course, &last.pose, &pose.pose, CHORD);
            let mut piece = pose.clone();
            piece.set_way(Move::default());
            if pose.feed_mode == FeedMode::InverseTime {
                piece.feed = pose.feed.map(|feed| feed * all.len() as f64);
            }
            for end in all {
                piece.pose = end;
                self.pose(&piece, Some(last))?;
            }
            return Ok(());
        }
        if pose.rapid {
            writeln!(self.writer, "RAPID")?;
        } else if let Some(feed) = pose.feed
            && self.feed != Some((feed, pose.feed_mode))
        {
            self.feed = Some((feed, pose.feed_mode));
            match pose.feed_mode {
                FeedMode::PerMinute => writeln!(self.writer, "FEDRAT/{},MMPM", shortest(feed * self.unit))?,
                FeedMode::PerRevolution => writeln!(self.writer, "FEDRAT/{},MMPR", shortest(feed * self.unit))?,
                FeedMode::InverseTime => writeln!(self.writer, "FEDRAT/INVERS,{}", shortest(feed))?,
            }
        }
        if !pose.rapid && pose.feed.is_none() && self.feed.is_some() {
            self.lose("moves without a feed after others with one".to_owned());
        }
        if let (true, Some(last), TipCourse::Arc(arc)) = (pose.joined, last, course) {
            self.arc(&arc, last, pose)?;
        } else if pose.joined && !matches!(pose.way().turning, Turning::Slerp) && course == TipCourse::Straight {
            self.lose("how the tool axis turns between two points".to_owned());
        }
        let (tip, axis) = (pose.pose.tip(), pose.pose.axis());
        writeln!(self.writer, "GOTO/{},{}", words(tip), words(axis))
    }

    /// The statement before the end of an arc.
    fn arc(&mut self, arc: &TipArc, from: &ProgramPose, to: &ProgramPose) -> Result<()> {
        let sign = arc.angle().signum();
        let normal = arc.normal().map(|c| c * sign);
        let angle = arc.angle().abs();
        let (a, b) = (from.pose.tip(), to.pose.tip());
        let near = (0..3).all(|k| (a[k] - b[k]).abs() < NEAR);
        let centre = words(arc.centre());
        if angle < TAU * (1.0 - 1e-9) && !near {
            writeln!(self.writer, "CIRCLE/{centre},{}", words(normal))
        } else {
            let radius = {
                let r = [0, 1, 2].map(|k| a[k] - arc.centre()[k]);
                let along: f64 = r.iter().zip(normal).map(|(r, n)| r * n).sum();
                let across = [0, 1, 2].map(|k| r[k] - along * normal[k]);
                across[0].hypot(across[1]).hypot(across[2])
            };
            let (normal, angle) = (words(normal), shortest(angle.to_degrees()));
            writeln!(
                self.writer,
                "MOVARC/{centre},{normal},{},ANGLE,{angle}",
                shortest(radius)
            )
        }
    }

    fn tool(&mut self, number: u32) -> Result<()> {
        match self.program.tools.get(&number) {
            None => self.lose(format!("tool {number} is not described")),
            Some(tool) => match tool.seven_parameters() {
                Some([d, r, e, f, a, b, h]) => {
                    if let Some(name) = tool.name.as_deref().filter(|name| !name.is_empty()) {
                        writeln!(self.writer, "INSERT/{}", name.replace(['\n', '\r'], " "))?;
                    }
                    let list = [d, r, e, f, a, b, h].map(shortest).join(",");
                    writeln!(self.writer, "CUTTER/{list}")?;
                }
                None => self.lose(format!("the shape of tool {number}")),
            },
        }
        writeln!(self.writer, "LOAD/TOOL,{number}")
    }

    fn event(&mut self, kind: &EventKind) -> Result<()> {
        let rpm = |rpm: &Option<f64>, sense: &str| match rpm {
            Some(rpm) => format!("SPINDL/{},RPM,{sense}", shortest(*rpm)),
            None => format!("SPINDL/ON,{sense}"),
        };
        let text = match kind {
            // Written with the first move of the tool.
            EventKind::ToolChange(_) => return Ok(()),
            EventKind::Spindle(Spindle::Stopped) => "SPINDL/OFF".to_owned(),
            EventKind::Spindle(Spindle::Clockwise { rpm: speed }) => rpm(speed, "CLW"),
            EventKind::Spindle(Spindle::CounterClockwise { rpm: speed }) => rpm(speed, "CCLW"),
            EventKind::Coolant(coolant) => match coolant {
                Coolant::Off | Coolant::ThroughOff => "COOLNT/OFF",
                Coolant::Mist => "COOLNT/MIST",
                Coolant::Flood => "COOLNT/FLOOD",
                Coolant::Through => "COOLNT/THRU",
            }
            .to_owned(),
            EventKind::Dwell { seconds } => format!("DELAY/{}", shortest(*seconds)),
            EventKind::Stop => "STOP".to_owned(),
            EventKind::OptionalStop => "OPSTOP".to_owned(),
            EventKind::Message(text) => format!("PPRINT {}", text.replace(['\n', '\r'], " ")),
        };
        writeln!(self.writer, "{text}")
    }
}
