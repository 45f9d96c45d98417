//! Intervals that are no longer than the tolerance: rounding leaves them where a cut touches another one, or ends on
//! the stock's surface. They may be as high as the cut is deep.

use std::borrow::Cow;
use sweepsim_dexel::{Dexels, Interval, Line};

/// What remains without them.
pub(in crate::verify) fn without(remaining: &Dexels, tolerance: f64) -> Cow<'_, Dexels> {
    let mut all = Cow::Borrowed(remaining);
    if remaining.iter().any(|(_, line)| has_thin(line, tolerance)) {
        drop_where(all.to_mut(), tolerance, |_| true);
    }
    all
}

/// Drops those for which this holds.
pub(in crate::verify) fn drop_where(all: &mut Dexels, tolerance: f64, is: impl Fn(&Interval) -> bool) {
    let is_sliver = |own: &Interval| own.upper.z - own.lower.z <= tolerance && is(own);
    let thin = all.iter().filter(|(_, line)| has_thin(*line, tolerance));
    let kept = |line: Line| line.iter().filter(|own| !is_sliver(own)).collect();
    let kept: Vec<(usize, Vec<Interval>)> = thin.map(|(number, line)| (number, kept(line))).collect();
    for (number, line) in kept {
        all.set(number, &line).expect("some of the intervals of a line");
    }
}

fn has_thin(line: Line, tolerance: f64) -> bool {
    line.heights().any(|[lower, upper]| upper - lower <= tolerance)
}
