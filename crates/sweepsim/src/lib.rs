//! Exact swept volumes of milling tools along 5-axis motions, as dexels
mod crossings;
mod element;
mod envelope;
mod form;
mod generic;
mod lattice;
mod sweep;
mod time;

pub use sweep::{Method, Monitor, Options, Statistics, Sweep, SweepError, Unresolved, sweep};
