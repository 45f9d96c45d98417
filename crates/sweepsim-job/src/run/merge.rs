//! The pieces of shards as one run.

use super::compute::{Computed, Part};
use super::shard::{check, tiling};
use crate::base::JobError;
use crate::request::{Request, Task};
use crate::session::{Pieces, Plan, Session, phase};
use crate::shards::{Gathered, PieceFile, Purpose, files, gather, identity};
use crate::verify::{self, Aside};
use std::path::{Path, PathBuf};
use sweepsim_formats::Report;

/// The pieces of all shards of a run: all of them, once each, of one run and of this version.
///
/// [`Merge::plan`] reads the job again. Its outcome is that of the whole run, to the byte but for times.
#[derive(Debug)]
pub struct Merge {
    pieces: Vec<(PathBuf, PieceFile)>,
}

impl Merge {
    /// Reads the pieces in some folders; a file counts as a piece.
    ///
    /// # Errors
    /// [`JobError`] if a piece is missing, comes twice, is damaged, of another run or of another version.
    pub fn read(folders: &[PathBuf]) -> Result<Self, JobError> {
        let merge = Self {
            pieces: files(folders)?,
        };
        let (file, first) = &merge.pieces[0];
        let (made_by, version) = (&first.run().program, env!("CARGO_PKG_VERSION"));
        if made_by != version {
            let why = format!("this piece was made by version {made_by} of sweepsim: expected {version}");
            return Err(JobError::file(file, why));
        }
        Ok(merge)
    }

    /// The name of the job.
    #[must_use]
    pub fn job(&self) -> &str {
        &self.pieces[0].1.run().job
    }

    /// The request of the run. Its files are named relative to [`Merge::folder`].
    #[must_use]
    pub fn request(&self) -> &Request {
        &self.pieces[0].1.run().request
    }

    /// The folder where the shards were run.
    #[must_use]
    pub fn folder(&self) -> &Path {
        Path::new(self.pieces[0].1.folder())
    }

    /// One of the pieces, for messages.
    #[must_use]
    pub fn piece(&self) -> &Path {
        &self.pieces[0].0
    }

    /// The plan of the whole run, to be carried out with what the shards have computed. Relative names of files refer
    /// to the current folder.
    ///
    /// # Errors
    /// As [`Request::plan`].
    pub fn plan(self) -> Result<Plan, JobError> {
        let run = self.pieces[0].1.run().clone();
        let mut plan = run.request.clone().plan()?;
        let files = self.pieces;
        plan.pieces = Some(Pieces { files });
        Ok(plan)
    }
}

/// What the shards have computed, in place of computing it.
pub(super) fn gathered(session: Session, pieces: Pieces, report: &mut Report) -> Result<Computed, JobError> {
    check(session.request)?;
    let job = session.job;
    let tiling = tiling(session)?;
    let run = identity(session.request, job, &tiling)?;
    session.phase("merge");
    let moves: Vec<usize> = job.paths.iter().map(|path| path.path.moves()).collect();
    let mut sets = phase(report, "merge", || gather(pieces.files, &run, &tiling, &moves))?;
    if session.request.task == Task::Verify {
        let judged = tiling.sets.iter().take_while(|set| set.purpose != Purpose::Cut).count();
        let cut = cut_aside(sets.split_off(judged));
        report.notes.extend(verify::sets(session)?.1);
        let mut done = verify::merged(session, &tiling.sets[..judged], sets, report)?;
        done.aside = done.aside.or(cut);
        return done.try_into();
    }
    let aside = cut_aside(sets.split_off(1));
    let along_z = sets.remove(0);
    session.phase("stock");
    let before = phase(report, "stock", || {
        job.stock.dexels(&job.grid).map(|stock| stock.volume())
    });
    let before = before.map_err(|error| session.failure(format!("stock: {error}")))?;
    Ok(Computed {
        volume_removed: Some(before - along_z.dexels.volume()),
        part: Part::new(along_z.dexels, aside)?,
        stopped: false,
        crossings: along_z.crossings,
        repaired: along_z.repaired,
        unresolved: along_z.unresolved,
        uncertified: 0,
        target: None,
        moves: Vec::new(),
        certified: None,
    })
}

/// What was cut along x and y beside all else, if it was.
fn cut_aside(sets: Vec<Gathered>) -> Option<Aside> {
    <[Gathered; 2]>::try_from(sets).ok().map(Aside::from)
}
