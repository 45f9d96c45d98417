//! Newton's method in a bracket.

/// Steps of Newton's method, or bisections, of which a handful suffice.
pub(crate) const STEPS: usize = 80;

/// The middle of a bracket: the geometric one where its ends differ by much.
pub(crate) fn middle(a: f64, b: f64) -> f64 {
    if b > 4.0 * a && a > 0.0 {
        (a * b).sqrt()
    } else {
        halfway(a, b)
    }
}

/// The middle of a bracket.
pub(crate) fn halfway(a: f64, b: f64) -> f64 {
    0.5 * (a + b)
}

/// Steps of Newton's method from `start`, or to the middle of the bracket where one leads out of it: next to an extreme
/// it may be anything. `at` gives the value, which `rises` or falls, the step to be subtracted, and what else `done`
/// gets, which is asked for the result at each place, with the bracket that remains.
#[inline]
pub(crate) fn newton<T, R>(
    [mut a, mut b]: [f64; 2],
    (rises, start): (bool, f64),
    middle: impl Fn(f64, f64) -> f64,
    mut at: impl FnMut(f64) -> (f64, f64, T),
    mut done: impl FnMut(f64, f64, &T, [f64; 2]) -> Option<R>,
) -> Option<R> {
    let mut x = start;
    for _ in 0..STEPS {
        // NaN is outside.
        if !(x > a && x < b) {
            x = middle(a, b);
        }
        let (value, step, own) = at(x);
        if (value < 0.0) == rises {
            a = x;
        } else {
            b = x;
        }
        if let Some(found) = done(x, step, &own, [a, b]) {
            return Some(found);
        }
        x -= step;
    }
    None
}
