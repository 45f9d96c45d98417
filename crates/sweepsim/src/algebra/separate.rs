//! Straight lines in the plane of the dexels' feet that separate points from others.

use crate::algebra::ranges::{Triples, products};
use nalgebra::Vector2;
use smallvec::SmallVec;

/// Whether the products of pairs of rows with points, all of them being uncertain, all lie on one side of a line that has all of `from` on the other.
pub(crate) fn is_separate(rows: [&[[f64; 3]]; 2], points: &Triples, from: &[[f64; 2]], uncertain: [f64; 2]) -> bool {
    let places = (0..rows[0].len()).flat_map(|k| {
        (0..points.len()).map(move |j| Vector2::new(points.dot(&rows[0][k], j), points.dot(&rows[1][k], j)))
    });
    let directions = places.flat_map(|place| from.iter().map(move |from| place - Vector2::from(*from)));
    // All directions are between these, by less than half a turn.
    let mut ends: Option<[Vector2<f64>; 2]> = None;
    for direction in directions {
        let [right, left] = ends.get_or_insert([direction; 2]);
        if right.perp(&direction) < 0.0 {
            *right = direction;
        }
        if left.perp(&direction) > 0.0 {
            *left = direction;
        }
        if right.perp(left) < 0.0 {
            return false;
        }
    }
    let Some([right, left]) = ends else { return false };
    let bisector = right
        .try_normalize(0.0)
        .zip(left.try_normalize(0.0))
        .map(|(a, b)| a + b);
    let chord = left - right;
    // Found without regard to rounding, and tested with it.
    [bisector, Some(Vector2::new(chord.y, -chord.x))]
        .into_iter()
        .flatten()
        .any(|side| {
            let Some(side) = side.try_normalize(0.0) else {
                return false;
            };
            let row = |k: usize| [0, 1, 2].map(|i| side.x * rows[0][k][i] + side.y * rows[1][k][i]);
            let combined: SmallVec<[[f64; 3]; 3]> = (0..rows[0].len()).map(row).collect();
            let (lo, _) = products(&combined, points);
            let uncertain = side.x.abs() * uncertain[0] + side.y.abs() * uncertain[1];
            from.iter()
                .all(|from| lo - side.x * from[0] - side.y * from[1] > uncertain)
        })
}
