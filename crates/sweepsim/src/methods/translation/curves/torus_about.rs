//! The grazing curve of a torus that turns about a line beside the tool: where the distance from it is monotone, and its inverse.

use super::graph::TurnedPoint;
use super::ring_about::Beside;
use super::torus::Torus;
use crate::methods::sheets::{STEPS, middle, newton};

/// Where `|e|` is greater than this, `1 − |e|` has more digits.
const WIDE: f64 = 0.5;

impl Torus {
    /// The parts of the stretch over which the distance from a point `radius` to the left (`side = 1`) or to the right of the tip is monotone, as ranges of
    /// `|e|`; `None` if that is not certain.
    ///
    /// With `s = R² − 2 σ R p + ρ²` and `k = 1 + m² + ρ_c m²/(r e³)`, `d|p|/dρ = k/w`. So the two terms of `ds/dρ` have one sign, or they cancel where
    /// `h = ρ w/k` is `R`. The three terms of `d ln h/de` are `±r/ρ`, `m²/(e³ w²)` and `3 ρ_c m²/(r e⁴ k)`: `h` is monotone if the first is the
    /// largest by far, or if all have one sign: by at least `r/2ρ`, so that rounding shifts the place where it is `R` by no more than that of a coordinate.
    pub(crate) fn halves_about(&self, radius: f64, side: f64) -> Option<[Option<[f64; 2]>; 2]> {
        let square = self.slope * self.slope;
        let (offset, bulge) = (self.centre[0], self.signs[0] * self.radius);
        let [low, high] = [self.ends[0].min(self.ends[1]), self.ends[0].max(self.ends[1])];
        // On a level way all but the first term are 0, also where the normal is vertical.
        let part = |size: f64, e: f64| if square == 0.0 { 0.0 } else { size * square / e };
        let rate = |e: f64| 1.0 + square + part(offset / bulge, e * e * e);
        let whole = Some([Some([low, high]), None]);
        let (rising, falling) = (rate(low).min(rate(high)) >= 0.0, rate(low).max(rate(high)) <= 0.0);
        let outside = side * self.side < 0.0;
        if (rising && outside) || (falling && !outside) {
            return whole;
        }
        if !rising {
            return None;
        }
        let widest = self.meridian(low)[0].max(self.meridian(high)[0]);
        let (w, k) = (self.sine(low), rate(low).min(rate(high)));
        let others = part(1.0, low * low * low * w * w) + part(3.0 * (offset / bulge).abs(), low * low * low * low * k);
        if !((offset >= 0.0 && bulge > 0.0) || self.radius / widest > 2.0 * others) {
            return None;
        }
        // Negative where h is less than R.
        let over = |e: f64| self.meridian(e)[0] * self.sine(e) - radius * rate(e);
        let [before, after] = [over(low) > 0.0, over(high) > 0.0];
        if before == after {
            return whole;
        }
        let (mut a, mut b) = (low, high);
        for _ in 0..STEPS {
            let e = middle(a, b);
            if (over(e) > 0.0) == before {
                a = e;
            } else {
                b = e;
            }
        }
        Some([Some([low, b]), Some([b, high])])
    }

    /// How far the point at `|e| = 1 − u` is, outwards and ahead, from a line within less than `R` of it: accurate even if that is as far from the tip as the widest place of the torus is.
    fn at_widest(&self, radius: f64, u: f64) -> [f64; 2] {
        let bulge = self.signs[0] * self.radius;
        let widest = self.centre[0] + bulge;
        let (e, rho) = (1.0 - u, widest - bulge * u);
        let cosine = self.slope.abs() * (u * (2.0 - u)).sqrt() / e;
        let square = cosine * cosine;
        let w = (1.0 - square).max(0.0).sqrt();
        [(radius - widest) + bulge * u + rho * square / (1.0 + w), rho * cosine]
    }

    /// The squared distance from a line as near as that, at `|e|`.
    pub(crate) fn square_at(&self, beside: &Beside, e: f64) -> f64 {
        let [out, ahead] = if e > WIDE {
            self.at_widest(beside.radius, 1.0 - e)
        } else {
            let [p, q] = self.place(e);
            [beside.radius - beside.side * self.side * p, q]
        };
        out * out + ahead * ahead
    }

