//! The outputs of a run but for its report: dexels, mesh, picture.

use super::compute::{Computed, Part};
use super::shard::along_three_axes;
use crate::base::{JobError, Sink, words};
use crate::request::Output;
use crate::session::{self, Session, TriSolid, phase};
use crate::show::{decimated, picture, share};
use std::borrow::Cow;
use sweepsim_dexel::{Mesh, TriDexels};
use sweepsim_formats::{Report, write_dexels_binary, write_dexels_csv, write_ply, write_tri_dexels};

pub(super) fn write_dexels(
    done: &Computed,
    session: Session,
    outputs: &[Output],
    sink: &mut dyn Sink,
    report: &mut Report,
) -> Result<(), JobError> {
    if outputs.contains(&Output::Dexels) {
        session.phase("dexels");
        phase(report, "dexels", || {
            sink.write("dexels.csv", &mut |file| write_dexels_csv(done.dexels(), file))
        })?;
    }
    if outputs.contains(&Output::Binary) {
        session.phase("dexels");
        phase(report, "dexels", || {
            sink.write("part.dexels", &mut |file| write_dexels_binary(done.dexels(), file))
        })?;
    }
    Ok(())
}

/// The result along three axes, if the job has one: as it is known, or simulated.
pub(super) fn solid<'a>(
    session: Session,
    done: &'a Computed,
    report: &mut Report,
) -> Result<Option<Cow<'a, TriSolid>>, JobError> {
    let made = match &done.part {
        Part::Solid(known) => Cow::Borrowed(known),
        Part::AlongZ(_) if done.stopped => {
            let why =
                "the program was followed to its first finding, along z: mesh and picture are of these dexels alone";
            report.notes.push(why.to_owned());
            return Ok(None);
        }
        Part::AlongZ(dexels) => {
            let heights = session::heights(session.request.task, session.job, dexels);
            let aside = along_three_axes(session, heights).unwrap_or_else(|note| {
                report.notes.push(note);
                false
            });
            if !aside {
                return Ok(None);
            }
            Cow::Owned(session::solid(session, dexels, report)?)
        }
    };
    if made.uncertified > 0 {
        let lines = words::counted(made.uncertified as u64, "dexel");
        report.notes.push(format!(
            "{lines} along x or y could not be certified: the surface may be wrong there"
        ));
    }
    Ok(Some(made))
}

pub(super) fn write_tri(
    solid: &TriDexels,
    session: Session,
    sink: &mut dyn Sink,
    report: &mut Report,
) -> Result<(), JobError> {
    session.phase("dexels");
    phase(report, "dexels", || {
        sink.write("part.tridexels", &mut |file| write_tri_dexels(solid, file))
    })
}

/// The surface of the result.
pub(super) fn mesh(
    solid: Option<&TriSolid>,
    session: Session,
    done: &Computed,
    report: &mut Report,
) -> Result<Mesh, JobError> {
    if let Some(own) = solid {
        return session::surface(&own.solid, session, report);
    }
    session.phase("mesh");
    Ok(phase(report, "mesh", || done.dexels().surface())?)
}

/// Writes the mesh and the picture, and returns the latter.
pub(super) fn write_mesh(
    mesh: &Mesh,
    session: Session,
    outputs: &[Output],
    sink: &mut dyn Sink,
    report: &mut Report,
) -> Result<Option<Vec<u8>>, JobError> {
    if outputs.contains(&Output::Mesh) {
        let note = phase(report, "mesh", || {
            let (written, note) = decimated(mesh, session.request.decimate)?;
            sink.write("part.ply", &mut |file| write_ply(&written, file))?;
            Ok::<_, JobError>(note)
        })?;
        report.warnings.extend(note);
    }
    if !outputs.contains(&Output::Picture) {
        return Ok(None);
    }
    session.phase("picture");
    let (png, missed) = phase(report, "picture", || {
        let go_on = share(session.monitor, |part| part);
        let (png, missed) = picture(&session.request.view, mesh, None, &go_on)?;
        sink.write("part.png", &mut |file| file.write_all(&png))?;
        Ok::<_, JobError>((png, missed))
    })?;
    report.warnings.extend(missed);
    Ok(Some(png))
}
