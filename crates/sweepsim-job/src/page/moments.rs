//! What is left of the stock at a number of moments of the program.
//!
//! The moments are for show: between two of them, moves are followed as chords, and large grids are thinned. What the
//! report says does not depend on them. Where the run has dexels along three axes, so have they, and the workpiece is
//! shown by its surface; otherwise by lines along z.

use super::PageSource;
use super::surface::{MOST, distances};
use crate::base::{JobError, words};
use crate::session::{CancelOnly, joined, stock_heights, stock_on};
use crate::show::{CRISP, Placement};
use rayon::prelude::*;
use std::ops::ControlFlow;
use sweepsim::motion::{Assembly, Path, Pose, Tool};
use sweepsim::verify::{Scene, Target, ToolPath, VerifyOptions, verify};
use sweepsim_dexel::{ChangingSurface, Dexels, Grid, TimedMesh};
use sweepsim_report::{Area, Course, DexelLayer, KeyFrame, LayerEnd, Surface, SurfaceCourse, Track, TrackPoint};

/// The most lines of the grid of the moments.
const LINES: usize = 40_000;
/// The most lines along three axes together: walls are sharp however far apart lines are, and a corner costs more than
/// an end.
const LINES_OF_SURFACE: usize = 16_000;
/// What moves by less than this, in steps, is as it was.
const SAME: f64 = 1e-4;
/// Where the surface has too many triangles at all moments together, lines are so many times as far apart.
const COARSER: f64 = 1.5;

/// The workpiece during the program.
#[derive(Default)]
pub(super) struct Moments {
    pub lines: Option<Course>,
    pub surface: Option<SurfaceCourse>,
    /// Between two moments: from, to, and the volume removed by the clock.
    pub removal: Vec<[f64; 3]>,
}

/// The workpiece at so many moments, at equal times.
pub(super) fn moments(
    source: &PageSource,
    count: u16,
    track: &Track,
    notes: &mut Vec<String>,
) -> Result<Moments, JobError> {
    let job = source.session.job;
    source.session.phase("course");
    if source.solid.is_some()
        && let Some(moments) = surfaces(source, count, track, notes)?
    {
        return Ok(moments);
    }
    let same = || job.stock.dexels(&job.grid);
    // A stock of dexels has a grid of its own.
    let stock = thinned(&job.grid).and_then(|grid| job.stock.dexels(&grid).ok());
    let Some(stock) = stock.or_else(|| same().ok()) else {
        return Ok(Moments::default());
    };
    let start = layer(&stock, source.target);
    let (mut frames, mut shown, mut removal) = (Vec::new(), stock.clone(), Vec::new());
    let mut show = |[since, clock]: [f64; 2], now: &[Dexels]| {
        removal.push(rate([since, clock, shown.volume() - now[0].volume()]));
        let frame = changes(clock, &shown, &now[0], source.target);
        if !frame.is_empty() {
            frames.push(frame);
            shown = now[0].clone();
        }
        Ok(ControlFlow::Continue(()))
    };
    let _to_the_end = followed(source, count, track, vec![stock], &mut show)?;
    Ok(Moments {
        lines: Some(Course { start, frames }),
        surface: None,
        removal,
    })
}

/// From, to, and the volume that is removed between them by the clock, of the volume in all.
fn rate([from, to, volume]: [f64; 3]) -> [f64; 3] {
    [from, to, volume.max(0.0) / (to - from).max(f64::MIN_POSITIVE)]
}

/// The same by the surface of dexels along three axes; nothing if they cannot be made, or it needs too many triangles
/// even if they are far apart.
fn surfaces(
    source: &PageSource,
    count: u16,
    track: &Track,
    notes: &mut Vec<String>,
) -> Result<Option<Moments>, JobError> {
    let job = source.session.job;
    let failed = |error: &dyn std::fmt::Display| source.session.failure(format!("course: {error}"));
    let Some(range) = stock_heights(job) else {
        return Ok(None);
    };
    let mut times = 1.0;
    let mut before = None;
    loop {
        let Some(solid) = coarse(&job.grid, range, times).and_then(|grid| stock_on(job, &grid)) else {
            return Ok(None);
        };
        // A stock of dexels keeps its lines.
        if before.replace(solid.cells()) == Some(solid.cells()) {
            let why = "the workpiece during the program is that on lines along z: its surface has too many triangles";
            notes.push(why.to_owned());
            return Ok(None);
        }
        let [step, ..] = solid.spacing();
        let sets = solid.sets().to_vec();
        let mut changing = ChangingSurface::new(solid, CRISP, SAME * step).map_err(|error| failed(&error))?;
        let (mut clocks, mut steps) = (Vec::new(), Vec::new());
        let mut show = |[since, clock]: [f64; 2], now: &[Dexels]| {
            let [x, y, z] = now else {
                return Ok(ControlFlow::Break(()));
            };
            let solid = joined([x.clone(), y.clone(), z.clone()])?;
            let before = clocks.len();
            if changing.advance(solid).map_err(|error| failed(&error))? {
                clocks.push(clock);
            }
            steps.push(([since, clock], [before, clocks.len()]));
            if changing.triangles() > 2 * MOST {
                return Ok(ControlFlow::Break(()));
            }
            Ok(ControlFlow::Continue(()))
        };
        if followed(source, count, track, sets, &mut show)?.is_break() {
            times *= COARSER;
            continue;
        }
        if step > 1.01 * job.grid.spacing()[0] {
            let step = words::length(step);
            notes.push(format!(
                "the workpiece during the program is that on lines {step} mm apart"
            ));
        }
        let mesh = changing.finish();
        let volumes = mesh.volumes();
        let volume = |moment: usize| volumes.get(moment).copied().unwrap_or(0.0);
        let removed = |([from, to], [a, b]): ([f64; 2], [usize; 2])| rate([from, to, volume(a) - volume(b)]);
        return Ok(Some(Moments {
            lines: None,
            removal: steps.into_iter().map(removed).collect(),
            surface: Some(measured(mesh, clocks, source.target, track)),
        }));
    }
}

