//! A sharp edge, a circle about the tool's axis, under a motion that turns.
//!
//! A line meets the plane of the circle once, at `e` from its centre `c = b + ζ a` (see [`disc`](super::disc)). It meets the surface that the circle sweeps where
//!
//! ```text
//! E = |e|² − R² = 0,    E′/2 = ⟨e, e′⟩ = e_z z′ − ⟨e, c′⟩
//! ```
//!
//! along the line. With `e = (d, −⟨d, h⟩)`, `h = a_h/a_z`, `E″/2 = |c_h′|² − ⟨d, c_h″⟩ + f′² + f f″`, `f = ⟨d, h⟩`: where the way of the centre is straighter than the circle, seen along the dexels, `E` is
//! convex, and the signs of `E` and its derivative at the ends of a span tell how often it is 0.

use super::Accuracy;
use super::axis_motion::{AxisMotion, Bounds, Moment};
use super::disc::Placed;
use super::spans::{Span, Verdict};
use super::zero::{Sample, Turn, zero};
use crate::cutter::outline::{Rim, fan_normal};
use crate::methods::harvest::{Collector, unit};
use crate::methods::sheets::Undecided::{self, Close};
use crate::methods::sheets::intervals::{Range, Sign, add, between, divided, joined, mul, scaled, sub, wider};
use crate::methods::sheets::{around, distance, search_lines};
use nalgebra::Vector3;
use sweepsim_dexel::Source;

/// A plane that is steeper than this is left to charts.
const STEEP: f64 = 0.02;
/// The last step of Newton's method may turn the arm by so much.
const TURNED: f64 = 1e-3;
/// A span of one line is halved this many times at most.
const DEEPEST: u32 = 12;

/// `E`, and half of its derivative.
#[derive(Clone, Copy, Debug)]
struct Value {
    t: f64,
    square: f64,
    half: f64,
}

/// How the faces beside a rim move during a span, as ranges.
struct Facing {
    centre: [Range; 2],
    /// `a_h/a_z`, `c′`, and `⟨V, a⟩` on the rim.
    lean: [Range; 2],
    travel: [Range; 3],
    along: Range,
    /// Of `g`.
    error: f64,
}

impl Facing {
    fn new(rim: &Rim, [a, b]: [&Placed; 2], bounds: &Bounds, slack: f64) -> Self {
        let (length, height) = (bounds.length, rim.height.abs());
        let bow = bounds.bow(height);
        let speed = bounds.speed + height * bounds.rate;
        let turning = rim.radius * bounds.rate;
        let along = [a.along.min(b.along), a.along.max(b.along)];
        Self {
            centre: [0, 1].map(|k| joined([a.centre[k]; 2], [b.centre[k]; 2], bounds.sag(bow))),
            lean: [0, 1].map(|k| divided(between(a.axis[k], b.axis[k], bounds.rate * length), bounds.rise)),
            travel: [0, 1, 2].map(|k| between(a.travel[k], b.travel[k], bow * length)),
            along: wider(along, turning + 0.5 * length * bounds.along()),
            error: 16.0 * (slack / STEEP * (bounds.rate + speed / rim.radius + bounds.noise) + f64::EPSILON * speed),
        }
    }

    /// Whether `g` has the same sign on both faces wherever a line of the block is on the rim.
    fn alike(&self, rim: &Rim, [x, y]: [Range; 2]) -> bool {
        let arm = [sub(x, self.centre[0]), sub(y, self.centre[1])];
        let up = add(mul(arm[0], self.lean[0]), mul(arm[1], self.lean[1]));
        let [u, v, w] = self.travel;
        let out = sub(add(mul(arm[0], u), mul(arm[1], v)), mul(up, w));
        let sign = |[n, m]: [f64; 2]| {
            let g = add(scaled(n / rim.radius, out), scaled(m, self.along));
            Sign::of(g, self.error)
        };
        let first = sign(rim.normals[0]);
        first != Sign::Unknown && sign(rim.normals[1]) == first
    }
}

