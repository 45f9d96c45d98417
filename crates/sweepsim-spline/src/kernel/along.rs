//! A dense tensor, first axis fastest, seen along one axis as `outer × len × inner`.

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
