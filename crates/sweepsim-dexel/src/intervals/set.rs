//! Sets of intervals on a line.

use super::interval::{Endpoint, Interval, IntervalError, check_lengths};
use super::operations::{Run, difference, intersection, merge, normalise, union};

/// A set of points on a line, as intervals in normal form: sorted, of positive length, with gaps between them.
///
/// Sets that differ only in single points are equal: it does not matter whether an end belongs to its interval. Ends
/// may be plain heights (`f64`), [ends with a normal and a source](crate::End), or any other [`Endpoint`]. Heights may
/// be infinite.
///
/// ```
/// use sweepsim_dexel::IntervalSet;
/// let stock = IntervalSet::try_from([[0.0, 10.0]])?;
/// let holes = IntervalSet::try_from([[2.0, 3.0], [2.5, 4.0], [9.0, 12.0]])?;
/// assert_eq!(holes.len(), 2);
/// assert_eq!(stock.difference(&holes), IntervalSet::try_from([[0.0, 2.0], [4.0, 9.0]])?);
/// assert_eq!(stock.intersection(&holes).length(), 3.0);
/// # Ok::<(), sweepsim_dexel::IntervalError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct IntervalSet<E = f64> {
    pieces: Vec<Interval<E>>,
}

impl<E> Default for IntervalSet<E> {
    fn default() -> Self {
        Self { pieces: Vec::new() }
    }
}

impl<E: Endpoint> IntervalSet<E> {
    /// The empty set.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The set of these intervals, in any order. They may overlap.
    ///
    /// # Errors
    /// [`IntervalError::Length`]: an interval is empty or reversed, or one of its ends is NaN.
    pub fn from_intervals(intervals: impl IntoIterator<Item = Interval<E>>) -> Result<Self, IntervalError> {
        let mut pieces: Vec<Interval<E>> = intervals.into_iter().collect();
        check_lengths(&pieces)?;
        normalise(&mut pieces);
        Ok(Self { pieces })
    }

    /// The intervals, from the lowest up.
    #[must_use]
    pub fn pieces(&self) -> &[Interval<E>] {
        &self.pieces
    }

    /// The number of intervals.
    #[must_use]
    pub fn len(&self) -> usize {
        self.pieces.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// Length of all intervals.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.pieces.iter().map(Interval::length).sum()
    }

    /// Whether a height lies inside an interval or on its end.
    #[must_use]
    pub fn contains(&self, height: f64) -> bool {
        let after = self.pieces.partition_point(|piece| piece.lower.height() <= height);
        after > 0 && height <= self.pieces[after - 1].upper.height()
    }

    fn with(&self, other: &Self, operation: Run<E>) -> Self {
        let mut pieces = Vec::with_capacity(self.len() + other.len());
        operation(&self.pieces, &other.pieces, &mut pieces);
        Self { pieces }
    }

    /// Points in either set. Intervals that touch are merged; of two ends at the same height that of `self` is kept.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        self.with(other, union)
    }

    /// Points in both sets. Of two ends at the same height that of `self` is kept.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        self.with(other, intersection)
    }

    /// Points in `self` but not in `other`. Ends that come from `other` are flipped.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Self {
        self.with(other, difference)
    }

    /// Points in exactly one of the sets.
    #[must_use]
    pub fn symmetric_difference(&self, other: &Self) -> Self {
        self.difference(other).union(&other.difference(self))
    }

    /// Points of `range` that are not in the set. Ends that come from the set are flipped.
    ///
    /// # Errors
    /// [`IntervalError::Length`]: the range is empty or reversed, or one of its ends is NaN.
    pub fn complement(&self, range: Interval<E>) -> Result<Self, IntervalError> {
        Ok(Self::from_intervals([range])?.difference(self))
    }

    /// Removes features that are too thin to be significant: fills gaps of at most `tolerance`, then drops intervals of
    /// at most `tolerance`.
    ///
    /// Every interval longer than the tolerance is contained in the result, and every gap longer than the tolerance
    /// remains a gap or becomes part of one, however many thin intervals are next to it. Repeating the operation
    /// changes nothing. A negative or NaN tolerance changes nothing either.
    #[must_use]
    pub fn merged(mut self, tolerance: f64) -> Self {
        if tolerance >= 0.0 {
            merge(&mut self.pieces, tolerance);
        }
        self
    }
}

/// As [`IntervalSet::from_intervals`], from pairs `[lower, upper]`.
impl<E: Endpoint, const N: usize> TryFrom<[[E; 2]; N]> for IntervalSet<E> {
    type Error = IntervalError;

    fn try_from(pieces: [[E; 2]; N]) -> Result<Self, IntervalError> {
        Self::from_intervals(pieces.map(|[lower, upper]| Interval { lower, upper }))
    }
}

impl<'a, E> IntoIterator for &'a IntervalSet<E> {
    type Item = &'a Interval<E>;
    type IntoIter = std::slice::Iter<'a, Interval<E>>;

