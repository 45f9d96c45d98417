//! What a circle, or the torus around one, leaves along a straight line: the cylinder over an ellipse, or its offset.
//!
//! Seen along the line, the circle is an ellipse. A torus is what is at a distance from its middle circle, so the body
//! that it sweeps is what is at that distance from the swept circle, and seen along the line, from the ellipse.

use nalgebra::Vector3;

/// All points at a distance from the cylinder over an ellipse, on its outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipticSheet {
    centre: Vector3<f64>,
    /// The directions of the longer and the shorter half axis, and of the rulings: right-handed.
    pub(crate) axes: [Vector3<f64>; 3],
    half: [f64; 2],
    offset: f64,
}

/// Steps to the nearest point of an ellipse: the first few halve, the last square the error.
const STEPS: usize = 40;
/// Ellipses flatter than this are taken for planes: none is made.
const FLATTEST: f64 = 1e-5;

impl EllipticSheet {
    /// What the torus around a circle, or the circle itself for `offset` 0, leaves on its way along a straight line.
    /// `None` if it moves in its own plane or along its axis.
    #[must_use]
    pub fn swept(centre: [f64; 3], axis: [f64; 3], radius: f64, way: [f64; 3], offset: f64) -> Option<Self> {
        let (axis, way) = (Vector3::from(axis), Vector3::from(way));
        let (axis, way) = (axis.try_normalize(0.0)?, way.try_normalize(0.0)?);
        let long = axis.cross(&way).try_normalize(FLATTEST)?;
        let flat = axis.dot(&way).abs();
        (flat > FLATTEST && radius > 0.0).then(|| Self {
            centre: centre.into(),
            axes: [long, way.cross(&long), way],
            half: [radius, radius * flat],
            offset,
        })
    }

    /// A point by the angle on the ellipse and the height along the rulings.
    pub(crate) fn point(&self, angle: f64, height: f64) -> Vector3<f64> {
        let (s, c) = angle.sin_cos();
        let [a, b] = self.half;
        let normal = (self.axes[0] * (b * c) + self.axes[1] * (a * s)).normalize();
        let on = self.axes[0] * (a * c) + self.axes[1] * (b * s);
        self.centre + on + normal * self.offset + self.axes[2] * height
    }

    /// How far the point goes with the angle.
    pub(crate) fn speed(&self, angle: f64) -> Vector3<f64> {
        let (s, c) = angle.sin_cos();
        let [a, b] = self.half;
        let square = (b * c).powi(2) + (a * s).powi(2);
        // The offset turns with the normal: as fast as the ellipse bends.
        let stretch = 1.0 + self.offset * a * b / square.powf(1.5);
        (self.axes[1] * (b * c) - self.axes[0] * (a * s)) * stretch
    }

    /// Angles between which cubics follow the sheet to a millionth of its size.
    pub(crate) fn knots(&self, [from, to]: [f64; 2]) -> Vec<f64> {
        let limit = 1e-6 * (self.half[0] + self.offset);
        let fits = |a: f64, b: f64| {
            let [p, q] = [a, b].map(|t| self.point(t, 0.0));
            let bent = (self.speed(a) - self.speed(b)) * ((b - a) / 8.0);
            ((p + q) * 0.5 + bent - self.point(0.5 * (a + b), 0.0)).norm() <= limit
        };
        let mut knots = vec![from];
        let mut rest = vec![to];
        while let Some(next) = rest.pop() {
            let last = knots[knots.len() - 1];
            if next - last < 1e-4 || (next - last < 0.8 && fits(last, next)) {
                knots.push(next);
            } else {
                rest.extend([next, 0.5 * (last + next)]);
            }
        }
        knots
    }

    /// The angle of the nearest point of the ellipse, and the height.
    pub(crate) fn angle(&self, p: Vector3<f64>) -> (f64, f64) {
        let off = p - self.centre;
        let [x, y, z] = self.axes.map(|axis| axis.dot(&off));
        let [a, b] = self.half;
        // Of the foot of a normal in the first quadrant: g(θ) = 0 with g decreasing, kept between two bounds.
        let g = |t: f64| {
            let (s, c) = t.sin_cos();
            (a * a - b * b) * s * c - x.abs() * a * s + y.abs() * b * c
        };
        let slope = |t: f64| (a * a - b * b) * (2.0 * t).cos() - x.abs() * a * t.cos() - y.abs() * b * t.sin();
        let (mut low, mut high) = (0.0_f64, std::f64::consts::FRAC_PI_2);
        let mut t = (y.abs() * a).atan2(x.abs() * b);
        for _ in 0..STEPS {
            let value = g(t);
            if value > 0.0 {
                low = t;
            } else {
                high = t;
            }
            let next = t - value / slope(t);
            let next = if next > low && next < high {
                next
            } else {
                0.5 * (low + high)
            };
            if (next - t).abs() < 1e-15 {
                break;
            }
            t = next;
        }
        (t.sin().copysign(y).atan2(t.cos().copysign(x)), z)
    }

