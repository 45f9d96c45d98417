//! Consecutive stretches as a tree of boxes.

use super::{Placement, Stretch};
use crate::tool::Convex;
use nalgebra::Vector3;

/// A box along the axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    pub low: Vector3<f64>,
    pub high: Vector3<f64>,
}

impl Bounds {
    pub fn join(&self, other: &Self) -> Self {
        Self {
            low: self.low.inf(&other.low),
            high: self.high.sup(&other.high),
        }
    }

    /// The largest `⟨direction, x⟩`.
    pub fn support(&self, direction: &Vector3<f64>) -> f64 {
        (0..3)
            .map(|k| (direction[k] * self.low[k]).max(direction[k] * self.high[k]))
            .sum()
    }

    pub fn size(&self) -> f64 {
        (self.high - self.low).norm()
    }

    /// Whether a cube has no point with it in common.
    pub fn misses(&self, centre: &Vector3<f64>, half: f64) -> bool {
        (0..3).any(|k| self.low[k] > centre[k] + half || self.high[k] < centre[k] - half)
    }
}

/// Some consecutive stretches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub first: usize,
    pub last: usize,
    /// Of what the solid sweeps.
    pub swept: Bounds,
    /// Of the tip's way.
    pub tips: Bounds,
    /// The axis, if it is the same all the way.
    pub axis: Option<Vector3<f64>>,
    /// The two halves, if there is more than one stretch.
    pub halves: Option<[usize; 2]>,
}

/// A solid along consecutive stretches.
pub(crate) struct Run<'a> {
    pub solid: &'a Convex,
    pub stretches: &'a [Stretch],
    /// The root is the last one.
    pub nodes: Vec<Node>,
    pub reach: f64,
}

impl<'a> Run<'a> {
    pub fn new(solid: &'a Convex, stretches: &'a [Stretch]) -> Self {
        let mut run = Self {
            solid,
            stretches,
            nodes: Vec::with_capacity(2 * stretches.len()),
            reach: solid.reach(),
        };
        if !stretches.is_empty() {
            run.build(0, stretches.len());
        }
        run
    }

    fn build(&mut self, first: usize, last: usize) -> usize {
        let node = if last == first + 1 {
            let stretch = &self.stretches[first];
            let ends = [stretch.at(0.0), stretch.at(1.0)];
            let tips = Bounds {
                low: stretch.low,
                high: stretch.high,
            };
            let axis = stretch.keeps_axis().then_some(ends[0].axis);
            Node {
                first,
                last,
                swept: self.swept(&ends, tips, axis, stretch.bend(self.reach, 1.0)),
                tips,
                axis,
                halves: None,
            }
        } else {
            let middle = usize::midpoint(first, last);
            let halves = [self.build(first, middle), self.build(middle, last)];
            let [a, b] = halves.map(|half| self.nodes[half]);
            Node {
                first,
                last,
                swept: a.swept.join(&b.swept),
                tips: a.tips.join(&b.tips),
                axis: a.axis.filter(|axis| b.axis == Some(*axis)),
                halves: Some(halves),
            }
        };
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    /// What is swept between two placements.
    pub fn swept(&self, ends: &[Placement; 2], tips: Bounds, axis: Option<Vector3<f64>>, bend: f64) -> Bounds {
        let reaches = |direction: Vector3<f64>| match &axis {
            Some(axis) => tips.support(&direction) + self.solid.support(&direction, axis),
            None => self.reaches(ends, &direction) + bend,
        };
        let mut bounds = Bounds {
            low: Vector3::zeros(),
            high: Vector3::zeros(),
        };
        for k in 0..3 {
            let mut direction = Vector3::zeros();
            direction[k] = 1.0;
            bounds.high[k] = reaches(direction);
            bounds.low[k] = -reaches(-direction);
        }
        bounds
    }

    /// How far the solid reaches in a direction at two placements.
    pub fn reaches(&self, ends: &[Placement; 2], direction: &Vector3<f64>) -> f64 {
        let one = |end: &Placement| direction.dot(&end.tip) + self.solid.support(direction, &end.axis);
        one(&ends[0]).max(one(&ends[1]))
    }

    /// The point that reaches farthest, and at which of both ends.
    pub fn farthest(&self, ends: &[Placement; 2], direction: &Vector3<f64>) -> (Vector3<f64>, usize) {
        let [a, b] = ends.map(|end| end.tip + self.solid.farthest(direction, &end.axis));
        if direction.dot(&a) >= direction.dot(&b) {
            (a, 0)
        } else {
            (b, 1)
        }
    }
}
