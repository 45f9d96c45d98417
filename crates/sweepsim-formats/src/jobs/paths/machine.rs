//! The machine that a path is for: its bodies, and what its axes do.

use std::path::Path as FilePath;
use std::sync::Arc;

use nalgebra::Vector3;
use sweepsim_machine::{Body, Convex, Course, Limits, Outcome, Values, contacts};
use sweepsim_nc::{AxesCourse, BodyShape, Kinematics, MachineDescription, is_within};

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
    let bodies: Arc<[Body]> = machine
        .description()
        .bodies
        .iter()
        .map(body)
        .collect::<Result<_, _>>()?;
    check_at_home(machine, &bodies)?;
    Ok(bodies)
}

/// Whether two bodies of a machine are looked at: they are on two links that no axis joins, and need not touch.
#[must_use]
pub fn must_stay_apart(machine: &MachineDescription, a: &Body, b: &Body) -> bool {
    a.link.abs_diff(b.link) > 1 && !may_touch(machine, a, b)
}

/// Whether two bodies are a pair of `may_touch`.
#[must_use]
pub fn may_touch(machine: &MachineDescription, a: &Body, b: &Body) -> bool {
    let same = |(c, d): &(String, String)| (*c == a.name && *d == b.name) || (*c == b.name && *d == a.name);
    machine.may_touch.iter().any(same)
}

/// Bodies that are no deeper in each other touch, in millimetres.
const TOUCHING: f64 = 1e-6;

/// A machine that stands still.
struct Still(Values);

impl Course for Still {
    fn moves(&self) -> usize {
        1
    }

    fn at(&self, _: usize, _: f64) -> Values {
        self.0
    }

    fn bend(&self, _: usize) -> Values {
        Values::default()
    }

    fn joined(&self, _: usize) -> bool {
        false
    }
}

/// Refuses bodies that overlap, or touch, before anything moves.
fn check_at_home(machine: &Kinematics, bodies: &[Body]) -> Result<(), FormatError> {
    let chain = machine.chain();
    let all = (0..bodies.len()).flat_map(|a| (a + 1..bodies.len()).map(move |b| (a, b)));
    let looked_at = |(a, b): &(usize, usize)| must_stay_apart(machine.description(), &bodies[*a], &bodies[*b]);
    let pairs: Vec<(usize, usize)> = all.filter(looked_at).collect();
    let found = contacts(
        chain.linkage(),
        bodies,
        &pairs,
        &Still(chain.home(machine)),
        &Limits::new(0.0),
    );
    let met = pairs.iter().zip(found).find_map(|(pair, outcome)| match outcome {
        Outcome::Contact(contact) => Some((pair, contact.depth)),
        _ => None,
    });
    let Some((&(a, b), depth)) = met else {
        return Ok(());
    };
    let [a, b] = [a, b].map(|body| &bodies[body].name);
    let how = match depth {
        depth if depth > TOUCHING => format!("overlap, by at most {depth:.3} mm,"),
        _ => "touch".to_owned(),
    };
    let problem = Problem::syntax(format!(
        "the bodies {a} and {b} of the machine {} {how} with all axes at home: expected bodies that are apart there, or the pair in may_touch",
        machine.name()
    ));
    Err(FormatError::new(problem, None))
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
