//! What is still searched for and split where rounding decides: directions that rounding does not hide, and targets that were not given up.
//!
//! Ranges of values are wider than the true ones by their rounding on each side, and so are those of all parts of a box. Where a direction adds no more than that to any value, cutting across
//! it tells no target from another; where all directions do, a target in the ranges of the box is in those of almost all its parts, of which there would be ever more. This is so at a pole, where all values
//! of one variable are the same point: boxes would be cut across it until they are as small as the numbers allow. So a target that neither a chart nor a better bound has decided by then is *given up*:
//! it is reported as unresolved, and not searched for in other boxes, since no other box can settle it.

use super::beside::FEW;
use super::{ChartMap, ChartTarget, Sink, Targets, UnresolvedTarget, all_of};
use crate::{Cause, Enclosure};

/// The sides of a box as parts of the domain's.
pub(super) fn parts<const N: usize>(bounds: &[Enclosure; N], domain: &[Enclosure; N]) -> [f64; N] {
    std::array::from_fn(|j| bounds[j].radius() / domain[j].radius())
}

/// Whether no direction is left to split: all are small, or nothing changes along them, for a continuum of solutions must not flood the search.
pub(super) fn is_tiny<const N: usize>(jacobian: &[[Enclosure; N]; N], small: &[bool; N]) -> bool {
    (0..N).all(|j| small[j] || (0..N).all(|i| jacobian[i][j].magnitude() == 0.0))
}

/// The directions in which a box is worth splitting: those that have not become `small` and, from the middle of the box to either face, add more to some value than what no split can take away, its
/// rounding and what the small directions add.
pub(super) fn worth_splitting<const N: usize>(
    bounds: &[Enclosure; N],
    jacobian: &[[Enclosure; N]; N],
    rounding: &[f64; N],
    small: &[bool; N],
) -> [bool; N] {
    let adds = |i: usize, j: usize| jacobian[i][j].magnitude() * bounds[j].radius();
    let rest = |i: usize| {
        (0..N)
            .filter(|j| small[*j])
            .fold(rounding[i], |rest, j| rest + adds(i, j))
    };
    let rest: [f64; N] = std::array::from_fn(rest);
    // NaN is worth it.
    std::array::from_fn(|j| !small[j] && !(0..N).all(|i| adds(i, j) <= rest[i]))
}

/// Weights of some directions only.
pub(super) fn among<const N: usize>(weights: &[f64; N], of: &[bool; N]) -> [f64; N] {
    std::array::from_fn(|j| if of[j] { weights[j] } else { -1.0 })
}

/// Targets without those that were given up.
pub(super) struct Wanted<'a, T: ?Sized> {
    targets: &'a T,
    /// The numbers of these, in order.
    pub given_up: Vec<usize>,
}

impl<'a, T: ?Sized> Wanted<'a, T> {
    pub fn new(targets: &'a T, given_up: Vec<usize>) -> Self {
        Self { targets, given_up }
    }

    /// Reports all targets in the ranges of a box as unresolved.
    pub fn report<const N: usize, V, S: Sink<N, V>>(
        &self,
        values: &[Enclosure; N],
        (bounds, cause): ([Enclosure; N], Cause),
        sink: &mut S,
    ) where
        T: Targets<N>,
    {
        self.visit(values, &all_of, &mut |target| {
            let target = target.number;
            sink.unresolved(UnresolvedTarget { target, bounds, cause });
            true
        });
    }

    /// Gives up all targets in the ranges of a box, and reports them.
    pub fn give_up<const N: usize, V, S: Sink<N, V>>(
        &mut self,
        values: &[Enclosure; N],
        bounds: [Enclosure; N],
        sink: &mut S,
    ) where
        T: Targets<N>,
    {
        self.report(values, (bounds, Cause::Smallest), sink);
        let given_up = &mut self.given_up;
        self.targets.visit(values, &all_of, &mut |target| {
            if let Err(place) = given_up.binary_search(&target.number) {
                given_up.insert(place, target.number);
            }
            true
        });
    }

    /// Reports the targets in the ranges of a box that were given up before.
    pub fn report_given_up<const N: usize, M: ChartMap<N>, S: Sink<N, M::Seen>>(
        &self,
        map: &mut M,
        cell: &M::Cell,
        sink: &mut S,
    ) where
        T: Targets<N>,
    {
        if self.given_up.is_empty() {
            return;
        }
        let Some(values) = map.values(cell) else { return };
        let (bounds, cause) = (map.bounds(cell), Cause::Smallest);
        self.targets.visit(&values, &all_of, &mut |target| {
            let target = target.number;
            if !self.holds(target) {
                sink.unresolved(UnresolvedTarget { target, bounds, cause });
            }
            true
        });
    }

    fn holds(&self, number: usize) -> bool {
        self.given_up.is_empty() || self.given_up.binary_search(&number).is_err()
    }
}

impl<const N: usize, T: Targets<N> + ?Sized> Targets<N> for Wanted<'_, T> {
    /// At least the number of these, and 0 only if there is none.
    fn count(&self, range: &[Enclosure; N]) -> usize {
        let all = self.targets.count(range);
        if self.given_up.is_empty() || all > self.given_up.len().max(FEW) {
            return all;
        }
        let mut count = 0;
        self.visit(range, &all_of, &mut |_| {
            count += 1;
            true
        });
        count
    }

    fn visit(
        &self,
        range: &[Enclosure; N],
        narrow: &dyn Fn(&[f64; N]) -> Option<Enclosure>,
        visit: &mut dyn FnMut(&ChartTarget<N>) -> bool,
    ) {
        self.targets
            .visit(range, narrow, &mut |target| !self.holds(target.number) || visit(target));
    }
}
