//! The interval end nearest to a point, which tells what made the surface there.

use super::Dexels;
use crate::intervals::{End, Source};

/// An interval end, and how far it is from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct NearestEnd {
    /// Number of the end's line.
    pub line: usize,
    /// The end, in the frame of its grid.
    pub end: End,
    /// Its distance from the point.
    pub distance: f64,
}

impl Dexels {
    /// The interval end nearest to a point of the world. `None` if there is no material, or the point is not finite.
    ///
    /// Of ends at the same distance, that of the lowest line and height is taken. The search looks at lines around the
    /// point, ring by ring, until none further away can have a nearer end.
    ///
    /// ```
    /// use sweepsim_dexel::{Grid, Source, Stock};
    /// let grid = Grid::new([0.0, 0.0], [10.0, 10.0], [10, 10])?;
    /// let block = Stock::Block { min: [0.0; 3], max: [10.0, 10.0, 4.0] }.dexels(&grid)?;
    /// let nearest = block.nearest_end([5.1, 5.2, 4.5]).unwrap();
    /// assert_eq!((nearest.end.z, nearest.end.source), (4.0, Source::Stock));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn nearest_end(&self, point: impl Into<[f64; 3]>) -> Option<NearestEnd> {
        self.nearest_of(point.into(), f64::INFINITY, |_| true)
    }

    /// The source of the surface at or near a point of the world: that of the nearest interval end, if one is within
    /// `reach`.
    #[must_use]
    pub fn source_at(&self, point: impl Into<[f64; 3]>, reach: f64) -> Option<Source> {
        let nearest = self.nearest_end(point)?;
        (nearest.distance <= reach).then_some(nearest.end.source)
    }

    /// The nearest end that passes the filter, no farther than `reach`.
    pub(crate) fn nearest_of(&self, point: [f64; 3], reach: f64, wanted: impl Fn(&End) -> bool) -> Option<NearestEnd> {
        if !point.iter().all(|c| c.is_finite()) {
            return None;
        }
        let grid = &self.grid;
        let p = grid.frame().from_world(point);
        let (cells, spacing) = (grid.cells(), grid.spacing());
        // The line next to the point, or on the grid's rim.
        let home = [0, 1].map(|k| ((p[k] - grid.min()[k]) / spacing[k]).clamp(0.0, cells[k] as f64 - 1.0) as usize);
        let finest = spacing[0].min(spacing[1]);
        let mut best: Option<NearestEnd> = None;
        for ring in 0..cells[0].max(cells[1]) {
            // Lines of this ring are at least this far from the point if it is on the grid, and farther otherwise.
            let least = (ring as f64 - 0.5).max(0.0) * finest;
            if best.as_ref().map_or(reach, |best| best.distance) < least {
                break;
            }
            for [i, j] in ring_around(home, ring, cells) {
                let flat = (grid.x(i) - p[0]).hypot(grid.y(j) - p[1]);
                let line = grid.number(i, j);
                if best.as_ref().map_or(reach, |best| best.distance) < flat {
                    continue;
                }
                for interval in self.at(line) {
                    for end in [interval.lower, interval.upper] {
                        let distance = flat.hypot(end.z - p[2]);
                        let nearer = |best: &NearestEnd| {
                            distance < best.distance || (distance == best.distance && line < best.line)
                        };
                        if distance <= reach && wanted(&end) && best.as_ref().is_none_or(nearer) {
                            best = Some(NearestEnd { line, end, distance });
                        }
                    }
                }
            }
        }
        best
    }
}

/// The cells whose greater distance from `home`, along either axis, is `ring`.
fn ring_around(home: [usize; 2], ring: usize, cells: [usize; 2]) -> impl Iterator<Item = [usize; 2]> {
    let range = move |k: usize| home[k].saturating_sub(ring)..=(home[k] + ring).min(cells[k] - 1);
    range(0).flat_map(move |i| {
        let whole = i.abs_diff(home[0]) == ring;
        let below = home[1].checked_sub(ring).filter(|_| !whole);
        let above = Some(home[1] + ring).filter(|j| !whole && ring > 0 && *j < cells[1]);
        let all = if whole { Some(range(1)) } else { None };
        all.into_iter().flatten().chain(below).chain(above).map(move |j| [i, j])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_have_every_cell_once() {
        for home in [[0, 0], [3, 1], [6, 4], [2, 4]] {
            let cells = [7, 5];
            let mut all: Vec<[usize; 2]> = (0..7).flat_map(|ring| ring_around(home, ring, cells)).collect();
            all.sort_unstable();
            let expected: Vec<[usize; 2]> = (0..7).flat_map(|i| (0..5).map(move |j| [i, j])).collect();
            assert_eq!(all, expected);
        }
    }
}
