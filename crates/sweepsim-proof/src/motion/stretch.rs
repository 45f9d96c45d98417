//! A stretch of a motion with bounds on how fast its tip and axis move and bend.

use crate::recall::Writing;
use nalgebra::{Vector3, Vector4};
use smallvec::SmallVec;
use sweepsim_motion::Segment;

/// Where the tip is and where the axis points.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// The tip.
    pub tip: Vector3<f64>,
    /// The unit vector from the tip to the holder.
    pub axis: Vector3<f64>,
}

/// A unit vector that moves no faster keeps still, but for rounding.
const STILL: f64 = 1e-13;

/// A tip that rises by no more keeps its height, in millimetres.
const LEVEL: f64 = 1e-9;

/// How fast something moves, and how fast that changes, for `t` in `[0, 1]`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Rates {
    pub speed: f64,
    pub bend: f64,
}

/// A segment of a move with what is known of it for all times.
#[derive(Clone, Debug)]
pub(crate) struct Stretch {
    /// None of a straight one.
    bent: Option<Box<Bent>>,
    /// The move, and the times in it at which the stretch begins and ends.
    pub number: usize,
    pub times: [f64; 2],
    /// Where it begins and ends.
    pub ends: [Placement; 2],
    /// The way of the tip stays in the box of these.
    pub low: Vector3<f64>,
    pub high: Vector3<f64>,
    tip: Rates,
    axis: Rates,
}

/// A segment, and the Bernstein coefficients of its tip and its axis, each with its weight.
#[derive(Clone, Debug)]
struct Bent {
    segment: Segment,
    tip: Form,
    axis: Form,
    is_level: bool,
}

type Form = SmallVec<[Vector4<f64>; 3]>;

impl Stretch {
    pub fn new(segment: Segment, number: usize, times: [f64; 2]) -> Self {
        let (points, weights) = segment.points();
        let control = || points.iter().zip(&weights).map(|(point, weight)| point / *weight);
        let low = control().fold(Vector3::repeat(f64::INFINITY), |low, p| low.inf(&p));
        let high = control().fold(Vector3::repeat(f64::NEG_INFINITY), |high, p| high.sup(&p));
        let axes: Vec<_> = segment.turns().iter().map(|turn| turn.column(2).into_owned()).collect();
        let (tip_rates, axis_rates) = (rates(&points, &weights), rates(&axes, segment.weights()));
        let ends = [0.0, 1.0].map(|t| placement(&segment, t));
        let is_straight = axis_rates.speed <= STILL && tip_rates.bend == 0.0;
        Self {
            bent: (!is_straight).then(|| {
                let form = |points: &[Vector3<f64>], weights: &[f64]| {
                    let all = points.iter().zip(weights);
                    all.map(|(point, weight)| point.push(*weight)).collect()
                };
                let (tip, axis): (Form, Form) = (form(&points, &weights), form(&axes, segment.weights()));
                let is_level = axis_rates.speed <= STILL && is_level(&tip, &ends[0].axis);
                Box::new(Bent {
                    segment,
                    tip,
                    axis,
                    is_level,
                })
            }),
            ends,
            number,
            times,
            low,
            high,
            tip: tip_rates,
            axis: axis_rates,
        }
    }

    /// All that it is but for the move's number, for a digest.
    pub fn write(&self, to: &mut Writing) {
        to.floats(&self.times);
        for end in &self.ends {
            to.floats(end.tip.as_slice());
            to.floats(end.axis.as_slice());
        }
        to.floats(self.low.as_slice());
        to.floats(self.high.as_slice());
        to.floats(&[self.tip.speed, self.tip.bend, self.axis.speed, self.axis.bend]);
        if let Some(bent) = &self.bent {
            to.bytes(format!("{:?}", bent.segment).as_bytes());
        }
    }

    /// Whether the axis stays the same.
    pub fn keeps_axis(&self) -> bool {
        self.axis.speed <= STILL
    }

    /// Whether the axis stays the same and the tip moves along a line.
    pub fn is_straight(&self) -> bool {
        self.bent.is_none()
    }

    /// Whether the axis stays the same and the tip does not move along it, as good as.
    pub fn is_level(&self) -> bool {
        self.bent.as_ref().is_some_and(|bent| bent.is_level)
    }

    /// Where the tip is.
    pub fn tip(&self, t: f64) -> Vector3<f64> {
        match &self.bent {
            Some(bent) => value(&bent.tip, t),
            None => self.at(t).tip,
        }
    }

    /// The axis turns by no more than this, in radians.
    pub fn turning(&self) -> f64 {
        if self.keeps_axis() { 0.0 } else { self.axis.speed }
    }

    pub fn at(&self, t: f64) -> Placement {
        let [from, to] = &self.ends;
        match &self.bent {
            Some(bent) => Placement {
                tip: value(&bent.tip, t),
                axis: match self.keeps_axis() {
                    true => from.axis,
                    false => value(&bent.axis, t).normalize(),
                },
            },
            None => Placement {
                tip: from.tip + (to.tip - from.tip) * t,
                axis: from.axis,
            },
        }
    }