/// Whether the plane of a circle with this radius and height is never steep, and its `E` convex for all lines over the
/// disc at any time of the span.
///
/// At such a time, `|f| = |e_z|` is no more than the lean of the axis times the radius. With `f′ = ⟨d, h′⟩ − ⟨c_h′, h⟩`
/// and `f″ = ⟨d, h″⟩ − 2⟨c_h′, h′⟩ − ⟨c_h″, h⟩`.
pub(super) fn is_simple([radius, height]: [f64; 2], ends: [&Moment; 2], bounds: &Bounds) -> bool {
    if !(bounds.rise[0] >= STEEP || bounds.rise[1] <= -STEEP) {
        return false;
    }
    let (length, half, bow) = (bounds.length, 0.5 * bounds.length, bounds.bow(height));
    let [a, b] = ends.map(|m| {
        let travel = (m.velocity + m.rate * height).xy();
        let lean = m.axis.xy() / m.axis.z;
        let tilt = (m.rate.xy() - lean * m.rate.z) / m.axis.z;
        let [own, across] = [&lean, &tilt].map(|of| travel.dot(of));
        [travel.norm(), own, across, tilt.norm(), m.rate.z]
    });
    let most = |n: usize, change: f64| a[n].abs().max(b[n].abs()) + half * change;
    let least = |n: usize, change: f64| {
        let least = a[n].abs().min(b[n].abs()) - half * change;
        if a[n] * b[n] > 0.0 { least.max(0.0) } else { 0.0 }
    };
    // h = a_h/a_z, and bounds of its derivatives: first by those of `a` alone, then from the ends.
    let steepest = bounds.rise.map(f64::abs).into_iter().fold(f64::INFINITY, f64::min);
    let level = bounds.lean[1].min(1.0);
    let lean = level / steepest;
    let tilts = |tilt: f64, climb: f64| (bounds.bend * (1.0 + lean) + 2.0 * tilt * climb) / steepest;
    let tilt = bounds.rate * (1.0 + lean) / steepest;
    let tilt = tilt.min(most(3, tilts(tilt, bounds.rate)));
    let tilts = tilts(tilt, most(4, bounds.bend));
    let (slow, fast) = (least(0, bow), most(0, bow));
    let reach = radius + fast * length;
    let f = (reach * lean).min(radius * level + length * (fast * lean + reach * tilt));
    let f_rate = (least(1, bow * lean + fast * tilt) - reach * tilt).max(0.0);
    let f_bend = bow * lean + 2.0 * most(2, bow * tilt + fast * tilts) + reach * tilts;
    slow > 0.0 && slow * slow + f_rate * f_rate > 1.01 * (reach * bow + f * f_bend)
}

/// About where `E` is 0 between two times at which its signs differ: at the zero of the cubic that has its values and
/// slopes there.
fn start([from, to]: [Value; 2], inwards: f64) -> f64 {
    let way = to.t - from.t;
    let [a, b] = [2.0 * from.half * way, 2.0 * to.half * way];
    let rise = to.square - from.square;
    let third = a + b - 2.0 * rise;
    let second = rise - a - third;
    // Of the parabola with both values and the difference of the slopes.
    let bend = 0.5 * (b - a);
    let slope = rise - bend;
    let root = (slope * slope - 4.0 * bend * from.square).sqrt();
    let mut share = -2.0 * from.square / (slope - inwards * root);
    for _ in 0..2 {
        let value = from.square + share * (a + share * (second + share * third));
        share -= value / (a + share * (2.0 * second + share * 3.0 * third));
    }
    from.t + way * share
}

/// A search of a rim along a motion.
pub(super) struct RimSearch<'a, F> {
    rim: &'a Rim,
    motion: &'a AxisMotion,
    accuracy: Accuracy,
    source: F,
    /// Bounds of the speed of points of the rim, of `|a′|`, and of how fast velocities turn.
    speed: f64,
    rate: f64,
    turning: f64,
    noise: f64,
}

