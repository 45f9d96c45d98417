//! One shard of a run: the dexels of some tiles, left as a piece.

use crate::base::{JobError, Sink};
use crate::request::{Directions, Output, Request, Task};
use crate::session::{self, Plan, Session, reported};
use crate::shards::{Piece, PieceTile, Purpose, ShardNumber, TileNotes, Tiling, TilingSet, identity, is_done};
use crate::verify;
use std::path::Path;
use sweepsim::{Monitor, UnresolvedDexel, simulate_tiles};
use sweepsim_dexel::Dexels;

/// The piece of a shard, which [`Merge`](super::Merge) joins with the others.
#[derive(Clone, Debug)]
pub struct ShardPiece {
    name: String,
    bytes: Vec<u8>,
    tiles: usize,
    dexels: usize,
}

impl ShardPiece {
    /// The name of its file.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The size of its file in bytes.
    #[must_use]
    pub fn size(&self) -> usize {
        self.bytes.len()
    }

    /// The number of tiles.
    #[must_use]
    pub fn tiles(&self) -> usize {
        self.tiles
    }

    /// The number of dexels.
    #[must_use]
    pub fn dexels(&self) -> usize {
        self.dexels
    }

    /// Passes the piece to a sink.
    ///
    /// # Errors
    /// [`JobError`] of the sink.
    pub fn write_to(&self, sink: &mut dyn Sink) -> Result<(), JobError> {
        sink.write(&self.name, &mut |file| file.write_all(&self.bytes))
    }
}

impl Plan {
    /// An estimate of the work, in solved lines: about a microsecond each of one thread.
    ///
    /// # Errors
    /// [`JobError`] if the grids of the run cannot be made.
    pub fn work(&self) -> Result<f64, JobError> {
        let session = Session::new(self, &());
        let tiling = tiling(session)?;
        Ok(tiling.work(&self.job, &session.cuts()))
    }

    /// Refuses what cannot be shared out: only stock is divided into tiles, and no shard knows of another's findings.
    ///
    /// # Errors
    /// [`JobError::Request`] with the field.
    pub fn check_shards(&self) -> Result<(), JobError> {
        check(&self.request)
    }

    /// The name of the file of a shard's piece.
    #[must_use]
    pub fn piece_name(number: ShardNumber) -> String {
        Piece::name(number.index(), number.count())
    }

    /// Whether the piece of a shard is in this file, whole and of this run.
    ///
    /// # Errors
    /// As [`Plan::shard`].
    pub fn is_shard_done(&self, number: ShardNumber, file: &Path) -> Result<bool, JobError> {
        check(&self.request)?;
        let tiling = tiling(Session::new(self, &()))?;
        let run = identity(&self.request, &self.job, &tiling)?;
        Ok(is_done(file, &run, [number.index(), number.count()]))
    }

    /// Computes one shard of the run.
    ///
    /// # Errors
    /// As [`Plan::run`]; and if the task cannot be shared out.
    pub fn shard(&self, number: ShardNumber, monitor: &dyn Monitor) -> Result<ShardPiece, JobError> {
        check(&self.request)?;
        let session = Session::new(self, monitor);
        let tiling = tiling(session)?;
        let run = identity(&self.request, &self.job, &tiling)?;
        let tiles = tiles(session, &tiling, number)?;
        let dexels = tiles.iter().map(|tile| tile.dexels.grid().len()).sum();
        let count = tiles.len();
        let folder = std::env::current_dir().unwrap_or_default();
        let piece = Piece {
            run,
            folder: folder.to_string_lossy().into_owned(),
            shard: number.index(),
            shards: number.count(),
            tiles,
        };
        Ok(ShardPiece {
            name: Self::piece_name(number),
            bytes: piece.bytes(),
            tiles: count,
            dexels,
        })
    }
}

