//! An order of places in which those that come together lie together.

use nalgebra::Vector3;
use rayon::prelude::*;

/// So many digits in binary tell a place along each axis.
const DIGITS: u32 = 10;

/// The numbers of some places along a curve that fills space (Morton's).
pub(super) fn along_a_curve(count: usize, place: impl Fn(usize) -> Vector3<f64> + Sync, size: f64) -> Vec<usize> {
    let scale = f64::from(1 << (DIGITS - 1)) / size;
    let mut keys: Vec<(u32, usize)> = (0..count)
        .into_par_iter()
        .map(|number| {
            let half = f64::from(1 << (DIGITS - 1));
            let cell = place(number).map(|c| ((c * scale + half) as u32).min((1 << DIGITS) - 1));
            let digit = |n: u32, k: usize| (cell[k] >> n & 1) << (3 * n + k as u32);
            let key = (0..DIGITS).flat_map(|n| [0, 1, 2].map(|k| digit(n, k)));
            (key.sum(), number)
        })
        .collect();
    keys.par_sort_unstable();
    keys.into_iter().map(|(_, number)| number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All places once, eight neighbours of a cube in a row.
    #[test]
    fn neighbours_come_together() {
        let place = |number: usize| Vector3::from([0, 1, 2].map(|k| (number >> (4 * k) & 15) as f64 - 7.5));
        let order = along_a_curve(4096, place, 8.0);
        for eight in order.chunks(8) {
            let (low, high) = eight.iter().map(|number| place(*number)).fold(
                (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY)),
                |(low, high), p| (low.inf(&p), high.sup(&p)),
            );
            assert_eq!(high - low, Vector3::repeat(1.0));
        }
        let mut all = order;
        all.sort_unstable();
        assert!(all.into_iter().eq(0..4096));
    }
}
