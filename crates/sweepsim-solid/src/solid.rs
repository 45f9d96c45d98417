//! The solid: surfaces, edges, and faces between them.

use crate::edges::{Chains, Edge, Placed, chains, place};
use crate::error::SolidError;
use crate::faces::{Faces, Use, faces, shells};
use crate::label::{FREE, Groups, Labels, labels, split};
use crate::net::Net;
use crate::summary::{Summary, summary};
use crate::surface::Surface;
use nalgebra::Vector3;
use sweepsim_dexel::{Mesh, SurfaceEnd, SurfaceEnds};

/// How often faces that cannot be made are given up for triangles.
const ROUNDS: usize = 24;
/// Smaller faces are given up as a whole.
const SMALL: usize = 48;
/// The most faces.
const MOST_FACES: usize = 400_000;

/// What a solid is made with.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct SolidOptions {
    /// How far interval ends may be from the surfaces that made them.
    pub tolerance: f64,
    /// The distance of the dexels' lines.
    pub cell: f64,
}

impl SolidOptions {
    /// Options with these lengths.
    #[must_use]
    pub fn new(tolerance: f64, cell: f64) -> Self {
        Self { tolerance, cell }
    }
}

/// A face of a solid.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Face {
    /// What it is part of.
    pub surface: Surface,
    /// Whether distances from the surface grow out of the material.
    pub outward: bool,
    /// Where angles begin, and across that, and the axis or the normal.
    pub axes: [Vector3<f64>; 3],
    /// Edges with whether they are passed from start to end, counter-clockwise seen from outside: the outer loop first.
    pub loops: Vec<Vec<Use>>,
    /// Whether it is a triangle of the mesh, because its surface is not known.
    pub is_facet: bool,
    /// The least and the largest of both parameters.
    pub(crate) range: [[f64; 2]; 2],
}

/// A connected part of a solid.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Body {
    /// The faces around it.
    pub faces: Vec<u32>,
    /// The faces around each of its hollows.
    pub hollows: Vec<Vec<u32>>,
}

/// A boundary representation: every edge has two faces.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Solid {
    /// The vertices.
    pub vertices: Vec<Vector3<f64>>,
    /// The edges: those that no face uses are not part of the solid.
    pub edges: Vec<Option<Edge>>,
    /// The faces.
    pub faces: Vec<Face>,
    /// The bodies.
    pub bodies: Vec<Body>,
    /// What it is made of.
    pub summary: Summary,
}

impl Solid {
    /// The solid of a surface whose interval ends are on surfaces that `candidates` knows: all that the source of an
    /// end may have left, whether they pass through the end or not. It is asked once for all ends of a move, and for
    /// each end of the stock.
    ///
    /// # Errors
    /// [`SolidError`]: a mesh that is not closed, or more faces than a file could be used with.
    pub fn new(
        mesh: &Mesh,
        ends: &SurfaceEnds,
        candidates: &dyn Fn(&SurfaceEnd) -> Vec<Surface>,
        options: SolidOptions,
    ) -> Result<Self, SolidError> {
        for (what, value) in [("the tolerance", options.tolerance), ("the distance of lines", options.cell)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(SolidError::Length { what, value });
            }
        }
        let net = Net::new(mesh, ends)?;
        let size = size(mesh);
        let mut labels = labels(&net, candidates, options.tolerance, size);
        for round in 0..=ROUNDS {
            if round == ROUNDS {
                labels.of.iter_mut().for_each(|label| *label = FREE);
            }
            let groups = split(&net, &mut labels);
            if groups.count() > MOST_FACES {
                return Err(SolidError::TooManyFaces {
                    faces: groups.count(),
                    most: MOST_FACES,
                });
            }
            let chains = chains(&net, &groups, &labels, options.cell);
            let placed = place(&net, &groups, &labels, &chains, &options);
            let made = faces(&net, &groups, &labels, &chains, &placed, options.tolerance);
            if std::env::var("SDEBUG").is_ok() { // DEBUG
                let free: Vec<usize> = (0..labels.of.len()).filter(|k| labels.of[*k] == FREE).collect(); // DEBUG
                eprintln!("round {round}: free {} of {}, groups {}, failed vertices {}, failed triangles {}", free.len(), labels.of.len(), groups.count(), placed.failed.len(), made.failed.len()); // DEBUG
                for k in free.iter().step_by(free.len() / 12 + 1) { eprintln!("   {:?}", net.ends.ends[*k]); } // DEBUG
                for v in placed.failed.iter().take(8) { eprintln!("   failed {:?}", net.place(*v)); } // DEBUG
                for v in made.failed.iter().take(4) { eprintln!("   failed face {:?} {:?}", net.place(net.mesh.triangles[*v as usize][0]), labels.all.get(labels.of[net.end_of(*v as usize) as usize] as usize)); } // DEBUG
            } // DEBUG
            let given_up = give_up(&net, &groups, &mut labels, &placed, &made);
            if given_up == 0 || round == ROUNDS {
                return Ok(Self::of(&net, &groups, &labels, &chains, placed, made, options));
            }
        }
        Err(SolidError::Open)
    }

    fn of(
        net: &Net,
        groups: &Groups,
        labels: &Labels,
        chains: &Chains,
        placed: Placed,
        made: Faces,
        options: SolidOptions,
    ) -> Self {
        let summary = summary(net, groups, labels, chains, &placed, &made, options);
        Self {
            bodies: shells(net, groups, &made.of_group),
            vertices: placed.vertices,
            edges: placed.edges,
            faces: made.all,
            summary,
        }
    }
}

/// The diagonal of the box of a mesh.
fn size(mesh: &Mesh) -> f64 {
    let range = |k: usize| {
        let along = mesh.vertices.iter().map(|p| p[k]);
        along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
    };
    (0..3).map(|k| range(k).powi(2)).sum::<f64>().sqrt()
}

/// Takes the surface from ends around what could not be made, and says from how many.
fn give_up(net: &Net, groups: &Groups, labels: &mut Labels, placed: &Placed, made: &Faces) -> usize {
    let mut wrong = vec![false; net.mesh.vertices.len()];
    for vertex in &placed.failed {
        wrong[*vertex as usize] = true;
    }
    // Triangles that lost their area where their corners were moved onto surfaces: the mesh has it.
    for triangle in made.failed.iter().filter(|t| groups.is_free(groups.of[**t as usize] as usize)) {
        for vertex in net.mesh.triangles[*triangle as usize] {
            wrong[vertex as usize] = true;
        }
    }
    let mut given_up = 0;
    let mut free = |labels: &mut Labels, triangle: usize| {
        let label = &mut labels.of[net.end_of(triangle) as usize];
        given_up += usize::from(*label != FREE);
        *label = FREE;
    };
    for group in (0..groups.count()).filter(|group| !groups.is_free(*group)) {
        let triangles = groups.triangles(group);
        let at_fault = |t: u32| net.mesh.triangles[t as usize].iter().any(|v| wrong[*v as usize]);
        let faulty: Vec<u32> = triangles.iter().copied().filter(|t| at_fault(*t)).collect();
        if !faulty.is_empty() {
            let all = if triangles.len() <= SMALL { triangles } else { &faulty };
            all.iter().for_each(|t| free(labels, *t as usize));
        }
    }
    for triangle in &made.failed {
        free(labels, *triangle as usize);
    }
    given_up
}
