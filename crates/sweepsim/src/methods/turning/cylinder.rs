//! A cylinder about the tool's axis, under a motion that turns.
//!
//! In the coordinates of the tool, `α` across its axis in the vertical plane of it, `β` horizontally across both, `ζ` along it, with the dexels' direction `(s, 0, k)`, a line at `(q, δ)` along
//! and across the horizontal part of the axis meets the cylinder at `N = (α, δ, 0)`, `α = ∓√(r² − δ²)`, `s ζ = q + k α`. With the velocity `V = b′ + ζ a′ − x a` of that point, `x = ⟨N, a′⟩`,
//!
//! ```text
//! G = r g = ⟨N, V⟩,    z′ = G/(s α),    G′ = −V_φ² + x (x − 2 τ) + ⟨N, b″ + ζ a″⟩    where G = 0,
//! ```
//!
//! with `τ = ⟨b′, a⟩` and the part `V_φ` of `V` around the axis. There `|V_φ|` is `S`, the length of the part of `b′ + ζ a′` across the axis, and `|x| = r |⟨b′, a × a′⟩|/S`: so `G` falls wherever it is 0, except
//! for heights near the one that the tool turns about.

mod pivot;

use super::Accuracy;
use super::axis_motion::{AxisMotion, Bounds, Moment};
use super::lean::Lean;
use super::rim::is_simple;
use super::shell::{Falls, Meeting, Passage, Shell, ShellPoint};
use super::spans::{Span, Verdict};
use crate::methods::sheets::around;
use crate::methods::sheets::intervals::{
    Range, Sign, add, between, divided, joined, mul, shared, square, square_root, sub, wider,
};
use nalgebra::Vector3;

/// An axis that leans less than this is taken as upright, or less than what rounding allows,
const UPRIGHT: f64 = 2.5e-5;
/// up to this;
const STEEP: f64 = 0.006;
/// one at rest that leans less than this is left to charts.
const LEANING: f64 = 0.02;

/// The part of a cylinder between two heights.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cylinder {
    pub radius: f64,
    pub ends: [f64; 2],
}

/// What is known over a span.
#[derive(Clone, Copy, Debug)]
pub(super) struct CylinderLimits {
    /// Of `|δ″|` and `|q″|`.
    bow: f64,
    doubt: f64,
    /// As far as rounding may move a point.
    pad: f64,
    /// Heights at which `G` may rise.
    pub pivot: Option<[f64; 2]>,
    /// How fast the components of `b′` and of `a′` change, and bounds of those of `b″` and `a″`.
    travel: f64,
    rate: f64,
    acceleration: f64,
    bend: f64,
    /// How fast velocities turn.
    turning: f64,
    lean: [f64; 2],
    rise: [f64; 2],
    /// For the discs at the lower and the upper end of the piece: whether a line that is inside at both ends of a span
    /// is so all the time, and how far `s ζ − q` may be from its chord.
    closed: [bool; 2],
    behind: [f64; 2],
    /// The error of the square of a radius.
    close: f64,
}

impl Cylinder {
    /// The greatest distance of its points from the tip.
    fn reach(&self) -> f64 {
        self.radius + self.ends[0].abs().max(self.ends[1].abs())
    }

    /// The bound of `|δ″|` and `|q″|` for lines over the span.
    fn bow(&self, bounds: &Bounds) -> f64 {
        let [swing, change] = bounds.swing;
        let far = self.ends[0].abs().max(self.ends[1].abs());
        let reach = self.radius + far * bounds.lean[1] + bounds.speed * bounds.length;
        (swing * swing + change) * reach + 2.0 * swing * bounds.speed + bounds.acceleration
    }

    /// The bound of the second derivative of the corners of its shadow, seen along the dexels.
    fn shadow_bow(&self, bounds: &Bounds) -> f64 {
        let [swing, change] = bounds.swing;
        // Of `u` and of `k u`, with the horizontal direction `u` of the axis.
        let turn = swing * swing + change;
        let tilt = bounds.bend + 2.0 * bounds.rate * swing + turn;
        bounds.bow(self.reach()) + self.radius * (tilt + turn)
    }

    /// `|G| |α|` below this may be rounding, for points that move across the axis by at most `across`, in all by `speed` and the turn at `rate`, with an axis that leans by `s`.
    fn doubt(&self, [across, speed, rate, noise]: [f64; 4], s: f64, slack: f64) -> f64 {
        let r = self.radius;
        32.0 * r * (slack * (across + rate * r / s) + r * (f64::EPSILON * speed + noise * slack / s))
    }

    /// A bound of `|ζ|` where lines over the span meet the cylinder, however long it is.
    fn height(&self, bounds: &Bounds) -> f64 {
        let way = (bounds.speed + bounds.rate * self.reach()) * bounds.length;
        self.reach() + 2.0 * (self.radius + way) / bounds.lean[0]
    }

