//! A disc or a ring across the tool's axis, under a motion that turns.
//!
//! A line meets its plane once, at `e` from the centre `c = b + ζ a`, at right angles to `a`. There
//!
//! ```text
//! F = ⟨V, a⟩ = ⟨c′, a⟩ − ⟨e, a′⟩,    z′ = F/a_z,    F′ = ⟨b″, a⟩ + 2⟨a′, b′⟩ + ζ |a′|² − ⟨e, a″⟩ − a′_z z′
//! ```
//!
//! along the line. If the axis travels faster along itself than the rim turns, `F` is never 0.

use super::Accuracy;
use super::axis_motion::{Bounds, Moment};
use super::shell::{Falls, Meeting, Passage, Shell, ShellPoint};
use super::spans::{Span, Verdict};
use crate::methods::sheets::intervals::{Range, Sign, add, between, joined, mul, scaled, sub};
use crate::methods::sheets::{around, distance};
use nalgebra::Vector3;

/// A plane that is steeper than this is left to charts.
const STEEP: f64 = 1e-3;

#[derive(Clone, Copy, Debug)]
pub(super) struct Disc {
    /// `ζ`.
    pub height: f64,
    /// From the inner to the outer radius; the centre is no end.
    pub radii: [f64; 2],
    /// 1 where the normal is the axis, otherwise −1.
    pub up: f64,
}

/// The disc at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    pub centre: Vector3<f64>,
    pub axis: Vector3<f64>,
    pub rate: Vector3<f64>,
    pub bend: Vector3<f64>,
    /// `c′`, and its part along the axis.
    pub travel: Vector3<f64>,
    pub along: f64,
    /// `c″`.
    pub acceleration: Vector3<f64>,
    inverse: f64,
}

impl Placed {
    #[inline]
    pub fn new(moment: &Moment, height: f64) -> Self {
        let travel = moment.velocity + moment.rate * height;
        Self {
            centre: moment.tip + moment.axis * height,
            axis: moment.axis,
            rate: moment.rate,
            bend: moment.bend,
            travel,
            along: moment.along,
            acceleration: moment.acceleration + moment.bend * height,
            inverse: moment.axis.z.recip(),
        }
    }

    /// `e` of a line.
    #[inline]
    pub fn arm(&self, [x, y]: [f64; 2]) -> Vector3<f64> {
        let (dx, dy) = (x - self.centre.x, y - self.centre.y);
        Vector3::new(dx, dy, -(dx * self.axis.x + dy * self.axis.y) * self.inverse)
    }

    /// `F`.
    #[inline]
    pub fn along(&self, arm: &Vector3<f64>) -> f64 {
        self.along - arm.dot(&self.rate)
    }

    /// `F′ + a′_z z′`. As `⟨a″, a⟩ = −|a′|²`, it is `⟨c″, a⟩ + 2⟨a′, c′⟩ − ⟨e, a″⟩`.
    #[inline]
    pub fn lift(&self, arm: &Vector3<f64>) -> f64 {
        2.0 * self.rate.dot(&self.travel) + self.acceleration.dot(&self.axis) - arm.dot(&self.bend)
    }

    /// How fast `F` falls along x and y.
    #[inline]
    fn falls(&self) -> [f64; 2] {
        [0, 1].map(|k| self.rate[k] - self.rate.z * self.axis[k] * self.inverse)
    }
}

/// What is known over a span.
#[derive(Clone, Copy, Debug)]
pub(super) struct DiscLimits {
    /// Whether the line meets the disc below or above it.
    sheet: usize,
    /// Whether `G` falls wherever it is 0, or rises.
    falls: Falls,
    /// `|G|` below this may be rounding, unless it is a product.
    doubt: f64,
    product: bool,
    /// Bounds of the second derivative of the centre, and of how fast `⟨V, a⟩` at the centre and [`Placed::falls`]
    /// change.
    bow: f64,
    rates: [f64; 2],
    /// How fast velocities turn, and a bound of `|b″|`.
    turning: f64,
    acceleration: f64,
    pad: f64,
}

