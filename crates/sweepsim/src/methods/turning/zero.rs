//! The only zero of a function in a bracket.

use super::shell::Undecided;
use nalgebra::Vector3;

/// Steps of Newton's method, or halvings of a bracket.
const STEPS: usize = 60;
/// The last step is no longer than this part of the motion: normals turn with it.
const LAST: f64 = 1e-5;

/// A function at one time.
pub(super) struct Sample<T> {
    /// The function, which is positive at the start of the bracket and negative at its end, and its derivative.
    pub value: f64,
    pub slope: f64,
    /// The derivative of the height.
    pub rise: f64,
    pub state: T,
}

/// The zero of the cubic that has the given values at the ends, as a function of the value, and the given slopes, if that is in the bracket; otherwise that of the line.
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
}

impl Known {
    /// `gradient`: of the function along x and y.
    pub fn new(line: [f64; 2], t: f64, gradient: [f64; 2], slope: f64) -> Self {
        Self {
            line,
            t,
            rates: gradient.map(|part| -part / slope),
        }
    }

    /// About where the zero is over another line.
    #[inline]
    pub fn over(&self, [x, y]: [f64; 2]) -> f64 {
        self.t + self.rates[0] * (x - self.line[0]) + self.rates[1] * (y - self.line[1])
    }
}

/// Where a sheet turns.
pub(super) struct Turn {
    pub t: f64,
    pub height: f64,
    /// Of any length.
    pub normal: Vector3<f64>,
}

/// Newton's method in a bracket, with the values and slopes at its ends, from `start` if that is inside. `at` gives the function, or `None` where it does not exist: then it does not on one side of the bracket, whose value is `None`. When the
/// height changes by no more than `near` in the next step, `done(time, step, sample)` is asked for the result, which it may refuse as long as steps become smaller.
pub(super) fn zero<T, R>(
    mut bracket: [f64; 2],
    (ends, start): ([Option<[f64; 2]>; 2], Option<f64>),
    near: f64,
    mut at: impl FnMut(f64) -> Option<Sample<T>>,
    mut done: impl FnMut(f64, f64, &Sample<T>) -> Option<R>,
) -> Result<R, Undecided> {
    let start = start.filter(|t| *t > bracket[0] && *t < bracket[1]);
    let mut t = start.unwrap_or_else(|| match ends {
        [Some(a), Some(b)] => guess(bracket, [a, b]),
        // From the end where it is known.
        [Some([value, slope]), None] => bracket[0] - value / slope,
        [None, Some([value, slope])] => bracket[1] - value / slope,
        [None, None] => f64::NAN,
    });
    if !(t > bracket[0] && t < bracket[1]) {
        t = 0.5 * (bracket[0] + bracket[1]);
    }
    for _ in 0..STEPS {
        let Some(sample) = at(t) else {
            bracket[usize::from(ends[0].is_some())] = t;
            t = 0.5 * (bracket[0] + bracket[1]);
            continue;
        };
        bracket[usize::from(sample.value < 0.0)] = t;
        let step = -sample.value / sample.slope;
        let next = t + step;
        // NaN is outside.
        if !(next >= bracket[0] && next <= bracket[1]) {
            let middle = 0.5 * (bracket[0] + bracket[1]);
            if middle <= bracket[0] || middle >= bracket[1] {
                return Err(Undecided::Close);
            }
            t = middle;
            continue;
        }
        if (sample.rise * step).abs() <= near && step.abs() <= LAST {
            if let Some(result) = done(next, step, &sample) {
                return Ok(result);
            }
            if step.abs() <= f64::EPSILON || next == t {
                return Err(Undecided::Close);
            }
        }
        t = next;
    }
    Err(Undecided::Close)
}
