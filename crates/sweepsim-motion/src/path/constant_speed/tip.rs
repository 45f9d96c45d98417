//! The tip along a move at constant speed.

use crate::path::rotary::turn;
use crate::path::{TableTurns, TipArc, TipCourse};
use crate::pose::Pose;
use crate::segment::{product, rational_turn};
use nalgebra::Vector3;

/// The course of the tip over the whole move.
pub(super) enum Tip {
    Straight([Vector3<f64>; 2]),
    /// An arc from a start, and the difference at its end.
    Arc(TipArc, Vector3<f64>, Vector3<f64>),
    /// The turns of a table, a start, and the way in the frame that turns.
    Carried(TableTurns, Vector3<f64>, Vector3<f64>),
}

impl Tip {
    pub fn new(from: &Pose, to: &Pose, course: &TipCourse) -> Self {
        match course {
            TipCourse::Straight => Self::Straight([from.tip_vector(), to.tip_vector()]),
            TipCourse::Arc(arc) => Self::Arc(
                *arc,
                from.tip_vector(),
                to.tip_vector() - arc.turned(from.tip_vector(), 1.0),
            ),
            TipCourse::Carried(turns) => {
                let [from, to] = [from, to].map(Pose::tip_vector);
                Self::Carried(*turns, from, turns.way(from, to))
            }
        }
    }

    /// Its angles, each with the distance of the tip from the axis at most.
    pub fn levers(&self) -> Vec<(f64, f64)> {
        match self {
            Self::Straight(_) => Vec::new(),
            Self::Arc(arc, from, _) => vec![(arc.angle().abs(), arc.radius_vector(*from).norm())],
            Self::Carried(turns, from, way) => turns.levers(*from, *way).0,
        }
    }

    pub fn angle(&self) -> f64 {
        self.levers().iter().map(|(angle, _)| *angle).fold(0.0, f64::max)
    }

    /// The displacement that is cubic in the parameter.
    pub fn straight(&self) -> Vector3<f64> {
        match self {
            Self::Straight([from, to]) => to - from,
            Self::Arc(_, _, way) | Self::Carried(_, _, way) => *way,
        }
    }

    /// Part `n` of `m`, where time has the slope `slope` at both ends: numerators and weights.
    pub fn part(&self, n: usize, m: usize, slope: f64) -> (Vec<Vector3<f64>>, Vec<f64>) {
        let (begin, end) = (n as f64 / m as f64, (n + 1) as f64 / m as f64);
        let way = self.straight();
        let third = (end - begin) * slope / 3.0;
        let times = [begin, begin + third, end - third, end];
        match self {
            Self::Straight([from, to]) => {
                let at = |time: f64| if time == 1.0 { *to } else { from + way * time };
                let points = if slope == 1.0 {
                    vec![at(begin), at(end)]
                } else {
                    times.map(at).to_vec()
                };
                (points, Vec::new())
            }
            Self::Arc(arc, from, _) => {
                let start = arc.turned(*from, begin);
                let out = arc.radius_vector(start);
                let foot = start - out;
                let (turns, weights, _) = rational_turn(arc.normal_vector().into_inner(), arc.angle() / m as f64);
                let circle = [0, 1, 2].map(|i| foot * weights[i] + turns[i] * out);
                if way.norm() <= 4.0 * f64::EPSILON * (start.norm() + out.norm()) {
                    return (circle.to_vec(), weights.to_vec());
                }
                let rise = product(&weights, &times, |w, time| way * (w * time));
                let circle = product(&[1.0; 4], &circle, |one, point| point * *one);
                let points = circle.iter().zip(&rise).map(|(circle, rise)| circle + rise).collect();
                (points, product(&weights, &[1.0; 4], |w, one| w * one))
            }
            Self::Carried(all, from, way) => {
                let (mut points, mut weights) = (times.map(|time| from + way * time).to_vec(), vec![1.0; 4]);
                for arc in all.turns().rev() {
                    let (normal, centre) = (arc.normal_vector().into_inner(), Vector3::from(arc.centre()));
                    let (turns, own, _) = rational_turn(normal, arc.angle() / m as f64);
                    let turned = turns.map(|part| part * turn(normal, arc.angle() * begin));
                    // Along the axis nothing turns.
                    let seen: Vec<(Vector3<f64>, Vector3<f64>)> = { points.iter().zip(&weights) }
                        .map(|(point, weight)| {
                            let off = point - centre * *weight;
                            let along = normal * normal.dot(&off);
                            (off - along, along + centre * *weight)
                        })
                        .collect();
                    let round = product(&turned, &seen, |turn, (out, _)| turn * out);
                    let rest = product(&own, &seen, |weight, (_, foot)| foot * *weight);
                    points = round.iter().zip(&rest).map(|(a, b)| a + b).collect();
                    weights = product(&own, &weights, |a, b| a * b);
                }
                (points, weights)
            }
        }
    }
}