impl Disc {
    /// Whether `F` is certain not to be 0 on the disc.
    fn keeps_its_sign(&self, [from, to]: [&Moment; 2], bounds: &Bounds, slack: f64) -> bool {
        let [a, b] = [from, to].map(|m| m.along);
        let least = a.abs().min(b.abs()) - 0.5 * bounds.length * bounds.along();
        let turning = bounds.rate * self.radii[1] * (1.0 + 1e-9);
        a * b > 0.0 && least > turning + 16.0 * (bounds.speed * f64::EPSILON + slack * (bounds.rate + bounds.noise))
    }

    /// Whether `F` falls wherever it is 0, or rises wherever it is; `None` if that is not certain.
    fn falls_where_zero(&self, [from, to]: [&Moment; 2], bounds: &Bounds, least: f64) -> Option<bool> {
        let slope = |m: &Moment| {
            m.acceleration.dot(&m.axis) + 2.0 * m.rate.dot(&m.velocity) + self.height * m.rate.norm_squared()
        };
        let [a, b] = [slope(from), slope(to)];
        let changes = 2.0 * bounds.bend * (bounds.speed + self.height.abs() * bounds.rate)
            + (bounds.jerk + 3.0 * bounds.acceleration * bounds.rate);
        // For all lines over the disc at any time of the span, at all times.
        let way = (bounds.speed + self.height.abs() * bounds.rate) * bounds.length;
        let far = (self.radii[1] + way) / least;
        let moves = way + bounds.length * (bounds.speed + far * bounds.rate) / least;
        let arm = far.min(self.radii[1] + moves);
        let rest = 0.5 * bounds.length * changes + arm * (bounds.across + bounds.askew);
        (a * b > 0.0 && a.abs().min(b.abs()) > rest * (1.0 + 1e-9)).then_some(a < 0.0)
    }

    /// On which side of its own a line meets it.
    fn sheet(&self, axis: f64) -> usize {
        usize::from(self.up * axis > 0.0)
    }
}

/// `G` is `F` on the side of the normal.
impl Shell for Disc {
    type Posed = Placed;
    type Limits = DiscLimits;

    fn along(&self, span: &Span, accuracy: Accuracy, spacing: f64) -> Result<(DiscLimits, [Range; 2]), Verdict> {
        let (ends, bounds, slack) = ([&span.from, &span.to], &span.bounds, accuracy.slack);
        if self.keeps_its_sign(ends, bounds, slack) {
            return Err(Verdict::Settled(Vec::new()));
        }
        if !span.last && span.is_far(self.height.abs(), self.radii[1], spacing) {
            return Err(Verdict::Long);
        }
        let least = bounds.rise[0].max(-bounds.rise[1]);
        let Some(falls) = self.falls_where_zero(ends, bounds, least).filter(|_| least >= STEEP) else {
            return Err(Verdict::Long);
        };
        let bow = bounds.bow(self.height);
        // Of the horizontal part of the axis over the vertical one.
        let tilts = bounds.rate * (1.0 + least.recip()) / least;
        let limits = DiscLimits {
            sheet: self.sheet(span.from.axis.z),
            falls: if falls == (self.up > 0.0) {
                Falls::Always
            } else {
                Falls::Never
            },
            doubt: 16.0 * (slack * (bounds.rate + bounds.noise) * (1.0 + 1.0 / least) + bounds.speed * f64::EPSILON),
            product: false,
            bow,
            rates: [
                bounds.along(),
                bounds.bend * (1.0 + least.recip()) + bounds.rate * tilts,
            ],
            turning: bounds.turning(),
            acceleration: bounds.acceleration,
            pad: slack,
        };
        let centres = ends.map(|moment| moment.tip + moment.axis * self.height);
        let area = around(
            &centres.map(|c| [c.x, c.y]),
            self.radii[1] + span.bounds.sag(bow) + slack,
        );
        Ok((limits, area))
    }

    fn at_rest(&self, moment: &Moment, slack: f64) -> Option<(Placed, DiscLimits)> {
        let placed = self.at(moment);
        let rate = placed.rate.norm();
        let error = 8.0 * slack * (3.0 + placed.inverse.abs());
        let limits = DiscLimits {
            sheet: self.sheet(placed.axis.z),
            falls: Falls::Unknown,
            doubt: error * rate + 16.0 * f64::EPSILON * placed.travel.norm() * f64::from(u8::from(rate > 0.0)),
            product: rate == 0.0,
            bow: 0.0,
            rates: [0.0; 2],
            turning: 0.0,
            acceleration: 0.0,
            pad: slack,
        };
        (placed.axis.z.abs() >= STEEP).then_some((placed, limits))
    }

