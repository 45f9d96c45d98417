//! The direction to split a box in.

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
