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
use super::graph::{End, Graph, GraphPoint, Turned};
use crate::methods::sheets::{middle, newton};
use std::f64::consts::{FRAC_PI_2, PI};

/// Steps of many values together, after which those that have not converged are left to the other way.
const STEPS_TOGETHER: usize = 8;
/// Where `q` changes faster than this, relative to `p`, each value is looked at by itself.
const STEEPEST: f64 = 1e9;
/// Ways less steep than this, but not level, are left to the general method: angles have no more digits.
const FLATTEST: f64 = 1e-14;

/// A monotone stretch on one side of the way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Torus {
    pub(super) centre: [f64; 2],
    pub(super) radius: f64,
    pub(super) slope: f64,
    /// `|e|` at the smaller and the larger `|p|`.
    pub(super) ends: [f64; 2],
    /// The signs of `e` and `f`.
    pub(super) signs: [f64; 2],
    /// The side of the way, and the span of `|p|`.
    pub(super) side: f64,
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
    pub(super) fn sine(&self, e: f64) -> f64 {
        let ratio = self.slope / e.max(f64::MIN_POSITIVE);
        (1.0 + self.slope * self.slope - ratio * ratio).max(0.0).sqrt()
    }

    /// `ρ` and `f`.
    pub(super) fn meridian(&self, e: f64) -> [f64; 2] {
        let rho = self.centre[0] + self.radius * self.signs[0] * e;
        [rho, self.signs[1] * ((1.0 - e) * (1.0 + e)).max(0.0).sqrt()]
    }

    /// `|p|` and `q`.
    pub(super) fn place(&self, e: f64) -> [f64; 2] {
        let [rho, f] = self.meridian(e);
        [rho * self.sine(e), -rho * self.slope * f / (self.signs[0] * e)]
    }

    /// `|e|` where `|p|` has this value.
    fn invert(&self, p: f64) -> Option<f64> {
        let [low, high] = self.ends;
        let rising = high > low;
        let (first, last) = (low.min(high), low.max(high));
        let square = self.slope * self.slope;
        let [offset, radius] = [self.centre[0], self.signs[0] * self.radius];
        let at = |e: f64| {
            // w² − (p/ρ)², which has the sign of |p(e)| − |p|.
            let rho = offset + radius * e;
            let (steep, flat) = (square / (e * e), p / rho);
            let value = 1.0 + square - steep - flat * flat;
            let rate = 2.0 * (steep / e + flat * flat * radius / rho);
            (value, value / rate, ())
        };
        let done = |e: f64, step: f64, (): &(), [a, b]: [f64; 2]| {
            let next = e - step;
            if (next - e).abs() <= 4.0 * f64::EPSILON * e {
                return Some(next.clamp(first, last));
            }
            (b - a <= 2.0 * f64::EPSILON * b).then_some(e)
        };
        newton([first, last], (rising, self.first_guess(p)), middle, at, done)
    }

    /// `|e|`, about, where `|p|` has this value.
    #[inline]
    fn first_guess(&self, p: f64) -> f64 {
        let [offset, radius] = [self.centre[0], self.signs[0] * self.radius];
        let square = self.slope * self.slope;
        // On a level way p is the radius; where the surface is nearly as flat as the way, the radius is that of the centre.
        let level = (p - offset) / radius;
        if level > 2.0 * self.slope.abs() {
            level
        } else {
            let w = p / offset;
            (square / (1.0 + square - w * w).max(f64::MIN_POSITIVE)).sqrt()
        }
    }

    /// `|e|` where `|p|` has these values, by the same steps for all; NaN where they do not suffice.
    fn invert_many(&self, p: &[f64], found: &mut [f64]) {
        let [a, b] = [self.ends[0].min(self.ends[1]), self.ends[0].max(self.ends[1])];
        let square = self.slope * self.slope;
        let [offset, radius] = [self.centre[0], self.signs[0] * self.radius];
        let place = |p: f64| p.abs().clamp(self.span[0], self.span[1]);
        for (p, e) in p.iter().zip(&mut *found) {
            // NaN becomes the lower end.
            *e = self.first_guess(place(*p)).max(a).min(b);
        }
        // The quotient of the value in `invert` and its derivative.
        let step = |p: f64, e: f64| {
            let rho = offset + radius * e;
            let inverse = 1.0 / (e * rho);
            let (steep, flat) = (square * (inverse * rho) * (inverse * rho), p * inverse * e);
            let flat = flat * flat;
            let value = 1.0 + square - steep - flat;
            let rate = 2.0 * (steep * (inverse * rho) + flat * radius * (inverse * e));
            value / rate
        };
        for _ in 0..STEPS_TOGETHER {
            let mut off = 0;
            for (p, e) in p.iter().zip(&mut *found) {
                let step = step(place(*p), *e);
                // NaN is off, too.
                off += usize::from(!(step.abs() <= 4.0 * f64::EPSILON * *e));
                *e = (*e - step).max(a).min(b);
            }
            if off == 0 {
                return;
            }
        }
        for (p, e) in p.iter().zip(found) {
            if !(step(place(*p), *e).abs() <= 8.0 * f64::EPSILON * *e) {
                *e = f64::NAN;
            }
        }
    }
}

