//! A ball under a motion that turns.
//!
//! Its centre `C = b + ζ_c a` moves on a curve. A line at `d` from it, seen along the dexels, meets it at `N = (d, ∓h)` from its centre, `h² = R² − |d|²`, where
//!
//! ```text
//! G = R g = ⟨N, C′⟩,    G′ = −|C′|² + ⟨N, C″⟩ + C′_z z′,    z′ = G/N_z
//! ```
//!
//! along the line. Where the curve of the centre is less curved than the ball, `|C′|² > R |C″|`, each `G` falls wherever it is 0.

use super::Accuracy;
use super::axis_motion::{Bounds, Moment};
use super::shell::{Falls, Meeting, Passage, Shell, ShellPoint};
use super::spans::{Span, Verdict};
use crate::cutter::outline::Ball;
use crate::methods::sheets::around;
use crate::methods::sheets::intervals::{Range, Sign, add, between, joined, mul, square, square_root, sub, wider};
use nalgebra::{Vector2, Vector3};

/// A ball at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Centre {
    place: Vector3<f64>,
    rate: Vector3<f64>,
    bend: Vector3<f64>,
    axis: Vector3<f64>,
}

impl Centre {
    /// Seen along the dexels.
    fn level(&self) -> [f64; 2] {
        [self.place.x, self.place.y]
    }
}

/// What is known over a span.
#[derive(Clone, Copy, Debug)]
pub(super) struct BallLimits {
    /// Of `|C″|`.
    bow: f64,
    /// Of `|a′|`.
    turn: f64,
    /// How fast velocities turn, and a bound of `|b″|`.
    turning: f64,
    acceleration: f64,
    /// `|G|` below the first, and the second over `h`, may be rounding.
    doubt: [f64; 2],
    /// As far as rounding may move a point.
    pad: f64,
}

impl Ball {
    /// What is certain over a span; `None` if the centre's curve is curved too much there, seen in space or along the dexels.
    pub(super) fn limits(&self, [from, to]: [&Moment; 2], bounds: &Bounds, slack: f64) -> Option<BallLimits> {
        let bow = bounds.bow(self.centre);
        let [a, b] = [from, to].map(|moment| self.at(moment).rate);
        // The slowest on the way: the velocity changes by `bow` per time.
        let least = |a: f64, b: f64| a.min(b) - 0.5 * bow * bounds.length;
        let slow = least(a.xy().norm(), b.xy().norm());
        // Twice as much as is needed: the squared distance of a line is convex up to twice the radius. As the centre stays near its chord, no line that has left
        // the ball and been that far away returns.
        let straight = bounds.sag(bow) <= 0.25 * self.radius;
        (straight && slow > 0.0 && slow * slow > 2.0 * self.radius * bow).then(|| BallLimits {
            bow,
            turn: bounds.rate,
            turning: bounds.turning(),
            acceleration: bounds.acceleration,
            pad: 16.0 * slack,
            doubt: self.doubt(
                [a.xy().norm().max(b.xy().norm()), a.z.abs().max(b.z.abs())].map(|speed| speed + bow * bounds.length),
                bounds.noise,
                slack,
            ),
        })
    }

    /// For a centre that moves as fast along the lines' plane and along the lines.
    fn doubt(&self, [level, steep]: [f64; 2], noise: f64, slack: f64) -> [f64; 2] {
        let rounding = self.radius * (f64::EPSILON * (level + steep) + noise * slack);
        [32.0 * (slack * level + rounding), 32.0 * slack * self.radius * steep]
    }
}

/// Where a straight way is nearest to a line.
fn share([a, b]: [&Meeting; 2]) -> f64 {
    let from = Vector2::from(a.place);
    let way = Vector2::from(b.place) - from;
    let share = -from.dot(&way) / way.norm_squared();
    // A way without length has none.
    if share.is_nan() { 0.5 } else { share.clamp(0.0, 1.0) }
}

impl Shell for Ball {
    type Posed = Centre;
    type Limits = BallLimits;

    fn along(&self, span: &Span, accuracy: Accuracy, spacing: f64) -> Result<(BallLimits, [Range; 2]), Verdict> {
        let (ends, bounds) = ([&span.from, &span.to], &span.bounds);
        if !span.last && span.is_far(self.centre.abs(), self.radius, spacing) {
            return Err(Verdict::Long);
        }
        let limits = self.limits(ends, bounds, accuracy.slack).ok_or(Verdict::Long)?;
        let margin = self.radius + bounds.sag(limits.bow) + accuracy.slack;
        Ok((limits, around(&ends.map(|moment| self.at(moment).level()), margin)))
    }

    fn at_rest(&self, moment: &Moment, slack: f64) -> Option<(Centre, BallLimits)> {
        let centre = self.at(moment);
        let speed = [centre.rate.xy().norm(), centre.rate.z.abs()];
        let limits = BallLimits {
            bow: 0.0,
            turn: 0.0,
            turning: 0.0,
            acceleration: 0.0,
            doubt: self.doubt(speed, 0.0, slack),
            pad: 16.0 * slack,
        };
        Some((centre, limits))
    }

    fn area(&self, at: &Centre, slack: f64) -> [Range; 2] {
        around(&[at.level()], self.radius + slack)
    }

    #[inline]
    fn at(&self, moment: &Moment) -> Centre {
        Centre {
            place: moment.tip + moment.axis * self.centre,
            rate: moment.velocity + moment.rate * self.centre,
            bend: moment.acceleration + moment.bend * self.centre,
            axis: moment.axis,
        }
    }

