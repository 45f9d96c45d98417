//! The envelope as surfaces: the paper's Algorithm 1, before intersecting with lines.

use crate::cutter::Cutter;
use crate::envelope::systems::PatchMotion;
use crate::error::SweepError;
use crate::sections::boundary_piece::{BoundaryPiece, BoundaryPoint, Moving};
use crate::sections::section::{outer, stretch};
use crate::sweep::{Cut, Options, Plan};
use crate::time::path_parts::PathPart;
use crate::tolerances::{ChordTolerance, Tolerances};
use nalgebra::Vector3;
use rayon::prelude::*;
use std::collections::HashMap;
use sweepsim_dexel::Frame;
use sweepsim_motion::Tool;
use sweepsim_solve::{CancelOnly, Monitor, SurfaceSolver};

/// One piece of an envelope as triangles.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct EnvelopeSurface {
    /// Number of the cut.
    pub cut: usize,
    /// The origin of the piece.
    pub piece: BoundaryPiece,
    /// Number of the move.
    pub segment: u32,
    /// Points of the surface.
    pub vertices: Vec<BoundaryPoint>,
    /// Counter-clockwise seen from outside the tool.
    pub triangles: Vec<[u32; 3]>,
    /// For each vertex, whether it bounds the swept volume, that is, no other part of any sweep covers it.
    pub outer: Vec<bool>,
}

/// The envelope of one or more sweeps, with their kinks and caps.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct EnvelopeSurfaces {
    /// All pieces, including those inside the volume.
    pub surfaces: Vec<EnvelopeSurface>,
    /// Pieces whose surface is not certified everywhere, with the numbers of their cut and move.
    pub open: Vec<(usize, BoundaryPiece, u32)>,
}

impl EnvelopeSurfaces {
    /// Positions, normals and triangles of all pieces in one list; of the `trimmed` envelope only the triangles all of whose corners bound the
    /// volume.
    #[must_use]
    pub fn triangles(&self, trimmed: bool) -> (Vec<BoundaryPoint>, Vec<[u32; 3]>) {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for surface in &self.surfaces {
            let first = vertices.len() as u32;
            vertices.extend_from_slice(&surface.vertices);
            let wanted = |t: &&[u32; 3]| !trimmed || t.iter().all(|v| surface.outer[*v as usize]);
            triangles.extend(surface.triangles.iter().filter(wanted).map(|t| t.map(|v| first + v)));
        }
        (vertices, triangles)
    }
}

/// The budget of boxes for one surface.
const BOXES: u64 = 200_000;
/// The maximum number of grid steps over an edge or a placed patch, in each direction.
const STEPS: usize = 128;

