//! The solid: surfaces, edges, and faces between them.

use crate::edges::{Edge, Known, Placed, chains, place};
use crate::error::SolidError;
use crate::faces::{Faces, faces, shells};
use crate::label::{FREE, Groups, Labels, finer, labels, split};
use crate::net::Net;
use crate::parts::{Body, Face, SolidOptions};
use crate::summary::{Summary, summary};
use crate::surface::{Surface, TensorSpline};
use nalgebra::Vector3;
use std::borrow::Cow;
use sweepsim_dexel::{Mesh, SurfaceEnd, SurfaceEnds};

/// How often faces that cannot be made are given up for triangles.
const ROUNDS: usize = 40;
/// How often triangles beside curved faces are made finer: in all, and before edges are found anew.
const FINEST: usize = 48;
const AT_ONCE: usize = 12;
/// Smaller faces are given up as a whole.
const SMALL: usize = 48;
/// How far splines may be from what they are written for, in parts of the size of a tool's piece.
const SPLINE: f64 = 2.5e-7;
/// The most faces.
const MOST_FACES: usize = 400_000;

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
        for (what, value) in [
            ("the tolerance", options.tolerance),
            ("the distance of lines", options.cell),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(SolidError::Length { what, value });
            }
        }
        let mut net = Net::new(Cow::Borrowed(mesh), Cow::Borrowed(ends))?;
        let size = size(mesh);
        let mut labels = labels(&net, candidates, options.tolerance, size);
        let mut finest = 0;
        let mut known = Known::default();
        // The last two rounds are for triangles alone.
        for round in 0..ROUNDS + 2 {
            if round == ROUNDS {
                labels.of.iter_mut().for_each(|label| *label = FREE);
            }
            let groups = split(&net, &mut labels, options.cell);
            if groups.count() > MOST_FACES {
                return Err(SolidError::TooManyFaces {
                    faces: groups.count(),
                    most: MOST_FACES,
                });
            }
            let chains = chains(&net, &groups, &labels, options.cell);
            let mut placed = place(&net, &groups, &labels, &chains, &options, &mut known);
            let mut made = faces(&net, &groups, &labels, &chains, &mut placed, options);
            let given_up = give_up(&net, &groups, &mut labels, &placed, &made);
            if given_up > 0 && round < ROUNDS {
                continue;
            }
            let before = finest;
            while finest < FINEST
                && finest - before < AT_ONCE
                && round < ROUNDS
                && let Some((mesh, of_triangle)) = finer(&net, &labels, options.chord)
            {
                finest += 1;
                let mut ends = net.ends.into_owned();
                ends.of_triangle = of_triangle;
                net = Net::new(Cow::Owned(mesh), Cow::Owned(ends))?;
            }
            if finest > before {
                continue;
            }
            let rough = rough(&groups, &placed, &made, &options);
            if round < ROUNDS && free(&net, &mut labels, &rough) > 0 {
                continue;
            }
            let unfitted = fit(&groups, &mut made, &options);
            if round < ROUNDS && free(&net, &mut labels, &unfitted) > 0 {
                continue;
            }
            let open = open_edges(&placed, &made);
            if open == 0 {
                return Ok(Self::of(&net, &groups, &labels, placed, made));
            }
            if labels.of.iter().all(|label| *label == FREE) {
                return Err(SolidError::Unclosed { edges: open });
            }
            labels.of.iter_mut().for_each(|label| *label = FREE);
        }
        Err(SolidError::Open)
    }

    fn of(net: &Net, groups: &Groups, labels: &Labels, placed: Placed, made: Faces) -> Self {
        let summary = summary(net, groups, labels, &placed, &made);
        Self {
            bodies: shells(net, groups, &made.of_group),
            vertices: placed.vertices,
            edges: placed.edges,
            faces: made.all,
            summary,
        }
    }
}

/// Takes the surface from triangles, and says from how many ends.
fn free(net: &Net, labels: &mut Labels, triangles: &[u32]) -> usize {
    let mut freed = 0;
    for triangle in triangles {
        let label = &mut labels.of[net.end_of(*triangle as usize) as usize];
        freed += usize::from(*label != FREE);
        *label = FREE;
    }
    freed
}

/// The triangles of faces with an edge that is farther from them than readers take.
fn rough(groups: &Groups, placed: &Placed, made: &Faces, options: &SolidOptions) -> Vec<u32> {
    let is_rough = |group: &usize| {
        let Some(face) = made.of(*group).first() else {
            return false;
        };
        let edges = face.loops.iter().flatten();
        let mut edges = edges.filter_map(|(edge, _)| placed.edges[*edge as usize].as_ref());
        let off = |p: Vector3<f64>| face.surface.off(p) > 2.0 * options.chord;
        edges.any(|edge| (0..=8).any(|k| off(edge.at(f64::from(k) / 8.0))))
    };
    let surfaces = (0..groups.count()).filter(|group| !groups.is_free(*group));
    surfaces
        .filter(is_rough)
        .flat_map(|group| groups.triangles(group))
        .copied()
        .collect()
}

/// Finds splines for swept faces, and gives the triangles of those for which there are none.
fn fit(groups: &Groups, made: &mut Faces, options: &SolidOptions) -> Vec<u32> {
    let mut failed = Vec::new();
    for group in 0..made.of_group.len() {
        for number in made.of_group[group].clone() {
            let face = &mut made.all[number as usize];
            let Surface::Swept(sheet) = &face.surface else { continue };
            let limit = (0.1 * options.tolerance).max(SPLINE * sheet.scale()[0]);
            face.spline = TensorSpline::new(sheet, face.range, limit);
            if face.spline.is_none() {
                failed.extend(groups.triangles(group));
            }
        }
    }
    failed
}

/// How many edges are not passed once each way.
fn open_edges(placed: &Placed, made: &Faces) -> usize {
    let mut uses = vec![[0_usize; 2]; placed.edges.len()];
    for (edge, forward) in made.all.iter().flat_map(|face| face.loops.iter().flatten()) {
        uses[*edge as usize][usize::from(*forward)] += 1;
    }
    uses.iter().filter(|uses| !matches!(uses, [0, 0] | [1, 1])).count()
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
    for triangle in made
        .failed
        .iter()
        .filter(|t| groups.is_free(groups.of[**t as usize] as usize))
    {
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