/// The surface at all moments with what is known of it.
fn measured(mesh: TimedMesh, clocks: Vec<f64>, target: Option<&Target>, track: &Track) -> SurfaceCourse {
    // The move at the end of a moment stands for all of it.
    let maker = |made: &u32| {
        let clock = clocks.get((*made as usize).wrapping_sub(1))?;
        let point = track.points.partition_point(|point| point.clock < clock - 1e-9);
        Some(track.points.get(point)?.number + 1)
    };
    SurfaceCourse {
        spans: mesh
            .spans
            .iter()
            .map(|span| span.map(|moment| u16::try_from(moment).unwrap_or(u16::MAX)))
            .collect(),
        surface: Surface {
            deviations: target.map_or_else(Vec::new, |target| distances(target, &mesh.vertices)),
            makers: mesh.made.iter().map(|made| maker(made).unwrap_or(0)).collect(),
            vertices: mesh.vertices,
            normals: mesh.normals,
            triangles: mesh.triangles,
            ..Surface::default()
        },
        clocks,
    }
}

/// A grid along z such that all lines along three axes, over these heights, are no more than [`LINES_OF_SURFACE`]; and
/// so many times coarser.
fn coarse(grid: &Grid, [low, high]: [f64; 2], times: f64) -> Option<Grid> {
    let [nx, ny] = grid.cells().map(|n| n as f64);
    let [dx, dy] = grid.spacing();
    let levels = (high - low) / (dx * dy).sqrt();
    let lines = nx * ny + (nx + ny) * levels;
    let times = times * (lines / LINES_OF_SURFACE as f64).sqrt().max(1.0);
    let cells = grid.cells().map(|n| ((n as f64 / times).round() as usize).max(1));
    let thin = Grid::new(grid.min(), grid.max(), cells).ok()?;
    Some(thin.in_frame(*grid.frame()))
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

/// What is shown of the sets of dexels at the second of two times; breaks off if that cannot be shown.
type Show<'a> = dyn FnMut([f64; 2], &[Dexels]) -> Result<ControlFlow<()>, JobError> + 'a;

/// Cuts the track at equal times, and removes what is swept in each part from all sets. Breaks off where `show` does.
fn followed(
    source: &PageSource,
    count: u16,
    track: &Track,
    mut now: Vec<Dexels>,
    show: &mut Show,
) -> Result<ControlFlow<()>, JobError> {
    let session = source.session;
    let job = session.job;
    let tools: Vec<&Tool> = job.tools.values().collect();
    let assemblies: Vec<Assembly> = tools.iter().map(|tool| Assembly::new((*tool).clone())).collect();
    let options = VerifyOptions::new(session.request.sweep_options(job));
    let points = &track.points;
    let end = points.last().map_or(0.0, |point| point.clock);
    let step = end / f64::from(count);
    let mut since = 0.0;
    let mut poses: Vec<Pose> = Vec::new();
    let cut = |poses: &mut Vec<Pose>, tool: u16, now: &mut [Dexels]| -> Result<(), JobError> {
        let last = poses.last().cloned();
        if poses.len() > 1
            && let Ok(path) = Path::new(std::mem::take(poses))
        {
            let program = [ToolPath::new(&assemblies[usize::from(tool)], &path)];
            for set in now {
                let grid = *set.grid();
                let scene = Scene::new(std::mem::replace(set, Dexels::empty(grid)));
                let monitor = &CancelOnly(session.monitor);
                let done = verify(scene, &program, &options, &mut |_| ControlFlow::Continue(()), monitor);
                *set = done.map_err(|error| session.failed(error))?.remaining;
            }
        }
        poses.clear();
        poses.extend(last);
        Ok(())
    };
    let mut moment = 1;
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
            if show([since, clock], &now)?.is_break() {
                return Ok(ControlFlow::Break(()));
            }
            since = clock;
            moment += 1;
            if last {
                break;
            }
        }
        poses.extend(place(point).pose(tool));
    }
    Ok(ControlFlow::Continue(()))
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
