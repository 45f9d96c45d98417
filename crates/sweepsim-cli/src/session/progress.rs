//! The progress bar.

use super::interruption::{interrupted, remove_at_end};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::ops::ControlFlow;
use std::time::Duration;
use sweepsim::Monitor;

/// How a phase is drawn whose steps are moves, and one that tells only its share.
const MOVES: &str = "{msg:>10} {bar:40} {human_pos}/{human_len} moves, {eta} left";
const SHARE: &str = "{msg:>10} {bar:40} {percent} %";
/// The length of the bar of a phase that tells only its share.
const WHOLE: u64 = 1000;

/// A progress bar, drawn on a terminal.
pub(crate) struct Progress {
    bar: ProgressBar,
    moves: u64,
}

impl Progress {
    /// A bar for a number of moves; nothing is drawn if `quiet`.
    pub fn new(moves: usize, quiet: bool) -> Self {
        let target = if quiet {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        let bar = ProgressBar::with_draw_target(Some(moves as u64), target);
        bar.set_style(style(MOVES));
        bar.enable_steady_tick(Duration::from_millis(200));
        remove_at_end(bar.clone());
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
