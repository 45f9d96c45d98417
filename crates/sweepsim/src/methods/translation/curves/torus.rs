//! The grazing curve of a torus (an arc of the meridian about a point off the axis), for a tool that stands along the dexels.
//!
//! With the normal `(e, f)` of the arc, `e² + f² = 1`, and the slope `m` of the move: `ρ = ρ_c + r e`, `ζ = ζ_c + r f`, `cos φ = −m f/e`, so
//! `p = ± ρ w` with `w² = sin² φ = 1 + m² − m²/e²`, and `q = ρ cos φ`. In terms of `e`,
//!
//! ```text
//! dp/de = (r e³ (1 + m²) + ρ_c m²) / (e³ w)        dq/de = m (r e³ + ρ_c) / (f e²)
//! ```
//!
//! so `p` and `q` are monotone between the zeros of `e`, `f` and `w`, and two cube roots.

use super::Heading;
use super::graph::{Graph, Spot};
use std::f64::consts::{FRAC_PI_2, PI};

/// Steps of Newton's method, or bisections, of which a handful suffice.
const STEPS: usize = 80;
/// Ways less steep than this, but not level, are left to the general method: angles have no more digits.
const FLATTEST: f64 = 1e-14;

/// A monotone stretch on one side of the way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Torus {
    centre: [f64; 2],
    radius: f64,
    slope: f64,
    /// `|e|` at the smaller and the larger `|p|`.
    ends: [f64; 2],
    /// The signs of `e` and `f`.
    signs: [f64; 2],
    /// The side of the way, and the span of `|p|`.
    side: f64,
    span: [f64; 2],
    margins: [f64; 2],
    reach: [f64; 2],
    jump: i8,
    out: f64,
}

/// The stretches of an arc about `centre` between two ascending angles, which is traversed in the direction of `out`.
/// `None` if rounding would blur them.
pub(crate) fn stretches(
    heading: &Heading,
    centre: [f64; 2],
    radius: f64,
    angles: [f64; 2],
    out: f64,
) -> Option<Vec<Torus>> {
    let m = heading.slope();
    if m != 0.0 && m.abs() < FLATTEST {
        return None;
    }
    let square = m * m;
    // Angles, with |cos| where it is known better.
    let mut cuts: Vec<(f64, Option<f64>)> = angles.map(|angle| (angle, None)).into();
    let mut add = |angle: f64, cosine: Option<f64>| {
        // All turns of it.
        let first = ((angles[0] - angle) / (2.0 * PI)).ceil();
        let turned = angle + 2.0 * PI * first;
        if turned > angles[0] && turned < angles[1] {
            cuts.push((turned, cosine));
        }
    };
    for k in 0..4 {
        add(FRAC_PI_2 * f64::from(k), Some(f64::from(1 - k % 2)));
    }
    let steepest = m.abs() / (1.0 + square).sqrt();
    let ratio = -centre[0] / radius;
    let turning = [
        (ratio * square / (1.0 + square)).cbrt(),
        ratio.cbrt(),
        steepest,
        -steepest,
    ];
    for cosine in turning {
        if cosine.abs() < 1.0 {
            let angle = cosine.acos();
            add(angle, Some(cosine.abs()));
            add(-angle, Some(cosine.abs()));
        }
    }
    cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut stretches = Vec::new();
    for pair in cuts.windows(2) {
        let [(low, _), (high, _)] = [pair[0], pair[1]];
        let (f, e) = (0.5 * (low + high)).sin_cos();
        // No grazing where the surface is flatter than the way.
        if !(high > low) || e.abs() <= steepest {
            continue;
        }
        let whole = Torus {
            centre,
            radius,
            slope: m,
            ends: [0.0; 2],
            signs: [e.signum(), f.signum()],
            side: 1.0,
            span: [0.0; 2],
            margins: [0.0; 2],
            reach: [0.0; 2],
            jump: 0,
            out,
        };
        // (|e|, p, q, error of p)
        let mut ends = [pair[0], pair[1]].map(|(angle, cosine)| {
            let e = cosine.unwrap_or(angle.cos().abs()).max(steepest);
            let [p, q] = whole.place(e);
            let w = whole.sine(e);
            let error = if e == steepest { 1.0 } else { 1.0 + 1.0 / w.max(1e-7) };
            (e, p, q, heading.slack * error)
        });
        let grows = (ends[1].1 > ends[0].1) == (out > 0.0);
        if ends[0].1 > ends[1].1 {
            ends.swap(0, 1);
        }
        // The sign of n_ρ times that of the change of |p| along the meridian.
        let jump = if grows == (out * e > 0.0) { 1 } else { -1 };
        let one = Torus {
            ends: ends.map(|end| end.0),
            span: ends.map(|end| end.1),
            reach: [ends[0].2.min(ends[1].2), ends[0].2.max(ends[1].2)],
            margins: ends.map(|end| 2.0 * end.3),
            jump,
            ..whole
        };
        stretches.extend([1.0, -1.0].map(|side| Torus { side, ..one }));
    }
    Some(stretches)
}

impl Torus {
    /// `w`, at `|e|`.
    fn sine(&self, e: f64) -> f64 {
        let ratio = self.slope / e.max(f64::MIN_POSITIVE);
        (1.0 + self.slope * self.slope - ratio * ratio).max(0.0).sqrt()
    }

