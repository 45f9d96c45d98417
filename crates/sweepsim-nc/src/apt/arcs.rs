//! Arcs: `CIRCLE` and `MOVARC` give centre and normal, the next `GOTO` the end. The turn is right-handed about the normal.

use std::f64::consts::TAU;
use std::ops::Range;

use super::frames::{Vector, add, cross, dot, norm, sub, turned};
use crate::drive::{Arc, radii_differ, radius_slack};

/// An arc whose end is not known yet, in millimetres in the frame of the poses.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PendingArc {
    pub centre: Vector,
    /// A unit vector.
    pub normal: Vector,
    pub radius: Option<f64>,
    /// The angle that `MOVARC` gives, in radians.
    pub angle: Option<f64>,
    /// The bytes of its statement, and its line.
    pub bytes: Range<usize>,
    pub line: usize,
}

/// Ends within this distance, in mm, are the same: files have four to six decimals.
const SAME_END: f64 = 2e-4;

impl PendingArc {
    fn radial(&self, point: Vector) -> Vector {
        let from = sub(point, self.centre);
        add(from, -dot(from, self.normal), self.normal)
    }

    /// The end of the arc as `MOVARC` gives it, without a rise.
    pub fn own_end(&self, start: Vector) -> Option<Vector> {
        let radial = self.radial(start);
        let turned = turned(radial, self.normal, self.angle?);
        Some(add(start, 1.0, sub(turned, radial)))
    }

    /// Whether a point is where the arc ends by its angle, apart from a rise.
    pub fn ends_at(&self, start: Vector, end: Vector) -> bool {
        self.own_end(start).is_none_or(|own| {
            let apart = sub(own, end);
            let across = add(apart, -dot(apart, self.normal), self.normal);
            norm(across) <= radius_slack(norm(self.radial(start)))
        })
    }

    /// The arc from `start` to `end`.
    pub fn to(&self, start: Vector, end: Vector) -> Result<Arc, String> {
        let [a, b] = [start, end].map(|point| self.radial(point));
        let (ra, rb) = (norm(a), norm(b));
        if !(ra > 0.0 && rb > 0.0 && ra.is_finite() && rb.is_finite()) {
            return Err(format!(
                "the arc has no radius: its ends are {ra} and {rb} mm from its axis"
            ));
        }
        if radii_differ(ra, rb) {
            return Err(format!(
                "the arc has two radii: its start is {ra} mm and its end {rb} mm from its axis, expected the same"
            ));
        }
        if let Some(radius) = self.radius.filter(|&radius| radii_differ(radius, ra)) {
            return Err(format!(
                "the arc's radius is {radius} mm, but its start is {ra} mm from its axis"
            ));
        }
        let angle = match self.angle {
            Some(angle) => angle,
            None if norm(sub(a, b)) <= SAME_END.min(0.1 * ra) => TAU,
            None => {
                let angle = dot(self.normal, cross(a, b)).atan2(dot(a, b));
                if angle <= 0.0 { angle + TAU } else { angle }
            }
        };
        Ok(Arc {
            start,
            end,
            centre: self.centre,
            normal: self.normal,
            sweep: angle,
        })
    }
}
