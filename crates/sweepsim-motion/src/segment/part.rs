//! Parts of a segment: what moves between two of its times.

use super::{Kind, Segment, SegmentCurve};
use sweepsim_spline::kernel::{Coefficient, split_line};

/// The form over `[from, to]`, as a form over `[0, 1]`.
fn restricted<A: Coefficient>(form: &[A], [from, to]: [f64; 2]) -> Vec<A> {
    let mut kept = form.to_vec();
    let mut other = kept.clone();
    if to < 1.0 {
        // `other` becomes the lower part.
        split_line(&mut kept, &mut other, 1.0 - to, to);
        kept.copy_from_slice(&other);
    }
    if from > 0.0 && to > 0.0 {
        let at = from / to;
        split_line(&mut kept, &mut other, 1.0 - at, at);
    }
    kept
}

impl Segment {
    /// The motion between `t = from` and `t = to`, with `0 ≤ from < to ≤ 1`, as a segment of its own. It is the same
    /// motion, up to rounding; its [time](Self::time) is its parameter.
    ///
    /// ```
    /// use sweepsim_motion::{Pose, Segment};
    /// let (from, to) = (Pose::new([0.0; 3], [0.0, 0.0, 1.0])?, Pose::new([8.0, 0.0, 0.0], [1.0, 0.0, 1.0])?);
    /// let whole = &Segment::between(&from, &to)[0];
    /// let part = whole.part(0.25, 0.75);
    /// assert!((part.start() - whole.at(0.25).0).norm() < 1e-14);
    /// assert_eq!(part.tips(), [[2.0, 0.0, 0.0], [6.0, 0.0, 0.0]]);
    /// # Ok::<(), sweepsim_motion::PoseError>(())
    /// ```
    #[must_use]
    pub fn part(&self, from: f64, to: f64) -> Self {
        let window = [from.clamp(0.0, 1.0), to.clamp(0.0, 1.0)];
        let length = window[1] - window[0];
        let (turns, weights) = (restricted(&self.turns, window), restricted(&self.weights, window));
        let (tips, kind) = match &self.kind {
            // κ is the angular velocity times the weight, and velocities shrink with the parameter.
            Kind::Arc(spin) => {
                let way = self.travel_vector();
                (window.map(|t| self.tips[0] + way * t), Kind::Arc(spin * length))
            }
            Kind::Curve(curve) => {
                let part = SegmentCurve {
                    points: restricted(&curve.points, window),
                    point_weights: restricted(&curve.point_weights, window),
                    spins: restricted(&curve.spins, window)
                        .iter()
                        .map(|spin| spin * length)
                        .collect(),
                    squared: curve.squared,
                };
                let last = part.points.len() - 1;
                let weight = |i: usize| part.point_weights.get(i).copied().unwrap_or(1.0);
                ([0, last].map(|i| part.points[i] / weight(i)), Kind::Curve(part))
            }
        };
        Self {
            tips,
            turns,
            weights,
            kind,
            clock: 0.0,
        }
    }

    /// The parameter at which a fraction of the segment's time has passed: the inverse of [`time`](Self::time).
    #[must_use]
    pub fn at_time(&self, time: f64) -> f64 {
        if self.clock == 0.0 {
            time
        } else {
            0.5 + 0.5 * ((2.0 * time - 1.0) * self.clock.atan()).tan() / self.clock
        }
    }
}
