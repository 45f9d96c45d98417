//! The machine that a path is for: its bodies, and what its axes do.

use std::path::Path as FilePath;
use std::sync::Arc;

use nalgebra::Vector3;
use sweepsim_machine::{Body, Convex};
use sweepsim_nc::{AxesCourse, BodyShape, Kinematics, is_within};

use crate::error::{FormatError, Problem};
use crate::meshes::read_mesh_file;

/// A path on a machine that has bodies or limits.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct OnMachine {
    /// What its axes do in each move of the path.
    pub course: AxesCourse,
    /// Its bodies, in machine coordinates with all axes at 0.
    pub bodies: Arc<[Body]>,
}

/// The bodies of a machine, with the files that it names: they must be within a folder, if one is given.
pub(super) fn bodies(machine: &Kinematics, within: Option<&FilePath>) -> Result<Arc<[Body]>, FormatError> {
    let chain = machine.chain();
    let body = |described: &sweepsim_nc::BodyDescription| {
        let name = &described.name;
        let link = chain.link(&described.on).unwrap_or(chain.base());
        let solids = solids(&described.shape, within)?;
        let problem = || {
            let what = format!("the shape of the body {name} of the machine");
            FormatError::new(Problem::value(what, "no solid", "solids with finite numbers"), None)
        };
        Body::new(name.clone(), link, solids).ok_or_else(problem)
    };
    machine.description().bodies.iter().map(body).collect()
}

fn solids(shape: &BodyShape, within: Option<&FilePath>) -> Result<Vec<Convex>, FormatError> {
    Ok(match shape {
        BodyShape::Block { min, max } => vec![Convex::Block { min: *min, max: *max }],
        BodyShape::Cylinder { from, to, radius } => {
            let axis = Vector3::from(*to) - Vector3::from(*from);
            Convex::cones(*from, axis, &[[*radius, 0.0], [*radius, axis.norm()]])
        }
        BodyShape::Turned { at, axis, outline } => Convex::cones(*at, Vector3::from(*axis), outline),
        BodyShape::File(name) => {
            let file = FilePath::new(name);
            if !is_within(file, within) {
                let folder = within.unwrap_or(FilePath::new("")).display();
                let problem = Problem::syntax(format!("{name} is not in {folder}: expected a file there"));
                return Err(FormatError::new(problem, None));
            }
            let mesh = read_mesh_file(file)?;
            let soup = mesh.soup().unwrap_or_default();
            soup.check_closed().map_err(|error| {
                let problem = Problem::syntax(format!("a body of a machine is what its surface encloses: {error}"));
                FormatError::new(problem, None).in_file(file)
            })?;
            soup.triangles.into_iter().map(Convex::Triangle).collect()
        }
        _ => Vec::new(),
    })
}
