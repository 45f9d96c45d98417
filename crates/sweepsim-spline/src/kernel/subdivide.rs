//! De Casteljau's algorithm along one variable of a tensor.
//!
//! A step is `s a + t b`, where `s + t = 1`: at the parameter `t`, or at the part `t` of a side whose shares were computed apart.

/// `target = s · target + t · next`, number by number.
#[inline(always)]
fn blend(target: &mut [f64], next: &[f64], s: f64, t: f64) {
    for (a, &b) in target.iter_mut().zip(next) {
        *a = s * *a + t * b;
    }
}

/// Both parts of tensors along one variable: the upper one in place, the lower one into `lower`, which is as long.
///
/// ```
/// use sweepsim_spline::kernel::split;
/// // Two lines, 0 to 4 and 1 to 2, as one tensor in (x, y): split across y.
/// let (mut upper, mut lower) = ([0.0, 1.0, 4.0, 2.0], [0.0; 4]);
/// split(&mut upper, &mut lower, 1, 2, 0.5, 0.5);
/// assert_eq!((lower, upper), ([0.0, 1.0, 2.0, 1.5], [2.0, 1.5, 4.0, 2.0]));
/// ```
#[inline]
pub fn split(upper: &mut [f64], lower: &mut [f64], degree: usize, inner: usize, s: f64, t: f64) {
    if degree == 0 {
        let count = upper.len().min(lower.len());
        lower[..count].copy_from_slice(&upper[..count]);
        return;
    }
    match inner {
        0 => {}
        1 => split_lines(upper, lower, degree + 1, s, t),
        _ => split_rows(upper, lower, degree + 1, inner, s, t),
    }
}

fn split_rows(upper: &mut [f64], lower: &mut [f64], len: usize, inner: usize, s: f64, t: f64) {
    let blocks = upper.chunks_exact_mut(inner * len);
    for (upper, lower) in blocks.zip(lower.chunks_exact_mut(inner * len)) {
        lower[..inner].copy_from_slice(&upper[..inner]);
        for step in 1..len {
            for i in 0..len - step {
                let (target, next) = upper[i * inner..(i + 2) * inner].split_at_mut(inner);
                blend(target, next, s, t);
            }
            lower[step * inner..(step + 1) * inner].copy_from_slice(&upper[..inner]);
        }
    }
}

/// [`split`] along the contiguous variable.
fn split_lines(upper: &mut [f64], lower: &mut [f64], len: usize, s: f64, t: f64) {
    match len {
        2 => split_short_lines::<2>(upper, lower, s, t),
        3 => split_short_lines::<3>(upper, lower, s, t),
        4 => split_short_lines::<4>(upper, lower, s, t),
        5 => split_short_lines::<5>(upper, lower, s, t),
        6 => split_short_lines::<6>(upper, lower, s, t),
        _ => {
            for (upper, lower) in upper.chunks_exact_mut(len).zip(lower.chunks_exact_mut(len)) {
                super::split_line(upper, lower, s, t);
            }
        }
    }
}

/// [`split_lines`] of a length known to the compiler: four lines abreast, in registers.
fn split_short_lines<const N: usize>(upper: &mut [f64], lower: &mut [f64], s: f64, t: f64) {
    const ABREAST: usize = 4;
    let mut uppers = upper.chunks_exact_mut(N * ABREAST);
    let mut lowers = lower.chunks_exact_mut(N * ABREAST);
    for (upper, lower) in (&mut uppers).zip(&mut lowers) {
        let mut b = [[0.0; ABREAST]; N];
        for i in 0..N {
            for line in 0..ABREAST {
                b[i][line] = upper[line * N + i];
            }
        }
        for step in 0..N {
            for line in 0..ABREAST {
                lower[line * N + step] = b[0][line];
            }
            for i in 0..N - 1 - step {
                for line in 0..ABREAST {
                    b[i][line] = s * b[i][line] + t * b[i + 1][line];
                }
            }
        }
        for i in 0..N {
            for line in 0..ABREAST {
                upper[line * N + i] = b[i][line];
            }
        }
    }
    let rest = uppers.into_remainder().chunks_exact_mut(N);
    for (upper, lower) in rest.zip(lowers.into_remainder().chunks_exact_mut(N)) {
        let mut b = [0.0; N];
        b.copy_from_slice(upper);
        for step in 0..N {
            lower[step] = b[0];
            for i in 0..N - 1 - step {
                b[i] = s * b[i] + t * b[i + 1];
            }
        }
        upper.copy_from_slice(&b);
    }
}

/// Keeps the part above `t` along one variable of tensors, in place.
#[inline]
pub fn keep_upper(values: &mut [f64], degree: usize, inner: usize, s: f64, t: f64) {
    if degree == 0 || inner == 0 {
        return;
    }
    if inner == 1 {
        return match degree {
            1 => upper_of_short_lines::<2>(values, s, t),
            2 => upper_of_short_lines::<3>(values, s, t),
            3 => upper_of_short_lines::<4>(values, s, t),
            4 => upper_of_short_lines::<5>(values, s, t),
            _ => {
                for line in values.chunks_exact_mut(degree + 1) {
                    for level in 0..degree {
                        for i in 0..degree - level {
                            line[i] = s * line[i] + t * line[i + 1];
                        }
                    }
                }
            }
        };
    }
    for block in values.chunks_exact_mut((degree + 1) * inner) {
        for level in 0..degree {
            for i in 0..degree - level {
                let (first, second) = block[i * inner..(i + 2) * inner].split_at_mut(inner);
                blend(first, second, s, t);
            }
        }
    }
}

fn upper_of_short_lines<const N: usize>(values: &mut [f64], s: f64, t: f64) {
    let (lines, _) = values.as_chunks_mut::<N>();
    for line in lines {
        for level in 0..N - 1 {
            for i in 0..N - 1 - level {
                line[i] = s * line[i] + t * line[i + 1];
            }
        }
    }
}

/// Keeps the part below `t` along one variable of tensors, in place.
#[inline]
pub fn keep_lower(values: &mut [f64], degree: usize, inner: usize, s: f64, t: f64) {
    if degree == 0 || inner == 0 {
        return;
    }
    if inner == 1 {
        return match degree {
            1 => lower_of_short_lines::<2>(values, s, t),
            2 => lower_of_short_lines::<3>(values, s, t),
            3 => lower_of_short_lines::<4>(values, s, t),
            4 => lower_of_short_lines::<5>(values, s, t),
            _ => {
                for line in values.chunks_exact_mut(degree + 1) {
                    for level in 0..degree {
                        for i in (level + 1..=degree).rev() {
                            line[i] = s * line[i - 1] + t * line[i];
                        }
                    }
                }
            }
        };
    }
    for block in values.chunks_exact_mut((degree + 1) * inner) {
        for level in 0..degree {
            for i in (level + 1..=degree).rev() {
                let (first, second) = block[(i - 1) * inner..(i + 1) * inner].split_at_mut(inner);
                blend(second, first, t, s);
            }
        }
    }
}

fn lower_of_short_lines<const N: usize>(values: &mut [f64], s: f64, t: f64) {
    let (lines, _) = values.as_chunks_mut::<N>();
    for line in lines {
        for level in 0..N - 1 {
            for i in (level + 1..N).rev() {
                line[i] = s * line[i - 1] + t * line[i];
            }
        }
    }
}
