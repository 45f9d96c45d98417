//! Finds the move that made a point of a surface.

use super::simulate::Simulation;
use super::tri::TriSimulation;
use sweepsim_dexel::{Dexels, Source};

/// The end of a dexel near a point: its source and position.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SurfaceSource {
    /// The stock, or the path, move and time.
    pub source: Source,
    /// The position of the end, in world coordinates.
    pub position: [f64; 3],
    /// The distance from the point.
    pub distance: f64,
}

/// The nearest end among the dexel about a point and its eight neighbours.
fn nearest(dexels: &Dexels, point: [f64; 3]) -> Option<SurfaceSource> {
    let grid = dexels.grid();
    let frame = grid.frame();
    let local = frame.from_world(point);
    if !local.iter().all(|x| x.is_finite()) {
        return None;
    }
    let (cells, spacing) = (grid.cells(), grid.spacing());
    // Up to one cell beyond the grid.
    let number = |k: usize| {
        let n = ((local[k] - grid.min()[k]) / spacing[k]).floor();
        (n >= -1.0 && n <= cells[k] as f64).then_some(n as isize)
    };
    let middle = [number(0)?, number(1)?];
    let about = |k: usize| (middle[k] - 1).max(0) as usize..(middle[k] + 2).clamp(0, cells[k] as isize) as usize;
    let mut best: Option<(f64, [f64; 3], Source)> = None;
    for i in about(0) {
        for j in about(1) {
            for interval in dexels.intervals(i, j).iter() {
                for end in [interval.lower, interval.upper] {
                    let at = [grid.x(i), grid.y(j), end.z];
                    let distance = (0..3).map(|k| (at[k] - local[k]).powi(2)).sum::<f64>().sqrt();
                    if best.is_none_or(|(least, ..)| distance < least) {
                        best = Some((distance, at, end.source));
                    }
                }
            }
        }
    }
    best.map(|(distance, at, source)| SurfaceSource {
        source,
        position: frame.to_world(at),
        distance,
    })
}

impl Simulation {
    /// The source of the surface at a point: the path, move and time that made it, or the stock, as recorded by the nearest end of a dexel.
    /// `None` if no dexel near the point contains material.
    ///
    /// Dexels have no ends on walls parallel to their lines; [`TriSimulation::source_at`] covers those, too. The distance of the end from the point
    /// tells how reliable the answer is.
    ///
    /// ```
    /// use sweepsim::dexel::{Source, Stock};
    /// use sweepsim::prelude::*;
    ///
    /// let grid = Grid::new([-10.0, -10.0], [10.0, 10.0], [40, 40])?;
    /// let stock = Stock::Block { min: [-10.0, -10.0, 0.0], max: [10.0, 10.0, 8.0] }.dexels(&grid)?;
    /// let tool = Tool::flat(3.0, 20.0)?;
    /// let pose = |x: f64| Pose::new([x, 0.0, 5.0], [0.0, 0.0, 1.0]);
    /// let path = Path::new(vec![pose(-20.0)?, pose(0.0)?, pose(20.0)?])?;
    /// let part = simulate(stock, &[Cut::new(&tool, &path)], &Options::default(), &())?;
    /// // On the floor of the groove, where the second move passes; and beside the groove.
    /// let floor = part.source_at([8.1, 0.1, 5.0]).ok_or("no surface")?;
    /// assert!(matches!(floor.source, Source::Cut { path: 0, segment: 1, .. }));
    /// let top = part.source_at([8.1, 6.1, 8.0]).ok_or("no surface")?;
    /// assert_eq!(top.source, Source::Stock);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn source_at(&self, point: impl Into<[f64; 3]>) -> Option<SurfaceSource> {
        nearest(&self.remaining, point.into())
    }
}

impl TriSimulation {
    /// As [`Simulation::source_at`], from the dexels along all three axes: walls of any direction have ends.
    #[must_use]
    pub fn source_at(&self, point: impl Into<[f64; 3]>) -> Option<SurfaceSource> {
        let point = point.into();
        let found = self.remaining.sets().iter().filter_map(|set| nearest(set, point));
        found.min_by(|a, b| a.distance.total_cmp(&b.distance))
    }
}
