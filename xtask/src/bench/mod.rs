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
pub use table1::{Cutter, cutter, share, table1};
pub use threads::threads;
pub use three_axis::three_axis;

/// Each measurement is repeated until this many seconds have passed; the shortest run counts.
const AT_LEAST: f64 = 0.4;

/// Seconds that one measurement takes at least, of as many runs as are necessary.
const STEADY: f64 = 0.05;

/// Work that takes so many seconds is not repeated.
const LONG: f64 = 6.0;

/// Runs some work on this many threads.
pub fn on<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(pool.map_err(|error| error.to_string())?.install(work))
}

/// Seconds of processor time of the shortest of several runs on the current thread. At least two unless they are long,
/// since the first one has yet to allocate its memory.
pub fn shortest(run: impl Fn() -> Result<(), String>) -> Result<f64, String> {
    shortest_by(Clock::seconds, run)
}

/// The same by a clock: [`Clock::wall`] for work on several threads.
pub fn shortest_by(clock: fn(&Clock) -> f64, run: impl Fn() -> Result<(), String>) -> Result<f64, String> {
    let begin = Clock::start();
    let (mut best, mut runs) = (f64::INFINITY, 0);
    // Processor time is told in steps of milliseconds: short runs are measured several at a time.
    let mut batch = 1_u32;
    while runs == 0 || begin.wall() < AT_LEAST || (runs < 2 && begin.wall() < LONG) {
        let start = Clock::start();
        for _ in 0..batch {
            run()?;
        }
        let took = clock(&start);
        if took < STEADY {
            batch *= 4;
        } else {
            best = best.min(took / f64::from(batch));
            runs += 1;
        }
    }
    Ok(best)
}
