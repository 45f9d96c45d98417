//! The program's course: where the tools are, and what is left of the stock at a number of moments.
//!
//! The moments are for show: between two of them, moves are followed as chords, and large grids are thinned. What the
//! report says does not depend on them.

use super::PageSource;
use super::program::Programs;
use crate::base::JobError;
use crate::request::Task;
use crate::session::CancelOnly;
use crate::show::{Placement, distance, placements};
use rayon::prelude::*;
use std::ops::ControlFlow;
use sweepsim::motion::{Assembly, Path, Pose, Tool};
use sweepsim::verify::{Scene, Target, ToolPath, VerifyOptions, verify};
use sweepsim_dexel::{Dexels, Grid};
use sweepsim_formats::JobPath;
use sweepsim_report::{Area, Course, DexelLayer, KeyFrame, LayerEnd, Track, TrackPoint};

/// The most lines of the grid of the moments.
const LINES: usize = 40_000;
/// The most points of the track.
const POINTS: usize = 200_000;
/// Programs with more moves have no moments unless they are asked for: it takes about as long as the simulation.
const MOVES: usize = 50_000;
/// So many moves are unpacked at a time.
const STRETCH: usize = 4096;
/// The default number of moments.
const MOMENTS: u16 = 120;

/// The course of all paths.
pub(super) struct Courses {
    pub track: Track,
    pub course: Option<Course>,
    /// Of each path, the number of moves before it.
    pub first_moves: Vec<u32>,
    pub moves: u32,
    /// Of each path, the length of feed moves and of rapids.
    pub lengths: Vec<[f64; 2]>,
    /// Between two moments: from, to, and the volume removed by the clock.
    pub removal: Vec<[f64; 3]>,
    pub notes: Vec<String>,
    /// The time at the end of each move, and at the start of the first.
    clocks: Vec<f64>,
}

impl Courses {
    /// The clock at a time (0 to 1) of a move.
    pub fn clock(&self, path: usize, number: usize, time: f64) -> Option<f64> {
        let place = *self.first_moves.get(path)? as usize + number;
        let [from, to] = [*self.clocks.get(place)?, *self.clocks.get(place + 1)?];
        Some(from + (to - from) * time.clamp(0.0, 1.0))
    }
}

