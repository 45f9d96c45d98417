//! `cargo xtask bench`: runs benchmarks, and prints the results beside the paper's.

mod instructions;
mod programs;
mod systems;
mod table1;
mod three_axis;

pub use instructions::{instructions, work};
pub use programs::programs;
pub use systems::systems;
pub use table1::table1;
pub use three_axis::three_axis;

use std::time::{Duration, Instant};

/// Each measurement is repeated until this much time has passed; the shortest run counts.
const AT_LEAST: Duration = Duration::from_millis(400);

/// Runs some work on this many threads.
fn on<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(pool.map_err(|error| error.to_string())?.install(work))
}

/// The shortest of several runs, at least two, since the first one has yet to allocate its memory.
fn shortest(run: impl Fn() -> Result<(), String>) -> Result<f64, String> {
    let begin = Instant::now();
    let (mut best, mut runs) = (f64::INFINITY, 0);
    while runs < 2 || begin.elapsed() < AT_LEAST {
        let start = Instant::now();
        run()?;
        best = best.min(start.elapsed().as_secs_f64());
        runs += 1;
    }
    Ok(best)
}
