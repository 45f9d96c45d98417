//! Comparisons that answer only beyond an error.

/// Whether a number that is known up to an error lies in a range, if that is certain. NaN never is.
#[inline]
pub(crate) fn certainly_within(value: f64, [low, high]: [f64; 2], error: f64) -> Option<bool> {
    if value > low + error && value < high - error {
        Some(true)
    } else if value < low - error || value > high + error {
        Some(false)
    } else {
        None
    }
}
