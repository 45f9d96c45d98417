//! Circles that turn about a line beside the tool, where they come near it.
//!
//! With the distance `R` of the line from the tip, `s` is a sum of two large numbers and a difference of them that is as large: next to the line it has
//! no digits left if `R` is the circle's radius. Here all follows from the difference of the radii instead.

use super::graph::{GraphPoint, TurnedPoint};
use super::ring::{Ring, Role};

/// What rounding may move a point by, in the rounding errors of a coordinate.
pub(super) const OFF: f64 = 8.0;

/// A line that the tool turns about, `radius` to the left (`side = 1`) or to the right of the tip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beside {
    pub radius: f64,
    pub side: f64,
    /// The rounding error of coordinates.
    pub slack: f64,
}

impl Beside {
    /// A point and the direction of the curve there, both outwards and ahead.
    ///
    /// If the curve is off by some distance across itself, or a line is, the angle is off by this, divided by the part of the direction towards the line, and by the distance from it.
    pub(super) fn seen(&self, out: f64, point: GraphPoint, [outwards, ahead]: [f64; 2]) -> TurnedPoint {
        TurnedPoint {
            out,
            error: OFF * self.slack * outwards.hypot(ahead) / (out * outwards + point.q * ahead).abs(),
            point,
        }
    }
}

impl Ring {
    /// The point at a squared distance from a line, before or beyond the place nearest to it. It is nearer than the axis of an upright tool.
    pub(crate) fn near(&self, beside: &Beside, s: f64, beyond: bool) -> TurnedPoint {
        let Beside { radius, side, slack } = *beside;
        let apart = radius - self.width;
        match self.role {
            Role::Rim { .. } => {
                let distance = s.sqrt();
                let out = 0.5 * (apart * (radius + self.width) + s) / radius;
                let ahead = ((distance - out) * (distance + out)).max(0.0).sqrt();
                let turn = [side * (radius - out) / self.width, self.half * ahead / self.width];
                // The circle's direction is perpendicular to its radius.
                let error = OFF * slack * distance / (radius * ahead) + 16.0 * f64::EPSILON;
                let point = self.point(turn, error);
                beside.seen(out, point, [-point.q, out - radius])
            }
            Role::Ball { .. } => {
                // out = R − r + r u, q = r k sin θ, with u = 1 − cos θ: a quadratic equation for u.
                let k = self.second[0] / self.width;
                let [flat, steep] = [(1.0 - k) * (1.0 + k), k * k];
                let half = apart + self.width * steep;
                let distance = s.sqrt();
                let less = (distance - apart) * (distance + apart);
                // The least value of s, or what it would be.
                let least = steep * (-apart * (radius + self.width) - self.width * self.width * steep) / flat;
                let root = (flat * (s - least)).max(0.0).sqrt();
                let u = if beyond {
                    -less / (self.width * (root - half))
                } else if half < 0.0 {
                    (root - half) / (self.width * flat)
                } else {
                    less / (self.width * (root + half))
                };
                let u = u.clamp(0.0, 1.0);
                let [c, n] = [1.0 - u, self.half * (u * (2.0 - u)).sqrt()];
                let point = self.point([side * c, n], 0.0);
                let way = [self.width * n, self.second[0] * c];
                beside.seen(apart + self.width * u, point, way)
            }
        }
    }
}
