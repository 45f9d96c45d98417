//! The progress bar, and how a run is interrupted.

use crate::failure::Failure;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use sweepsim::Monitor;

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Shows how far a run is, on a terminal, and asks it to end when the user presses Ctrl-C.
pub(crate) struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// `moves` to go; nothing is drawn when `quiet`.
    pub fn new(moves: usize, quiet: bool) -> Self {
        // A second Ctrl-C ends the process at once. A handler that cannot be set leaves it at the first.
        static HANDLER: OnceLock<()> = OnceLock::new();
        HANDLER.get_or_init(|| {
            let _ = ctrlc::set_handler(|| {
                if INTERRUPTED.swap(true, Ordering::Relaxed) {
                    std::process::exit(130);
                }
            });
        });
        let target = if quiet {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        let bar = ProgressBar::with_draw_target(Some(moves as u64), target);
        let style = ProgressStyle::with_template("{msg:>10} {bar:40} {human_pos}/{human_len} moves, {eta} left");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.enable_steady_tick(Duration::from_millis(200));
        Self { bar }
    }

    /// Names what is being done now.
    pub fn phase(&self, name: &'static str) {
        self.bar.set_message(name);
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }

    /// Ends a run that the user has interrupted.
    pub fn check(&self) -> Result<(), Failure> {
        if self.cancelled() {
            self.finish();
            return Err(Failure::Interrupted);
        }
        Ok(())
    }
}

impl Monitor for Progress {
    fn advance(&self, done: usize, _: usize) {
        self.bar.set_position(done as u64);
    }

    fn cancelled(&self) -> bool {
        INTERRUPTED.load(Ordering::Relaxed)
    }
}
