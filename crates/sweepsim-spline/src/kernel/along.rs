//! The layout that all forms share: a dense tensor, first axis fastest, seen along one axis as `outer × len × inner`.
//!
//! A linear operation along an axis (de Casteljau, elevation, knot insertion) acts on rows of `inner` contiguous
//! numbers, so that the compiler vectorises it whatever the axis; a vector-valued form has its components as the
//! fastest axis and needs no code of its own.

/// A tensor seen along one axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Along {
    /// Numbers between neighbours on the axis.
    pub inner: usize,
    /// Length of the axis.
    pub len: usize,
    /// How many independent blocks of `inner × len` there are.
    pub outer: usize,
}

/// The view along `axis` of a tensor with `lengths`, each entry `width` numbers wide. `axis < lengths.len()`.
pub(crate) fn along(lengths: impl Iterator<Item = usize>, axis: usize, width: usize) -> Along {
    let mut view = Along {
        inner: width,
        len: 1,
        outer: 1,
    };
    for (i, length) in lengths.enumerate() {
        match i.cmp(&axis) {
            std::cmp::Ordering::Less => view.inner *= length,
            std::cmp::Ordering::Equal => view.len = length,
            std::cmp::Ordering::Greater => view.outer *= length,
        }
    }
    view
}

/// `target = s · target + t · next`, row by row: the step of de Casteljau's algorithm.
#[inline(always)]
pub(crate) fn blend_rows(target: &mut [f64], next: &[f64], s: f64, t: f64) {
    for (a, &b) in target.iter_mut().zip(next) {
        *a = s * *a + t * b;
    }
}

/// `target += factor · source`.
#[inline(always)]
pub(crate) fn accumulate(target: &mut [f64], source: &[f64], factor: f64) {
    for (a, &b) in target.iter_mut().zip(source) {
        *a += factor * b;
    }
}
