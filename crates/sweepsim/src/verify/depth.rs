//! The point of some material that is farthest inside, or outside, of a surface.

use super::lines::Lines;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use sweepsim_dexel::{DistanceTo, Grid};

/// The most distances that are computed beyond those of the ends.
const MOST: usize = 20_000;
/// Depths are found to this part of themselves, if the budget allows.
const RELATIVE: f64 = 1e-4;

/// On which side of the surface depths count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SurfaceSide {
    Inside,
    Outside,
}

/// A stretch of a line between two points with known depths.
struct Stretch {
    line: u32,
    ends: [f64; 2],
    depths: [f64; 2],
}

impl Stretch {
    /// Distances change no faster than places do (Piyavskii 1972): no depth between the ends is larger.
    fn bound(&self) -> f64 {
        0.5 * (self.depths[0] + self.depths[1] + self.ends[1] - self.ends[0])
    }
}

/// By bound, then by place, so that the order does not depend on anything else.
impl Ord for Stretch {
    fn cmp(&self, other: &Self) -> Ordering {
        let place = |stretch: &Self| (stretch.line, stretch.ends[0].to_bits());
        self.bound()
            .total_cmp(&other.bound())
            .then_with(|| place(other).cmp(&place(self)))
    }
}

impl PartialOrd for Stretch {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Stretch {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Stretch {}

/// The greatest depth of the material of some lines, and where it is, in the world. It is exact to a ten-thousandth, unless the budget ends first.
pub(super) fn greatest(material: &Lines, grid: &Grid, surface: &DistanceTo, side: SurfaceSide) -> (f64, [f64; 3]) {
    let sign = if side == SurfaceSide::Inside { -1.0 } else { 1.0 };
    let place = |line: u32, z: f64| {
        let (i, j) = grid.place(line as usize);
        grid.frame().to_world([grid.x(i), grid.y(j), z])
    };
    let mut best = (0.0_f64, None);
    let mut depth = |line: u32, z: f64| {
        let depth = surface.nearest(place(line, z)).map_or(0.0, |near| sign * near.distance);
        if depth > best.0 || best.1.is_none() {
            best = (depth.max(best.0), Some((line, z)));
        }
        (depth, best.0)
    };
    // The most promising first.
    let mut open: BinaryHeap<Stretch> = BinaryHeap::new();
    let mut most = 0.0;
    let mut evaluated = 0;
    for (line, heights) in &material.0 {
        for ends in heights {
            let depths = ends.map(|z| {
                let (own, best) = depth(*line, z);
                most = best;
                own
            });
            evaluated += 2;
            open.push(Stretch {
                line: *line,
                ends: *ends,
                depths,
            });
        }
    }
    let budget = evaluated + MOST;
    while let Some(stretch) = open.pop() {
        if stretch.bound() <= most * (1.0 + RELATIVE) || evaluated >= budget {
            break;
        }
        let middle = 0.5 * (stretch.ends[0] + stretch.ends[1]);
        let (found, best) = depth(stretch.line, middle);
        most = best;
        evaluated += 1;
        let [a, b] = stretch.ends;
        for (ends, depths) in [
            ([a, middle], [stretch.depths[0], found]),
            ([middle, b], [found, stretch.depths[1]]),
        ] {
            open.push(Stretch {
                line: stretch.line,
                ends,
                depths,
            });
        }
    }
    let at = best.1.map_or([0.0; 3], |(line, z)| place(line, z));
    (best.0, at)
}
