//! A motion is divided into spans of time that are short enough for what has to be certain.

use super::axis_motion::{AxisMotion, Bounds, Moment};
use super::{Element, Leftover};

/// Spans are halved this many times at most,
const DEEPEST: u32 = 6;
/// and so many times where the axis is almost upright on the way.
const DEEPEST_UPRIGHT: u32 = 16;

/// A span between two moments.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub from: Moment,
    pub to: Moment,
    pub bounds: Bounds,
    /// Whether it cannot be divided.
    pub last: bool,
}

impl Span {
    /// Whether a point at this height goes so far that ranges over a block of lines tell little, and over so many lines
    /// that more spans cost less.
    pub fn is_far(&self, height: f64, radius: f64, spacing: f64) -> bool {
        self.bounds.length * (self.bounds.speed + height * self.bounds.rate) > 0.5 * radius + 16.0 * spacing
    }
}

/// What becomes of a span.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// But for some lines, which charts have to solve.
    Settled(Vec<u32>),
    /// It is too long, or charts have to solve it.
    Long,
    /// It is too long, since the axis is almost upright on the way: halves lean half as much, or their axis turns about
    /// the vertical half as much.
    Upright,
    /// Charts have to solve it, and its halves, too.
    Intricate,
}

/// Settles a motion span by span. What remains is left to charts for all lines.
pub(super) fn settle(
    motion: &AxisMotion,
    element: &Element,
    leftovers: &mut Vec<Leftover>,
    mut settle: impl FnMut(&Span) -> Verdict,
) {
    // In the order of time: halves are put back, the later one first.
    let mut spans = vec![(motion.at(0.0), motion.at(1.0), 0)];
    while let Some((from, to, depth)) = spans.pop() {
        let span = Span {
            from,
            to,
            bounds: motion.bounds([&from, &to]),
            last: depth >= DEEPEST,
        };
        let left = |all: bool, lines: Vec<u32>| Leftover {
            element: element.clone(),
            times: [from.t, to.t],
            all,
            lines,
        };
        let verdict = settle(&span);
        let deepest = match verdict {
            Verdict::Upright => DEEPEST_UPRIGHT,
            _ => DEEPEST,
        };
        match verdict {
            Verdict::Settled(lines) if lines.is_empty() => {}
            Verdict::Settled(lines) => leftovers.push(left(false, lines)),
            Verdict::Long | Verdict::Upright if depth < deepest => {
                let middle = motion.at(0.5 * (from.t + to.t));
                spans.push((middle, to, depth + 1));
                spans.push((from, middle, depth + 1));
            }
            Verdict::Long | Verdict::Upright | Verdict::Intricate => {
                let left = left(true, Vec::new());
                match leftovers.last_mut() {
                    Some(before) if before.follows(&left) => before.times[1] = to.t,
                    _ => leftovers.push(left),
                }
            }
        }
    }
}
