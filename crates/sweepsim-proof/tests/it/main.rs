//! Proofs against what is known.

mod apart;
mod certificates;
mod scenes;
mod standing;
mod walls;
