//! The outputs of a run but for its report: dexels, mesh, picture.

use super::{Outcome, along_three_axes};
use crate::arguments::{Output, RunOptions};
use crate::commands::task::Task;
use crate::commands::tri_surface;
use crate::session::{Failure, JobSession, decimated, phase, picture, words};
use crate::shards::Gathered;
use std::io::Write as _;
use sweepsim_dexel::{Mesh, TriDexels};
use sweepsim_formats::{Report, write_dexels_binary, write_dexels_csv, write_ply, write_tri_dexels};

pub(super) fn write_dexels(outcome: &Outcome, session: &mut JobSession, report: &mut Report) -> Result<(), Failure> {
    let JobSession { outputs, progress, .. } = session;
    if outputs.wants(Output::Dexels) {
        progress.phase("dexels");
        phase(report, "dexels", || {
            outputs.write("dexels.csv", |file| write_dexels_csv(&outcome.dexels, file))
        })?;
    }
    if outputs.wants(Output::Binary) {
        progress.phase("dexels");
        phase(report, "dexels", || {
            outputs.write("part.dexels", |file| write_dexels_binary(&outcome.dexels, file))
        })?;
    }
    Ok(())
}

/// The result along three axes, if it is wanted.
pub(super) fn solid(
    task: Task,
    session: &JobSession,
    options: &RunOptions,
    outcome: &mut Outcome,
    report: &mut Report,
) -> Result<Option<TriDexels>, Failure> {
    let heights = tri_surface::heights(task, &session.job, &outcome.dexels);
    let aside = along_three_axes(&session.job, options, heights).unwrap_or_else(|note| {
        report.notes.push(note);
        false
    });
    if !aside {
        return Ok(None);
    }
    let made = match <[Gathered; 2]>::try_from(std::mem::take(&mut outcome.aside)) {
        Ok(aside) => {
            let uncertified = aside.iter().map(|set| set.unresolved.len()).sum();
            let [along_x, along_y] = aside.map(|set| set.dexels);
            let solid = tri_surface::joined([along_x, along_y, outcome.dexels.clone()])?;
            tri_surface::TriSolid { solid, uncertified }
        }
        Err(_) => tri_surface::solid(task, session, options, &outcome.dexels, report)?,
    };
    outcome.uncertified += made.uncertified;
    if made.uncertified > 0 {
        let lines = words::counted(made.uncertified as u64, "dexel");
        report.notes.push(format!(
            "{lines} along x or y could not be certified: the mesh may be wrong there"
        ));
    }
    Ok(Some(made.solid))
}

pub(super) fn write_tri(solid: &TriDexels, session: &mut JobSession, report: &mut Report) -> Result<(), Failure> {
    let JobSession { outputs, progress, .. } = session;
    progress.phase("dexels");
    phase(report, "dexels", || {
        outputs.write("part.tridexels", |file| write_tri_dexels(solid, file))
    })
}

/// The surface of the result.
pub(super) fn mesh(
    solid: Option<&TriDexels>,
    session: &JobSession,
    outcome: &Outcome,
    report: &mut Report,
) -> Result<Mesh, Failure> {
    if let Some(solid) = solid {
        return tri_surface::surface(solid, session, report);
    }
    session.progress.phase("mesh");
    Ok(phase(report, "mesh", || outcome.dexels.surface())?)
}

/// Writes the mesh and the picture, and returns the latter.
pub(super) fn write_mesh(
    options: &RunOptions,
    mesh: &Mesh,
    session: &mut JobSession,
    report: &mut Report,
) -> Result<Option<Vec<u8>>, Failure> {
    let JobSession { outputs, progress, .. } = session;
    if outputs.wants(Output::Mesh) {
        let note = phase(report, "mesh", || {
            let (written, note) = decimated(mesh, options.decimate)?;
            outputs.write("part.ply", |file| write_ply(&written, file))?;
            Ok::<_, Failure>(note)
        })?;
        report.warnings.extend(note);
    }
    if !outputs.wants(Output::Picture) {
        return Ok(None);
    }
    progress.phase_of_shares("picture");
    let (png, missed) = phase(report, "picture", || {
        let (png, missed) = picture(&options.view, mesh, None, &|share| progress.share(share))?;
        outputs.write("part.png", |file| file.write_all(&png))?;
        Ok::<_, Failure>((png, missed))
    })?;
    report.warnings.extend(missed);
    Ok(Some(png))
}
