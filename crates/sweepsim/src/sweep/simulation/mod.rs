//! Cuts in a stock: only what comes near material is computed.

pub(crate) mod heights;
pub(crate) mod runs;
mod simulate;
mod source_at;
mod tiles;
mod tri;

pub use simulate::{Cut, Simulation, simulate, sweep_all};
pub use source_at::SurfaceSource;
pub(crate) use tiles::STRETCH;
pub use tiles::simulate_tiles;
pub use tri::{TriSimulation, simulate_tri};
