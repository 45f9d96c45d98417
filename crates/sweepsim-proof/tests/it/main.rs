//! Proofs against what is known.

mod certificates;
mod scenes;
mod walls;