    /// The time in the move.
    pub fn time(&self, t: f64) -> f64 {
        let own = self.bent.as_ref().map_or(t, |bent| bent.segment.time(t));
        self.times[0] + (self.times[1] - self.times[0]) * own
    }

    /// How far a point within `reach` of the tip may move in a time.
    pub fn travel(&self, reach: f64, duration: f64) -> f64 {
        (self.tip.speed + self.axis.speed * reach) * duration
    }

    /// By how much a point of the tool within `reach` of the tip may go beyond the line between where it is at the ends
    /// of a time, in any direction.
    ///
    /// Spin about the axis moves no point into or out of a solid of revolution, so the tool may be taken to turn with
    /// `ω = a × a′`. A point `p` then has `|p″| ≤ |b″| + (|ω′| + |ω|²) r` with `|ω| = |a′|` and `|ω′| ≤ |a″|`, and a
    /// function with `f″ ≥ −m` is at most `m h²/8` above its chord over a time `h`.
    pub fn bend(&self, reach: f64, duration: f64) -> f64 {
        let turning = self.axis.bend + self.axis.speed * self.axis.speed;
        (self.tip.bend + turning * reach) * duration * duration / 8.0
    }
}

/// Whether what the form describes is as high along an axis all the time.
fn is_level(form: &Form, axis: &Vector3<f64>) -> bool {
    let heights = form.iter().map(|point| axis.dot(&point.xyz()) / point.w);
    let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], c| {
        [low.min(c), high.max(c)]
    });
    high - low <= LEVEL
}

/// By de Casteljau, but for the many with three coefficients.
fn value(form: &Form, t: f64) -> Vector3<f64> {
    if let [a, b, c] = form[..] {
        let s = 1.0 - t;
        let own = a * (s * s) + b * (2.0 * s * t) + c * (t * t);
        return own.xyz() / own.w;
    }
    let mut row = form.clone();
    for left in (1..row.len()).rev() {
        for k in 0..left {
            let step = (row[k + 1] - row[k]) * t;
            row[k] += step;
        }
    }
    row[0].xyz() / row[0].w
}

fn placement(segment: &Segment, t: f64) -> Placement {
    let (turn, tip) = segment.at(t);
    Placement {
        tip: tip.into(),
        axis: turn.column(2).into_owned(),
    }
}

/// Bounds of the first two derivatives of `P/w` by control values, seen from the middle one.
///
/// With `q = P/w` from a centre, `q′ = (P′ − q w′)/w` and `q″ = (P″ − 2 q′ w′ − q w″)/w`; each part is bounded by its
/// own coefficients, as Bernstein forms lie in the hull of theirs.
fn rates(points: &[Vector3<f64>], weights: &[f64]) -> Rates {
    let n = points.len() - 1;
    if n == 0 {
        return Rates::default();
    }
    let centre = points[n / 2] / weights[n / 2];
    let own: Vec<Vector3<f64>> = points.iter().zip(weights).map(|(p, w)| p - centre * *w).collect();
    let least = weights.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    let degree = n as f64;
    let radius = largest(&mut own.iter().zip(weights).map(|(p, w)| p.norm() / w));
    let first = degree * largest(&mut own.windows(2).map(|p| (p[1] - p[0]).norm()));
    let weight_first = degree * largest(&mut weights.windows(2).map(|w| (w[1] - w[0]).abs()));
    let twice = degree * (degree - 1.0);
    let second = twice * largest(&mut own.windows(3).map(|p| (p[2] - p[1] * 2.0 + p[0]).norm()));
    let weight_second = twice * largest(&mut weights.windows(3).map(|w| (w[2] - 2.0 * w[1] + w[0]).abs()));
    let speed = (first + radius * weight_first) / least;
    let bend = (second + 2.0 * speed * weight_first + radius * weight_second) / least;
    Rates { speed, bend }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_motion::Pose;

    #[test]
    fn rates_hold_differences() {
        let from = Pose::new([0.0; 3], [0.0, 0.0, 1.0]).expect("a pose");
        let to = Pose::new([3.0, 4.0, 1.0], [1.0, 0.5, 0.2]).expect("a pose");
        for segment in Segment::between(&from, &to) {
            let stretch = Stretch::new(segment, 0, [0.0, 1.0]);
            let h = 1e-4;
            for k in 1..99 {
                let t = f64::from(k) / 100.0;
                let [a, b, c] = [t - h, t, t + h].map(|t| stretch.at(t).axis);
                let (first, second) = ((c - a).norm() / (2.0 * h), (c - b * 2.0 + a).norm() / (h * h));
                assert!(first <= stretch.axis.speed * (1.0 + 1e-6));
                assert!(second <= stretch.axis.bend * (1.0 + 1e-3));
                assert!(first > 0.3 * stretch.axis.speed, "{first} {}", stretch.axis.speed);
            }
            assert!((stretch.tip.speed - 26_f64.sqrt()).abs() < 1e-12 && stretch.tip.bend < 1e-12);
        }
    }
}
