//! The targets of a box: those that the mean value theorem leaves, those that the map itself excludes, and those that were given up.
//!
//! Where no direction is worth splitting, a target in the ranges of a box is in those of almost all its parts, of which there would be ever more. So a target that neither a chart nor a better bound
//! has decided by then is *given up*: it is reported as unresolved, and not searched for in other boxes, since no other box can settle it.

use super::linear::Linear;
use super::{ChartMap, ChartTarget, Sink, Targets, UnresolvedTarget, all_of};
use crate::{Cause, Enclosure};
use nalgebra::SVector;

/// If a box has at most this many targets, each is tested before a split.
pub(super) const FEW: usize = 4;

/// Whether the part of the box that holds all preimages certainly holds none of the targets'.
pub(super) fn part_is_empty<const N: usize, M: ChartMap<N>, T: Targets<N> + ?Sized>(
    map: &mut M,
    cell: &M::Cell,
    (values, jacobian): (&[Enclosure; N], &[[Enclosure; N]; N]),
    targets: &T,
) -> bool {
    let Some(part) = map.part(cell, values, jacobian) else {
        return false;
    };
    let is_empty = map.values(&part).is_none_or(|own| {
        let count = targets.count(&own);
        count == 0 || all_beside(map, &part, &own, targets)
    });
    map.drop_part(part);
    is_empty
}

/// Whether the map excludes each target in the range.
pub(super) fn all_beside<const N: usize, M: ChartMap<N>, T: Targets<N> + ?Sized>(
    map: &mut M,
    cell: &M::Cell,
    values: &[Enclosure; N],
    targets: &T,
) -> bool {
    let mut absent = true;
    targets.visit(values, &all_of, &mut |target| {
        absent = map.is_absent(cell, &target.value);
        absent
    });
    absent
}

/// The target in a range, if there is just one.
pub(super) fn only<const N: usize, T: Targets<N> + ?Sized>(targets: &T, values: &[Enclosure; N]) -> Option<[f64; N]> {
    let (mut found, mut count) = (None, 0);
    targets.visit(values, &all_of, &mut |target| {
        found = Some(target.value);
        count += 1;
        count == 1
    });
    found.filter(|_| count == 1)
}

/// The least box that holds all targets in a range.
pub(super) fn hull<const N: usize, T: Targets<N> + ?Sized>(
    targets: &T,
    values: &[Enclosure; N],
) -> Option<[Enclosure; N]> {
    let mut hull: Option<[Enclosure; N]> = None;
    targets.visit(values, &all_of, &mut |target| {
        let own = target.value.map(|q| Enclosure::hull(q, q));
        hull = Some(hull.map_or(own, |hull| {
            std::array::from_fn(|k| Enclosure::hull(hull[k].lo().min(own[k].lo()), hull[k].hi().max(own[k].hi())))
        }));
        true
    });
    hull
}

/// The number of targets, of `count` in the range, that the mean value test does not exclude; any number from `enough` on if there are as many.
pub(super) fn remaining<const N: usize, T: Targets<N> + ?Sized>(
    linear: &Linear<N>,
    value: &[f64; N],
    values: &[Enclosure; N],
    targets: &T,
    count: usize,
    enough: usize,
) -> usize {
    /// With this many times as many expected, they are not counted.
    const CERTAIN: f64 = 4.0;
    let mut left = 0;
    if count <= FEW {
        let origin = SVector::<f64, N>::zeros();
        targets.visit(values, &all_of, &mut |target| {
            let start = linear.predict(&origin, value, &target.value);
            left += usize::from((0..N).all(|i| start[i].abs() <= 1.0 + linear.reach(i)));
            left < enough
        });
        return left;
    }
    let strips = linear.strips(value);
    let share = strips.narrowest() / values[1.min(N - 1)].radius();
    if share * count as f64 > CERTAIN * (enough + FEW) as f64 {
        return count.max(enough);
    }
    targets.visit(values, &|q| strips.window(q), &mut |_| {
        left += 1;
        left < enough
    });
    left
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