    #[inline]
    fn meet(&self, at: &Centre, [x, y]: [f64; 2]) -> Meeting {
        let place = [x - at.place.x, y - at.place.y];
        let half_chord_sq = self.radius * self.radius - (place[0] * place[0] + place[1] * place[1]);
        if half_chord_sq > 0.0 {
            let half = half_chord_sq.sqrt();
            let (level, steep) = (place[0] * at.rate.x + place[1] * at.rate.y, half * at.rate.z);
            Meeting {
                half_chord_sq,
                half,
                place,
                g: [level - steep, level + steep],
            }
        } else {
            Meeting::beside(half_chord_sq, place)
        }
    }

    fn passage(&self, limits: &BallLimits, [a, b]: [&Meeting; 2], length: f64) -> Passage {
        match (a.half_chord_sq > 0.0, b.half_chord_sq > 0.0) {
            // The squared distance from the line is convex.
            (true, true) => Passage::Inside,
            (true, false) => Passage::Leaves,
            (false, true) => Passage::Enters,
            (false, false) => {
                let (from, to) = (Vector2::from(a.place), Vector2::from(b.place));
                let nearest = (from + (to - from) * share([a, b])).norm();
                let sag = 0.125 * limits.bow * length * length;
                if nearest > (self.radius + sag) * (1.0 + 1e-12) {
                    Passage::Beside
                } else {
                    Passage::Through
                }
            }
        }
    }

    fn falls(&self, _: &BallLimits, _: [(&Centre, &Meeting); 2], _: f64, _: usize) -> Falls {
        Falls::Always
    }

    #[inline]
    fn signs(&self, limits: &BallLimits, [from, to]: [&Centre; 2], [x, y]: [Range; 2], length: f64) -> [Sign; 2] {
        let sag = 0.125 * limits.bow * length * length;
        let seen = |k: usize, range: Range| {
            let [a, b] = [from, to].map(|centre| range.map(|at| at - centre.place[k]));
            joined(a, b, sag)
        };
        let (dx, dy) = (seen(0, x), seen(1, y));
        // As far as rounding may move a root.
        let half_chord_sq = sub([self.radius * self.radius; 2], add(square(dx), square(dy)));
        let half_chord_sq = wider(half_chord_sq, self.radius * limits.pad);
        if half_chord_sq[1] < 0.0 {
            return [Sign::Absent; 2];
        }
        let half = square_root(half_chord_sq);
        let change = limits.bow * length;
        let rate = |k: usize| between(from.rate[k], to.rate[k], change);
        let level = add(mul(dx, rate(0)), mul(dy, rate(1)));
        let steep = mul(half, rate(2));
        let axis = |k: usize| between(from.axis[k], to.axis[k], limits.turn * length);
        let along = add(mul(dx, axis(0)), mul(dy, axis(1)));
        let rise = mul(half, axis(2));
        let ends = wider(self.ends, limits.pad);
        // The rounding of `h` is in its range.
        let doubt = limits.doubt[0] + limits.doubt[1] / self.radius;
        let sign = |g: Range, along: Range| {
            if along[1] < ends[0] || along[0] > ends[1] {
                Sign::Absent
            } else {
                Sign::of(g, doubt)
            }
        };
        [
            sign(sub(level, steep), sub(along, rise)),
            sign(add(level, steep), add(along, rise)),
        ]
    }

    fn doubtful(&self, limits: &BallLimits, meeting: &Meeting, sheet: usize) -> bool {
        !(meeting.g[sheet].abs() * meeting.half > limits.doubt[0] * meeting.half + limits.doubt[1])
    }

    #[inline]
    fn slope(&self, at: &Centre, meeting: &Meeting, sheet: usize) -> [f64; 2] {
        let up = if sheet == 0 { -meeting.half } else { meeting.half };
        let rise = meeting.g[sheet] / up;
        let [x, y] = meeting.place;
        let bend = x * at.bend.x + y * at.bend.y + up * at.bend.z;
        [-at.rate.norm_squared() + bend + at.rate.z * rise, rise]
    }

    #[inline]
    fn gradient(&self, at: &Centre, meeting: &Meeting, sheet: usize) -> [f64; 2] {
        let up = if sheet == 0 { -meeting.half } else { meeting.half };
        let steep = at.rate.z / up;
        let [x, y] = meeting.place;
        [at.rate.x - steep * x, at.rate.y - steep * y]
    }

    #[inline]
    fn pace(&self, limits: &BallLimits, at: &Centre, meeting: &Meeting, slope: f64) -> [f64; 2] {
        let speed = at.rate.x.abs() + at.rate.y.abs() + at.rate.z.abs() + self.radius * limits.turn;
        [
            speed,
            (speed / meeting.half + limits.turning + limits.acceleration / speed) * (1.0 + speed * speed / slope.abs()),
        ]
    }

    #[inline]
    fn point(&self, at: &Centre, meeting: &Meeting, (sheet, rise, step): (usize, f64, f64), slack: f64) -> ShellPoint {
        let up = if sheet == 0 { -meeting.half } else { meeting.half };
        let [x, y] = meeting.place;
        let lift = 0.5 * rise * step;
        ShellPoint {
            height: at.place.z + up + lift,
            normal: Vector3::new(x - at.rate.x * step, y - at.rate.y * step, up + lift - at.rate.z * step),
            along: x * at.axis.x + y * at.axis.y + up * at.axis.z,
            error: 8.0 * slack * self.radius / meeting.half,
        }
    }

    fn nearest(&self, ends: [&Meeting; 2]) -> f64 {
        // Beside the ends, so that a span is divided.
        share(ends).clamp(0.01, 0.99)
    }

    fn misses(&self, limits: &BallLimits, poses: [&Centre; 2], (line, length): ([f64; 2], f64), sheet: usize) -> bool {
        self.signs(limits, poses, line.map(|at| [at; 2]), length)[sheet] == Sign::Absent
    }

    fn ends(&self) -> [f64; 2] {
        self.ends
    }
}
