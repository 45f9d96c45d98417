//! The envelope as a surface, of `sweep --method surface`.

use crate::base::{JobError, Sink};
use crate::session::{Session, phase};
use sweepsim::{Options, envelope_surfaces};
use sweepsim_dexel::Mesh;
use sweepsim_formats::{Report, write_ply};

/// The largest deviation of the triangles of envelope.ply, in millimetres.
const CHORD: f64 = 0.02;
/// The most missing pieces of the envelope that are named.
const NAMED: usize = 10;

/// Writes the whole envelope, and the part of it that bounds the swept volume.
pub(super) fn write(session: Session, sink: &mut dyn Sink, report: &mut Report) -> Result<(), JobError> {
    session.phase("envelope");
    let options = Options::new(session.job.tolerance);
    let made = phase(report, "envelope", || {
        envelope_surfaces(&session.cuts(), CHORD, &options, session.monitor)
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
        sink.write(name, &mut |file| write_ply(&mesh, file))?;
    }
    for (path, piece, number) in surfaces.open.iter().take(NAMED) {
        report.notes.push(format!(
            "envelope.ply lacks parts of {piece:?} of move {number} of path {path}"
        ));
    }
    Ok(())
}