/// The track, and the course if it is wanted.
pub(super) fn made(source: &PageSource, programs: &Programs) -> Result<Courses, JobError> {
    let job = source.session.job;
    let room = 0.1 * job.grid.spacing()[0].min(job.grid.spacing()[1]);
    // The clock is that of the machine if all moves have a duration, otherwise the way of the tip.
    let is_timed = |path: &JobPath| {
        path.seconds.len() == path.path.moves() && path.seconds.iter().all(|s| s.is_some_and(f64::is_finite))
    };
    let timed = job.paths.iter().all(is_timed);
    let mut made = Courses {
        track: Track {
            lines: programs.lines(),
            unit: if timed { "s" } else { "mm" }.to_owned(),
            ..Track::default()
        },
        course: None,
        first_moves: Vec::new(),
        moves: 0,
        lengths: Vec::new(),
        removal: Vec::new(),
        notes: Vec::new(),
        clocks: vec![0.0],
    };
    let every = job.moves().div_ceil(POINTS).max(1);
    let (mut clock, mut tool_numbers) = (0.0, job.tools.keys().copied().collect::<Vec<u32>>());
    tool_numbers.sort_unstable();
    for path in &job.paths {
        made.first_moves.push(made.moves);
        let tool = tool_numbers.binary_search(&path.tool).unwrap_or_default() as u16;
        let reach = job.tools[&path.tool].reach();
        let mut lengths = [0.0; 2];
        let mut before = Placement::first(&path.path);
        let mut point = |clock: f64, place: &Placement, number: u32, rapid: bool, begins: bool| {
            made.track.points.push(TrackPoint {
                clock,
                tip: place.tip,
                axis: place.axis,
                number,
                rapid,
                begins,
                tool,
            });
        };
        if let Some(place) = &before {
            point(clock, place, made.moves, false, true);
        }
        let mut times = path.seconds.iter();
        for (first, part) in path.path.stretches(STRETCH) {
            for own in 0..part.moves() {
                let number = first + own;
                let rapid = path.rapid.get(number);
                // What is left out of long programs is straight, as far as people can see.
                let room = if every > 1 { f64::INFINITY } else { room };
                let places = placements(&part, own, 1.0, reach, room);
                let steps: Vec<[f64; 2]> = std::iter::once(before)
                    .chain(places.iter().copied().map(Some))
                    .zip(&places)
                    .map(|(before, place)| {
                        let Some(before) = before else { return [0.0; 2] };
                        let step = distance(before.tip, place.tip);
                        // A turn on the spot takes time, too.
                        [step, step.max(0.25 * before.far(place, reach))]
                    })
                    .collect();
                let whole: f64 = steps.iter().map(|[_, way]| way).sum();
                let known = times.next().flatten();
                let seconds = if timed { known.unwrap_or_default() } else { whole };
                let pace = if whole > 0.0 { seconds / whole } else { 0.0 };
                let end = clock + seconds;
                for (place, [step, way]) in places.iter().zip(&steps) {
                    clock += pace * way;
                    lengths[usize::from(rapid)] += step;
                    if number % every == 0 || number + 1 == path.path.moves() {
                        point(clock, place, made.moves + number as u32, rapid, false);
                    }
                }
                before = places.last().copied().or(before);
                // A move without a way may take its time.
                clock = end.max(clock);
                made.clocks.push(clock);
            }
        }
        made.moves += path.path.moves() as u32;
        made.lengths.push(lengths);
    }
    let asked = source.session.request.moments;
    let count = asked.unwrap_or(MOMENTS);
    if source.session.request.task == Task::Sweep || count == 0 || clock <= 0.0 {
        return Ok(made);
    }
    if job.moves() > MOVES && asked.is_none() {
        made.notes.push(format!(
            "the workpiece during the program is not shown: more than {MOVES} moves; --moments asks for it"
        ));
        return Ok(made);
    }
    moments(source, count, &mut made)?;
    Ok(made)
}

/// The grid of the moments: that of the job, thinned if it is large.
fn thinned(grid: &Grid) -> Option<Grid> {
    let cells = grid.cells();
    let mut every = 1;
    while cells[0].div_ceil(every) * cells[1].div_ceil(every) > LINES {
        every += 1;
    }
    let thin = Grid::new(grid.min(), grid.max(), cells.map(|n| n.div_ceil(every))).ok()?;
    Some(thin.in_frame(*grid.frame()))
}

/// The distances of a line's ends from the target; NaN without one.
fn deviations(dexels: &Dexels, line: usize, target: Option<&Target>) -> Vec<[f32; 2]> {
    let grid = dexels.grid();
    let (i, j) = grid.place(line);
    let distance = |z: f64| {
        let place = grid.frame().to_world([grid.x(i), grid.y(j), z]);
        let near = target.and_then(|target| target.distance().nearest(place));
        near.map_or(f32::NAN, |near| near.distance as f32)
    };
    dexels.at(line).heights().map(|ends| ends.map(distance)).collect()
}

fn layer(dexels: &Dexels, target: Option<&Target>) -> DexelLayer {
    let grid = dexels.grid();
    let area = Area {
        min: grid.min(),
        max: grid.max(),
        cells: grid.cells(),
    };
    let numbers = 0..grid.len();
    let mut measured = numbers
        .into_par_iter()
        .map(|line| deviations(dexels, line, target))
        .collect::<Vec<_>>()
        .into_iter();
    // Lines come by column, then row, as they are numbered.
    DexelLayer::new(area, |i, j, line| {
        let own = measured.next().unwrap_or_default();
        for (ends, deviations) in dexels.intervals(i, j).heights().zip(own) {
            let [mut lower, mut upper] = [
                LayerEnd::at(ends[0], [0.0, 0.0, -1.0]),
                LayerEnd::at(ends[1], [0.0, 0.0, 1.0]),
            ];
            [lower.deviation, upper.deviation] = deviations;
            line.push([lower, upper]);
        }
    })
}

