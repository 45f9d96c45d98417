//! Where a solid of revolution is, and how much its way bends.
//!
//! With the tip `b`, the unit axis `a` and a point `p` of the solid at a distance of at most `r` from the tip:
//! the solid is one of revolution, so it may be taken to turn with `ω = a × a′`, and then `|p″| ≤ |b″| + (|a″|
//! + |a′|²) r`. A function with `|f″| ≤ m` is nowhere more than `m h²/8` above its chord over a time `h`. So
//! what `⟨n, p⟩` is at the ends of a time, and this, bounds it in between.

use crate::scene::{Move, Path, Piece};
use crate::solid::Body;
use crate::vector::{EPS, MORE, V3, add, cross, dot, dot_up, is_finite, norm, norm_up, scaled, size, sub, unit};
use std::ops::Range;

/// The tip and the unit axis, and how far both may be from the truth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    pub tip: V3,
    pub axis: V3,
    pub tip_error: f64,
    pub axis_error: f64,
}

/// A rational curve `P/w` in Bernstein form, with bounds of its first two derivatives.
#[derive(Clone, Debug)]
struct Curve {
    points: Vec<V3>,
    weights: Vec<f64>,
    /// The first derivative is at most this long, and the second.
    speed: f64,
    bend: f64,
    /// Values are off by no more.
    error: f64,
}

/// More coefficients than this do not occur.
const MOST: usize = 32;

impl Curve {
    fn new(points: &[V3], weights: &[f64]) -> Option<Self> {
        let are_good = points.iter().all(is_finite) && weights.iter().all(|w| *w > 1e-3 && *w < 1e3);
        if points.is_empty() || points.len() > MOST || points.len() != weights.len() || !are_good {
            return None;
        }
        let least = weights.iter().copied().fold(f64::INFINITY, f64::min);
        let most = weights.iter().copied().fold(0.0, f64::max);
        let largest = points.iter().map(size).fold(0.0, f64::max);
        let degree = points.len() - 1;
        // de Casteljau takes convex combinations, each off by 2 EPS in parts of the largest coefficient; then the
        // numerator is divided by the weight.
        let error = 8.0 * EPS * (degree + 1) as f64 * (largest / least) * (1.0 + most / least);
        let (speed, bend) = rates(points, weights, least);
        Some(Self {
            points: points.to_vec(),
            weights: weights.to_vec(),
            speed: speed + error,
            bend: if degree == 1 && weights[0] == weights[1] {
                0.0
            } else {
                bend + error
            },
            error,
        })
    }

    fn at(&self, t: f64) -> V3 {
        let (mut points, mut weights) = ([[0.0; 3]; MOST], [0.0; MOST]);
        let count = self.points.len();
        points[..count].copy_from_slice(&self.points);
        weights[..count].copy_from_slice(&self.weights);
        for left in (1..count).rev() {
            for k in 0..left {
                points[k] = add(&scaled(&points[k], 1.0 - t), &scaled(&points[k + 1], t));
                weights[k] = weights[k] * (1.0 - t) + weights[k + 1] * t;
            }
        }
        scaled(&points[0], 1.0 / weights[0])
    }
}

/// Bounds of `|q′|` and `|q″|` for `q = P/w − c`, with `q′ = (P′ − q w′)/w` and `q″ = (P″ − 2 q′ w′ − q w″)/w`:
/// each numerator is a Bernstein form, and so in the hull of its coefficients. `c` is the middle control point.
fn rates(points: &[V3], weights: &[f64], least: f64) -> (f64, f64) {
    let degree = points.len() - 1;
    let middle = scaled(&points[degree / 2], 1.0 / weights[degree / 2]);
    let own: Vec<V3> = points
        .iter()
        .zip(weights)
        .map(|(p, w)| sub(p, &scaled(&middle, *w)))
        .collect();
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max) * MORE;
    let n = degree as f64;
    let radius = largest(&mut own.iter().zip(weights).map(|(p, w)| norm(p) / w));
    let first = n * largest(&mut own.windows(2).map(|p| norm(&sub(&p[1], &p[0]))));
    let weight_first = n * largest(&mut weights.windows(2).map(|w| (w[1] - w[0]).abs()));
    let twice = n * (n - 1.0).max(0.0);
    let bent = |p: &[V3]| norm(&add(&sub(&p[2], &scaled(&p[1], 2.0)), &p[0]));
    let second = twice * largest(&mut own.windows(3).map(bent));
    let weight_second = twice * largest(&mut weights.windows(3).map(|w| (w[2] - 2.0 * w[1] + w[0]).abs()));
    let speed = (first + radius * weight_first) / least * MORE;
    let bend = (second + 2.0 * speed * weight_first + radius * weight_second) / least * MORE;
    (speed, bend)
}

