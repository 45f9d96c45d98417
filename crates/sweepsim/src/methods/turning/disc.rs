//! A disc or a ring across the tool's axis, under a motion that turns.
//!
//! A line meets its plane once, at `e` from the centre `c = b + ζ a`, at right angles to `a`. There
//!
//! ```text
//! F = ⟨V, a⟩ = ⟨c′, a⟩ − ⟨e, a′⟩,    z′ = F/a_z,    F′ = 2⟨a′, b′⟩ + ζ |a′|² − ⟨e, a″⟩ − a′_z z′
//! ```
//!
//! along the line. If the axis travels faster along itself than the rim turns, `F` is never 0.

use super::axis_motion::{AxisMotion, Bounds, Moment};
use super::spans::{Span, Verdict};
use super::zero::{Known, Sample, Turn, start, zero};
use super::{Accuracy, Searching};
use crate::algebra::certain::certainly_within;
use crate::methods::harvest::unit;
use crate::methods::sheets::Undecided::{self, Close, Intricate};
use crate::methods::sheets::intervals::Range;
use crate::methods::sheets::{around, distance, search_lines};
use nalgebra::Vector3;
use sweepsim_dexel::Source;

/// A plane that is steeper than this is left to charts.
const STEEP: f64 = 1e-3;
/// The last step of Newton's method may turn the normal by so much: corrected to first order, that leaves its square.
const TURNED: f64 = 1e-3;

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
}

impl Disc {
    /// Whether a line at this distance from the centre meets it, if that is certain.
    pub fn holds(&self, radius: f64, error: f64) -> Option<bool> {
        let [inner, outer] = self.radii;
        certainly_within(radius, [if inner == 0.0 { -1.0 } else { inner }, outer], error)
    }

    /// Settles one span of a motion, unless it is too long.
    pub fn settle(
        &self,
        (motion, span): (&AxisMotion, &Span),
        Searching { collector, accuracy }: &mut Searching,
        source: &impl Fn(f64) -> Source,
    ) -> Verdict {
        let Span { from, to, bounds, .. } = span;
        let slack = accuracy.slack;
        if self.keeps_its_sign([from, to], bounds, slack) {
            return Verdict::Settled(Vec::new());
        }
        let steep = bounds.rise[0] < STEEP && bounds.rise[1] > -STEEP;
        let Some(falls) = self.falls([from, to], bounds).filter(|_| !steep) else {
            return Verdict::Long;
        };
        let [a, b] = [from, to].map(|moment| Placed::new(moment, self.height));
        let sag = bounds.sag(self.height.abs() * bounds.bend);
        let reach = self.radii[1] + sag + slack;
        let least = bounds.rise.map(f64::abs).into_iter().fold(f64::INFINITY, f64::min);
        let doubt = 16.0 * slack * (bounds.rate * (1.0 + 1.0 / least) + bounds.speed * f64::EPSILON / slack);
        let centres = [&a, &b].map(|placed| [placed.centre.x, placed.centre.y]);
        // Blocks that the disc does not reach.
        let over = |block: [Range; 2]| (distance(block, centres) <= reach).then_some(());
        let mut last = None;
        let left = search_lines(
            collector,
            around(&centres, reach),
            over,
            |collector, number, line, ()| {
                let ends = [a.along(&a.arm(line)), b.along(&b.arm(line))];
                if ends.iter().any(|f| f.abs() <= doubt) {
                    // Only if it is over the disc.
                    let beside = |placed: &Placed| placed.arm(line).norm() > 2.0 * self.radii[1];
                    return if beside(&a) && beside(&b) { Ok(()) } else { Err(Close) };
                }
                if (ends[0] >= 0.0) == (ends[1] >= 0.0) {
                    return Ok(());
                }
                if (ends[0] > 0.0) != falls {
                    return Err(Intricate);
                }
                if let Some(Turn { t, height, normal }) =
                    self.turn((motion, span), line, (ends, &mut last), *accuracy)?
                {
                    // From `g > 0` to `g < 0` if `F` falls on the upper side, or rises on the lower one.
                    let inwards = falls == (self.up > 0.0);
                    let jump = if (normal.z > 0.0) == inwards { -1 } else { 1 };
                    collector.crossing(number, height, jump, unit(normal), source(t));
                }
                Ok(())
            },
        );
        Verdict::Settled(left)
    }

