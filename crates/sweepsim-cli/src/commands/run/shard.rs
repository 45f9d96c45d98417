//! One shard of a run: the dexels of some tiles, left as a piece.

use super::{along_three_axes, check_directions, pool, read};
use crate::arguments::{JudgeOptions, Output, RunOptions, ShardNumber};
use crate::commands::task::{Task, reported, sweeping};
use crate::commands::{tri_surface, verify};
use crate::session::interruption::writing;
use crate::session::{Failure, JobSession, output_folder, print, words};
use crate::shards::{Piece, PieceTile, Purpose, TileNotes, Tiling, TilingSet, identity, is_done};
use std::process::ExitCode;
use sweepsim::{Monitor, UnresolvedDexel, simulate_tiles};
use sweepsim_dexel::Dexels;

/// Options that concern one shard, or how it is run: with a value, and without.
const OWN: [&[&str]; 2] = [&["--shard", "--out", "--threads"], &["--resume", "--quiet", "--json"]];

/// The arguments of a command but for those that concern one shard.
fn common(arguments: impl Iterator<Item = String>) -> Vec<String> {
    let mut common = Vec::new();
    let mut arguments = arguments;
    while let Some(argument) = arguments.next() {
        let name = argument.split('=').next().unwrap_or_default();
        if OWN[0].contains(&name) {
            if !argument.contains('=') {
                arguments.next();
            }
        } else if !OWN[1].contains(&name) {
            common.push(argument);
        }
    }
    common
}

/// The tiles of a run, which follow from the job and the options alone.
pub(super) fn tiling(
    task: Task,
    session: &JobSession,
    options: &RunOptions,
    judging: &JudgeOptions,
) -> Result<Tiling, Failure> {
    let job = &session.job;
    let mut sets = match task {
        Task::Verify => verify::sets(session, options, judging)?,
        Task::Simulate | Task::Sweep => vec![TilingSet::new("along z", job.grid, None, options.tile)],
    };
    let outputs = [Output::Mesh, Output::Picture, Output::Tridexels];
    let surface = outputs.into_iter().any(|output| session.outputs.wants(output));
    if surface && along_three_axes(job, options, tri_surface::stock_heights(job)) == Ok(true) {
        let aside =
            tri_surface::grids_aside(job).map_err(|error| session.failure(format!("--directions xyz: {error}")))?;
        if let Some((grids, within)) = aside {
            let grids = grids.into_iter().zip(["along x", "along y"]);
            sets.extend(grids.map(|(grid, name)| TilingSet::new(name, grid, Some(within.clone()), options.tile)));
        }
    }
    Ok(Tiling { sets })
}

/// Only stock that is divided into tiles can be shared out.
pub(super) fn check(task: Task, judging: &JudgeOptions) -> Result<(), Failure> {
    match task {
        Task::Sweep => Err(Failure::message(
            "--shard is for `simulate` and `verify`: a swept volume is computed in one run",
        )),
        Task::Verify if judging.first => Err(Failure::message(
            "--first with --shard: no shard knows of what another finds first, so none can end there. Leave out one of them",
        )),
        Task::Simulate | Task::Verify => Ok(()),
    }
}

