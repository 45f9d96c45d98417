//! A cylinder that hardly leans, for a moment: its wall is so steep that a line either meets none of it, or is beside it all along.
//!
//! The wall between two heights is seen as a ring that is as thin as the axis leans. Only a line that the ring passes meets it, and `G = ⟨N, b′ + ζ a′⟩`, where `N` is
//! horizontal but for the lean, has no zero over most of these. The few lines that remain are left to charts.

use super::Cylinder;
use crate::methods::turning::blocks::{around, blocks, distance};
use crate::methods::sheets::intervals::{Range, Sign, add, between, joined, mul, sub, wider};
use crate::methods::turning::spans::{Span, Verdict};
use crate::methods::turning::{Leftover, Searching};

/// So many lines may be left to charts.
const FEW: usize = 12;

/// The wall over a span, seen along the dexels.
struct Ring {
    /// Where the tip is at the ends of the span.
    tips: [[f64; 2]; 2],
    /// Points of the wall are so far from the tip.
    radii: [f64; 2],
    /// How far the axis of the wall is from the tip.
    aside: f64,
    /// `b′ + ζ a′`, horizontally, and a bound of what it adds to `G` along the dexels.
    travel: [Range; 2],
    rest: f64,
    /// The rounding error of coordinates, and that of `G`.
    slack: f64,
    doubt: f64,
}

impl Ring {
    /// `None` if the axis leans too much.
    fn new(cylinder: &Cylinder, Span { from, to, bounds, .. }: &Span, slack: f64) -> Option<Self> {
        let Cylinder { radius, ends } = *cylinder;
        let lean = bounds.lean[1];
        let far = ends[0].abs().max(ends[1].abs());
        let aside = far * lean * (1.0 + 1e-9);
        let speed = bounds.speed + far * bounds.rate;
        let travel = |k: usize| {
            let rate = between(from.rate[k], to.rate[k], bounds.bend * bounds.length);
            add([from.velocity[k]; 2], mul(ends, rate))
        };
        (lean < 0.1).then(|| Self {
            tips: [from, to].map(|moment| [moment.tip.x, moment.tip.y]),
            // `N` is across the axis.
            radii: [radius * (1.0 - lean * lean) - aside, radius + aside],
            aside,
            travel: [0, 1].map(travel),
            rest: 1.01 * radius * lean * speed,
            slack,
            doubt: 32.0 * (slack + f64::EPSILON * radius) * speed,
        })
    }

    /// Whether no line of a block crosses what the wall sweeps.
    fn misses(&self, block: [Range; 2]) -> bool {
        let [inner, outer] = self.radii;
        if distance(block, self.tips) > outer + self.slack {
            return true;
        }
        // The farthest corner of a convex block from a straight way.
        let [x, y] = block;
        let inside = |tip: &[f64; 2]| {
            let far = |k: usize, [low, high]: Range| (low - tip[k]).abs().max((high - tip[k]).abs());
            far(0, x).hypot(far(1, y)) < inner - self.slack
        };
        if self.tips.iter().all(inside) {
            return true;
        }
        let normal = |k: usize| {
            let tips = joined([self.tips[0][k]; 2], [self.tips[1][k]; 2], self.aside);
            sub(block[k], tips)
        };
        let level = add(mul(normal(0), self.travel[0]), mul(normal(1), self.travel[1]));
        let g = wider(level, self.rest);
        Sign::of(g, self.doubt) != Sign::Unknown
    }
}