/// The envelope of the cuts, as triangles that are within about `chord` of it.
///
/// The mesh of a patch's envelope (Eq. 2) is guaranteed to have the topology of the surface in its parameters `u, v, t`. Edges and placed patches are given by
/// their parameters; they are trimmed where a condition changes sign, which is tested on a grid.
///
/// # Errors
/// [`SweepError`]: cancelled, or an invalid tolerance or chord error.
pub fn envelope_surfaces(
    cuts: &[Cut],
    chord: f64,
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<EnvelopeSurfaces, SweepError> {
    let chord = ChordTolerance::new(chord)?;
    let mut all = EnvelopeSurfaces::default();
    for (number, Cut { tool, path }) in cuts.iter().enumerate() {
        let plan = Plan::new(tool, path, &Frame::WORLD, std::iter::empty(), options)?;
        let found: Vec<EnvelopeSurfaces> = (0..plan.parts.len())
            .into_par_iter()
            .with_max_len(1)
            .map(|at| {
                if monitor.cancelled() {
                    return EnvelopeSurfaces::default();
                }
                of_part((tool, number), &plan.cutter, (&plan.parts, at), chord, monitor)
            })
            .collect();
        if monitor.cancelled() {
            return Err(SweepError::Cancelled);
        }
        for part in found {
            all.surfaces.extend(part.surfaces);
            all.open.extend(part.open);
        }
    }
    let off = Tolerances::new(options.tolerance, 0.0)?.outside();
    let vertices = all.surfaces.iter().flat_map(|surface| &surface.vertices);
    let points: Vec<(&BoundaryPoint, f64)> = vertices.map(|point| (point, off)).collect();
    let mut outer = outer(cuts, &points, options, monitor)?.into_iter();
    for surface in &mut all.surfaces {
        surface.outer = outer.by_ref().take(surface.vertices.len()).collect();
    }
    Ok(all)
}

fn of_part(
    (tool, cut): (&Tool, usize),
    cutter: &Cutter,
    (parts, at): (&[PathPart], usize),
    chord: ChordTolerance,
    monitor: &dyn Monitor,
) -> EnvelopeSurfaces {
    let moving = Moving::new(&cutter.patches, &cutter.edges, parts, at);
    let segment = &parts[at].segment;
    let speed = moving.speed(cutter.reach);
    let mut all = EnvelopeSurfaces::default();
    for piece in moving.pieces(tool) {
        if monitor.cancelled() {
            break;
        }
        let (vertices, mut triangles) = match piece {
            BoundaryPiece::Patch(k) => {
                let patch = &tool.patches()[k];
                let fastest = stretch(patch.position(), patch.weight()).max(speed);
                let options = SurfaceSolver::new(0.1).options.boxes(BOXES).unresolved(64);
                let flatness = chord.of_surface(fastest);
                let surface = PatchMotion::new(patch, segment).envelope().ok().and_then(|system| {
                    SurfaceSolver::with_options(flatness, options)
                        .solve(&system, &CancelOnly(monitor))
                        .ok()
                });
                let Some(surface) = surface else {
                    all.open.push((cut, piece, parts[at].number));
                    continue;
                };
                if !surface.unresolved.is_empty() {
                    all.open.push((cut, piece, parts[at].number));
                }
                let points = surface.vertices.iter().map(|x| moving.see(piece, x).point).collect();
                (points, surface.triangles)
            }
            _ => by_grid(&moving, piece, chord),
        };
        if triangles.is_empty() {
            continue;
        }
        orient(&vertices, &mut triangles);
        all.surfaces.push(EnvelopeSurface {
            cut,
            piece,
            segment: parts[at].number,
            vertices,
            triangles,
            outer: Vec::new(),
        });
    }
    all
}

/// Turns triangles that face inwards.
fn orient(vertices: &[BoundaryPoint], triangles: &mut [[u32; 3]]) {
    for triangle in triangles {
        let [a, b, c] = triangle.map(|v| &vertices[v as usize]);
        let p = [a, b, c].map(|v| Vector3::from(v.position));
        let normal = [a, b, c].map(|v| Vector3::from(v.normal)).iter().sum::<Vector3<f64>>();
        if (p[1] - p[0]).cross(&(p[2] - p[0])).dot(&normal) < 0.0 {
            triangle.swap(1, 2);
        }
    }
}

/// The part of a piece with two parameters that belongs to the boundary of its move, over a grid.
fn by_grid(moving: &Moving, piece: BoundaryPiece, chord: ChordTolerance) -> (Vec<BoundaryPoint>, Vec<[u32; 3]>) {
    let place = |x: [f64; 2]| Vector3::from(moving.see(piece, &x).point.position);
    // Steps in each direction: enough to keep the midpoints of steps within half the chord error, on a few lines.
    let steps = [0, 1].map(|axis| {
        let mut steps = 4;
        let at = |along: f64, across: f64| if axis == 0 { [along, across] } else { [across, along] };
        while steps < STEPS {
            let width = 1.0 / steps as f64;
            let off = (0..steps).flat_map(|k| [0.1, 0.5, 0.9].map(|across| (k as f64 * width, across)));
            let off = off.map(|(start, across)| {
                let [a, m, b] = [0.0, 0.5, 1.0].map(|part| place(at(start + part * width, across)));
                (m - 0.5 * (a + b)).norm()
            });
            if off.fold(0.0, f64::max) <= chord.of_step() {
                break;
            }
            steps *= 2;
        }
        steps
    });
    let corner = |n: usize| {
        let (i, j) = (n % (steps[0] + 1), n / (steps[0] + 1));
        [i as f64 / steps[0] as f64, j as f64 / steps[1] as f64]
    };
    // Positive where the piece belongs to the boundary.
    let belongs = |x: &[f64; 2]| moving.see(piece, x).sides.is_none_or(|[a, b]| (a < 0.0) != (b < 0.0));
    let count = (steps[0] + 1) * (steps[1] + 1);
    let inside: Vec<bool> = (0..count).map(|n| belongs(&corner(n))).collect();
    if !inside.contains(&true) {
        return (Vec::new(), Vec::new());
    }
    let mut mesh = Clipped {
        vertices: Vec::new(),
        corners: HashMap::new(),
        cuts: HashMap::new(),
    };
    let mut triangles = Vec::new();
    for j in 0..steps[1] {
        for i in 0..steps[0] {
            let n = i + (steps[0] + 1) * j;
            let quad = [n, n + 1, n + steps[0] + 2, n + steps[0] + 1];
            for triangle in [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]] {
                let mut polygon: Vec<u32> = Vec::with_capacity(4);
                for k in 0..3 {
                    let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
                    if inside[a] {
                        polygon.push(mesh.corner(a, || moving.see(piece, &corner(a)).point));
                    }
                    if inside[a] != inside[b] {
                        polygon.push(mesh.cut(a, b, || {
                            let (mut from, mut to) = if inside[a] {
                                (corner(a), corner(b))
                            } else {
                                (corner(b), corner(a))
                            };
                            for _ in 0..40 {
                                let middle = [0, 1].map(|k| 0.5 * (from[k] + to[k]));
                                if belongs(&middle) {
                                    from = middle;
                                } else {
                                    to = middle;
                                }
                            }
                            moving.see(piece, &from).point
                        }));
                    }
                }
                for k in 2..polygon.len() {
                    triangles.push([polygon[0], polygon[k - 1], polygon[k]]);
                }
            }
        }
    }
    (mesh.vertices, triangles)
}

/// Vertices shared by triangles: corners of the grid, and points where its edges are trimmed.
struct Clipped {
    vertices: Vec<BoundaryPoint>,
    corners: HashMap<usize, u32>,
    cuts: HashMap<(usize, usize), u32>,
}

impl Clipped {
    fn corner(&mut self, n: usize, point: impl FnOnce() -> BoundaryPoint) -> u32 {
        let vertices = &mut self.vertices;
        *self.corners.entry(n).or_insert_with(|| push(vertices, point()))
    }

    fn cut(&mut self, a: usize, b: usize, point: impl FnOnce() -> BoundaryPoint) -> u32 {
        let vertices = &mut self.vertices;
        *self
            .cuts
            .entry((a.min(b), a.max(b)))
            .or_insert_with(|| push(vertices, point()))
    }
}

fn push(vertices: &mut Vec<BoundaryPoint>, point: BoundaryPoint) -> u32 {
    vertices.push(point);
    vertices.len() as u32 - 1
}
