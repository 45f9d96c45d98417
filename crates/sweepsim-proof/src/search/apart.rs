//! How far a moving body and what is near a cell are apart.
//!
//! Two convex sets are at least `−(h(n) + g(−n))` apart for any unit vector `n`, if `h` and `g` are how far they reach.
//! So what a body sweeps during a time and the surface in a cell are apart: both lie in the hulls of what is known of
//! them. The best `n` is found by turning it to where the points that are nearest in its direction differ across it.

use super::reach::During;
use crate::solid::{Cell, Target};
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
                // Of the surroundings, in which the surface is.
                let corner = direction.map(|c| (2.01 * self.cell.half).copysign(c)) + self.cell.centre;
                (direction.dot(&corner), corner)
            }
        }
    }

    /// A bound of the distance between both, and the direction in which it was found; the search ends at `enough`.
    pub fn distance(&self, enough: f64) -> (f64, Vector3<f64>) {
        let apart = |normal: &Vector3<f64>| -(self.top(normal).0 + self.during.reach(&-normal));
        let away = self.during.core(&self.cell.centre) - self.cell.centre;
        let axis = self.during.ends[0].axis;
        let starts = away.try_normalize(1e-12).into_iter().chain([axis, -axis]);
        let best = starts.map(|normal| (apart(&normal), normal));
        let Some((mut value, mut normal)) = best.max_by(|a, b| a.0.total_cmp(&b.0)) else {
            return (f64::NEG_INFINITY, axis);
        };
        let size = self.run_size();
        let mut step = 1.0 / size;
        for _ in 0..STEPS {
            if value >= enough {
                break;
            }
            let apart_by = self.top(&normal).1 - self.during.farthest(&-normal).1;
            let across = apart_by - normal * normal.dot(&apart_by);
            let Some(turned) = (normal - across * step).try_normalize(1e-9) else {
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
        (value, normal)
    }

    fn run_size(&self) -> f64 {
        self.during.run.solid.radius().max(self.cell.half).max(1e-3)
    }
}