/// Computes a shard, and writes its piece.
pub(super) fn run(
    task: Task,
    options: &RunOptions,
    judging: &JudgeOptions,
    number: ShardNumber,
) -> Result<ExitCode, Failure> {
    check(task, judging)?;
    let unreadable = |_| Failure::message("--shard: expected arguments of Unicode characters only");
    let arguments = std::env::args_os()
        .skip(1)
        .map(|argument| argument.into_string().map_err(unreadable));
    let arguments = common(arguments.collect::<Result<Vec<_>, _>>()?.into_iter());
    let read = read(options)?;
    check_directions(&read, options)?;
    let name = Piece::name(number.index, number.count);
    let file = output_folder(options.out.as_deref(), &read.job.name).join(&name);
    let session = JobSession::new(&options.job, read, options.out.as_deref(), &options.only, options.quiet)?;
    let tiling = tiling(task, &session, options, judging)?;
    let run = identity(task.name(), &session.job, options, &tiling, arguments);
    if options.resume && is_done(&file, &run, [number.index, number.count]) {
        session.progress.finish();
        if !options.quiet {
            print(&format!("{} is done: nothing to do\n", file.display()))?;
        }
        return Ok(ExitCode::SUCCESS);
    }
    let pool = pool(options.threads)?;
    let tiles = pool
        .install(|| tiles(&session, (options, judging), &tiling, number))
        .inspect_err(|_| session.progress.finish())?;
    let lines: usize = tiles.iter().map(|tile| tile.dexels.grid().len()).sum();
    let count = tiles.len() as u64;
    let folder = std::env::current_dir().unwrap_or_default();
    let piece = Piece {
        run,
        folder: folder.to_string_lossy().into_owned(),
        shard: number.index,
        shards: number.count,
        tiles,
    };
    let size = writing(Some(&file.to_string_lossy()), || Ok(piece.write(&file)?))?;
    session.progress.finish();
    if !options.quiet {
        print(&format!(
            "shard {number}: {}, {}; {} ({})\n",
            words::counted(count, "tile"),
            words::counted(lines as u64, "dexel"),
            file.display(),
            words::bytes(size)
        ))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Computes the tiles of a shard.
fn tiles(
    session: &JobSession,
    (options, judging): (&RunOptions, &JudgeOptions),
    tiling: &Tiling,
    number: ShardNumber,
) -> Result<Vec<PieceTile>, Failure> {
    let job = &session.job;
    let (cuts, sweeping) = (session.cuts(), sweeping(job, options));
    let share = tiling.share(number, job, &cuts);
    let mut done = Vec::with_capacity(share.len());
    for (direction, set) in tiling.sets.iter().enumerate() {
        let mine = share.iter().filter(|(own, _)| *own == direction);
        let mine: Vec<usize> = mine.map(|(_, tile)| *tile).collect();
        session.progress.phase(set.name);
        let notes = |number: usize, crossings: u64, unresolved: &[UnresolvedDexel]| TileNotes {
            set: direction,
            number,
            crossings,
            repaired: 0,
            unresolved: reported(unresolved),
            record: None,
            deviation: None,
        };
        if set.purpose != Purpose::Cut {
            let judged = verify::judged_tiles(session, options, judging, set, &mine)?;
            done.extend(
                mine.into_iter()
                    .zip(judged)
                    .map(|(number, (tile, deviation))| PieceTile {
                        notes: TileNotes {
                            record: Some(tile.record),
                            deviation,
                            ..notes(number, tile.crossings, &tile.unresolved)
                        },
                        // Only what is left along z is part of the result.
                        dexels: match direction {
                            0 => tile.remaining,
                            _ => Dexels::empty(*tile.remaining.grid()),
                        },
                    }),
            );
            continue;
        }
        let stock = mine.iter().map(|tile| set.stock(&job.stock, *tile));
        let stock = stock.collect::<Result<Vec<_>, _>>();
        let stock = stock.map_err(|error| session.failure(format!("stock: {error}")))?;
        let cut = simulate_tiles(stock, &cuts, &sweeping, &session.progress as &dyn Monitor);
        let cut = cut.map_err(|error| session.failed(error))?;
        done.extend(mine.into_iter().zip(cut).map(|(number, tile)| PieceTile {
            notes: TileNotes {
                repaired: tile.statistics.repaired,
                ..notes(number, tile.statistics.crossings, &tile.statistics.unresolved)
            },
            dexels: tile.remaining,
        }));
    }
    Ok(done)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_of_one_shard_are_left_out() {
        let given = "simulate --shard 3/8 job.ron --out=there --resume --tile 32 --threads 1 --quiet --only mesh";
        let common = common(given.split(' ').map(str::to_owned));
        assert_eq!(common.join(" "), "simulate job.ron --tile 32 --only mesh");
    }
}
