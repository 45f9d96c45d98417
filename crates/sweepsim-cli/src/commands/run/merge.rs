//! `merge`: the pieces of shards as the outputs of one run.

use super::{Outcome, Pieces, shard, whole};
use crate::arguments::{Arguments, Command, JudgeOptions, MergeOptions, RunOptions};
use crate::commands::task::Task;
use crate::commands::verify;
use crate::session::{Failure, JobSession, output_folder, phase};
use crate::shards::{Purpose, files, gather, identity};
use clap::Parser;
use std::path::{Path, absolute};
use std::process::ExitCode;
use sweepsim_formats::{Report, io_reason};

/// Joins the pieces of all shards of a run.
pub(crate) fn merge(options: &MergeOptions) -> Result<ExitCode, Failure> {
    let pieces = files(&options.pieces)?;
    let (_, first) = &pieces[0];
    let refused = |what: &dyn std::fmt::Display| Failure::message(format!("{}: {what}", pieces[0].0.display()));
    let (version, arguments) = (env!("CARGO_PKG_VERSION"), first.run().arguments.clone());
    if first.run().program != version {
        let made_by = &first.run().program;
        let message = format!("this piece was made by version {made_by} of sweepsim: expected {version}");
        return Err(refused(&message));
    }
    let unknown =
        |error: &dyn std::fmt::Display| refused(&format!("the arguments of its run are not understood: {error}"));
    let words = std::iter::once("sweepsim").chain(arguments.iter().map(String::as_str));
    let (task, mut run, judging) = match Arguments::try_parse_from(words).map(|parsed| parsed.command) {
        Ok(Command::Simulate(run)) => (Task::Simulate, run, JudgeOptions::default()),
        Ok(Command::Verify { run, judging }) => (Task::Verify, run, judging),
        Ok(_) => return Err(unknown(&"expected `simulate` or `verify`")),
        Err(error) => return Err(unknown(&error)),
    };
    let from_here = |path: &Path| {
        absolute(path).map_err(|error| Failure::message(format!("{}: {}", path.display(), io_reason(&error))))
    };
    run.out = Some(match &options.out {
        Some(out) => from_here(out)?,
        None => from_here(&output_folder(None, &first.run().job))?,
    });
    (run.threads, run.quiet, run.json) = (options.threads, options.quiet, options.json);
    // Names of files are as they were given there. Where that folder does not exist, as in another container, they are taken from here.
    let there = Path::new(first.folder());
    if there.is_dir() && std::env::set_current_dir(there).is_err() {
        let message = format!("cannot change to the folder of its run, {}", there.display());
        return Err(refused(&message));
    }
    whole(task, &run, &judging, Some((pieces, arguments)))
}

/// What the shards have computed, in place of computing it.
pub(super) fn gathered(
    task: Task,
    session: &JobSession,
    (options, judging): (&RunOptions, &JudgeOptions),
    (pieces, arguments): Pieces,
    report: &mut Report,
) -> Result<Outcome, Failure> {
    shard::check(task, judging)?;
    let tiling = shard::tiling(task, session, options, judging)?;
    let run = identity(task.name(), &session.job, options, &tiling, arguments);
    session.progress.phase("merge");
    let job = &session.job;
    let moves: Vec<usize> = job.paths.iter().map(|path| path.path.moves()).collect();
    let mut sets = phase(report, "merge", || gather(pieces, &run, &tiling, &moves))?;
    if task == Task::Verify {
        let judged = tiling.sets.iter().take_while(|set| set.purpose != Purpose::Cut).count();
        let aside = sets.split_off(judged);
        let done = verify::merged(session, judging, &tiling.sets[..judged], sets, report)?;
        return Ok(Outcome {
            aside,
            ..Outcome::from(done)
        });
    }
    let aside = sets.split_off(1);
    let along_z = sets.remove(0);
    session.progress.phase("stock");
    let before = phase(report, "stock", || {
        job.stock.dexels(&job.grid).map(|stock| stock.volume())
    });
    let before = before.map_err(|error| session.failure(format!("stock: {error}")))?;
    Ok(Outcome {
        volume_removed: Some(before - along_z.dexels.volume()),
        dexels: along_z.dexels,
        crossings: along_z.crossings,
        repaired: along_z.repaired,
        unresolved: along_z.unresolved,
        uncertified: 0,
        aside,
        target: None,
        moves: Vec::new(),
        picture: None,
    })
}
