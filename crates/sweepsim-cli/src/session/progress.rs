//! The progress bar, and interruption by Ctrl-C or by the system (SIGTERM, SIGHUP).

use super::Failure;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use sweepsim::Monitor;

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Draws a progress bar on a terminal, and cancels the run when the user presses Ctrl-C.
pub(crate) struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar for a number of moves; nothing is drawn if `quiet`.
    pub fn new(moves: usize, quiet: bool) -> Self {
        // A second Ctrl-C ends the process at once. If the handler cannot be set, the first one does.
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

    /// Names the current phase.
    pub fn phase(&self, name: &'static str) {
        self.bar.set_message(name);
    }

    /// Removes the bar.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }

    /// Fails if the user has interrupted the run.
    pub fn check(&self) -> Result<(), Failure> {
        if self.cancelled() {
            self.finish();
            return Err(Failure::interrupted());
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
