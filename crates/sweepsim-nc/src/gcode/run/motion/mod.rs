//! Moves: what each motion code makes of its words.

mod curves;
mod cycles;
mod moves;
mod pockets;
mod strokes;

pub(crate) use curves::Nurbs;