/// What changed between two states.
fn changes(clock: f64, before: &Dexels, after: &Dexels, target: Option<&Target>) -> KeyFrame {
    let mut frame = KeyFrame::new(clock);
    let lines = (0..after.grid().len()).into_par_iter();
    let changed = lines.filter(|line| !before.at(*line).heights().eq(after.at(*line).heights()));
    let found: Vec<_> = changed.map(|line| (line, deviations(after, line, target))).collect();
    for (line, own) in found {
        frame.push_measured(line as u32, after.at(line).heights().zip(own));
    }
    frame
}

/// Cuts the track at equal times, and removes what is swept in each part.
fn moments(source: &PageSource, count: u16, made: &mut Courses) -> Result<(), JobError> {
    let session = source.session;
    let job = session.job;
    session.phase("course");
    let same = || job.stock.dexels(&job.grid).map(|stock| (job.grid, stock));
    let stock = thinned(&job.grid).and_then(|grid| Some((grid, job.stock.dexels(&grid).ok()?)));
    // A stock of dexels has a grid of its own.
    let Some((_, stock)) = stock.or_else(|| same().ok()) else {
        return Ok(());
    };
    let tools: Vec<&Tool> = job.tools.values().collect();
    let assemblies: Vec<Assembly> = tools.iter().map(|tool| Assembly::new((*tool).clone())).collect();
    let options = VerifyOptions::new(session.request.sweep_options(job));
    let start = layer(&stock, source.target);
    let mut found = Vec::new();
    let grid = *stock.grid();
    let mut shown = stock.clone();
    let mut now = stock;
    let end = made.clocks.last().copied().unwrap_or_default();
    let step = end / f64::from(count);
    let mut since = 0.0;
    let mut poses: Vec<Pose> = Vec::new();
    let cut = |poses: &mut Vec<Pose>, tool: u16, now: &mut Dexels| -> Result<(), JobError> {
        let last = poses.last().cloned();
        if poses.len() > 1
            && let Ok(path) = Path::new(std::mem::take(poses))
        {
            let program = [ToolPath::new(&assemblies[usize::from(tool)], &path)];
            let scene = Scene::new(std::mem::replace(now, Dexels::empty(grid)));
            let monitor = &CancelOnly(session.monitor);
            let done = verify(scene, &program, &options, &mut |_| ControlFlow::Continue(()), monitor);
            *now = done.map_err(|error| session.failed(error))?.remaining;
        }
        poses.clear();
        poses.extend(last);
        Ok(())
    };
    let mut moment = 1;
    let points = &made.track.points;
    for (n, point) in points.iter().enumerate() {
        let tool = tools[usize::from(point.tool)];
        let place = |point: &TrackPoint| Placement {
            tip: point.tip,
            axis: point.axis,
            side: side(point.axis),
        };
        if point.begins {
            if n > 0 {
                cut(&mut poses, points[n - 1].tool, &mut now)?;
            }
            poses.clear();
            poses.extend(place(point).pose(tool));
            continue;
        }
        let before = &points[n - 1];
        while step * moment as f64 <= point.clock || n + 1 == points.len() {
            let last = n + 1 == points.len() && step * moment as f64 >= point.clock;
            let clock = if last { point.clock } else { step * moment as f64 };
            let span = point.clock - before.clock;
            let t = if span > 0.0 { (clock - before.clock) / span } else { 1.0 };
            poses.extend(place(before).between(&place(point), t).pose(tool));
            cut(&mut poses, point.tool, &mut now)?;
            let frame = changes(clock, &shown, &now, source.target);
            let removed = shown.volume() - now.volume();
            made.removal
                .push([since, clock, removed.max(0.0) / (clock - since).max(f64::MIN_POSITIVE)]);
            since = clock;
            if !frame.is_empty() {
                found.push(frame);
                shown = now.clone();
            }
            moment += 1;
            if last {
                break;
            }
        }
        poses.extend(place(point).pose(tool));
    }
    made.course = Some(Course { start, frames: found });
    Ok(())
}

/// Any direction across an axis, the same for nearly the same axis.
fn side(axis: [f64; 3]) -> [f64; 3] {
    let across = if axis[2].abs() > 0.9 {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    };
    let along: f64 = (0..3).map(|k| across[k] * axis[k]).sum();
    [0, 1, 2].map(|k| across[k] - along * axis[k])
}
