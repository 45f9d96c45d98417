//! The progress bar.

use super::interruption::{interrupted, remove_at_end};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::Duration;
use sweepsim_job::Monitor;

/// How a phase is drawn whose steps are moves, and one that tells only its share.
const MOVES: &str = "{msg:>10} {bar:40} {human_pos}/{human_len} moves, {eta} left";
const SHARE: &str = "{msg:>10} {bar:40} {percent} %";
/// The phases that tell only their share.
const SHARES: [&str; 2] = ["picture", "frames"];

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
        let moves = moves as u64;
        Self { bar, moves }
    }

    /// Removes the bar.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Monitor for Progress {
    fn phase(&self, name: &'static str) {
        self.bar.set_message(name);
        if SHARES.contains(&name) {
            self.bar.set_style(style(SHARE));
            self.bar.set_position(0);
        } else {
            self.bar.set_style(style(MOVES));
            self.bar.set_length(self.moves);
        }
    }

    fn advance(&self, done: usize, total: usize) {
        if SHARES.contains(&self.bar.message().as_str()) {
            self.bar.set_length(total as u64);
        }
        self.bar.set_position(done as u64);
    }

    fn cancelled(&self) -> bool {
        interrupted()
    }
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}
