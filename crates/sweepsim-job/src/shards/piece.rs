//! The file that a shard leaves.
//!
//! | part | content |
//! | --- | --- |
//! | header | `sweeppce`; version `u32`; 0 `u32`; bytes of the manifest `u64`; bytes of the dexels `u64`, all little-endian |
//! | manifest | JSON: what the run computes, which shard of how many, its tiles |
//! | dexels | those of each tile in the order of the manifest, each as a `.dexels` file, on a grid of unit cells |
//! | end | SHA-256 of all that is before it |

use crate::request::Request;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fs;
use std::io::{self, Read as _};
use std::path::Path;
use sweepsim::verify::{TileDeviation, TileRecord};
use sweepsim_dexel::{Dexels, Grid};
use sweepsim_formats::{ReportedDexel, read_dexels_binary, write_dexels_binary};

const MAGIC: &[u8; 8] = b"sweeppce";
const VERSION: u32 = 3;
const HEADER: usize = 32;
const END: usize = 32;

/// What a run computes. Pieces fit together if it is the same.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Identity {
    /// The version of the program.
    pub program: String,
    pub command: String,
    /// The name of the job.
    pub job: String,
    pub cells: [usize; 2],
    pub tile: usize,
    pub tolerance: f64,
    pub method: String,
    /// SHA-256 of the job as read and of what is to be done with it.
    pub digest: String,
    pub request: Request,
}

impl Identity {
    /// In what another run differs from this one.
    pub fn difference(&self, other: &Self) -> Option<String> {
        let differs =
            |what: &str, own: String, other: String| (own != other).then(|| format!("{what} is {other}, not {own}"));
        let version = |of: &Self| format!("of version {}", of.program);
        differs("the program that made it", version(self), version(other))
            .or_else(|| differs("its command", self.command.clone(), other.command.clone()))
            .or_else(|| differs("its job", format!("{:?}", self.job), format!("{:?}", other.job)))
            .or_else(|| differs("its tolerance", self.tolerance.to_string(), other.tolerance.to_string()))
            .or_else(|| differs("its method", self.method.clone(), other.method.clone()))
            .or_else(|| {
                differs(
                    "its number of dexels",
                    format!("{:?}", self.cells),
                    format!("{:?}", other.cells),
                )
            })
            .or_else(|| differs("the size of its tiles", self.tile.to_string(), other.tile.to_string()))
            .or_else(|| {
                let notation = |of: &Self| serde_json::to_string(&of.request).unwrap_or_default();
                differs("its request", notation(self), notation(other))
            })
            .or_else(|| {
                let differs = self.digest != other.digest;
                differs.then(|| "its job had other tools, paths, stock or target, or another grid".to_owned())
            })
    }
}

/// The dexels of a tile, and how they were computed.
pub(crate) struct PieceTile {
    pub dexels: Dexels,
    pub notes: TileNotes,
}

/// How a tile was computed.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct TileNotes {
    /// The direction of its lines, and its number among the tiles of that direction.
    pub set: usize,
    pub number: usize,
    pub crossings: u64,
    pub repaired: usize,
    /// In the whole grid.
    pub unresolved: Vec<ReportedDexel>,
    /// What was found, if moves were judged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub record: Option<TileRecord>,
    /// How what is left differs from the target, if it is to be compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deviation: Option<TileDeviation>,
}

#[derive(Debug, Serialize, Deserialize)]
struct Manifest {
    run: Identity,
    /// Where it was run: names of files in the request refer to it.
    folder: String,
    shard: usize,
    shards: usize,
    tiles: Vec<TileNotes>,
}

/// A piece.
pub(crate) struct Piece {
    pub run: Identity,
    pub folder: String,
    pub shard: usize,
    pub shards: usize,
    pub tiles: Vec<PieceTile>,
}

/// Why a file is no piece that can be used.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Unfit {
    /// It cannot be read.
    Unreadable(String),
    /// It is something else.
    Foreign,
    /// Of another version of the format.
    Version(u32),
    /// Its end is missing.
    Truncated,
    /// Its content has changed.
    Damaged,
}

impl std::fmt::Display for Unfit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Unreadable(error) => write!(f, "cannot be read: {error}"),
            Self::Foreign => f.write_str("is not a piece: expected `sweeppce` at its beginning"),
            Self::Version(version) => write!(f, "has version {version} of the format of pieces: expected {VERSION}"),
            Self::Truncated => f.write_str("is truncated: run its shard again"),
            Self::Damaged => f.write_str("is damaged, its checksum is wrong: run its shard again"),
        }
    }
}

/// A grid of unit cells, with as many columns and rows as another.
fn unit_grid(like: &Grid) -> Option<Grid> {
    let cells = like.cells();
    Grid::new([0.0; 2], cells.map(|n| n as f64), cells).ok()
}

