//! Circles, whose hulls bound parts of a tool.

use crate::motion::Placement;
use crate::tool::Level;
use nalgebra::Vector3;
use smallvec::SmallVec;
use std::f64::consts::TAU;

/// A circle about an axis, or a point, with a ball around each of its points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ring {
    pub centre: Vector3<f64>,
    pub axis: Vector3<f64>,
    pub radius: f64,
    pub thick: f64,
}

/// The circle is inside of a polygon of so many sides.
const SIDES: usize = 8;

impl Ring {
    pub fn point(at: Vector3<f64>) -> Self {
        Self {
            centre: at,
            axis: Vector3::z(),
            radius: 0.0,
            thick: 0.0,
        }
    }

    /// No point of it is farther outside of a solid that is at a placement: a bound, exact if both axes are parallel.
    ///
    /// In the half-plane of the solid, its points are no farther from the axis than the centre and the radius, and at
    /// heights around that of the centre; [how far](Level::signed) a point is outside is convex, and does not fall away
    /// from the axis. What is outside by more than `most` in any case need not be known better.
    pub fn level(&self, level: &Level, at: &Placement, most: f64) -> f64 {
        let off = self.centre - at.tip;
        let along = off.dot(&at.axis);
        let across = (off - at.axis * along).norm() + self.radius;
        let rise = self.radius * self.axis.cross(&at.axis).norm();
        let heights = [along - rise, along + rise];
        let of = |level: &dyn Fn([f64; 2]) -> f64| {
            let own = level([across, heights[0]]);
            self.thick
                + match self.radius > 0.0 {
                    true => own.max(level([across, heights[1]])),
                    false => own,
                }
        };
        let own = of(&|point| level.at(point));
        if own > most || own <= self.thick {
            own
        } else {
            of(&|point| level.signed(point))
        }
    }

    /// How far the nearest of its points is along a direction.
    pub fn least(&self, n: &Vector3<f64>) -> f64 {
        let across = (n - self.axis * n.dot(&self.axis)).norm();
        n.dot(&self.centre) - self.radius * across - self.thick * n.norm()
    }

    /// Points whose hull holds it.
    pub fn corners(&self, corners: &mut SmallVec<[Vector3<f64>; 12]>) {
        if self.radius + self.thick <= 0.0 {
            corners.push(self.centre);
            return;
        }
        let x = across(&self.axis);
        let y = self.axis.cross(&x);
        let radius = (self.radius + self.thick) / (0.5 * TAU / SIDES as f64).cos();
        let heights: &[f64] = if self.thick > 0.0 {
            &[-self.thick, self.thick]
        } else {
            &[0.0]
        };
        for k in 0..SIDES {
            let (sin, cos) = (TAU * k as f64 / SIDES as f64).sin_cos();
            let corner = self.centre + (x * cos + y * sin) * radius;
            corners.extend(heights.iter().map(|height| corner + self.axis * *height));
        }
    }

    /// How far it is from its centre in the direction of each axis.
    pub fn extent(&self) -> Vector3<f64> {
        let across = |c: f64| self.radius * (1.0 - c * c).max(0.0).sqrt() + self.thick;
        self.axis.map(across)
    }
}

/// A unit vector across another.
pub(super) fn across(axis: &Vector3<f64>) -> Vector3<f64> {
    axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::cover;
    use sweepsim_motion::Tool;

    /// Points all around a ring.
    fn around(ring: &Ring) -> impl Iterator<Item = Vector3<f64>> + '_ {
        let (x, y) = (across(&ring.axis), ring.axis.cross(&across(&ring.axis)));
        (0..360).map(move |k| {
            let (sin, cos) = f64::from(k).to_radians().sin_cos();
            ring.centre + (x * cos + y * sin) * ring.radius
        })
    }

    #[test]
    fn no_point_is_outside_of_its_bounds() {
        let level = Level::new(&cover(&Tool::bull(3.0, 1.0, 10.0).expect("a tool"), 1e-3)[0]);
        for k in 0..200 {
            let angle = f64::from(k) * 0.7;
            let ring = Ring {
                centre: Vector3::new(angle.sin() * 3.0, angle.cos(), 0.04 * f64::from(k)),
                axis: Vector3::new(0.3 * angle.cos(), 0.2 * angle.sin(), 1.0).normalize(),
                radius: 0.01 * f64::from(k),
                thick: 0.0,
            };
            let at = Placement {
                tip: Vector3::new(0.1, 0.2, 0.3),
                axis: Vector3::new(0.05 * f64::from(k % 3), 0.0, 1.0).normalize(),
            };
            let bound = ring.level(&level, &at, f64::INFINITY);
            let mut corners = SmallVec::new();
            ring.corners(&mut corners);
            let extent = ring.extent();
            for point in around(&ring) {
                let own = Ring::point(point).level(&level, &at, f64::INFINITY);
                assert!(own <= bound + 1e-12, "{own} {bound}");
                let off = (point - ring.centre).abs();
                assert!((0..3).all(|k| off[k] <= extent[k] + 1e-12));
                for n in [Vector3::x(), Vector3::new(0.6, -0.8, 0.0), Vector3::new(0.0, 0.6, 0.8)] {
                    let hull = corners.iter().map(|c| c.dot(&n)).fold(f64::NEG_INFINITY, f64::max);
                    assert!(point.dot(&n) <= hull + 1e-12);
                }
            }
        }
    }
}
