//! Where solids are during a time, and how far they reach then.
//!
//! Spin about the axis moves no point into a solid of revolution or out of it, so the tool may be taken to turn with
//! `ω = a × a′`, and a point at a distance of at most `r` from the tip `b` has `|p″| ≤ |b″| + (|a″| + |a′|²) r`: the
//! turning of the axis is `|ω|² = |a′|²` and `|ω′| ≤ |a″|`. A function `f` with `|f″| ≤ m` is nowhere more than
//! `m h²/8` above its chord over a time `h`. So what `⟨n, p⟩` is at the ends of a time, and this, bounds it in between.

use crate::scene::{Course, Motion};
use crate::tool::Body;
use crate::vector::{EPS, MORE, V3, add, cross, dot, dot_up, is_finite, norm, norm_up, scaled, size, sub, unit};

/// The tip and the unit axis, and how far both may be from the truth.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Placement {
    pub tip: V3,
    pub axis: V3,
    pub tip_error: f64,
    pub axis_error: f64,
}

/// A rational curve `P/w` in Bernstein form, with bounds of its first two derivatives.
#[derive(Clone, Debug)]
struct Curve {
    controls: Vec<(V3, f64)>,
    /// The first derivative is at most this long, and the second.
    speed: f64,
    bend: f64,
    /// Values are off by no more.
    error: f64,
}

/// More coefficients than this do not occur.
const MOST: usize = 32;

impl Curve {
    /// With `q = P/w − c`, `q′ = (P′ − q w′)/w` and `q″ = (P″ − 2 q′ w′ − q w″)/w`: each numerator is a Bernstein form,
    /// and so in the hull of its coefficients. `c` is the middle control point.
    fn new(controls: &[(V3, f64)]) -> Option<Self> {
        let are_good = controls.iter().all(|(p, w)| is_finite(p) && *w > 1e-3 && *w < 1e3);
        if controls.is_empty() || controls.len() > MOST || !are_good {
            return None;
        }
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max) * MORE;
        let least = controls.iter().map(|(_, w)| *w).fold(f64::INFINITY, f64::min);
        let most = largest(&mut controls.iter().map(|(_, w)| *w));
        let n = (controls.len() - 1) as f64;
        // de Casteljau takes convex combinations, each off by 2 EPS in parts of the largest coefficient; then the
        // numerator is divided by the weight.
        let farthest = largest(&mut controls.iter().map(|(p, _)| size(p)));
        let error = 8.0 * EPS * (n + 1.0) * (farthest / least) * (1.0 + most / least);
        let (middle, weight) = controls[(controls.len() - 1) / 2];
        let own: Vec<(V3, f64)> = controls
            .iter()
            .map(|(p, w)| (sub(p, &scaled(&middle, w / weight)), *w))
            .collect();
        let radius = largest(&mut own.iter().map(|(p, w)| norm(p) / w));
        let steps: Vec<(V3, f64)> = own
            .windows(2)
            .map(|p| (sub(&p[1].0, &p[0].0), p[1].1 - p[0].1))
            .collect();
        let bends: Vec<(V3, f64)> = steps
            .windows(2)
            .map(|p| (sub(&p[1].0, &p[0].0), p[1].1 - p[0].1))
            .collect();
        let of = |all: &[(V3, f64)], times: f64| {
            let longest = times * largest(&mut all.iter().map(|(p, _)| norm(p)));
            (longest, times * largest(&mut all.iter().map(|(_, w)| w.abs())))
        };
        let ((first, first_weight), (second, second_weight)) = (of(&steps, n), of(&bends, n * (n - 1.0)));
        let speed = (first + radius * first_weight) / least * MORE;
        let bend = (second + 2.0 * speed * first_weight + radius * second_weight) / least * MORE;
        let is_line = controls.len() == 1 || controls.len() == 2 && controls[0].1 == controls[1].1;
        Some(Self {
            controls: controls.to_vec(),
            speed: speed + error,
            bend: if is_line { 0.0 } else { bend + error },
            error,
        })
    }

    fn at(&self, t: f64) -> V3 {
        let mut row = [([0.0; 3], 0.0); MOST];
        let count = self.controls.len();
        row[..count].copy_from_slice(&self.controls);
        for left in (1..count).rev() {
            for k in 0..left {
                let [(p, v), (q, w)] = [row[k], row[k + 1]];
                row[k] = (add(&scaled(&p, 1.0 - t), &scaled(&q, t)), v * (1.0 - t) + w * t);
            }
        }
        scaled(&row[0].0, 1.0 / row[0].1)
    }
}