    /// `ρ` and `f`.
    fn meridian(&self, e: f64) -> [f64; 2] {
        let rho = self.centre[0] + self.radius * self.signs[0] * e;
        [rho, self.signs[1] * ((1.0 - e) * (1.0 + e)).max(0.0).sqrt()]
    }

    /// `|p|` and `q`.
    fn place(&self, e: f64) -> [f64; 2] {
        let [rho, f] = self.meridian(e);
        [rho * self.sine(e), -rho * self.slope * f / (self.signs[0] * e)]
    }

    /// `|e|` where `|p|` has this value.
    fn invert(&self, p: f64) -> Option<f64> {
        let [low, high] = self.ends;
        let rising = high > low;
        let (mut a, mut b) = (low.min(high), low.max(high));
        let square = self.slope * self.slope;
        let [offset, radius] = [self.centre[0], self.signs[0] * self.radius];
        // On a level way p is the radius; where the surface is nearly as flat as the way, the radius is that of the centre.
        let level = (p - offset) / radius;
        let mut e = if level > 2.0 * self.slope.abs() {
            level
        } else {
            let w = p / offset;
            (square / (1.0 + square - w * w).max(f64::MIN_POSITIVE)).sqrt()
        };
        for _ in 0..STEPS {
            if !(e > a && e < b) {
                e = if b > 4.0 * a && a > 0.0 {
                    (a * b).sqrt()
                } else {
                    0.5 * (a + b)
                };
            }
            // w² − (p/ρ)², which has the sign of |p(e)| − |p|.
            let rho = offset + radius * e;
            let (steep, flat) = (square / (e * e), p / rho);
            let value = 1.0 + square - steep - flat * flat;
            if (value < 0.0) == rising {
                a = e;
            } else {
                b = e;
            }
            let rate = 2.0 * (steep / e + flat * flat * radius / rho);
            let next = e - value / rate;
            if (next - e).abs() <= 4.0 * f64::EPSILON * e || b - a <= 2.0 * f64::EPSILON * b {
                return Some(next.clamp(low.min(high), low.max(high)));
            }
            e = next;
        }
        None
    }

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
            let middle = if b > 4.0 * a && a > 0.0 {
                (a * b).sqrt()
            } else {
                0.5 * (a + b)
            };
            if (over(middle) > 0.0) == before {
                a = middle;
            } else {
                b = middle;
            }
        }
        Some([Some([low, b]), Some([b, high])])
    }

    /// `p` at a value of `|e|`.
    pub(crate) fn across(&self, e: f64) -> f64 {
        self.side * self.place(e)[0]
    }

    /// `p` where the squared distance from that point has the value `s`, over a range of `|e|` where it is monotone.
    pub(crate) fn invert_about(&self, [low, high]: [f64; 2], radius: f64, side: f64, s: f64) -> Option<f64> {
        let (mut a, mut b) = (low, high);
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
        if !(e > a && e < b) {
            e = guess(-s.sqrt());
        }
        for _ in 0..STEPS {
            if !(e > a && e < b) {
                e = if b > 4.0 * a && a > 0.0 {
                    (a * b).sqrt()
                } else {
                    0.5 * (a + b)
                };
            }
            let value = value(e);
            if (value < 0.0) == rising {
                a = e;
            } else {
                b = e;
            }
            let rho = offset + bulge * e;
            let w = self.sine(e);
            let cube = e * e * e;
            let by = (bulge * cube * (1.0 + square) + offset * square) / (cube * w);
            let rate = sign * seen(e)[0] * by + rho * square * (bulge + offset / cube);
            let next = e + value / (2.0 * rate);
            if value.abs() <= noise || (next - e).abs() <= 4.0 * f64::EPSILON * e || b - a <= 2.0 * f64::EPSILON * b {
                let e = next.clamp(low, high);
                return Some(self.side * (offset + bulge * e) * self.sine(e));
            }
            e = next;
        }
        None
    }
}

impl Graph for Torus {
    #[inline]
    fn at(&self, p: f64) -> Spot {
        let found = self.invert(p.abs());
        let e = found.unwrap_or(self.ends[0]);
        let [rho, f] = self.meridian(e);
        let (sign, m) = (self.signs[0], self.slope);
        let cosine = -m * f / (sign * e);
        let w = p.abs() / rho;
        let cube = self.radius * sign * e * e * e;
        let [offset, square] = [self.centre[0], m * m];
        // The quotient of both derivatives.
        let slope = m * sign * (cube + offset) * e * w / (f * (cube * (1.0 + square) + offset * square));
        Spot {
            q: rho * cosine,
            z: self.centre[1] + self.radius * f,
            slope: self.side * slope,
            jump: self.jump,
            normal: [
                self.out * sign * e * cosine,
                self.out * sign * e * w * self.side,
                self.out * f,
            ],
            certain: found.is_some(),
        }
    }

    fn span(&self) -> [f64; 2] {
        let [low, high] = self.span;
        if self.side > 0.0 { [low, high] } else { [-high, -low] }
    }

    fn margins(&self) -> [f64; 2] {
        let [low, high] = self.margins;
        if self.side > 0.0 { [low, high] } else { [high, low] }
    }

    fn reach(&self) -> [f64; 2] {
        self.reach
    }

    fn jump(&self, _: [f64; 2]) -> Option<i8> {
        Some(self.jump)
    }

    /// On a level way there is nothing but the circles of its widest points.
    fn steepest(&self, _: [f64; 2]) -> Option<f64> {
        (self.slope == 0.0).then_some(0.0)
    }
}
