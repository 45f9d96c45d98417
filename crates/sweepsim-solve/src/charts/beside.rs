//! Targets that a map itself excludes from a box, where the mean value theorem does not.

use super::{ChartMap, Targets, all_of};
use crate::Enclosure;

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
