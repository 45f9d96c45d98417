//! The union over time of the chords of one line: dense sampling with local refinement.

use super::chord::chords;
use super::minimum::minimise;
use super::motion::{Arc, Motion};
use super::outline::Outline;
use nalgebra::Vector3;

/// How often the time between two samples with different numbers of chords is halved: ends at which a chord vanishes are as exact as that time.
const HALVINGS: u32 = 40;
/// How often it is halved where a chord is so short that it does not overlap with itself one sample later.
const HALVINGS_TORN: u32 = 5;
/// Chords this near to a span belong to it: gaps thinner than a tenth of any tolerance tested are none.
const TOUCHING: f64 = 1e-7;

/// An interval of the swept set on a line, with estimates of the errors of its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Its lower end.
    pub low: f64,
    /// Its upper end.
    pub high: f64,
    /// How far off the ends may be.
    pub error: [f64; 2],
}

/// What a sweep cuts out of a vertical line.
#[derive(Clone, Debug, PartialEq)]
pub struct SweptLine {
    /// The intervals, ascending.
    pub spans: Vec<Span>,
    /// A gap or an interval is thinner than the tool moves between two samples, so it may be there or not.
    pub ambiguous: bool,
}

struct Sample {
    arc: usize,
    t: f64,
    chords: Vec<[f64; 2]>,
}

struct Sampler<'a> {
    outline: &'a Outline,
    motion: &'a Motion,
    x: f64,
    y: f64,
    samples: Vec<Sample>,
    /// What chords pass through between two samples in which they do not overlap.
    bridges: Vec<[f64; 2]>,
}

/// How densely time is sampled to begin with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// The least number of samples of an arc.
    pub least: usize,
    /// How far the tool may move past the line, at the height of its tip, between two samples.
    pub step: f64,
}

impl Sampling {
    /// So many samples of each arc, however long.
    #[must_use]
    pub fn number(least: usize) -> Self {
        let step = f64::INFINITY;
        Self { least, step }
    }

    /// How many samples an arc takes.
    fn count(&self, arc: &Arc, x: f64, y: f64) -> usize {
        if arc.rests() {
            return 1;
        }
        let beside = |t: f64| arc.speed_bound(&Vector3::new(x, y, arc.at(t).tip.z));
        let steps = beside(0.0).max(beside(1.0)) / self.step;
        self.least.max(steps.ceil() as usize)
    }
}

/// What the tool sweeps of the vertical line through `(x, y)`.
#[must_use]
pub fn swept_line(outline: &Outline, motion: &Motion, x: f64, y: f64, sampling: Sampling) -> SweptLine {
    let mut sampler = Sampler {
        outline,
        motion,
        x,
        y,
        samples: Vec::new(),
        bridges: Vec::new(),
    };
    sampler.sample(sampling);
    let mut spans = sampler.union();
    // Refined ends may close a gap, and then there are other ends.
    loop {
        for span in &mut spans {
            sampler.refine(span);
        }
        let merged = merge(&spans);
        let done = merged.len() == spans.len();
        spans = merged;
        if done {
            break;
        }
    }
    let ambiguous = sampler.unresolved(&spans, sampling);
    SweptLine { spans, ambiguous }
}