    fn into_iter(self) -> Self::IntoIter {
        self.pieces.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::End;
    use sweepsim_props::*;

    /// Any intervals with ends on whole numbers: unsorted, overlapping, empty, reversed.
    fn pieces() -> impl Strategy<Value = Vec<[i32; 2]>> {
        collection::vec([0..60i32, 0..60i32], 0..14)
    }

    /// The ends of what complements are taken in.
    fn whole() -> impl Strategy<Value = (i32, i32)> {
        (0..59i32).prop_flat_map(|lo| (Just(lo), lo + 1..60))
    }

    fn set(pieces: &[[i32; 2]]) -> IntervalSet<End> {
        let pieces = pieces.iter().filter(|[a, b]| a < b);
        IntervalSet::from_intervals(pieces.map(|[a, b]| Interval::between(f64::from(*a), f64::from(*b)))).unwrap()
    }

    /// The model: which unit cells are covered, by testing every interval.
    fn cells(pieces: &[[i32; 2]]) -> Vec<bool> {
        (0..60).map(|k| pieces.iter().any(|[a, b]| *a <= k && k < *b)).collect()
    }

    /// The sorted list of places where the model changes.
    fn boundary(cells: &[bool]) -> Vec<f64> {
        let at = |k: usize| k.checked_sub(1).and_then(|k| cells.get(k)).copied().unwrap_or(false);
        (0..=cells.len())
            .filter(|k| at(*k) != at(k + 1))
            .map(|k| k as f64)
            .collect()
    }

    fn ends(set: &IntervalSet<End>) -> Vec<f64> {
        set.into_iter().flat_map(|i| [i.lower.z, i.upper.z]).collect()
    }

    fn outwards(set: &IntervalSet<End>) -> bool {
        set.into_iter()
            .all(|i| i.lower.normal[2] == -1.0 && i.upper.normal[2] == 1.0)
    }

    fn operations(a: &[[i32; 2]], b: &[[i32; 2]], (lo, hi): (i32, i32)) -> Result<(), TestCaseError> {
        let (p, q) = (cells(a), cells(b));
        let (x, y) = (set(a), set(b));
        let model =
            |f: &dyn Fn(bool, bool) -> bool| boundary(&p.iter().zip(&q).map(|(p, q)| f(*p, *q)).collect::<Vec<_>>());
        let cases: [(IntervalSet<End>, Vec<f64>); 6] = [
            (x.clone(), boundary(&p)),
            (x.union(&y), model(&|p, q| p || q)),
            (x.intersection(&y), model(&|p, q| p && q)),
            (x.difference(&y), model(&|p, q| p && !q)),
            (x.symmetric_difference(&y), model(&|p, q| p != q)),
            (
                x.complement(Interval::between(f64::from(lo), f64::from(hi))).unwrap(),
                {
                    let outside = p.iter().zip(lo.min(60)..).enumerate();
                    boundary(
                        &outside
                            .map(|(k, (p, _))| !p && lo <= k as i32 && (k as i32) < hi)
                            .collect::<Vec<_>>(),
                    )
                },
            ),
        ];
        for (k, (found, expected)) in cases.iter().enumerate() {
            prop_assert_eq!(&ends(found), expected, "case {}", k);
            prop_assert!(outwards(found), "case {}", k);
        }
        for k in 0..60 {
            prop_assert_eq!(x.contains(f64::from(k) + 0.5), p[k as usize]);
        }
        prop_assert_eq!(x.union(&y), y.union(&x));
        prop_assert_eq!(x.intersection(&y), y.intersection(&x));
        Ok(())
    }

    fn merging(a: &[[i32; 2]], tolerance: i32) -> Result<(), TestCaseError> {
        let x = set(a);
        let merged = x.clone().merged(f64::from(tolerance));
        let thick = |set: &IntervalSet<End>| -> IntervalSet<End> {
            let long = set.into_iter().filter(|i| i.length() > f64::from(tolerance));
            IntervalSet::from_intervals(long.copied()).unwrap()
        };
        let all = Interval::between(-100.0, 200.0);
        prop_assert!(thick(&x).difference(&merged).is_empty());
        prop_assert!(thick(&x.complement(all).unwrap()).intersection(&merged).is_empty());
        prop_assert!(merged.into_iter().all(|i| i.length() > f64::from(tolerance)));
        prop_assert!(
            merged
                .complement(all)
                .unwrap()
                .into_iter()
                .all(|i| i.length() > f64::from(tolerance))
        );
        prop_assert_eq!(merged.clone().merged(f64::from(tolerance)), merged);
        Ok(())
    }

    proptest! {
        #[test]
        fn operations_agree_with_the_model(a in pieces(), b in pieces(), whole in whole()) {
            operations(&a, &b, whole)?;
        }

        #[test]
        fn merging_keeps_all_that_is_thick(a in pieces(), tolerance in 0..6i32) {
            merging(&a, tolerance)?;
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 1_000_000, ..ProptestConfig::default() })]
        /// `cargo test --release -p sweepsim-dexel -- --ignored million`
        #[test]
        #[ignore = "takes minutes"]
        fn a_million_operations_agree_with_the_model(
            a in pieces(), b in pieces(), whole in whole(), tolerance in 0..6i32,
        ) {
            operations(&a, &b, whole)?;
            merging(&a, tolerance)?;
        }
    }

    #[test]
    fn what_is_no_interval_is_refused() {
        for odd in [[f64::NAN, 1.0], [0.0, f64::NAN], [3.0, 2.0], [1.0, 1.0]] {
            assert!(IntervalSet::try_from([[5.0, 6.0], odd]).is_err(), "{odd:?}");
            let [lower, upper] = odd;
            assert!(IntervalSet::<f64>::new().complement(Interval { lower, upper }).is_err());
        }
        let endless = IntervalSet::try_from([[f64::NEG_INFINITY, -1.0]]).unwrap();
        assert_eq!(endless.clone().merged(f64::NAN), endless);
        assert!(IntervalSet::<f64>::new().merged(1.0).is_empty());
        assert_eq!(size_of::<Interval<f64>>(), 16);
    }
}
