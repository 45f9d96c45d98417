//! The part as a solid: surfaces that moves leave, and what is said of the result.

mod moves;
mod stock;
mod surfaces;
mod swept;

use crate::base::words::count as numbered;
use crate::base::{JobError, Sink};
use crate::session::{Session, phase};
use moves::{left_by, pieces};
use std::collections::BTreeMap;
use stock::StockSurfaces;
use surfaces::Piece;
use sweepsim_dexel::{Source, SurfaceEnd, TriDexels};
use sweepsim_formats::Report;
use sweepsim_solid::{Solid, SolidOptions, StepHeader, Summary, Surface, write_step};

/// How far edges of triangles may be from the curved faces beside them, in millimetres: half of what readers take.
const CHORD: f64 = 5e-4;
/// Kinds of faces with one of them and several, in the order in which they are counted.
const KINDS: [(&str, &str, &str); 8] = [
    ("plane", "plane", "planes"),
    ("cylinder", "cylinder", "cylinders"),
    ("cone", "cone", "cones"),
    ("sphere", "sphere", "spheres"),
    ("torus", "torus", "tori"),
    ("sheet", "ruled sheet", "ruled sheets"),
    ("spline", "B-spline", "B-splines"),
    ("facet", "triangle", "triangles"),
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
                tools
                    .get(&path.tool)
                    .map_or(Vec::new(), |tool| left_by(tool, &path.path, segment as usize))
            }
        }
    };
    let cells = solid.cells();
    let cell = (0..3).map(|k| (solid.max()[k] - solid.min()[k]) / cells[k] as f64);
    let options = SolidOptions::new(job.tolerance, cell.fold(0.0, f64::max)).with_chord(CHORD);
    Solid::new(&mesh, &ends, &candidates, options).map_err(|error| failed(&error))
}

/// What is said of a solid.
fn in_words(solid: &Solid) -> String {
    let summary = &solid.summary;
    let parts: Vec<String> = KINDS
        .iter()
        .filter_map(|(kind, one, more)| {
            let count = *summary.faces.get(kind)?;
            Some(format!(
                "{} {}",
                numbered(count as u64),
                if count == 1 { one } else { more }
            ))
        })
        .collect();
    let bodies = match solid.bodies.len() {
        1 => "one body".to_owned(),
        several => format!("{} bodies", numbered(several as u64)),
    };
    format!(
        "part.step, in millimetres: {bodies} of {}. {}",
        parts.join(", "),
        distances(summary)
    )
}

fn distances(summary: &Summary) -> String {
    let mut text = format!(
        "Dexels end within {} mm of these surfaces, and edges are within {} mm of them",
        at_most(summary.deviation + summary.spline),
        at_most(summary.gap + summary.spline)
    );
    if summary.faces.contains_key("facet") {
        let share = 100.0 * (1.0 - summary.share());
        text += &format!(
            "; triangles are {share:.2} % of the area, within {} mm of the ends of dexels: what moves leave there is not known as a surface, or finer than the dexels",
            at_most(summary.facet_deviation)
        );
    }
    text
}

/// A length rounded up to one digit, a nanometre at least.
fn at_most(value: f64) -> String {
    let value = value.max(1e-6);
    let power = value.log10().floor();
    let digits = (value / 10f64.powf(power) - 1e-9).ceil();
    let decimals = (-power).max(0.0) as usize;
    format!("{:.decimals$}", digits * 10f64.powf(power))
}

#[cfg(test)]
mod tests {
    use super::at_most;

    #[test]
    fn lengths_are_rounded_up() {
        assert_eq!(at_most(0.0), "0.000001");
        assert_eq!(at_most(0.0071), "0.008");
        assert_eq!(at_most(0.03), "0.03");
        assert_eq!(at_most(0.97), "1.0");
        assert_eq!(at_most(12.3), "20");
    }
}
