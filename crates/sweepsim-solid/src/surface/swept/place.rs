//! Distances from pieces at a time, and points of sheets by their parameters.
//!
//! Legend: of a point relative to the tip, `h` is the height along the axis, `r` the distance from it, and `e` the unit
//! vector away from it.

use super::motion::Moving;
use super::{BEYOND, PARALLEL, SweptPiece, SweptSheet};
use nalgebra::Vector3;

/// Steps of differences, in angles, times and parts of lengths.
const STEP: f64 = 2e-3;

/// A line of the outline: its direction, its length, and its normal away from the tool.
fn line(from: [f64; 2], to: [f64; 2]) -> ([f64; 2], f64, [f64; 2]) {
    let (out, up) = (to[0] - from[0], to[1] - from[1]);
    let length = out.hypot(up);
    ([out / length, up / length], length, [up / length, -out / length])
}

/// The height, the distance and the direction from the axis.
fn around(p: Vector3<f64>, at: &Moving) -> (f64, f64, Vector3<f64>) {
    let off = p - at.tip;
    let h = off.dot(&at.axis);
    let across = off - at.axis * h;
    let r = across.norm();
    (h, r, across / r)
}

/// The velocity of a point of a tool that does not spin.
fn velocity(off: Vector3<f64>, at: &Moving) -> Vector3<f64> {
    at.tip_rate + at.axis.cross(&at.axis_rate).cross(&off)
}

impl SweptSheet {
    /// The direction about which angles are.
    pub(super) fn pole(&self, at: &Moving) -> Option<Vector3<f64>> {
        match self.piece {
            SweptPiece::Ball { height, .. } => (at.tip_rate + at.axis_rate * height).try_normalize(1e-9),
            _ => Some(at.axis),
        }
    }

    /// The directions at angles 0 and 90° about the pole.
    fn frame(&self, at: &Moving) -> Option<[Vector3<f64>; 2]> {
        let pole = self.pole(at)?;
        let x = (self.towards - pole * pole.dot(&self.towards)).try_normalize(0.0)?;
        Some([x, pole.cross(&x)])
    }

    /// How fast the distance of a point grows with time, or its square does: 0 where it is least.
    pub(super) fn slope(&self, p: Vector3<f64>, at: &Moving) -> f64 {
        if let SweptPiece::Ball { height, .. } = self.piece {
            let off = p - at.tip - at.axis * height;
            return -off.dot(&(at.tip_rate + at.axis_rate * height));
        }
        let off = p - at.tip;
        let (h, r, _) = around(p, at);
        let h_rate = off.dot(&at.axis_rate) - at.tip_rate.dot(&at.axis);
        let r_rate = (-off.dot(&at.tip_rate) - h * h_rate) / r;
        match self.piece {
            SweptPiece::Line { from, to, .. } => {
                let (_, _, normal) = line(from, to);
                normal[0] * r_rate + normal[1] * h_rate
            }
            SweptPiece::Circle { at: [out, up], .. } => (r - out) * r_rate + (h - up) * h_rate,
            SweptPiece::Ball { .. } => 0.0,
        }
    }

    /// The signed distance at a time, and its direction; `None` beyond the piece, or on the other side of its way.
    pub(super) fn distance(&self, p: Vector3<f64>, at: &Moving) -> Option<(f64, Vector3<f64>)> {
        match self.piece {
            SweptPiece::Ball { height, radius } => {
                let off = p - at.tip - at.axis * height;
                let far = off.norm();
                Some((far - radius, off.try_normalize(1e-9 * radius)?))
            }
            SweptPiece::Line { from, to, left } => {
                let (along, length, normal) = line(from, to);
                let (h, r, e) = around(p, at);
                let off = [r - from[0], h - from[1]];
                let s = off[0] * along[0] + off[1] * along[1];
                let beyond = BEYOND * length;
                let side = at.axis.cross(&self.ahead(s, at)).dot(&e) > 0.0;
                (s >= -beyond && s <= length + beyond && side == left && r > 0.0).then(|| {
                    let distance = off[0] * normal[0] + off[1] * normal[1];
                    (distance, e * normal[0] + at.axis * normal[1])
                })
            }
            SweptPiece::Circle {
                at: [out, up],
                tube,
                upper,
            } => {
                let (_, _, e) = around(p, at);
                let foot = at.tip + at.axis * up + e * out;
                let normal = self.swept_normal(e, at)?;
                let off = p - foot;
                if tube == 0.0 {
                    return Some((off.dot(&normal), normal));
                }
                let grows = off.try_normalize(1e-9 * tube)?;
                ((grows.dot(&normal) > 0.0) == upper).then(|| (off.norm() - tube, grows))
            }
        }
    }

