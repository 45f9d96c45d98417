//! What searches of sheets share. A sheet is one of the points at which a line meets a piece of the moving tool, as a
//! function of one unknown, mostly the time. Its zeros are wanted, each exactly once: lines are visited block by block
//! where a block may have any ([`search_lines`]), and each zero is found in a bracket in which it is the only one
//! ([`newton`]).

mod blocks;
mod counts;
pub(crate) mod intervals;
mod newton;

pub(crate) use blocks::{around, distance, numbers, search_lines};
pub(crate) use counts::Counts;
pub(crate) use newton::{STEPS, halfway, middle, newton};

/// What is not decided about a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Undecided {
    /// Closer than rounding errors: it has to be displaced.
    Close,
    /// Charts can tell.
    Intricate,
}