impl Sampler<'_> {
    fn chords(&self, arc: usize, t: f64) -> Vec<[f64; 2]> {
        chords(self.outline, &self.motion.arcs()[arc].at(t), self.x, self.y)
    }

    fn sample(&mut self, sampling: Sampling) {
        for (arc, moving) in self.motion.arcs().iter().enumerate() {
            let count = sampling.count(moving, self.x, self.y);
            self.push(arc, 0.0);
            for i in 0..count {
                let before = self.samples.len() - 1;
                self.advance(arc, (i + 1) as f64 / count as f64, before, HALVINGS);
            }
        }
    }

    fn push(&mut self, arc: usize, t: f64) {
        let chords = self.chords(arc, t);
        self.samples.push(Sample { arc, t, chords });
    }

    /// Samples at `t` and, where the chords since sample `before` (the last one) do not clearly continue, between.
    fn advance(&mut self, arc: usize, t: f64, before: usize, halvings: u32) {
        let chords = self.chords(arc, t);
        let old = &self.samples[before].chords;
        let same_number = old.len() == chords.len();
        let apart = |(a, b): (&[f64; 2], &[f64; 2])| a[1] < b[0] || b[1] < a[0];
        let torn = same_number && old.iter().zip(&chords).any(apart);
        if halvings > 0 && !same_number || halvings > HALVINGS - HALVINGS_TORN && torn {
            let middle = 0.5 * (self.samples[before].t + t);
            self.advance(arc, middle, before, halvings - 1);
            let before = self.samples.len() - 1;
            self.advance(arc, t, before, halvings - 1);
            return;
        }
        if torn {
            // A short chord on the move: by continuity it passes through what lies between.
            for (a, b) in old.iter().zip(&chords) {
                self.bridges.push([a[0].min(b[0]), a[1].max(b[1])]);
            }
        }
        self.samples.push(Sample { arc, t, chords });
    }

    fn union(&self) -> Vec<Span> {
        let mut all: Vec<Span> = self
            .samples
            .iter()
            .flat_map(|sample| &sample.chords)
            .chain(&self.bridges)
            .map(|&[low, high]| Span {
                low,
                high,
                error: [0.0; 2],
            })
            .collect();
        all.sort_by(|a, b| a.low.total_cmp(&b.low));
        merge(&all)
    }

    /// Moves both ends of a span outwards, to the extremes over time near the samples that may hold them.
    fn refine(&self, span: &mut Span) {
        let (low, low_error) = self.extreme(span, 1.0);
        let (high, high_error) = self.extreme(span, -1.0);
        *span = Span {
            low,
            high: -high,
            error: [low_error, high_error],
        };
    }

    /// The least `sign · z` of the chords that overlap the span, and an estimate of its error.
    fn extreme(&self, span: &Span, sign: f64) -> (f64, f64) {
        let [bottom, top] = if sign > 0.0 {
            [span.low, span.high]
        } else {
            [-span.high, -span.low]
        };
        // A chord counts if it overlaps what is known of the span, which reaches down to `reach`, or all but touches it.
        let end = |chords: &[[f64; 2]], reach: f64| -> f64 {
            let turned = chords.iter().map(|c| if sign > 0.0 { *c } else { [-c[1], -c[0]] });
            let overlapping = turned.filter(|c| c[1] >= reach - TOUCHING && c[0] <= top);
            overlapping.map(|c| c[0]).fold(f64::INFINITY, f64::min)
        };
        let values: Vec<f64> = self.samples.iter().map(|sample| end(&sample.chords, bottom)).collect();
        let least = (0..values.len()).min_by(|&a, &b| values[a].total_cmp(&values[b]));
        let least = least.expect("a motion has samples");
        let (mut best, mut error) = (values[least].min(bottom), f64::INFINITY);
        for k in 0..values.len() {
            let value = |i: Option<usize>| i.and_then(|i| values.get(i)).copied().unwrap_or(f64::INFINITY);
            let (left, right) = (value(k.checked_sub(1)), value(Some(k + 1)));
            // Between this sample and its neighbours the end gains less than it differs over two samples: a parabola that is level at
            // both ends of a step dips by an eighth of its second difference, which shows two samples away.
            let further = value(k.checked_sub(2)).max(value(Some(k + 2)));
            let gain = left.max(right).max(further) - values[k];
            // The end of one arc and the start of the next are the same pose, but for rounding.
            let lowest = values[k] <= left + 1e-12 && values[k] <= right + 1e-12;
            let hopeful = lowest && values[k] - gain < best - 1e-10;
            if k != least && !hopeful {
                continue;
            }
            let arc = self.samples[k].arc;
            let beside = |other: Option<&Sample>| match other {
                Some(sample) if sample.arc == arc => sample.t,
                _ => self.samples[k].t,
            };
            let from = beside(k.checked_sub(1).and_then(|i| self.samples.get(i)));
            let to = beside(self.samples.get(k + 1));
            // A short chord on the move may leave the span as it was sampled: what is found extends it.
            let mut reach = best;
            let extending = |t: f64| {
                let value = end(&self.chords(arc, t), reach);
                reach = reach.min(value);
                value
            };
            let found = minimise(extending, from, to, 1e-11);
            if found.value <= best {
                (best, error) = (found.value, found.rise);
            }
        }
        (best, error + 1e-10)
    }

    fn unresolved(&self, spans: &[Span], sampling: Sampling) -> bool {
        let step_at = |z: f64| {
            let p = Vector3::new(self.x, self.y, z);
            let step = |arc: &Arc| arc.speed_bound(&p) / sampling.count(arc, self.x, self.y) as f64;
            self.motion.arcs().iter().map(step).fold(0.0, f64::max)
        };
        let thin = spans.iter().any(|span| span.high - span.low < step_at(span.low));
        thin || spans
            .windows(2)
            .any(|pair| pair[1].low - pair[0].high < step_at(pair[1].low))
    }
}

