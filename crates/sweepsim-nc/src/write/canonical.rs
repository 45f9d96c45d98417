//! One line per move.

use std::io::{Result, Write};

use sweepsim_motion::{TipArc, TipCourse};

use crate::model::event::{Coolant, EventKind, Spindle};
use crate::model::program::{FeedMode, Program, ProgramPose};
use crate::text::numbers::shortest;

fn words(point: [f64; 3]) -> String {
    point.map(shortest).join(" ")
}

/// Writes what a program does, one line per move or event: what happens, where to, and the lines that say so, the innermost call last.
///
/// ```
/// use sweepsim_nc::{ReadOptions, gcode, write};
/// let program = gcode::read("G21\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F200\n", &ReadOptions::default())?;
/// let mut text = Vec::new();
/// write::canonical(&program, &mut text)?;
/// let text = String::from_utf8(text)?;
/// assert!(text.ends_with("start (0 0 5) axis (0 0 1)  # line 3\nfeed 200 (0 0 -1) axis (0 0 1)  # line 4\n"), "{text}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Those of the writer.
pub fn canonical(program: &Program, writer: &mut impl Write) -> Result<()> {
    if let Some(title) = &program.title {
        writeln!(writer, "# {}", title.replace(['\n', '\r'], " "))?;
    }
    let mut events = program.events.iter().peekable();
    let lines = |file: usize, line: usize, call: Option<u32>| {
        let mut lines: Vec<String> = program
            .calls_of(call)
            .map(|call| place(program, call.file, call.line))
            .collect();
        lines.reverse();
        lines.push(place(program, file, line));
        lines.join(" > ")
    };
    for (index, pose) in program.poses.iter().enumerate() {
        while let Some(event) = events.next_if(|event| event.pose <= index) {
            let at = lines(event.file, event.line, event.call);
            writeln!(writer, "{}  # {at}", of_event(&event.kind))?;
        }
        writeln!(
            writer,
            "{}  # {}",
            of_pose(pose, program.units.in_mm()),
            lines(pose.file, pose.line, pose.call)
        )?;
    }
    for event in events {
        let at = lines(event.file, event.line, event.call);
        writeln!(writer, "{}  # {at}", of_event(&event.kind))?;
    }
    Ok(())
}

fn place(program: &Program, file: usize, line: usize) -> String {
    // The main program needs no name.
    match program.files.get(file).and_then(|path| path.file_name()) {
        Some(name) if file > 0 => format!("{} line {line}", name.to_string_lossy()),
        _ => format!("line {line}"),
    }
}

/// Lengths are in millimetres, those of feeds too.
fn of_pose(pose: &ProgramPose, unit: f64) -> String {
    let kind = match (pose.joined, pose.rapid, pose.feed) {
        (false, ..) => "start".to_owned(),
        (true, true, _) => "rapid".to_owned(),
        (true, false, None) => "feed".to_owned(),
        (true, false, Some(feed)) => {
            let (feed, per) = match pose.feed_mode {
                FeedMode::PerMinute => (feed * unit, ""),
                FeedMode::PerRevolution => (feed * unit, "/rev"),
                FeedMode::InverseTime => (feed, " inverse"),
            };
            format!("feed {}{per}", shortest(feed))
        }
    };
    let about = |arc: &TipArc| {
        format!(
            " about ({}) normal ({}) by {} deg",
            words(arc.centre()),
            words(arc.normal()),
            shortest(arc.angle().to_degrees())
        )
    };
    let arc = match pose.way().course {
        TipCourse::Arc(arc) if pose.joined => about(&arc),
        TipCourse::Carried(turns) if pose.joined => {
            let turns: String = turns.turns().map(about).collect();
            format!(" carried{turns}")
        }
        _ => String::new(),
    };
    format!(
        "{kind} ({}) axis ({}){arc}",
        words(pose.pose.tip()),
        words(pose.pose.axis())
    )
}

fn of_event(kind: &EventKind) -> String {
    let speed = |rpm: &Option<f64>| rpm.map_or_else(String::new, |rpm| format!(" {}", shortest(rpm)));
    match kind {
        EventKind::ToolChange(number) => format!("tool {number}"),
        EventKind::Spindle(Spindle::Stopped) => "spindle off".to_owned(),
        EventKind::Spindle(Spindle::Clockwise { rpm }) => format!("spindle clockwise{}", speed(rpm)),
        EventKind::Spindle(Spindle::CounterClockwise { rpm }) => format!("spindle counter-clockwise{}", speed(rpm)),
        EventKind::Coolant(Coolant::Off) => "coolant off".to_owned(),
        EventKind::Coolant(Coolant::Mist) => "coolant mist".to_owned(),
        EventKind::Coolant(Coolant::Flood) => "coolant flood".to_owned(),
        EventKind::Coolant(Coolant::Through) => "coolant through the spindle".to_owned(),
        EventKind::Coolant(Coolant::ThroughOff) => "coolant through the spindle off".to_owned(),
        EventKind::Dwell { seconds } => format!("dwell {} s", shortest(*seconds)),
        EventKind::Stop => "stop".to_owned(),
        EventKind::OptionalStop => "optional stop".to_owned(),
        EventKind::Message(text) => format!("message {text:?}"),
    }
}
