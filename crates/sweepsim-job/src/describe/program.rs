//! Programs and tool libraries in words.

use super::{Description, described_tool};
use crate::base::words::{clock, counted, measure, point};
use sweepsim_nc::tools::ToolLibrary;
use sweepsim_nc::{
    Controller, EventKind, Format, NoteKind, Program, ProgramPose, RAPID_SPEED, StockDescription, ToolUsage, Units,
};

/// The most directions of the tool, stops or messages that are listed.
const MOST_LISTED: usize = 6;

/// A program: what moves where, with which tools, for how long, and what was ignored.
pub(crate) fn program(text: &mut Description, program: &Program) {
    text.line("program", &language(program));
    if let Some(title) = program.title.as_deref().filter(|title| !title.is_empty()) {
        text.line("title", title);
    }
    let usage = program.usage();
    let sum = |count: fn(&ToolUsage) -> usize| usage.iter().map(count).sum::<usize>() as u64;
    let arcs = match sum(|tool| tool.arcs) {
        0 => String::new(),
        arcs => format!(" ({})", counted(arcs, "arc")),
    };
    text.line(
        "moves",
        &format!(
            "{}{arcs} and {}, in {}",
            counted(sum(|tool| tool.feed_moves), "feed move"),
            counted(sum(|tool| tool.rapid_moves), "rapid"),
            counted(pieces(program) as u64, "piece")
        ),
    );
    text.labelled_bounds("extent", program.extent().into_iter().flatten());
    let cuts = usage.iter().filter_map(|tool| tool.extent).flatten();
    text.labelled_bounds("cutting", cuts);
    text.line("tool axis", &directions(program));
    times(text, program, &usage);
    for tool in &usage {
        let number = tool
            .tool
            .map_or_else(|| "without a number".to_owned(), |number| number.to_string());
        let description = tool.tool.and_then(|number| program.tools.get(&number));
        let described = description.map_or_else(|| "not described".to_owned(), described_tool);
        text.line("tool", &format!("{number}: {described}"));
        text.line("", &used(tool));
        if let Some(words) = conditions(tool) {
            text.line("", &words);
        }
    }
    if let Some(stock) = &program.stock {
        text.line("stock", &described_stock(stock));
    }
    happenings(text, program);
    reading(text, program);
}

/// What was understood, assumed and ignored: the worst first.
fn reading(text: &mut Description, program: &Program) {
    let file = |index: usize| match program.files.get(index) {
        Some(file) if index > 0 => format!("{}, ", file.display()),
        _ => String::new(),
    };
    let assumed = |text: &mut Description, worst: bool| {
        for assumption in program
            .assumptions
            .iter()
            .filter(|assumption| assumption.changes_verdict == worst)
        {
            let (what, taken, times) = (&assumption.what, &assumption.taken, assumption.times());
            let place = format!("{}line {}", file(assumption.file), assumption.line);
            text.line("assumed", &format!("{place}: {what}: {taken}{times}"));
            text.line("", &format!("to settle it: {}", assumption.settle));
        }
    };
    let notes = |text: &mut Description, kind: NoteKind, label: &str| {
        for note in program.notes.iter().filter(|note| note.kind() == kind) {
            text.line(label, &note.to_string());
        }
    };
    assumed(text, true);
    notes(text, NoteKind::Warning, "warning");
    assumed(text, false);
    notes(text, NoteKind::Read, "note");
    notes(text, NoteKind::Ignored, "ignored");
    if program.blocks > 0 {
        let all = counted(program.blocks as u64, "block");
        let odd = match program.blocks - program.understood {
            0 => "all".to_owned(),
            odd => format!("all but {odd}"),
        };
        text.line("understood", &format!("{odd} of {all} that were executed"));
    }
}

/// The number of stretches of joined poses.
fn pieces(program: &Program) -> usize {
    let begins = program.poses.in_order().enumerate();
    begins.filter(|(index, pose)| *index == 0 || !pose.joined).count()
}

/// The format, the control and the units.
fn language(program: &Program) -> String {
    let format = match program.format {
        Some(Format::Apt) => "APT or CLSF",
        Some(Format::Table) => "table of poses",
        Some(Format::Rows) => "rows of numbers",
        _ => match program.controller {
            Some(Controller::Siemens) => "Siemens 840D",
            Some(Controller::Heidenhain) => "Heidenhain Klartext",
            Some(Controller::LinuxCnc) => "G-code of LinuxCNC",
            Some(Controller::Fanuc) => "G-code of Fanuc",
            Some(Controller::Haas) => "G-code of Haas",
            Some(Controller::Grbl) => "G-code of Grbl",
            Some(Controller::Okuma) => "G-code of Okuma",
            _ => "G-code, of any control",
        },
    };
    let units = match program.units {
        Units::Inch => "inches",
        _ => "millimetres",
    };
    format!("{format}, in {units}")
}