impl<'a, F: Fn(f64) -> Source> RimSearch<'a, F> {
    pub fn new(rim: &'a Rim, motion: &'a AxisMotion, accuracy: Accuracy, source: F) -> Self {
        let bounds = motion.bounds([&motion.at(0.0), &motion.at(1.0)]);
        let speed = bounds.speed + (rim.height.abs() + rim.radius) * bounds.rate;
        Self {
            rim,
            motion,
            accuracy,
            source,
            speed,
            rate: bounds.rate,
            turning: bounds.turning() + bounds.acceleration / speed,
            noise: bounds.noise,
        }
    }

    /// Settles one span, unless it is too long.
    pub fn settle(&self, span: &Span, collector: &mut Collector) -> Verdict {
        let Span { from, to, bounds, .. } = span;
        if !self.is_simple([from, to], bounds) {
            // Where not even the ends are, no halves will do.
            let is_simple = |end| self.is_simple([end, end], &self.motion.bounds([end, end]));
            return if is_simple(from) || is_simple(to) {
                Verdict::Long
            } else {
                Verdict::Intricate
            };
        }
        let [a, b] = [from, to].map(|moment| Placed::new(moment, self.rim.height));
        let slack = self.accuracy.slack;
        let facing = Facing::new(self.rim, [&a, &b], bounds, slack);
        let sag = bounds.sag(bounds.bow(self.rim.height));
        let centres = [&a, &b].map(|placed| [placed.centre.x, placed.centre.y]);
        let reach = self.rim.radius + sag + slack;
        let wanted = |block: [Range; 2]| {
            // `E` is convex in space as well: all of a block is inside at both ends if its corners are.
            let inside = |placed: &Placed| {
                let [x, y] = block;
                x.into_iter().all(|x| {
                    y.into_iter()
                        .all(|y| self.value(placed, 0.0, [x, y]).square < -self.doubt())
                })
            };
            let excluded =
                distance(block, centres) > reach || inside(&a) && inside(&b) || facing.alike(self.rim, block);
            (!excluded).then_some(())
        };
        let visit = |collector: &mut Collector, number, line, ()| {
            let ends = [self.value(&a, from.t, line), self.value(&b, to.t, line)];
            if ends.iter().all(|end| end.square < -self.doubt()) {
                return Ok(());
            }
            self.between((number, line), ends, collector, 0)
        };
        let left = search_lines(collector, around(&centres, reach), wanted, visit);
        Verdict::Settled(left)
    }

    fn is_simple(&self, ends: [&Moment; 2], bounds: &Bounds) -> bool {
        is_simple([self.rim.radius, self.rim.height], ends, bounds)
    }

    /// Of `E`.
    fn doubt(&self) -> f64 {
        16.0 * self.accuracy.slack * self.rim.radius / STEEP
    }

    #[inline]
    fn value(&self, placed: &Placed, t: f64, line: [f64; 2]) -> Value {
        let arm = placed.arm(line);
        let rise = placed.along(&arm) / placed.axis.z;
        Value {
            t,
            square: arm.norm_squared() - self.rim.radius * self.rim.radius,
            half: arm.z * rise - arm.dot(&placed.travel),
        }
    }

    fn between(
        &self,
        line: (usize, [f64; 2]),
        [from, to]: [Value; 2],
        collector: &mut Collector,
        depth: u32,
    ) -> Result<(), Undecided> {
        let doubt = self.doubt();
        if from.square.abs() <= doubt || to.square.abs() <= doubt {
            return Err(Close);
        }
        match (from.square < 0.0, to.square < 0.0) {
            (true, true) => Ok(()),
            (true, false) => self.pass(line, [from, to], -1.0, collector),
            (false, true) => self.pass(line, [from, to], 1.0, collector),
            (false, false) => {
                // Above both tangents.
                let (a, b) = (2.0 * from.half, 2.0 * to.half);
                if a >= 0.0 || b <= 0.0 {
                    return Ok(());
                }
                let crossing = (to.square - from.square + a * from.t - b * to.t) / (a - b);
                let least = from.square + a * (crossing - from.t);
                if least > doubt {
                    return Ok(());
                }
                if depth == DEEPEST {
                    return Err(Close);
                }
                // NaN is in the middle.
                let t = if crossing > from.t && crossing < to.t {
                    crossing
                } else {
                    0.5 * (from.t + to.t)
                };
                let placed = Placed::new(&self.motion.at(t), self.rim.height);
                let middle = self.value(&placed, t, line.1);
                self.between(line, [from, middle], collector, depth + 1)?;
                self.between(line, [middle, to], collector, depth + 1)
            }
        }
    }

