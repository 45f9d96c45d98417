//! The union over time of the chords of one line: dense sampling with local refinement.

use super::chord::chords;
use super::minimum::minimise;
use super::motion::{Arc, Motion};
use super::outline::Outline;
use nalgebra::Vector3;

/// How often the time between two samples with different numbers of chords is halved: ends at which a chord vanishes
/// are as exact as that time.
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
    /// The number of samples of each arc, however long it is.
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
        // A chord counts if it overlaps what is known of the span, which reaches down to `reach`, or all but touches
        // it.
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
            // Between this sample and its neighbours the end gains less than it differs over two samples: a parabola
            // that is level at both ends of a step dips by an eighth of its second difference, which shows two samples
            // away.
            let further = value(k.checked_sub(2)).max(value(Some(k + 2)));
            let gain = left.max(right).max(further) - values[k];
            // The end of one arc and the start of the next are the same pose up to rounding.
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
mod tests;