/// Where the tool points while it cuts.
fn directions(program: &Program) -> String {
    let axis = |pose: &ProgramPose| pose.pose.axis();
    let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
    let mut held: Vec<[f64; 3]> = Vec::new();
    let mut turns = false;
    let mut last: Option<[f64; 3]> = None;
    for pose in program.poses.in_order() {
        let own = axis(&pose);
        let before = last.replace(own);
        let Some(before) = before.filter(|_| pose.joined && !pose.rapid) else {
            continue;
        };
        turns |= !near(before, own);
        if held.len() <= MOST_LISTED && !held.iter().any(|known| near(*known, own)) {
            held.push(own);
        }
    }
    let tilt = program
        .poses
        .in_order()
        .map(|pose| axis(&pose)[2].clamp(-1.0, 1.0).acos().to_degrees())
        .fold(0.0, f64::max);
    let words = |axis: &[f64; 3]| match axis {
        [0.0, 0.0, 1.0] => "z".to_owned(),
        axis => point(*axis),
    };
    match held.as_slice() {
        _ if turns => format!("turns while cutting, up to {} degrees from z", measure(tilt)),
        [] if tilt > 0.0 => format!("up to {} degrees from z", measure(tilt)),
        [] => "z".to_owned(),
        [one] => format!("{} all along", words(one)),
        held if held.len() <= MOST_LISTED => format!(
            "{} while cutting: {}",
            counted(held.len() as u64, "direction"),
            held.iter().map(words).collect::<Vec<_>>().join(", ")
        ),
        _ => format!(
            "many directions, held while cutting, up to {} degrees from z",
            measure(tilt)
        ),
    }
}

/// Durations: of rapids, where no machine tells its speed, with that of [`RAPID_SPEED`].
fn times(text: &mut Description, program: &Program, usage: &[ToolUsage]) {
    let cutting: f64 = usage.iter().map(|tool| tool.seconds).sum();
    let rapids: f64 = usage.iter().map(|tool| tool.rapid_seconds).sum();
    if cutting + rapids == 0.0 {
        return;
    }
    let mut words = format!("{}: {} of cutting", clock(cutting + rapids), clock(cutting));
    if rapids > 0.0 {
        words += &format!(", {} of rapids", clock(rapids));
        if program.machine.kinematics.is_none() {
            words += &format!(" at {} m/min", RAPID_SPEED / 1000.0);
        }
    }
    let untimed: usize = usage.iter().map(|tool| tool.untimed).sum();
    if untimed > 0 {
        words += &format!("; {} of unknown feed are left out", counted(untimed as u64, "move"));
    }
    text.line("time", &words);
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

/// Its depth, spindle and feeds.
fn conditions(tool: &ToolUsage) -> Option<String> {
    let range = |[low, high]: [f64; 2]| {
        if low == high {
            measure(low)
        } else {
            format!("{} … {}", measure(low), measure(high))
        }
    };
    let [low, high] = tool.extent?;
    let mut words = vec![format!("z {} mm", range([low[2], high[2]]))];
    words.extend(tool.speeds.map(|speeds| format!("{} rpm", range(speeds))));
    words.extend(tool.feeds.map(|feeds| format!("{} mm/min", range(feeds))));
    Some(words.join(", "))
}

/// Stops, at which a part may be clamped anew, and texts for the operator.
fn happenings(text: &mut Description, program: &Program) {
    let of = |wanted: fn(&EventKind) -> bool| program.events.iter().filter(move |event| wanted(&event.kind));
    let stops: Vec<String> = of(|kind| matches!(kind, EventKind::Stop | EventKind::OptionalStop))
        .map(|event| event.line.to_string())
        .collect();
    if !stops.is_empty() {
        let mut lines = stops[..stops.len().min(MOST_LISTED)].join(", ");
        if stops.len() > MOST_LISTED {
            lines += " …";
        }
        let noun = if stops.len() == 1 { "line" } else { "lines" };
        text.line("stops", &format!("{}: {noun} {lines}", stops.len()));
    }
    let mut messages = 0;
    for event in of(|kind| matches!(kind, EventKind::Message(_))) {
        messages += 1;
        if let (EventKind::Message(said), true) = (&event.kind, messages <= MOST_LISTED) {
            text.line("message", &format!("line {}: {said:?}", event.line));
        }
    }
    if messages > MOST_LISTED {
        text.line("", &format!("and {} more", messages - MOST_LISTED));
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
pub(crate) fn library(text: &mut Description, library: &ToolLibrary) {
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
