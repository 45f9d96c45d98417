//! Proofs against what is known.

mod apart;
mod scenes;
mod standing;
mod walls;
