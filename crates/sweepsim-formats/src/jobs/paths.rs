//! The paths of a job: poses in the job itself, or a file whose extension determines its format.

use std::path::{Path as FilePath, PathBuf};
use std::sync::Arc;

use sweepsim_motion::{Course, Law, Move, Path, PathError, Pose, PoseError, TipArc, Turning};
use sweepsim_nc::{AxisFinding, Call, Event, EventKind, Note, Program, ProgramPose, Spindle, check};

use super::course::{Step, at_steps, course};
use super::schema;
use super::tool_box::ToolBox;
use crate::error::{FormatError, Problem, TextPosition};

/// A path of a job, with its tool. A file has several of them if its path breaks or its tool changes.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct JobPath {
    /// The number of its tool: a key of [`Job::tools`](crate::Job::tools).
    pub tool: u32,
    /// The poses, in millimetres.
    pub path: Path,
    /// Where it comes from, for display: the name of a file, or its position in the job.
    pub source: String,
    /// Whether each move is a rapid.
    pub rapid: Vec<bool>,
    /// Whether the spindle stands still in each move; empty if the program never mentions the spindle.
    pub spindle_stopped: Vec<bool>,
    /// Whether each move is a feed move before the program's first feed; empty if it never gives one.
    pub no_feed: Vec<bool>,
    /// What the machine cannot do, if one is known: axes beyond their limits, or faster than they can be. The pose is one of this path.
    pub beyond: Vec<AxisFinding>,
    /// How long each move takes, in seconds, as far as that is known; empty for poses in the job itself.
    pub seconds: Vec<Option<f64>>,
    /// How long the tool rests between these moves, in seconds.
    pub dwell_seconds: f64,
    /// Whether the speeds of rapids had to be assumed.
    pub assumed_rapids: bool,
    /// Where each pose comes from; empty for poses in the job itself.
    pub origins: Vec<Origin>,
    /// The files of the program, the main program first.
    pub files: Arc<[PathBuf]>,
    /// The calls of subprograms, loops and cycles of the program, each before those within it.
    pub calls: Arc<[Call]>,
    /// What was ignored or decided while reading the file; given with the first of its paths.
    pub notes: Vec<Note>,
}

/// Where a pose of a program comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Origin {
    /// The file: an index of [`JobPath::files`].
    pub file: usize,
    /// The line, from 1.
    pub line: usize,
    /// The call that made the pose: an index of [`JobPath::calls`].
    pub call: Option<u32>,
}

impl JobPath {
    /// The files and lines that a pose comes from: first its own, then those of the calls that led to it, the innermost first.
    #[must_use]
    pub fn places(&self, pose: usize) -> Vec<(&FilePath, usize)> {
        let file = |index: usize| self.files.get(index).map_or(FilePath::new(""), PathBuf::as_path);
        let Some(origin) = self.origins.get(pose) else {
            return Vec::new();
        };
        let at = |index: Option<u32>| index.and_then(|index| self.calls.get(index as usize));
        let calls = std::iter::successors(at(origin.call), |call| at(call.parent));
        std::iter::once((file(origin.file), origin.line))
            .chain(calls.map(|call| (file(call.file), call.line)))
            .collect()
    }

    /// The number of moves that are rapids.
    #[must_use]
    pub fn rapid_moves(&self) -> usize {
        self.rapid.iter().filter(|rapid| **rapid).count()
    }
}

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
        let first = section[0];
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
        let steps = course(&program, begin, section);
        begin += section.len();
        let poses = steps.iter().map(|step| step.pose).collect();
        let moves: Vec<Move> = steps[1..].iter().map(|step| step.way).collect();
        // Tables do not specify how the tool turns.
        let path = if moves.iter().all(|way| *way == Move::default()) {
            Path::with_law(poses, law)
        } else {
            Path::with_moves(poses, moves)
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
            path,
            source: shown.to_owned(),
            rapid: moved().map(|step| end(step).rapid).collect(),
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

/// A problem of poses in the job, with the pose and the part of it (0: tip, 1: axis, 2: side).
pub(crate) type PoseFault = (Problem, Option<(usize, usize)>);

fn pose(raw: &schema::Pose, unit: f64) -> Result<Pose, (Problem, usize)> {
    let schema::Pose(tip, axis, side) = *raw;
    let placed = tip.map(|c| c * unit);
    let made = match side {
        None => Pose::new(placed, axis),
        Some(side) => Pose::with_side(placed, axis, side),
    };
    made.map_err(|error| {
        let part = match error {
            PoseError::TipNotFinite(_) => 0,
            PoseError::SideWithoutDirection(_) => 2,
            _ => 1,
        };
        (Problem::Pose(error), part)
    })
}

/// The path through poses in the job itself.
pub(crate) fn of_poses(raw: &[schema::Pose], law: Law, unit: f64) -> Result<Path, PoseFault> {
    let mut poses = Vec::with_capacity(raw.len());
    for (index, raw) in raw.iter().enumerate() {
        poses.push(pose(raw, unit).map_err(|(problem, part)| (problem, Some((index, part))))?);
    }
    Path::with_law(poses, law).map_err(path_fault)
}

fn path_fault(error: PathError) -> PoseFault {
    let place = match error {
        PathError::OppositeAxes { index } => Some((index + 1, 1)),
        _ => None,
    };
    (Problem::Path(error), place)
}

/// The path along moves in the job itself.
pub(crate) fn of_moves(raw: &[schema::Move], law: Law, unit: f64) -> Result<Path, PoseFault> {
    let mut poses: Vec<Pose> = Vec::with_capacity(raw.len());
    let mut arcs = Vec::new();
    for (index, raw) in raw.iter().enumerate() {
        let fault = |problem: Problem| (problem, Some((index, 0)));
        let (to, arc) = match raw {
            schema::Move::Start(to) | schema::Move::Line(to) => (to, None),
            schema::Move::Arc {
                to,
                centre,
                normal,
                turn,
                turns,
            } => (to, Some((centre.map(|c| c * unit), *normal, *turn, *turns))),
        };
        if matches!(raw, schema::Move::Start(_)) != (index == 0) {
            let message = "expected `Start(..)` as the first of the moves, and nowhere else";
            return Err(fault(Problem::syntax(message)));
        }
        let to = pose(to, unit).map_err(|(problem, part)| (problem, Some((index, part))))?;
        if let (Some((centre, normal, turn, turns)), Some(from)) = (arc, poses.last()) {
            let signed = match (turns, turn) {
                (1..=10_000, schema::Turn::Ccw) => i32::from(turns),
                (1..=10_000, schema::Turn::Cw) => -i32::from(turns),
                _ => return Err(fault(Problem::value("`turns` of an arc", turns, "from 1 to 10000"))),
            };
            let arc = TipArc::between(from.tip(), to.tip(), centre, normal, signed);
            arcs.push((
                index - 1,
                arc.map_err(|error| fault(Problem::syntax(error.to_string())))?,
            ));
        }
        poses.push(to);
    }
    let plain = Path::with_law(poses.clone(), law).map_err(path_fault)?;
    let mut moves: Vec<Move> = (0..plain.moves()).map(|index| plain.way(index)).collect();
    for (index, arc) in arcs {
        moves[index] = Move {
            course: Course::Arc(arc),
            turning: match moves[index].turning {
                Turning::Slerp => Turning::Even,
                other => other,
            },
        };
    }
    Path::with_moves(poses, moves).map_err(path_fault)
}

/// A file named in a job, relative to the folder of the job.
pub(crate) fn beside(job: &FilePath, file: &str) -> PathBuf {
    job.parent().unwrap_or(FilePath::new("")).join(file)
}
