//! Where a dexel line meets a cone or a cylinder of a leaning tool: see [`leaning`](super::leaning).

use super::cone_sign_changes::Wedge;
use super::leaning::{LeaningPoint, PARALLEL, Points};
use crate::algebra::certain::certainly_within;

/// Nearer to the axis than this, azimuths say nothing.
const APEX: f64 = 1e-6;

/// Where a cone's normals lean less than this, from being on one side of the dexels, a line meets it once.
const UPRIGHT: f64 = 1e-6;

/// A cone or a cylinder.
pub(super) struct Cone {
    /// Of the meridian.
    pub normal: [f64; 2],
    pub tilt: [f64; 2],
    pub slack: f64,
    /// `w`.
    pub weight: f64,
    /// Of `ρ`, and of `ζ`.
    pub ends: [[f64; 2]; 2],
}

impl Cone {
    /// Where a line meets it, within a wedge if that is given.
    pub fn points(&self, [q, b]: [f64; 2], wedge: Option<&Wedge>) -> Points {
        let ([n, m], [s, k]) = (self.normal, self.tilt);
        if m == 0.0 {
            return self.on_cylinder([q, b], wedge);
        }
        if (n * s).abs() < UPRIGHT * (m * k).abs() {
            // With one sign of `n_z` there is one point, near the one of an upright cone.
            let mut tangent = false;
            let point = self.point([q, b], (-q / k, f64::INFINITY), wedge, &mut tangent);
            return if tangent {
                Points::Tangent
            } else {
                Points::Two([point, None])
            };
        }
        let u = s * self.weight - m * q;
        let [round, flat] = [n * s, m * k];
        let square = round * round - flat * flat;
        // (n_ρ ρ n_z s)² = (n_ρ s)² e
        let e = u * u - square * b * b;
        let size = self.weight.abs() + q.abs() + b.abs();
        let doubt = 16.0 * self.slack * size;
        if e < -doubt {
            return Points::Two([None, None]);
        }
        if e < doubt {
            return Points::Tangent;
        }
        let root = round.abs() * e.sqrt();
        let half = flat * u;
        let far = -(half + root.copysign(half));
        let product = round * round * b * b - u * u;
        let roots = [far / square, product / far];
        let mut tangent = false;
        // Rounding may move a root by much less than to the other one.
        let apart = 0.25 * (roots[1] - roots[0]).abs();
        let points = roots.map(|a| {
            if !a.is_finite() {
                return None;
            }
            // On the cone this is n² s ρ, on its other nappe the same below 0.
            let own = n * (u - flat * a);
            let expected = 0.5 * n * n * s * (a * a + b * b).sqrt();
            if !(own.abs() > expected && expected > self.slack * size) {
                // A root far away, or an apex.
                tangent |= a.abs() <= self.weight.abs() + q.abs() + b.abs() + self.ends[0][1];
                return None;
            }
            if own < 0.0 {
                return None;
            }
            self.point([q, b], (a, apart), wedge, &mut tangent)
        });
        // A line enters a cone and leaves it.
        if let [Some(a), Some(b)] = &points
            && (self.rises(a) > 0.0) == (self.rises(b) > 0.0)
        {
            tangent = true;
        }
        if tangent { Points::Tangent } else { Points::Two(points) }
    }

    /// The points on a cylinder, `a² + b² = ρ²`: dexels may be almost parallel to it. Then most of them are beside the ends of the cylinder, on the plane `s ζ = q + k a`.
    fn on_cylinder(&self, [q, b]: [f64; 2], wedge: Option<&Wedge>) -> Points {
        let ([n, _], [s, k]) = (self.normal, self.tilt);
        let rho = self.ends[0][1];
        let (square, doubt) = ((rho - b) * (rho + b), 16.0 * self.slack * (rho + b.abs()));
        if square < -doubt {
            return Points::Two([None, None]);
        }
        let heights = self.ends[1].map(|height| s * height);
        if square < doubt {
            // Anywhere near the middle.
            let reach = k.abs() * (square.max(0.0) + doubt).sqrt() + 8.0 * self.slack;
            let beside = q - reach > heights[1] || q + reach < heights[0];
            return if beside {
                Points::Two([None, None])
            } else {
                Points::Tangent
            };
        }
        let half = square.sqrt();
        let error = 8.0 * self.slack * rho / half;
        Points::Two([-half, half].map(|a| {
            if wedge.is_some_and(|wedge| !wedge.holds(a / rho, b / rho)) {
                return None;
            }
            let rise = q + k * a;
            let height = rise / s;
            Some(LeaningPoint {
                height: a * s + height * k,
                normal: [n * a / rho, n * b / rho, 0.0],
                error: [error / rho, 0.0],
                inside: certainly_within(rise, heights, error + 8.0 * self.slack),
            })
        }))
    }

    /// `n_z`.
    fn rises(&self, point: &LeaningPoint) -> f64 {
        self.tilt[0] * point.normal[0] + self.tilt[1] * point.normal[2]
    }

    /// The point near `a`; `tangent` if there may be one that is not certain.
    fn point(
        &self,
        [q, b]: [f64; 2],
        (first, apart): (f64, f64),
        wedge: Option<&Wedge>,
        tangent: &mut bool,
    ) -> Option<LeaningPoint> {
        let ([n, m], [s, k]) = (self.normal, self.tilt);
        let mut a = first;
        let mut step = 0.0;
        let (mut rho, mut up) = (0.0, 0.0);
        // Twice by Newton's method: then it is as accurate as the coordinates.
        for _ in 0..3 {
            rho = (a * a + b * b).sqrt();
            up = s * n * a / rho + m * k;
            step = (s * (n * rho - self.weight) + m * (q + k * a)) / up;
            a -= step;
        }
        let error = 8.0 * self.slack / up.abs();
        // NaN is in doubt.
        let found = step.abs() <= error && (a - first).abs() <= apart;
        if !(up.abs() > PARALLEL * s && found && rho > APEX) {
            *tangent = true;
            return None;
        }
        // Both are the same; one is the more accurate.
        let (height, blur) = if m.abs() > s {
            ((self.weight - n * rho) / m, error * (1.0 + n.abs()) / m.abs())
        } else {
            ((q + k * a) / s, (self.slack + error) / s)
        };
        let inside = if m.abs() > n.abs() {
            // An apex is no end.
            let [low, high] = self.ends[0];
            certainly_within(rho, [if low == 0.0 { -1.0 } else { low }, high], error)
        } else {
            let apex = self.ends[0][0] == 0.0 && rho < self.ends[0][1];
            let inside = certainly_within(height, self.ends[1], blur);
            if apex && inside.is_none() {
                certainly_within(rho, [-1.0, self.ends[0][1]], error)
            } else {
                inside
            }
        };
        if wedge.is_some_and(|wedge| !wedge.holds(a / rho, b / rho)) {
            return None;
        }
        Some(LeaningPoint {
            height: a * s + height * k,
            normal: [n * a / rho, n * b / rho, m],
            error: [error / rho, 0.0],
            inside,
        })
    }
}
