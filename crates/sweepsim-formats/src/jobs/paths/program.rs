//! The paths of programs.

use std::path::{Path as FilePath, PathBuf};
use std::sync::Arc;

use sweepsim_motion::{Law, PackedRows};
use sweepsim_nc::{Call, Event, EventKind, Kinematics, MoveTime, Note, Program, ProgramPose, Spindle, check};

use super::section::{Known, Section, Whole, with_notes};
use super::{Flags, JobPath, machine};
use crate::error::{FormatError, Problem, TextPosition};
use crate::jobs::provided::Provided;
use crate::jobs::tools::ToolBox;

/// Where a program comes from: its file, and what the job calls it.
#[derive(Clone, Copy)]
pub(crate) struct ProgramOrigin<'a> {
    pub file: &'a FilePath,
    pub shown: &'a str,
    pub provided: &'a Provided,
}

/// The paths of a program. The tool axis turns according to `law` where the program does not specify how. `tool` is the
/// job's tool for the whole program; without it, the program's tool numbers are used.
pub(crate) fn of_program(
    mut program: Program,
    origin: ProgramOrigin,
    tool: Option<u32>,
    law: Law,
    tools: &mut ToolBox,
) -> Result<Vec<JobPath>, FormatError> {
    let ProgramOrigin { file, shown, provided } = origin;
    let at = |problem: Problem, line: usize| {
        let whole = provided.line(file, line).unwrap_or_default();
        let place = TextPosition::in_line(line, &whole, 1, whole.chars().count());
        FormatError::new(problem, Some(place)).in_file(file)
    };
    if let Some(tool) = tool {
        let asked = program.poses.in_order().find_map(|pose| Some((pose.tool?, pose.line)));
        let changes = second_tool(&program).map(|other| (other.line, "the program changes tools".to_owned()));
        let differs = asked.filter(|(number, _)| *number != tool);
        let differs = differs.map(|(number, line)| (line, format!("the program asks for tool {number}")));
        if let Some((line, fact)) = changes.or(differs) {
            let note = format!("{fact}; the job's tool {tool} is used throughout");
            program.notes.push(Note::new(line, note));
        }
    }
    let notes = std::mem::take(&mut program.notes);
    let described = std::mem::take(&mut program.tools);
    let files: Arc<[PathBuf]> = std::mem::take(&mut program.files).into();
    let calls: Arc<[Call]> = std::mem::take(&mut program.calls).into();
    let has_spindle = turns_spindle(&program);
    let on = program.machine.kinematics.clone();
    let kinematics = on.as_deref();
    let bodies = kinematics.map_or_else(
        || Ok(Arc::from([])),
        |kinematics| machine::bodies(kinematics, provided.within.as_deref()),
    )?;
    let follows = !bodies.is_empty() || kinematics.is_some_and(has_limits);
    let beyond = kinematics.map_or_else(Vec::new, |kinematics| check(&program, kinematics));
    let mut times = kinematics.map(|_| times(&program));
    let rest_at_end = program.rest_at_end();
    // Poses and positions make room for the paths as these grow.
    let (poses, positions) = (
        std::mem::take(&mut program.poses),
        std::mem::take(&mut program.positions),
    );
    let mut positions = (positions.len() == poses.len()).then(|| positions.into_iter());
    let mut poses = poses.into_iter().enumerate().peekable();
    let (mut clock, mut spindle) = (program.clock(), Spindles::of(&program));
    let mut faults = beyond.iter().map(|finding| finding.pose).peekable();
    let mut has_feed = false;
    let mut paths = Vec::new();
    while let Some((_, first)) = poses.peek() {
        let line = first.line;
        let number = match (tool, first.tool) {
            (Some(tool), _) | (None, Some(tool)) => tool,
            (None, None) => {
                let problem = Problem::syntax(
                    "no tool is named for this path: expected `tool:` in the job, or a tool in the file",
                );
                return Err(at(problem, line));
            }
        };
        tools
            .need(number, Some((&described, shown)))
            .map_err(|problem| at(problem, line))?;
        let mut section = Section::default();
        while let Some((of, pose)) = poses.next() {
            has_feed |= pose.feed.is_some();
            let time = times.as_mut().map_or_else(|| Some(clock.next(&pose)), Iterator::next);
            let known = Known {
                of,
                time: time.unwrap_or_default(),
                stopped: spindle.stopped(of),
                position: positions.as_mut().and_then(Iterator::next),
                at_fault: std::iter::from_fn(|| faults.next_if(|pose| *pose <= of)).count() > 0,
            };
            section.add(on.as_ref(), follows, &pose, &known);
            if !poses.peek().is_some_and(|(_, next)| next.joined) {
                break;
            }
        }
        section.settle(on.as_deref());
        let whole = Whole {
            tool: number,
            shown,
            beyond: &beyond,
            has_limits: kinematics.is_some_and(has_limits),
            bodies: bodies.clone(),
            has_spindle,
            files: files.clone(),
            calls: calls.clone(),
        };
        let path = section.finish(&whole, law);
        paths.push(path.map_err(|(error, line)| at(Problem::Path(error), line))?);
    }
    if let Some(last) = paths.last_mut() {
        last.dwell_seconds += rest_at_end;
    }
    if !has_feed {
        paths.iter_mut().for_each(|path| path.no_feed = Flags::default());
    }
    Ok(with_notes(paths, notes))
}

/// Whether any axis of a machine has limits.
fn has_limits(machine: &Kinematics) -> bool {
    let linear = machine.linear().iter().any(|axis| axis.limits.is_some());
    linear || machine.rotary().any(|axis| axis.limits.is_some())
}

/// The times of the moves of a program, packed.
fn times(program: &Program) -> impl Iterator<Item = MoveTime> + use<> {
    let mut rows = PackedRows::<3>::default();
    program.each_time(|time| {
        let assumed = f64::from(u8::from(time.assumed));
        rows.push([time.seconds.unwrap_or(f64::NAN), time.rest, assumed]);
    });
    rows.into_iter().map(|[seconds, rest, assumed]| {
        let mut time = MoveTime::default();
        time.seconds = Some(seconds).filter(|seconds| !seconds.is_nan());
        (time.rest, time.assumed) = (rest, assumed > 0.0);
        time
    })
}

/// Whether the spindle ever turns; otherwise the program does not control it.
fn turns_spindle(program: &Program) -> bool {
    let turns = |event: &Event| matches!(event.kind, EventKind::Spindle(spindle) if spindle != Spindle::Stopped);
    program.events.iter().any(turns)
}

/// Whether the spindle stands still, pose by pose.
struct Spindles<'a> {
    events: std::iter::Peekable<std::slice::Iter<'a, Event>>,
    stopped: bool,
}

impl<'a> Spindles<'a> {
    fn of(program: &'a Program) -> Self {
        Self {
            events: program.events.iter().peekable(),
            stopped: true,
        }
    }

    fn stopped(&mut self, pose: usize) -> bool {
        while let Some(event) = self.events.next_if(|event| event.pose <= pose) {
            if let EventKind::Spindle(spindle) = event.kind {
                self.stopped = spindle == Spindle::Stopped;
            }
        }
        self.stopped
    }
}

fn second_tool(program: &Program) -> Option<ProgramPose> {
    let first = program.poses.in_order().find_map(|pose| pose.tool)?;
    program
        .poses
        .in_order()
        .find(|pose| pose.tool.is_some_and(|tool| tool != first))
}
