//! Proofs against what is known.

mod walls;