/// The union of spans sorted by their lower ends.
fn merge(spans: &[Span]) -> Vec<Span> {
    let mut merged: Vec<Span> = Vec::new();
    for span in spans {
        match merged.last_mut() {
            Some(last) if span.low <= last.high => {
                if span.high > last.high {
                    (last.high, last.error[1]) = (span.high, span.error[1]);
                }
            }
            _ => merged.push(*span),
        }
    }
    merged
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tools;
    use sweepsim_motion::{Pose, Tool};

    fn line(tool: &Tool, poses: &[([f64; 3], [f64; 3])], x: f64, y: f64) -> SweptLine {
        let poses: Vec<Pose> = poses.iter().map(|p| Pose::new(p.0, p.1).unwrap()).collect();
        swept_line(
            &Outline::new(tool.profile().expect("a solid of revolution")),
            &Motion::new(&poses),
            x,
            y,
            Sampling::number(200),
        )
    }

    fn assert_spans(found: &SweptLine, expected: &[[f64; 2]]) {
        assert_eq!(found.spans.len(), expected.len(), "{found:?} for {expected:?}");
        for (span, ends) in found.spans.iter().zip(expected) {
            for (z, e, error) in [(span.low, ends[0], span.error[0]), (span.high, ends[1], span.error[1])] {
                assert!(error <= 1e-9, "{found:?}");
                assert!((z - e).abs() <= error, "{found:?} for {expected:?}");
            }
        }
    }

    const UP: [f64; 3] = [0.0, 0.0, 1.0];

    #[test]
    fn a_ball_along_a_slope_is_a_capsule_below() {
        let (radius, from, to) = (3.0_f64, [0.0, 0.0, 0.0], [20.0, 4.0, 10.0]);
        let tool = Tool::ball(radius, 50.0).unwrap();
        // The lowest z with distance `radius` from the centres' line c(λ) = from + λ d + (0, 0, radius).
        let d = Vector3::from(to) - Vector3::from(from);
        for (x, y) in [(5.0, 1.0), (10.3, 3.0), (14.0, 1.2), (9.0, 0.0)] {
            // With e = (x, y, z − radius) and |e|² − (e·d)²/|d|² = r²: a quadratic in ζ = z − radius.
            let (flat, dd): (f64, f64) = (x * d.x + y * d.y, d.norm_squared());
            let a = 1.0 - d.z * d.z / dd;
            let b = -2.0 * flat * d.z / dd;
            let c = x * x + y * y - flat * flat / dd - radius * radius;
            let lower = (-b - (b * b - 4.0 * a * c).sqrt()) / (2.0 * a);
            let foot = (flat + lower * d.z) / dd;
            assert!((0.1..0.9).contains(&foot), "the case must lie between the ends");
            // Above: the top of the shank at the last instant that covers the line.
            let along = d.xy().normalize();
            let side = along.perp(&nalgebra::Vector2::new(x, y));
            let last =
                (along.dot(&nalgebra::Vector2::new(x, y)) + (radius * radius - side * side).sqrt()) / d.xy().norm();
            let found = line(&tool, &[(from, UP), (to, UP)], x, y);
            assert_spans(&found, &[[lower + radius, 50.0 + 10.0 * last]]);
        }
    }

    #[test]
    fn a_vertical_cylinder_moved_sideways_is_a_slab() {
        let tool = Tool::flat(2.0, 30.0).unwrap();
        let poses = [([-5.0, 0.0, 1.0], UP), ([5.0, 0.0, 1.0], UP)];
        assert_spans(&line(&tool, &poses, 0.7, 1.999), &[[1.0, 31.0]]);
        assert_spans(&line(&tool, &poses, 6.9, 0.1), &[[1.0, 31.0]]);
        assert_spans(&line(&tool, &poses, 0.7, 2.001), &[]);
        assert_spans(&line(&tool, &poses, 7.1, 0.0), &[]);
    }

    #[test]
    fn a_plunge_is_one_long_cylinder() {
        let tool = Tool::flat(2.0, 3.0).unwrap();
        assert_spans(
            &line(&tool, &[([0.0; 3], UP), ([0.0, 0.0, -17.0], UP)], 1.0, 1.0),
            &[[-17.0, 3.0]],
        );
    }

    #[test]
    fn a_zero_move_is_the_tool() {
        let tool = Tool::ball(2.0, 9.0).unwrap();
        let low = 2.0 - 3.0_f64.sqrt();
        assert_spans(&line(&tool, &[([0.0; 3], UP), ([0.0; 3], UP)], 1.0, 0.0), &[[low, 9.0]]);
        assert_spans(&line(&tool, &[([0.0; 3], UP)], 1.0, 0.0), &[[low, 9.0]]);
    }

    #[test]
    fn a_tilted_cylinder_along_itself() {
        // Moved along its own axis by 20 it is a cylinder of length 60.
        let (s, c) = (0.6, 0.8);
        let tool = Tool::flat(2.0, 40.0).unwrap();
        let axis = [s, 0.0, c];
        let found = line(&tool, &[([0.0; 3], axis), ([20.0 * s, 0.0, 20.0 * c], axis)], 15.0, 1.0);
        let half = 3.0_f64.sqrt();
        assert_spans(&found, &[[(15.0 * c - half) / s, (15.0 * c + half) / s]]);
    }

    #[test]
    fn a_long_cylinder_turned_in_place_is_a_sector() {
        // In the plane y = 0 it turns about the tip from −60° to +60°: a fan of radius √(L² + R²) above,
        // the flank's lines below.
        let (radius, length) = (1.0_f64, 30.0_f64);
        let tool = Tool::flat(radius, length).unwrap();
        let (s, c) = 60.0_f64.to_radians().sin_cos();
        let poses = [([0.0; 3], [-s, 0.0, c]), ([0.0; 3], [s, 0.0, c])];
        let (x, y) = (10.0, 0.25);
        // The flank of the last placement from below, where x c − z s = half its chord at y; the rim's sphere on top.
        let half = (radius * radius - y * y).sqrt();
        let top = (length * length + half * half - x * x).sqrt();
        assert_spans(&line(&tool, &poses, x, y), &[[(x * c - half) / s, top]]);
    }

    #[test]
    fn two_visits_leave_a_gap_and_a_third_closes_it() {
        let tool = Tool::ball(1.0, 3.0).unwrap();
        let at = |z: f64| [([-9.0, 0.0, z], UP), ([9.0, 0.0, z], UP)];
        let mut poses = at(0.0).to_vec();
        poses.extend(at(10.0).iter().rev());
        let side = Tool::ball(1.0, 3.0).unwrap();
        assert_spans(&line(&side, &poses, 0.0, 0.0), &[[0.0, 3.0], [10.0, 13.0]]);
        poses.extend(at(5.0));
        poses.extend([([0.0, 0.0, 5.0], UP), ([0.0, 0.0, 9.0], UP)]);
        let found = line(&tool, &poses, 0.0, 0.0);
        assert_spans(&found, &[[0.0, 3.0], [5.0, 13.0]]);
        assert!(!found.ambiguous);
    }

    #[test]
    fn the_ends_do_not_depend_on_the_density() {
        let poses: Vec<Pose> = [
            ([0.0, 0.0, 0.0], [0.1, 0.2, 1.0]),
            ([14.0, 5.0, -3.0], [0.7, -0.4, 0.6]),
        ]
        .map(|(tip, axis)| Pose::new(tip, axis).unwrap())
        .to_vec();
        let motion = Motion::new(&poses);
        let mut clear = 0;
        for tool in tools::zoo() {
            let outline = Outline::new(tool.profile().expect("a solid of revolution"));
            for k in 0..49 {
                let (x, y) = (-8.0 + 5.17 * f64::from(k % 7), -11.0 + 4.03 * f64::from(k / 7));
                let coarse = swept_line(&outline, &motion, x, y, Sampling::number(97));
                let fine = swept_line(&outline, &motion, x, y, Sampling::number(1000));
                if coarse.ambiguous || fine.ambiguous {
                    continue;
                }
                clear += usize::from(!fine.spans.is_empty());
                assert_eq!(coarse.spans.len(), fine.spans.len(), "({x}, {y})");
                for (a, b) in coarse.spans.iter().zip(&fine.spans) {
                    assert!((a.low - b.low).abs() <= a.error[0] + b.error[0], "{coarse:?} {fine:?}");
                    assert!(
                        (a.high - b.high).abs() <= a.error[1] + b.error[1],
                        "{coarse:?} {fine:?}"
                    );
                }
            }
        }
        assert!(clear > 60, "{clear} lines compared");
    }
}