/// A piece of a path.
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
    fn new(piece: &Piece, number: usize) -> Option<Self> {
        let tip = Curve::new(&piece.tips, &piece.tip_weights)?;
        let mut axis = Curve::new(&piece.axes, &piece.axis_weights)?;
        if !(unit_error(&piece.axes, &piece.axis_weights) <= UNIT) {
            return None;
        }
        let mut axis_error = 2.0 * UNIT + axis.error;
        if axis.speed <= 2.0 * STILL {
            axis_error += axis.speed;
            axis = Curve::new(&[unit(&axis.at(0.0))?], &[1.0])?;
            (axis.speed, axis.bend) = (0.0, 0.0);
        } else {
            // The unit axis is that of a form which is one but for coefficients of this size.
            let more = 1e3 * UNIT;
            (axis.speed, axis.bend) = (axis.speed + more, axis.bend + more);
        }
        let mut own = Self {
            tip,
            axis,
            axis_error,
            ends: [Placement {
                tip: [0.0; 3],
                axis: [0.0; 3],
                tip_error: 0.0,
                axis_error: 0.0,
            }; 2],
            number,
        };
        own.ends = [own.at(0.0), own.at(1.0)];
        Some(own)
    }

    pub fn keeps_axis(&self) -> bool {
        self.axis.points.len() == 1
    }

    pub fn at(&self, t: f64) -> Placement {
        let axis = if self.keeps_axis() {
            self.axis.points[0]
        } else {
            self.axis.at(t)
        };
        Placement {
            tip: self.tip.at(t),
            axis,
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
fn unit_error(points: &[V3], weights: &[f64]) -> f64 {
    let n = points.len().saturating_sub(1);
    let choose = |n: usize, k: usize| (0..k).fold(1.0, |c, i| c * (n - i) as f64 / (i + 1) as f64);
    let coefficient = |k: usize| {
        let pairs = (k.saturating_sub(n)..=k.min(n)).map(|i| {
            let part = dot(&points[i], &points[k - i]) - weights[i] * weights[k - i];
            choose(n, i) * choose(n, k - i) / choose(2 * n, k) * part
        });
        pairs.sum::<f64>().abs()
    };
    let least = weights.iter().copied().fold(f64::INFINITY, f64::min);
    (0..=2 * n).map(coefficient).fold(0.0, f64::max) / (least * least)
}

/// The piece, or pieces, of a linear move: both poses, and the rational arc between the axes, `(a (1 − t)² + 2
/// s t (1 − t) + b t²)/(…)` with `s = (a + b)/|a + b|` and the middle weight `|a + b|/2`. For axes more than
/// 90° apart, by way of the middle.
fn linear(from: &[V3; 2], to: &[V3; 2], pieces: &mut Vec<Piece>) -> Option<()> {
    let (a, b) = (from[1], to[1]);
    let (tips, tip_weights) = (vec![from[0], to[0]], vec![1.0; 2]);
    let sum = add(&a, &b);
    if norm(&cross(&a, &b)) < STILL && dot(&a, &b) > 0.0 {
        let (axes, axis_weights) = (vec![a], vec![1.0]);
        pieces.push(Piece {
            tips,
            tip_weights,
            axes,
            axis_weights,
        });
        return Some(());
    }
    let middle = unit(&sum).filter(|_| norm(&sum) > 1e-6)?;
    if norm(&cross(&a, &b)).atan2(dot(&a, &b)) > std::f64::consts::FRAC_PI_2 * (1.0 + 1e-12) {
        let half = [scaled(&add(&from[0], &to[0]), 0.5), middle];
        linear(from, &half, pieces)?;
        return linear(&half, to, pieces);
    }
    let (axes, axis_weights) = (vec![a, middle, b], vec![1.0, 0.5 * norm(&sum), 1.0]);
    pieces.push(Piece {
        tips,
        tip_weights,
        axes,
        axis_weights,
    });
    Some(())
}

fn linear_stretches(from: &[V3; 2], to: &[V3; 2], number: usize) -> Option<Vec<Stretch>> {
    let mut pieces = Vec::new();
    linear(from, to, &mut pieces)?;
    pieces.iter().map(|piece| Stretch::new(piece, number)).collect()
}

/// The stretches of some moves of a path: those of the moves, then those of other courses. `off`: how far the tip of
/// pieces may be from where they should join. `None` if they are not a path.
pub(crate) fn stretches(path: &Path, moves: Range<usize>, off: f64) -> Option<Vec<Stretch>> {
    let mut all = Vec::new();
    for number in moves.clone() {
        let (from, to) = (path.poses.get(number)?, path.poses.get(number + 1)?);
        match path.moves.get(number)? {
            Move::Linear => all.extend(linear_stretches(from, to, number)?),
            Move::Pieces(pieces) => {
                let own: Option<Vec<_>> = pieces.iter().map(|piece| Stretch::new(piece, number)).collect();
                let own = own?;
                let near = |end: &Placement, [tip, axis]: &[V3; 2]| {
                    norm(&sub(&end.tip, tip)) <= off && norm(&sub(&end.axis, axis)) <= 1e-6
                };
                let joins = |pair: &[Stretch]| near(&pair[0].ends[1], &[pair[1].ends[0].tip, pair[1].ends[0].axis]);
                let (first, last) = (own.first()?, own.last()?);
                if !(near(&first.ends[0], from) && near(&last.ends[1], to) && own.windows(2).all(joins)) {
                    return None;
                }
                all.extend(own);
            }
        }
    }
    let first = path.others.partition_point(|(number, _)| *number < moves.start);
    for (number, poses) in path.others[first..]
        .iter()
        .take_while(|(number, _)| *number < moves.end)
    {
        for pair in poses.windows(2) {
            all.extend(linear_stretches(&pair[0], &pair[1], *number)?);
        }
    }
    Some(all)
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
    /// Whether the box misses a cube.
    pub fn misses(&self, centre: &V3, half: f64) -> bool {
        (0..3).any(|k| {
            let room = 8.0 * EPS * (centre[k].abs() + half + self.low[k].abs().max(self.high[k].abs()));
            self.low[k] - (centre[k] + half) > room || (centre[k] - half) - self.high[k] > room
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
        let mut run = Self {
            body,
            stretches,
            ends: stretches.iter().flat_map(|stretch| stretch.ends).collect(),
            nodes: Vec::new(),
        };
        run.build(0, stretches.len());
        run
    }

    fn build(&mut self, first: usize, last: usize) -> usize {
        let mut node = Node {
            first,
            last,
            low: [0.0; 3],
            high: [0.0; 3],
            bend: 0.0,
            still: self.stretches[first].keeps_axis(),
            halves: None,
        };
        if last == first + 1 {
            let stretch = &self.stretches[first];
            node.bend = stretch.bend(self.body.reach, 1.0);
            for k in 0..3 {
                let mut way = [0.0; 3];
                way[k] = 1.0;
                node.high[k] = self.reach_up(&stretch.ends, node.still, &way) + node.bend;
                way[k] = -1.0;
                node.low[k] = -self.reach_up(&stretch.ends, node.still, &way) - node.bend;
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
