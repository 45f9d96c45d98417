//! What is found on a tile, and what the tiles of a grid find together.
//!
//! A tile knows its own lines only, so it keeps of each move what can be joined without loss: the earliest time, the longest overlap, ranges of coordinates. Volumes are
//! summed in the order of the tiles. Joined results thus depend on the tiles, but not on where or when each of them was computed.

use super::finding::{Finding, FindingKind, RapidCourses, in_order};
use super::scene::{MoveRemoval, PathRemoval};
use std::collections::{BTreeMap, BTreeSet};

/// Ranges of coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Extent([[f64; 2]; 3]);

impl Extent {
    pub fn of(place: [f64; 3]) -> Self {
        Self(place.map(|c| [c, c]))
    }

    pub fn hull(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| {
            let (own, other) = (self.0[k], other.0[k]);
            [own[0].min(other[0]), own[1].max(other[1])]
        }))
    }

    pub fn length(&self, k: usize) -> f64 {
        self.0[k][1] - self.0[k][0]
    }
}

/// A finding of a tile.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct TileFinding {
    pub finding: Finding,
    /// Depth and volume are those of material that is there throughout, and not of some that the move removes later.
    pub stays: bool,
}

/// What a move removes from a tile.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct TileRemoval {
    pub path: usize,
    pub number: usize,
    pub volume: f64,
    /// Of what is removed, as seen from the tool: along its axis, and across.
    pub extent: Option<Extent>,
}

/// What [`verify_tiles`](super::verify_tiles) finds on one tile. With the feature `serde` it can be stored, and joined by [another](Judgement::of_tiles) process.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TileRecord {
    pub(super) findings: Vec<TileFinding>,
    /// What each toolpath removes.
    pub(super) volumes: Vec<f64>,
    /// Moves that remove something, in their order.
    pub(super) moves: Vec<TileRemoval>,
    /// The number of moves of each toolpath that were looked at one by one.
    pub(super) each: Vec<usize>,
    /// Path, move and body.
    pub(super) undecided: Vec<(usize, usize, Option<usize>)>,
    pub(super) stopped: bool,
}

impl TileRecord {
    pub(super) fn new(paths: usize) -> Self {
        Self {
            volumes: vec![0.0; paths],
            each: vec![0; paths],
            ..Self::default()
        }
    }

    /// The first move, by path and number, in which anything is found.
    #[must_use]
    pub fn first(&self) -> Option<(usize, usize)> {
        self.findings
            .iter()
            .map(|own| (own.finding.path, own.finding.number))
            .min()
    }

    /// Whether it can be of toolpaths with so many moves each.
    #[must_use]
    pub fn is_of(&self, moves: &[usize]) -> bool {
        // A path of one pose counts as a move.
        let has = |path: usize, number: usize| moves.get(path).is_some_and(|count| number < (*count).max(1));
        let found = self.findings.iter().map(|own| (own.finding.path, own.finding.number));
        let removed = self.moves.iter().map(|own| (own.path, own.number));
        let open = self.undecided.iter().map(|(path, number, _)| (*path, *number));
        found.chain(removed).chain(open).all(|(path, number)| has(path, number))
            && [self.volumes.len(), self.each.len()] == [moves.len(); 2]
            && self
                .each
                .iter()
                .zip(moves)
                .all(|(each, count)| *each <= (*count).max(1))
    }

    /// The same of toolpaths that are some of a longer program: `paths` are their numbers in it, of `count`.
    ///
    /// # Panics
    /// If there are fewer numbers than toolpaths, or one of them is not less than `count`.
    #[must_use]
    pub fn renumbered(mut self, paths: &[usize], count: usize) -> Self {
        self.findings
            .iter_mut()
            .for_each(|own| own.finding.path = paths[own.finding.path]);
        self.moves.iter_mut().for_each(|own| own.path = paths[own.path]);
        self.undecided.iter_mut().for_each(|own| own.0 = paths[own.0]);
        let (mut volumes, mut each) = (vec![0.0; count], vec![0; count]);
        for (path, (volume, moves)) in paths.iter().zip(self.volumes.iter().zip(&self.each)) {
            (volumes[*path], each[*path]) = (*volume, *moves);
        }
        (self.volumes, self.each) = (volumes, each);
        self
    }
}

