//! Independent pieces of work, on one thread or on many.

/// The results for the items, in their order; on the threads of the current rayon pool if that is asked for and available.
#[cfg(feature = "rayon")]
pub(crate) fn spread<T: Send, R: Send>(parallel: bool, items: Vec<T>, work: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    use rayon::prelude::*;
    if parallel {
        items.into_par_iter().map(work).collect()
    } else {
        items.into_iter().map(work).collect()
    }
}

/// The results for the items, in their order.
#[cfg(not(feature = "rayon"))]
pub(crate) fn spread<T, R>(_: bool, items: Vec<T>, work: impl Fn(T) -> R) -> Vec<R> {
    items.into_iter().map(work).collect()
}
