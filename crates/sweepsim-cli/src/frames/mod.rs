//! `--frames N`: pictures of the stock while it is cut.
//!
//! Each move is cut once, in the order of the program: the state that is kept is always that after a whole move. What the tool has swept of the
//! move that it is in is removed from a copy, along chords: the picture is the only thing that is made of it.

mod moments;

use crate::arguments::{RunOptions, ViewOptions};
use crate::session::{CRISP, Failure, JobSession, Place, bounds, frame_picture, placements, shape};
use moments::{Moment, moments};
use std::collections::BTreeMap;
use std::io::Write as _;
use sweepsim::motion::{BodyKind, Path, Pose};
use sweepsim::{Cut, Monitor, Options, simulate};
use sweepsim_dexel::{Dexels, Mesh, TriDexels};
use sweepsim_formats::{Job, Report};

/// What the frames are made of.
pub(crate) struct Frames<'a> {
    count: usize,
    /// Whether the tool is drawn.
    tool: bool,
    view: &'a ViewOptions,
    sweeping: Options,
    stock: Vec<Dexels>,
}

/// The stock while it is cut.
struct Course<'a> {
    job: &'a Job,
    monitor: Silent<'a>,
    sweeping: Options,
    sets: Vec<Dexels>,
    /// The path that is being cut, and how many of its moves have been.
    path: usize,
    done: usize,
}

impl<'a> Frames<'a> {
    /// `count` frames of a stock: dexels along z, or along x, y and z.
    pub fn new(count: u16, options: &'a RunOptions, sweeping: Options, stock: Vec<Dexels>) -> Self {
        Self {
            count: usize::from(count),
            tool: !options.no_tool,
            view: &options.view,
            sweeping,
            stock,
        }
    }

    /// Writes them.
    pub fn write(self, session: &mut JobSession, report: &mut Report) -> Result<(), Failure> {
        session.progress.phase_of_shares("frames");
        let start = std::time::Instant::now();
        let done = self.draw(session);
        *report.seconds.entry("frames".to_owned()).or_default() += start.elapsed().as_secs_f64();
        done
    }

    fn draw(self, session: &mut JobSession) -> Result<(), Failure> {
        let JobSession {
            job, outputs, progress, ..
        } = session;
        let (job, progress) = (&*job, &*progress);
        let moments = moments(job, self.count);
        let mut course = Course {
            job,
            monitor: Silent(progress),
            sweeping: self.sweeping,
            sets: self.stock,
            path: 0,
            done: 0,
        };
        // All frames have the point of view of the raw stock.
        let raw = surface(course.sets.clone())?;
        let Some(whole) = bounds(&raw) else {
            return Err(Failure::message("--frames: expected a stock that is not empty"));
        };
        let mut tools: BTreeMap<u32, Mesh> = BTreeMap::new();
        for number in 0..self.count {
            let moment = moments.get(number).copied();
            let sets = match moment {
                Some(moment) => course.at(moment)?,
                None => course.sets.clone(),
            };
            let mesh = surface(sets)?;
            let tool = moment.filter(|_| self.tool).map(|moment| {
                let path = &job.paths[moment.path];
                let own = tools.entry(path.tool).or_insert_with(|| assembled(job, path.tool));
                let reach = job.tools[&path.tool].reach();
                placed(own, &Place::at(&path.path, moment.number, moment.time, reach))
            });
            let share = |share: f64| progress.share((number as f64 + share) / self.count as f64);
            let png = frame_picture(self.view, &mesh, tool.as_ref(), whole, &share)?;
            outputs.write(&name(number + 1), |file| file.write_all(&png))?;
        }
        // Those of an earlier run with more frames are no part of this one.
        outputs.remove_from(|extra| name(self.count + 1 + extra));
        Ok(())
    }
}

fn name(number: usize) -> String {
    format!("frame-{number:04}.png")
}

impl Course<'_> {
    /// What is left of the stock at a moment. Moments must come in their order.
    fn at(&mut self, moment: Moment) -> Result<Vec<Dexels>, Failure> {
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
        let before = Place::at(&path.path, moment.number, 0.0, tool.reach());
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
    fn cut_until(&mut self, number: usize) -> Result<(), Failure> {
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

    fn cut(&self, set: Dexels, cuts: &[Cut]) -> Result<Dexels, Failure> {
        match simulate(set, cuts, &self.sweeping, &self.monitor) {
            Ok(done) => Ok(done.remaining),
            Err(sweepsim::SweepError::Cancelled) => Err(Failure::interrupted()),
            Err(error) => Err(Failure::message(format!("--frames: {error}"))),
        }
    }
}

/// The surface of dexels along z, or along x, y and z.
fn surface(mut sets: Vec<Dexels>) -> Result<Mesh, Failure> {
    match <[Dexels; 3]>::try_from(std::mem::take(&mut sets)) {
        Ok(sets) => {
            let solid = TriDexels::from_sets(sets).map_err(|error| Failure::message(format!("--frames: {error}")))?;
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
        let part = shape::mesh(&body.solid, CRISP);
        let first = whole.vertices.len() as u32;
        whole.vertices.extend(part.vertices);
        whole.normals.extend(part.normals);
        whole.cut.extend(part.cut);
        whole
            .triangles
            .extend(part.triangles.iter().map(|t| t.map(|v| first + v)));
    }
    whole
}

/// A tool where it stands.
fn placed(own: &Mesh, place: &Place) -> Mesh {
    let turned = |n: &[f32; 3]| place.direction(n.map(f64::from)).map(|c| c as f32);
    Mesh {
        vertices: own.vertices.iter().map(|p| place.point(*p)).collect(),
        normals: own.normals.iter().map(turned).collect(),
        ..own.clone()
    }
}

/// Cancels with the run, but leaves its progress alone.
struct Silent<'a>(&'a dyn Monitor);

impl Monitor for Silent<'_> {
    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }
}
