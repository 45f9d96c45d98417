//! The bodies of a machine at a moment of a program.

use super::Moment;
use crate::show::solids::{self, Triangles};
use sweepsim_dexel::Mesh;
use sweepsim_formats::{Job, JobPath, OnMachine};

/// Bodies of more triangles are not shown whole.
const LARGEST: usize = 100_000;

/// The bodies of the machines of a job, as triangles.
pub(super) struct Machines {
    /// Of each path that has bodies; paths for one machine share theirs.
    bodies: Vec<Option<std::rc::Rc<Vec<Triangles>>>>,
}

impl Machines {
    pub fn new(job: &Job) -> Self {
        let mut bodies: Vec<Option<std::rc::Rc<Vec<Triangles>>>> = Vec::with_capacity(job.paths.len());
        for (number, path) in job.paths.iter().enumerate() {
            let Some(on) = with_bodies(path) else {
                bodies.push(None);
                continue;
            };
            let same = |other: &usize| {
                with_bodies(&job.paths[*other]).is_some_and(|other| std::sync::Arc::ptr_eq(&other.bodies, &on.bodies))
            };
            let known = (0..number).find(same).and_then(|other| bodies[other].clone());
            let own = || std::rc::Rc::new(on.bodies.iter().map(|body| solids::body(body, LARGEST)).collect());
            bodies.push(Some(known.unwrap_or_else(own)));
        }
        Self { bodies }
    }

    /// The bodies where they are at a moment, in the coordinates of the part; nothing of a path without.
    pub fn at(&self, job: &Job, moment: Moment) -> Mesh {
        let mut mesh = Mesh::default();
        let path = &job.paths[moment.path];
        let (Some(own), Some(on)) = (&self.bodies[moment.path], with_bodies(path)) else {
            return mesh;
        };
        let values = on.course.during(moment.number, moment.time);
        let zero = on.course.machine().description().part_zero;
        let linkage = on.course.chain().linkage();
        for (body, triangles) in on.bodies.iter().zip(own.iter()) {
            solids::add_flat(&mut mesh, triangles, |point| {
                let on_part = linkage.place(point, body.link, 0, &values);
                path.frame.to_world([0, 1, 2].map(|k| on_part[k] - zero[k]))
            });
        }
        mesh
    }
}

fn with_bodies(path: &JobPath) -> Option<&OnMachine> {
    path.on_machine.as_ref().filter(|on| !on.bodies.is_empty())
}
