//! The least value of a function of time near a sample, without derivatives.

/// Parts that a bracket is cut into at each step.
const PARTS: usize = 8;

/// The least value found, where, and by how much the last bracket still varied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Minimum {
    /// Where it is.
    pub at: f64,
    /// The value there.
    pub value: f64,
    /// The smaller rise to a neighbouring sample of the last bracket: an estimate of the error, generous for a smooth
    /// minimum.
    pub rise: f64,
}

/// Minimises `f` on `[a, b]` by repeated sampling of ever smaller brackets: robust to corners and to jumps to `+∞`, and
/// to a second minimum that is higher by more than it varies on an eighth of the bracket. Stops when the last bracket
/// varies by less than `fine`.
pub fn minimise(mut f: impl FnMut(f64) -> f64, mut a: f64, mut b: f64, fine: f64) -> Minimum {
    let mut best = Minimum {
        at: a,
        value: f(a),
        rise: f64::INFINITY,
    };
    let end = f(b);
    if end < best.value {
        (best.at, best.value) = (b, end);
    }
    for _ in 0..24 {
        let step = (b - a) / PARTS as f64;
        let mut values = [0.0; PARTS + 1];
        let at = |i: usize| if i == PARTS { b } else { a + step * i as f64 };
        let mut least = 0;
        for (i, value) in values.iter_mut().enumerate() {
            *value = f(at(i));
        }
        for i in 1..=PARTS {
            if values[i] < values[least] {
                least = i;
            }
        }
        if values[least] < best.value {
            (best.at, best.value) = (at(least), values[least]);
        }
        let (left, right) = (least.saturating_sub(1), (least + 1).min(PARTS));
        let rise = |i: usize| {
            if i == least {
                f64::INFINITY
            } else {
                values[i] - values[least]
            }
        };
        let rises = [rise(left), rise(right)];
        // At a jump the lower side tells how exact the value is.
        best.rise = rises[0].min(rises[1]);
        let settled = |i: usize| i == least || values[i] - values[least] <= fine;
        if (settled(left) && settled(right)) || b - a < 1e-14 {
            break;
        }
        (a, b) = (at(left), at(right));
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_sharp_and_broken_minima() {
        let smooth = minimise(|t| (t - 0.3).powi(2), 0.0, 1.0, 1e-12);
        assert!(smooth.value < 1e-12 && smooth.rise <= 1e-12);
        let sharp = minimise(|t| 50.0 * (t - 0.7).abs(), 0.0, 1.0, 1e-12);
        assert!(sharp.value < 1e-10);
        let broken = minimise(|t| if t < 0.413 { f64::INFINITY } else { t }, 0.0, 1.0, 1e-12);
        assert!((broken.value - 0.413).abs() < 1e-12);
        let at_the_end = minimise(|t| -t, 0.0, 1.0, 1e-12);
        assert_eq!((at_the_end.at, at_the_end.value), (1.0, -1.0));
    }
}
