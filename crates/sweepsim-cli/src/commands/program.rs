//! Programs and tool libraries in words.

use crate::session::words::{counted, measure, seconds};
use crate::session::{Lines, described_tool};
use sweepsim_nc::tools::ToolLibrary;
use sweepsim_nc::{EventKind, Program, StockDescription, ToolUsage, Units};

/// A program: what moves where, with which tools, for how long, and what was ignored.
pub(crate) fn program(text: &mut Lines, program: &Program) {
    if let Some(title) = program.title.as_deref().filter(|title| !title.is_empty()) {
        text.line("title", title);
    }
    let sections = program.sections().count();
    let moves: usize = program.sections().map(|section| section.len() - 1).sum();
    let rapid = program.poses.iter().filter(|pose| pose.joined && pose.rapid).count();
    text.line(
        "path",
        &format!(
            "{} in {}, {}",
            counted(moves as u64, "move"),
            counted(sections as u64, "piece"),
            counted(rapid as u64, "rapid")
        ),
    );
    let units = if program.units == Units::Inch {
        "inches"
    } else {
        "millimetres"
    };
    text.line("units", units);
    text.bounds(program.poses.iter().map(|pose| pose.pose.tip()));
    let feeds = program.poses.iter().filter(|pose| !pose.rapid);
    if program.poses.iter().any(|pose| pose.rapid) {
        text.labelled_bounds("cutting", feeds.map(|pose| pose.pose.tip()));
    }
    let tilt = program
        .poses
        .iter()
        .map(|pose| pose.pose.axis()[2].clamp(-1.0, 1.0).acos().to_degrees())
        .fold(0.0, f64::max);
    text.line("axis", &format!("up to {} degrees from z", measure(tilt)));
    let usage = program.usage();
    for tool in &usage {
        let number = tool
            .tool
            .map_or_else(|| "without a number".to_owned(), |number| number.to_string());
        let description = tool.tool.and_then(|number| program.tools.get(&number));
        let described = description.map_or_else(|| "not described".to_owned(), described_tool);
        text.line("tool", &format!("{number}: {described}"));
        text.line("", &used(tool));
    }
    let total: f64 = usage.iter().map(|tool| tool.seconds).sum();
    if total > 0.0 {
        text.line(
            "time",
            &format!("{} of cutting, without acceleration and rapids", clock(total)),
        );
    }
    let messages = program
        .events
        .iter()
        .filter(|event| matches!(event.kind, EventKind::Message(_)))
        .count();
    let stops = program
        .events
        .iter()
        .filter(|event| matches!(event.kind, EventKind::Stop | EventKind::OptionalStop))
        .count();
    for (count, what) in [(messages, "message"), (stops, "stop")] {
        if count > 0 {
            text.line(&format!("{what}s"), &counted(count as u64, what));
        }
    }
    if let Some(stock) = &program.stock {
        text.line("stock", &described_stock(stock));
    }
    for note in &program.notes {
        text.line("note", &note.to_string());
    }
}

/// What a tool does.
fn used(tool: &ToolUsage) -> String {
    let mut text = format!(
        "{}, {} mm",
        counted(tool.feed_moves as u64, "feed move"),
        measure(tool.feed_length)
    );
    if tool.seconds > 0.0 {
        text.push_str(&format!(", {}", clock(tool.seconds)));
    }
    if tool.untimed > 0 {
        text.push_str(&format!(
            " ({} without a known feed)",
            counted(tool.untimed as u64, "move")
        ));
    }
    if tool.rapid_moves > 0 {
        let rapids = counted(tool.rapid_moves as u64, "rapid");
        text.push_str(&format!("; {rapids}, {} mm", measure(tool.rapid_length)));
    }
    text
}

/// A duration on a machine.
pub(super) fn clock(duration: f64) -> String {
    if duration < 60.0 {
        return seconds(duration);
    }
    let whole = duration.round() as u64;
    let (hours, minutes, rest) = (whole / 3600, whole / 60 % 60, whole % 60);
    if hours > 0 {
        format!("{hours} h {minutes} min")
    } else {
        format!("{minutes} min {rest} s")
    }
}

fn described_stock(stock: &StockDescription) -> String {
    let corner = |point: [f64; 3]| format!("({})", point.map(measure).join(", "));
    match stock {
        StockDescription::Block { min, max } => format!("block {} … {} mm", corner(*min), corner(*max)),
        StockDescription::Size(size) => format!("block of {} mm", size.map(measure).join(" × ")),
        _ => "of another kind".to_owned(),
    }
}

/// A tool library.
pub(crate) fn library(text: &mut Lines, library: &ToolLibrary) {
    text.line("tools", &counted(library.tools.len() as u64, "tool"));
    for (number, tool) in &library.tools {
        text.line("tool", &format!("{number}: {}", described_tool(tool)));
    }
    if let Some(stock) = &library.stock {
        text.line("stock", &described_stock(stock));
    }
    for name in &library.programs {
        text.line("program", name);
    }
    for note in &library.notes {
        text.line("note", &note.message);
    }
}

#[cfg(test)]
mod tests {
    use super::clock;

    #[test]
    fn durations() {
        assert_eq!([5.25, 75.4, 3725.0].map(clock), ["5.2 s", "1 min 15 s", "1 h 2 min"]);
    }
}
