//! Degree elevation in place.

/// Raises the degree of one block of rows by one: the first `degree + 1` rows of `inner` numbers become `degree + 2`.
///
/// ```
/// use sweepsim_spline::kernel::elevate;
///
/// // x on [0, 1] as a form of degree 2.
/// let mut block = [0.0, 1.0, 0.0];
/// elevate(&mut block, 1, 1);
/// assert_eq!(block, [0.0, 0.5, 1.0]);
/// ```
///
/// # Panics
/// If `block` is shorter than `degree + 2` rows.
pub fn elevate(block: &mut [f64], degree: usize, inner: usize) {
    block.copy_within(degree * inner..(degree + 1) * inner, (degree + 1) * inner);
    let order = (degree + 1) as f64;
    for k in (1..=degree).rev() {
        let (before, after) = block.split_at_mut(k * inner);
        let (s, t) = ((order - k as f64) / order, k as f64 / order);
        for (a, &b) in after[..inner].iter_mut().zip(&before[(k - 1) * inner..]) {
            *a = s * *a + t * b;
        }
    }
}
