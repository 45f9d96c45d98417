//! The paper's Figures 8 to 10: tools and what they sweep; and its Figures 1 and 3: envelopes with their curves and sections.

use super::sheet;
use super::tubes::Coloured;
use crate::bench::{Cutter, cutter};
use nalgebra::Vector3;
use sweepsim::systems::Plane;
use sweepsim::{BoundaryPiece, Cut, Options, envelope_surfaces, section, sweep_all};
use sweepsim_dexel::{Mesh, TriDexels};
use sweepsim_motion::{Path, Pose};
use sweepsim_picture::{Axis, CuttingPlane, Drawing, Image, View};

type Make = fn() -> Result<Image, String>;

/// The figures, by the names of their files.
pub const FIGURES: [(&str, Make); 4] = [
    ("figure-8", || figure("ball")),
    ("figure-9", || figure("flat")),
    ("figure-10", || figure("form")),
    ("envelopes", envelopes),
];

/// Pixels of a panel.
const PANEL: [usize; 2] = [480, 450];
/// Dexels along the longest side of a panel's solid.
const CELLS: f64 = 260.0;
/// Cosine of 40°: sharper edges are drawn sharp.
const CRISP: f64 = 0.766;
/// The deviation of surfaces and curves, in mm.
const CHORD: f64 = 0.08;
/// Half the width of a curve, in mm.
const PEN: f64 = 0.22;

fn said(error: impl std::fmt::Display) -> String {
    error.to_string()
}

fn view() -> View {
    let mut view = View::default();
    view.size = PANEL;
    view.axes = false;
    view
}

/// The tool, and what it sweeps along Sweep1 and Sweep2.
fn figure(name: &str) -> Result<Image, String> {
    let cutter = cutter(name)?;
    let tool = Path::new(vec![Pose::new([0.0; 3], [0.0, 0.0, 1.0]).map_err(said)?]).map_err(said)?;
    let at_rest = swept(&cutter, &tool)?;
    let mut panels = vec![view().draw(&Drawing::new(&Mesh::default()).tool(&at_rest))];
    for which in 0..2 {
        panels.push(view().render(&swept(&cutter, &cutter.path(which)?)?));
    }
    sheet(&panels, 3)
}

/// The surface of what a tool sweeps, from dexels along three axes.
fn swept(cutter: &Cutter, path: &Path) -> Result<Mesh, String> {
    let cuts = [Cut::new(cutter.tool(), path)];
    let (min, max) = cutter.bounds(path);
    let size = [0, 1, 2].map(|k| max[k] - min[k]);
    let step = size.into_iter().fold(0.0, f64::max) / CELLS;
    let cells = size.map(|s| (s / step).ceil() as usize);
    let mut sets = TriDexels::empty(min, max, cells).map_err(said)?.into_sets();
    for set in &mut sets {
        let done = sweep_all(&cuts, set.grid(), &Options::new(1e-6), &()).map_err(said)?;
        if !done.statistics.unresolved.is_empty() {
            return Err(format!("{} unresolved dexels", done.statistics.unresolved.len()));
        }
        *set = done.volume;
    }
    let solid = TriDexels::from_sets(sets).map_err(said)?;
    solid.surface().and_then(|mesh| mesh.crisp(CRISP)).map_err(said)
}

/// The envelopes of ball and flat end along Sweep2, cut open by a plane: patches blue, edges red, the first and the last placement pale. The section is
/// dark where it bounds the volume, and red where it does not.
fn envelopes() -> Result<Image, String> {
    let panels: Result<Vec<Image>, String> = ["ball", "flat"].iter().map(|name| envelope(name)).collect();
    sheet(&panels?, 2)
}

fn envelope(name: &str) -> Result<Image, String> {
    let cutter = cutter(name)?;
    let path = cutter.path(1)?;
    let cuts = [Cut::new(cutter.tool(), &path)];
    let options = Options::new(1e-6);
    let at = -1.0;
    let found = envelope_surfaces(&cuts, CHORD, &options, &()).map_err(said)?;
    if let Some((_, piece, _)) = found.open.first() {
        return Err(format!("the envelope lacks parts of {piece:?}"));
    }
    let mut drawn = Coloured::default();
    for surface in &found.surfaces {
        let value = match surface.piece {
            BoundaryPiece::Patch(_) => -0.55,
            BoundaryPiece::Edge(_) => 0.6,
            _ => 0.0,
        };
        // What lies inside the volume shows its section only.
        let outer = |t: &&[u32; 3]| t.iter().any(|v| surface.outer[*v as usize]);
        let triangles: Vec<[u32; 3]> = surface.triangles.iter().filter(outer).copied().collect();
        let points = surface.vertices.iter().map(|point| (point.position, point.normal));
        drawn.surface(points, &triangles, value);
    }
    let cut = section(&cuts, &Plane::y(at).map_err(said)?, CHORD, &options, &()).map_err(said)?;
    // Behind the plane, since all in front of it is removed.
    let behind = |p: [f64; 3]| (Vector3::from(p) + Vector3::y() * (1.02 * PEN)).into();
    for curve in &cut.curves {
        let marked: Vec<([f64; 3], bool)> = curve
            .points
            .iter()
            .zip(&curve.outer)
            .map(|(point, outer)| (behind(point.position), *outer))
            .collect();
        for run in marked.chunk_by(|a, b| a.1 == b.1) {
            let points: Vec<[f64; 3]> = run.iter().map(|(place, _)| *place).collect();
            let (pen, value) = if run[0].1 { (PEN, f32::NAN) } else { (0.6 * PEN, 1.0) };
            drawn.tube(&points, pen, value);
        }
    }
    let sections = [CuttingPlane { axis: Axis::Y, at }];
    let drawing = Drawing::new(&drawn.mesh).values(&drawn.values, 1.0).sections(&sections);
    Ok(view().draw(&drawing))
}
