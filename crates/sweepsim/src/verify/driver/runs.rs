//! The runs into which a program is divided.

use crate::sweep::{CHUNK, STRETCH};
use crate::verify::driver::Solids;
use crate::verify::scene::ToolPath;
use std::ops::Range;

/// Some moves of a toolpath that are judged together.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RunOfMoves {
    /// The toolpath.
    pub path: usize,
    /// The moves; of a toolpath of one pose, one that it does not have.
    pub moves: Range<usize>,
    /// Whether what is prepared together ends with it: how its last move ends may depend on that.
    pub ends_stretch: bool,
}

/// All runs of a program, in its order. What is found in a run depends on it and on all runs before, and on the moves after it up to the first in which the tool does not rest.
#[must_use]
pub fn runs_of(program: &[ToolPath]) -> Vec<RunOfMoves> {
    let mut all = Vec::new();
    for (path, toolpath) in program.iter().enumerate() {
        let own = runs(toolpath);
        for stretch in stretches(&own, STRETCH / Solids::count(toolpath)) {
            let last = stretch.len() - 1;
            all.extend(stretch.iter().enumerate().map(|(k, moves)| RunOfMoves {
                path,
                moves: moves.clone(),
                ends_stretch: k == last,
            }));
        }
    }
    all
}

/// Where to begin, from `first` on, so that moves from a later one on are prepared as after all those before: with the last move before it in which the tool does not rest.
pub(super) fn before(toolpath: &ToolPath, first: usize, from: usize) -> usize {
    let moves = toolpath.path.moves();
    let mut at = from.min(moves);
    while at > first {
        at -= 1;
        let (path, begin) = toolpath.path.unpacked(at..at + 1);
        if !path.rests(at - begin, at + 1 - begin) {
            break;
        }
    }
    at
}

/// Runs of consecutive moves in one state, none longer than a chunk.
pub(super) fn runs(toolpath: &ToolPath) -> Vec<Range<usize>> {
    // A path of one pose has no move, but its tool removes what it covers.
    let count = toolpath.path.moves().max(1);
    let mut runs: Vec<Range<usize>> = Vec::new();
    for number in 0..count {
        match runs.last_mut() {
            Some(run) if run.len() < CHUNK && toolpath.state(run.start) == toolpath.state(number) => run.end += 1,
            _ => runs.push(number..number + 1),
        }
    }
    runs
}

/// Runs that are prepared together, of at most so many moves but at least one run: memory grows with the moves.
pub(super) fn stretches(runs: &[Range<usize>], most: usize) -> impl Iterator<Item = &[Range<usize>]> {
    let mut first = 0;
    std::iter::from_fn(move || {
        let start = runs.get(first)?.start;
        let count = runs[first..].partition_point(|run| run.end - start <= most).max(1);
        let stretch = &runs[first..first + count];
        first += count;
        Some(stretch)
    })
}
