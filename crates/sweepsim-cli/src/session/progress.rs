//! The progress bar, and interruption by Ctrl-C or by the system (SIGTERM, SIGHUP).

use super::Failure;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::ops::ControlFlow;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use sweepsim::Monitor;

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// How a phase is drawn whose steps are moves, and one that tells only its share.
const MOVES: &str = "{msg:>10} {bar:40} {human_pos}/{human_len} moves, {eta} left";
const SHARE: &str = "{msg:>10} {bar:40} {percent} %";
/// The length of the bar of a phase that tells only its share.
const WHOLE: u64 = 1000;

/// Whether the user, or the system, has interrupted the run.
pub(crate) fn interrupted() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// Draws a progress bar on a terminal, and cancels the run when the user presses Ctrl-C.
pub(crate) struct Progress {
    bar: ProgressBar,
    moves: u64,
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
        bar.set_style(style(MOVES));
        bar.enable_steady_tick(Duration::from_millis(200));
        Self {
            bar,
            moves: moves as u64,
        }
    }

    /// Names the current phase, whose steps are moves.
    pub fn phase(&self, name: &'static str) {
        self.bar.set_message(name);
        self.bar.set_style(style(MOVES));
        self.bar.set_length(self.moves);
    }

    /// Names the current phase, which tells its share as it goes on.
    pub fn phase_of_shares(&self, name: &'static str) {
        self.bar.set_message(name);
        self.bar.set_style(style(SHARE));
        self.bar.set_length(WHOLE);
        self.bar.set_position(0);
    }

    /// Draws the share of the phase that is done, unless the run has been interrupted.
    pub fn share(&self, share: f64) -> ControlFlow<()> {
        self.bar.set_position((share * WHOLE as f64) as u64);
        if interrupted() {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
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
        interrupted()
    }
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}
