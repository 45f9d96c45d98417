//! Edges in space.

use nalgebra::Vector3;
use std::f64::consts::TAU;

/// The curve of an edge.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Curve {
    /// A straight line.
    Line,
    /// A circular arc, counter-clockwise about its axis.
    Circle {
        /// Its centre.
        centre: Vector3<f64>,
        /// Its axis.
        axis: Vector3<f64>,
        /// From the centre towards the start: a unit vector.
        towards: Vector3<f64>,
        /// Its radius.
        radius: f64,
        /// How far it turns, in radians.
        angle: f64,
    },
    /// An arc of an ellipse, counter-clockwise about its axis.
    Ellipse {
        /// Its centre.
        centre: Vector3<f64>,
        /// Its axis.
        axis: Vector3<f64>,
        /// The direction of its longer half axis.
        long: Vector3<f64>,
        /// The half axes, the longer first.
        half: [f64; 2],
        /// The parameters of its ends: angles from the longer half axis, the second larger.
        range: [f64; 2],
    },
    /// A cubic B-spline with one derivative in common at its inner knots, each of which is double.
    Spline {
        /// Control points: two more than twice the number of pieces.
        points: Vec<Vector3<f64>>,
        /// Where the pieces begin and end.
        knots: Vec<f64>,
    },
}

/// An edge of a solid.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Edge {
    /// The vertices where it begins and ends: the same for a closed edge.
    pub vertices: [u32; 2],
    /// Where these are.
    pub ends: [Vector3<f64>; 2],
    /// Its course between them.
    pub curve: Curve,
}

impl Edge {
    /// A point at a part of the way, from 0 to 1.
    #[must_use]
    pub fn at(&self, part: f64) -> Vector3<f64> {
        match &self.curve {
            Curve::Line => self.ends[0] + (self.ends[1] - self.ends[0]) * part,
            Curve::Circle {
                centre,
                axis,
                towards,
                radius,
                angle,
            } => {
                let (s, c) = (angle * part).sin_cos();
                centre + (towards * c + axis.cross(towards) * s) * *radius
            }
            Curve::Ellipse {
                centre,
                axis,
                long,
                half: [a, b],
                range: [from, to],
            } => {
                let (s, c) = (from + (to - from) * part).sin_cos();
                centre + long * (a * c) + axis.cross(long) * (b * s)
            }
            Curve::Spline { points, knots } => {
                let (Some(first), Some(last)) = (knots.first(), knots.last()) else {
                    return self.ends[0];
                };
                let t = first + (last - first) * part;
                let piece = knots.partition_point(|knot| *knot <= t).clamp(1, knots.len() - 1) - 1;
                let w = (t - knots[piece]) / (knots[piece + 1] - knots[piece]);
                let [b, c] = [points[2 * piece + 1], points[2 * piece + 2]];
                let a = joint(points, knots, piece);
                let d = joint(points, knots, piece + 1);
                let v = 1.0 - w;
                a * (v * v * v) + b * (3.0 * v * v * w) + c * (3.0 * v * w * w) + d * (w * w * w)
            }
        }
    }

    /// The chord.
    #[must_use]
    pub fn chord(&self) -> f64 {
        (self.ends[1] - self.ends[0]).norm()
    }

    /// Points along it, in as many parts as its turning needs: without its end.
    pub(crate) fn samples(&self) -> Vec<Vector3<f64>> {
        let parts = match &self.curve {
            Curve::Line => 4,
            Curve::Circle { angle, .. } => 4 + (angle / TAU * 28.0) as usize,
            Curve::Ellipse { range, .. } => 4 + ((range[1] - range[0]) / TAU * 28.0) as usize,
            Curve::Spline { knots, .. } => 2 * knots.len(),
        };
        (0..parts).map(|k| self.at(k as f64 / parts as f64)).collect()
    }
}

/// The point at a knot: at inner knots between the two control points beside it.
fn joint(points: &[Vector3<f64>], knots: &[f64], k: usize) -> Vector3<f64> {
    if k == 0 {
        return points[0];
    }
    if k + 1 == knots.len() {
        return points[points.len() - 1];
    }
    let (before, after) = (knots[k] - knots[k - 1], knots[k + 1] - knots[k]);
    (points[2 * k] * after + points[2 * k + 1] * before) / (before + after)
}

/// The spline through points with unit tangents.
pub(super) fn hermite(points: &[Vector3<f64>], tangents: &[Vector3<f64>]) -> Curve {
    let mut knots = vec![0.0];
    let mut control = vec![points[0]];
    for k in 1..points.len() {
        let chord = (points[k] - points[k - 1]).norm();
        // As far as makes a piece between tangents that turn by θ follow a circle best: the chord over cos² θ/4.
        let sine = (0.5 * (tangents[k] - tangents[k - 1]).norm()).min(1.0);
        let way = chord / (0.5 + 0.5 * (1.0 - sine * sine).sqrt());
        knots.push(knots[k - 1] + way);
        control.push(points[k - 1] + tangents[k - 1] * (way / 3.0));
        control.push(points[k] - tangents[k] * (way / 3.0));
    }
    control.push(points[points.len() - 1]);
    Curve::Spline { points: control, knots }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splines_pass_through_their_points_and_follow_a_circle() {
        let on = |t: f64| Vector3::new(3.0 * t.cos(), 3.0 * t.sin(), 1.0);
        let along = |t: f64| Vector3::new(-t.sin(), t.cos(), 0.0);
        let angles: Vec<f64> = [0.0, 0.2, 0.5, 0.6, 0.9].to_vec();
        let points: Vec<_> = angles.iter().map(|t| on(*t)).collect();
        let tangents: Vec<_> = angles.iter().map(|t| along(*t)).collect();
        let edge = Edge {
            vertices: [0, 1],
            ends: [points[0], points[4]],
            curve: hermite(&points, &tangents),
        };
        let Curve::Spline { knots, .. } = &edge.curve else {
            panic!()
        };
        let length = knots[4];
        assert!((length - 2.7).abs() < 1e-2);
        for (knot, point) in knots.iter().zip(&points) {
            assert!((edge.at(knot / length) - point).norm() < 1e-12);
        }
        for k in 0..=100 {
            let p = edge.at(f64::from(k) / 100.0);
            assert!((p.xy().norm() - 3.0).abs() < 1e-6, "{k} {}", p.xy().norm());
        }
    }
}
