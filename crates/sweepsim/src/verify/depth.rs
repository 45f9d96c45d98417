//! How deep a gouge is.

use super::lines::Lines;
use sweepsim_dexel::{DistanceTo, Grid};

/// The most distances that are computed for one gouge.
const MOST: usize = 20_000;
/// Depths are found to this part of themselves, if the budget allows.
const RELATIVE: f64 = 1e-4;

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

/// The greatest depth below the surface in the material of some lines.
pub(super) fn greatest(material: &Lines, grid: &Grid, surface: &DistanceTo) -> f64 {
    let depth = |line: u32, z: f64| {
        let (i, j) = grid.place(line as usize);
        let place = grid.frame().to_world([grid.x(i), grid.y(j), z]);
        surface.nearest(place).map_or(0.0, |near| -near.distance)
    };
    let mut best = 0.0_f64;
    let mut open: Vec<Stretch> = Vec::new();
    for (line, heights) in &material.0 {
        for ends in heights {
            let depths = ends.map(|z| depth(*line, z));
            best = best.max(depths[0]).max(depths[1]);
            open.push(Stretch {
                line: *line,
                ends: *ends,
                depths,
            });
        }
    }
    let mut evaluated = 2 * open.len();
    while !open.is_empty() && evaluated < MOST {
        let mut next = Vec::new();
        for stretch in open {
            if stretch.bound() <= best * (1.0 + RELATIVE) {
                continue;
            }
            let middle = 0.5 * (stretch.ends[0] + stretch.ends[1]);
            let found = depth(stretch.line, middle);
            evaluated += 1;
            best = best.max(found);
            let [a, b] = stretch.ends;
            for (ends, depths) in [
                ([a, middle], [stretch.depths[0], found]),
                ([middle, b], [found, stretch.depths[1]]),
            ] {
                next.push(Stretch {
                    line: stretch.line,
                    ends,
                    depths,
                });
            }
        }
        open = next;
    }
    best
}