/// Settles a span in which the axis leans hardly, unless too many lines are left.
pub(in crate::methods::turning) fn standing(
    cylinder: &Cylinder,
    span: &Span,
    searching: &Searching,
    left: &mut Leftover,
) -> Verdict {
    let Some(ring) = Ring::new(cylinder, span, searching.slack) else {
        return Verdict::Intricate;
    };
    let lines = searching.collector.lines;
    let area = around(&ring.tips, ring.radii[1] + ring.slack);
    let wanted = |block: [Range; 2]| (!ring.misses(block)).then_some(());
    let mut found = Vec::new();
    blocks(lines, area, wanted, |(i, j), line, ()| {
        if found.len() <= FEW && !ring.misses(line.map(|at| [at; 2])) && lines.asks(i, j) {
            found.push(lines.line(i, j) as u32);
        }
    });
    if found.len() > FEW {
        return Verdict::Intricate;
    }
    left.lines = found;
    Verdict::Settled
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::turning::axis_motion::AxisMotion;
    use sweepsim_motion::{Pose, Segment};
    use sweepsim_props::*;

    proptest! {
        /// No line through a point where the wall slides along itself is missed.
        #[test]
        fn lines_that_cross_are_kept(tips in [[-4.0..4.0_f64, -4.0..4.0, -4.0..4.0], [-4.0..4.0, -4.0..4.0, -4.0..4.0]], axes in [[-1.0..1.0_f64, -1.0..1.0], [-1.0..1.0, -1.0..1.0]],
            scales in [-4.0..-1.0_f64, -3.0..0.0], down in any::<bool>(), points in collection::vec([0.0..1.0_f64, 0.0..1.0], 1..40)) {
            let [lean, share] = scales.map(|exponent| 10f64.powf(exponent));
            let axis = |n: usize| [lean * axes[n][0], lean * axes[n][1], if down { -1.0 } else { 1.0 }];
            let tip = |n: usize| [0, 1, 2].map(|k| tips[0][k] + share * n as f64 * (tips[1][k] - tips[0][k]));
            let [from, to] = [0, 1].map(|n| Pose::new(tip(n), axis(n)).unwrap());
            let Some(motion) = AxisMotion::new(&Segment::between(&from, &to)[0]) else { return Ok(()) };
            let [from, to] = [0.0, 1.0].map(|t| motion.at(t));
            let span = Span { bounds: motion.bounds([&from, &to]), from, to, last: true };
            let cylinder = Cylinder { radius: 1.5, ends: [1.0, 9.0] };
            let Some(ring) = Ring::new(&cylinder, &span, 1e-14) else { return Ok(()) };
            for [t, share] in points {
                let (moment, zeta) = (motion.at(t), 1.0 + 8.0 * share);
                let across = moment.axis.cross(&(moment.velocity + moment.rate * zeta));
                prop_assume!(across.norm() > 1e-6);
                for side in [-1.0, 1.0] {
                    let point = moment.tip + moment.axis * zeta + across.normalize() * (side * cylinder.radius);
                    prop_assert!(!ring.misses([[point.x; 2], [point.y; 2]]), "{t} {zeta} {side}");
                }
            }
        }

        /// Most lines are missed where the tool leans by a thousandth.
        #[test]
        fn few_lines_are_kept(angle in 0.0..6.3_f64, along in 0.0..6.3_f64) {
            let pose = |n: f64| Pose::new([0.02 * n * along.cos(), 0.02 * n * along.sin(), 0.0], [1e-3 * n * angle.cos(), 1e-3 * n * angle.sin(), 1.0]).unwrap();
            let Some(motion) = AxisMotion::new(&Segment::between(&pose(-1.0), &pose(1.0))[0]) else { return Ok(()) };
            let [from, to] = [0.0, 1.0].map(|t| motion.at(t));
            let span = Span { bounds: motion.bounds([&from, &to]), from, to, last: true };
            let ring = Ring::new(&Cylinder { radius: 1.5, ends: [1.0, 9.0] }, &span, 1e-14).expect("a tool that hardly leans");
            let kept = (0..100 * 100).filter(|n| {
                let [x, y] = [n / 100, n % 100].map(|k| -2.0 + 0.04 * f64::from(k));
                !ring.misses([[x; 2], [y; 2]])
            });
            prop_assert!(kept.count() <= 120);
        }
    }
}
