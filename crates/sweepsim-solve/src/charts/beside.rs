//! The targets of a box: those that the mean value theorem leaves, and those that the map itself excludes.

use super::linear::Linear;
use super::{ChartMap, Targets, all_of};
use crate::Enclosure;
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
