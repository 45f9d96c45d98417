//! The part as a solid: surfaces that moves leave, and what is said of the result.

mod moves;
mod stock;
mod surfaces;

use crate::base::words::{counted, length};
use crate::base::{JobError, Sink};
use crate::session::{Session, phase};
use moves::{Piece, left_by, pieces};
use std::collections::BTreeMap;
use stock::StockSurfaces;
use sweepsim_dexel::{Source, SurfaceEnd, TriDexels};
use sweepsim_formats::Report;
use sweepsim_solid::{Solid, SolidOptions, StepHeader, Summary, Surface, write_step};

/// Kinds of faces with their plurals, in the order in which they are counted.
const KINDS: [(&str, &str); 7] = [
    ("plane", "planes"),
    ("cylinder", "cylinders"),
    ("cone", "cones"),
    ("sphere", "spheres"),
    ("torus", "tori"),
    ("sheet", "ruled sheets"),
    ("facet", "triangles"),
];

/// Writes `part.step`.
pub(super) fn write(
    solid: &TriDexels,
    session: Session,
    sink: &mut dyn Sink,
    report: &mut Report,
) -> Result<(), JobError> {
    session.phase("solid");
    let made = phase(report, "solid", || of(solid, session))?;
    let header = StepHeader {
        name: session.job.name.clone(),
        program: format!("sweepsim {}", env!("CARGO_PKG_VERSION")),
        uncertainty: made.summary.gap.max(session.job.tolerance),
    };
    sink.write("part.step", &mut |file| write_step(&made, &header, file))?;
    report.notes.push(in_words(&made));
    Ok(())
}

/// The solid of dexels along three axes.
fn of(solid: &TriDexels, session: Session) -> Result<Solid, JobError> {
    let failed = |error: &dyn std::fmt::Display| JobError::run(format!("part.step: {error}"));
    let (mesh, ends) = solid.surface_with_ends()?;
    let job = session.job;
    let stock = StockSurfaces::new(&job.stock, [solid.min(), solid.max()]);
    let tools: BTreeMap<u32, Vec<Piece>> = job.tools.iter().map(|(number, tool)| (*number, pieces(tool))).collect();
    let candidates = |end: &SurfaceEnd| -> Vec<Surface> {
        match end.source {
            Source::Stock => stock.near(end),
            Source::Cut { path, segment, .. } => {
                let Some(path) = job.paths.get(path as usize) else {
                    return Vec::new();
                };
                tools.get(&path.tool).map_or(Vec::new(), |tool| left_by(tool, &path.path, segment as usize))
            }
        }
    };
    let cells = solid.cells();
    let cell = (0..3).map(|k| (solid.max()[k] - solid.min()[k]) / cells[k] as f64);
    let options = SolidOptions::new(job.tolerance, cell.fold(0.0, f64::max));
    Solid::new(&mesh, &ends, &candidates, options).map_err(|error| failed(&error))
}

/// What is said of a solid.
fn in_words(solid: &Solid) -> String {
    let summary = &solid.summary;
    let parts: Vec<String> = KINDS
        .iter()
        .filter_map(|(kind, plural)| {
            let count = *summary.faces.get(kind)?;
            let name = if count == 1 { plural_of_one(plural, kind) } else { plural };
            Some(format!("{count} {name}"))
        })
        .collect();
    let bodies = counted(solid.bodies.len() as u64, "body").replace("bodys", "bodies");
    let faces = counted(solid.faces.len() as u64, "face");
    format!(
        "part.step, in millimetres: {bodies} of {faces}: {}. {}",
        parts.join(", "),
        shares(summary)
    )
}

fn plural_of_one<'a>(plural: &'a str, kind: &'a str) -> &'a str {
    match kind {
        "sheet" => "ruled sheet",
        "facet" => "triangle",
        _ if plural.is_empty() => plural,
        _ => kind,
    }
}

fn shares(summary: &Summary) -> String {
    let mut text = format!(
        "Dexels end within {} mm of the surfaces, which meet within {} mm at edges",
        length(summary.deviation),
        length(summary.gap)
    );
    if summary.faces.contains_key("facet") {
        let share = 100.0 * (1.0 - summary.share());
        text += &format!(
            "; {share:.2} % of the area is triangles, up to {} mm from the ends of dexels: what the moves leave there is not known as a surface, or is finer than the dexels",
            length(summary.facet_deviation)
        );
    }
    text
}
