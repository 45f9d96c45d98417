//! De Casteljau's algorithm along one variable of a tensor.

/// A step of the algorithm: the number between two neighbours.
trait Blend: Copy {
    fn of(self, a: f64, b: f64) -> f64;
}

/// `s a + t b`, where `s + t = 1`: for a part of a side whose weights were computed separately.
#[derive(Clone, Copy)]
struct Shares(f64, f64);

impl Blend for Shares {
    #[inline(always)]
    fn of(self, a: f64, b: f64) -> f64 {
        self.0 * a + self.1 * b
    }
}

/// `a + t (b − a)`: constants stay exact.
#[derive(Clone, Copy)]
struct Towards(f64);

impl Blend for Towards {
    #[inline(always)]
    fn of(self, a: f64, b: f64) -> f64 {
        a + self.0 * (b - a)
    }
}

/// Replaces every number of `target` by the one between it and its neighbour in `next`.
#[inline(always)]
fn blend(target: &mut [f64], next: &[f64], step: impl Blend) {
    for (a, &b) in target.iter_mut().zip(next) {
        *a = step.of(*a, b);
    }
}

/// Both parts of tensors along one variable: the upper one in place, the lower one into `lower`, which is as long.
///
/// Steps are `s a + t b`; `s + t = 1`.
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
    split_by(upper, lower, degree, inner, Shares(s, t));
}

/// As [`split`] at `t`, by steps `a + t (b − a)`: parts of a constant are exactly that constant.
///
/// ```
/// use sweepsim_spline::kernel::{split, split_at};
/// let (mut upper, mut lower) = ([0.7; 4], [0.0; 4]);
/// split_at(&mut upper, &mut lower, 3, 1, 0.492);
/// assert_eq!((upper, lower), ([0.7; 4], [0.7; 4]));
/// ```
#[inline]
pub fn split_at(upper: &mut [f64], lower: &mut [f64], degree: usize, inner: usize, t: f64) {
    split_by(upper, lower, degree, inner, Towards(t));
}

#[inline]
fn split_by(upper: &mut [f64], lower: &mut [f64], degree: usize, inner: usize, step: impl Blend) {
    if degree == 0 {
        let count = upper.len().min(lower.len());
        lower[..count].copy_from_slice(&upper[..count]);
        return;
    }
    match inner {
        0 => {}
        1 => split_lines(upper, lower, degree + 1, step),
        _ => split_rows(upper, lower, degree + 1, inner, step),
    }
}

fn split_rows(upper: &mut [f64], lower: &mut [f64], len: usize, inner: usize, step: impl Blend) {
    let blocks = upper.chunks_exact_mut(inner * len);
    for (upper, lower) in blocks.zip(lower.chunks_exact_mut(inner * len)) {
        lower[..inner].copy_from_slice(&upper[..inner]);
        for level in 1..len {
            for i in 0..len - level {
                let (target, next) = upper[i * inner..(i + 2) * inner].split_at_mut(inner);
                blend(target, next, step);
            }
            lower[level * inner..(level + 1) * inner].copy_from_slice(&upper[..inner]);
        }
    }
}

/// [`split_by`] along the contiguous variable.
fn split_lines(upper: &mut [f64], lower: &mut [f64], len: usize, step: impl Blend) {
    match len {
        2 => split_short_lines::<2>(upper, lower, step),
        3 => split_short_lines::<3>(upper, lower, step),
        4 => split_short_lines::<4>(upper, lower, step),
        5 => split_short_lines::<5>(upper, lower, step),
        6 => split_short_lines::<6>(upper, lower, step),
        9 => split_short_lines::<9>(upper, lower, step),
        _ => {
            for (upper, lower) in upper.chunks_exact_mut(len).zip(lower.chunks_exact_mut(len)) {
                lower[0] = upper[0];
                for level in 1..len {
                    for i in 0..len - level {
                        upper[i] = step.of(upper[i], upper[i + 1]);
                    }
                    lower[level] = upper[0];
                }
            }
        }
    }
}

/// [`split_lines`] of a length known to the compiler: four lines side by side, in registers.
fn split_short_lines<const N: usize>(upper: &mut [f64], lower: &mut [f64], by: impl Blend) {
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
                    b[i][line] = by.of(b[i][line], b[i + 1][line]);
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
                b[i] = by.of(b[i], b[i + 1]);
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
                blend(first, second, Shares(s, t));
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
                blend(second, first, Shares(t, s));
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