impl Piece {
    /// The name of the file of a shard.
    pub fn name(shard: usize, shards: usize) -> String {
        let width = (shards - 1).to_string().len();
        format!("shard-{shard:0width$}-of-{shards}.piece")
    }

    /// The bytes of its file.
    pub fn bytes(self) -> Vec<u8> {
        let mut dexels = Vec::new();
        let mut notes = Vec::with_capacity(self.tiles.len());
        for tile in self.tiles {
            let grid = unit_grid(tile.dexels.grid()).expect("as many cells as another grid");
            let moved = tile.dexels.on(grid).expect("as many columns and rows");
            write_dexels_binary(&moved, &mut dexels).expect("memory can be written to");
            notes.push(tile.notes);
        }
        let manifest = Manifest {
            run: self.run,
            folder: self.folder,
            shard: self.shard,
            shards: self.shards,
            tiles: notes,
        };
        let manifest = serde_json::to_vec(&manifest).expect("plain data");
        let mut bytes = Vec::with_capacity(HEADER + manifest.len() + dexels.len() + END);
        bytes.extend_from_slice(MAGIC);
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(0_u32.to_le_bytes());
        bytes.extend((manifest.len() as u64).to_le_bytes());
        bytes.extend((dexels.len() as u64).to_le_bytes());
        bytes.extend_from_slice(&manifest);
        bytes.append(&mut dexels);
        let digest = Sha256::digest(&bytes);
        bytes.extend_from_slice(&digest);
        bytes
    }

    /// Reads a whole file and checks it. `grids`: the grid of each tile, by direction and number.
    pub fn read(file: &Path) -> Result<PieceFile, Unfit> {
        let unreadable = |error: io::Error| Unfit::Unreadable(sweepsim_formats::io_reason(&error));
        let mut open = fs::File::open(file).map_err(unreadable)?;
        let mut bytes = Vec::new();
        // The head tells how much there is; a file of another kind is not read on.
        let mut read = |most: u64, bytes: &mut Vec<u8>| (&mut open).take(most).read_to_end(bytes).map_err(unreadable);
        read(HEADER as u64, &mut bytes)?;
        if !bytes.starts_with(MAGIC) {
            // A file that was cut off within its first bytes begins like one.
            return Err(if MAGIC.starts_with(&bytes) {
                Unfit::Truncated
            } else {
                Unfit::Foreign
            });
        }
        let word = |at: usize| {
            bytes
                .get(at..at + 8)
                .and_then(|own| own.try_into().ok())
                .map(u64::from_le_bytes)
        };
        let version = word(8).ok_or(Unfit::Truncated)? as u32;
        if version != VERSION {
            return Err(Unfit::Version(version));
        }
        let lengths = [word(16).ok_or(Unfit::Truncated)?, word(24).ok_or(Unfit::Truncated)?];
        let told = lengths
            .iter()
            .try_fold((HEADER + END) as u64, |sum, own| sum.checked_add(*own));
        let told = told.ok_or(Unfit::Damaged)?;
        read((told - HEADER as u64).saturating_add(1), &mut bytes)?;
        match (bytes.len() as u64).cmp(&told) {
            std::cmp::Ordering::Less => return Err(Unfit::Truncated),
            std::cmp::Ordering::Greater => return Err(Unfit::Damaged),
            std::cmp::Ordering::Equal => {}
        }
        let (content, digest) = bytes.split_at(bytes.len() - END);
        if Sha256::digest(content).as_slice() != digest {
            return Err(Unfit::Damaged);
        }
        let from = HEADER + lengths[0] as usize;
        let manifest: Manifest = serde_json::from_slice(&content[HEADER..from]).map_err(|_| Unfit::Damaged)?;
        Ok(PieceFile {
            manifest,
            content: content[from..].to_vec(),
        })
    }
}

/// A piece whose file is whole, before its dexels are read.
#[derive(Debug)]
pub(crate) struct PieceFile {
    manifest: Manifest,
    content: Vec<u8>,
}

impl PieceFile {
    pub fn run(&self) -> &Identity {
        &self.manifest.run
    }

    pub fn folder(&self) -> &str {
        &self.manifest.folder
    }

    /// The shard, and how many there are.
    pub fn shard(&self) -> [usize; 2] {
        [self.manifest.shard, self.manifest.shards]
    }

    /// Its tiles, whose grids `grid` knows by direction and number; `None` if they are not those.
    pub fn tiles(self, grid: impl Fn(usize, usize) -> Option<Grid>) -> Option<Vec<PieceTile>> {
        let mut rest = &self.content[..];
        let mut tiles = Vec::with_capacity(self.manifest.tiles.len());
        for notes in self.manifest.tiles {
            let dexels = read_dexels_binary(&mut rest).ok()?;
            let dexels = dexels.on(grid(notes.set, notes.number)?).ok()?;
            tiles.push(PieceTile { dexels, notes });
        }
        rest.is_empty().then_some(tiles)
    }
}
