//! Pictures of the stock while it is cut.
//!
//! Each move is cut once, in the order of the program: the state that is kept is always that after a whole move. What
//! the tool has swept of the move that it is in is removed from a copy, along chords: the picture is the only thing
//! that is made of it.

mod machine;
mod moments;

use crate::base::{JobError, Sink};
use crate::session::{CancelOnly, Session, phase};
use crate::show::{CRISP, Placement, bounds, frame_picture, placements, shape, share};
use machine::Machines;
use moments::{Moment, moments};
use std::collections::BTreeMap;
use sweepsim::motion::{BodyKind, Path, Pose};
use sweepsim::{Cut, Options, simulate};
use sweepsim_dexel::{Dexels, Mesh, TriDexels};
use sweepsim_formats::{Job, Report};

/// The stock while it is cut.
struct CutStock<'a> {
    job: &'a Job,
    monitor: CancelOnly<'a>,
    sweeping: Options,
    sets: Vec<Dexels>,
    /// The path that is being cut, and how many of its moves have been.
    path: usize,
    done: usize,
}

/// Writes the frames of a stock: dexels along z, or along x, y and z.
pub(crate) fn write(
    session: Session,
    count: u16,
    stock: Vec<Dexels>,
    sink: &mut dyn Sink,
    report: &mut Report,
) -> Result<(), JobError> {
    session.phase("frames");
    phase(report, "frames", || draw(session, usize::from(count), stock, sink))
}

fn draw(session: Session, count: usize, stock: Vec<Dexels>, sink: &mut dyn Sink) -> Result<(), JobError> {
    let (job, request) = (session.job, session.request);
    let moments = moments(job, count);
    let mut cut = CutStock {
        job,
        monitor: CancelOnly(session.monitor),
        sweeping: request.sweep_options(job),
        sets: stock,
        path: 0,
        done: 0,
    };
    // All frames have the point of view of the raw stock.
    let raw = surface(cut.sets.clone())?;
    let Some(whole) = bounds(&raw) else {
        return Err(JobError::request("frames", "expected a stock that is not empty"));
    };
    let mut tools: BTreeMap<u32, Mesh> = BTreeMap::new();
    // The bodies of the machine are in all frames, if there are any.
    let machines = Machines::new(job);
    let seen = moments.iter().filter_map(|moment| bounds(&machines.at(job, *moment)));
    let whole = seen.fold(whole, |[low, high], [a, b]| {
        [
            [0, 1, 2].map(|k| low[k].min(a[k])),
            [0, 1, 2].map(|k| high[k].max(b[k])),
        ]
    });
    for number in 0..count {
        let moment = moments.get(number).copied();
        let sets = match moment {
            Some(moment) => cut.at(moment)?,
            None => cut.sets.clone(),
        };
        let mesh = surface(sets)?;
        let tool = moment.filter(|_| !request.no_tool).map(|moment| {
            let path = &job.paths[moment.path];
            let own = tools.entry(path.tool).or_insert_with(|| assembled(job, path.tool));
            let reach = job.tools[&path.tool].reach();
            placed(own, &Placement::at(&path.path, moment.number, moment.time, reach))
        });
        let bodies = moment
            .map(|moment| machines.at(job, moment))
            .filter(|bodies| !bodies.triangles.is_empty());
        let tool = match (tool, bodies) {
            (Some(tool), Some(bodies)) => Some(joined(tool, bodies)),
            (tool, bodies) => tool.or(bodies),
        };
        let go_on = share(session.monitor, |part| (number as f64 + part) / count as f64);
        let png = frame_picture(&request.view, &mesh, tool.as_ref(), whole, &go_on)?;
        sink.write(&name(number + 1), &mut |file| file.write_all(&png))?;
    }
    // Those of an earlier run with more frames are no part of this one.
    (count + 1..).find(|extra| !sink.remove(&name(*extra)));
    Ok(())
}

fn name(number: usize) -> String {
    format!("frame-{number:04}.png")
}