/// A motion with what is known of it for all times.
#[derive(Clone, Debug)]
pub(crate) struct Stretch {
    tip: Curve,
    /// One point if the axis keeps still.
    axis: Curve,
    /// How far the axis may be from what is given.
    axis_error: f64,
    pub ends: [Placement; 2],
    /// The move.
    pub number: usize,
}

/// An axis that turns by no more keeps still.
const STILL: f64 = 1e-13;
/// Axes need not be closer to length 1.
const UNIT: f64 = 1e-12;

impl Stretch {
    /// `None` if it is no motion.
    pub fn new(motion: &Motion) -> Option<Self> {
        let linear;
        let [tip, axis] = match &motion.course {
            Course::Rational(both) => both,
            Course::Linear(poses) => {
                linear = turned(poses)?;
                &linear
            }
        };
        let (tip, mut axis, off) = (Curve::new(tip)?, Curve::new(axis)?, off_unit(axis));
        let mut axis_error = 2.0 * UNIT + axis.error;
        if axis.speed <= 2.0 * STILL {
            axis_error += axis.speed;
            axis = Curve::new(&[(unit(&axis.at(0.0))?, 1.0)])?;
            (axis.speed, axis.bend) = (0.0, 0.0);
        } else {
            // The unit axis is that of a form which is one but for coefficients of this size.
            let more = 1e3 * UNIT;
            (axis.speed, axis.bend) = (axis.speed + more, axis.bend + more);
        }
        let (ends, number) = ([Placement::default(); 2], motion.number);
        let mut own = Self {
            tip,
            axis,
            axis_error,
            ends,
            number,
        };
        own.ends = [own.at(0.0), own.at(1.0)];
        (off <= UNIT).then_some(own)
    }

    pub fn keeps_axis(&self) -> bool {
        self.axis.controls.len() == 1
    }

    /// The axis turns by no more, in radians.
    pub fn turning(&self) -> f64 {
        self.axis.speed
    }

    /// Whether each point goes along a line.
    pub fn is_straight(&self) -> bool {
        self.keeps_axis() && self.tip.bend == 0.0
    }

    pub fn at(&self, t: f64) -> Placement {
        Placement {
            tip: self.tip.at(t),
            axis: if self.keeps_axis() {
                self.axis.controls[0].0
            } else {
                self.axis.at(t)
            },
            tip_error: self.tip.error,
            axis_error: self.axis_error,
        }
    }

    /// The tip moves no farther in a time.
    pub fn travel(&self, duration: f64) -> f64 {
        self.tip.speed * duration * MORE
    }

    /// How far a point within `reach` of the tip may go beyond the line between where it is at the ends of a time.
    pub fn bend(&self, reach: f64, duration: f64) -> f64 {
        let turning = self.axis.bend + self.axis.speed * self.axis.speed;
        (self.tip.bend + turning * reach) * duration * duration / 8.0 * MORE
    }
}

/// A bound of the coefficients of `|A|² − w²`.
fn off_unit(controls: &[(V3, f64)]) -> f64 {
    let n = controls.len() - 1;
    let choose = |n: usize, k: usize| (0..k).fold(1.0, |c, i| c * (n - i) as f64 / (i + 1) as f64);
    let coefficient = |k: usize| {
        let pairs = (k.saturating_sub(n)..=k.min(n)).map(|i| {
            let [(p, v), (q, w)] = [controls[i], controls[k - i]];
            choose(n, i) * choose(n, k - i) / choose(2 * n, k) * (dot(&p, &q) - v * w)
        });
        pairs.sum::<f64>().abs()
    };
    let least = controls.iter().map(|(_, w)| *w).fold(f64::INFINITY, f64::min);
    (0..=2 * n).map(coefficient).fold(0.0, f64::max) / (least * least)
}