/// Only stock that is divided into tiles can be shared out.
pub(super) fn check(request: &Request) -> Result<(), JobError> {
    if request.cache.is_some() {
        let why = "each shard judges the whole program on its own tiles: leave out one of them";
        return Err(JobError::request("cache with --shard", why));
    }
    match request.task {
        Task::Sweep | Task::Section => Err(JobError::request(
            "shard",
            "is for `simulate` and `verify`: a swept volume is computed in one run",
        )),
        Task::Verify if request.judging.first => Err(JobError::request(
            "first with --shard",
            "no shard knows of what another finds first, so none can end there. Leave out one of them",
        )),
        Task::Simulate | Task::Verify => Ok(()),
    }
}

/// The tiles of a run, which follow from the job and the request alone.
pub(super) fn tiling(session: Session) -> Result<Tiling, JobError> {
    let (job, request) = (session.job, session.request);
    let tile = request.sweeping.tile;
    let mut sets = match request.task {
        Task::Verify => verify::sets(session)?.0,
        Task::Simulate | Task::Sweep | Task::Section => vec![TilingSet::new("along z", job.grid, None, tile)],
    };
    let outputs = [Output::Mesh, Output::Picture, Output::Tridexels, Output::Step];
    let surface = outputs.into_iter().any(|output| request.wants(output));
    let judged = request.task == Task::Verify && verify::judges_solid(session, &sets);
    if surface && !judged && along_three_axes(session, session::stock_heights(job)) == Ok(true) {
        let aside = session::grids_aside(job).map_err(|error| session.failure(format!("--directions xyz: {error}")))?;
        if let Some((grids, within)) = aside {
            let grids = grids.into_iter().zip(["along x", "along y"]);
            sets.extend(grids.map(|(grid, name)| TilingSet::new(name, grid, Some(within.clone()), tile)));
        }
    }
    Ok(Tiling { sets })
}

/// Whether the result is made along x and y, too; why not, if that was not asked for: a job has no such dexels, or far
/// too many. `heights`: of what is made.
pub(super) fn along_three_axes(session: Session, heights: Option<[f64; 2]>) -> Result<bool, String> {
    let (job, request) = (session.job, session.request);
    if request.needs_three_axes().is_some() {
        return Ok(true);
    }
    if let Some(directions) = request.directions {
        return Ok(directions == Directions::Xyz);
    }
    let no = match session::check(job) {
        Err(what) => format!("x and y would need {what}"),
        Ok(()) if session::too_many(&job.grid, heights) => {
            "the part is so much taller than the distance of its dexels that those along x and y must be asked for: --directions xyz".to_owned()
        }
        Ok(()) => return Ok(true),
    };
    Err(format!("mesh and picture are made of dexels along z only: {no}"))
}

/// Computes the tiles of a shard.
fn tiles(session: Session, tiling: &Tiling, number: ShardNumber) -> Result<Vec<PieceTile>, JobError> {
    let job = session.job;
    let (cuts, sweeping) = (session.cuts(), session.request.sweep_options(job));
    let share = tiling.share(number, job, &cuts);
    let mut done = Vec::with_capacity(share.len());
    for (direction, set) in tiling.sets.iter().enumerate() {
        let mine = share.iter().filter(|(own, _)| *own == direction);
        let mine: Vec<usize> = mine.map(|(_, tile)| *tile).collect();
        session.phase(set.name);
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
            let judged = verify::judged_tiles(session, set, &mine)?;
            done.extend(
                mine.into_iter()
                    .zip(judged)
                    .map(|(number, (tile, deviation))| PieceTile {
                        notes: TileNotes {
                            record: Some(tile.record),
                            deviation,
                            ..notes(number, tile.crossings, &tile.unresolved)
                        },
                        // What is left is part of the result along z, and compared with the target along x and y.
                        dexels: match set.purpose {
                            Purpose::Judge { .. } => tile.remaining,
                            _ => Dexels::empty(*tile.remaining.grid()),
                        },
                    }),
            );
            continue;
        }
        let stock = mine.iter().map(|tile| set.stock(&job.stock, *tile));
        let stock = stock.collect::<Result<Vec<_>, _>>();
        let stock = stock.map_err(|error| session.failure(format!("stock: {error}")))?;
        let cut = simulate_tiles(stock, &cuts, &sweeping, session.monitor);
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