impl CutStock<'_> {
    /// What is left of the stock at a moment. Moments must come in their order.
    fn at(&mut self, moment: Moment) -> Result<Vec<Dexels>, JobError> {
        while self.path < moment.path {
            self.cut_until(self.job.paths[self.path].path.moves())?;
            (self.path, self.done) = (self.path + 1, 0);
        }
        let whole = moment.time >= 1.0;
        self.cut_until(moment.number + usize::from(whole))?;
        if whole || moment.time <= 0.0 {
            return Ok(self.sets.clone());
        }
        let path = &self.job.paths[self.path];
        let tool = &self.job.tools[&path.tool];
        let spacing = self.job.grid.spacing();
        let room = 0.1 * spacing[0].min(spacing[1]);
        let before = Placement::at(&path.path, moment.number, 0.0, tool.reach());
        let way = placements(&path.path, moment.number, moment.time, tool.reach(), room);
        let poses: Option<Vec<Pose>> = std::iter::once(before)
            .chain(way)
            .map(|place| place.pose(tool))
            .collect();
        let Some(part) = poses.and_then(|poses| Path::new(poses).ok()) else {
            return Ok(self.sets.clone());
        };
        let cuts = [Cut::new(tool, &part)];
        self.sets.iter().map(|set| self.cut(set.clone(), &cuts)).collect()
    }

    /// Cuts the moves of the path that are not done yet, up to this one.
    fn cut_until(&mut self, number: usize) -> Result<(), JobError> {
        if number <= self.done {
            return Ok(());
        }
        let path = &self.job.paths[self.path];
        let part = path.path.part(self.done..number);
        let cuts = [Cut::new(&self.job.tools[&path.tool], &part)];
        for set in std::mem::take(&mut self.sets) {
            let cut = self.cut(set, &cuts)?;
            self.sets.push(cut);
        }
        self.done = number;
        Ok(())
    }

    fn cut(&self, set: Dexels, cuts: &[Cut]) -> Result<Dexels, JobError> {
        match simulate(set, cuts, &self.sweeping, &self.monitor) {
            Ok(done) => Ok(done.remaining),
            Err(sweepsim::SweepError::Cancelled) => Err(JobError::Cancelled),
            Err(error) => Err(JobError::request("frames", error.to_string())),
        }
    }
}

/// The surface of dexels along z, or along x, y and z.
fn surface(mut sets: Vec<Dexels>) -> Result<Mesh, JobError> {
    match <[Dexels; 3]>::try_from(std::mem::take(&mut sets)) {
        Ok(sets) => {
            let solid = TriDexels::from_sets(sets).map_err(|error| JobError::request("frames", error.to_string()))?;
            Ok(solid.surface().and_then(|mesh| mesh.crisp(CRISP))?)
        }
        Err(sets) => Ok(sets.first().map_or(Ok(Mesh::default()), Dexels::surface)?),
    }
}

/// A tool with its shank and holder.
fn assembled(job: &Job, number: u32) -> Mesh {
    let mut whole = shape::mesh(&job.tools[&number], CRISP);
    let bodies = job.bodies.get(&number).into_iter().flatten();
    for body in bodies.filter(|body| matches!(body.kind, BodyKind::Shank | BodyKind::Holder)) {
        whole = joined(whole, shape::mesh(&body.solid, CRISP));
    }
    whole
}

/// Two meshes in one.
fn joined(mut whole: Mesh, part: Mesh) -> Mesh {
    let first = whole.vertices.len() as u32;
    whole.vertices.extend(part.vertices);
    whole.normals.extend(part.normals);
    whole.cut.extend(part.cut);
    whole
        .triangles
        .extend(part.triangles.iter().map(|t| t.map(|v| first + v)));
    whole
}

/// A tool where it stands.
fn placed(own: &Mesh, place: &Placement) -> Mesh {
    let turned = |n: &[f32; 3]| place.direction(n.map(f64::from)).map(|c| c as f32);
    Mesh {
        vertices: own.vertices.iter().map(|p| place.point(*p)).collect(),
        normals: own.normals.iter().map(turned).collect(),
        ..own.clone()
    }
}
