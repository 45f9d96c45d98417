//! The boxes that the repairs of a sweep may examine: degenerate input ends with unresolved lines, and not never.

use std::sync::atomic::{AtomicU64, Ordering};

/// For a sweep, and for each part of its path.
const SWEEP: [u64; 2] = [50_000_000, 20_000];
/// The least and the most that a line may use.
const LINE: [u64; 2] = [2_000, 1_000_000];

/// What is left of the budget.
#[derive(Debug)]
pub(crate) struct RepairBudget(AtomicU64);

impl RepairBudget {
    pub fn new(parts: usize) -> Self {
        Self(AtomicU64::new(SWEEP[0] + SWEEP[1] * parts as u64))
    }

    /// The boxes for each of some lines. Asked before all of them and [spent](Self::spend) after all of them, it does not depend on the number of
    /// threads.
    pub fn of_each(&self, lines: usize) -> u64 {
        (self.0.load(Ordering::Relaxed) / lines.max(1) as u64).clamp(LINE[0], LINE[1])
    }

    pub fn spend(&self, boxes: u64) {
        let left = self.0.load(Ordering::Relaxed).saturating_sub(boxes);
        self.0.store(left, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_lines_share_what_is_left() {
        let budget = RepairBudget::new(0);
        assert_eq!(budget.of_each(1), LINE[1]);
        assert_eq!(budget.of_each(1_000), 50_000);
        budget.spend(49_000_000);
        assert_eq!(budget.of_each(100), 10_000);
        budget.spend(u64::MAX);
        assert_eq!(budget.of_each(1), LINE[0]);
    }
}