    /// Whether `F` is certain not to be 0 on the disc.
    fn keeps_its_sign(&self, [from, to]: [&Moment; 2], bounds: &Bounds, slack: f64) -> bool {
        let [a, b] = [from, to].map(|m| m.along);
        let least = a.abs().min(b.abs()) - 0.5 * bounds.length * bounds.speed * bounds.rate;
        let turning = bounds.rate * self.radii[1] * (1.0 + 1e-9);
        a * b > 0.0 && least > turning + 16.0 * (bounds.speed * f64::EPSILON + slack * bounds.rate)
    }

    /// Whether `F` falls wherever it is 0, or rises wherever it is; `None` if that is not certain.
    fn falls(&self, [from, to]: [&Moment; 2], bounds: &Bounds) -> Option<bool> {
        let slope = |m: &Moment| 2.0 * m.rate.dot(&m.velocity) + self.height * m.rate.norm_squared();
        let [a, b] = [slope(from), slope(to)];
        let changes = 2.0 * bounds.bend * (bounds.speed + self.height.abs() * bounds.rate);
        // For all lines over the disc at any time of the span, at all times.
        let least = bounds.rise.map(f64::abs).into_iter().fold(f64::INFINITY, f64::min);
        let way = (bounds.speed + self.height.abs() * bounds.rate) * bounds.length;
        let arm = (self.radii[1] + way) * (1.0 + least.recip());
        let rest = 0.5 * bounds.length * changes + arm * (bounds.across + bounds.askew);
        (a * b > 0.0 && a.abs().min(b.abs()) > rest * (1.0 + 1e-9)).then_some(a < 0.0)
    }

    /// Where `F` is 0, if that is on the disc.
    fn turn(
        &self,
        (motion, span): (&AxisMotion, &Span),
        line: [f64; 2],
        (ends, last): ([f64; 2], &mut Option<Known>),
        Accuracy {
            slack,
            height_tolerance,
        }: Accuracy,
    ) -> Result<Option<Turn>, Undecided> {
        let side = ends[0].signum();
        let turning = span.bounds.turning();
        let bracket = [span.from.t, span.to.t];
        let first = match last.as_ref().map(|last| last.over(line)) {
            Some(t) if t > bracket[0] && t < bracket[1] => t,
            _ => start(bracket, ends.map(|f| Some([side * f, f64::NAN]))),
        };
        let (found, known) = zero(
            bracket,
            ([true; 2], first),
            |t| {
                let placed = Placed::new(&motion.at(t), self.height);
                let arm = placed.arm(line);
                let f = placed.along(&arm);
                let rise = f * placed.inverse;
                let slope = 2.0 * placed.rate.dot(&placed.travel)
                    - self.height * placed.rate.norm_squared()
                    - arm.dot(&placed.bend)
                    - placed.rate.z * rise;
                Some(Sample {
                    value: side * f,
                    slope: side * slope,
                    rise,
                    state: (placed, arm),
                })
            },
            |t, step, sample| {
                let (placed, arm) = &sample.state;
                let (radius, turn, tilt) = (arm.norm(), placed.rate.norm(), 1.0 + placed.inverse.abs());
                let speed = placed.travel.norm() + self.radii[1].max(radius) * turn;
                let turned = tilt * (turning + turn) * (1.0 + turn * speed / sample.slope.abs()) * step.abs();
                // So that the zero is no farther than two steps from here.
                if !(turned < 0.125) {
                    return None;
                }
                let error = 8.0 * (slack + speed * step.abs()) * tilt;
                let inside = self.holds(radius, error)?;
                // The height is extreme at the zero. With the next step it is expanded to second order; the rest is of third.
                if inside && !(turned <= TURNED && 2.0 * turned * (sample.rise * step).abs() <= height_tolerance) {
                    return None;
                }
                let [x, y] = [0, 1].map(|k| placed.rate[k] - placed.rate.z * placed.axis[k] * placed.inverse);
                let known = Known::new(line, t, ([-side * x, -side * y], sample.slope), last.as_ref());
                let turn = Turn {
                    t,
                    height: placed.centre.z + arm.z + 0.5 * sample.rise * step,
                    normal: (placed.axis + placed.rate * step) * self.up,
                };
                Some((inside.then_some(turn), known))
            },
        )?;
        *last = Some(known);
        Ok(found)
    }
}