    /// The only place where a line passes the circle: into it if `inwards` is 1, out of it if it is −1.
    fn pass(
        &self,
        (number, line): (usize, [f64; 2]),
        ends: [Value; 2],
        inwards: f64,
        collector: &mut Collector,
    ) -> Result<(), Undecided> {
        let Accuracy {
            slack,
            height_tolerance,
        } = self.accuracy;
        let bracket = ends.map(|end| end.t);
        let first = start(ends, inwards);
        let found = zero(
            bracket,
            ([true; 2], first),
            |t| {
                let placed = Placed::new(&self.motion.at(t), self.rim.height);
                let arm = placed.arm(line);
                let rise = placed.along(&arm) / placed.axis.z;
                Some(Sample {
                    value: inwards * (arm.norm_squared() - self.rim.radius * self.rim.radius),
                    slope: 2.0 * inwards * (arm.z * rise - arm.dot(&placed.travel)),
                    rise,
                    state: (placed, arm),
                })
            },
            |t, step, sample| {
                let (placed, arm) = &sample.state;
                let along = placed.along(arm);
                let out = arm.dot(&placed.travel) / self.rim.radius;
                let speed = self.speed;
                // What a step of Newton's method leaves is of second order, and what the next derivative leaves of third.
                let inverse = placed.axis.z.recip();
                let fast = speed * inverse;
                let pace = 2.0 * fast * fast / sample.slope.abs() + self.turning * inverse.abs();
                let turned = pace * step.abs();
                if !(turned < 0.125) {
                    return None;
                }
                let error = 16.0 * (slack / STEEP + step.abs() * speed) * (self.rate + speed / self.rim.radius)
                    + 16.0 * (f64::EPSILON * speed + self.noise * slack / STEEP);
                let [[n, m], [p, q]] = self.rim.normals;
                let faces = [n * out + m * along, p * out + q * along];
                // NaN is not certain.
                if !(faces[0].abs() > error && faces[1].abs() > error) {
                    return None;
                }
                let alike = (faces[0] < 0.0) == (faces[1] < 0.0);
                if alike {
                    return Some(None);
                }
                let rest = turned * turned * (sample.rise.abs() + fast.abs()) * step.abs();
                if !(turned <= TURNED && 2.0 * rest <= height_tolerance) {
                    return None;
                }
                let lift = (placed.lift(arm) - 2.0 * placed.rate.z * sample.rise) * inverse;
                let slides = Vector3::new(0.0, 0.0, sample.rise) - placed.travel;
                let back = arm.dot(&placed.acceleration);
                let bend = slides.norm_squared() + arm.z * lift - back;
                let less = step * step * bend * inwards / sample.slope;
                let (t, step) = (t - less, step - less);
                // To first order, on both faces.
                let out = out + step * (slides.dot(&placed.travel) + back) / self.rim.radius;
                let along = along + step * (lift * placed.axis.z + placed.rate.z * sample.rise);
                let (later, axis) = (arm + slides * step, placed.axis + placed.rate * step);
                let later_faces = [n * out + m * along, p * out + q * along];
                let [radial, axial] = fan_normal(&self.rim.normals, later_faces);
                let normal = later * (radial / self.rim.radius) + axis * axial;
                // The turn of the circle about the tool, from below to above along the meridian, is that of its disc.
                let jump = if ((placed.axis.z > 0.0) == (inwards < 0.0)) == (faces[0] < 0.0) {
                    -1
                } else {
                    1
                };
                let turn = Turn {
                    t,
                    height: placed.centre.z + arm.z + step * (sample.rise + 0.5 * lift * step),
                    normal,
                };
                Some(Some((turn, jump)))
            },
        )?;
        if let Some((Turn { t, height, normal }, jump)) = found {
            collector.crossing(number, height, jump, unit(normal), (self.source)(t));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