impl Torus {
    /// The point with the radius `ρ` and the normal `(|e|, f)` of the meridian, and the sine `w`.
    #[inline]
    pub(super) fn point(&self, rho: f64, [e, f]: [f64; 2], w: f64) -> GraphPoint {
        let (sign, m) = (self.signs[0], self.slope);
        let cosine = -m * f / (sign * e);
        let cube = self.radius * sign * e * e * e;
        let [offset, square] = [self.centre[0], m * m];
        // The quotient of both derivatives.
        let slope = m * sign * (cube + offset) * e * w / (f * (cube * (1.0 + square) + offset * square));
        GraphPoint {
            q: rho * cosine,
            z: self.centre[1] + self.radius * f,
            slope: self.side * slope,
            jump: self.jump,
            normal: [
                self.out * sign * e * cosine,
                self.out * sign * e * w * self.side,
                self.out * f,
            ],
            certain: true,
        }
    }
}

impl Graph for Torus {
    #[inline]
    fn at(&self, p: f64) -> GraphPoint {
        let found = self.invert(p.abs());
        let e = found.unwrap_or(self.ends[0]);
        let [rho, f] = self.meridian(e);
        GraphPoint {
            certain: found.is_some(),
            ..self.point(rho, [e, f], p.abs() / rho)
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

    /// The product of the extremes of all factors.
    fn steepest(&self, between: [f64; 2]) -> Option<f64> {
        // On a level way there is nothing but the circles of its widest points.
        if self.slope == 0.0 {
            return Some(0.0);
        }
        let ends = [self.invert(between[0].abs())?, self.invert(between[1].abs())?];
        let high = ends[0].max(ends[1]);
        let square = self.slope * self.slope;
        let offset = self.centre[0];
        let cubes = ends.map(|e| self.radius * self.signs[0] * e * e * e);
        let over = cubes.map(|cube| (cube + offset).abs());
        let under = cubes.map(|cube| cube * (1.0 + square) + offset * square);
        let flat = ((1.0 - high) * (1.0 + high)).max(0.0).sqrt();
        let least = under[0].abs().min(under[1].abs()) * flat;
        let bound = self.slope.abs() * over[0].max(over[1]) * high * self.sine(high) / least;
        // With room for the rounding of all this; NaN is no bound.
        (under[0] * under[1] > 0.0 && bound < STEEPEST).then_some(1.1 * bound)
    }

    fn many_q(&self, p: &[f64], q: &mut [f64], own: &mut [f64]) {
        self.invert_many(p, own);
        for (q, e) in q.iter_mut().zip(own) {
            let [rho, f] = self.meridian(*e);
            *q = -rho * self.slope * f / (self.signs[0] * *e);
        }
    }

    fn many(&self, p: &[f64], own: &[f64], z: &mut [f64], [q, left, up]: [&mut [f64]; 3]) {
        let torus = *self;
        let sign = torus.out * torus.signs[0];
        let points = z.iter_mut().zip(q).zip(left).zip(up);
        for ((p, e), (((z, q), left), up)) in p.iter().zip(own).zip(points) {
            let [rho, f] = torus.meridian(*e);
            let across = sign * e;
            *z = torus.centre[1] + torus.radius * f;
            [*q, *left, *up] = [-torus.out * torus.slope * f, across * (p / rho), torus.out * f];
        }
    }
}

impl Turned for Torus {
    fn ends(&self) -> [End; 2] {
        // At the widest place p turns, and q does not.
        let end = |e: f64| End {
            q: self.place(e)[1],
            blur: (e == 1.0).then(|| 4.0 * f64::EPSILON * (self.centre[0].abs() + self.radius) * self.slope.abs()),
        };
        let [low, high] = self.ends;
        if self.side > 0.0 {
            [end(low), end(high)]
        } else {
            [end(high), end(low)]
        }
    }
}