    /// The point at a squared distance from a line, over a range of `|e|` where it is monotone, if it is nearer to the line than the axis is, and to the widest place.
    pub(crate) fn near(&self, [low, high]: [f64; 2], beside: &Beside, s: f64) -> Option<TurnedPoint> {
        let low = low.max(WIDE);
        if self.side * beside.side < 0.0 || !(low < high) {
            return None;
        }
        let value = |u: f64| {
            let [out, ahead] = self.at_widest(beside.radius, u);
            out * out + ahead * ahead - s
        };
        let (a, b) = (1.0 - high, 1.0 - low);
        let [first, last] = [value(a), value(b)];
        if first * last > 0.0 {
            return None;
        }
        let rising = last > first;
        let (m, bulge) = (self.slope, self.signs[0] * self.radius);
        let (widest, square) = (self.centre[0] + bulge, m * m);
        let apart = beside.radius - widest;
        // As if w and the radius were linear.
        let rate = bulge + widest * square;
        let half = apart * rate + widest * widest * square;
        let distance = s.sqrt();
        let less = (distance - apart) * (distance + apart);
        let root = (half * half + rate * rate * less).max(0.0).sqrt();
        let guesses = [less / (half + root), less / (half - root)];
        let start = guesses.into_iter().find(|u| *u > a && *u < b).unwrap_or(f64::NAN);
        let at = |u: f64| {
            let value = value(u);
            let (e, rho) = (1.0 - u, widest - bulge * u);
            let bend = square * u * (2.0 - u) / (e * e);
            let turn = 2.0 * square / (e * e * e);
            let w = (1.0 - bend).max(0.0).sqrt();
            let [out, _] = self.at_widest(beside.radius, u);
            let outwards = bulge * (1.0 - bend / (1.0 + w)) + 0.5 * rho * turn / w;
            let step = value / (2.0 * out * outwards + rho * (rho * turn - 2.0 * bulge * bend));
            (value, step, [e, rho, w, out, outwards])
        };
        let done = |u: f64, step: f64, &[e, rho, w, out, outwards]: &[f64; 5], [a, b]: [f64; 2]| {
            (step.abs() <= 4.0 * f64::EPSILON * u || b - a <= 2.0 * f64::EPSILON * b).then(|| {
                let f = self.signs[1] * (u * (2.0 - u)).sqrt();
                let point = self.point(rho, [e, f], w);
                let ahead = m.abs() * (rho / (e * e) - bulge * f * f / e) * point.q.signum();
                beside.seen(out, point, [outwards * f.abs(), ahead])
            })
        };
        newton([a, b], (rising, start), middle, at, done)
    }

    /// `p` at a value of `|e|`.
    pub(crate) fn across(&self, e: f64) -> f64 {
        self.side * self.place(e)[0]
    }

    /// `p` where the squared distance from that point has the value `s`, over a range of `|e|` where it is monotone.
    pub(crate) fn invert_about(&self, [low, high]: [f64; 2], radius: f64, side: f64, s: f64) -> Option<f64> {
        let sign = side * self.side;
        let [offset, bulge] = [self.centre[0], self.signs[0] * self.radius];
        let square = self.slope * self.slope;
        // Outwards, and q²: small numbers next to the centre.
        let seen = |e: f64| {
            let rho = offset + bulge * e;
            let ahead = rho * self.slope / e.max(f64::MIN_POSITIVE);
            [
                radius - sign * rho * self.sine(e),
                ahead * ahead * (1.0 - e) * (1.0 + e),
            ]
        };
        let value = |e: f64| {
            let [out, ahead] = seen(e);
            out * out + ahead - s
        };
        let rising = value(high) > value(low);
        let noise = 4.0 * f64::EPSILON * (radius + s.sqrt()) * s.sqrt();
        // On a level way, the distance is R − σρ, or that less than 0.
        let guess = |distance: f64| (sign * (radius - distance) - offset) / bulge;
        let mut e = guess(s.sqrt());
        if !(e > low && e < high) {
            e = guess(-s.sqrt());
        }
        let at = |e: f64| {
            let value = value(e);
            let rho = offset + bulge * e;
            let w = self.sine(e);
            let cube = e * e * e;
            let by = (bulge * cube * (1.0 + square) + offset * square) / (cube * w);
            let rate = sign * seen(e)[0] * by + rho * square * (bulge + offset / cube);
            (value, -value / (2.0 * rate), value)
        };
        let done = |e: f64, step: f64, value: &f64, [a, b]: [f64; 2]| {
            let next = e - step;
            let is_last = value.abs() <= noise || (next - e).abs() <= 4.0 * f64::EPSILON * e;
            (is_last || b - a <= 2.0 * f64::EPSILON * b).then(|| {
                let e = next.clamp(low, high);
                self.side * (offset + bulge * e) * self.sine(e)
            })
        };
        newton([low, high], (rising, e), middle, at, done)
    }
}