/// The tip and the axis of a linear motion: the rational arc between the axes is `(a (1 − t)² + 2 s t (1 − t) + b
/// t²)/…` with `s = (a + b)/|a + b|` and the middle weight `|a + b|/2`.
fn turned([[from, a], [to, b]]: &[[V3; 2]; 2]) -> Option<[Vec<(V3, f64)>; 2]> {
    let sum = add(a, b);
    let axis = if norm(&cross(a, b)) < STILL && dot(a, b) > 0.0 {
        vec![(*a, 1.0)]
    } else {
        vec![(*a, 1.0), (unit(&sum)?, 0.5 * norm(&sum)), (*b, 1.0)]
    };
    (dot(a, b) > -1e-9).then_some([vec![(*from, 1.0), (*to, 1.0)], axis])
}

/// Some consecutive stretches: what a solid sweeps is in a box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub first: usize,
    pub last: usize,
    low: V3,
    high: V3,
    /// No point goes farther beyond the hull of where it is at the ends of the stretches.
    pub bend: f64,
    /// Whether the axis is the same all along.
    still: bool,
    pub halves: Option<[usize; 2]>,
}

impl Node {
    /// Whether a cube is farther from the box than a distance.
    pub fn misses(&self, centre: &V3, half: f64, distance: f64) -> bool {
        (0..3).any(|k| {
            let room = 8.0 * EPS * (centre[k].abs() + half + self.low[k].abs().max(self.high[k].abs()) + distance);
            self.low[k] - (centre[k] + half) > distance + room || (centre[k] - half) - self.high[k] > distance + room
        })
    }
}

/// A solid along consecutive stretches.
pub(crate) struct Run<'a> {
    pub body: &'a Body,
    pub stretches: &'a [Stretch],
    ends: Vec<Placement>,
    /// The last one is all.
    pub nodes: Vec<Node>,
}

impl<'a> Run<'a> {
    /// At least one stretch.
    pub fn new(body: &'a Body, stretches: &'a [Stretch]) -> Self {
        let ends = stretches.iter().flat_map(|stretch| stretch.ends).collect();
        let mut run = Self {
            body,
            stretches,
            ends,
            nodes: Vec::new(),
        };
        run.build(0, stretches.len());
        run
    }

    fn build(&mut self, first: usize, last: usize) -> usize {
        let stretch = &self.stretches[first];
        let (bend, still) = (stretch.bend(self.body.reach, 1.0), stretch.keeps_axis());
        let mut node = Node {
            first,
            last,
            low: [0.0; 3],
            high: [0.0; 3],
            bend,
            still,
            halves: None,
        };
        if last == first + 1 {
            for k in 0..3 {
                let way = |c: f64| std::array::from_fn(|i| if i == k { c } else { 0.0 });
                node.high[k] = self.reach_up(&stretch.ends, still, &way(1.0)) + bend;
                node.low[k] = -self.reach_up(&stretch.ends, still, &way(-1.0)) - bend;
            }
        } else {
            let middle = usize::midpoint(first, last);
            let halves = [self.build(first, middle), self.build(middle, last)];
            let [a, b] = halves.map(|half| self.nodes[half]);
            node.halves = Some(halves);
            node.bend = a.bend.max(b.bend);
            node.still = a.still && b.still && self.ends[2 * first].axis == self.ends[2 * middle].axis;
            for k in 0..3 {
                (node.low[k], node.high[k]) = (a.low[k].min(b.low[k]), a.high[k].max(b.high[k]));
            }
        }
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    /// How far the solid reaches along a direction during some stretches, but for their bend.
    pub fn reach_of_node(&self, node: &Node, n: &V3) -> f64 {
        self.reach_up(&self.ends[2 * node.first..2 * node.last], node.still, n)
    }

    /// How far it reaches at some placements. `still`: all have the same axis.
    pub fn reach_up(&self, ends: &[Placement], still: bool, n: &V3) -> f64 {
        let length = norm_up(n);
        let own = |end: &Placement| self.body.support_up(n, &end.axis, end.axis_error);
        let same = if still { own(&ends[0]) } else { 0.0 };
        let at = |end: &Placement| {
            let tip = dot_up(n, &end.tip) + end.tip_error * length;
            tip + if still { same } else { own(end) }
        };
        let most = ends.iter().map(at).fold(f64::NEG_INFINITY, f64::max);
        most + 4.0 * EPS * most.abs()
    }
}
