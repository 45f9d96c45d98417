//! All that a search for what touches material knows, and what it finds.

use super::history::History;
use crate::motion::Cutter;
use crate::statement::{OpenBox, Witness};
use crate::tool::Convex;
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// A path of a program, with all that moves along it.
pub struct Work<'a> {
    /// What cuts. It is followed as closely as its reach asks for, or that of the bodies if that is farther.
    pub cutter: Cutter<'a>,
    /// Shanks and holders.
    pub bodies: &'a [Convex],
    /// Whether a move is a rapid.
    pub is_rapid: &'a (dyn Fn(usize) -> bool + Sync),
}

/// What must touch no material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Movers {
    /// Shanks and holders, in all moves.
    Bodies,
    /// Cutters, in rapids.
    Rapids,
}

/// How much room is wanted.
#[derive(Clone, Copy, Debug)]
pub struct Room {
    /// So far from all material, in millimetres; if negative, so deep in it is allowed.
    pub distance: f64,
    /// How far the segments of a path may be from it.
    pub deviation: f64,
    /// At most as many zones are looked at in the whole request.
    pub zones: usize,
}

pub(super) struct Scene<'a> {
    pub work: &'a [Work<'a>],
    pub solids: &'a [Vec<Convex>],
    pub movers: Movers,
    pub room: &'a Room,
    pub history: History<'a>,
    pub first: Vec<&'a [u32]>,
    pub margin: f64,
    /// Of the stock.
    pub bounds: [Vector3<f64>; 2],
}

#[derive(Default)]
pub(super) struct Found {
    pub moves: BTreeMap<usize, Witness>,
    pub open: Vec<OpenBox>,
    /// How many places of each move are open.
    pub open_counts: BTreeMap<usize, usize>,
    pub zones: usize,
    /// For each solid, the trees of all its zones; nothing if a checker could not follow them.
    pub trees: Vec<Option<Vec<u8>>>,
}
