//! How far a moving body and what is near a cell are apart.
//!
//! Two convex sets are at least `−(h(n) + g(−n))` apart for any unit vector `n`, if `h` and `g` are how far they reach.
//! So what a body sweeps during a time and the surface in a cell are apart: both lie in the hulls of what is known of
//! them. The best `n` is found by turning it to where the points that are nearest in its direction differ across it.

use super::reach::During;
use crate::solid::{Cell, Normal, Target};
use nalgebra::Vector3;

/// Steps of a descent.
const STEPS: usize = 12;

/// A body during a time, and what is near a cell: its surface, or the cube itself.
pub(super) struct Apart<'a> {
    pub during: During<'a>,
    pub cell: &'a Cell,
    pub surface: Option<&'a Target>,
}

impl Apart<'_> {
    /// How far what is near the cell reaches in a direction, and where.
    pub fn top(&self, direction: &Vector3<f64>) -> (f64, Vector3<f64>) {
        match self.surface {
            Some(target) => self.cell.top(direction, &target.triangles),
            None => {
                let corner = direction.map(|c| self.cell.half.copysign(c)) + self.cell.centre;
                (direction.dot(&corner), corner)
            }
        }
    }

    /// A bound of the distance between both, and the direction in which it was found; the search ends at `enough`.
    pub fn distance(&self, enough: f64) -> Option<(f64, Normal)> {
        let apart = |normal: &Normal| -(self.top(&normal.vector).0 + self.during.reach(&-normal.vector));
        let away = self.during.on_axis(&self.cell.centre) - self.cell.centre;
        let axis = self.during.ends[0].axis;
        let starts = [away, axis, -axis].into_iter().filter_map(|start| Normal::near(&start));
        let best = starts.map(|normal| (apart(&normal), normal));
        let (mut value, mut normal) = best.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let size = self.run_size();
        let mut step = 1.0 / size;
        for _ in 0..STEPS {
            if value >= enough {
                break;
            }
            let own = normal.vector;
            let apart_by = self.top(&own).1 - self.during.farthest(&-own).1;
            let across = apart_by - own * own.dot(&apart_by);
            let Some(turned) = Normal::near(&(own - across * step)) else {
                break;
            };
            let next = apart(&turned);
            if next > value {
                (normal, value) = (turned, next);
                step *= 1.5;
            } else {
                step *= 0.25;
            }
        }
        Some((value, normal))
    }

    fn run_size(&self) -> f64 {
        self.during.run.solid.radius().max(self.cell.half).max(1e-3)
    }
}
