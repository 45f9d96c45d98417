//! `cargo xtask bench`: runs benchmarks, and prints the results beside the paper's.

mod clock;
mod instructions;
mod memory;
mod near_degenerate;
mod programs;
pub mod raster;
mod records;
mod scaling;
mod systems;
mod table1;
mod threads;
mod three_axis;

pub use clock::Clock;
pub use instructions::{instructions, work};
pub use memory::memory;
pub use near_degenerate::near_degenerate;
pub use programs::programs;
pub use scaling::scaling;
pub use systems::systems;
pub use table1::{CUTTERS, Cutter, cutter, table1};
pub use threads::threads;
pub use three_axis::three_axis;

/// Each measurement is repeated until this many seconds have passed; the shortest run counts.
const AT_LEAST: f64 = 0.4;

/// Work that takes so many seconds is not repeated.
const LONG: f64 = 6.0;

/// Runs some work on this many threads.
pub fn on<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(pool.map_err(|error| error.to_string())?.install(work))
}

/// Seconds of processor time of the shortest of several runs on the current thread. At least two unless they are long, since the first
/// one has yet to allocate its memory.
pub fn shortest(run: impl Fn() -> Result<(), String>) -> Result<f64, String> {
    shortest_by(Clock::seconds, run)
}

/// The same by a clock: [`Clock::wall`] for work on several threads.
pub fn shortest_by(clock: fn(&Clock) -> f64, run: impl Fn() -> Result<(), String>) -> Result<f64, String> {
    let begin = Clock::start();
    let (mut best, mut runs) = (f64::INFINITY, 0);
    while begin.wall() < AT_LEAST || (runs < 2 && begin.wall() < LONG) {
        let start = Clock::start();
        run()?;
        best = best.min(clock(&start));
        runs += 1;
    }
    Ok(best)
}