    /// What is certain over a span; `None` if the axis may be upright.
    pub fn limits(&self, [from, to]: [&Moment; 2], bounds: &Bounds, slack: f64) -> Option<CylinderLimits> {
        if !(bounds.lean[0] > 0.0) {
            return None;
        }
        let height = self.height(bounds);
        let across = [from, to].map(Moment::across).into_iter().fold(0.0, f64::max);
        let fastest = across + 0.5 * bounds.length * bounds.along() + bounds.rate * height;
        // Along unit vectors that turn as fast as the axis and its horizontal direction do.
        let turn = bounds.swing[0] + bounds.rate;
        let bend = bounds.across + bounds.askew;
        Some(CylinderLimits {
            bow: self.bow(bounds),
            doubt: self.doubt(
                [fastest, bounds.speed, bounds.rate, bounds.noise],
                bounds.lean[0],
                slack,
            ),
            pad: 16.0 * slack,
            pivot: self.pivot([from, to], bounds, height),
            travel: bounds.acceleration + turn * bounds.speed,
            rate: bend + turn * bounds.rate,
            acceleration: bounds.acceleration,
            bend,
            turning: bounds.turning(),
            lean: bounds.lean,
            rise: bounds.rise,
            closed: self.ends.map(|end| is_simple([self.radius, end], [from, to], bounds)),
            behind: self.ends.map(|end| {
                let leans = bounds.bend + bounds.rate * bounds.rate / bounds.lean[0];
                bounds.sag(self.bow(bounds) + end.abs() * leans) + 16.0 * slack
            }),
            close: 32.0 * slack * self.radius,
        })
    }

    /// The ranges of `α`, `δ` and `ζ` of a sheet where lines at `q` and `δ` meet it; `None` if they do not.
    #[inline(always)]
    fn ranges(&self, limits: &CylinderLimits, [q, delta]: [Range; 2], sheet: usize) -> Option<[Range; 3]> {
        let r = self.radius;
        if delta[0] > r + limits.pad || delta[1] < -r - limits.pad {
            return None;
        }
        let delta = shared(delta, [-r, r]);
        // As far as rounding may move a root.
        let half_chord_sq = wider(sub([r * r; 2], square(delta)), r * limits.pad);
        let half = square_root(half_chord_sq);
        let alpha = if sheet == 0 { [-half[1], -half[0]] } else { half };
        let zeta = divided(add(q, mul(limits.rise, alpha)), limits.lean);
        (zeta[1] >= self.ends[0] - limits.pad && zeta[0] <= self.ends[1] + limits.pad).then_some([alpha, delta, zeta])
    }

    /// The range of `G`, and the two parts of the velocity across the axis.
    #[inline(always)]
    fn rates(
        limits: &CylinderLimits,
        poses: [&Lean; 2],
        length: f64,
        [alpha, delta, zeta]: [Range; 3],
    ) -> (Range, [Range; 2]) {
        let [a, b] = poses;
        let across = |k: usize| {
            let travel = between(a.travel[k], b.travel[k], limits.travel * length);
            let rate = between(a.rate[k], b.rate[k], limits.rate * length);
            add(travel, mul(rate, zeta))
        };
        let across = [across(0), across(1)];
        (add(mul(alpha, across[0]), mul(delta, across[1])), across)
    }
}

impl Shell for Cylinder {
    type Posed = Lean;
    type Limits = CylinderLimits;

    fn along(&self, span: &Span, accuracy: Accuracy, spacing: f64) -> Result<(CylinderLimits, [Range; 2]), Verdict> {
        let (ends, bounds, slack) = ([&span.from, &span.to], &span.bounds, accuracy.slack);
        // Heights of points are off by the rounding error over the lean.
        let least = (slack / accuracy.height_tolerance).clamp(UPRIGHT, STEEP);
        if bounds.lean[1] <= 4.0 * least {
            return Err(Verdict::Intricate);
        }
        if !(bounds.lean[0] > least) {
            return Err(Verdict::Upright);
        }
        let limits = self.limits(ends, bounds, slack).ok_or(Verdict::Upright)?;
        let reach = self.ends[0].abs().max(self.ends[1].abs());
        if !span.last && span.is_far(0.5 * reach, self.radius, spacing) {
            return Err(Verdict::Long);
        }
        // How far lines may be from where a straight way has them: fewer spans for more, fewer lines that need another look for less.
        if bounds.sag(limits.bow) > spacing.min(0.2 * self.radius) {
            return Err(if bounds.lean[0] < STEEP {
                Verdict::Upright
            } else {
                Verdict::Long
            });
        }
        let corners = ends.map(|moment| self.at(moment).corners(self.radius, self.ends));
        let wider = bounds.sag(self.shadow_bow(bounds)) + slack;
        Ok((limits, around(&corners.concat(), wider)))
    }

