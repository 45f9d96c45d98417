//! Proofs against what is known.

mod scenes;
mod walls;
