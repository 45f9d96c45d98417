//! Parts of the work of a search: blocks of moves.

use super::{Cutter, blocks, digest};
use std::ops::Range;

/// A block of moves of a path.
#[derive(Clone)]
pub(crate) struct Part {
    pub path: usize,
    pub moves: Range<usize>,
    /// Of where it begins.
    digest: u64,
}

/// So many parts are done one beside the other.
const TOGETHER: [usize; 3] = [16, 16, 64];

/// All that there are.
pub(crate) fn parts(cutters: &[Cutter]) -> Vec<Part> {
    let of_one = |(path, cutter): (usize, &Cutter)| {
        let part = |moves: Range<usize>| Part {
            path,
            digest: digest(&cutter.path.pose(moves.start).tip().into()),
            moves,
        };
        cutter.blocks().into_iter().map(part).collect::<Vec<_>>()
    };
    cutters.iter().enumerate().flat_map(of_one).collect()
}

/// Some parts in groups, which begin where their content says so, too. Where blocks begin, the last digits of digests
/// are the same.
pub(crate) fn groups(parts: &[Part]) -> impl Iterator<Item = &[Part]> {
    blocks(parts.len(), TOGETHER, |number| parts[number].digest >> 16).map(|group| &parts[group])
}

impl Part {
    /// Whether it is one of so many, here and there, about `some` of `all`.
    pub fn is_sampled(&self, some: usize, all: usize) -> bool {
        let each = (all / some).max(1).next_power_of_two() as u64;
        (self.digest >> 32).is_multiple_of(each)
    }
}
