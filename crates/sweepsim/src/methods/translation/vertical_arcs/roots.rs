//! The solutions of `Q(x) = y` for a curve parallel to a section: there is one where `Q′` has one sign, and the values
//! at both ends are on different sides.

use crate::methods::sheets::Undecided::{self, Close};
use crate::methods::sheets::{halfway, newton};

/// Stretches are halved so many times at most,
const HALVINGS: usize = 30;
/// and there are so many for one line.
const STRETCHES: usize = 240;

/// A solution.
pub(super) struct Root<P> {
    pub at: P,
    /// How far off it may be.
    pub error: f64,
    /// Whether `Q` grows there.
    pub grows: bool,
}

/// What is known between two places.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// The range of `Q′`.
    pub slope: [f64; 2],
    /// How much `Q` is off by if coordinates are off by `slack`.
    pub error: f64,
}

impl Bounds {
    pub const UNKNOWN: Self = Self {
        slope: [f64::NEG_INFINITY, f64::INFINITY],
        error: f64::INFINITY,
    };
}

/// A point with its unknown, and the value there.
pub(super) trait CurvePoint: Copy {
    fn unknown(&self) -> f64;
    fn value(&self) -> f64;
}

/// A function of one unknown.
pub(super) trait Curve {
    type Point: CurvePoint;
    fn at(&self, x: f64) -> Self::Point;
    /// `Q′`.
    fn slope(&self, at: &Self::Point) -> f64;
    /// Between two places, ascending.
    fn bounds(&self, ends: [&Self::Point; 2]) -> Bounds;
    /// By how much `Q` may be off.
    fn error_at(&self, at: &Self::Point) -> f64;
    /// Whether it is where another curve goes on, on which the same line is searched.
    fn is_axis(&self, _: &Self::Point) -> bool {
        false
    }
    /// Whether `Q` is certainly not 0 between two places, ascending.
    fn vanishes_nowhere(&self, _: [&Self::Point; 2]) -> bool {
        false
    }
    /// The rounding error of coordinates.
    fn slack(&self) -> f64;
}

/// A section, with the part of it whose envelope may be over a line.
pub(super) struct Search<C> {
    pub curve: C,
    /// The wanted value of `Q`.
    pub y: f64,
    /// −1 if the curve is traversed backwards: behind the axis, the half has its start at the axis where the other has
    /// its end.
    pub mirror: f64,
}

impl<C: Curve> Search<C> {
    /// On which side of the line: the same at the axis for both halves.
    fn before(&self, at: &C::Point) -> bool {
        if self.mirror > 0.0 {
            at.value() < self.y
        } else {
            at.value() > self.y
        }
    }

    /// Whether the line may be met between two places.
    fn may_meet(&self, [a, b]: [&C::Point; 2]) -> bool {
        let bounds = self.curve.bounds([a, b]);
        let steepest = bounds.slope[0].abs().max(bounds.slope[1].abs());
        let reach = 0.5 * (b.unknown() - a.unknown()) * steepest + bounds.error;
        // Infinite values and NaN may.
        !((0.5 * (a.value() + b.value()) - self.y).abs() > reach || self.curve.vanishes_nowhere([a, b]))
    }

    /// All solutions in a part of the section. The range of each of its ends; the range beyond which the envelope is
    /// not on the arc.
    pub fn roots(
        &self,
        [from, to]: [[f64; 2]; 2],
        clip: [f64; 2],
        mut found: impl FnMut(Root<C::Point>) -> Result<(), Undecided>,
    ) -> Result<(), Undecided> {
        let all = [from[0].max(clip[0]), to[1].min(clip[1])];
        if !(all[0] <= all[1]) {
            return Ok(());
        }
        let sure = [from[1].max(all[0]), to[0].min(all[1])];
        let [first, last] = all.map(|x| self.curve.at(x));
        if !(sure[0] < sure[1]) {
            return if self.may_meet([&first, &last]) {
                Err(Close)
            } else {
                Ok(())
            };
        }
        let [a, b] = sure.map(|x| self.curve.at(x));
        for (end, beyond) in [(&a, &first), (&b, &last)] {
            let uncertain = if end.unknown() == beyond.unknown() {
                // An end of the arc, or the axis.
                !self.curve.is_axis(end) && !((end.value() - self.y).abs() > self.curve.error_at(end))
            } else if end.unknown() < beyond.unknown() {
                self.may_meet([end, beyond])
            } else {
                self.may_meet([beyond, end])
            };
            if uncertain {
                return Err(Close);
            }
        }
        let mut stretches = 0;
        self.between([&a, &b], (0, &mut stretches), &mut found)
    }

    /// The solutions between two places.
    fn between(
        &self,
        [a, b]: [&C::Point; 2],
        (depth, stretches): (usize, &mut usize),
        found: &mut impl FnMut(Root<C::Point>) -> Result<(), Undecided>,
    ) -> Result<(), Undecided> {
        let bounds = self.curve.bounds([a, b]);
        let [low, high] = bounds.slope;
        let differ = self.before(a) != self.before(b);
        if low > 0.0 || high < 0.0 {
            let grows = low > 0.0;
            if !differ {
                return Ok(());
            }
            if (b.value() > a.value()) != grows {
                return Err(Close);
            }
            let at = self.solve([a, b]).ok_or(Close)?;
            let error = (bounds.error + (at.value() - self.y).abs()) / low.abs().min(high.abs());
            return found(Root { at, error, grows });
        }
        let reach = 0.5 * (b.unknown() - a.unknown()) * low.abs().max(high) + bounds.error;
        if !differ && (0.5 * (a.value() + b.value()) - self.y).abs() > reach {
            return Ok(());
        }
        if !differ && self.curve.vanishes_nowhere([a, b]) {
            return Ok(());
        }
        *stretches += 1;
        if depth == HALVINGS || *stretches > STRETCHES {
            return Err(Close);
        }
        let middle = self.curve.at(0.5 * (a.unknown() + b.unknown()));
        self.between([a, &middle], (depth + 1, stretches), found)?;
        self.between([&middle, b], (depth + 1, stretches), found)
    }

    /// The solution between two places on different sides.
    fn solve(&self, [a, b]: [&C::Point; 2]) -> Option<C::Point> {
        let enough = 0.25 * self.curve.slack();
        let ends = [a.unknown(), b.unknown()];
        let share = (self.y - a.value()) / (b.value() - a.value());
        let at = |x: f64| {
            let at = self.curve.at(x);
            let value = at.value() - self.y;
            (value, value / self.curve.slope(&at), at)
        };
        let done = |_, _, at: &C::Point, [a, b]: [f64; 2]| {
            let middle = halfway(a, b);
            let is_last = (at.value() - self.y).abs() <= enough || !(middle > a && middle < b);
            is_last.then_some(*at)
        };
        let start = ends[0] + (ends[1] - ends[0]) * share;
        newton(ends, (b.value() > a.value(), start), halfway, at, done)
    }
}
