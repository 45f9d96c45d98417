//! One span of time in which each line is covered once at most.

use super::LeaningCeiling;
use crate::methods::harvest::Collector;
use crate::methods::sheets::{Counts, around, numbers};
use crate::methods::turning::axis_motion::{AxisMotion, Moment};
use nalgebra::Vector3;

/// A span is divided for one line this many times at most.
const DEEPEST: u32 = 12;

/// The section at the ceiling at one time.
pub(super) struct CeilingSection {
    moment: Moment,
    /// How far it is above the tip.
    above: f64,
    square: f64,
    centre: f64,
}

impl CeilingSection {
    /// `e` and `ζ`.
    #[inline]
    fn arm(&self, [x, y]: [f64; 2]) -> (Vector3<f64>, f64) {
        let own = &self.moment;
        let way = Vector3::new(x - own.tip.x, y - own.tip.y, self.above);
        let height = way.dot(&own.axis);
        let height = if height > self.centre { height } else { self.centre };
        (way - own.axis * height, height)
    }

    /// `E`.
    #[inline]
    pub fn value(&self, line: [f64; 2]) -> f64 {
        self.arm(line).0.norm_squared() - self.square
    }

    /// Of the lines of a column.
    fn values(&self, x: f64, y: &[f64], values: &mut [f64]) {
        for (value, y) in values.iter_mut().zip(y) {
            *value = self.value([x, *y]);
        }
    }

    /// `E′`.
    #[inline]
    pub fn slope(&self, line: [f64; 2]) -> f64 {
        let (arm, height) = self.arm(line);
        -2.0 * arm.dot(&(self.moment.velocity + self.moment.rate * height))
    }
}

/// A span of time in which a line is covered once at most.
pub(super) struct CeilingSpan<'a> {
    ceiling: &'a LeaningCeiling,
    motion: AxisMotion,
    ends: [CeilingSection; 2],
    /// The lines that may be covered.
    pub area: [[f64; 2]; 2],
    /// Of `E`.
    doubt: f64,
}

impl<'a> CeilingSpan<'a> {
    pub fn new(ceiling: &'a LeaningCeiling, motion: AxisMotion, [from, to]: [f64; 2], slack: f64) -> Option<Self> {
        let moments = [motion.at(from), motion.at(to)];
        let bounds = motion.bounds([&moments[0], &moments[1]]);
        let rise = bounds.rise[0];
        // The axis meets the plane at `b + a h/a_z`, on a way with this bound of its second derivative.
        let [above, _] = ceiling.heights([&moments[0], &moments[1]], &bounds);
        let speed = (bounds.speed + above * bounds.rate / rise) / rise;
        let bend = (bounds.acceleration + 2.0 * speed * bounds.rate + above * bounds.bend / rise) / rise;
        let bow = bend * bounds.lean[1] + 2.0 * speed * bounds.rate + bounds.bow(above / rise);
        let middles = moments.map(|moment| {
            let share = (ceiling.z - moment.tip.z) / moment.axis.z;
            [0, 1].map(|k| moment.tip[k] + moment.axis[k] * share)
        });
        let area = around(&middles, ceiling.radius / rise + bounds.sag(bow) + slack);
        Some(Self {
            ceiling,
            ends: moments.map(|moment| ceiling.section(moment)),
            motion,
            area,
            doubt: 16.0 * slack * ceiling.radius,
        })
    }

    /// Counts the lines that come under the tool.
    pub fn add(&self, first: bool, (counts, lines): (&mut Counts, &mut Collector)) {
        let lattice = lines.lines;
        let (Some(is), Some(js)) = (numbers(lattice, 0, self.area[0]), numbers(lattice, 1, self.area[1])) else {
            return;
        };
        let y: Vec<f64> = (js[0]..=js[1]).map(|j| lattice.coordinate(1, j)).collect();
        let mut values = [vec![0.0; y.len()], vec![0.0; y.len()]];
        for i in is[0]..=is[1] {
            let x = lattice.coordinate(0, i);
            for (end, values) in self.ends.iter().zip(&mut values) {
                end.values(x, &y, values);
            }
            for (at, j) in (js[0]..=js[1]).enumerate() {
                match self.enters([x, y[at]], [values[0][at], values[1][at]], first) {
                    Some(false) => {}
                    Some(true) => counts.put(i, [j, j], 1),
                    None if lattice.asks(i, j) => lines.open(lattice.line(i, j)),
                    None => {}
                }
            }
        }
    }

    /// Whether a line comes under the tool, or is there when the `first` span begins; `None` if that is open.
    #[inline]
    fn enters(&self, line: [f64; 2], values: [f64; 2], first: bool) -> Option<bool> {
        if values[0] < -self.doubt {
            return Some(first);
        }
        if !(values[0] > self.doubt && values[1].abs() > self.doubt) {
            return None;
        }
        if values[1] < 0.0 {
            return Some(true);
        }
        let [from, to] = &self.ends;
        let slopes = [from.slope(line), to.slope(line)];
        if slopes[0] >= 0.0 || slopes[1] <= 0.0 {
            return Some(false);
        }
        self.passes(
            line,
            [
                (from.moment.t, values[0], slopes[0]),
                (to.moment.t, values[1], slopes[1]),
            ],
        )
    }

    /// Whether a line is covered in between: times, values and slopes of `E`.
    #[cold]
    fn passes(&self, line: [f64; 2], [mut from, mut to]: [(f64, f64, f64); 2]) -> Option<bool> {
        for _ in 0..DEEPEST {
            // Above both tangents.
            let ((t, value, slope), (u, other, rise)) = (from, to);
            let crossing = (other - value + slope * t - rise * u) / (slope - rise);
            if slope >= 0.0 || rise <= 0.0 || value + slope * (crossing - t) > self.doubt {
                return Some(false);
            }
            // NaN is in the middle.
            let middle = if crossing > t && crossing < u {
                crossing
            } else {
                0.5 * (t + u)
            };
            let section = self.ceiling.section(self.motion.at(middle));
            let own = (middle, section.value(line), section.slope(line));
            if own.1.abs() <= self.doubt {
                return None;
            }
            if own.1 < 0.0 {
                return Some(true);
            }
            if own.2 < 0.0 {
                from = own;
            } else {
                to = own;
            }
        }
        None
    }
}

impl LeaningCeiling {
    pub(super) fn section(&self, moment: Moment) -> CeilingSection {
        CeilingSection {
            above: self.z - moment.tip.z,
            square: self.radius * self.radius,
            centre: self.centre,
            moment,
        }
    }
}