    /// The normal of what the circle sweeps, at the point of the circle in a direction.
    fn swept_normal(&self, e: Vector3<f64>, at: &Moving) -> Option<Vector3<f64>> {
        let SweptPiece::Circle { at: [out, up], .. } = self.piece else {
            return None;
        };
        let along = at.axis.cross(&e);
        let way = velocity(at.axis * up + e * out, at);
        along.cross(&way).try_normalize(PARALLEL * way.norm())
    }

    /// Of a point of the line, the direction `w` for which points of the circle there are on the envelope where
    /// `e · w` is `c`, with `c` the second part of the envelope's equation.
    fn equation(&self, s: f64, at: &Moving) -> (Vector3<f64>, f64, [f64; 2]) {
        let SweptPiece::Line { from, to, .. } = self.piece else {
            return (Vector3::zeros(), 0.0, [0.0; 2]);
        };
        let (along, _, normal) = line(from, to);
        let (r, h) = (from[0] + s * along[0], from[1] + s * along[1]);
        let w = (at.tip_rate + at.axis_rate * h) * -normal[0] + at.axis_rate * (normal[1] * r);
        let w = w - at.axis * at.axis.dot(&w);
        (w, normal[1] * at.tip_rate.dot(&at.axis), [r, h])
    }

    fn ahead(&self, s: f64, at: &Moving) -> Vector3<f64> {
        self.equation(s, at).0
    }

    /// The first parameter of a point whose time is known.
    pub(super) fn parameter(&self, p: Vector3<f64>, at: &Moving) -> Option<f64> {
        if let SweptPiece::Line { from, to, .. } = self.piece {
            let (along, _, _) = line(from, to);
            let (h, r, _) = around(p, at);
            return Some((r - from[0]) * along[0] + (h - from[1]) * along[1]);
        }
        let off = match self.piece {
            SweptPiece::Ball { height, .. } => p - at.tip - at.axis * height,
            _ => p - at.tip,
        };
        let [x, y] = self.frame(at)?.map(|axis| axis.dot(&off));
        (x.hypot(y) > 0.0).then(|| y.atan2(x))
    }

    /// The point with these parameters.
    pub(super) fn point(&self, u: f64, t: f64) -> Option<Vector3<f64>> {
        let at = &self.motion.at(t);
        let [x, y] = self.frame(at)?;
        match self.piece {
            SweptPiece::Ball { height, radius } => {
                let (sin, cos) = u.sin_cos();
                Some(at.tip + at.axis * height + (x * cos + y * sin) * radius)
            }
            SweptPiece::Circle {
                at: [out, up],
                tube,
                upper,
            } => {
                let (sin, cos) = u.sin_cos();
                let e = x * cos + y * sin;
                let on = at.tip + at.axis * up + e * out;
                if tube == 0.0 {
                    return Some(on);
                }
                let side = if upper { tube } else { -tube };
                Some(on + self.swept_normal(e, at)? * side)
            }
            SweptPiece::Line { left, .. } => {
                let (w, c, [r, h]) = self.equation(u, at);
                let size = w.norm();
                let ahead = w.try_normalize(0.0)?;
                let cosine = c / size;
                if !(cosine.abs() < 1.0) {
                    return None;
                }
                let sine = (1.0 - cosine * cosine).sqrt();
                let aside = at.axis.cross(&ahead) * if left { sine } else { -sine };
                Some(at.tip + at.axis * h + (ahead * cosine + aside) * r)
            }
        }
    }

    /// The point and its derivatives by the first parameter, the second and both, by differences of the fourth order.
    pub(super) fn derivatives(&self, u: f64, t: f64) -> Option<[Vector3<f64>; 4]> {
        const WEIGHTS: [(f64, f64); 4] = [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)];
        let [du, dt] = [if self.is_round() { STEP } else { STEP * self.length() }, STEP];
        let (mut by_u, mut by_t, mut by_both) = (Vector3::zeros(), Vector3::zeros(), Vector3::zeros());
        for (k, weight) in WEIGHTS {
            by_u += self.point(u + k * du, t)? * (weight / (12.0 * du));
            by_t += self.point(u, t + k * dt)? * (weight / (12.0 * dt));
            for (l, other) in WEIGHTS {
                by_both += self.point(u + k * du, t + l * dt)? * (weight * other / (144.0 * du * dt));
            }
        }
        Some([self.point(u, t)?, by_u, by_t, by_both])
    }
}