    fn at_rest(&self, moment: &Moment, slack: f64) -> Option<(Lean, CylinderLimits)> {
        let pose = Lean::new(moment);
        let (rate, [s, k]) = (moment.rate.norm(), pose.tilt);
        let height = self.reach() + self.radius / s;
        let across = moment.across() + rate * height;
        let limits = CylinderLimits {
            bow: 0.0,
            doubt: self.doubt([across, moment.velocity.norm(), rate, 0.0], s, slack),
            pad: 16.0 * slack,
            pivot: None,
            travel: 0.0,
            rate: 0.0,
            acceleration: 0.0,
            bend: 0.0,
            turning: 0.0,
            lean: [s; 2],
            rise: [k; 2],
            closed: [true; 2],
            behind: [16.0 * slack; 2],
            close: 32.0 * slack * self.radius,
        };
        (s > LEANING).then_some((pose, limits))
    }

    fn area(&self, at: &Lean, slack: f64) -> [Range; 2] {
        around(&at.corners(self.radius, self.ends), slack)
    }

    fn at(&self, moment: &Moment) -> Lean {
        Lean::new(moment)
    }

    #[inline]
    fn pose(&self, motion: &AxisMotion, t: f64) -> Lean {
        Lean::during(motion, t)
    }

    #[inline]
    fn meet(&self, at: &Lean, line: [f64; 2]) -> Meeting {
        let [q, delta] = at.place(line);
        let half_chord_sq = (self.radius - delta) * (self.radius + delta);
        if half_chord_sq > 0.0 {
            let half = half_chord_sq.sqrt();
            let lift = at.tilt[1] * half;
            let below = (q - lift) * at.inverse;
            let above = (q + lift) * at.inverse;
            let g = |alpha: f64, zeta: f64| {
                alpha * (at.travel[0] + at.rate[0] * zeta) + delta * (at.travel[1] + at.rate[1] * zeta)
            };
            Meeting {
                half_chord_sq,
                half,
                place: [q, delta],
                g: [g(-half, below), g(half, above)],
            }
        } else {
            Meeting::beside(half_chord_sq, [q, delta])
        }
    }

    fn passage(&self, limits: &CylinderLimits, [a, b]: [&Meeting; 2], length: f64) -> Passage {
        let sag = 0.125 * limits.bow * length * length;
        let [from, to] = [a.place[1], b.place[1]];
        // Its derivative is within four sags of the difference.
        let monotone = (to - from).abs() > 4.0 * sag;
        let r = self.radius;
        match (a.half_chord_sq > 0.0, b.half_chord_sq > 0.0) {
            (true, true) if monotone || from.abs().max(to.abs()) + sag < r => Passage::Inside,
            (true, false) if monotone => Passage::Leaves,
            (false, true) if monotone => Passage::Enters,
            (false, false) if from * to < 0.0 => Passage::Through,
            (false, false) if monotone || from.abs().min(to.abs()) - sag > r => Passage::Beside,
            _ => Passage::Unknown,
        }
    }

    #[inline]
    fn falls(&self, limits: &CylinderLimits, ends: [(&Lean, &Meeting); 2], length: f64, sheet: usize) -> Falls {
        let near = |zone| self.falls_near(zone, limits, ends, length, sheet);
        limits.pivot.map_or(Falls::Always, near)
    }

    #[inline]
    fn signs(&self, limits: &CylinderLimits, poses: [&Lean; 2], block: [Range; 2], length: f64) -> [Sign; 2] {
        let sag = 0.125 * limits.bow * length * length;
        let [a, b] = [poses[0].places(block), poses[1].places(block)];
        let place = [joined(a[0], b[0], sag), joined(a[1], b[1], sag)];
        let sign = |sheet: usize| match self.ranges(limits, place, sheet) {
            None => Sign::Absent,
            Some([alpha, delta, zeta]) => {
                // Only on the piece.
                let zeta = shared(zeta, wider(self.ends, limits.pad));
                let (g, _) = Self::rates(limits, poses, length, [alpha, delta, zeta]);
                Sign::of(g, limits.doubt / self.radius)
            }
        };
        [sign(0), sign(1)]
    }

