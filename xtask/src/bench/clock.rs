//! Clocks: of the wall, and of the processor time that a thread has had, which other programs on the machine disturb
//! less.

use std::fs;
use std::time::Instant;

/// Measures a piece of work on the current thread.
pub struct Clock {
    wall: Instant,
    /// Nanoseconds on a processor, where the system tells.
    own: Option<u64>,
}

impl Clock {
    pub fn start() -> Self {
        Self {
            wall: Instant::now(),
            own: on_processor(),
        }
    }

    /// Seconds of processor time of this thread; on systems that do not tell, seconds of the wall clock.
    pub fn seconds(&self) -> f64 {
        match (self.own, on_processor()) {
            (Some(start), Some(end)) => end.saturating_sub(start) as f64 * 1e-9,
            _ => self.wall.elapsed().as_secs_f64(),
        }
    }

    /// Seconds of the wall clock.
    pub fn wall(&self) -> f64 {
        self.wall.elapsed().as_secs_f64()
    }
}

/// Linux: the first number of `schedstat`.
fn on_processor() -> Option<u64> {
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split_whitespace().next()?.parse().ok()
}

/// The system's load over the last minute, for the records: processes that want a processor.
pub fn load() -> Option<f64> {
    let text = fs::read_to_string("/proc/loadavg").ok()?;
    text.split_whitespace().next()?.parse().ok()
}
