//! The envelope as a surface, of `sweep --method surface`.

use crate::commands::summary::NAMED;
use crate::session::{Failure, JobSession, phase};
use sweepsim::{Monitor, Options, envelope_surfaces};
use sweepsim_dexel::Mesh;
use sweepsim_formats::{Report, write_ply};

/// The largest deviation of the triangles of envelope.ply, in millimetres.
const CHORD: f64 = 0.02;

/// Writes the whole envelope, and the part of it that bounds the swept volume.
pub(super) fn write(session: &mut JobSession, report: &mut Report) -> Result<(), Failure> {
    session.progress.phase("envelope");
    let options = Options::new(session.job.tolerance);
    let monitor = &session.progress as &dyn Monitor;
    let made = phase(report, "envelope", || {
        envelope_surfaces(&session.cuts(), CHORD, &options, monitor)
    });
    let surfaces = made.map_err(|error| session.failed(error))?;
    for (name, trimmed) in [("envelope.ply", false), ("envelope-outer.ply", true)] {
        let (points, triangles) = surfaces.triangles(trimmed);
        let mesh = Mesh {
            vertices: points.iter().map(|point| point.position).collect(),
            normals: points.iter().map(|point| point.normal.map(|x| x as f32)).collect(),
            cut: vec![true; points.len()],
            triangles,
        };
        session.outputs.write(name, |file| write_ply(&mesh, file))?;
    }
    for (path, piece, number) in surfaces.open.iter().take(NAMED) {
        report.notes.push(format!(
            "envelope.ply lacks parts of {piece:?} of move {number} of path {path}"
        ));
    }
    Ok(())
}
