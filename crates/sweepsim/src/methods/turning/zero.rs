//! The only zero of a function in a bracket.

use crate::methods::sheets::{Undecided, halfway, newton};
use nalgebra::Vector3;

/// A function at one time.
pub(super) struct Sample<T> {
    /// The function, which is positive at the start of the bracket and negative at its end, and its derivative.
    pub value: f64,
    pub slope: f64,
    /// The derivative of the height.
    pub rise: f64,
    pub state: T,
}

/// The zero of the cubic that has the given values at the ends, as a function of the value, and the given slopes, if
/// that is in the bracket; otherwise that of the line.
fn guess(bracket: [f64; 2], [[a, da], [b, db]]: [[f64; 2]; 2]) -> f64 {
    let way = bracket[1] - bracket[0];
    let share = a / (a - b);
    let rest = 1.0 - share;
    // The inverse function rises by `way` from `a` to `b`, with these slopes.
    let [first, last] = [da, db].map(|slope| (b - a) / slope);
    let cubic = share * share * (1.0 + 2.0 * rest) * way + share * rest * (rest * first - share * last);
    let t = bracket[0] + cubic;
    // NaN is outside.
    if da < 0.0 && db < 0.0 && t > bracket[0] && t < bracket[1] {
        t
    } else {
        bracket[0] + way * share
    }
}

/// A zero that was found over a line, where the search over the next line starts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    line: [f64; 2],
    t: f64,
    /// By how much `t` grows along x and y.
    rates: [f64; 2],
    /// About by how much these grow: along x twice, along both, along y twice.
    bends: [f64; 3],
}

impl Known {
    /// `gradient`: of the function along x and y. `last`: over the line before.
    pub fn new(line: [f64; 2], t: f64, (gradient, slope): ([f64; 2], f64), last: Option<&Self>) -> Self {
        let inverse = -slope.recip();
        let rates = [gradient[0] * inverse, gradient[1] * inverse];
        let bends = last.map_or([0.0; 3], |last| last.bends_towards(line, rates));
        Self { line, t, rates, bends }
    }

    /// The symmetric form that is nearest to the last one and explains how the rates changed.
    fn bends_towards(&self, line: [f64; 2], rates: [f64; 2]) -> [f64; 3] {
        let [xx, xy, yy] = self.bends;
        let [x, y] = [line[0] - self.line[0], line[1] - self.line[1]];
        let inverse = (x * x + y * y).recip();
        let rest = [
            (rates[0] - self.rates[0] - (xx * x + xy * y)) * inverse,
            (rates[1] - self.rates[1] - (xy * x + yy * y)) * inverse,
        ];
        let both = (rest[0] * x + rest[1] * y) * inverse;
        let bends = [
            xx + x * (2.0 * rest[0] - both * x),
            xy + rest[0] * y + rest[1] * x - both * x * y,
            yy + y * (2.0 * rest[1] - both * y),
        ];
        // NaN is not.
        let finite = bends[0].abs() + bends[1].abs() + bends[2].abs() < f64::MAX;
        if finite { bends } else { [0.0; 3] }
    }

    /// About where the zero is over another line.
    #[inline]
    pub fn over(&self, line: [f64; 2]) -> f64 {
        let [x, y] = [line[0] - self.line[0], line[1] - self.line[1]];
        let [xx, xy, yy] = self.bends;
        self.t + x * (self.rates[0] + 0.5 * xx * x + xy * y) + y * (self.rates[1] + 0.5 * yy * y)
    }
}

/// A crossing: where a sheet turns, or a rim passes.
pub(super) struct Turn {
    pub t: f64,
    pub height: f64,
    /// Of any length.
    pub normal: Vector3<f64>,
}

/// Where to start without a zero that is known: `ends` are the values and slopes at the ends of the bracket, where the
/// function exists.
pub(super) fn start(bracket: [f64; 2], ends: [Option<[f64; 2]>; 2]) -> f64 {
    match ends {
        [Some(a), Some(b)] => guess(bracket, [a, b]),
        // From the end where it is known.
        [Some([value, slope]), None] => bracket[0] - value / slope,
        [None, Some([value, slope])] => bracket[1] - value / slope,
        [None, None] => f64::NAN,
    }
}

/// Newton's method in a bracket, from `start` if that is inside. `at` gives the function, or `None` where it does not
/// exist: then it does not on one side of the bracket, which is not `there`. `done(time, step, sample)` is asked for
/// the result before each step to a time, and refuses as long as steps have to become smaller.
#[inline]
pub(super) fn zero<T, R>(
    bracket: [f64; 2],
    (there, start): ([bool; 2], f64),
    mut at: impl FnMut(f64) -> Option<Sample<T>>,
    mut done: impl FnMut(f64, f64, &Sample<T>) -> Option<R>,
) -> Result<R, Undecided> {
    // As if it had its sign at the end beyond which it does not exist.
    let beyond = if there[0] { -1.0 } else { 1.0 };
    let at = |t: f64| match at(t) {
        Some(sample) => (sample.value, sample.value / sample.slope, Some(sample)),
        None => (beyond, f64::NAN, None),
    };
    let done = |t: f64, step: f64, sample: &Option<Sample<T>>, [a, b]: [f64; 2]| {
        let next = t - step;
        // NaN is outside.
        let inside = next >= a && next <= b;
        sample
            .as_ref()
            .filter(|_| inside)
            .and_then(|sample| done(next, -step, sample))
    };
    newton(bracket, (false, start), halfway, at, done).ok_or(Undecided::Close)
}
