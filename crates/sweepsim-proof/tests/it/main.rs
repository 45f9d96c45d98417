//! Proofs against what is known.

mod apart;
mod certificates;
mod clear;
mod expected;
mod forged;
mod jagged;
mod process;
mod recall;
mod scenes;
mod shapes;
mod standing;
mod trees;
mod walls;