    #[inline]
    fn is_beyond(&self, limits: &CylinderLimits, ends: [(&Lean, &Meeting); 2], sheet: usize) -> bool {
        let side = if sheet == 0 { 1.0 } else { -1.0 };
        let ahead = |at: &Lean, meeting: &Meeting| at.tilt[0] * self.ends[sheet] - meeting.place[0];
        let is_in_disc = |at: &Lean, meeting: &Meeting| {
            let (across, k) = (meeting.place[1], at.tilt[1]);
            let square = k * k * (self.radius - across) * (self.radius + across);
            ahead(at, meeting).powi(2) + limits.close < square
        };
        // `s ζ = q + k α`, with `α < 0` on the lower sheet.
        limits.rise[0] > 0.0
            && (ends
                .iter()
                .all(|(at, meeting)| side * ahead(at, meeting) > limits.behind[sheet])
                || limits.closed[sheet] && ends.iter().all(|(at, meeting)| is_in_disc(at, meeting)))
    }

    fn doubtful(&self, limits: &CylinderLimits, meeting: &Meeting, sheet: usize) -> bool {
        !(meeting.g[sheet].abs() * meeting.half > limits.doubt)
    }

    #[inline]
    fn slope(&self, at: &Lean, meeting: &Meeting, sheet: usize) -> [f64; 2] {
        let alpha = if sheet == 0 { -meeting.half } else { meeting.half };
        let [q, delta] = meeting.place;
        let [s, k] = at.tilt;
        let zeta = (q + k * alpha) * at.inverse;
        let (va, vb) = (at.travel[0] + at.rate[0] * zeta, at.travel[1] + at.rate[1] * zeta);
        let seen = |v: [f64; 2]| alpha * v[0] + delta * v[1];
        let (x, y) = (seen(at.rate), seen(at.acceleration) + zeta * seen(at.bend));
        let rise = meeting.g[sheet] / (s * alpha);
        let around = alpha * vb - delta * va;
        // The point slides along the surface.
        let slides = -alpha * vb - delta * (rise * s - va);
        let slope = slides * around / (self.radius * self.radius) + y + x * (rise * k - 2.0 * at.travel[2] + x);
        [slope, rise]
    }

    #[inline]
    fn gradient(&self, at: &Lean, meeting: &Meeting, sheet: usize) -> [f64; 2] {
        let alpha = if sheet == 0 { -meeting.half } else { meeting.half };
        let [q, delta] = meeting.place;
        let zeta = (q + at.tilt[1] * alpha) * at.inverse;
        // α falls by δ/α along δ, and ζ by k/s times that.
        let (falls, x) = (delta / alpha, alpha * at.rate[0] + delta * at.rate[1]);
        let along = x * at.inverse;
        let aside = at.travel[1] + at.rate[1] * zeta - falls * (at.travel[0] + at.rate[0] * zeta + along * at.tilt[1]);
        let [ux, uy] = at.ahead;
        [ux * along - uy * aside, uy * along + ux * aside]
    }

    #[inline]
    fn pace(&self, limits: &CylinderLimits, at: &Lean, meeting: &Meeting, slope: f64) -> [f64; 2] {
        let height = (meeting.place[0].abs() + meeting.half) * at.inverse;
        let [a, b, c] = at.travel;
        let turn = at.rate[0].abs() + at.rate[1].abs();
        let speed = a.abs() + b.abs() + c.abs() + turn * (height + self.radius);
        [
            speed,
            at.inverse
                * (speed / meeting.half + limits.turning + limits.acceleration / speed)
                * (1.0 + speed * speed / slope.abs()),
        ]
    }

    #[inline]
    fn point(&self, at: &Lean, meeting: &Meeting, (sheet, rise, step): (usize, f64, f64), slack: f64) -> ShellPoint {
        let alpha = if sheet == 0 { -meeting.half } else { meeting.half };
        let [q, delta] = meeting.place;
        let ([s, k], [ux, uy]) = (at.tilt, at.ahead);
        let zeta = (q + k * alpha) * at.inverse;
        let (va, vb) = (at.travel[0] + at.rate[0] * zeta, at.travel[1] + at.rate[1] * zeta);
        let lift = 0.5 * rise * step;
        // The normal a step later, in the coordinates of now.
        let out = alpha + s * lift - va * step;
        let side = delta - vb * step;
        let up = -(alpha * at.rate[0] + delta * at.rate[1]) * step;
        let level = s * up - k * out;
        ShellPoint {
            height: at.tip[2] + s * alpha + k * zeta + lift,
            normal: Vector3::new(level * ux - side * uy, level * uy + side * ux, s * out + k * up),
            along: zeta,
            error: 8.0 * slack * (1.0 + self.radius / meeting.half) * at.inverse,
        }
    }

    fn nearest(&self, [a, b]: [&Meeting; 2]) -> f64 {
        let [from, to] = [a.place[1].abs(), b.place[1].abs()];
        from / (from + to)
    }

    fn ends(&self) -> [f64; 2] {
        self.ends
    }
}
