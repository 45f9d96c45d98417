//! Finds the pieces of a run, and joins them: all, once each, of this very run.

use super::piece::{Identity, Piece, PieceFile, PieceTile};
use super::tiling::{Purpose, Tiling, TilingSet};
use crate::base::JobError;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use sweepsim::verify::{TileDeviation, TileRecord};
use sweepsim_dexel::Dexels;
use sweepsim_formats::{ReportedDexel, io_reason};

/// How many missing shards are named.
const NAMED: usize = 10;

/// What the shards computed along one direction, joined.
#[derive(Debug)]
pub(crate) struct Gathered {
    pub dexels: Dexels,
    pub crossings: u64,
    pub repaired: usize,
    pub unresolved: Vec<ReportedDexel>,
    /// What was found on each tile, if moves were judged.
    pub records: Vec<TileRecord>,
    /// How each tile differs from the target, if it was compared.
    pub deviations: Vec<TileDeviation>,
}

impl Gathered {
    pub fn empty(set: &TilingSet) -> Self {
        Self {
            dexels: Dexels::empty(set.tiles[0]),
            crossings: 0,
            repaired: 0,
            unresolved: Vec::new(),
            records: Vec::new(),
            deviations: Vec::new(),
        }
    }
}

/// The pieces in these folders, sorted by name. A file counts as a piece.
fn listed(folders: &[PathBuf]) -> Result<Vec<PathBuf>, JobError> {
    let mut all = Vec::new();
    for folder in folders {
        if folder.is_file() {
            all.push(folder.clone());
            continue;
        }
        let unreadable = |error: std::io::Error| {
            JobError::run(format!(
                "cannot read the folder {}: {}",
                folder.display(),
                io_reason(&error)
            ))
        };
        let mut found = Vec::new();
        for entry in fs::read_dir(folder).map_err(unreadable)? {
            let file = entry.map_err(unreadable)?.path();
            if file.extension().is_some_and(|extension| extension == "piece") {
                found.push(file);
            }
        }
        if found.is_empty() {
            return Err(JobError::run(format!(
                "{}: no pieces of shards (*.piece) are here",
                folder.display()
            )));
        }
        found.sort();
        all.append(&mut found);
    }
    Ok(all)
}

/// Reads the pieces in some folders, and checks that they are all pieces of one run.
pub(crate) fn files(folders: &[PathBuf]) -> Result<Vec<(PathBuf, PieceFile)>, JobError> {
    let mut pieces: Vec<(PathBuf, PieceFile)> = Vec::new();
    let mut seen: BTreeMap<usize, PathBuf> = BTreeMap::new();
    for file in listed(folders)? {
        let refused = |what: &dyn std::fmt::Display| JobError::run(format!("{}: {what}", file.display()));
        let piece = Piece::read(&file).map_err(|unfit| refused(&format!("this file {unfit}")))?;
        let [shard, shards] = piece.shard();
        if let Some((first, other)) = pieces.first() {
            if let Some(difference) = other.run().difference(piece.run()) {
                return Err(refused(&format!(
                    "this piece is of another run than {}: {difference}",
                    first.display()
                )));
            }
            let expected = other.shard()[1];
            if shards != expected {
                return Err(refused(&format!(
                    "this piece is one of {shards}, but {} is one of {expected}",
                    first.display()
                )));
            }
        }
        if let Some(other) = seen.insert(shard, file.clone()) {
            return Err(refused(&format!(
                "shard {shard} comes twice, also in {}",
                other.display()
            )));
        }
        pieces.push((file, piece));
    }
    let Some((_, first)) = pieces.first() else {
        return Err(JobError::run("expected folders with pieces of shards"));
    };
    let shards = first.shard()[1];
    let missing: Vec<usize> = (0..shards).filter(|shard| !seen.contains_key(shard)).collect();
    if !missing.is_empty() {
        let mut names: Vec<String> = missing
            .iter()
            .take(NAMED)
            .map(|shard| format!("{shard}/{shards}"))
            .collect();
        if missing.len() > NAMED {
            names.push(format!("{} more", missing.len() - NAMED));
        }
        return Err(JobError::run(format!(
            "{} of {shards} pieces are missing: run again with --shard {}",
            missing.len(),
            names.join(", ")
        )));
    }
    Ok(pieces)
}

/// Joins the pieces along each direction of the tiling of the same run. `moves`: of each path.
pub(crate) fn gather(
    pieces: Vec<(PathBuf, PieceFile)>,
    run: &Identity,
    tiling: &Tiling,
    moves: &[usize],
) -> Result<Vec<Gathered>, JobError> {
    let mut tiles: Vec<Vec<PieceTile>> = tiling.sets.iter().map(|_| Vec::new()).collect();
    for (file, piece) in pieces {
        let refused = |what: String| JobError::run(format!("{}: {what}", file.display()));
        if let Some(difference) = run.difference(piece.run()) {
            return Err(refused(format!(
                "this piece is stale, the run is another one now: {difference}; run all shards again"
            )));
        }
        let grid = |set: usize, number: usize| tiling.sets.get(set)?.tiles.get(number).copied();
        let own = piece
            .tiles(grid)
            .ok_or_else(|| refused("this piece is damaged: its tiles are invalid".to_owned()))?;
        for tile in own {
            let purpose = tiling.sets[tile.notes.set].purpose;
            let judged = purpose != Purpose::Cut;
            let compared = matches!(purpose, Purpose::Judge { compare: Some(_), .. });
            let fits = |record: &TileRecord| judged && record.is_of(moves);
            if !tile.notes.record.as_ref().map_or(!judged, fits) || tile.notes.deviation.is_some() != compared {
                return Err(refused(
                    "this piece is damaged: its findings are of another program".to_owned(),
                ));
            }
            tiles[tile.notes.set].push(tile);
        }
    }
    let sets = tiling.sets.iter().zip(tiles);
    sets.map(|(set, mut tiles)| {
        tiles.sort_by_key(|tile| tile.notes.number);
        let mut gathered = Gathered::empty(set);
        let mut dexels = Vec::with_capacity(tiles.len());
        for tile in tiles {
            gathered.crossings += tile.notes.crossings;
            gathered.repaired += tile.notes.repaired;
            gathered.unresolved.extend(tile.notes.unresolved);
            gathered.records.extend(tile.notes.record);
            gathered.deviations.extend(tile.notes.deviation);
            dexels.push(tile.dexels);
        }
        gathered.unresolved.sort_by_key(|dexel| (dexel.i, dexel.j));
        gathered.dexels = Dexels::from_tiles(set.grid, dexels)
            .map_err(|error| JobError::run(format!("the pieces do not make up the grid: {error}")))?;
        Ok(gathered)
    })
    .collect()
}

/// Whether the piece of a shard is there, whole, and of this run.
pub(crate) fn is_done(file: &Path, run: &Identity, shard: [usize; 2]) -> bool {
    Piece::read(file).is_ok_and(|piece| piece.run().difference(run).is_none() && piece.shard() == shard)
}
