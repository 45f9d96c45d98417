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

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    proptest! {
        /// The only zero is found wherever the search starts, by right slopes and where steps lead nowhere.
        #[test]
        fn the_only_zero(root in 0.001..0.999_f64, start in -1.0..2.0_f64, bend in 0.0..50.0_f64, rises in any::<bool>()) {
            let sign = if rises { 1.0 } else { -1.0 };
            let value = |x: f64| sign * ((x - root) + bend * (x - root).powi(3));
            let slope = |x: f64| sign * (1.0 + 3.0 * bend * (x - root).powi(2));
            for step in [|value: f64, slope: f64| value / slope, |_, _| f64::NAN, |_, _| 0.0, |_, slope| 2.0 * slope] {
                for halves in [middle, halfway] {
                    let at = |x: f64| (value(x), step(value(x), slope(x)), slope(x));
                    let done = |x: f64, step: f64, slope: &f64, [a, b]: [f64; 2]| {
                        let near = (step * slope).abs() < 1e-13 && step != 0.0;
                        (near || b - a < 1e-12).then_some(x)
                    };
                    let found = newton([0.0, 1.0], (rises, start), halves, at, done);
                    prop_assert!(found.is_some_and(|x| (x - root).abs() < 1e-11), "{found:?}");
                }
            }
        }
    }
}