    pub(crate) fn distance(&self, p: Vector3<f64>) -> Option<(f64, Vector3<f64>)> {
        let (angle, height) = self.angle(p);
        let (s, c) = angle.sin_cos();
        let [a, b] = self.half;
        let normal = (self.axes[0] * (b * c) + self.axes[1] * (a * s)).try_normalize(0.0)?;
        Some(((p - self.point(angle, height)).dot(&normal), normal))
    }

    pub(crate) fn centre(&self) -> Vector3<f64> {
        self.centre
    }

    /// All its numbers.
    pub(crate) fn numbers(&self) -> [f64; 15] {
        let mut all = [0.0; 15];
        let axes = self.axes.iter().flat_map(|axis| axis.iter());
        let numbers = self.centre.iter().chain(axes).chain(&self.half).chain([&self.offset]);
        all.iter_mut().zip(numbers).for_each(|(into, from)| *into = *from);
        all
    }

    pub(crate) fn same(&self, other: &Self, near: Vector3<f64>, size: f64, limit: f64) -> bool {
        let between = other.centre - self.centre;
        let off = between - self.axes[2] * self.axes[2].dot(&between);
        let turned: f64 = self.axes.iter().zip(&other.axes).map(|(a, b)| a.cross(b).norm()).sum();
        let apart = |k: usize| (self.half[k] - other.half[k]).abs();
        let reach = size + (near - self.centre).norm();
        off.norm() + turned * reach + apart(0) + apart(1) + (self.offset - other.offset).abs() <= limit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The distance is that of brute force over the swept torus.
    #[test]
    fn distances_are_those_of_the_swept_torus() {
        let (axis, way) = (Vector3::new(0.0, 0.0, 1.0), Vector3::new(2.0, 1.0, -0.7).normalize());
        let sheet = EllipticSheet::swept([1.0, 2.0, 3.0], axis.into(), 4.0, way.into(), 0.8).unwrap();
        let circle = |t: f64| Vector3::new(1.0 + 4.0 * t.cos(), 2.0 + 4.0 * t.sin(), 3.0);
        let mut tried = 0;
        for k in 0..40 {
            let angle = 0.157 * f64::from(k);
            let p = sheet.point(angle, 0.3 * f64::from(k)) + Vector3::new(0.2, -0.1, 0.15) * (angle.sin());
            let (distance, normal) = sheet.distance(p).unwrap();
            // From the lines through the circle.
            let nearest = (0..200_000)
                .map(|n| {
                    let off = p - circle(f64::from(n) * std::f64::consts::TAU / 200_000.0);
                    (off - way * way.dot(&off)).norm()
                })
                .fold(f64::INFINITY, f64::min);
            let inside = (p - sheet.centre).dot(&normal) < 0.0;
            assert!(
                !inside && (nearest - 0.8 - distance).abs() < 1e-6,
                "{k} {nearest} {distance}"
            );
            assert!(normal.dot(&way).abs() < 1e-12);
            tried += usize::from(distance.abs() > 0.01);
        }
        assert!(tried > 20);
    }

    #[test]
    fn speeds_are_those_of_differences() {
        let sheet = EllipticSheet::swept([0.0; 3], [0.0, 0.0, 1.0], 3.0, [1.0, 0.0, 0.4], 0.5).unwrap();
        for k in 0..20 {
            let t = 0.3 * f64::from(k);
            let by = (sheet.point(t + 1e-6, 1.0) - sheet.point(t - 1e-6, 1.0)) / 2e-6;
            assert!((by - sheet.speed(t)).norm() < 1e-7);
        }
        assert!(EllipticSheet::swept([0.0; 3], [0.0, 0.0, 1.0], 3.0, [1.0, 0.0, 0.0], 0.5).is_none());
        assert!(EllipticSheet::swept([0.0; 3], [0.0, 0.0, 1.0], 3.0, [0.0, 0.0, 1.0], 0.5).is_none());
    }
}
