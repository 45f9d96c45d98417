//! The sweep against brute force, with random tools and moves.
//!
//! Every test draws cases of one family (a tool, poses, a grid), sweeps them, and lets the oracle of this package judge
//! each dexel. The oracle shares no code with the solver. Cases are drawn from a fixed seed, so a failure is a failure
//! everywhere; it prints a reproducer. The gate runs a seeded sample (`SWEEPSIM_SEED=7` takes another),
//! `cargo xtask brute-force` the whole suite.
//!
//! Tolerances. A sweep with tolerance ε is exact for an input within ε of the given one: its motion and its lines are
//! moved by less than that to avoid degenerate positions. So an end may be off by ε *in space*, which along a steep
//! wall is much more in z. The judge therefore takes the signed distance of the true swept volume at the points where
//! the two answers differ, and demands |D| ≤ ε (plus its own error of 1e-8). That is exactly what is promised, at any
//! slope.

mod about_a_line;
mod cases;
mod circle_segments;
mod corpus;
mod degenerate;
mod drawn_tools;
mod generic;
mod jobs;
mod judge;
mod metamorphic;
mod motions;
mod named_motions;
mod random;
mod relations;
mod sample;
mod splines;