    fn area(&self, at: &Placed, slack: f64) -> [Range; 2] {
        around(&[[at.centre.x, at.centre.y]], self.radii[1] + slack)
    }

    fn at(&self, moment: &Moment) -> Placed {
        Placed::new(moment, self.height)
    }

    #[inline]
    fn meet(&self, at: &Placed, line: [f64; 2]) -> Meeting {
        let g = self.up * at.along(&at.arm(line));
        Meeting {
            half_chord_sq: 1.0,
            half: 1.0,
            place: line,
            g: [g; 2],
        }
    }

    fn passage(&self, _: &DiscLimits, _: [&Meeting; 2], _: f64) -> Passage {
        Passage::Inside
    }

    fn falls(&self, limits: &DiscLimits, _: [(&Placed, &Meeting); 2], _: f64, _: usize) -> Falls {
        limits.falls
    }

    #[inline]
    fn signs(&self, limits: &DiscLimits, [from, to]: [&Placed; 2], block: [Range; 2], length: f64) -> [Sign; 2] {
        let mut signs = [Sign::Absent; 2];
        let sag = 0.125 * limits.bow * length * length;
        let centres = [from, to].map(|placed| [placed.centre.x, placed.centre.y]);
        if distance(block, centres) <= self.radii[1] + sag + limits.pad {
            let [along, change] = limits.rates.map(|rate| rate * length);
            let (a, b) = (from.falls(), to.falls());
            let part = |k: usize| {
                let centre = joined([centres[0][k]; 2], [centres[1][k]; 2], sag);
                mul(sub(block[k], centre), between(a[k], b[k], change))
            };
            let f = sub(between(from.along, to.along, along), add(part(0), part(1)));
            signs[limits.sheet] = Sign::of(scaled(self.up, f), limits.doubt);
        }
        signs
    }

    fn doubtful(&self, limits: &DiscLimits, meeting: &Meeting, sheet: usize) -> bool {
        !(limits.product || meeting.g[sheet].abs() > limits.doubt)
    }

    #[inline]
    fn slope(&self, at: &Placed, meeting: &Meeting, sheet: usize) -> [f64; 2] {
        let rise = self.up * meeting.g[sheet] * at.inverse;
        let slope = at.lift(&at.arm(meeting.place)) - at.rate.z * rise;
        [self.up * slope, rise]
    }

    #[inline]
    fn gradient(&self, at: &Placed, _: &Meeting, _: usize) -> [f64; 2] {
        at.falls().map(|fall| -self.up * fall)
    }

    #[inline]
    fn pace(&self, limits: &DiscLimits, at: &Placed, meeting: &Meeting, slope: f64) -> [f64; 2] {
        let (radius, turn, tilt) = (at.arm(meeting.place).norm(), at.rate.norm(), 1.0 + at.inverse.abs());
        let speed = at.travel.norm() + self.radii[1].max(radius) * turn;
        let turning = limits.turning + limits.acceleration / speed;
        let pace = tilt * (turning + turn) * (1.0 + turn * speed / slope.abs());
        [4.0 * speed * tilt, pace]
    }

    #[inline]
    fn point(&self, at: &Placed, meeting: &Meeting, (_, rise, step): (usize, f64, f64), slack: f64) -> ShellPoint {
        let arm = at.arm(meeting.place);
        ShellPoint {
            height: at.centre.z + arm.z + 0.5 * rise * step,
            normal: (at.axis + at.rate * step) * self.up,
            along: arm.norm(),
            error: 8.0 * slack * (1.0 + at.inverse.abs()),
        }
    }

    /// Of its radii, of which the centre is none.
    fn ends(&self) -> [f64; 2] {
        let [inner, outer] = self.radii;
        [if inner == 0.0 { -1.0 } else { inner }, outer]
    }

    fn nearest(&self, _: [&Meeting; 2]) -> f64 {
        0.5
    }
}
