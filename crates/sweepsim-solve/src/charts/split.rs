//! The direction to split a box in.
//!
//! Ranges of values are wider than the true ones by their rounding on each side, and so are those of all parts of a box. Where a direction adds no more than that to any value, cutting across it tells no target
//! from another. This is so at a pole, where all values of one variable are the same point: boxes would be cut across it until they are as small as the numbers allow.

use super::ChartMap;
use crate::Enclosure;
use nalgebra::SMatrix;

/// Whether the direction `axis` may have almost no length in the box and adds little to the range of each value.
///
/// This happens at a pole, where a side of a patch has shrunk to a point, or where a tool turns about one of its own points. Cutting
/// across this direction leaves boxes that are as singular as before; only cutting towards the pole isolates it.
pub(crate) fn collapses<const N: usize>(bounds: &[Enclosure; N], jacobian: &[[Enclosure; N]; N], axis: usize) -> bool {
    let half = bounds.map(Enclosure::radius);
    jacobian.iter().all(|row| {
        let most = (0..N).map(|j| row[j].magnitude() * half[j]).fold(0.0, f64::max);
        let least = row[axis].lo().max(-row[axis].hi()).max(0.0);
        row[axis].magnitude() * half[axis] < 0.25 * most && least * half[axis] < 1e-3 * most
    })
}

pub(crate) fn largest<const N: usize>(weights: &[f64; N]) -> usize {
    (0..N).fold(0, |best, j| if weights[j] > weights[best] { j } else { best })
}

/// The variable that moves the values most, measured in `scales`, over the box.
pub(crate) fn widest<const N: usize>(
    bounds: &[Enclosure; N],
    domain: &[Enclosure; N],
    jacobian: &[[Enclosure; N]; N],
    scales: &[f64; N],
) -> usize {
    let weights: [f64; N] = std::array::from_fn(|j| {
        let reach: f64 = (0..N).map(|i| jacobian[i][j].magnitude() / scales[i]).sum();
        reach * bounds[j].radius()
    });
    if weights.iter().all(|w| *w == 0.0) {
        return largest::<N>(&std::array::from_fn(|j| bounds[j].radius() / domain[j].radius()));
    }
    largest(&weights)
}

/// How much `K ∂Φ` changes along a direction of the box, from the middle of one face to that of the other.
pub(super) fn change<const N: usize, M: ChartMap<N>>(
    map: &M,
    bounds: &[Enclosure; N],
    inverse: &SMatrix<f64, N, N>,
    axis: usize,
) -> f64 {
    let at = |end: f64| {
        let mut place = bounds.map(Enclosure::mid);
        place[axis] = end;
        let jacobian = map.evaluate(&place).jacobian;
        SMatrix::<f64, N, N>::from_fn(|i, j| jacobian[i][j] * bounds[j].radius())
    };
    (inverse * (at(bounds[axis].hi()) - at(bounds[axis].lo()))).abs().sum()
}

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