/// What tiles find together.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Judgement {
    /// All findings, in the order of the program.
    pub findings: Vec<Finding>,
    /// What each toolpath removes.
    pub paths: Vec<PathRemoval>,
    /// What each move removes, if [asked for](super::VerifyOptions::each_move).
    pub moves: Vec<MoveRemoval>,
    /// Moves, by path and number, in which a body follows its cutter so closely that it is not known whether it touches.
    pub undecided: Vec<(usize, usize)>,
    /// Whether the verification ended early.
    pub stopped: bool,
}

impl Judgement {
    /// Joins what is found on the tiles of one grid, given in the order of the tiles: the same whichever process has computed which.
    ///
    /// Harm of one move by one body is one finding: with the earliest time and the place that belongs to it, the greatest depth, and the sum of the volumes. Where some tiles
    /// see the solid touch and others see it only come near, the former count; likewise its own course before another one, and material that stays before what the move
    /// removes later.
    #[must_use]
    pub fn of_tiles(tiles: &[TileRecord]) -> Self {
        let mut harms: BTreeMap<_, Vec<TileFinding>> = BTreeMap::new();
        for own in tiles.iter().flat_map(|tile| &tile.findings) {
            harms.entry(own.finding.harm()).or_default().push(*own);
        }
        let touched: BTreeSet<_> = harms.keys().copied().collect();
        let count = tiles.iter().map(|tile| tile.volumes.len()).max().unwrap_or(0);
        let mut paths = vec![PathRemoval::default(); count];
        for tile in tiles {
            for (all, own) in paths.iter_mut().zip(&tile.volumes) {
                all.volume += own;
            }
        }
        // What one tile does not know may be known to another.
        let open = tiles.iter().flat_map(|tile| &tile.undecided);
        let open =
            open.filter(|(path, number, body)| !touched.contains(&(*path, *number, FindingKind::Collision, *body)));
        let undecided: BTreeSet<(usize, usize)> = open.map(|(path, number, _)| (*path, *number)).collect();
        Self {
            findings: in_order(harms.into_values().filter_map(united)),
            paths,
            moves: moves(tiles),
            undecided: undecided.into_iter().collect(),
            stopped: tiles.iter().any(|tile| tile.stopped),
        }
    }
}

/// Findings of the same harm on several tiles as one.
fn united(all: Vec<TileFinding>) -> Option<Finding> {
    let near = all.iter().all(|own| own.finding.near);
    let seen = || all.iter().filter(|own| own.finding.near == near);
    let courses = seen()
        .filter_map(|own| own.finding.courses)
        .reduce(|a, b| if a == b { a } else { RapidCourses::Both });
    let is_other = |own: &&TileFinding| own.finding.courses == Some(RapidCourses::Other);
    let only_other = seen().all(|own| is_other(&own));
    let seen = || seen().filter(|own| is_other(own) == only_other);
    let first = seen().map(|own| own.finding).reduce(|a, b| {
        let earlier = b.time.total_cmp(&a.time).then(a.depth.total_cmp(&b.depth));
        if earlier.is_lt() { b } else { a }
    })?;
    let stays = seen().any(|own| own.stays);
    let counted = seen().filter(|own| own.stays == stays);
    let (depth, volume) = counted.fold((0.0_f64, 0.0), |(depth, volume), own| {
        (depth.max(own.finding.depth), volume + own.finding.volume)
    });
    Some(Finding {
        depth,
        volume,
        courses,
        ..first
    })
}

/// What each move removes, also of those that remove nothing.
fn moves(tiles: &[TileRecord]) -> Vec<MoveRemoval> {
    let mut removed: BTreeMap<(usize, usize), (f64, Option<Extent>)> = BTreeMap::new();
    for own in tiles.iter().flat_map(|tile| &tile.moves) {
        let (volume, extent) = removed.entry((own.path, own.number)).or_default();
        *volume += own.volume;
        *extent = match (*extent, own.extent) {
            (Some(a), Some(b)) => Some(a.hull(b)),
            (a, b) => a.or(b),
        };
    }
    let paths = tiles.iter().map(|tile| tile.each.len()).max().unwrap_or(0);
    let count = |path: usize| tiles.iter().filter_map(|tile| tile.each.get(path)).max();
    let all = (0..paths).flat_map(|path| (0..count(path).copied().unwrap_or(0)).map(move |number| (path, number)));
    all.map(|(path, number)| {
        let (volume, extent) = removed.get(&(path, number)).copied().unwrap_or_default();
        let length = |k: usize| extent.map_or(0.0, |extent| extent.length(k));
        MoveRemoval {
            path,
            number,
            volume,
            depth: length(0),
            width: length(1).max(length(2)),
        }
    })
    .collect()
}
