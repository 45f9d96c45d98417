//! The paths of programs.

use std::path::{Path as FilePath, PathBuf};
use std::sync::Arc;

use sweepsim_dexel::Frame;
use sweepsim_motion::{Law, Path, PathError};
use sweepsim_nc::{Call, Event, EventKind, Note, Program, ProgramPose, Spindle, check};

use super::course::{Course, Step, at_steps, course, other_courses};
use super::{JobPath, Origin};
use crate::error::{FormatError, Problem, TextPosition};
use crate::jobs::tools::ToolBox;

/// The paths of a program. The tool axis turns according to `law` where the program does not specify how. `tool` is the job's tool for the whole
/// program; without it, the program's tool numbers are used.
pub(crate) fn of_program(
    mut program: Program,
    file: &FilePath,
    shown: &str,
    tool: Option<u32>,
    law: Law,
    tools: &mut ToolBox,
) -> Result<Vec<JobPath>, FormatError> {
    let at = |problem: Problem, line: usize| {
        let text = std::fs::read(file).map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        let whole = text.ok().and_then(|text| text.lines().nth(line - 1).map(str::to_owned));
        let whole = whole.unwrap_or_default();
        let place = TextPosition::in_line(line, &whole, 1, whole.chars().count());
        FormatError::new(problem, Some(place)).in_file(file)
    };
    if let Some(tool) = tool {
        let asked = program.poses.iter().find_map(|pose| Some((pose.tool?, pose.line)));
        let changes = second_tool(&program).map(|other| (other.line, "the program changes tools".to_owned()));
        let differs = asked.filter(|(number, _)| *number != tool);
        let differs = differs.map(|(number, line)| (line, format!("the program asks for tool {number}")));
        if let Some((line, fact)) = changes.or(differs) {
            let note = format!("{fact}; the job's tool {tool} is used throughout");
            program.notes.push(Note::new(line, note));
        }
    }
    let mut notes = std::mem::take(&mut program.notes);
    let described = std::mem::take(&mut program.tools);
    let files: Arc<[PathBuf]> = std::mem::take(&mut program.files).into();
    let calls: Arc<[Call]> = std::mem::take(&mut program.calls).into();
    let origin = |pose: &ProgramPose| Origin {
        file: pose.file,
        line: pose.line,
        call: pose.call,
    };
    let stopped = stopped_spindle(&program);
    let times = program.times();
    let kinematics = program.machine.kinematics.as_deref();
    let beyond = kinematics.map_or_else(Vec::new, |kinematics| check(&program, kinematics));
    let has_feed = program.poses.iter().any(|pose| pose.feed.is_some());
    let mut paths = Vec::new();
    let mut begin = 0;
    for section in program.sections() {
        let first = &section[0];
        let number = match (tool, first.tool) {
            (Some(tool), _) | (None, Some(tool)) => tool,
            (None, None) => {
                let problem = Problem::syntax(
                    "no tool is named for this path: expected `tool:` in the job, or a tool in the file",
                );
                return Err(at(problem, first.line));
            }
        };
        tools
            .need(number, Some((&described, shown)))
            .map_err(|problem| at(problem, first.line))?;
        let Course { poses, steps, ways } = course(&program, begin, section);
        begin += section.len();
        // Tables do not specify how the tool turns.
        let path = if ways.is_empty() {
            Path::with_law(poses, law)
        } else {
            Path::with_moves(poses, ways)
        };
        let path = path.map_err(|error| {
            let line = match error {
                PathError::OppositeAxes { index } | PathError::Rotary { index } => steps
                    .get(index + 1)
                    .map_or(first.line, |step| program.poses[step.of].line),
                _ => first.line,
            };
            at(Problem::Path(error), line)
        })?;
        let end = |step: &Step| &program.poses[step.of];
        let moved = || steps[1..].iter();
        paths.push(JobPath {
            tool: number,
            setup: 0,
            frame: Frame::WORLD,
            path,
            source: shown.to_owned(),
            rapid: moved().map(|step| end(step).rapid).collect(),
            other_courses: other_courses(&program, &steps),
            seconds: moved()
                .map(|step| Some(times[step.of].seconds? * (step.share[1] - step.share[0])))
                .collect(),
            dwell_seconds: times[steps[0].of..begin].iter().map(|time| time.rest).sum(),
            assumed_rapids: moved().any(|step| times[step.of].assumed),
            beyond: at_steps(&beyond, &steps),
            spindle_stopped: moved().filter_map(|step| stopped.get(step.of).copied()).collect(),
            no_feed: if has_feed {
                let missing = |pose: &ProgramPose| !pose.rapid && pose.feed.is_none();
                moved().map(|step| missing(end(step))).collect()
            } else {
                Vec::new()
            },
            origins: steps.iter().map(|step| origin(end(step))).collect(),
            files: files.clone(),
            calls: calls.clone(),
            notes: std::mem::take(&mut notes),
        });
    }
    Ok(paths)
}

/// Whether the spindle stands still at each pose; empty if it never turns, so that the program does not control it.
fn stopped_spindle(program: &Program) -> Vec<bool> {
    let spindle = |event: &Event| match event.kind {
        EventKind::Spindle(spindle) => Some((event.pose, spindle == Spindle::Stopped)),
        _ => None,
    };
    let switched: Vec<(usize, bool)> = program.events.iter().filter_map(spindle).collect();
    if switched.iter().all(|(_, stopped)| *stopped) {
        return Vec::new();
    }
    let mut next = switched.into_iter().peekable();
    let mut stopped = true;
    let mut all = Vec::with_capacity(program.poses.len());
    for pose in 0..program.poses.len() {
        while let Some((_, now)) = next.next_if(|(at, _)| *at <= pose) {
            stopped = now;
        }
        all.push(stopped);
    }
    all
}

fn second_tool(program: &Program) -> Option<&ProgramPose> {
    let first = program.poses.iter().find_map(|pose| pose.tool)?;
    program
        .poses
        .iter()
        .find(|pose| pose.tool.is_some_and(|tool| tool != first))
}
